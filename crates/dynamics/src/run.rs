//! Many balls on all cores: the same bytes for any number of threads.

use crate::body::Ball;
use crate::events::Outcome;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::simulate::simulate;
use carom_geometry::bounds::Aabb;
use nalgebra::Point3;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use thiserror::Error;

/// Balls simulated before their results are handed on, for each thread: what bounds the memory. Among as many there are neighbours,
/// which meet the same part of a mesh while it is in the cache.
const BALLS_IN_FLIGHT: usize = 4096;

/// Balls that a thread takes at a time: enough to forget what taking them costs, few enough that no thread waits long for another.
const BALLS_AT_A_TIME: usize = 8;

/// The threads could not be started.
#[derive(Debug, Error)]
#[error("cannot start {threads} threads: {reason}")]
pub struct ThreadsError {
    /// How many were asked for.
    pub threads: usize,
    /// What the system says.
    pub reason: String,
}

/// Simulates every ball of `plan` on `threads` threads (all cores if none). `make` gives the observer of a ball by its
/// index; `sink` takes each back with the ball's outcome, on the calling thread and in the order of the balls, and may break
/// off; the threads go on with the next balls meanwhile. No more than some thousand balls a thread are in memory at once.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::observer::FrameSampler;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::run::run_balls;
/// use std::ops::ControlFlow;
///
/// // Four frames a second of every ball, on all cores, in the order of the balls.
/// let plan = Plan::new(&scene)?;
/// let mut heights = Vec::new();
/// run_balls(&plan, None, |_| FrameSampler::new(4.0, plan.duration()), |_ball, sampler, _outcome| {
///     heights.extend(sampler.frames().iter().map(|frame| frame.state.position.z));
///     ControlFlow::Continue(())
/// })?;
/// assert_eq!(heights[..5], [4.0, 3.75, 3.0, 1.75, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_balls<O: Observer + Send>(
    plan: &Plan,
    threads: Option<usize>,
    make: impl Fn(usize) -> O + Sync,
    mut sink: impl FnMut(usize, O, Outcome) -> ControlFlow<()>,
) -> Result<(), ThreadsError> {
    let wanted = threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted)
        .build()
        .map_err(|e| ThreadsError { threads: wanted, reason: e.to_string() })?;
    let chunk = BALLS_IN_FLIGHT * pool.current_num_threads();
    let stopped = AtomicBool::new(false);
    let all_of = |first: usize, balls: &[Ball]| {
        let order = neighbours_together(balls);
        let one = |&i: &usize| {
            let mut observer = make(first + i);
            let outcome = simulate(plan, &balls[i], &mut observer);
            (first + i, observer, outcome)
        };
        let still = |_: &&usize| !stopped.load(Ordering::Relaxed);
        let in_order = order.par_chunks(BALLS_AT_A_TIME);
        let mut results: Vec<(usize, O, Outcome)> =
            pool.install(|| in_order.flat_map_iter(|some| some.iter().filter(still).map(one)).collect());
        results.sort_unstable_by_key(|(i, ..)| *i);
        results
    };
    std::thread::scope(|scope| {
        // One chunk is handed on while the next is made, and no more.
        let (hand_on, made) = sync_channel(0);
        scope.spawn(move || {
            for (k, balls) in plan.balls().chunks(chunk).enumerate() {
                if hand_on.send(all_of(k * chunk, balls)).is_err() {
                    return;
                }
            }
        });
        for (i, observer, outcome) in made.into_iter().flatten() {
            if sink(i, observer, outcome).is_break() {
                stopped.store(true, Ordering::Relaxed);
                return;
            }
        }
    });
    Ok(())
}

/// The balls' numbers in the order of a curve through their starts that fills space (G. M. Morton, 1966).
fn neighbours_together(balls: &[Ball]) -> Vec<usize> {
    let starts: Vec<Point3<f64>> = balls.iter().map(|ball| ball.start().position).collect();
    let bounds = Aabb::of_points(&starts);
    let (corner, size) = (*bounds.min(), bounds.extent().amax());
    // A cell is of no consequence but for speed: what is not a number is 0.
    let cell = |x: f64| (x / size * CELLS) as u64;
    let mut order: Vec<(u64, usize)> = starts
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let [x, y, z] = [0, 1, 2].map(|axis| spread(cell(p[axis] - corner[axis])));
            (x | y << 1 | z << 2, i)
        })
        .collect();
    order.sort_unstable();
    order.into_iter().map(|(_, i)| i).collect()
}

/// Cells along a side of the box of all starts: 2^20.
const CELLS: f64 = 1048576.0;

/// The 21 lower bits, three places apart.
fn spread(x: u64) -> u64 {
    let x = x & 0x1f_ffff;
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn bits_are_spread_three_places_apart() {
        for k in 0..21 {
            assert_eq!(spread(1 << k), 1 << (3 * k));
        }
    }

    #[test]
    fn neighbours_are_together_and_nobody_is_lost() {
        let at = |x: f64, y: f64| Ball::new(Point3::new(x, y, 0.0), Vector3::zeros(), 0.1, None).unwrap();
        let order = neighbours_together(&[at(0.0, 0.0), at(9.0, 9.0), at(0.1, 0.0), at(9.0, 8.9), at(0.0, 0.0)]);
        assert_eq!(order, [0, 4, 2, 3, 1]);
        assert_eq!(neighbours_together(&[at(1.0, 1.0), at(1.0, 1.0)]), [0, 1]);
    }
}
