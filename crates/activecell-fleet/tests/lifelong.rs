//! Runs in which targets keep coming: every journal passes the checker, which knows no planner.

#![expect(clippy::unwrap_used, reason = "a test that cannot be set up should stop")]

use activecell::{
    Cell, Dir, Event, Journal, JournalFault, Lattice, Map, Moves, News, PlanFault, Rng, Task, check_journal,
};
use activecell_fleet::{Assignment, Lifelong, LifelongOptions, deliveries, visits, within_reach};

const MOVES: [Moves; 2] = [Moves::Omni, Moves::Turning];

/// A random floor, the cells of its largest part shuffled.
fn floor(lattice: Lattice, size: u32, density: f64, rng: &mut Rng) -> (Map, Vec<Cell>) {
    let [width, height] = [1 + rng.below(size), 1 + rng.below(size)];
    let map = Map::random(lattice, width, height, density, rng.next_u64()).unwrap();
    let parts = map.free().map(|cell| within_reach(&map, cell));
    let mut cells = parts.max_by_key(Vec::len).unwrap_or_default();
    rng.shuffle(&mut cells);
    (map, cells)
}

fn options(moves: Moves, seed: u64) -> LifelongOptions {
    LifelongOptions { moves, seed, ..LifelongOptions::default() }
}

fn journal(map: &Map, starts: &[Cell], tasks: &[Task], options: LifelongOptions, steps: usize) -> Journal {
    let mut run = Lifelong::new(map, starts, &[], tasks.to_vec(), options).unwrap();
    let journal = run.run(steps, |_| {}).unwrap();
    assert_eq!(check_journal(map, tasks, &journal), Ok(()));
    journal
}

#[test]
fn runs_on_random_floors_are_legal() {
    let mut rng = Rng::new(3);
    let (mut runs, mut finished) = (0, 0);
    for case in 0..160 {
        let lattice = Lattice::ALL[case % 2];
        let moves = MOVES[case / 2 % 2];
        // Each tenth is wider than a word of 64 cells.
        let (map, cells) = floor(lattice, if case % 10 == 0 { 90 } else { 12 }, 0.25, &mut rng);
        let share = [0.95, 0.5, 0.1][case / 4 % 3];
        let robots = (cells.len() as f64 * share) as usize;
        if robots == 0 {
            continue;
        }
        let seed = rng.next_u64();
        let tasks =
            if case % 3 == 0 { deliveries(&cells, &cells, 400, seed) } else { visits(&cells, 400, seed) };
        let options = LifelongOptions {
            window: 1 + rng.below(30) as usize,
            step_paths: (case % 5 == 0).then_some(200),
            assignment: if case % 7 < 3 { Assignment::Nearest { shown: 1.5 } } else { Assignment::InOrder },
            tasks_per_step: (case % 4 == 0).then_some(0.7),
            ..options(moves, seed)
        };
        let journal = journal(&map, &cells[..robots], &tasks, options, 60);
        runs += 1;
        finished += journal.finished(&tasks);
    }
    println!("{runs} runs, {finished} tasks finished, all legal");
    assert!(runs > 100 && finished > 2000);
}

#[test]
fn the_same_seed_gives_the_same_run_on_any_number_of_threads() {
    let map = Map::random(Lattice::Hex, 30, 20, 0.2, 4).unwrap();
    let cells = map.free().map(|cell| within_reach(&map, cell)).max_by_key(Vec::len).unwrap();
    let tasks = visits(&cells, 1000, 5);
    for moves in MOVES {
        let run = |threads, seed| {
            let options = LifelongOptions { threads, step_paths: Some(500), ..options(moves, seed) };
            journal(&map, &cells[..100], &tasks, options, 50)
        };
        assert_eq!(run(1, 1), run(2, 1));
        assert_ne!(run(1, 1), run(1, 2));
    }
}

/// Alone, a robot takes the shortest way: as many steps as a plain search over cells and headings says.
#[test]
fn a_robot_alone_takes_as_many_steps_as_a_plain_search() {
    let mut rng = Rng::new(21);
    for case in 0..200 {
        let (lattice, moves) = (Lattice::ALL[case % 2], MOVES[case / 2 % 2]);
        let (map, cells) = floor(lattice, 14, 0.3, &mut rng);
        let [Some(&from), Some(&to)] = [cells.first(), cells.last()] else { continue };
        let tasks = [Task::visit(to)];
        let window = 1 + rng.below(30) as usize;
        let options = LifelongOptions { window, ..options(moves, rng.next_u64()) };
        let journal = journal(&map, &[from], &tasks, options, 1000);
        assert_eq!(journal.steps(), plain(&map, moves, from, to), "{from} to {to}, window {window}");
    }
}

