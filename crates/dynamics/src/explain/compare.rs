//! Two scenes side by side, one without an effect and one with it: what it changes, and what was predicted.

use super::effect::{Effect, MORE_REST};
use super::flight::Flight;
use super::prediction::{change, landing};
use super::{Cost, Finding, Quantity, Runs, Size};
use crate::effects::friction::Friction;
use crate::effects::grip::slip;
use crate::effects::restitution::Restitution;
use crate::events::{Event, Motion};
use crate::power::logarithm;
use crate::surface::Material;
use crate::tolerance::{FLIGHT_TOLERANCE, rate_rounding};
use nalgebra::Vector3;

/// A prediction that is off by more than this share needs a reason.
const APART: f64 = 0.15;

/// Above this share an effect is not small, and its square not nothing beside it.
const SMALL: f64 = 0.1;

/// Below this part of the way that the ball is going towards the surface it only grazes it.
const GRAZING: f64 = 0.25;

/// What `effect` changes on the ball of `balls` where that is most.
pub(super) fn find(effect: Effect, without: &Runs, with: &Runs, balls: &[usize]) -> Result<Finding, &'static str> {
    let mut most: Option<Finding> = None;
    let mut shifts = Vec::new();
    for (i, &ball) in balls.iter().enumerate() {
        let (before, after) = (&without.flights[i], &with.flights[i]);
        shifts.push((after.outcome.state.position - before.outcome.state.position).norm());
        let found = match effect {
            _ if effect.is_of_flight() => of_flight(effect, (without, before), (with, after), ball),
            Effect::Rest => of_rest((without, before), (with, after), ball),
            Effect::Rolling => of_rolling((without, before), (with, after), ball),
            _ => of_impact(effect, (without, before), (with, after), ball),
        };
        if let Some(found) = found
            && most.as_ref().is_none_or(|most| found.share() > most.share())
        {
            most = Some(found);
        }
    }
    shifts.sort_by(f64::total_cmp);
    let end_shift = shifts.get(shifts.len() / 2).copied().unwrap_or(0.0);
    let finding = most.ok_or(match effect {
        Effect::Rolling => "no ball rolls",
        Effect::Rest => "no ball comes to rest after bouncing",
        _ if effect.is_of_flight() => "no ball begins with a flight",
        _ => "no ball hits anything at an angle, or at all",
    })?;
    Ok(Finding { end_shift, cost: cost(without, with), ..finding })
}

/// The work that the effect adds, in a second of simulated time.
fn cost(without: &Runs, with: &Runs) -> Cost {
    let ((before, seconds), (after, other_seconds)) = (without.work(), with.work());
    let rate = |count: fn(&crate::counters::Counters) -> u64| {
        count(&after) as f64 / other_seconds - count(&before) as f64 / seconds
    };
    Cost {
        accelerations: rate(|c| c.accelerations),
        paths: rate(|c| c.paths),
        contacts: rate(|c| c.restitution + c.friction + c.rest),
    }
}

