//! An order of points and directions that no mirror changes, as far as there is one.

use nalgebra::Vector3;
use std::cmp::Ordering;

/// The order of `a` and `b` by the sizes of their coordinates, x first, and only where all of these are equal by the signs: so that their mirror images
/// in the planes of the axes have the same order, but for vectors that are images of each other.
#[inline]
pub fn by_size(a: &Vector3<f64>, b: &Vector3<f64>) -> Ordering {
    for (a, b) in a.iter().zip(b.iter()) {
        let order = a.abs().total_cmp(&b.abs());
        if order.is_ne() {
            return order;
        }
    }
    let mut signs = a.iter().zip(b.iter()).map(|(a, b)| a.total_cmp(b));
    signs.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn r12_the_order_is_that_of_the_mirror_images() {
        let [a, b, c] = [[1.0, 2.0, -3.0], [-1.0, 2.0, 4.0], [1.0, -2.0, -3.0]].map(Vector3::<f64>::from);
        for signs in [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]] {
            let image = |v: &Vector3<f64>| v.component_mul(&Vector3::from(signs));
            assert_eq!(by_size(&image(&a), &image(&b)), Ordering::Less);
            assert_eq!(by_size(&image(&b), &image(&a)), Ordering::Greater);
            assert_eq!(by_size(&image(&a), &image(&a)), Ordering::Equal);
        }
        // Of two images of each other one must be the first.
        assert_eq!(by_size(&a, &c), Ordering::Greater);
    }
}
