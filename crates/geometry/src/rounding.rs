//! Rounding bounds as formulas in the unit roundoff: every allowance for rounding in this crate has its home here.

/// u = 2^-53: fl(x op y) = (x op y)(1 + d) with |d| <= u, for + - * / and sqrt without underflow.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// 2^-1074, the spacing of the subnormal numbers; a product that underflows is off by half of it at most, sums by nothing.
const SUBNORMAL_SPACING: f64 = f64::from_bits(1);

/// gamma(n) = n u / (1 - n u): n roundings in a row change a result by this factor at most (Higham 2002, lemma 3.1).
pub const fn gamma(n: u32) -> f64 {
    n as f64 * UNIT_ROUNDOFF / (1.0 - n as f64 * UNIT_ROUNDOFF)
}

/// Bound on the error of det = fl(left - right), where left and right are products of two coordinate differences each and
/// `magnitude` = fl(|left| + |right|).
///
/// (3 + 16 u) u covers the three roundings of each product and those of this bound (Shewchuk 1997, figure 21); each of the two
/// products may underflow, which adds a spacing; two are given.
pub fn orient2d_bound(magnitude: f64) -> f64 {
    (3.0 + 16.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF * magnitude + 2.0 * SUBNORMAL_SPACING
}

/// Bound on the error of the 3 x 3 determinant of coordinate differences, expanded along one column: `permanent` is the same expansion
/// with absolute values everywhere, and `column` the sum of the column's absolute values.
///
/// (7 + 56 u) u is Shewchuk's constant (1997, figure 22). The two products of a minor may underflow by half a spacing each, multiplied
/// by an entry of the column, and so may the three products with the column: `column` + 1.5 spacings. Far more is given, the
/// smallest normal number for a spacing, because a product that is subnormal takes a processor some hundred cycles.
pub fn orient3d_bound(permanent: f64, column: f64) -> f64 {
    (7.0 + 56.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF * permanent + f64::MIN_POSITIVE * (column + 2.0)
}

/// Bound on the error of the same determinant from exact differences, in twice the precision, rounded to `value`.
///
/// Each product of two differences is off by 9 u^2 of it and their difference by 3 u^2 of both more, the product with the column by another 9 u^2 and the two
/// sums by 3 u^2 each: 27 u^2 of the permanent, and 5 more for its own roundings. The value is the first part of the sum, off by u of it. What is left out where
/// products underflow is given as in [`orient3d_bound`], for the errors of the products as well as for them.
pub(crate) fn orient3d_twofold_bound(value: f64, permanent: f64, column: f64) -> f64 {
    2.0 * UNIT_ROUNDOFF * value.abs()
        + 32.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * permanent
        + 8.0 * f64::MIN_POSITIVE * (column + 2.0)
}

/// Bound on the error of x1 y2 - x2 y1 of two points that were seen from the start of a segment and sheared along its longest axis:
/// no |x| or |y| is larger than `across` as computed, and no distance along the axis than `along`.
///
/// A sheared coordinate is r - (d / e) z: u |r| for a difference of coordinates, 5 u |z| for the quotient of two, its product and the rounding of z, and u
/// `across` for the last subtraction, where |r| <= `across` + |z|: together less than 8 u m, m = `across` + `along`. Four such
/// errors times `across`, two of their squares, and the roundings of the products and the difference, 6 u `across`^2, are
/// below 40 u `across` m + 128 u^2 m^2; what is over covers the rounding of the bound. Products that underflow are
/// off by a spacing each, and so are coordinates: the smallest normal number is given. No product is larger than `across` m, so that
/// the bound is infinite where one of them is.
pub(crate) fn sheared_bound(across: f64, along: f64) -> f64 {
    let m = across + along;
    64.0 * UNIT_ROUNDOFF * (m * (across + 4.0 * UNIT_ROUNDOFF * m)) + f64::MIN_POSITIVE * (across + 2.0)
}

/// Bound on the error of a coordinate of a point that was sheared as for [`sheared_bound`], across or along: `size` is not below the sum of what its
/// coordinates are from the start of the segment.
///
/// 8 u m is that of one across, m = |r| + 2 |z| at most, and u |z| that of the one along; what is over covers the rounding of `size`.
pub(crate) fn prism_bound(size: f64) -> f64 {
    24.0 * UNIT_ROUNDOFF * size + f64::MIN_POSITIVE
}

/// Bound on the error of n.(x - p) as computed from f64 n, x and p: `magnitude` = fl(|n1 d1| + |n2 d2| + |n3 d3|), d = fl(x - p).
///
/// A term passes a subtraction, a product and two sums: gamma(4) (|n1 d1| + ...) in exact arithmetic; 4 u + 64 u^2 also covers the
/// roundings of `magnitude` and of the bound itself. Each of the three products may underflow by half a spacing: two are given.
pub fn signed_distance_bound(magnitude: f64) -> f64 {
    (4.0 + 64.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF * magnitude + 2.0 * SUBNORMAL_SPACING
}

/// How far a computed position may be from the exact one when `extent` is the largest |coordinate| or |displacement| that
/// went into it: 16 u `extent`.
///
/// A point of a path is a sum of at most four terms with at most four roundings each, each no larger than the extent.
pub fn position_bound(extent: f64) -> f64 {
    16.0 * UNIT_ROUNDOFF * extent
}

/// u of f32, 2^-24.
pub(crate) const UNIT_ROUNDOFF_F32: f64 = f32::EPSILON as f64 / 2.0;

/// By how much a point of a segment may move, on each axis, when the tree of boxes takes its ends into its own coordinates and clips
/// it; `reach` is the largest |coordinate| of the ends there.
///
/// An end has one rounding, u `reach`; the direction, at most 2 `reach` long, one; its product with s another; the sum one:
/// 6 u `reach`, and 8 is given.
pub(crate) fn segment_bound(reach: f64) -> f64 {
    8.0 * UNIT_ROUNDOFF * reach
}

/// Room for all f32 rounding when a segment, with ends no larger than `reach` and a radius, is tested against boxes in [-1, 1], in the
/// unit of the boxes.
///
/// With u of f32: the ends and the direction 3 u `reach`, the points that planes are measured from u (`reach` + `radius`), and 3 u
/// relative in (plane - point) inverse, which is 6 u `reach` where it matters, at s <= 1. What is over 10 u `reach` + u `radius` covers this
/// bound's own rounding and that of the boxes, one u of f64 each.
pub(crate) fn segment_bound_f32(reach: f64, radius: f64) -> f64 {
    UNIT_ROUNDOFF_F32 * (16.0 * reach + 2.0 * radius + 2.0)
}

/// By how much each component of a unit normal from [`unit_normal`](crate::normal::unit_normal) may differ from the exact one.
///
/// A vector area is accepted when its error is below 48 u of its length; normalising it adds less than 8 u: three
/// squares, two sums (half of gamma(3)), a root, a division and the scaling.
pub const NORMAL_BOUND: f64 = 56.0 * UNIT_ROUNDOFF;

/// The error a vector area may have, as a part of its length, so that its direction keeps [`NORMAL_BOUND`].
pub(crate) const VECTOR_AREA_BOUND: f64 = 48.0 * UNIT_ROUNDOFF;

/// Bound on the error of each component of a vector area summed from `fans` cross products of rounded edges: `magnitude` is the sum of
/// the absolute values of the products in that component, as computed. The edges are scaled to lengths of about 1.
///
/// A product passes two subtractions, a multiplication, the subtraction within the cross product and at most `fans` - 1 sums; two more for
/// the roundings of `magnitude` and of the bound. Scaling an edge and multiplying may underflow, by four spacings for each
/// cross product; the smallest normal number is given for them.
pub(crate) fn vector_area_bound(magnitude: f64, fans: usize) -> f64 {
    gamma(fans as u32 + 5) * magnitude + f64::MIN_POSITIVE * fans as f64
}

/// The square of the sine of an angle below which a cross product is worth twice the precision: sine 2^-6.
///
/// A plain cross product loses u / sine of its length: below 2^-6 that is more than 64 u.
pub(crate) const NEEDLE_SINE_SQUARED: f64 = 1.0 / 4096.0;

/// The square of the sine of an angle, 2^-200, above which a triangle has a normal at every scale of f64: |n|^2, of the order of its size to
/// the fourth, is then a normal number if the size is at least 2^-200.
pub(crate) const LEAST_SINE_SQUARED: f64 = f64::from_bits((1023 - 200) << 52);

/// How far the f of [`segment_hits_triangle`](crate::segment::segment_hits_triangle) may be below the exact one: 256 u.
///
/// A design choice: a smaller one sends more segments to rationals. Two determinants of a well-shaped query are off by some 7 u of
/// their permanents, which are a few times the determinants; this leaves room for segments down to a tenth of a radian from the plane.
pub const SEGMENT_FRACTION_BOUND: f64 = 256.0 * UNIT_ROUNDOFF;

/// How far |n|^2, computed, of a vector that was normalised in f64 may be from 1: 10 u.
///
/// Squares and sums of the normalisation give gamma(3) / 2 of the length, its root and the division u each, which is 7 u of
/// |n|^2; computing |n|^2 again gives gamma(3). A vector within it is taken to be a unit vector and kept bit for bit.
pub const UNIT_LENGTH_BOUND: f64 = 10.0 * UNIT_ROUNDOFF;

/// How far the vertices of a planar polygon may be off the plane fitted to them when each of their coordinates
/// is off by 8 u `extent`, `extent` being the largest |coordinate|.
///
/// 8 u is what a rotation and a translation of f64 coordinates leave (gamma(4) of up to two terms of the size of the extent). A vertex
/// is then at most e = sqrt(3) 8 u `extent` off its place. That moves a vertex off the plane by e, the plane's own point by e,
/// and turns the normal by at most e `perimeter` / `area` (each edge of the vector area, half a sum of cross
/// products, moves by 2 e), which lifts a vertex at `diameter` by that times `diameter`.
pub fn planarity_bound(extent: f64, diameter: f64, perimeter: f64, area: f64) -> f64 {
    let vertex = 1.75 * 8.0 * UNIT_ROUNDOFF * extent;
    vertex * (2.0 + diameter * (perimeter / area))
}

/// The sine of the angle by which two triangles of one plane may be folded when each of their coordinates is off by 8 u `extent`, as in
/// [`planarity_bound`]; their heights over the common edge are `one` and `other`.
///
/// A vertex is then at most e = sqrt(3) 8 u `extent` off its place; the third corner and the edge turn a triangle about the edge by
/// 2 e over its height.
pub fn fold_bound(extent: f64, one: f64, other: f64) -> f64 {
    let vertex = 1.75 * 8.0 * UNIT_ROUNDOFF * extent;
    2.0 * vertex * (1.0 / one + 1.0 / other)
}

/// Folds of more than this, 2^-30 rad, are never taken to be rounding: a needle says nothing of what lies on its two sides.
pub(crate) const LARGEST_ROUNDED_FOLD: f64 = 1.0 / (1u64 << 30) as f64;

/// The exponent e of a finite x != 0, 2^e <= |x| < 2^(e+1); -1075 for 0.
pub fn exponent(x: f64) -> i32 {
    const MANTISSA: u32 = 52;
    let biased = |x: f64| (x.abs().to_bits() >> MANTISSA) as i32;
    match biased(x) {
        0 if x == 0.0 => -1075,
        // Subnormal: 2^54 x is not.
        0 => biased(x * power_of_two(54)) - 1023 - 54,
        e => e - 1023,
    }
}

/// 2^k, exactly; `k` is brought into -1022..=1023 first.
pub const fn power_of_two(k: i32) -> f64 {
    let k = match k {
        ..-1022 => -1022,
        1024.. => 1023,
        k => k,
    };
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// x 2^k; exact unless the result is subnormal or too large. `k` in -2044..=2046.
pub fn scale(x: f64, k: i32) -> f64 {
    x * power_of_two(k / 2) * power_of_two(k - k / 2)
}

/// How much the computed distance n.(p - a) - r between a support plane and a ball may be off, n a unit vector and `extent`
/// the sum of the largest |coordinate| of a - start, r, and the reach of the path, all relative to the start of the path.
///
/// a - start and each term of p carry 2 u of the extent; three products and their sums gamma(4) of sqrt(3) times it, both dot
/// products; n itself is off by 4 u. That is sqrt(3) 4 + 2 + 4 < 16 of it.
pub fn contact_bound(extent: f64) -> f64 {
    16.0 * UNIT_ROUNDOFF * extent
}

/// How far from touching a ball may be where a contact is reported: 5 [`contact_bound`].
///
/// The plane is moved towards the ball by two bounds, and what is as near as that again to the moved plane's place counts as touching; the fifth
/// is for the rounding of f.
pub fn contact_doubt(extent: f64) -> f64 {
    5.0 * contact_bound(extent)
}

/// The square of the way that a ball of `radius` may make so that it is off the plane that faced it at an edge or a vertex by rounding only, among lengths of `size`.
///
/// A ball is off its tangent by half the square of the way over the radius: by half of u `size` at most.
pub(crate) fn round_bound(radius: f64, size: f64) -> f64 {
    UNIT_ROUNDOFF * (radius * size)
}

/// The distance between ball and triangle that is no contact, not even in doubt, as computed from planes with their normals scaled or
/// not: [`contact_doubt`], and as much again as [`contact_bound`] allows the evaluation, threefold.
pub(crate) fn screen_bound(extent: f64) -> f64 {
    contact_doubt(extent) + 3.0 * contact_bound(extent)
}

/// How far a point at `distance` from a plane's own may seem to stand out of the plane, as computed from its unit normal.
///
/// The normal is off by [`NORMAL_BOUND`] in each component, which lifts the point by sqrt(3) times that; the rest is
/// [`contact_bound`].
pub fn hold_bound(distance: f64) -> f64 {
    2.0 * NORMAL_BOUND * distance + contact_bound(distance)
}

/// Bound on the error of n.(p x q), n a normal within [`NORMAL_BOUND`] and p and q rounded differences of points with no |component| above `most`.
///
/// A component of p x q is at most 2 `most`^2 and off by 8 u `most`^2: 2 u and a rounding for each of its products, and that of their difference. Three of
/// them give 24, the normal's own error 3 * 56 * 2 = 336, the sums and products with it less than 24 u `most`^2: together below 512.
pub(crate) fn triple_product_bound(most: f64) -> f64 {
    512.0 * UNIT_ROUNDOFF * (most * most)
}

/// How far the centre of a ball may lie outside the region of the place that it touches, by rounding: 8 [`position_bound`].
///
/// What touches within the rounding of a position, 64 units of the extent, has been put there along a normal that was off by as much: twice that.
pub(crate) fn cone_bound(extent: f64) -> f64 {
    8.0 * position_bound(extent)
}

/// The radius in m that stands for a point against a mesh whose largest |coordinate| is `farthest`: 2^14 units of
/// roundoff, so that the centre stays on its own side whatever the rounding of its position (64 units), and so that what the ball
/// touches to within that rounding has normals within sqrt(2 64 / 2^14), a twelfth of a radian.
pub fn point_radius(farthest: f64) -> f64 {
    16384.0 * UNIT_ROUNDOFF * farthest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponent_brackets_every_kind_of_number() {
        for x in [1.0, 1.5, -2.0, 0.75, f64::MIN_POSITIVE, f64::MAX, f64::from_bits(1), f64::from_bits(12345)] {
            let e = exponent(x);
            assert!(scale(1.0, e) <= x.abs() && x.abs() / 2.0 < scale(1.0, e), "{x:e} has exponent {e}");
        }
        assert_eq!(exponent(f64::from_bits(1)), -1074);
        assert_eq!(exponent(0.0), -1075);
    }

    #[test]
    fn gamma_is_n_u_and_a_little() {
        assert!(gamma(4) > 4.0 * UNIT_ROUNDOFF);
        assert!(gamma(4) < 4.0 * UNIT_ROUNDOFF * (1.0 + 8.0 * UNIT_ROUNDOFF));
    }

    /// Whether `bound` is `n` u of `x`, and more only by what covers its own rounding.
    fn is_units(bound: f64, n: f64, x: f64) -> bool {
        let least = n * UNIT_ROUNDOFF * x;
        least < bound && bound < least * (1.0 + 32.0 * UNIT_ROUNDOFF)
    }

    #[test]
    fn bounds_of_determinants_count_their_roundings_and_underflows() {
        assert!(UNIT_ROUNDOFF == scale(1.0, -53) && UNIT_ROUNDOFF_F32 == scale(1.0, -24));
        for x in [0.5, 4.0] {
            assert!(is_units(orient2d_bound(x), 3.0, x) && is_units(orient3d_bound(x, 9.0), 7.0, x));
            assert!(is_units(signed_distance_bound(x), 4.0, x) && is_units(vector_area_bound(x, 3), 8.0, x));
        }
        assert_eq!((orient2d_bound(0.0), signed_distance_bound(0.0)), (f64::from_bits(2), f64::from_bits(2)));
        assert_eq!(orient3d_bound(0.0, 3.0), 5.0 * f64::MIN_POSITIVE);
        assert!(is_units(sheared_bound(2.0, 6.0), 1024.0, 1.0) && sheared_bound(0.0, 1.0) > scale(1.0, -99));
        assert_eq!(
            (sheared_bound(0.0, 0.0), sheared_bound(scale(1.0, 520), 0.0)),
            (2.0 * f64::MIN_POSITIVE, f64::INFINITY)
        );
        assert_eq!(vector_area_bound(0.0, 3), 3.0 * f64::MIN_POSITIVE);
        assert_eq!(NORMAL_BOUND, VECTOR_AREA_BOUND + 8.0 * UNIT_ROUNDOFF);
    }

    #[test]
    fn bounds_of_positions_are_their_units_of_the_extent() {
        let units = |bound: f64| bound / UNIT_ROUNDOFF;
        assert_eq!([position_bound(3.0), segment_bound(3.0), contact_bound(3.0)].map(units), [48.0, 24.0, 48.0]);
        assert_eq!([contact_doubt(3.0), hold_bound(2.0), point_radius(3.0)].map(units), [240.0, 256.0, 49152.0]);
        assert_eq!([cone_bound(3.0), triple_product_bound(3.0)].map(units), [384.0, 4608.0]);
        assert_eq!(units(round_bound(2.0, 3.0)), 6.0);
        let in_f32 = |reach, radius| segment_bound_f32(reach, radius) / UNIT_ROUNDOFF_F32;
        assert_eq!([in_f32(0.0, 0.0), in_f32(3.0, 0.0), in_f32(0.0, 3.0), in_f32(3.0, 5.0)], [2.0, 50.0, 8.0, 60.0]);
        // e = 14 u times the extent; (2 e, and e times diameter times perimeter over area) and 2 e over each height.
        assert_eq!(
            [planarity_bound(2.0, 3.0, 4.0, 2.0), planarity_bound(2.0, 0.0, 4.0, 2.0)].map(units),
            [224.0, 56.0]
        );
        assert_eq!([fold_bound(2.0, 0.5, 0.25), fold_bound(4.0, 0.5, 0.25)].map(units), [336.0, 672.0]);
        assert_eq!(LARGEST_ROUNDED_FOLD, scale(1.0, -30));
        assert_eq!(NEEDLE_SINE_SQUARED.sqrt(), scale(1.0, -6));
        assert_eq!([SEGMENT_FRACTION_BOUND, UNIT_LENGTH_BOUND].map(units), [256.0, 10.0]);
    }
}
