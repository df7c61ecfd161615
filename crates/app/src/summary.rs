//! The summary of a run, for the eye and as JSON.

use carom_dynamics::counters::Counters;
use carom_dynamics::energy::EnergyBalance;
use carom_dynamics::events::{Ending, Motion, Outcome};
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_dynamics::surface::{Shape, Surface};
use carom_geometry::bounds::Aabb;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Duration;

/// What a run came to. As JSON all but `wall_seconds` is the same on every machine.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// How many balls there were.
    balls: usize,
    /// The scene's duration in s.
    duration: f64,
    /// The time simulated, in s, summed over the balls.
    ball_seconds: f64,
    /// Impacts answered; a simultaneous one at several surfaces counts once.
    impacts: u64,
    /// How many balls were at rest at the end.
    resting: usize,
    /// How many were sliding.
    sliding: usize,
    /// How many were rolling; left out where nothing spins.
    #[serde(skip_serializing_if = "Option::is_none")]
    rolling: Option<usize>,
    /// How many were flying.
    flying: usize,
    /// How many of the flying ones had not even the box of all surfaces before them, in the direction of gravity or, without it,
    /// of their velocity; null with an infinite plane or without surfaces.
    off_the_map: Option<usize>,
    /// The balls that a guard ended before the duration was over.
    ended_early: Vec<EndedEarly>,
    energy: Energy,
    /// What was evaluated.
    counters: BTreeMap<&'static str, u64>,
    /// How long the run took, in s; depends on the machine.
    wall_seconds: f64,
}

/// A ball that a guard ended.
#[derive(Debug, Serialize)]
struct EndedEarly {
    ball: usize,
    time: f64,
    ending: &'static str,
}

/// Kinetic and potential energy of all balls, potential counted from the lowest ball.
#[derive(Debug, Serialize)]
struct Energy {
    /// J, or J/kg if not all masses are known.
    unit: &'static str,
    start: f64,
    end: f64,
    /// Percent of the energy at the start that was gained (lost, if negative); null if there was none.
    change_percent: Option<f64>,
}

/// Adds up a run, ball by ball.
pub struct Tally<'a> {
    scene: &'a Scene,
    bounds: Option<Aabb>,
    masses_known: bool,
    energy: EnergyBalance,
    balls: usize,
    ball_seconds: f64,
    resting: usize,
    sliding: usize,
    rolling: usize,
    flying: usize,
    off_the_map: usize,
    ended_early: Vec<EndedEarly>,
    counters: Counters,
}

impl<'a> Tally<'a> {
    /// Of no balls yet.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            bounds: bounds(&scene.surfaces),
            masses_known: scene.balls.iter().all(|ball| ball.mass().is_some()),
            energy: EnergyBalance::new(scene.gravity),
            balls: 0,
            ball_seconds: 0.0,
            resting: 0,
            sliding: 0,
            rolling: 0,
            flying: 0,
            off_the_map: 0,
            ended_early: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// Adds the outcome of a ball.
    pub fn add(&mut self, ball: usize, outcome: &Outcome) {
        self.balls += 1;
        self.ball_seconds += outcome.time;
        self.counters += outcome.counters;
        match outcome.motion {
            Motion::Resting => self.resting += 1,
            Motion::Sliding => self.sliding += 1,
            Motion::Rolling => self.rolling += 1,
            Motion::Flying => self.flying += 1,
        }
        if let Some(bounds) = &self.bounds
            && outcome.motion == Motion::Flying
        {
            let heading = self.scene.gravity.map_or(outcome.state.velocity, |g| g.acceleration());
            self.off_the_map += usize::from(!bounds.is_ahead(&outcome.state.position, &heading));
        }
        if let Some(start) = self.scene.balls.get(ball) {
            let mass = start.mass().filter(|_| self.masses_known).unwrap_or(1.0);
            self.energy.add(mass, &start.start(), &outcome.state);
            if let Some(spin) = outcome.spin {
                self.energy.add_rotation(mass, start.inertia(), start.radius(), [start.spin(), spin]);
            }
        }
        let ending = match outcome.ending {
            Ending::Completed => return,
            Ending::EventBudget => "event_budget",
            Ending::UnresolvedContact => "unresolved_contact",
            Ending::UnstableStep => "unstable_step",
            Ending::StepBudget => "step_budget",
            Ending::Diverged => "diverged",
            _ => "other",
        };
        self.ended_early.push(EndedEarly { ball, time: outcome.time, ending });
    }

