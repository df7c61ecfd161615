//! Exact predicates against fixtures, the classic grid, and scales from 2^-1000 to 2^900.

use carom_geometry::inside::edge_determinant;
use carom_geometry::predicates::{Sign, Tier, orient2d, orient2d_with_tier, orient3d, orient3d_with_tier};
use carom_tests::data::{csv, number, read};
use carom_tests::nasty;
use nalgebra::{Point2, Point3};

fn sign(cell: &str) -> Sign {
    Sign::of(number(cell))
}

/// The rows of a fixture: id, `N` coordinates, sign.
fn fixture<const N: usize>(path: &str) -> Vec<([f64; N], Sign)> {
    let text = read(path);
    let rows: Vec<_> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .map(|line| {
            let cells: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(cells.len(), N + 2, "{line}");
            (std::array::from_fn(|i| number(cells[i + 1])), sign(cells[N + 1]))
        })
        .collect();
    assert_eq!(rows.len(), 1000, "{path}");
    rows
}

#[test]
fn r30_orient2d_fixtures() {
    for (c, expected) in fixture::<6>("geometry-cases/orient2d.txt") {
        let [a, b, d] = [Point2::new(c[0], c[1]), Point2::new(c[2], c[3]), Point2::new(c[4], c[5])];
        assert_eq!(orient2d(&a, &b, &d), expected, "{c:?}");
        assert_eq!(orient2d(&b, &a, &d), expected.reverse(), "{c:?} swapped");
    }
}

#[test]
fn r30_orient3d_fixtures() {
    for (c, expected) in fixture::<12>("geometry-cases/orient3d.txt") {
        let [a, b, d, e]: [Point3<f64>; 4] = std::array::from_fn(|i| Point3::new(c[3 * i], c[3 * i + 1], c[3 * i + 2]));
        // The fixtures count d below the plane as positive.
        assert_eq!(orient3d(&a, &b, &d, &e), expected.reverse(), "{c:?}");
        assert_eq!(orient3d(&a, &d, &b, &e), expected, "{c:?} swapped");
    }
}

/// The classic grid: p = (0.5 + i 2^-53, 0.5 + j 2^-53) against the line through (12, 12) and (24, 24).
fn grid() -> Vec<(Point2<f64>, Sign)> {
    let step = 2f64.powi(-53);
    csv("oracles/orient2d_grid.csv", "i,j,exact_sign,plain_f64_sign")
        .iter()
        .map(|row| (Point2::new(0.5 + number(&row[0]) * step, 0.5 + number(&row[1]) * step), sign(&row[2])))
        .collect()
}

#[test]
fn r44_classic_grid_is_right_on_all_points_and_plain_f64_wrong_on_1300() {
    let grid = grid();
    assert_eq!(grid.len(), 2304);
    let (q, r) = (Point2::new(12.0, 12.0), Point2::new(24.0, 24.0));
    let mut plain_wrong = 0;
    for (p, expected) in &grid {
        assert_eq!(orient2d(p, &q, &r), *expected, "{p:?}");
        plain_wrong += usize::from(Sign::of(edge_determinant(p, &q, &r)) != *expected);
    }
    assert_eq!(plain_wrong, 1300);
}

#[test]
fn r44_signs_do_not_change_with_scale_and_every_tier_is_used() {
    let (q, r) = (Point2::new(12.0, 12.0), Point2::new(24.0, 24.0));
    let mut tiers = [[0; 3]; 2];
    // Points of the grid, which the filter cannot decide, and one far off the line, which it can.
    let easy = (Point2::new(1.0, 3.0), Sign::Positive);
    for (p, expected) in grid().into_iter().step_by(7).chain([easy]) {
        for s in nasty::scales() {
            let [p, q, r] = [p, q, r].map(|p| p * s);
            let (sign, tier) = orient2d_with_tier(&p, &q, &r);
            assert_eq!(sign, expected, "{p:?} at scale {s:e}");
            tiers[0][tier as usize] += 1;
            // The same triangle stood upright, seen from beside it.
            let lift = |p: Point2<f64>| Point3::new(p.x, p.y, s);
            let (sign, tier) = orient3d_with_tier(&lift(p), &lift(q), &lift(r), &Point3::new(0.0, 0.0, 2.0 * s));
            assert_eq!(sign, expected, "{p:?} at scale {s:e}, in space");
            tiers[1][tier as usize] += 1;
        }
    }
    // One scale for all coordinates never needs rationals; mixed scales do.
    let (tiny, huge) = (2f64.powi(-1000), 2f64.powi(1000));
    let mixed = [Point2::new(tiny, 0.0), Point2::new(0.0, huge), Point2::new(tiny / 2.0, huge / 2.0)];
    for (dx, expected) in [(0, Sign::Zero), (1, Sign::Positive), (-1, Sign::Negative)] {
        let c = Point2::new(nasty::ulps(mixed[2].x, dx), mixed[2].y);
        let (sign, tier) = orient2d_with_tier(&mixed[0], &mixed[1], &c);
        // a -> b turns left; the left side is that of smaller x.
        assert_eq!(sign, expected.reverse());
        tiers[0][tier as usize] += 1;
        let lift = |p: Point2<f64>| Point3::new(p.x, p.y, 0.0);
        let (sign, tier) = orient3d_with_tier(&lift(mixed[0]), &lift(mixed[1]), &lift(c), &Point3::new(0.0, 0.0, 1.0));
        assert_eq!(sign, expected.reverse());
        tiers[1][tier as usize] += 1;
    }
    println!("decided by filter, expansions, rationals: orient2d {:?}, orient3d {:?}", tiers[0], tiers[1]);
    for counts in tiers {
        for tier in [Tier::Filter, Tier::Expansion, Tier::Rational] {
            assert!(counts[tier as usize] > 0, "{tier:?} was never used: {counts:?}");
        }
    }
}

#[test]
fn r30_neighbours_by_ulps_turn_as_rationals_say() {
    // With coordinates k/8 that are small integers the determinant of the unmoved points is exact in f64.
    let (a, b) = (Point2::new(0.0, 0.0), Point2::new(3.0, 1.0));
    let c = Point2::new(1.5, 0.5);
    for p in nasty::neighbours2(c, 3) {
        // 3 y - x, exact by hand: x = 1.5 + i 2^-52, y = 0.5 + j 2^-53 or 2^-54.
        let (dx, dy) = (p.x - c.x, p.y - c.y);
        assert_eq!(orient2d(&a, &b, &p), Sign::of(3.0 * dy - dx), "{p:?}");
    }
}
