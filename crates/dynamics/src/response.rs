//! Collision response: the velocity after an impact.
//!
//! At one surface it is the chapter's: v_n and v_t apart, v_n+ = -c_r v_n-, v_t+ by friction, v+ = v_n+ + v_t+. At several at
//! once it is Moreau's: p, the velocity nearest to v- that leaves none of them behind, takes the place of v_t, and what p adds
//! along each normal the place of v_n; for one surface that is the chapter's law to the letter. (J. J. Moreau, in *Nonsmooth
//! Mechanics and Applications*, 1988.) Where the surfaces differ in c_r, no more comes back than the greatest c_r of what came in.

use crate::contacts::{Contact, PerContact};
use crate::counters::Counters;
use crate::effects::friction::Friction;
use crate::support::{Projection, project};
use crate::surface::Material;
use crate::tolerance::rate_rounding;
use carom_geometry::bounds::amax;
use nalgebra::Vector3;

/// Repeats of the response before restitution is given up for what is left (H19: acute normals may close again).
const MAX_REPEATS: u32 = 32;

/// The velocity after an impact with velocity `v` (m/s), of which at least one of `contacts` is closing; leaves in each contact the
/// rate with which it separates. `material` is what a contact is made of.
pub fn respond<'m>(
    v: Vector3<f64>,
    contacts: &mut [Contact],
    material: impl Fn(&Contact) -> &'m Material,
    counters: &mut Counters,
) -> Vector3<f64> {
    let mut closing = contacts.iter().enumerate().filter(|(_, c)| c.rate < 0.0);
    let after = match (closing.next(), closing.next()) {
        (Some((hit, contact)), None) => {
            let material = material(contact);
            respond_to_one(v, contacts, hit, material, counters)
        }
        _ => None,
    };
    after.unwrap_or_else(|| {
        let materials: PerContact<Material> = contacts.iter().map(|c| *material(c)).collect();
        respond_to_all(v, contacts, &materials, counters)
    })
}

/// The chapter's response to the only closing contact, which is number `hit`; none if it drives the ball into another.
fn respond_to_one(
    v: Vector3<f64>,
    contacts: &mut [Contact],
    hit: usize,
    material: &Material,
    counters: &mut Counters,
) -> Option<Vector3<f64>> {
    let (n, closing) = (contacts[hit].normal, -contacts[hit].rate);
    let c_r = material.restitution.at(closing);
    // A rounded unit normal is off by the same u at each of a million bounces: divided by its square, it is not.
    let square = n.norm_squared();
    let v_t = v - n * (n.dot(&v) / square);
    let rebound = material.restitution.rebound(closing);
    let friction = &material.friction;
    let mut after = slowed(friction, v_t, closing, c_r, counters) + n * (rebound / square);
    // Rounding must not gain energy; nor lose it where nothing does.
    // In units of the largest component: squares of small speeds vanish.
    let unit = amax(&v);
    let (had, has) = ((v / unit).norm_squared(), (after / unit).norm_squared());
    if has > had || (c_r == 1.0 && *friction == Friction::None) {
        after *= (had / has).sqrt();
    }
    if contacts.len() > 1 {
        let drives = |(i, c): (usize, &Contact)| i != hit && changed_rate(c, &v, &after) < 0.0;
        if contacts.iter().enumerate().any(drives) {
            return None;
        }
        for contact in contacts.iter_mut() {
            contact.rate = changed_rate(contact, &v, &after);
        }
    }
    counters.restitution += 1;
    contacts[hit].rate = rebound;
    Some(after)
}

/// The rate of a contact after the velocity went from `before` to `after`: unchanged where the change has no part in it.
pub(crate) fn changed_rate(contact: &Contact, before: &Vector3<f64>, after: &Vector3<f64>) -> f64 {
    let change = contact.normal.dot(&(after - before));
    if change.abs() <= rate_rounding(before.norm()) { contact.rate } else { contact.rate + change }
}

/// Moreau's response to all contacts.
fn respond_to_all(
    v: Vector3<f64>,
    contacts: &mut [Contact],
    materials: &[Material],
    counters: &mut Counters,
) -> Vector3<f64> {
    let mut v = v;
    for repeat in 0..=MAX_REPEATS {
        let speed = v.norm();
        let normals: PerContact<_> = contacts.iter().map(|c| c.normal).collect();
        let projection = project(&v, &normals);
        let mut after = projection.velocity;
        for (i, impulse) in projection.loads() {
            let c_r = materials[i].restitution.at(impulse);
            after = slowed(&materials[i].friction, after, impulse, c_r, counters);
        }
        if repeat < MAX_REPEATS {
            after += rebound_of_all(&v, &projection, contacts, materials, counters);
        }
        // Rounding must not gain energy.
        let gained = after.norm();
        if gained > speed {
            after *= speed / gained;
        }
        v = after;
        let rounding = rate_rounding(speed);
        for contact in contacts.iter_mut() {
            let rate = contact.normal.dot(&v);
            contact.rate = if rate.abs() <= rounding { 0.0 } else { rate };
        }
        if contacts.iter().all(|c| c.rate >= 0.0) {
            return v;
        }
    }
    for contact in contacts.iter_mut() {
        contact.rate = contact.rate.max(0.0);
    }
    v
}

