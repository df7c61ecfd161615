//! What `explain` predicts and measures, against the rules of thumb, closed forms, and runs of the test's own.

use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::grip::Grip;
use carom_dynamics::effects::magnus::Magnus;
use carom_dynamics::explain::choice::choose;
use carom_dynamics::explain::effect::Effect;
use carom_dynamics::explain::{Finding, Quantity, explain};
use carom_tests::oracle::{Table, Worst};
use carom_tests::stage::{Stage, coulomb, rough, smooth};
use nalgebra::Vector3;

/// What is found of one effect of a scene.
#[track_caller]
fn found(stage: &Stage, effect: Effect) -> Finding {
    let explanation = explain(&stage.0).unwrap_or_else(|e| panic!("{e}"));
    explanation.entry(effect).finding.clone().unwrap_or_else(|why| panic!("{effect:?}: {why}"))
}

#[track_caller]
fn size(finding: &Finding, quantity: Quantity) -> (f64, f64) {
    let size = finding.size(quantity).unwrap_or_else(|| panic!("no {quantity:?} in {finding:?}"));
    (size.predicted, size.measured)
}

#[test]
fn a_fall_in_air_takes_gh_6vt2_longer_and_ends_gh_2vt2_slower() {
    let (mut rules, mut runs) = (Worst::of("prediction"), Worst::of("measured by two runs"));
    let table = Table::read("criteria_check");
    let mut small = 0;
    for row in table.rows() {
        let [m, d, c, h] = row.numbers(["m", "diameter", "Cd", "drop_H"]);
        let stage = Stage::new(30.0).down(9.81).drag(Drag::quadratic(c, 1.2).unwrap()).floor(smooth(0.0));
        let stage = stage.thing([0.0, 0.0, h + 0.5 * d], [0.0; 3], 0.5 * d, Some(m));
        let finding = found(&stage, Effect::Drag);
        let place = || format!("{} from {h} m", row.text("ball"));
        for (quantity, rule, exact) in [
            (Quantity::FlightTime, "criterion_x_over_6", "exact_rel_dt"),
            (Quantity::ImpactSpeed, "criterion_minus_x_over_2", "exact_rel_dv_impact"),
        ] {
            let (predicted, measured) = size(&finding, quantity);
            rules.see(predicted, row.number(rule), 1e-9 * predicted.abs(), place);
            runs.see(measured, row.number(exact), 1e-8, place);
        }
        // The rule is within 15 % as long as g H / vt^2 is below about 0.5, and where it is not, that is said.
        let apart = finding.sizes.iter().filter(|s| s.apart.is_some()).count();
        let off = finding.sizes.iter().filter(|s| (s.predicted - s.measured).abs() > 0.15 * s.measured.abs()).count();
        assert_eq!(apart, off, "{}", place());
        small += usize::from(off == 0);
    }
    assert!(small > 30, "{small}");
    Worst::settle_all([rules, runs]);
}

