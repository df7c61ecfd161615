//! A short run of the fuzzer: no changed scene or mesh file makes the program panic or hang.

use carom_tests::fuzz::{Fuzz, Tally};

#[test]
fn h18_changed_files_are_refused_or_run() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let fuzz = Fuzz::new(folder.path());
    let mut tally = Tally::default();
    let count = 1500;
    for seed in 0..count {
        fuzz.run(seed, &mut tally);
    }
    println!("{tally:?}");
    assert_eq!(tally.refused + tally.unplanned + tally.ran, count);
    assert!(tally.refused > count / 10 && tally.ran > count / 10, "{tally:?}");
}