/// What comes back of the part of `v` that the `projection` takes from it: of each load the share c_r, along its normal.
///
/// It is no faster than the greatest of these shares of what was taken. Equal shares are that by themselves; of unequal ones in an acute groove, where the
/// loads all but cancel, the difference could be more than all that came in.
fn rebound_of_all(
    v: &Vector3<f64>,
    projection: &Projection,
    contacts: &[Contact],
    materials: &[Material],
    counters: &mut Counters,
) -> Vector3<f64> {
    let (mut rebound, mut share, mut largest) = (Vector3::zeros(), 0.0f64, 0.0f64);
    let lost = |i: usize| projection.loads().any(|(j, _)| i != j && collapse_in_between(i, j, contacts, materials));
    for (i, impulse) in projection.loads().filter(|(i, _)| !lost(*i)) {
        let restitution = &materials[i].restitution;
        counters.restitution += 1;
        rebound += contacts[i].normal * restitution.rebound(impulse);
        (share, largest) = (share.max(restitution.at(impulse)), largest.max(impulse));
    }
    let (speed, most) = (rebound.norm(), share * (v - projection.velocity).norm());
    if speed > most + rate_rounding(largest) { rebound * (most / speed) } else { rebound }
}

/// Whether a point between contacts `i` and `j` hits them without end, so that nothing comes back from the two together.
///
/// The velocity goes through the product of two maps 1 - (1 + c_r) n n^T, with determinant c_i c_j and trace (1 + c_i)(1 + c_j)
/// cos^2 - c_i - c_j across the edge; it turns round only if its eigenvalues are not real, that is unless
/// (1 + c_i)(1 + c_j) cos^2 >= (sqrt(c_i) + sqrt(c_j))^2. What hits both at once must do what its neighbours do, which hit one first.
fn collapse_in_between(i: usize, j: usize, contacts: &[Contact], materials: &[Material]) -> bool {
    let cos = -contacts[i].normal.dot(&contacts[j].normal);
    let [a, b] = [i, j].map(|k| materials[k].restitution.coefficient());
    let roots = a.sqrt() + b.sqrt();
    cos > 0.0 && a * b < 1.0 && (1.0 + a) * (1.0 + b) * cos * cos >= roots * roots
}

/// The velocity after infinitely many impacts in no time: with c_r < 1 they take all that Moreau's response can take, and leave p.
///
/// (Inelastic collapse: a point in a wedge narrower than cos(angle) = 2 sqrt(c_r) / (1 + c_r) hits its sides without end.)
pub fn collapse(v: Vector3<f64>, contacts: &mut [Contact]) -> Vector3<f64> {
    let normals: PerContact<_> = contacts.iter().map(|c| c.normal).collect();
    let after = project(&v, &normals).velocity;
    let rounding = rate_rounding(v.norm());
    for contact in contacts {
        let rate = contact.normal.dot(&after);
        contact.rate = if rate <= rounding { 0.0 } else { rate };
    }
    after
}