/// Floors too large for tables of distances: each robot has what it needs around it.
#[test]
fn large_floors_go_as_well() {
    for (case, moves) in MOVES.into_iter().chain(MOVES).enumerate() {
        let map = Map::random(Lattice::ALL[case / 2], 150, 140, 0.15, case as u64).unwrap();
        let cells =
            map.free().map(|cell| (cell, within_reach(&map, cell))).find(|(_, cells)| cells.len() > 16_384);
        let (_, cells) = cells.unwrap();
        let starts: Vec<Cell> = cells.iter().copied().step_by(60).collect();
        let near: Vec<Cell> = cells.iter().copied().filter(|cell| cell.x < 40 && cell.y < 40).collect();
        let tasks = deliveries(&near, &cells, 500, 3);
        let options = LifelongOptions { window: 8, threads: 2, ..options(moves, 1) };
        let crowd = journal(&map, &starts, &tasks, options.clone(), 60);
        assert!(crowd.events().iter().filter(|event| event.news == News::Done(0)).count() > 10);
        if moves == Moves::Omni {
            let tasks = [Task::visit(cells[cells.len() - 1])];
            let alone = journal(&map, &cells[..1], &tasks, options, 1000);
            assert_eq!(alone.steps(), plain(&map, moves, cells[0], cells[cells.len() - 1]));
        }
    }
}

fn plain(map: &Map, moves: Moves, from: Cell, to: Cell) -> usize {
    let mut seen = std::collections::BTreeSet::from([(from, Dir::E)]);
    let mut rim: Vec<(Cell, Dir)> = seen.iter().copied().collect();
    for step in 0.. {
        assert!(!rim.is_empty());
        if rim.iter().any(|&(cell, _)| cell == to) {
            return step;
        }
        let mut next = Vec::new();
        for (cell, dir) in rim {
            let lattice = map.lattice();
            let ways: Vec<(Cell, Dir)> = match moves {
                Moves::Omni => lattice.dirs().map(|way| (lattice.neighbour(cell, way), dir)).collect(),
                Moves::Turning => {
                    let turned = [-1, 1].map(|by| (cell, lattice.turned(dir, by)));
                    turned.into_iter().chain([(lattice.neighbour(cell, dir), dir)]).collect()
                }
            };
            next.extend(ways.into_iter().filter(|way| map.is_free(way.0) && seen.insert(*way)));
        }
        rim = next;
    }
    unreachable!()
}

/// In a corridor with bays everybody comes through; in one without, those behind each other do.
#[test]
fn corridors_and_dead_ends_do_not_stop_a_run() {
    let map = Map::parse(Lattice::Square, "...........\n.#.#.#.#.#.\n...........").unwrap();
    let cells: Vec<Cell> = map.free().collect();
    for (moves, seed) in MOVES.into_iter().flat_map(|moves| (0..5).map(move |seed| (moves, seed))) {
        let tasks = visits(&cells, 200, seed);
        let journal = journal(&map, &cells[..8], &tasks, options(moves, seed), 2000);
        assert_eq!(journal.finished(&tasks), 200, "{moves:?}, seed {seed}");
    }
}

/// Robots that turn, on a floor with one to three free cells: a row of them moves up, or around, so that the first in rank
/// always comes on. Without rows hardly any task is done there.
#[test]
fn robots_that_turn_come_on_where_nearly_all_cells_are_taken() {
    for (lattice, seed) in
        Lattice::ALL.into_iter().flat_map(|lattice| (0..2).map(move |seed| (lattice, seed)))
    {
        let map = Map::parse(lattice, &["........"; 8].join("\n")).unwrap();
        let cells: Vec<Cell> = map.free().collect();
        for free in [1, 3] {
            let tasks = visits(&cells, 1000, seed);
            let options = LifelongOptions { step_paths: Some(500), ..options(Moves::Turning, seed) };
            let done = journal(&map, &cells[free..], &tasks, options, 100).finished(&tasks);
            assert!(done >= 30, "{lattice:?}, seed {seed}, {free} free cells: {done} tasks done");
        }
    }
}

/// Nobody can move: the run goes on all the same.
#[test]
fn robots_that_are_boxed_in_wait() {
    let map = Map::parse(Lattice::Hex, "...\n...").unwrap();
    let cells: Vec<Cell> = map.free().collect();
    let tasks = visits(&cells, 100, 4);
    for moves in MOVES {
        journal(&map, &cells, &tasks, options(moves, 1), 50);
        // One free cell is enough for all.
        journal(&map, &cells[1..], &tasks, options(moves, 1), 50);
    }
}

