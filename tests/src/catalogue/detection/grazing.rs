//! H3 and H4: double roots, and roots that cancel.

use super::super::{Bound, Case, Figure, Worst};
use super::rows::{Tally, rows};
use crate::exact::{Exact, exact};
use crate::nasty::ulps;
use crate::random::Random;
use crate::stage::{Stage, smooth};
use carom_geometry::rounding::UNIT_ROUNDOFF;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H3",
            title: "grazing a plane: a throw that reaches the ceiling to an ulp",
            elsewhere: "v^2 - 2 g h in f64 is 14 % off at 1 + 2e-16; LSODAR-class solvers find odd roots only (netlib roots.f)",
            bound: "hit or none by the exact sign of the discriminant; t to 4 u",
            run: grazing_a_ceiling,
        },
        Case {
            id: "H3",
            title: "grazing a face, an edge, a vertex, r (1 +- 10^-k), k = 1..15",
            elsewhere: "companion matrix: 14 of 60 late by more than 1e-12; parry 0.31.1 1e-5 early from k = 13 on",
            bound: "none missed, none late, none answered farther than 64 u L from touching",
            run: grazing_features,
        },
        Case {
            id: "H4",
            title: "time of impact far from the double root, v 1e-8..1e8, h 1e-12..1e3",
            elsewhere: "(-v + sqrt(v^2 + 2 g h))/g is 0 at v = 1e4, h = 1e-9: 100 % wrong",
            bound: "4 u relative, against rational arithmetic",
            run: time_of_impact,
        },
    ]
}

/// The sign of gap - v t + g t^2/2, exactly.
fn left(gap: f64, v: f64, g: f64, t: f64) -> Exact {
    let t = exact(t);
    exact(gap) - exact(v) * &t + exact(g) * exact(0.5) * &t * &t
}

/// Keeps that `t` is within 4 u of the first root of gap - v t + g t^2/2, and gives the distance in u (from the sign changes).
fn keep_first_root(bound: &mut Bound, worst: &mut Worst, [gap, v, g]: [f64; 3], t: f64) {
    let inside = |k: f64| {
        let (low, high) = (t * (1.0 - k * UNIT_ROUNDOFF), t * (1.0 + k * UNIT_ROUNDOFF));
        // Until its turn at v / g the clearance falls, if it falls at all.
        let turned = g > 0.0 && exact(high) * exact(g) >= exact(v);
        left(gap, v, g, low) >= Exact::ZERO && (turned || left(gap, v, g, high) <= Exact::ZERO)
    };
    let units = [0.5, 1.0, 2.0, 3.0, 4.0].into_iter().find(|k| inside(*k));
    worst.of(units.unwrap_or(f64::INFINITY));
    bound.keep(units.is_some(), || format!("gap {gap:e}, v {v:e}, g {g:e}: t = {t:e}"));
}

fn grazing_a_ceiling() -> Figure {
    let mut random = Random::new(0x31);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    let (mut hits, mut misses, mut touches) = (0, 0, 0);
    for _ in 0..3000 {
        let (v, g) = (random.octave(-10, 10), random.octave(-4, 8));
        // Up to 8 ulps beside the apex; half of them numbers whose apex is exact.
        let (v, g) =
            if random.below(2) == 0 { (v, g) } else { ((v * 1024.0).ceil(), 2f64.powi(random.below(8) as i32)) };
        let gap = ulps(v * v / (2.0 * g), random.below(17) as i32 - 8);
        let stage = Stage::new(1.75 * v / g).down(g).plane("ceiling", smooth(1.0), [0.0, 0.0, gap], [0.0, 0.0, -1.0]);
        let run = stage.ball([0.3, -0.2, 0.0], [0.25, 0.5, v], 0.0).run();
        let discriminant = exact(v) * exact(v) - exact(2.0) * exact(g) * exact(gap);
        let impacts = run.impacts();
        if discriminant > Exact::ZERO {
            hits += 1;
            bound.keep(impacts.len() == 1, || format!("gap {gap:e}, v {v:e}, g {g:e}: {} impacts", impacts.len()));
            if let Some(event) = impacts.first() {
                keep_first_root(&mut bound, &mut worst, [gap, v, g], event.time);
            }
        } else {
            if discriminant.is_zero() {
                touches += 1
            } else {
                misses += 1
            }
            // A touch has no closing speed: nothing to answer.
            bound.keep(impacts.is_empty(), || format!("gap {gap:e}, v {v:e}, g {g:e}: {impacts:?}"));
            let events = &run.trajectory.events;
            bound.keep(events.is_empty(), || format!("gap {gap:e}, v {v:e}, g {g:e}: {events:?}"));
        }
    }
    bound.keep(hits > 500 && misses > 500 && touches > 50, || format!("too few: {hits}, {misses}, {touches}"));
    bound.figure(format!("{hits} hit, {touches} touch, {misses} miss: all right, t off by {} u at worst", worst.0))
}

fn grazing_features() -> Figure {
    let mut bound = Bound::default();
    let rows = rows(&["apex_graze_face", "line_graze_edge", "line_graze_vertex"]);
    let tally = Tally::of(&rows, 64.0, &mut bound);
    bound.keep(tally.missed.is_empty(), || format!("missed {:?}", tally.missed));
    bound.figure(tally.text())
}

fn time_of_impact() -> Figure {
    let mut random = Random::new(0x41);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    let count = 10_000;
    for _ in 0..count {
        let decimal = |random: &mut Random, low: f64, high: f64| 10f64.powf(random.within(low, high));
        let (v, h) = (decimal(&mut random, -8.0, 8.0), decimal(&mut random, -12.0, 3.0));
        let (v, g) = (if random.below(4) == 0 { -v } else { v }, 9.81);
        let high = (v.abs() + (v * v + 2.0 * g * h).sqrt()) / g;
        let stage = Stage::new(2.0 * high).down(g).floor(smooth(0.0));
        let run = stage.ball([0.0, 0.0, h], [0.0, 0.0, -v], 0.0).run();
        match run.impacts().first() {
            // Upwards throws have their apex first: the clearance rises, then falls through 0 once.
            Some(event) if v < 0.0 => {
                let [low, high] =
                    [1.0 - 4.0 * UNIT_ROUNDOFF, 1.0 + 4.0 * UNIT_ROUNDOFF].map(|k| left(h, v, -g, event.time * k));
                bound.keep(low >= Exact::ZERO && high <= Exact::ZERO, || {
                    format!("v {v:e}, h {h:e}: t = {:e}", event.time)
                });
            }
            Some(event) => keep_first_root(&mut bound, &mut worst, [h, v, -g], event.time),
            None => bound.keep(false, || format!("v {v:e}, h {h:e}: no impact")),
        }
    }
    bound.figure(format!("{count} throws: t off by {} u at worst", worst.0))
}
