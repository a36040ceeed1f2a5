//! Run files: what was written is read again, and what was not is told in one line.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::{Cell, Dir, Drive, Frame, Lattice, Map, Rng, Robot, Rule};
use activecell_formats::run::{self, RouteReport, Seconds};

fn written(seed: u64) -> (String, Map, Robot, Cell, Cell) {
    let frame = Frame { cell_m: 0.4, origin_m: [-3.5, 0.25], yaw_rad: 0.7 };
    let map = Map::random(Lattice::ALL[seed as usize % 2], 9, 7, 0.1, seed).unwrap().in_frame(frame).unwrap();
    let drive = [Drive::Steered, Drive::Differential][seed as usize / 2 % 2];
    let robot =
        Robot { drive, wheel_perimeter_m: 0.31, can_reverse: seed.is_multiple_of(3), ..Robot::default() };
    let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
    let rule = if seed.is_multiple_of(5) { Rule::Learning } else { Rule::Wave };
    let route = map.route(rule, from, to, 10_000).unwrap();
    let program = route.program(&robot, &map, Some(Dir((seed % 4) as u8)));
    let report = RouteReport::new(rule, &route, &program, &robot, &map, Seconds::default());
    let text = run::write(&map, &robot, from, to, &report).unwrap();
    let read = run::read(text.as_bytes()).unwrap();
    assert_eq!((&read.map, read.robot, read.from, read.to, read.rule), (&map, robot, from, to, rule));
    assert_eq!(read.cells, route.cells());
    if !read.program.waypoints.is_empty() {
        assert_eq!(read.program, program);
    }
    (text, map, robot, from, to)
}

#[test]
fn runs_come_back_as_they_were() {
    for seed in 0..60 {
        written(seed);
    }
}

#[test]
fn what_is_wrong_is_told_in_one_line() {
    let text = written(4).0;
    let with = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        run::read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    let cases = [
        (with("\"run\"", "\"trace\""), "activecell is `trace`, not `run`"),
        (with("\"version\":1", "\"version\":9"), "version 9 is not known here"),
        (with("\"square\"", "\"round\""), "map.lattice is `round`; it must be square or hex"),
        (with("\"cell_m\":0.4", "\"cell_m\":-1"), "the cell size in metres is -1"),
        (with("\"rows\":[\"", "\"rows\":[\"?"), "map.rows["),
        (with("\"rows\":[\"", "\"rows\":[\"\",\""), "map.rows[0] is no row"),
        (with("\"from\":[", "\"from\":[99"), "from: the cell (99"),
        (with("\"wheel_perimeter_m\":0.31", "\"wheel_perimeter_m\":0"), "robot: wheel_perimeter_m is 0"),
        (with("\"track_m\"", "\"trak_m\""), "did you mean `track_m`?"),
        (with("\"rule\":\"wave\"", "\"rule\":\"fast\""), "route.rule is `fast`"),
        (with("\"turn_deg\":", "\"turn_deg\":999"), "route.program["),
        (with("\"revolutions\":", "\"revolutions\":1e9"), "not a run file: "),
    ];
    for (error, expected) in cases {
        assert!(error.contains(expected) && !error.contains('\n'), "{error} does not say {expected}");
    }
    for hostile in ["", "{", "[]", "null", "{\"activecell\":\"run\"}", "\u{0}"] {
        let error = run::read(hostile.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("not a run file: ") && !error.contains('\n'), "{error}");
    }
    let deep = "[".repeat(100_000);
    assert!(run::read(deep.as_bytes()).is_err());
}

/// A run that would take for ever to drive.
#[test]
fn a_run_longer_than_its_map_is_refused() {
    let (text, ..) = written(4);
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json["route"]["program"][0]["revolutions"] = 1e300.into();
    let error = run::read(json.to_string().as_bytes()).unwrap_err().to_string();
    assert!(error.starts_with("route.program[0] does not lead from"), "{error}");
}

#[test]
fn changed_bytes_never_panic() {
    let text = written(4).0.into_bytes();
    let mut rng = Rng::new(1);
    for _ in 0..3000 {
        let mut bytes = text.clone();
        for _ in 0..=rng.below(3) {
            let at = rng.below(bytes.len() as u32) as usize;
            bytes[at] = rng.next_u64() as u8;
        }
        bytes.truncate(1 + rng.below(2 * bytes.len() as u32) as usize);
        if let Err(error) = run::read(&bytes) {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    }
}
