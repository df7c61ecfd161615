//! Queries of geometry: `cargo bench --package carom-benches --bench geometry`.

use carom_benches::operations::{Bench, GEOMETRY, TIMES};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn queries(criterion: &mut Criterion) {
    let bench = match Bench::new() {
        Ok(bench) => bench,
        Err(error) => return eprintln!("{error}"),
    };
    let mut group = criterion.benchmark_group("geometry");
    group.throughput(Throughput::Elements(TIMES as u64));
    for (name, operation) in GEOMETRY {
        group.bench_function(name, |b| b.iter(|| operation(&bench)));
    }
    group.finish();
}

criterion_group!(geometry, queries);
criterion_main!(geometry);
