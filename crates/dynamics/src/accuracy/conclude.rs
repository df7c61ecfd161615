//! What the measurements of a scene come to: orders, remarks, the discretisation of its surfaces, where the balls end.

use super::candidate::Candidate;
use super::compare::{Compared, Ends, Errors, Times, distance, only_gravity};
use super::fit::order;
use super::measure::Effort;
use super::real::rounded;
use super::record::Record;
use super::report::{Measurement, Remark, Resolution, Sweep};
use super::resolution::{LEVELS, Original, refined};
use super::stage::Stage;
use super::variant::{Parameter, Variant};
use crate::body::{Ball, State};
use crate::error::SceneError;
use crate::plan::Plan;
use crate::scene::Method;
use crate::surface::Shape;
use crate::tolerance::FINEST_TOLERANCE;
use std::sync::Arc;

impl Stage<'_> {
    /// The measurements by method, with their orders.
    pub(super) fn sweeps(&self, measured: Vec<Measurement>, effort: &Effort, fits: bool) -> Vec<Sweep> {
        let mut sweeps = Vec::new();
        for &variant in effort.variants {
            let measurements: Vec<_> = measured.iter().filter(|m| m.variant == variant).cloned().collect();
            if measurements.is_empty() {
                continue;
            }
            let stepping = variant.parameter() == Parameter::Step;
            // What a linear f is off by depends on where in a step the impacts lie: no line, but a band.
            let even = stepping && variant != Variant::Rk4LinearF;
            let fit = |error: fn(&Errors) -> f64, step: fn(&Measurement) -> f64| {
                let step = |m: &Measurement| if stepping { m.value } else { step(m) };
                let points: Vec<_> =
                    measurements.iter().map(|m| (step(m), error(&m.errors), m.shares.rounding)).collect();
                order(if fits { &points } else { &[] }, even)
            };
            let flight_order = fit(|e| e.flight, |m| m.flight_step);
            let order = fit(|e| e.position, |m| m.step);
            sweeps.push(Sweep { variant, measurements, flight_order, order });
        }
        sweeps
    }

    /// What the numbers mean.
    pub(super) fn conclude(&mut self, sweeps: &[Sweep], impacts: usize, comparable: usize) {
        if comparable == 0 {
            self.remarks.push(Remark::NothingToCompare);
        } else if impacts == 0 {
            self.remarks.push(Remark::NoImpacts);
        }
        for sweep in sweeps {
            let variant = sweep.variant;
            let whole = sweep.order.value();
            let higher = variant.textbook_orders().is_some_and(|[flight, _]| flight > 1);
            if higher && only_gravity(self.scene) && comparable > 0 && impacts > 0 {
                self.remarks.push(Remark::ExactFlights(variant));
            }
            if let (Some(flight), Some(order)) = (sweep.flight_order.value(), whole)
                && order < flight - 0.1
            {
                self.remarks.push(Remark::LoweredByBounces { variant, flight, order });
            }
            let radius = self.scene.balls.iter().map(Ball::radius).fold(self.plan.farthest * 2f64.powi(-10), f64::max);
            let runs = sweep.measurements.iter().filter(|m| m.errors.penetration > radius).count();
            if runs > 0 {
                self.remarks.push(Remark::Through { variant, runs });
            }
        }
    }

    /// The scene on its meshes, and on finer ones of what they were cut from.
    pub(super) fn resolutions(&mut self, references: &[Compared]) -> Result<Vec<Resolution>, SceneError> {
        let mut originals = Vec::new();
        for (surface, s) in self.scene.surfaces.iter().enumerate() {
            if let Shape::Mesh(mesh) = &s.shape {
                let original = Original::of(mesh);
                self.remarks.push(Remark::Discretised { surface, original });
                originals.push((surface, Arc::clone(mesh), original));
            }
        }
        if originals.iter().all(|(_, _, original)| *original == Original::Itself) {
            return Ok(Vec::new());
        }
        let mut runs: Vec<(usize, Vec<Record>)> = Vec::new();
        for level in 0..=LEVELS {
            let mut scene = self.scene.clone();
            let mut faces = 0;
            for (surface, mesh, original) in &originals {
                let finer = if level == 0 { None } else { refined(mesh, original, level) };
                if level > 0 && finer.is_none() && *original != Original::Itself {
                    return Ok(compare_resolutions(self.times, &runs, references));
                }
                let mesh = finer.map_or_else(|| Arc::clone(mesh), Arc::new);
                faces += mesh.faces().len();
                scene.surfaces[*surface].shape = Shape::Mesh(mesh);
            }
            let best = if Plan::new(&scene)?.method() == Method::Exact { Variant::Exact } else { Variant::Adaptive };
            let candidate = Candidate::new(best, FINEST_TOLERANCE, &scene)?;
            runs.push((faces, self.beside(&scene).run(&candidate)));
        }
        Ok(compare_resolutions(self.times, &runs, references))
    }

    pub(super) fn reference_ends(&self, references: &[Compared]) -> Ends {
        let last = references.iter().filter_map(|r| r.course.samples.last());
        let states: Vec<State> =
            last.map(|[x, v]| State { position: rounded(x).into(), velocity: rounded(v) }).collect();
        let impacts = references.iter().map(|r| r.course.impacts.len()).sum();
        let resting = references.iter().filter(|r| r.course.rest.is_some()).count();
        Ends::of(self.scene, &states, impacts, resting)
    }
}

/// Each but the finest beside the finest.
fn compare_resolutions(times: &Times, runs: &[(usize, Vec<Record>)], references: &[Compared]) -> Vec<Resolution> {
    let Some(((_, finest), others)) = runs.split_last() else { return Vec::new() };
    let first = |records: &[Record]| records.iter().find_map(|r| r.impacts.first()).map(|(t, _)| *t);
    // Up to the second impact of anyone: there the first bounce is over.
    let second = finest.iter().filter_map(|r| r.impacts.get(1)).map(|(t, _)| *t).fold(f64::INFINITY, f64::min);
    let early: Vec<f64> = times.all.iter().copied().take_while(|t| *t < second).collect();
    let compare = |(faces, records): &(usize, Vec<Record>)| Resolution {
        faces: *faces,
        first_bounce: distance(&early, records, finest, references),
        position: distance(&times.all, records, finest, references),
        first_impact: first(records).zip(first(finest)).map(|(a, b)| (a - b).abs()),
    };
    others.iter().map(compare).collect()
}
