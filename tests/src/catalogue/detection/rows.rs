//! The 1176 exact cases of a ball against a triangle, each run as a scene.

use super::super::Bound;
use crate::data::{csv, number};
use crate::exact;
use crate::stage::{Run, Stage, smooth};
use carom_dynamics::events::Event;
use carom_geometry::bounds::Aabb;
use carom_geometry::rounding::{UNIT_ROUNDOFF, point_radius};
use nalgebra::{Point3, Vector3};

const HEADER: &str = "id,category,cx,cy,cz,vx,vy,vz,gx,gy,gz,r,ax,ay,az,bx,by,bz,ex,ey,ez,tmax,start,hit,t_lo,t_hi,t_decimal,feature,multiplicity,n_boundary_roots";

/// A ball on c + v t + g t^2/2 and a triangle, with the exact answer.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub id: String,
    pub centre: Point3<f64>,
    pub velocity: Vector3<f64>,
    pub gravity: Vector3<f64>,
    pub radius: f64,
    pub triangle: [Point3<f64>; 3],
    pub duration: f64,
    /// The bracket of the first contact, if there is one.
    pub contact: Option<[f64; 2]>,
}

/// The rows of some categories that start outside.
pub(super) fn rows(categories: &[&str]) -> Vec<Row> {
    let wanted = |row: &&Vec<String>| categories.contains(&row[1].as_str()) && row[22] == "outside";
    let table = csv("geometry-cases/ball_vs_triangle_exact.csv", HEADER);
    table.iter().filter(wanted).map(|row| Row::of(row)).collect()
}

impl Row {
    fn of(row: &[String]) -> Self {
        let n = |i: usize| number(&row[i]);
        let p = |i: usize| Point3::new(n(i), n(i + 1), n(i + 2));
        Self {
            id: row[0].clone(),
            centre: p(2),
            velocity: p(5).coords,
            gravity: p(8).coords,
            radius: n(11),
            triangle: [p(12), p(15), p(18)],
            duration: n(21),
            contact: (row[23] == "1").then(|| [n(24), n(25)]),
        }
    }

    /// Its scene, run: the triangle as a mesh, without loss.
    pub fn run(&self) -> Run {
        let stage = Stage::new(self.duration).gravity(self.gravity);
        let stage = stage.mesh("triangle", smooth(1.0), self.triangle.to_vec(), vec![[0, 1, 2]]);
        stage.ball(self.centre, self.velocity, self.radius).run()
    }

    /// The largest length that goes into a position: coordinates, and how far the ball travels until `t`.
    pub fn length(&self, t: f64) -> f64 {
        let corners = self.triangle.iter().map(|p| p.coords.amax());
        let travelled = (self.velocity.amax() + 0.5 * self.gravity.amax() * t) * t;
        corners.fold(self.centre.coords.amax() + self.radius + travelled, f64::max)
    }

    /// The radius with which the ball meets the mesh: a point is a ball of the least size that its place resolves.
    pub fn mesh_radius(&self) -> f64 {
        let bounds = Aabb::of_points(&[self.triangle.as_slice(), &[self.centre]].concat());
        let corners = bounds.min().coords.amax().max(bounds.max().coords.amax());
        self.radius.max(point_radius(corners.max(bounds.extent().amax())))
    }

    /// How far the ball of the exact flight is from the triangle at `t`, exactly but for the last rounding.
    pub fn clearance(&self, t: f64) -> f64 {
        let x = exact::on_path(&self.centre, &[self.velocity, self.gravity * 0.5], t);
        exact::clearance(&self.triangle, &x, self.mesh_radius())
    }
}

/// What running rows came to; distances in units of u times the largest length.
#[derive(Debug, Default)]
pub(super) struct Tally {
    /// How many rows.
    pub rows: usize,
    /// Impacts found.
    pub hits: usize,
    /// Contacts there are, and no impact.
    pub missed: Vec<String>,
    /// Impacts where there is, exactly, no contact.
    pub doubtful: usize,
    /// How much too deep the ball is at its impact, at worst.
    pub deep: f64,
    /// How far from the triangle at its impact, at worst.
    pub far: f64,
}

impl Tally {
    /// Runs `rows` and keeps that no impact is late, early or missed by more than `most` u L; `doubt` is how many impacts there
    /// may be where the exact answer is none.
    pub fn of(rows: &[Row], most: f64, bound: &mut Bound) -> Self {
        let mut tally = Self::default();
        for row in rows {
            let run = row.run();
            tally.add(row, run.impacts().first(), most, bound);
        }
        tally
    }

    fn add(&mut self, row: &Row, impact: Option<&Event>, most: f64, bound: &mut Bound) {
        self.rows += 1;
        let Some(event) = impact else {
            if row.contact.is_some() {
                self.missed.push(row.id.clone());
            }
            return;
        };
        self.hits += 1;
        self.doubtful += usize::from(row.contact.is_none());
        let unit = UNIT_ROUNDOFF * row.length(event.time);
        let gap = row.clearance(event.time);
        self.far = self.far.max(gap / unit);
        bound.keep(gap <= most * unit, || format!("row {}: {:.1} u L away", row.id, gap / unit));
        // A late impact is one that was deeper before; a needle has long been passed when it is seen again.
        let since = row.contact.map_or(event.time, |[low, _]| low.min(event.time));
        for k in 0..=8 {
            let deep = -row.clearance(since + (event.time - since) * f64::from(k) / 8.0) / unit;
            self.deep = self.deep.max(deep);
            bound.keep(deep <= most, || format!("row {}: {deep:.1} u L deep", row.id));
        }
    }

    /// In words.
    pub fn text(&self) -> String {
        format!(
            "{} cases, {} impacts: {} missed, {} in doubt, away by {:.1} u L, deep by {:.1} u L at worst",
            self.rows,
            self.hits,
            self.missed.len(),
            self.doubtful,
            self.far,
            self.deep
        )
    }
}
