//! The modelling thresholds, each with its unit, what follows from it, and what breaks if it changes.

use crate::error::{ValueError, require};
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::Vector3;

/// When bouncing ends and when a ball is at rest: the thresholds e1, e2, e3 of the chapter's rest test.
///
/// The fourth part of the test, |F_t| <= mu |F_n|, has no threshold of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RestThresholds {
    /// One length in m from which the others follow: a hop lower than this is no hop.
    Length(f64),
    /// The book's own: speed e1 in m/s, distance e2 in m, force per mass e3 in m/s^2.
    Book {
        /// e1 in m/s.
        speed: f64,
        /// e2 in m.
        distance: f64,
        /// e3 in m/s^2: how strongly the surface may be left and still count as pressed.
        force: f64,
    },
}

impl RestThresholds {
    /// One length in m, > 0.
    pub fn length(length: f64) -> Result<Self, ValueError> {
        require("rest length", length, "a finite length > 0 in m", length.is_finite() && length > 0.0).map(Self::Length)
    }

    /// The book's three thresholds, each finite and >= 0.
    pub fn book(speed: f64, distance: f64, force: f64) -> Result<Self, ValueError> {
        let ok = |x: f64| x.is_finite() && x >= 0.0;
        require("rest speed", speed, "finite and >= 0, in m/s", ok(speed))?;
        require("rest distance", distance, "finite and >= 0, in m", ok(distance))?;
        require("rest force", force, "finite and >= 0, in m/s^2", ok(force))?;
        Ok(Self::Book { speed, distance, force })
    }
}

/// e1, e2, e3 for a contact that is pressed with a given acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// e1 in m/s: a speed below it is none.
    pub speed: f64,
    /// e2 in m: a distance below it is contact.
    pub distance: f64,
    /// e3 in m/s^2: how strongly the force may still pull the ball off.
    pub force: f64,
}

impl RestThresholds {
    /// The three thresholds where the ball is pressed with the acceleration `pressed` >= 0 (m/s^2).
    ///
    /// From one length: e2 is the length, e1 = sqrt(2 a e2) the speed of a hop that high, e3 = 0. A larger length ends
    /// bouncing sooner, and the ball is misplaced by up to that length; a smaller one costs more bounces, their number growing
    /// with its logarithm.
    pub fn at(&self, pressed: f64) -> Thresholds {
        match *self {
            Self::Length(length) => Thresholds { speed: (2.0 * pressed * length).sqrt(), distance: length, force: 0.0 },
            Self::Book { speed, distance, force } => Thresholds { speed, distance, force },
        }
    }
}

/// Hops up to this many rest lengths are low.
const LOW_HOP: f64 = 256.0;

impl RestThresholds {
    /// The speed in m/s of a hop that is low where the ball is pressed with the acceleration `pressed` >= 0 (m/s^2).
    pub(crate) fn low_hop(&self, pressed: f64) -> f64 {
        match *self {
            Self::Length(length) => (2.0 * pressed * (LOW_HOP * length)).sqrt(),
            Self::Book { speed, .. } => speed,
        }
    }
}

/// The rest length of a scene that gives none, as a share of its extent: bouncing ends where a hop is this small beside the
/// scene. Of no consequence for the motion a person sees; a thousand times larger would show in a comparison to 9 digits.
const REST_SHARE: f64 = 1.0e-12;

/// What f64 resolves at a distance of 1 from the origin, generously: a hop must not drown in the rounding of its position.
const RESOLVED_SHARE: f64 = 16.0 * UNIT_ROUNDOFF;

/// The rest length in m of a scene that gives none: `extent` is the size of the scene, `farthest` its largest coordinate.
pub fn default_rest_length(extent: f64, farthest: f64) -> f64 {
    (REST_SHARE * extent).max(RESOLVED_SHARE * farthest)
}

/// The least hop in m that a method of steps `h` (s) resolves under an acceleration `a` (m/s^2): one that lasts two steps.
///
/// The explicit Euler method adds a h to the speed of each hop, so that its hops do not get lower than where c_r (v + a h) = v, which is
/// v = a h c_r / (1 - c_r): for c_r > 1/2 that is more than this, and the ball trembles for ever. No threshold ends it, because for c_r near 1 it would
/// end hops that are seen; a shorter step makes it smaller in proportion, and no other method does it.
pub fn least_hop(a: f64, h: f64) -> f64 {
    0.5 * a * h * h
}

/// Rates this small beside a speed are 0 by rounding.
pub fn rate_rounding(speed: f64) -> f64 {
    64.0 * UNIT_ROUNDOFF * speed
}

/// Distances this small are contact: the rounding of a position at distance `farthest` from the origin after moving `travelled`.
pub fn touch_distance(farthest: f64, travelled: f64) -> f64 {
    64.0 * UNIT_ROUNDOFF * (farthest + travelled)
}

/// How far beside what is touched in a plane a ball of `radius` may be (m), that is within `distance` (m) of touching it: a hypotenuse of both, less the
/// radius, is the distance.
pub fn touch_breadth(distance: f64, radius: f64) -> f64 {
    (distance * (2.0 * radius + distance)).sqrt()
}

/// How far the time of an impact may be off in s, whose clearance is known to `doubt` (m), at the speed `closing` >= 0 (m/s) and where the clearance
/// bends by at most `bend` (m/s^2).
///
/// In 2 `doubt` / `closing` the clearance changes by 2 `doubt`, less the bend's 2 `bend` (`doubt` / `closing`)^2, which is at most a quarter of a
/// doubt unless closing^2 < 8 bend doubt. That is a graze: there it takes 8 sqrt(`doubt` / `bend`), in which the bend alone makes 32 doubts and
/// the speed unmakes at most 8 sqrt(8) of them.
pub fn impact_time_bound(doubt: f64, closing: f64, bend: f64) -> f64 {
    if closing * closing >= 8.0 * bend * doubt { 2.0 * doubt / closing } else { 8.0 * (doubt / bend).sqrt() }
}