#[test]
fn what_cannot_be_run_is_refused() {
    let map = Map::parse(Lattice::Square, "..#.").unwrap();
    let [a, b, wall, far] = [0, 1, 2, 3].map(|x| Cell::new(x, 0));
    let new = |starts: &[Cell], headings: &[Dir], tasks: &[Task], options| {
        Lifelong::new(&map, starts, headings, tasks.to_vec(), options).err().map(|error| error.to_string())
    };
    let omni = || options(Moves::Omni, 0);
    let turning = || options(Moves::Turning, 0);
    let said = |text: Option<String>, part: &str| {
        let text = text.expect("refused");
        assert!(text.contains(part), "{text}");
    };
    said(new(&[a], &[], &[Task::visit(b), Task::visit(far)], omni()), "task 1: no way leads from (0,0)");
    said(new(&[a], &[], &[Task::visit(wall)], omni()), "task 0: the target (2,0) lies in an obstacle");
    said(new(&[a], &[], &[Task { errands: Vec::new() }], omni()), "task 0: a task without a cell");
    said(new(&[a, far], &[], &[], omni()), "no way leads from (0,0)");
    said(new(&[a, a], &[], &[], omni()), "same start");
    said(new(&[wall], &[], &[], omni()), "robot 0");
    said(new(&[a], &[Dir(4)], &[], turning()), "a heading is 4");
    said(new(&[a, b], &[Dir(0)], &[], turning()), "the number of headings is 1");
    said(new(&[a], &[], &[], LifelongOptions { window: 31, ..omni() }), "from 1 to 30");
    said(new(&[a], &[], &[], LifelongOptions { tasks_per_step: Some(0.0), ..omni() }), "above 0");
    let shown = Assignment::Nearest { shown: f64::NAN };
    said(new(&[a], &[], &[], LifelongOptions { assignment: shown, ..omni() }), "tasks shown a robot");
    assert!(matches!(Lifelong::new(&map, &[], &[], Vec::new(), omni()), Ok(run) if run.is_done()));
}

/// Each kind of tampering is found.
#[test]
fn tampered_journals_are_refused() {
    let map = Map::parse(Lattice::Square, "...\n.#.").unwrap();
    let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
    let [wall, out, low] = [Cell::new(1, 1), Cell::new(0, -1), Cell::new(0, 1)];
    let tasks = [Task { errands: vec![b, c] }, Task::visit(a)];
    let event = |step, robot, task, news| Event { step, robot, task, news };
    let good = [event(0, 0, 0, News::Assigned), event(1, 0, 0, News::Done(0)), event(2, 0, 0, News::Done(1))];
    let told = |cells: &[&[Cell]], events: &[Event]| {
        let mut journal = Journal::new(Moves::Omni, cells[0], &[], &[]);
        cells[1..].iter().for_each(|row| journal.push(row, &[], &[]));
        journal.push(cells[cells.len() - 1], &[], events);
        check_journal(&map, &tasks, &journal).err()
    };
    let way: &[&[Cell]] = &[&[a], &[b], &[c]];
    assert_eq!(told(way, &good), None);
    let moved = |fault: Option<JournalFault>| match fault {
        Some(JournalFault::Move(fault)) => fault,
        other => panic!("{other:?}"),
    };
    assert!(matches!(moved(told(&[&[a], &[c]], &[])), PlanFault::Jump { step: 1, .. }));
    assert!(matches!(moved(told(&[&[b], &[wall]], &[])), PlanFault::Blocked { .. }));
    assert!(matches!(moved(told(&[&[a], &[out]], &[])), PlanFault::Outside { .. }));
    assert!(matches!(moved(told(&[&[a, b], &[b, b]], &[])), PlanFault::Collision { .. }));
    assert!(matches!(moved(told(&[&[a, b], &[b, a]], &[])), PlanFault::Swap { .. }));
    let is = |events: &[Event], fault: JournalFault| {
        assert_eq!(told(way, events), Some(fault));
        assert!(!fault.to_string().is_empty());
    };
    is(&[event(0, 1, 0, News::Assigned)], JournalFault::NoSuch { event: 0 });
    is(&[event(0, 0, 2, News::Assigned)], JournalFault::NoSuch { event: 0 });
    is(&[event(9, 0, 0, News::Assigned)], JournalFault::NoSuch { event: 0 });
    is(&[event(1, 0, 0, News::Assigned), good[0]], JournalFault::NoSuch { event: 1 });
    let twice = JournalFault::GivenTwice { event: 1, robot: 0, task: 0 };
    is(&[good[0], good[0]], twice);
    is(&[good[0], event(0, 0, 1, News::Assigned)], JournalFault::GivenTwice { event: 1, robot: 0, task: 1 });
    is(&[good[1]], JournalFault::NotNext { step: 1, robot: 0, task: 0, errand: 0 });
    is(&[good[0], good[2]], JournalFault::NotNext { step: 2, robot: 0, task: 0, errand: 1 });
    let late = event(2, 0, 0, News::Done(0));
    is(&[good[0], late], JournalFault::NotThere { step: 2, robot: 0, cell: c, errand: b });
    let turned = |rows: &[(Cell, Dir)]| {
        let mut journal = Journal::new(Moves::Turning, &[rows[0].0], &[rows[0].1], &[]);
        rows[1..].iter().for_each(|row| journal.push(&[row.0], &[row.1], &[]));
        check_journal(&map, &[], &journal).err()
    };
    assert_eq!(turned(&[(a, Dir::N), (a, Dir::W), (a, Dir::S), (low, Dir::S)]), None);
    for row in [(a, Dir::S), (b, Dir::N), (b, Dir::E)] {
        assert!(matches!(turned(&[(a, Dir::N), row]), Some(JournalFault::Turn { step: 1, robot: 0, .. })));
    }
    let none = turned(&[(a, Dir(4))]);
    assert_eq!(none, Some(JournalFault::NoDirection { step: 0, robot: 0, heading: Dir(4) }));
}
