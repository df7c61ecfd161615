//! A run under test beside the reference: the error, taken apart.

use super::course::Course;
use super::real::{BITS, Real, norm, point, rounded, sub};
use super::record::{Record, energy};
use crate::body::State;
use crate::scene::Scene;
use nalgebra::Vector3;

/// The errors of a run, at worst over its balls and over the time in which they can be compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Distance of the positions at the sample times, in m; infinite if the run ended early.
    pub position: f64,
    /// The same at one time before the first impact, in m: the last at which every step of the sweep ends.
    pub flight: f64,
    /// Of the times of impacts that are in both, in s; none if there is no such impact.
    pub impact_time: Option<f64>,
    /// Of the time of the first impact, in s, with its sign; of the first ball that has one.
    pub first_impact: Option<f64>,
    /// Impacts of the reference that the run does not have.
    pub missed: usize,
    /// Impacts of the run that the reference does not have.
    pub invented: usize,
    /// Of the energy per mass at the sample times, relative to the reference's largest speed: |dE| / (v^2 / 2).
    pub energy: f64,
    /// How far a ball got behind a surface, in m.
    pub penetration: f64,
    /// How far from touching a ball was where an impact was answered, in m.
    pub off_touch: f64,
}

/// The parts of the error of the positions, in m (R26).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Of the flights: what is left with certified collisions. 0 if that is not above rounding.
    pub integration: f64,
    /// Of determination: the distance between this run and that with certified collisions, or, for those, how far from touching an impact was
    /// answered.
    pub determination: f64,
    /// Of rounding: what becomes of the last digit of the start.
    pub rounding: f64,
    /// The same in the first flight.
    pub flight_rounding: f64,
}

/// When positions are compared, in s.
#[derive(Debug, Clone)]
pub struct Times {
    /// All of them, ascending.
    pub all: Vec<f64>,
    /// The one that stands for the first flight.
    pub flight: f64,
}

impl Times {
    /// Those up to the one that stands for the first flight.
    pub fn in_flight(&self) -> &[f64] {
        &self.all[..self.all.partition_point(|t| *t <= self.flight)]
    }
}

/// A reference with the time up to which it can be compared with.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The course.
    pub course: Course,
    /// Until when, in s.
    pub until: f64,
}

impl Errors {
    /// No error yet.
    fn none() -> Self {
        Self {
            position: 0.0,
            flight: 0.0,
            impact_time: None,
            first_impact: None,
            missed: 0,
            invented: 0,
            energy: 0.0,
            penetration: 0.0,
            off_touch: 0.0,
        }
    }

    /// The errors of `records` against `references`, ball by ball.
    pub fn of(scene: &Scene, times: &Times, records: &[Record], references: &[Compared]) -> Self {
        let mut errors = Self::none();
        for (record, reference) in records.iter().zip(references) {
            errors.add(scene, times, record, reference);
        }
        errors
    }

    fn add(&mut self, scene: &Scene, times: &Times, record: &Record, reference: &Compared) {
        let Times { all: times, flight } = times;
        let flight = *flight;
        let count = times.iter().take_while(|t| **t <= reference.until).count().min(reference.course.samples.len());
        if record.samples.len() < count {
            self.position = f64::INFINITY;
        }
        let before = |t: f64| {
            let exact = reference.course.impacts.iter().filter(|impact| impact.time.to_f64() <= t).count();
            exact == record.impacts.iter().filter(|(time, _)| *time <= t).count()
        };
        let fastest = reference.course.samples.iter().map(|s| rounded(&s[1]).norm_squared()).fold(0.0, f64::max);
        let pairs = times.iter().zip(&record.samples).zip(&reference.course.samples).take(count);
        for ((time, sample), [x, v]) in pairs {
            let off = norm(&sub(&point(&sample.position), x)).to_f64();
            self.position = self.position.max(off);
            if *time == flight {
                self.flight = self.flight.max(off);
            }
            let exact = State { position: rounded(x).into(), velocity: rounded(v) };
            // Between an impact of the one and that of the other the energies have nothing to do with each other.
            if fastest > 0.0 && before(*time) {
                let off = (energy(scene, sample) - energy(scene, &exact)).abs() / (0.5 * fastest);
                self.energy = self.energy.max(off);
            }
        }
        self.add_impacts(record, reference);
        self.penetration = self.penetration.max(record.penetration);
        self.off_touch = self.off_touch.max(record.off_touch);
    }