/// How much rounding may be of the products that are summed to a coefficient of the squared distance from an edge, of a path that leaves it: 16 units.
/// The parts across the edge are off by 4 units of the whole term, of which the square takes twice as many, and the sums up to 6.
pub const RETURN_ROUNDING: f64 = 16.0 * UNIT_ROUNDOFF;

/// How far the end of a stretch of sliding may be off in s, that ends after `seconds` as a speed over an acceleration, both of them lengths of vectors
/// or parts along one: 16 units.
pub fn stretch_bound(seconds: f64) -> f64 {
    16.0 * UNIT_ROUNDOFF * seconds
}

/// How far the sum of the times of a ball's flights may be off at time `now` (s), by rounding: 8 units.
pub fn clock_bound(now: f64) -> f64 {
    8.0 * UNIT_ROUNDOFF * now
}

/// The square of the angle (rad) by which normals may differ and still be one: a point that is within `tolerance` of a ball of
/// `radius` lies up to sqrt(2 radius tolerance) beside the point that is touched; four times that, squared.
pub fn merge_angle_squared(tolerance: f64, radius: f64) -> f64 {
    let rounding = 64.0 * UNIT_ROUNDOFF;
    if radius > 0.0 { (8.0 * tolerance / radius).max(rounding * rounding) } else { rounding * rounding }
}

/// Whether a velocity and an acceleration in contact are parallel to rounding, so that the path is straight.
pub fn parallel(a: &Vector3<f64>, v: &Vector3<f64>) -> bool {
    // Of unit vectors: a product of four small numbers would vanish in a small scene.
    match (a.try_normalize(0.0), v.try_normalize(0.0)) {
        (Some(a), Some(v)) => a.cross(&v).norm() <= 16.0 * UNIT_ROUNDOFF,
        _ => true,
    }
}

/// Error allowed per step of a sliding motion that has no closed form, relative to the motion.
pub const SLIDING_TOLERANCE: f64 = 1.0e-10;

/// The same around edges and vertices, where nothing need take energy: a hundred times more, and it would be seen to grow where a step is cut,
/// in its dense output.
pub const ROLLING_TOLERANCE: f64 = 1.0e-12;

/// Error allowed per step of the adaptive pair where the scene asks for no method: errors of micrometres in a throw of 100 m.
pub const FLIGHT_TOLERANCE: f64 = 1.0e-9;

/// The least tolerance the adaptive pair can be asked for: below it the error estimate is rounding.
pub const LEAST_TOLERANCE: f64 = 1.0e-15;

/// The tolerance of the adaptive pair where it is to follow a flight as well as f64 lets it.
pub const FINEST_TOLERANCE: f64 = 1.0e-14;

/// What a tolerance must be, in words: from [`LEAST_TOLERANCE`] to 1.
pub(crate) const TOLERANCE_RANGE: &str = "between 1e-15 and 1";

/// Less time than this, in s, is none for answers in a row at time `now` (s): 2^10 of the spacing of f64 there. In longer ones the ball gets on.
pub fn time_resolution(now: f64) -> f64 {
    2048.0 * UNIT_ROUNDOFF * now
}

/// Hops without time passing before bouncing ends: fewer than [`COLLAPSE_AFTER`], so that what is left of them is summed and not cut.
pub const PATIENCE_WITH_HOPS: u32 = COLLAPSE_AFTER / 2;

/// Low hops in a row before bouncing on an elastic surface ends beside one that takes energy. The ball lies on that one as on a rail: what it has
/// left at the elastic end of the rail is about what bouncing ends with anywhere, and nothing takes it.
pub const PATIENCE_WITH_LOW_HOPS: u32 = 256;

/// Contacts answered without time passing before they are taken to answer each other for ever, so that restitution has lost all that it can
/// lose. With fewer, what is left of the velocity might still be seen; the run would be ended at [`MAX_STANDSTILL`].
pub const COLLAPSE_AFTER: u32 = 128;

/// Contacts answered without time passing before the ball's simulation is ended as unresolved.
pub const MAX_STANDSTILL: u32 = 256;

/// Steps of one ball before its simulation is ended; a fixed timestep that needs more is refused. They take hours.
pub const STEP_BUDGET: u64 = 10_000_000_000;

/// Contacts answered without time passing before bouncing ends whatever the restitution: hops that f64 does not resolve in time are none.
pub const PATIENCE: u32 = 16;

/// Events of one ball before its simulation is ended: a ball that bounces for ever stops here.
pub const EVENT_BUDGET: u64 = 10_000_000;

/// 2^500: coordinates (m), speeds (m/s) and accelerations (m/s^2) of a scene are at most this, so that the square of a sum of them is a number.
pub const LARGEST: f64 = f64::from_bits((1023 + 500) << 52);

/// 2^511: a ball that gets farther (m) or faster (m/s) has left the range in which f64 can square a length, and its simulation is ended.
pub const FARTHEST: f64 = f64::from_bits((1023 + 511) << 52);

/// 2^-450: a scene with a mesh is at least this large (m), so that the squares of lengths, and of their roundings, are normal numbers.
pub const SMALLEST: f64 = f64::from_bits((1023 - 450) << 52);
