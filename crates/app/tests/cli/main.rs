//! Tests of the real program: what it is given, what it says, what it leaves.

mod accuracy;
mod balls;
mod bad_input;
mod commands;
mod common;
mod compare;
mod explain;
mod first_steps;
mod run;
mod scenes;
