//! The path of a moving point as a polynomial over f in [0, 1].
