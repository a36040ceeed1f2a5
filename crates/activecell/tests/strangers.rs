//! Members and strangers: the promised rate of errors over many looks, on both lattices.

use activecell::predict::Capsule;
use activecell::sense::{Estimate, look};
use activecell::{
    Cell, Detection, Errors, Lattice, Map, MemberRecord, Pose, Rng, Sensors, detections, strangers,
};

#[test]
fn members_are_called_strangers_no_more_often_than_promised() {
    let mut rng = Rng::new(5);
    for rate in [0.1, 0.01] {
        let (mut wrong, looks) = (0, 20_000);
        for _ in 0..looks {
            let (own, seen) = (0.02 + 0.1 * rng.unit(), 0.02 + 0.1 * rng.unit());
            let radius_m = 0.1 + rng.unit();
            let mut off = |at: [f64; 2], spread: f64| at.map(|x| x + spread * rng.normal());
            let report = off([0.0, 0.0], own);
            let at_m = off([radius_m, 0.0], seen);
            let body = Capsule { from_m: report, to_m: report, radius_m };
            let members = [MemberRecord { body, spread_m: own }];
            let met = Detection { beam: 0, at_m, spread_m: seen };
            wrong += strangers(&members, &[met], rate).unwrap().len();
        }
        let share = wrong as f64 / f64::from(looks);
        println!("rate {rate}: {share}");
        assert!(share <= rate, "{rate}: {share}");
    }
    assert!(strangers(&[], &[], 0.0).is_err() && strangers(&[], &[], f64::NAN).is_err());
}

/// How far a beam goes until it meets a disc.
fn to_disc(from: [f64; 2], bearing_rad: f64, centre: [f64; 2], radius_m: f64) -> f64 {
    let (sin, cos) = bearing_rad.sin_cos();
    let d = [centre[0] - from[0], centre[1] - from[1]];
    let (along, aside) = (d[0] * cos + d[1] * sin, d[1] * cos - d[0] * sin);
    let half = radius_m * radius_m - aside * aside;
    if half < 0.0 || along < 0.0 { f64::INFINITY } else { along - half.sqrt() }
}

#[test]
fn a_stranger_among_members_and_walls_is_found() {
    let (mut looks, mut found, mut members_wrong, mut members_met, mut walls_wrong) = (0, 0, 0, 0, 0);
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        let map = Map::random(Lattice::ALL[seed as usize % 2], 9, 9, 0.1, seed).unwrap();
        let sensors = Sensors { beams: 72, range_m: 6.0, noise_m: 0.02, false_rate: 0.0 };
        let errors = Errors { start_m: 0.02, start_rad: 0.005, ..Errors::default() };
        let at = |cell: Cell| map.centre_m(cell);
        let [own, member, stranger] = [(2, 4), (6, 2), (6, 6)].map(|(x, y)| at(Cell::new(x, y)));
        // The robot is a little off what it believes, and so is the member off its report.
        let believed = Pose { at_m: own, bearing_rad: 0.3 };
        let truth = Pose {
            at_m: own.map(|x| x + errors.start_m * rng.normal()),
            bearing_rad: 0.3 + errors.start_rad * rng.normal(),
        };
        let true_member = member.map(|x| x + 0.03 * rng.normal());
        let nearest = |bearing_rad: f64| {
            let wall = map.cast(truth.at_m, bearing_rad, 9.0).map_or(9.0, |hit| hit.enter_m);
            let member = to_disc(truth.at_m, bearing_rad, true_member, 0.3);
            let stranger = to_disc(truth.at_m, bearing_rad, stranger, 0.3);
            let least = wall.min(member).min(stranger);
            (least, if wall <= least { 0 } else { 1 + usize::from(stranger <= least) })
        };
        let readings = look(&sensors, truth, &|bearing_rad| nearest(bearing_rad).0, &mut rng);
        let estimate = Estimate::new(believed, &errors);
        let met = detections(&map, &estimate, &sensors, &readings, 0.001).unwrap();
        let body = Capsule { from_m: member, to_m: member, radius_m: 0.3 };
        let records = [MemberRecord { body, spread_m: 0.03 }];
        let called = strangers(&records, &met, 0.001).unwrap();
        let what: Vec<usize> = sensors.bearings_rad(truth.bearing_rad).map(|b| nearest(b).1).collect();
        let of = |kind: usize| called.iter().filter(|&&i| what[met[i].beam] == kind).count();
        members_met += met.iter().filter(|met| what[met.beam] == 1).count();
        (walls_wrong, members_wrong) = (walls_wrong + of(0), members_wrong + of(1));
        if what.contains(&2) {
            (looks, found) = (looks + 1, found + usize::from(of(2) > 0));
        }
    }
    println!(
        "{found} of {looks} strangers; {members_wrong} of {members_met} on members, {walls_wrong} on walls"
    );
    assert!(looks > 200 && found * 10 > looks * 8);
    assert!(members_met > 300 && members_wrong * 200 < members_met);
    assert!(walls_wrong < 60);
}
