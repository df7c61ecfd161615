//! The time that a piece of work takes: the processor's where the system tells it, which does not count what other programs take.

use std::time::Instant;

/// Less than this, in s, the system does not tell well.
const LEAST: f64 = 0.05;

/// The seconds that `work` takes.
pub fn seconds(work: impl FnOnce()) -> f64 {
    let (cpu, wall) = (on_cpu(), Instant::now());
    work();
    match (cpu, on_cpu()) {
        (Some(before), Some(after)) if after - before > LEAST => after - before,
        _ => wall.elapsed().as_secs_f64(),
    }
}

/// The middle of the times of `runs` runs of `work`, in s.
pub fn median(runs: usize, mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..runs).map(|_| seconds(&mut work)).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// How long this thread has been on a processor, in s; Linux tells.
fn on_cpu() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: u64 = text.split(' ').next()?.parse().ok()?;
    Some(nanoseconds as f64 / 1.0e9)
}

/// The most memory that the process has held so far, in bytes; Linux tells.
pub fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
