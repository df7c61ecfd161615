//! In place of Parquet, in a build without it: tables of which there are none.

use super::target::{Demand, Target};
use crate::error::AppError;
use carom_dynamics::events::Event;
use carom_dynamics::observer::Frame;
use carom_dynamics::scene::Scene;

/// A table that cannot be.
pub enum Table {}

impl Table {
    /// Refuses.
    pub fn events(target: Target, scene: &Scene) -> Result<Self, AppError> {
        Self::frames(target, scene)
    }

    /// Refuses.
    pub fn frames(target: Target, _: &Scene) -> Result<Self, AppError> {
        Err(AppError::Usage(format!("{}: this carom was built without its feature `parquet`", target.shown())))
    }

    /// Never called.
    pub fn push_events(&mut self, _: usize, _: &[Event]) -> Result<Demand, AppError> {
        match *self {}
    }

    /// Never called.
    pub fn push_frames(&mut self, _: usize, _: &[Frame]) -> Result<Demand, AppError> {
        match *self {}
    }

    /// Never called.
    pub fn finish(self) -> Result<Target, AppError> {
        match self {}
    }
}
