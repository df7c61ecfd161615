//! The independent checker on scene files: `checker SCENE...` runs every ball of each scene and verifies by brute force that it never comes
//! too near to a face, an edge or a vertex, nor gains energy, nor breaks a law of impact. It fails if one does.

use carom_dynamics::events::{Ending, EventKind};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
use carom_tests::checker::{Checker, Flaw};
use carom_tests::parallel;
use carom_tests::world::World;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

/// What came of one ball.
struct Checked {
    impacts: usize,
    worst: BTreeMap<Flaw, f64>,
    flaws: Vec<String>,
}

fn main() -> ExitCode {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    if paths.is_empty() {
        eprintln!("checker SCENE...");
        return ExitCode::from(2);
    }
    println!(
        "| scene | balls | impacts | nearest approach | energy | laws of impact | flaws |\n|---|--:|--:|--:|--:|--:|--:|"
    );
    let mut flaws = Vec::new();
    for path in &paths {
        match carom::read_scene(Path::new(path)) {
            Ok(scene) => flaws.extend(tell(path, &scene)),
            Err(error) => flaws.push(error),
        }
    }
    println!("\nThe worst of each kind as a part of what rounding may take; above 1 is a flaw.");
    for flaw in &flaws {
        println!("{flaw}");
    }
    if flaws.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs and checks the balls of a scene and prints their row; gives what is wrong.
fn tell(path: &str, scene: &Scene) -> Vec<String> {
    let plan = match Plan::new(scene) {
        Ok(plan) => plan,
        Err(error) => return vec![format!("{path}: {error}")],
    };
    let world = World::of(scene);
    let checked = parallel::map(plan.balls().len(), |i| check(scene, &plan, &world, i));
    let impacts: usize = checked.iter().map(|ball| ball.impacts).sum();
    let worst = |flaws: &[Flaw]| {
        let of = |ball: &Checked| flaws.iter().filter_map(|flaw| ball.worst.get(flaw).copied()).fold(0.0, f64::max);
        checked.iter().map(of).fold(0.0, f64::max)
    };
    let flaws: Vec<String> =
        checked.iter().flat_map(|ball| &ball.flaws).map(|flaw| format!("{path}: {flaw}")).collect();
    println!(
        "| {path} | {} | {impacts} | {:.3} | {:.3} | {:.3} | {} |",
        checked.len(),
        worst(&[Flaw::Penetration]),
        worst(&[Flaw::EnergyUp, Flaw::Conservation]),
        worst(&[Flaw::Restitution, Flaw::Friction]),
        flaws.len()
    );
    flaws
}

fn check(scene: &Scene, plan: &Plan, world: &World, i: usize) -> Checked {
    let ball = &plan.balls()[i];
    let mut run = Trajectory::default();
    let outcome = simulate(plan, ball, &mut run);
    let checker = Checker::run(world, scene, ball, &run, &outcome);
    let mut flaws: Vec<String> = checker
        .findings
        .iter()
        .map(|f| {
            format!("ball {i}: {:?} at t = {} s: {:e}, allowed {:e}: {}", f.flaw, f.time, f.amount, f.allowed, f.note)
        })
        .collect();
    if outcome.ending != Ending::Completed {
        flaws.push(format!("ball {i}: ended by {:?} at t = {} s", outcome.ending, outcome.time));
    }
    let impacts = run.events.iter().filter(|e| e.kind == EventKind::Impact).count();
    Checked { impacts, worst: checker.worst, flaws }
}
