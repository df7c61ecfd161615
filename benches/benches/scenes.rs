//! Flights and scenes: `cargo bench --package carom-benches --bench scenes`.

use carom_benches::operations::{Bench, SCENES, TIMES};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn flights(criterion: &mut Criterion) {
    let bench = match Bench::new() {
        Ok(bench) => bench,
        Err(error) => return eprintln!("{error}"),
    };
    let mut group = criterion.benchmark_group("scenes");
    group.throughput(Throughput::Elements(TIMES as u64));
    for (name, operation) in SCENES {
        group.bench_function(name, |b| b.iter(|| operation(&bench)));
    }
    group.finish();
}

criterion_group!(scenes, flights);
criterion_main!(scenes);
