//! Axes: the range of the values, where a value comes to lie, and which values are marked.

use super::Scale;

/// More marks than this on an axis would be a ruler.
const MOST_TICKS: f64 = 9.0;

/// An axis laid out: values in [`lo`, `hi`] come to lie between two places of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Ruler {
    scale: Scale,
    /// The ends of the axis; of a logarithmic one the exponents of ten.
    lo: f64,
    hi: f64,
    /// Where they come to lie, in pixels.
    pub from: f64,
    pub to: f64,
}

/// A value that is marked.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Where, in pixels.
    pub at: f64,
    /// Its number; empty for a line without one.
    pub label: String,
}

impl Ruler {
    /// For `values`, those that cannot be shown left out; from `from` to `to`.
    pub fn new(scale: Scale, values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in values.filter_map(|value| place(scale, value)) {
            (lo, hi) = (lo.min(x), hi.max(x));
        }
        if lo > hi {
            (lo, hi) = (0.0, 1.0);
        }
        (lo, hi) = match scale {
            Scale::Log if hi - lo > 1.5 => (lo.floor(), hi.ceil()),
            // A value alone has some space around it.
            _ if lo == hi => (lo - 0.5, hi + 0.5),
            _ => (lo - 0.04 * (hi - lo), hi + 0.04 * (hi - lo)),
        };
        Self { scale, lo, hi, from, to }
    }

    /// Pixels for a unit of the value.
    pub fn density(&self) -> f64 {
        (self.to - self.from).abs() / (self.hi - self.lo)
    }

    /// Shows a larger range, so that there are `density` pixels for a unit.
    pub fn widen_to(&mut self, density: f64) {
        let more = 0.5 * ((self.to - self.from).abs() / density - (self.hi - self.lo));
        (self.lo, self.hi) = (self.lo - more, self.hi + more);
    }

    /// Where `value` comes to lie, in pixels; none if it cannot be shown.
    pub fn at(&self, value: f64) -> Option<f64> {
        place(self.scale, value).map(|x| self.pixel(x))
    }

    fn pixel(&self, x: f64) -> f64 {
        self.from + (x - self.lo) / (self.hi - self.lo) * (self.to - self.from)
    }

    /// The values that are marked.
    pub fn ticks(&self) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(),
            Scale::Log => self.log_ticks(),
        }
    }

    fn linear_ticks(&self) -> Vec<Tick> {
        let step = round_step((self.hi - self.lo) / MOST_TICKS);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let first = (self.lo / step).ceil();
        let count = ((self.hi / step).floor() - first).clamp(0.0, 2.0 * MOST_TICKS) as u32;
        let tick = |k: u32| {
            let x = (first + f64::from(k)) * step;
            let plain = (1e-4..1e6).contains(&step.max(x.abs())) && step > 1e-6;
            let label = if plain || x == 0.0 { format!("{x:.decimals$}") } else { format!("{x:e}") };
            Tick { at: self.pixel(x), label }
        };
        (0..=count).map(tick).collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let (first, last) = (self.lo.ceil() as i32, self.hi.floor() as i32);
        let stride = (f64::from(last - first) / MOST_TICKS).ceil().max(1.0) as i32;
        let plain = first >= -3 && last <= 4;
        let mut ticks = Vec::new();
        for k in first..=last {
            let label = if (k - first) % stride == 0 { power(k, plain) } else { String::new() };
            ticks.push(Tick { at: self.pixel(f64::from(k)), label });
        }
        if last - first < 2 {
            for (k, digit) in (first - 1..=last).flat_map(|k| [(k, 2), (k, 5)]) {
                let x = f64::from(k) + f64::from(digit).log10();
                if x >= self.lo && x <= self.hi {
                    let label = if plain { plain_number(k, digit) } else { format!("{digit}·{}", power(k, false)) };
                    ticks.push(Tick { at: self.pixel(x), label });
                }
            }
        }
        ticks
    }
}

/// Where a value is on its scale; none if it cannot be shown.
fn place(scale: Scale, value: f64) -> Option<f64> {
    match scale {
        Scale::Linear => value.is_finite().then_some(value),
        Scale::Log => (value > 0.0 && value.is_finite()).then(|| value.log10()),
    }
}

/// The least 1, 2 or 5 times a power of ten that is >= `least`.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// 10^k, in figures if they are few.
fn power(k: i32, plain: bool) -> String {
    if plain {
        return plain_number(k, 1);
    }
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = k.abs().to_string();
    let raised = digits.bytes().map(|d| RAISED[usize::from(d - b'0')]);
    "10".chars().chain((k < 0).then_some('⁻')).chain(raised).collect()
}

fn plain_number(k: i32, digit: i32) -> String {
    let decimals = (-k).max(0) as usize;
    format!("{:.decimals$}", f64::from(digit) * 10f64.powi(k))
}
