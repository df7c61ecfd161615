//! The catalogue of hard cases, run as a whole.

use carom_tests::catalogue;

#[test]
fn every_hard_case_holds() {
    let only = std::env::var("CASE").ok();
    let mut broken = Vec::new();
    for case in catalogue::all() {
        if only.as_ref().is_some_and(|o| !case.id.eq(o)) {
            continue;
        }
        let start = std::time::Instant::now();
        let figure = (case.run)();
        println!(
            "{} | {} | {} | {} | {} | {:.2?} {}",
            case.id,
            case.title,
            case.elsewhere,
            figure.text,
            case.bound,
            start.elapsed(),
            if figure.holds { "ok" } else { "BROKEN" }
        );
        if !figure.holds {
            broken.push(format!("{} {}: {}", case.id, case.title, figure.text));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
