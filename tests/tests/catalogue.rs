//! Every hard case of the catalogue keeps its bound, and every row has a case.

use carom_tests::catalogue;

#[test]
fn every_hard_case_keeps_its_bound() {
    let results = catalogue::run();
    println!("{}", catalogue::table_of(&results));
    let broken: Vec<String> = results
        .iter()
        .filter(|(_, figure)| !figure.holds)
        .map(|(case, figure)| format!("{} {}: {}", case.id, case.title, figure.text))
        .collect();
    assert!(broken.is_empty(), "{} of {} cases:\n{}", broken.len(), results.len(), broken.join("\n"));
}

#[test]
fn every_row_of_the_catalogue_has_a_case() {
    let ids: Vec<&str> = catalogue::all().iter().map(|case| case.id).collect();
    let missing: Vec<String> =
        (1..=32).map(|row| format!("H{row}")).filter(|row| !ids.contains(&row.as_str())).collect();
    assert!(missing.is_empty(), "no case for {missing:?}");
}
