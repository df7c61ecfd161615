//! Rounding bounds as formulas in the unit roundoff.