    /// An impact of the run is that of the reference to which it is nearer in time than to any other, and nearer than any other.
    fn add_impacts(&mut self, record: &Record, reference: &Compared) {
        let within = |t: f64| t <= reference.until;
        let exact: Vec<&Real> = reference.course.impacts.iter().map(|impact| &impact.time).collect();
        let times: Vec<f64> = exact.iter().map(|t| t.to_f64()).take_while(|t| within(*t)).collect();
        let mut nearest: Vec<Option<f64>> = vec![None; times.len()];
        for (time, _) in record.impacts.iter().filter(|(t, _)| within(*t)) {
            let after = times.partition_point(|t| t < time);
            let candidates = [after.checked_sub(1), Some(after)].into_iter().flatten().filter(|k| *k < times.len());
            let Some(k) = candidates.min_by(|a, b| (times[*a] - time).abs().total_cmp(&(times[*b] - time).abs()))
            else {
                self.invented += 1;
                continue;
            };
            let off = (&Real::from(*time) - exact[k]).to_f64();
            match &mut nearest[k] {
                Some(best) => {
                    self.invented += 1;
                    if off.abs() < best.abs() {
                        *best = off;
                    }
                }
                none => *none = Some(off),
            }
        }
        self.missed += nearest.iter().filter(|n| n.is_none()).count();
        for off in nearest.iter().flatten() {
            self.impact_time = Some(self.impact_time.unwrap_or(0.0).max(off.abs()));
        }
        if let (None, Some(Some(off))) = (self.first_impact, nearest.first()) {
            self.first_impact = Some(*off);
        }
    }
}

/// The greatest distance between two runs at the sample times that can be compared, in m.
pub fn distance(times: &[f64], a: &[Record], b: &[Record], references: &[Compared]) -> f64 {
    let mut greatest = 0.0_f64;
    for ((a, b), reference) in a.iter().zip(b).zip(references) {
        let pairs = times.iter().zip(&a.samples).zip(&b.samples).take_while(|((t, _), _)| **t <= reference.until);
        for ((_, a), b) in pairs {
            greatest = greatest.max((a.position - b.position).norm());
        }
    }
    greatest
}

/// The laws that Euler's method obeys to the letter while a ball falls freely, each measured as a multiple of what it says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EulerLaws {
    /// The height is too large by g t h / 2.
    pub height: f64,
    /// The energy per mass grows by g^2 h^2 / 2 in a step.
    pub energy: f64,
    /// The first impact is late by h / 2 after a start from rest; none without one.
    pub late: Option<f64>,
}

impl EulerLaws {
    /// Of the first flight of `record` with the step `h` (s); none without gravity, with air, or if the flight is shorter than a step.
    pub fn of(scene: &Scene, record: &Record, h: f64, first_impact: Option<f64>) -> Option<Self> {
        let g = scene.gravity.filter(|_| only_gravity(scene))?.acceleration();
        let start = scene.balls.first()?.start();
        let (time, end, steps) = record.flight?;
        let strength = g.norm();
        if strength == 0.0 || steps == 0 {
            return None;
        }
        let t = Real::from(time);
        let half = Real::from(0.5);
        let fallen = |i: usize| {
            let moved = &(&Real::from(start.velocity[i]) * &t) + &(&(&Real::from(g[i]) * &half) * &(&t * &t));
            &Real::from(start.position[i]) + &moved
        };
        let exact = [fallen(0), fallen(1), fallen(2)];
        let too_high = -rounded(&sub(&point(&end.position), &exact)).dot(&g) / strength;
        let gained = (energy(scene, &end) - energy(scene, &start)) / f64::from(steps);
        Some(Self {
            height: too_high / (0.5 * strength * time * h),
            energy: gained / (0.5 * strength * strength * h * h),
            late: first_impact.filter(|_| start.velocity == Vector3::zeros()).map(|late| late / (0.5 * h)),
        })
    }
}

/// Whether nothing but gravity acts in flight.
pub fn only_gravity(scene: &Scene) -> bool {
    scene.drag.is_none() && scene.magnus.is_none() && scene.buoyancy.is_none()
}

/// Where balls are after all: what still means something when positions do not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// Impacts of all balls.
    pub impacts: usize,
    /// Balls that rest.
    pub resting: usize,
    /// Mean energy per mass, in J/kg.
    pub energy: f64,
    /// Root of the mean square distance from the mean position, in m.
    pub spread: f64,
    /// The mean position, in m.
    pub centre: [f64; 3],
}

impl Ends {
    /// Of final states with the number of impacts and of resting balls.
    pub fn of(scene: &Scene, states: &[State], impacts: usize, resting: usize) -> Self {
        let n = states.len().max(1) as f64;
        let centre = states.iter().fold(Vector3::zeros(), |sum, s| sum + s.position.coords / n);
        let square = states.iter().map(|s| (s.position.coords - centre).norm_squared() / n).sum::<f64>();
        let energy = states.iter().map(|s| energy(scene, s) / n).sum();
        Self { impacts, resting, energy, spread: square.sqrt(), centre: centre.into() }
    }
}

/// The growth of a small difference: how many times `shift` (m) two courses of one ball are apart at each sample.
pub fn growth(a: &Course, b: &Course, shift: f64) -> Vec<f64> {
    let pairs = a.samples.iter().zip(&b.samples);
    pairs.map(|([x, _], [y, _])| norm(&sub(x, y)).to_f64() / shift).collect()
}

/// What rounding makes of a course of the reference in a scene of `size` (m) after a growth of small differences, in m: a few hundred operations
/// from one sample to the next.
pub fn reference_error(size: f64, growth: f64) -> f64 {
    2f64.powi(10 - BITS as i32) * size * growth
}
