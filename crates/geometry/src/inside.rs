//! The determinant inside test.
