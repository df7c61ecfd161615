//! What the measurements of a scene come to: orders, remarks, the discretisation of its surfaces, where the balls end.

use super::candidate::Candidate;
use super::compare::{Compared, Ends, Times, distance, only_gravity};
use super::fit::{Law, Order, order};
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
            let flights = if stepping { Law::Smooth } else { Law::Band };
            let bounces = match variant {
                // What f is off by depends on where in a step the impacts lie: nothing else is left of a linear f, and as much of a quartic as of the flight.
                Variant::Rk4LinearF | Variant::DormandPrince => Law::Band,
                _ if stepping => Law::Even,
                _ => Law::Band,
            };
            let fit = |error: fn(&Measurement) -> [f64; 2], step: fn(&Measurement) -> f64, law: Law| {
                let step = |m: &Measurement| if stepping { m.value } else { step(m) };
                let point = |m: &Measurement| {
                    let [error, rounding] = error(m);
                    (step(m), error, rounding)
                };
                let points: Vec<_> = measurements.iter().map(point).collect();
                order(if fits { &points } else { &[] }, law)
            };
            let flight_order = fit(|m| [m.errors.flight, m.shares.flight_rounding], |m| m.flight_step, flights);
            let order = fit(|m| [m.errors.position, m.shares.rounding], |m| m.step, bounces);
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
            let higher = variant.textbook_orders().is_some_and(|[flight, _]| flight > 1);
            if higher && only_gravity(self.scene) && comparable > 0 && impacts > 0 {
                self.remarks.push(Remark::ExactFlights(variant));
            }
            let flight = sweep.flight_order;
            let expected = match (flight, variant.textbook_orders()) {
                (Order::AtRounding, Some([flight, _])) => Some(f64::from(flight)),
                _ => flight.value(),
            };
            if let (Some(expected), Some(order)) = (expected, sweep.order.value())
                && order < expected - 0.1
            {
                self.remarks.push(Remark::LoweredByBounces { variant, flight, order });
            }
            if let (Some(order), Some([textbook, _])) = (sweep.flight_order.value(), variant.textbook_orders())
                && variant.parameter() == Parameter::Tolerance
                && (order - f64::from(textbook)).abs() > 0.1
            {
                self.remarks.push(Remark::OwnSteps { variant, order });
            }
            // By more than half the ball; of points, by more than a thousandth of the scene.
            let largest = self.scene.balls.iter().map(Ball::radius).fold(0.0, f64::max);
            let deep = if largest > 0.0 { 0.5 * largest } else { self.plan.farthest * 2f64.powi(-10) };
            let runs = sweep.measurements.iter().filter(|m| m.errors.penetration > deep).count();
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
