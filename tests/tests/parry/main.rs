//! Geometry against parry3d on more than a million random cases, every disagreement explained.
//!
//! Where the two differ by more than rounding explains, the case goes to a third: rational arithmetic, or parry's own distance.
//! What they differ by is put under a reason that code has checked; what has none fails the test.

mod casts;
mod oracle;
mod queries;

use std::collections::BTreeMap;

/// How a series of cases went.
#[derive(Debug, Default)]
struct Tally {
    agreed: u32,
    /// The worst difference that counts as agreement, as a part of what rounding allows.
    closest_call: f64,
    /// By reason: how many, and the worst difference.
    explained: BTreeMap<&'static str, (u32, f64)>,
    unexplained: Vec<String>,
}

impl Tally {
    fn agree(&mut self) {
        self.agreed += 1;
    }

    /// Whether `difference` is within `allowed`; then it is agreement.
    fn agree_within(&mut self, difference: f64, allowed: f64) -> bool {
        let within = difference <= allowed;
        if within {
            self.agreed += 1;
            self.closest_call = self.closest_call.max(difference / allowed);
        }
        within
    }

    /// A disagreement: explained if `checked`, else kept as it stands.
    fn explain(&mut self, reason: &'static str, checked: bool, difference: f64, case: impl FnOnce() -> String) {
        if checked {
            let (count, worst) = self.explained.entry(reason).or_default();
            *count += 1;
            *worst = worst.max(difference);
        } else {
            self.unexplained.push(format!("not {reason} ({difference:e}): {}", case()));
        }
    }

    /// Prints the counts; fails if there were not `cases` of them, or if one is unexplained.
    #[track_caller]
    fn finish(self, what: &str, cases: u32) {
        let explained: u32 = self.explained.values().map(|(count, _)| count).sum();
        println!(
            "{what}: {} of {cases} agree (to {:.3} of the allowance); {:?}",
            self.agreed, self.closest_call, self.explained
        );
        let shown = &self.unexplained[..self.unexplained.len().min(5)];
        assert!(shown.is_empty(), "{what}: {} unexplained, such as {shown:#?}", self.unexplained.len());
        assert_eq!(self.agreed + explained, cases, "{what}: every case is counted once");
    }
}
