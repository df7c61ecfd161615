//! Signs of orientation determinants, filtered and then exact.