/// Friction, where there is any: a surface without it is not asked.
fn slowed(friction: &Friction, v_t: Vector3<f64>, closing: f64, c_r: f64, counters: &mut Counters) -> Vector3<f64> {
    if *friction == Friction::None {
        return v_t;
    }
    counters.friction += 1;
    friction.slow(v_t, closing, c_r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::restitution::Restitution;
    use carom_geometry::rounding::UNIT_ROUNDOFF;

    fn material(c_r: f64, friction: Friction) -> Material {
        Material { restitution: Restitution::new(c_r).unwrap(), friction }
    }

    fn contacts(v: &Vector3<f64>, normals: &[Vector3<f64>]) -> Vec<Contact> {
        normals.iter().map(|n| Contact { surface: 0, site: None, normal: *n, rate: n.dot(v), lasting: false }).collect()
    }

    fn answer(v: Vector3<f64>, normals: &[Vector3<f64>], m: Material) -> Vector3<f64> {
        let mut touched = contacts(&v, normals);
        respond(v, &mut touched, |_| &m, &mut Counters::default())
    }

    #[test]
    fn r16_normal_and_tangential_parts_are_answered_apart() {
        let n = Vector3::new(0.6, 0.0, 0.8);
        let v: Vector3<f64> = 3.0 * Vector3::y() - 2.0 * n;
        let after = answer(v, &[n], material(0.5, Friction::linear(0.5).unwrap()));
        assert!((after - Vector3::new(0.6, 1.5, 0.8)).norm() < 1e-15);
    }

    #[test]
    fn r17_the_normal_speed_is_reversed_and_reduced_by_c_r() {
        for c_r in [0.0, 0.25, 0.5, 1.0] {
            let after = answer(Vector3::new(1.0, 0.0, -4.0), &[Vector3::z()], material(c_r, Friction::None));
            assert_eq!(after, Vector3::new(1.0, 0.0, 4.0 * c_r));
        }
    }

    #[test]
    fn r33_in_a_groove_of_unequal_sides_nothing_is_gained_across_nor_lost_along() {
        let mut least = f64::INFINITY;
        for (angle, [a, b]) in
            (1..60).flat_map(|k| [[0.7, 0.9], [0.9, 0.7], [0.0, 1.0], [1.0, 0.5]].map(|c_r| (k, c_r)))
        {
            let (sin, cos) = (0.05 * f64::from(angle)).sin_cos();
            let normals = [Vector3::y(), Vector3::new(sin, -cos, 0.0)];
            let materials = [a, b].map(|c_r| material(c_r, Friction::None));
            let v = Vector3::new(-0.25, 0.0, 3.0);
            let mut touched = contacts(&v, &normals);
            // The first carries the ball, the second is hit.
            (touched[1].surface, touched[0].lasting) = (1, true);
            let after = respond(v, &mut touched, |c| &materials[c.surface], &mut Counters::default());
            assert!((after.z - 3.0).abs() <= 4.0 * UNIT_ROUNDOFF * 3.0, "{after} at {angle}, {a}, {b}");
            let kept = after.xy().norm() / 0.25;
            // In an acute groove all is taken that leads across; up a side that is not, what leads up it goes on.
            let most = if cos > 0.0 { a.max(b) } else { 1.0 };
            assert!(kept <= most * (1.0 + 64.0 * UNIT_ROUNDOFF), "{kept} at {angle}, {a}, {b}");
            least = least.min(kept);
        }
        assert!(least == 0.0, "collapse leaves nothing: {least}");
    }

    #[test]
    fn r25_the_answer_is_the_sum_of_both_parts() {
        let m = material(0.5, Friction::coulomb(0.25).unwrap());
        let after = answer(Vector3::new(3.0, 0.0, -4.0), &[Vector3::z()], m);
        assert_eq!(after, Vector3::new(2.0, 0.0, 2.0));
    }

    #[test]
    fn r12_a_corner_reverses_the_velocity_whatever_the_order() {
        let v = Vector3::new(-1.0, -2.0, -3.0);
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        for normals in [[x, y, z], [z, y, x], [y, x, z], [y, z, x], [z, x, y], [x, z, y]] {
            for c_r in [0.0, 0.5, 1.0] {
                assert_eq!(answer(v, &normals, material(c_r, Friction::None)), -c_r * v);
            }
        }
    }

    #[test]
    fn acute_corners_leave_nothing_closing_and_gain_no_energy() {
        let m = material(1.0, Friction::None);
        for k in 1..200 {
            let angle = f64::from(k) * 0.0157;
            let normals = [Vector3::z(), Vector3::new(angle.sin(), 0.0, angle.cos())];
            let v = Vector3::new(-1.0, 0.3, -1.0);
            let mut touched = contacts(&v, &normals);
            let after = respond(v, &mut touched, |_| &m, &mut Counters::default());
            assert!(after.norm() <= v.norm() * (1.0 + 4.0 * UNIT_ROUNDOFF));
            assert!(touched.iter().all(|c| c.rate >= 0.0));
            assert!(normals.iter().all(|n| n.dot(&after) >= -1e-14), "{k}");
        }
    }

    #[test]
    fn two_surfaces_collapse_in_a_wedge_narrower_than_their_restitutions_allow() {
        // cos^2 >= (sqrt(a) + sqrt(b))^2 / ((1 + a)(1 + b)): for 1/4 and 1/4 from 0.8 on, for 1/25 and 9/25 from 0.672...
        let of_two = |a: f64, b: f64, cos: f64| {
            let normals = [Vector3::z(), Vector3::new((1.0 - cos * cos).sqrt(), 0.0, -cos)];
            let (touched, materials) =
                (contacts(&Vector3::zeros(), &normals), [a, b].map(|c| material(c, Friction::None)));
            let [there, back] = [(0, 1), (1, 0)].map(|(i, j)| collapse_in_between(i, j, &touched, &materials));
            assert_eq!(there, back);
            there
        };
        for (a, b, least) in
            [(0.25, 0.25, 0.8), (0.04, 0.36, 0.8 / 1.4144f64.sqrt()), (0.0, 0.0, 0.0), (0.0, 1.0, 0.5f64.sqrt())]
        {
            assert!(of_two(a, b, least + 0.01), "{a} and {b}");
            assert!(!of_two(a, b, least - 0.01) && !of_two(a, b, -least - 0.01), "{a} and {b}");
        }
        assert!(!of_two(1.0, 1.0, 1.0), "nothing is lost between two perfect walls");
    }

    #[test]
    fn a_contact_that_is_not_hit_changes_no_bit_of_the_answer() {
        let (n, idle) = (Vector3::new(0.6, 0.0, 0.8), Vector3::y());
        for k in 1..50 {
            let v = Vector3::new(0.1 * f64::from(k), 0.0, -0.7);
            // Along the idle one, and off it.
            for v in [v, v + idle * 0.3] {
                for (c_r, friction) in [(0.3, Friction::coulomb(0.2).unwrap()), (1.0, Friction::None)] {
                    let m = material(c_r, friction);
                    let of = |normals: &[Vector3<f64>]| {
                        let (mut touched, mut counters) = (contacts(&v, normals), Counters::default());
                        let after = respond(v, &mut touched, |_| &m, &mut counters);
                        (after, counters, touched)
                    };
                    let (alone, counters, touched) = of(&[n]);
                    let frictions = u64::from(friction != Friction::None);
                    let closes = n.dot(&v) < 0.0;
                    if !closes {
                        continue;
                    }
                    assert_eq!((counters.restitution, counters.friction), (1, frictions));
                    for (normals, hit) in [([n, idle], 0), ([idle, n], 1)] {
                        let (after, too, beside) = of(&normals);
                        assert_eq!((after, too, beside[hit].rate), (alone, counters, touched[0].rate), "{v} at {n}");
                        // Where friction slows what leaves the idle one, that is left more slowly.
                        assert!((beside[1 - hit].rate - idle.dot(&after)).abs() <= 2.0 * rate_rounding(v.norm()));
                    }
                }
            }
        }
    }

    #[test]
    fn a_normal_that_is_not_of_unit_length_reflects_none_the_less() {
        let n = Vector3::new(0.6, 0.0, 0.8);
        let v = Vector3::new(0.3, -0.2, -0.9);
        for c_r in [0.0, 0.5, 1.0] {
            let exact = v - n * ((1.0 + c_r) * n.dot(&v));
            for length in [1.0 - 0.5f64.powi(8), 1.0, 1.0 + 0.5f64.powi(8)] {
                let after = answer(v, &[n * length], material(c_r, Friction::None));
                assert!((after - exact).norm() <= 8.0 * UNIT_ROUNDOFF, "{c_r}, {length}: {after}");
            }
        }
    }

    #[test]
    fn what_collapses_keeps_what_no_wall_can_take() {
        // Between walls that are open by arccos 0.96, with c_r = 1/4 (from 0.8 on it collapses), and by arccos 0.6.
        let wedge = |cos: f64| [Vector3::z(), Vector3::new((1.0 - cos * cos).sqrt(), 0.0, -cos)];
        let v = Vector3::new(-1.0, 0.3, -0.125);
        let m = material(0.25, Friction::None);
        assert!((answer(v, &wedge(0.96), m) - Vector3::y() * 0.3).norm() <= 8.0 * UNIT_ROUNDOFF);
        assert!((answer(v, &wedge(0.6), m) - Vector3::y() * 0.3).norm() > 0.1);
        // And by the other way, after impacts without end: nothing of what closes, all of what leaves.
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut touched = contacts(&v, &[x, y, z]);
        assert_eq!(collapse(v, &mut touched), y * 0.3);
        assert_eq!(touched.iter().map(|c| c.rate).collect::<Vec<_>>(), [0.0, 0.3, 0.0]);
    }

    #[test]
    fn the_most_acute_of_elastic_corners_gain_no_energy() {
        let m = material(1.0, Friction::None);
        for k in 4..40 {
            // Walls at an angle of 0.7 2^-k: what they push with is as much larger than what they stop, and its rounding with it.
            let sin = 0.7 * 0.5f64.powi(k);
            let normals = [Vector3::z(), Vector3::new(sin, 0.0, -(1.0 - sin * sin).sqrt())];
            for j in 1..20 {
                let v = Vector3::new(-1.0, 0.3, -0.05 * f64::from(j) * sin);
                let mut touched = contacts(&v, &normals);
                assert!(touched.iter().all(|c| c.rate < 0.0));
                let after = respond(v, &mut touched, |_| &m, &mut Counters::default());
                assert!(after.norm() <= v.norm() * (1.0 + 4.0 * UNIT_ROUNDOFF), "{k}, {j}: {after}");
                assert!(touched.iter().all(|c| c.rate >= 0.0));
            }
        }
    }
}
