//! Every requirement has a test that bears its number: `fn r08_...`, or `fn r44_r46_...` for several.

use carom_tests::sources;
use std::collections::{BTreeMap, BTreeSet};

/// The requirements, after House and Keyser, *Foundations of Physically Based Modeling and Animation*, chapter 3.
/// R14 is no requirement.
const ROWS: [(u8, &str); 46] = [
    (1, "an impact is instantaneous"),
    (2, "three stages: detection, determination, response"),
    (3, "in one dimension a sign change of y - b is a collision"),
    (4, "three ways to give a plane; coefficients are normalised"),
    (5, "signed distance d = (x - p).n"),
    (6, "a ball's clearance: d - r on the positive side, d + r on the negative; the side is remembered"),
    (7, "positions before and after a step, interpolated between"),
    (8, "f = d[n] / (d[n] - d[n+1]); 0/0 and starts inside have names"),
    (9, "contact is clearance <= 0 and closing"),
    (10, "the loop over the time that remains; bounded; t = n h"),
    (11, "f multiplies the sub-step"),
    (12, "several planes in one step: the smallest f; ties do not depend on the order of the surfaces"),
    (13, "by default a ball does not rotate and surfaces stand still"),
    (15, "an impact does not change the position"),
    (16, "velocity splits into normal and tangential parts"),
    (17, "restitution: v_n+ = -c_r v_n-"),
    (18, "a table of restitutions with sources"),
    (19, "linear friction: v_t+ = (1 - c_f) v_t-"),
    (20, "Coulomb friction: |F_t| = mu |F_n|"),
    (21, "a table of friction for pairs of materials"),
    (22, "Coulomb friction by momentum: the change of v_t is proportional to |v_n-|"),
    (23, "Coulomb friction at an impact: v_t+ = v_t- - min(mu |v_n-|, |v_t-|) v_t-/|v_t-|"),
    (24, "friction stops a tangential motion and never turns it round"),
    (25, "v+ = v_n+ + v_t+"),
    (26, "round-off, integration error and geometric discretisation are kept apart"),
    (27, "the errors of distance, f and hit position are bounded"),
    (28, "never through a surface"),
    (29, "no absolute epsilon in geometry"),
    (30, "modelling thresholds are few, named, and scale with the scene"),
    (31, "a ball that has stopped costs no more time"),
    (32, "four conditions of rest: speed, distance, force, friction"),
    (33, "rest on two or three surfaces at once"),
    (34, "no rest at the top of a flight, nor on a slope that is too steep"),
    (35, "where a moving point meets a polygon, and the normal there"),
    (36, "a simple polygon is validated"),
    (37, "convex and concave polygons; the star and the bow-tie are refused"),
    (38, "four vertices not in one plane are two triangles"),
    (39, "a polygon's normal from its vertices"),
    (40, "the plane equation of a polygon"),
    (41, "t_hit = ((p - p_i).n) / (v_i.n), 0 <= t_hit < h"),
    (42, "x_hit = p_i + t_hit v_i"),
    (43, "projection: the coordinate with the largest |n_i| is dropped, in cyclic order"),
    (44, "inside if all determinants have one sign"),
    (45, "each determinant is an edge over the vector from its vertex to the hit"),
    (46, "the inside test knows the error of the hit point; a mesh is watertight"),
    (47, "triangles: surfaces are split into them; barycentric coordinates"),
];

/// The names of the functions under `#[test]`, in unit tests, in the tests' own folders and inside `proptest!`.
fn tests(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut attributed = false;
    for line in text.lines().map(str::trim) {
        if line == "#[test]" {
            attributed = true;
        } else if let Some(rest) = line.strip_prefix("fn ") {
            if attributed {
                names.extend(rest.split('(').next());
            }
            attributed = false;
        }
    }
    names
}

/// The rows that begin a test's name: 44 and 46 for `r44_r46_nothing_slips_through`.
fn rows(test: &str) -> impl Iterator<Item = &str> {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    test.split('_').take_while(move |word| word.strip_prefix('r').is_some_and(is_number))
}

/// The rows that tests name, each with its tests.
fn tests_by_row() -> BTreeMap<String, Vec<String>> {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    // What a test is called in the text of this file is no test.
    for source in sources::rust().iter().filter(|source| source.path != "tests/tests/requirements.rs") {
        for test in tests(&source.text) {
            for row in rows(test) {
                found.entry(row.to_owned()).or_default().push(format!("{}: {test}", source.path));
            }
        }
    }
    found
}

#[test]
fn every_requirement_has_a_test_of_its_name() {
    let found = tests_by_row();
    let missing: Vec<String> = ROWS
        .iter()
        .filter(|(row, _)| !found.contains_key(&format!("r{row:02}")))
        .map(|(row, what)| format!("R{row}: {what}"))
        .collect();
    assert!(
        missing.is_empty(),
        "{} of {} requirements have no test:\n{}",
        missing.len(),
        ROWS.len(),
        missing.join("\n")
    );
}

#[test]
fn every_row_that_a_test_names_exists() {
    let known: BTreeSet<String> = ROWS.iter().map(|(row, _)| format!("r{row:02}")).collect();
    let found = tests_by_row();
    let unknown: Vec<_> = found.iter().filter(|(row, _)| !known.contains(*row)).collect();
    assert!(unknown.is_empty(), "rows are r01 to r47 in two digits, without r14: {unknown:#?}");
}

#[test]
fn the_names_of_tests_are_found_with_their_rows() {
    let text = "fn r99_helper() {}\n#[test]\n#[should_panic]\nfn r44_r46_nothing_slips() {}\n  #[test]\n  fn rolling(x in 0..1) {}\n";
    assert_eq!(tests(text), ["r44_r46_nothing_slips", "rolling"]);
    assert_eq!(rows("r44_r46_r_r47_nothing").collect::<Vec<_>>(), ["r44", "r46"]);
    assert_eq!(rows("rolling_r01").count(), 0);
}
