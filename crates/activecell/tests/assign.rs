//! Assignments against the Hungarian method with its table of all distances, on small floors.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Cell, Error, Lattice, Map, Rng, Team};

/// The least sum of an assignment of every row to a column of its own, at least as many columns as rows.
///
/// Source: H. W. Kuhn, *The Hungarian Method for the Assignment Problem*, Naval Research Logistics Quarterly 1955; in the
/// form of R. Jonker and A. Volgenant, *A Shortest Augmenting Path Algorithm*, Computing 1987.
fn hungarian(costs: &[Vec<i64>]) -> i64 {
    let (rows, columns) = (costs.len(), costs.first().map_or(0, Vec::len));
    let (mut u, mut v) = (vec![0; rows + 1], vec![0; columns + 1]);
    let mut row_of = vec![0; columns + 1];
    for row in 1..=rows {
        row_of[0] = row;
        let mut least = vec![i64::MAX; columns + 1];
        let mut before = vec![0; columns + 1];
        let mut done = vec![false; columns + 1];
        let mut column = 0;
        while row_of[column] != 0 {
            done[column] = true;
            let at = row_of[column];
            let (mut step, mut next) = (i64::MAX, 0);
            for other in (1..=columns).filter(|&other| !done[other]) {
                let reduced = costs[at - 1][other - 1] - u[at] - v[other];
                if reduced < least[other] {
                    (least[other], before[other]) = (reduced, column);
                }
                if least[other] < step {
                    (step, next) = (least[other], other);
                }
            }
            for other in 0..=columns {
                if done[other] {
                    u[row_of[other]] += step;
                    v[other] -= step;
                } else if other > 0 && least[other] < i64::MAX {
                    least[other] -= step;
                }
            }
            column = next;
        }
        while column != 0 {
            row_of[column] = row_of[before[column]];
            column = before[column];
        }
    }
    (1..=columns).filter(|&j| row_of[j] > 0).map(|j| costs[row_of[j] - 1][j - 1]).sum()
}

/// The cells of a floor in an order of chance.
fn shuffled(map: &Map, rng: &mut Rng) -> Vec<Cell> {
    let mut cells: Vec<Cell> = map.free().collect();
    rng.shuffle(&mut cells);
    cells
}

/// More than all ways of such a small floor together.
const NO_WAY: i64 = 1_000_000;

fn least_sum(map: &Map, starts: &[Cell], targets: &[Cell]) -> i64 {
    let steps = |target: &Cell| {
        let field = map.wave(*target).unwrap();
        starts.iter().map(|&start| field.steps(start).map_or(NO_WAY, i64::from)).collect()
    };
    hungarian(&targets.iter().map(steps).collect::<Vec<_>>())
}

#[test]
fn no_assignment_has_a_smaller_sum() {
    let (mut solved, mut refused, mut left_over) = (0, 0, 0);
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let (width, height) = (1 + rng.below(9), 1 + rng.below(7));
        let map = Map::random(lattice, width, height, f64::from(rng.below(6)) * 0.1, seed).unwrap();
        let (mut starts, mut targets) = (shuffled(&map, &mut rng), shuffled(&map, &mut rng));
        let robots = rng.below(starts.len() as u32 + 1) as usize;
        starts.truncate(robots);
        targets.truncate(if seed % 3 == 0 { rng.below(robots as u32 + 1) as usize } else { robots });
        let least = least_sum(&map, &starts, &targets);
        match Team::assigned(&map, starts.clone(), &targets) {
            Ok(team) => {
                assert_eq!(team.lower_bound(&map).unwrap(), Some(least as u64), "seed {seed}");
                assert_eq!(team.starts(), starts);
                assert!(targets.iter().all(|target| team.targets().contains(target)), "seed {seed}");
                let resting = starts.iter().zip(team.targets()).filter(|(start, target)| start == target);
                assert!(resting.count() >= robots - targets.len(), "seed {seed}");
                solved += 1;
                left_over += u32::from(targets.len() < robots);
            }
            Err(Error::TooFewRobots { cell, robots, targets: wanted }) => {
                let field = map.wave(cell).unwrap();
                let within =
                    |cells: &[Cell]| cells.iter().filter(|&&cell| field.steps(cell).is_some()).count();
                assert_eq!((within(&starts), within(&targets)), (robots, wanted), "seed {seed}");
                assert!(robots < wanted && least >= NO_WAY, "seed {seed}");
                refused += 1;
            }
            Err(other) => panic!("seed {seed}: {other}"),
        }
    }
    assert!(solved > 1000 && refused > 300 && left_over > 300, "{solved}, {refused}, {left_over}");
}

/// All robots come from the left; the one that is farthest takes the first target, and nobody has to pass it.
#[test]
fn who_comes_from_farthest_takes_the_first_target() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "..........").unwrap();
        let row = |xs: [i32; 4]| xs.map(|x| Cell::new(x, 0)).to_vec();
        let team = Team::assigned(&map, row([2, 0, 3, 1]), &row([9, 7, 8, 6])).unwrap();
        assert_eq!(team.targets(), row([8, 6, 9, 7]));
        // Also if that sends away the one that stands on a target.
        let team = Team::assigned(&map, row([3, 0, 1, 2]), &row([5, 6, 4, 3])).unwrap();
        assert_eq!(team.targets(), row([6, 3, 4, 5]));
    }
}

#[test]
fn what_cannot_be_assigned_is_refused_with_the_cell() {
    let map = Map::parse(Lattice::Hex, "..#..\n..#..").unwrap();
    let cell = Cell::new;
    let says = |starts: &[Cell], targets: &[Cell]| {
        Team::assigned(&map, starts.to_vec(), targets).unwrap_err().to_string()
    };
    let (west, east) = ([cell(0, 0), cell(1, 0)], [cell(3, 0), cell(4, 1)]);
    assert_eq!(
        says(&west, &[cell(0, 1), cell(3, 0)]),
        "the part of the floor around (3,0) has 0 robots for 1 target; give it a robot for each target"
    );
    assert_eq!(
        says(&[west[0], west[0]], &east),
        "robots 0 and 1 have the same start (0,0); give every robot its own"
    );
    assert_eq!(
        says(&west, &[east[0], east[0]]),
        "robots 0 and 1 have the same target (3,0); give every robot its own"
    );
    assert_eq!(
        says(&west, &[cell(2, 0)]),
        "the target (2,0) lies in an obstacle; the nearest free cell is (1,0)"
    );
    assert_eq!(
        says(&[cell(0, 9)], &[]),
        "robot 0: cell (0,9) is outside the map: x goes from 0 to 4, y from 0 (top) to 1"
    );
    let nobody = Team::assigned(&map, Vec::new(), &[]).unwrap();
    assert_eq!(nobody.robots(), 0);
}
