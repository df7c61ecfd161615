//! A ball in someone's game loop: the flight is known ahead, frames only read it off, and a kick begins a new one.
//!
//! `cargo run -p carom-dynamics --example game_loop`

use carom_dynamics::body::{Ball, State};
use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
use carom_dynamics::error::SceneError;
use carom_dynamics::events::Motion;
use carom_dynamics::geometry::plane::Plane;
use carom_dynamics::nalgebra::{Point3, Vector3};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use std::error::Error;

/// How far ahead a flight is computed, in s.
const AHEAD: f64 = 20.0;

/// A ball that a game asks where it is.
struct GameBall {
    scene: Scene,
    flight: Trajectory,
    /// The game's time at which the flight begins, in s.
    since: f64,
}

impl GameBall {
    fn new(surfaces: Vec<Surface>, ball: Ball) -> Result<Self, Box<dyn Error>> {
        let gravity = Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81))?);
        let scene = Scene { gravity, surfaces, balls: vec![ball], ..Scene::lasting(AHEAD) };
        let mut ball = Self { scene, flight: Trajectory::default(), since: 0.0 };
        ball.predict()?;
        Ok(ball)
    }

    /// Computes the flight of the ball as it is.
    fn predict(&mut self) -> Result<(), SceneError> {
        let plan = Plan::new(&self.scene)?;
        self.flight = Trajectory::default();
        simulate(&plan, &plan.balls()[0], &mut self.flight);
        Ok(())
    }

    /// Where it is at the game's time `now`, however long the frame was; at the end of the prediction it stays where it is.
    fn at(&self, now: f64) -> (State, Motion) {
        let start = (self.scene.balls[0].start(), Motion::Flying);
        self.flight.at((now - self.since).clamp(0.0, AHEAD)).unwrap_or(start)
    }

    /// The impacts since the last frame: each makes a sound, as loud as it was fast.
    fn impacts(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let within = move |time: f64| time > from - self.since && time <= to - self.since;
        let loud = |event: &carom_dynamics::events::Event| -event.normal.dot(&event.velocity_in);
        self.flight.events.iter().filter(move |event| within(event.time)).map(loud).filter(|loud| *loud > 0.0)
    }

    /// Somebody kicks it: it gets `kick` m/s more, and a new flight.
    fn kick(&mut self, now: f64, kick: Vector3<f64>) -> Result<(), Box<dyn Error>> {
        let (state, _) = self.at(now);
        let radius = self.scene.balls[0].radius();
        self.scene.balls[0] = Ball::new(state.position, state.velocity + kick, radius, None)?;
        self.since = now;
        Ok(self.predict()?)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let grass = Material { restitution: Restitution::new(0.7)?, friction: Friction::coulomb(0.4)? };
    let ground = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
    let field = Surface { name: "field".into(), material: grass, shape: Shape::Plane(ground) };
    let start = Ball::new(Point3::new(0.0, 0.0, 0.11), Vector3::zeros(), 0.11, None)?;
    let mut ball = GameBall::new(vec![field], start)?;
    ball.kick(0.0, Vector3::new(8.0, 0.0, 6.0))?;

    // The loop of the game. Frames are as long as they happen to be, which changes nothing about where the ball flies.
    let (mut now, mut sounds, mut kicked) = (0.0, 0, false);
    for frame in 0_u32.. {
        let before = now;
        now += if frame % 7 == 0 { 0.050 } else { 0.016 };
        for speed in ball.impacts(before, now) {
            sounds += 1;
            if speed > 1.0 {
                println!("{now:6.3} s  thump, {speed:.1} m/s");
            }
        }
        let (state, motion) = ball.at(now);
        assert!(state.position.z >= 0.11 - 1e-12, "never into the ground");
        if !kicked && state.position.x > 15.0 {
            kicked = true;
            println!("{now:6.3} s  kicked back from x = {:.1} m", state.position.x);
            ball.kick(now, Vector3::new(-14.0, 2.0, 5.0))?;
        } else if motion == Motion::Resting {
            println!(
                "{now:6.3} s  rests at x = {:.1} m, y = {:.1} m after {sounds} impacts",
                state.position.x, state.position.y
            );
            break;
        }
    }
    assert!(kicked && sounds > 10);
    Ok(())
}
