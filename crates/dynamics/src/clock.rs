//! Simulated time: t = n h at the end of a step, a compensated sum between.

/// The time of one ball, in s.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    sum: f64,
    lost: f64,
}

impl Clock {
    /// At t = 0.
    pub fn start() -> Self {
        Self { sum: 0.0, lost: 0.0 }
    }

    /// The time.
    pub fn now(&self) -> f64 {
        self.sum + self.lost
    }

    /// Lets `seconds` pass (Neumaier's summation: many events cost no digits).
    pub fn advance(&mut self, seconds: f64) {
        let sum = self.sum + seconds;
        let larger_first =
            if self.sum.abs() >= seconds.abs() { (self.sum - sum) + seconds } else { (seconds - sum) + self.sum };
        self.lost += larger_first;
        self.sum = sum;
    }

    /// Sets the time, exactly.
    pub fn set(&mut self, time: f64) {
        *self = Self { sum: time, lost: 0.0 };
    }

    /// The time left until `end`.
    pub fn until(&self, end: f64) -> f64 {
        (end - self.sum) - self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_tenths_are_a_hundred_thousand() {
        let mut clock = Clock::start();
        for _ in 0..1_000_000 {
            clock.advance(0.1);
        }
        // 0.1 is 5.55e-18 above a tenth; a plain sum is off by 1e-6.
        assert!((clock.now() - 1e5 - 5.55e-12).abs() < 2e-11, "{:e}", clock.now() - 1e5);
    }
}
