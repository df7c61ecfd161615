//! A run that is broken off when it does not get on: a stall must be found, and named, however large the solver's own budgets are.

use carom_dynamics::body::Ball;
use carom_dynamics::events::{Event, Outcome};
use carom_dynamics::observer::{Observer, Segment};
use carom_dynamics::plan::Plan;
use carom_dynamics::simulate::simulate;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// A run took more stretches than it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stalled {
    /// How far it got, in s.
    pub time: f64,
}

/// Counts the stretches that an observer is shown.
struct Patience<'a, O> {
    observer: &'a mut O,
    left: u64,
}

impl<O: Observer> Observer for Patience<'_, O> {
    fn event(&mut self, event: &Event) {
        self.observer.event(event);
    }

    fn segment(&mut self, segment: &Segment) {
        self.observer.segment(segment);
        self.left = match self.left.checked_sub(1) {
            Some(left) => left,
            // An observer cannot end a run; nothing is left of one that is unwound but what the observer saw.
            None => resume_unwind(Box::new(Stalled { time: segment.end })),
        };
    }
}

/// Simulates `ball` for `stretches` stretches of motion at most.
pub fn simulate_within(
    plan: &Plan,
    ball: &Ball,
    observer: &mut impl Observer,
    stretches: u64,
) -> Result<Outcome, Stalled> {
    let mut patience = Patience { observer, left: stretches };
    catch_unwind(AssertUnwindSafe(|| simulate(plan, ball, &mut patience))).map_err(|payload| {
        match payload.downcast::<Stalled>() {
            Ok(stalled) => *stalled,
            Err(other) => resume_unwind(other),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::{Stage, smooth};
    use carom_dynamics::events::Ending;

    #[test]
    fn a_run_is_broken_off_when_its_stretches_are_used_up() {
        let stage = Stage::new(100.0).down(8.0).floor(smooth(1.0)).ball([0.0, 0.0, 1.0], [0.0; 3], 0.0);
        let plan = stage.plan();
        let run = |stretches| simulate_within(&plan, &plan.balls()[0], &mut (), stretches);
        assert_eq!(run(1000).map(|outcome| outcome.ending), Ok(Ending::Completed));
        let stalled = run(10).expect_err("100 bounces");
        assert!(stalled.time > 9.0 && stalled.time < 12.0, "{stalled:?}");
    }
}