    /// The summary of a run that took `wall`.
    pub fn finish(self, wall: Duration) -> Summary {
        Summary {
            balls: self.balls,
            duration: self.scene.duration,
            ball_seconds: self.ball_seconds,
            impacts: self.counters.impacts,
            resting: self.resting,
            sliding: self.sliding,
            rolling: self.scene.spins().then_some(self.rolling),
            flying: self.flying,
            off_the_map: self.bounds.is_some().then_some(self.off_the_map),
            ended_early: self.ended_early,
            energy: Energy {
                unit: if self.masses_known { "J" } else { "J/kg" },
                start: self.energy.start(),
                end: self.energy.end(),
                change_percent: self.energy.change().map(|change| 100.0 * change),
            },
            counters: self.counters.named().into_iter().collect(),
            wall_seconds: wall.as_secs_f64(),
        }
    }
}

/// The box of all surfaces, if there are any and none is infinite.
fn bounds(surfaces: &[Surface]) -> Option<Aabb> {
    surfaces
        .iter()
        .map(|surface| match &surface.shape {
            Shape::Plane(_) => None,
            Shape::Polygon(polygon) => Some(Aabb::of_points(polygon.vertices())),
            Shape::Mesh(mesh) => Some(*mesh.bounds()),
        })
        .reduce(|a, b| a.zip(b).map(|(a, b)| a.union(&b)))
        .flatten()
}

/// How many balls a message names before it only counts the rest.
const NAMED: usize = 10;

impl Summary {
    /// As JSON, with a line end.
    pub fn json(&self) -> String {
        // Nothing in a summary can fail to be JSON: names are fixed, and a number that is not finite becomes null.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// The unit of its energies.
    pub fn energy_unit(&self) -> &'static str {
        self.energy.unit
    }

    /// What came of it, without what it cost: a few lines, the same on every machine.
    pub fn result(&self) -> Vec<String> {
        self.lines("")
    }

    /// For the eye: a few lines.
    pub fn text(&self) -> String {
        let mut lines = self.lines(&format!(", {:.3} s on the clock", self.wall_seconds));
        let work: Vec<String> =
            self.counters.iter().filter(|(_, n)| **n > 0).map(|(name, n)| format!("{name} {}", count(*n))).collect();
        lines.push(line("work", &work.join(", ")));
        lines.join("\n")
    }

    /// The lines of the result; `clock` goes behind the time simulated.
    fn lines(&self, clock: &str) -> Vec<String> {
        let off = match self.off_the_map {
            Some(n) if n > 0 => format!(" ({} of them off the map)", count(n as u64)),
            _ => String::new(),
        };
        let [resting, sliding, flying] = [self.resting, self.sliding, self.flying].map(|n| count(n as u64));
        let Energy { unit, start, end, change_percent } = &self.energy;
        let change = match change_percent {
            Some(change) if *change < 0.0 => format!(", {} % lost", percent(-change)),
            Some(change) if *change > 0.0 => format!(", {} % gained", percent(*change)),
            _ => String::new(),
        };
        let rolling = self.rolling.map_or_else(String::new, |n| format!("{} rolling, ", count(n as u64)));
        vec![
            line("balls", &count(self.balls as u64)),
            line("impacts", &count(self.impacts)),
            line("at end", &format!("{resting} resting, {sliding} sliding, {rolling}{flying} flying{off}")),
            line("time", &format!("{} s simulated{clock}", figure(self.duration))),
            line("energy", &format!("{} {unit} at start, {} {unit} at end{change}", figure(*start), figure(*end))),
        ]
    }

    /// What the guards ended, if anything.
    pub fn guarded(&self) -> Option<String> {
        let first = self.ended_early.first()?;
        let named = |e: &EndedEarly| format!("ball {} at {:?} s ({})", e.ball, e.time, e.ending.replace('_', " "));
        let list: Vec<String> = self.ended_early.iter().take(NAMED).map(named).collect();
        let more = self.ended_early.len().saturating_sub(list.len());
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        let noun = if self.ended_early.len() == 1 { "a ball was" } else { "balls were" };
        let help = match first.ending {
            "event_budget" => "; it bounced more often than the budget of events allows",
            _ => "",
        };
        Some(format!("{noun} ended by a guard before the duration was over: {}{rest}{help}", list.join(", ")))
    }
}

/// What is to be known of balls that are points where there are meshes; none if there is no such ball.
pub fn points_note(plan: &Plan) -> Option<String> {
    let (points, radius) = plan.points_at_meshes()?;
    let who = if points == 1 {
        "1 ball is a point and meets".to_owned()
    } else {
        format!("{points} balls are points and meet")
    };
    Some(format!("{who} polygons and meshes as a ball of {radius:.1e} m, to stay clear of rounding"))
}

/// A line of the summary.
pub fn line(name: &str, what: &str) -> String {
    format!("{name:<9} {what}")
}

/// A whole number in groups of three digits.
fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// Seven digits that count, with an exponent only where there would be more noughts than digits.
fn figure(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    if x == 0.0 || (1e-3..1e9).contains(&x.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// Two decimals, or the order of magnitude where they would say nothing.
fn percent(x: f64) -> String {
    if x < 0.005 { format!("{x:.1e}") } else { format!("{x:.2}") }
}