/// A ball thrown at a wall, along x and without gravity: 20 m, with the drag length l = 2 m / (rho C A).
fn throw(wind: [f64; 3]) -> (Stage, f64) {
    let (r, m, c, rho) = (0.1, 0.5, 0.01, 1.2);
    let drag = Drag::quadratic(c, rho).unwrap().in_wind(wind.into()).unwrap();
    let stage = Stage::new(4.0).drag(drag).plane("wall", smooth(0.5), [20.0 + r, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let length = 2.0 * m / (rho * c * std::f64::consts::PI * r * r);
    (stage.thing([0.0; 3], [10.0, 0.0, 0.0], r, Some(m)), length)
}

#[test]
fn a_throw_ends_s_over_l_slower() {
    let (stage, l) = throw([0.0; 3]);
    let (predicted, measured) = size(&found(&stage, Effect::Drag), Quantity::ImpactSpeed);
    assert!((predicted + 20.0 / l).abs() < 1e-12, "{predicted}");
    assert!((measured - (-20.0 / l).exp_m1()).abs() < 1e-9, "{measured}");
}

#[test]
fn a_wind_across_blows_a_throw_aside_by_w_v_s_2l() {
    let (stage, l) = throw([0.0, 0.5, 0.0]);
    let (predicted, measured) = size(&found(&stage, Effect::Wind), Quantity::Landing);
    let rule = 0.5 / 10.0 * 20.0 / (2.0 * l) * 20.0;
    assert!(
        (predicted / rule - 1.0).abs() < 0.01 && (measured / rule - 1.0).abs() < 0.02,
        "{predicted} {measured} {rule}"
    );
}

#[test]
fn the_magnus_force_lifts_a_throw_by_cl_c_s_2l() {
    let (stage, l) = throw([0.0; 3]);
    let (c, r, spin) = (0.01, 0.1, 5.0);
    let lift = 1.0 * r * spin / 10.0;
    let stage = stage.magnus(Magnus::new(1.0, 1.2).unwrap()).spinning([0.0, -spin, 0.0]);
    let (predicted, measured) = size(&found(&stage, Effect::Magnus), Quantity::Landing);
    let rule = lift / c * 20.0 / (2.0 * l) * 20.0;
    assert!(
        (predicted / rule - 1.0).abs() < 0.01 && (measured / rule - 1.0).abs() < 0.02,
        "{predicted} {measured} {rule}"
    );
}

#[test]
fn buoyancy_makes_a_fall_three_quarters_of_rho_v_over_m_longer() {
    let (r, m) = (0.11, 0.43);
    let stage = Stage::new(3.0).down(9.81).floor(smooth(0.5)).thing([0.0, 0.0, 2.0], [0.0; 3], r, Some(m));
    let (predicted, measured) = size(&found(&stage, Effect::Buoyancy), Quantity::FlightTime);
    let share = 1.204 * 4.0 / 3.0 * std::f64::consts::PI * r * r * r / m;
    // g (1 - b) / (1 + b / 2): to first order g (1 - 3 b / 2), and its inverse square root for the time.
    let exact = ((1.0 + 0.5 * share) / (1.0 - share)).sqrt() - 1.0;
    assert!((measured - exact).abs() < 1e-12, "{measured} {exact}");
    assert!((predicted / (0.75 * share) - 1.0).abs() < 0.02, "{predicted} {}", 0.75 * share);
}

#[test]
fn the_laws_of_friction_differ_by_one_plus_c_r() {
    let stage = Stage::new(3.0).down(9.81).floor(rough(0.6, coulomb(0.1)));
    let stage = stage.ball([0.0, 0.0, 1.1], [8.0, 0.0, 0.0], 0.1);
    let friction = size(&found(&stage, Effect::Friction), Quantity::TangentialSpeed);
    let law = size(&found(&stage, Effect::ImpulseFriction), Quantity::TangentialSpeed);
    for (book, more) in [(friction.0, law.0), (friction.1, law.1)] {
        assert!(((book + more) / book - 1.6).abs() < 1e-12, "{book} {more}");
    }
}

/// A tennis ball that falls 2.54 m, with its drag coefficient.
fn tennis() -> Stage {
    let mut stage =
        Stage::new(3.0).down(9.81).floor(smooth(0.75)).thing([0.0, 0.0, 2.5735], [0.0; 3], 0.0335, Some(0.0577));
    stage.0.balls[0] = stage.0.balls[0].with_drag(0.55).unwrap();
    stage
}

#[test]
fn what_is_called_for_changes_exactly_what_was_announced_when_it_is_put_in_or_taken_out() {
    let off = tennis();
    let explanation = explain(&off.0).unwrap();
    let called: Vec<Effect> = explanation.called_for(0.01).iter().map(|entry| entry.effect).collect();
    assert_eq!(called, [Effect::Drag], "it would land 2.5 % slower");
    let announced = found(&off, Effect::Drag);
    let on = tennis().drag(Drag::of_ball(1.204).unwrap());
    let taken_out = found(&on, Effect::Drag);
    // By runs of the test's own.
    let (before, after) = (off.run().impacts()[0], on.run().impacts()[0]);
    let speed = |v: Vector3<f64>| v.norm();
    let time = (after.time - before.time) / before.time;
    let slower = (speed(after.velocity_in) - speed(before.velocity_in)) / speed(before.velocity_in);
    for finding in [&announced, &taken_out] {
        assert_eq!((size(finding, Quantity::FlightTime).1, size(finding, Quantity::ImpactSpeed).1), (time, slower));
        assert!(finding.sizes.iter().all(|size| size.apart.is_none()));
    }
    assert!((time - 0.0086).abs() < 0.0001 && (slower + 0.0251).abs() < 0.0001, "{time} {slower}");
    assert!(explain(&on.0).unwrap().called_for(0.01).is_empty());
}

#[test]
fn an_effect_that_cannot_be_told_says_why() {
    let stage = Stage::new(1.0).down(9.81).ball([0.0; 3], [1.0, 0.0, 0.0], 0.1);
    let explanation = explain(&stage.0).unwrap();
    for effect in [Effect::Drag, Effect::Buoyancy, Effect::Wind, Effect::Magnus, Effect::Friction, Effect::Rest] {
        let entry = explanation.entry(effect);
        assert!(!entry.on && entry.finding.as_ref().is_err_and(|why| !why.is_empty()), "{effect:?}");
    }
}

/// The share by which the first impacts of two scenes with one ball differ: in time, in speed, or in place over the way.
fn differ(a: &Stage, b: &Stage, way: f64) -> f64 {
    let (a, b) = (a.run().impacts()[0], b.run().impacts()[0]);
    let speed = |v: Vector3<f64>| v.norm();
    let time = (a.time - b.time).abs() / a.time;
    let speeds = (speed(a.velocity_in) - speed(b.velocity_in)).abs() / speed(a.velocity_in);
    time.max(speeds).max((a.position - b.position).norm() / way)
}

#[test]
fn the_effects_that_are_chosen_are_those_that_matter_and_what_is_left_out_costs_no_more_than_asked() {
    for (tolerance, kept) in [(0.05, vec![]), (0.01, vec![Effect::Drag]), (0.001, vec![Effect::Drag, Effect::Buoyancy])]
    {
        let choice = choose(&tennis().0, tolerance).unwrap();
        assert_eq!(choice.kept.iter().map(|(effect, _)| *effect).collect::<Vec<_>>(), kept, "{tolerance}");
        assert!(choice.price <= tolerance && choice.kept.iter().all(|(_, share)| *share > tolerance), "{choice:?}");
        let all = tennis().drag(Drag::of_ball(1.204).unwrap()).buoyancy(1.204);
        let chosen = Stage(choice.scene.clone());
        // The measured price is that of runs of the test's own.
        assert!((differ(&chosen, &all, 2.54) - choice.price).abs() < 1e-12, "{tolerance}: {}", choice.price);
        // And what is left out is not even asked.
        assert_eq!(chosen.run().outcome.counters.drag > 0, kept.contains(&Effect::Drag));
        assert!(choice.runs > 0 && choice.work.paths > 0);
    }
    let exact = Stage(choose(&tennis().0, 0.05).unwrap().scene).run();
    assert!(exact.trajectory == tennis().run().trajectory, "to the bit the scene without");
}

#[test]
fn grip_is_told_by_the_slip_of_the_first_impact() {
    for (speed, spin) in [(1.0, 0.0), (12.0, 0.0), (6.0, 150.0), (6.0, -150.0)] {
        let stage = Stage::new(2.0).down(9.81).floor(rough(0.7, coulomb(0.3)));
        let stage = stage.thing([0.0, 0.0, 1.0], [speed, 0.0, 0.0], 0.033, Some(0.058)).spinning([0.0, spin, 0.0]);
        let finding = found(&stage, Effect::Grip);
        let (predicted, measured) = size(&finding, Quantity::TangentialSpeed);
        assert!((predicted - measured).abs() < 1e-12 && finding.sizes[0].apart.is_none(), "{predicted} {measured}");
        assert!(measured.abs() > 0.01, "{speed} {spin}: {measured}");
    }
}

#[test]
fn rolling_resistance_is_told_by_c_rr_g_over_1_plus_alpha() {
    let grip = Grip::new(0.5).and_then(|grip| grip.with_rolling(0.02)).unwrap();
    let stage = Stage::new(1.0).down(9.81).floor(rough(0.5, Friction::Grip(grip)));
    let stage = stage.thing([0.0, 0.0, 0.1], [3.0, 0.0, 0.0], 0.1, None);
    let (predicted, measured) = size(&found(&stage, Effect::Rolling), Quantity::RollingSpeed);
    assert!(predicted < -0.03 && (predicted - measured).abs() < 1e-12, "{predicted} {measured}");
}
