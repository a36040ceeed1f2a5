//! Two golden examples in the spirit of the paper's figure 4, with the published rule.

#![expect(clippy::unwrap_used, reason = "the maps are the project's own")]

use activecell::{Cell, Lattice, Map, Outcome, Rule};

/// The steps of the published rule drawn into the map, as in figure 4: numbers, S and F.
fn drawn(map: &str) -> String {
    let map = Map::parse(Lattice::Square, map).unwrap();
    let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
    let route = map.route(Rule::Published, from, to, 1000).unwrap();
    assert_eq!(route.outcome(), Outcome::Arrived);
    let symbol = |cell: Cell| match route.cells().iter().position(|&visited| visited == cell) {
        Some(0) => 'S',
        Some(step) if cell != to => char::from_digit(step as u32, 36).unwrap(),
        Some(_) => 'F',
        None if map.is_free(cell) => '.',
        None => '#',
    };
    let row = |y| (0..map.width() as i32).map(move |x| Cell::new(x, y)).map(symbol).collect();
    let rows: Vec<String> = (0..map.height() as i32).map(row).collect();
    format!("{}\n{} steps", rows.join("\n"), route.steps())
}

#[test]
fn a_plain_detour() {
    assert_eq!(
        drawn(include_str!("../../../maps/detour.txt")),
        "
.......
.3456F.
.2##...
.1##...
.S.....
.......
7 steps"
            .trim_start()
    );
}

/// The way up is blocked, so the robot passes beyond the target's column (Xd becomes negative) and comes back.
#[test]
fn eight_steps_beyond_the_target_s_column() {
    assert_eq!(
        drawn(include_str!("../../../maps/beyond.txt")),
        "
..F7..
...6..
...5..
###4..
S123..
8 steps"
            .trim_start()
    );
}
