//! Files of strangers: what they close, and what is refused.

#![expect(clippy::unwrap_used, reason = "a test that cannot read its file should stop")]

use activecell::{Cell, Lattice, Map};
use activecell_formats::strangers::{MAX_CLOSED, Strangers, read};
use proptest::prelude::*;

const SEEN: &str =
    r#""radius_m": 0.3, "max_speed_mps": 1, "max_accel_mps2": 1, "seen_within_m": 0.05, "seen": "#;

fn file(rest: &str) -> String {
    format!("{{\"activecell\": \"strangers\", \"version\": 1{rest}}}")
}

fn strangers(rest: &str) -> Strangers {
    read(file(rest).as_bytes()).unwrap()
}

fn object(seen: &str) -> String {
    format!(", \"objects\": [{{{SEEN}{seen}}}]")
}

#[test]
fn closed_by_hand_and_by_objects_come_together() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, &"..............\n".repeat(12)).unwrap();
        let both = strangers(
            &(", \"certain_steps\": 2, \"likely_steps\": 0, \"keep_outs\": [{\"cell\": [0, 0], \"from\": 4, \"to\": 6}]"
                .to_owned()
                + &object("[[5, 7.5, 6.5]]")),
        );
        let closed = both.keep_outs(&map, 0).unwrap();
        assert!(closed.is_closed(Cell::new(0, 0), 4) && !closed.is_closed(Cell::new(0, 0), 7));
        let near = map.cell_at_m([7.5, 6.5]);
        // Time 5 of the sightings is step 0 of the plan.
        assert!((0..=2).all(|step| closed.is_closed(near, step)) && !closed.is_closed(near, 3));
        // Larger robots come nearer to more; who is small may say it.
        let count = |strangers: &Strangers, largest| strangers.keep_outs(&map, largest).unwrap().all().len();
        let small = strangers(&(", \"robot_radius_m\": 0.1".to_owned() + &object("[[5, 7.5, 6.5]]")));
        let usual = strangers(&object("[[5, 7.5, 6.5]]"));
        assert!(count(&small, 0) < count(&usual, 0));
        assert_eq!(count(&small, 1), count(&usual, 1));
        assert_eq!(count(&usual, 0), count(&usual, 3));
    }
}

#[test]
fn what_is_wrong_is_said_where() {
    for (rest, expected) in [
        (", \"keep_out\": []", "line 1, column 52: not a file of strangers: unknown field `keep_out`"),
        (",\n\"objects\": [{}]", "not a file of strangers: missing field `radius_m`"),
        (", \"step_s\": 0", "the time of a slot in seconds is 0"),
        (", \"certain_steps\": 20, \"likely_steps\": 20", "the number of slots foreseen is 40"),
        (", \"now_s\": 1e10", "now_s is 10000000000"),
        (&(", \"now_s\": 4".to_owned() + &object("[[5, 0, 0]]")), "now_s is 4; it must be no earlier than"),
        (&object("[]"), "objects[0]: `seen` is empty, so that it may be anywhere"),
        (&object("[[0, 1, 1], [0, 1, 1]]"), "objects[0]: seen[1]: the time of a position, in seconds is 0"),
        (&object("[[0, 1, 1], [1, 9, 1]]"), "objects[0]: seen[1] is farther than its bounds allow"),
        (&object("[[0, 1, 1]]").replace("0.3", "-1"), "objects[0]: the object's radius in metres is -1"),
    ] {
        let error = read(file(rest).as_bytes()).unwrap_err().to_string();
        assert!(error.contains(expected), "{rest}: {error}");
    }
    assert!(
        read(b"{\"activecell\":\"run\",\"version\":1}").unwrap_err().to_string().contains("not `strangers`")
    );
    let later = file("").replace('1', "2");
    assert!(read(later.as_bytes()).unwrap_err().to_string().contains("version 2 is not known here"));
}

#[test]
fn more_closed_cells_than_memory_are_refused_before_they_are_made() {
    let map = Map::random(Lattice::Square, 1000, 1000, 0.0, 1).unwrap();
    for rest in [
        object("[[0, 500, 500]]").replace("\"max_speed_mps\": 1", "\"max_speed_mps\": 1000000"),
        ", \"keep_outs\": [".to_owned()
            + &vec!["{\"cell\":[0,0],\"from\":0,\"to\":9999}"; 420].join(",")
            + "]",
    ] {
        let error = strangers(&rest).keep_outs(&map, 0).unwrap_err().to_string();
        assert!(error.contains(&format!("more than {MAX_CLOSED} cells")), "{error}");
    }
    let wrong =
        strangers(", \"keep_outs\": [{\"cell\":[0,0],\"from\":5,\"to\":4294967295}]").keep_outs(&map, 0);
    assert!(wrong.is_err());
    assert!(strangers(", \"keep_outs\": [{\"cell\":[0,0],\"from\":5,\"to\":4}]").keep_outs(&map, 0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mangled_bytes_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let mut bytes = file(&object("[[0, 1, 1], [1, 1.5, 1]]")).into_bytes();
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = if byte < 128 { b"0123456789-e.[]{},\""[usize::from(byte) % 19] } else { byte };
        }
        let map = Map::parse(Lattice::Hex, "....\n....").unwrap();
        match read(&bytes) {
            Ok(strangers) => drop(strangers.keep_outs(&map, 0)),
            Err(error) => prop_assert!(!error.to_string().contains(char::is_control), "{error:?}"),
        }
    }
}