fn finding(ball: usize, way: f64, number: Option<(&'static str, f64)>, sizes: Vec<Size>) -> Finding {
    let cost = Cost { accelerations: 0.0, paths: 0.0, contacts: 0.0 };
    Finding { ball, way, number, sizes, end_shift: 0.0, cost }
}

/// What an effect changes of a flight and of the landing.
fn of_flight(
    effect: Effect,
    (without, before): (&Runs, &Flight),
    (with, after): (&Runs, &Flight),
    ball: usize,
) -> Option<Finding> {
    if !before.flies || !after.flies {
        return None;
    }
    let common = before.seconds().min(after.seconds());
    let way = before.way(common);
    let moved = change(&without.plan, &with.plan, ball, before, common);
    let number = number(effect, without, with, before, ball, common);
    let measured = (after.at(common).position - before.at(common).position).norm();
    let place = (Quantity::Place, moved.position.norm(), measured);
    let way = if way > 0.0 { way } else { after.way(common) };
    if way == 0.0 {
        return None;
    }
    let lands = match (before.impact, after.impact) {
        (Some(a), Some(b)) if a.surface == b.surface && a.normal == b.normal => Some((a, b)),
        _ => None,
    };
    let Some((a, b)) = lands else {
        let share = measured / way;
        let told = size(place, share, share, None);
        return Some(finding(ball, way, number, vec![told]));
    };
    let until = before.seconds();
    let moved = change(&without.plan, &with.plan, ball, before, until);
    let pull = without.plan.forces(&without.plan.balls()[ball]);
    let pull = pull.acceleration(&before.at(until), &mut Default::default());
    let predicted = landing(&moved, &a.normal, &a.velocity_in, &pull);
    let (speed, other_speed) = (a.velocity_in.norm(), b.velocity_in.norm());
    let sizes = [
        (Quantity::FlightTime, predicted.later / until, (b.time - a.time) / until),
        (Quantity::ImpactSpeed, predicted.faster / speed, (other_speed - speed) / speed),
        (Quantity::Landing, predicted.aside.norm(), (b.position - a.position).norm()),
    ];
    let share = |(quantity, _, measured): (Quantity, f64, f64)| {
        if quantity == Quantity::Landing { measured / way } else { measured.abs() }
    };
    let largest = sizes.iter().map(|s| share(*s)).fold(0.0, f64::max);
    let grazes = (-a.normal.dot(&a.velocity_in) < GRAZING * speed).then_some("it only grazes the surface there");
    let told = sizes.into_iter().filter(|s| share(*s) > rate_rounding(1.0));
    let mut told: Vec<Size> = told.map(|s| size(s, share(s), largest, grazes)).collect();
    told.sort_by(|a, b| b.share(way).total_cmp(&a.share(way)));
    Some(finding(ball, way, number, told))
}

/// A size with the reason why its prediction is off, if it is: `share` is what is measured of it, `largest` that of the effect's largest.
fn size(
    (quantity, predicted, measured): (Quantity, f64, f64),
    share: f64,
    largest: f64,
    known: Option<&'static str>,
) -> Size {
    let off = (predicted - measured).abs() > APART * measured.abs();
    let reason = if share <= SMALL * FLIGHT_TOLERANCE.sqrt() {
        "too small beside the tolerance of the flights"
    } else if largest > SMALL {
        "the effect is not small, and what is of second order in it is left out"
    } else if share <= 2.0 * largest * largest / APART {
        "small beside what else the effect changes, of whose second order it is"
    } else {
        known.unwrap_or("the other effects of the scene act against it, which is left out")
    };
    Size { quantity, predicted, measured, apart: off.then_some(reason) }
}

/// The number that tells how large an effect is, with its name.
fn number(
    effect: Effect,
    without: &Runs,
    with: &Runs,
    flight: &Flight,
    ball: usize,
    until: f64,
) -> Option<(&'static str, f64)> {
    let of = &with.plan.balls()[ball];
    Some(match effect {
        // int |a| / v dt: for quadratic drag the way over the drag length, for linear k t / m.
        Effect::Drag | Effect::Magnus => {
            let (before, after) = (without.plan.forces(of), with.plan.forces(of));
            let mut counters = Default::default();
            let sum = flight.samples(until).filter(|(_, state, _)| state.velocity != Vector3::zeros());
            let sum = sum.map(|(t, state, weight)| {
                let a = after.acceleration_after(&state, t, &mut counters);
                let b = before.acceleration_after(&state, t, &mut counters);
                (a - b).norm() / state.velocity.norm() * weight
            });
            let name = if effect == Effect::Drag { "way over drag length, s/l" } else { "(C_L/C) s/l" };
            (name, sum.sum())
        }
        Effect::Wind => ("wind over speed, w/v", {
            let wind = with.scene.drag.map_or(0.0, |drag| drag.wind().norm());
            wind / flight.at(until).velocity.norm()
        }),
        Effect::SpinDecay => ("t/tau", until / with.scene.spin_decay.map_or(f64::INFINITY, |d| d.time_constant())),
        Effect::Buoyancy => ("rho V/m", with.scene.buoyancy?.displaced(of) / of.mass()?),
        _ => return None,
    })
}

/// The material of what is hit, as the ball meets it.
fn material(runs: &Runs, impact: &Event, ball: usize) -> Material {
    let material = runs.scene.surfaces[impact.surface].material;
    let restitution: Restitution = material.restitution.for_ball(&runs.plan.balls()[ball]);
    Material { restitution, ..material }
}

/// What an effect changes of the first impact.
fn of_impact(
    effect: Effect,
    (without, before): (&Runs, &Flight),
    (with, after): (&Runs, &Flight),
    ball: usize,
) -> Option<Finding> {
    let (a, b) = (before.impact?, after.impact?);
    let (m_before, m_after) = (material(without, &a, ball), material(with, &b, ball));
    let (n, v) = (a.normal, a.velocity_in);
    let closing = -n.dot(&v);
    let along = |v: &Vector3<f64>| v - n * n.dot(v);
    let together = (before.together || after.together).then_some("it hits several surfaces at once");
    let (told, number) = if effect == Effect::FallingRestitution {
        let predicted = m_after.restitution.at(closing) / m_before.restitution.at(closing) - 1.0;
        let measured = n.dot(&b.velocity) / n.dot(&a.velocity) - 1.0;
        (((Quantity::ReboundSpeed), predicted, measured), Some(("closing speed, m/s", closing)))
    } else {
        let tangential = along(&v).norm();
        if tangential <= rate_rounding(v.norm()) {
            return None;
        }
        let of = &with.plan.balls()[ball];
        let spin = with.scene.spin_decay.map_or(of.spin(), |decay| decay.after(&of.spin(), a.time));
        let u = slip(of, &v, &spin, &n);
        let kept = |m: &Material| {
            let c_r = m.restitution.at(closing);
            match m.friction {
                Friction::Grip(grip) => along(&v) + grip.kick(&u, of.inertia(), (1.0 + c_r) * closing),
                _ => m.friction.slow(along(&v), closing, c_r),
            }
        };
        let kept = |m: &Material| kept(m).norm();
        let predicted = (kept(&m_after) - kept(&m_before)) / tangential;
        let measured = (along(&b.velocity).norm() - along(&a.velocity).norm()) / tangential;
        let number = match effect {
            // Grips up to mu (1 + c_r) (1 + alpha) / (alpha (1 + e_x)).
            Effect::Grip => ("slip over closing speed, |u|/|v_n|", u.norm() / closing),
            Effect::ImpulseFriction => ("1 + c_r", 1.0 + m_after.restitution.at(closing)),
            _ => ("closing over tangential speed", closing / tangential),
        };
        ((Quantity::TangentialSpeed, predicted, measured), Some(number))
    };
    let told = Size { apart: together.filter(|_| off(told.1, told.2)), ..size(told, 1.0, 0.0, together) };
    Some(finding(ball, before.way(before.seconds()), number, vec![told]))
}

/// How much slower a ball rolls for its rolling resistance: c_rr N / (1 + alpha) per second and mass.
fn of_rolling((without, before): (&Runs, &Flight), (with, after): (&Runs, &Flight), ball: usize) -> Option<Finding> {
    let ((from, to), (other_from, other_to)) = (before.rolling()?, after.rolling()?);
    let (from, until) = (from.max(other_from), to.min(other_to));
    let roll = before.roll?;
    let Friction::Grip(grip) = with.scene.surfaces[roll.surface].material.friction else { return None };
    let of = &without.plan.balls()[ball];
    let load = -roll.normal.dot(&without.plan.constant_acceleration(of));
    let speed = before.rolling_speed(from);
    let predicted = -grip.rolling() * load / (1.0 + of.inertia()) * (until - from) / speed;
    let measured = (after.rolling_speed(until) - before.rolling_speed(until)) / speed;
    let reason = "the ball rolls over edges, turns, or is in the air";
    let apart = off(predicted, measured).then_some(reason);
    let told = Size { quantity: Quantity::RollingSpeed, predicted, measured, apart };
    Some(finding(ball, speed * (until - from), Some(("c_rr", grip.rolling())), vec![told]))
}

fn off(predicted: f64, measured: f64) -> bool {
    (predicted - measured).abs() > APART * measured.abs()
}

/// How many impacts more the rest test takes than one with a higher speed: at each end of bouncing, those in which restitution takes the speed
/// down by that factor.
fn of_rest((without, before): (&Runs, &Flight), (_, after): (&Runs, &Flight), ball: usize) -> Option<Finding> {
    let c_r = |surface: usize| {
        without.scene.surfaces[surface].material.restitution.for_ball(&without.plan.balls()[ball]).coefficient()
    };
    let bounces = |surface: &usize| c_r(*surface) > 0.0 && c_r(*surface) < 1.0;
    if after.outcome.motion != Motion::Resting || before.endings.is_empty() || !before.endings.iter().all(bounces) {
        return None;
    }
    let predicted = before.endings.iter().map(|surface| -logarithm(MORE_REST) / logarithm(c_r(*surface))).sum();
    let measured = after.outcome.counters.impacts as f64 - before.outcome.counters.impacts as f64;
    let reason = "impacts are whole, and between surfaces they do not follow one restitution";
    let apart = off(predicted, measured).then_some(reason);
    let told = Size { quantity: Quantity::Impacts, predicted, measured, apart };
    Some(finding(ball, before.way(before.seconds()), Some(("c_r", c_r(before.endings[0]))), vec![told]))
}
