//! What a query asks of eight boxes or of the points of a leaf at once, for narrow registers and for wide ones, by the same operations.

use super::WIDTH;
use super::frame::LocalSegment;
use super::leaves::{MASK_UNITS, MOST, PAIR_UNITS, Unit};
use super::prism::Prism;

/// The points of a leaf, as sheared for a query: two coordinates across and one along.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ShearedPoints {
    pub(super) coordinates: [[f64; MOST]; 3],
}

macro_rules! questions {
    ($(#[$feature:meta])?) => {
        /// For each child a lower bound of where it is entered, in [0, 1], and a bit for each that is met up to `limit`.
        #[inline]
        $(#[$feature])?
        pub(in super::super) fn entries(segment: &LocalSegment, planes: &[[[f32; WIDTH]; 2]; 3], limit: f32) -> ([f32; WIDTH], u32) {
            let (mut entry, mut exit) = (all_f32(0.0), all_f32(limit));
            for (i, sides) in planes.iter().enumerate() {
                let forward = usize::from(segment.forward[i]);
                let inverse = all_f32(segment.inverse[i]);
                let near = sub_f32(load_f32(&sides[1 - forward]), all_f32(segment.near_from[i]));
                let far = sub_f32(load_f32(&sides[forward]), all_f32(segment.far_from[i]));
                // There are no NaN.
                entry = max_f32(mul_f32(near, inverse), entry);
                exit = min_f32(mul_f32(far, inverse), exit);
            }
            (store_f32(entry), not_above_f32(entry, exit))
        }

        /// Shears the points of a leaf; returns a bit for each face that is not certain to be off the prism.
        #[inline]
        $(#[$feature])?
        pub(in super::super) fn screen(leaf: &[Unit], prism: &Prism, sheared: &mut ShearedPoints) -> u32 {
            let Some((masks, points)) = leaf.split_first_chunk::<MASK_UNITS>() else { return 0 };
            let beyond = match prism.shear.axis {
                0 => beyond::<0>(points, prism, sheared),
                1 => beyond::<1>(points, prism, sheared),
                _ => beyond::<2>(points, prism, sheared),
            };
            let masks = load_masks(masks);
            let mut off = all_masks(0);
            for side in beyond {
                off = with_same(off, masks, all_masks(side as u16));
            }
            !bits_of(off) & 0xffff
        }

        /// For each side of the prism a bit for each point that is beyond it, for certain.
        #[inline]
        $(#[$feature])?
        fn beyond<const AXIS: usize>(points: &[Unit], prism: &Prism, sheared: &mut ShearedPoints) -> [u32; 6] {
            let [next, last, along] = &mut sheared.coordinates;
            let mut beyond = [0; 6];
            let Some(points) = points.first_chunk::<{ MOST / 2 * PAIR_UNITS }>() else { return beyond };
            let quads = points.chunks_exact(2 * PAIR_UNITS).enumerate();
            let stores = next.as_chunks_mut::<4>().0.iter_mut().zip(last.as_chunks_mut::<4>().0).zip(along.as_chunks_mut::<4>().0);
            for ((k, pairs), ((next, last), along)) in quads.zip(stores) {
                let from = |i: usize| sub_f64(load_f64(pairs[i], pairs[PAIR_UNITS + i]), all_f64(prism.origin(i, AXIS)));
                let z = from(AXIS);
                let across = |i: usize| sub_f64(from((AXIS + 1 + i) % 3), mul_f64(all_f64(prism.shear.slopes[i]), z));
                let seen = [across(0), across(1), z];
                for i in 0..3 {
                    beyond[2 * i] |= below_f64(seen[i], all_f64(prism.least[i])) << (4 * k);
                    beyond[2 * i + 1] |= below_f64(all_f64(prism.most[i]), seen[i]) << (4 * k);
                }
                (*next, *last, *along) = (store_f64(seen[0]), store_f64(seen[1]), store_f64(z));
            }
            beyond
        }
    };
}

/// By registers that every processor has.
pub(super) mod narrow {
    use super::*;
    use wide::{f32x8, f64x4, i16x8};

    fn all_f32(x: f32) -> f32x8 {
        f32x8::splat(x)
    }
    fn load_f32(x: &[f32; 8]) -> f32x8 {
        f32x8::new(*x)
    }
    fn store_f32(x: f32x8) -> [f32; 8] {
        x.to_array()
    }
    fn sub_f32(a: f32x8, b: f32x8) -> f32x8 {
        a - b
    }
    fn mul_f32(a: f32x8, b: f32x8) -> f32x8 {
        a * b
    }
    fn max_f32(a: f32x8, b: f32x8) -> f32x8 {
        a.fast_max(b)
    }
    fn min_f32(a: f32x8, b: f32x8) -> f32x8 {
        a.fast_min(b)
    }
    fn not_above_f32(a: f32x8, b: f32x8) -> u32 {
        a.simd_le(b).to_bitmask()
    }
    fn all_f64(x: f64) -> f64x4 {
        f64x4::splat(x)
    }
    fn load_f64(a: Unit, b: Unit) -> f64x4 {
        f64x4::new(bytemuck::cast([a, b]))
    }
    fn store_f64(x: f64x4) -> [f64; 4] {
        x.to_array()
    }
    fn sub_f64(a: f64x4, b: f64x4) -> f64x4 {
        a - b
    }
    fn mul_f64(a: f64x4, b: f64x4) -> f64x4 {
        a * b
    }
    fn below_f64(a: f64x4, b: f64x4) -> u32 {
        a.simd_lt(b).to_bitmask()
    }
    fn all_masks(x: u16) -> [i16x8; 2] {
        [i16x8::splat(x as i16); 2]
    }
    fn load_masks(x: &[Unit; 2]) -> [i16x8; 2] {
        x.map(|unit| i16x8::new(bytemuck::cast(unit)))
    }
    /// `marked`, and where all bits of `masks` are in `side`.
    fn with_same(marked: [i16x8; 2], masks: [i16x8; 2], side: [i16x8; 2]) -> [i16x8; 2] {
        [0, 1].map(|k| marked[k] | (masks[k] & side[k]).simd_eq(masks[k]))
    }
    fn bits_of(marked: [i16x8; 2]) -> u32 {
        marked[0].to_bitmask() | marked[1].to_bitmask() << 8
    }

    questions!();
}

/// In a program that is compiled for AVX2, those are what every processor has.
#[cfg(target_feature = "avx2")]
pub(super) use narrow as avx2;

/// By the registers of AVX2.
#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
pub(super) mod avx2 {
    use super::*;
    use bytemuck::cast;
    use std::arch::x86_64::*;

    macro_rules! avx2 {
        ($($(#[$doc:meta])* fn $name:ident($($argument:ident: $type:ty),*) -> $out:ty { $value:expr })*) => {
            $($(#[$doc])* #[inline] #[target_feature(enable = "avx2")] fn $name($($argument: $type),*) -> $out { $value })*
        };
    }
    avx2! {
        fn all_f32(x: f32) -> __m256 { _mm256_set1_ps(x) }
        fn load_f32(x: &[f32; 8]) -> __m256 { cast(*x) }
        fn store_f32(x: __m256) -> [f32; 8] { cast(x) }
        fn sub_f32(a: __m256, b: __m256) -> __m256 { _mm256_sub_ps(a, b) }
        fn mul_f32(a: __m256, b: __m256) -> __m256 { _mm256_mul_ps(a, b) }
        fn max_f32(a: __m256, b: __m256) -> __m256 { _mm256_max_ps(a, b) }
        fn min_f32(a: __m256, b: __m256) -> __m256 { _mm256_min_ps(a, b) }
        fn not_above_f32(a: __m256, b: __m256) -> u32 { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
        fn all_f64(x: f64) -> __m256d { _mm256_set1_pd(x) }
        fn load_f64(a: Unit, b: Unit) -> __m256d { _mm256_set_m128d(cast(b), cast(a)) }
        fn store_f64(x: __m256d) -> [f64; 4] { cast(x) }
        fn sub_f64(a: __m256d, b: __m256d) -> __m256d { _mm256_sub_pd(a, b) }
        fn mul_f64(a: __m256d, b: __m256d) -> __m256d { _mm256_mul_pd(a, b) }
        fn below_f64(a: __m256d, b: __m256d) -> u32 { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)) as u32 }
        fn all_masks(x: u16) -> __m256i { _mm256_set1_epi16(x as i16) }
        fn load_masks(x: &[Unit; 2]) -> __m256i { cast(*x) }
        /// `marked`, and where all bits of `masks` are in `side`.
        fn with_same(marked: __m256i, masks: __m256i, side: __m256i) -> __m256i {
            _mm256_or_si256(marked, _mm256_cmpeq_epi16(_mm256_and_si256(masks, side), masks))
        }
        fn bits_of(marked: __m256i) -> u32 {
            _mm_movemask_epi8(_mm_packs_epi16(_mm256_castsi256_si128(marked), _mm256_extracti128_si256::<1>(marked))) as u32
        }
    }

    questions!(#[target_feature(enable = "avx2")]);
}
