//! Schedules of random plans: the order that they keep is exactly the plan's, and whoever is late, nobody collides and
//! everybody arrives.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its plan should stop")]

mod adversary;

use activecell::schedule::{Delays, Execution, Runner, Stop};
use activecell::{
    Cell, Error, Lattice, Map, Plan, Rng, Robot, Schedule, check_program, check_schedule,
    schedule::ScheduleFault,
};
use std::collections::BTreeSet;

/// Robots that wander by the rules, following each other, around rings too: everyone wishes for a neighbouring cell or its
/// own; of two that wish for one cell the first has it, those who swap stay, and so does, again and again, whoever wishes
/// for the cell of one that stays.
fn wander(map: &Map, robots: usize, steps: usize, rng: &mut Rng) -> Plan {
    let lattice = map.lattice();
    let mut free: Vec<Cell> = map.free().collect();
    rng.shuffle(&mut free);
    let robots = robots.min(free.len());
    let mut now = free[..robots].to_vec();
    let mut cells = now.clone();
    for _ in 0..steps {
        let wish = |&cell: &Cell| {
            let to = lattice.neighbour(cell, lattice.turned(activecell::Dir(0), rng.below(6) as i32));
            if map.is_free(to) { to } else { cell }
        };
        let mut next: Vec<Cell> = now.iter().map(wish).collect();
        let mut settled = false;
        while !settled {
            settled = true;
            for robot in 0..robots {
                let rival = (0..robots).any(|other| {
                    let taken = next[other] == next[robot] && (other < robot || next[other] == now[other]);
                    other != robot && (taken || next[other] == now[robot] && next[robot] == now[other])
                });
                if rival && next[robot] != now[robot] {
                    next[robot] = now[robot];
                    settled = false;
                }
            }
        }
        cells.extend(&next);
        now = next;
    }
    Plan::new(robots, cells).unwrap()
}

fn random(seed: u64, robots: usize, steps: usize) -> (Map, Plan) {
    let mut rng = Rng::new(seed);
    loop {
        let (width, height) = (2 + rng.below(4), 2 + rng.below(4));
        let map = Map::random(Lattice::ALL[seed as usize % 2], width, height, 0.1, rng.next_u64()).unwrap();
        if map.free_cells() > 0 {
            let robots = 1 + rng.below(robots as u32) as usize;
            let plan = wander(&map, robots, rng.below(steps as u32) as usize, &mut rng);
            return (map, plan);
        }
    }
}

/// Robots of a size that may go around every ring.
fn robot(lattice: Lattice) -> Robot {
    Robot { radius_m: if lattice == Lattice::Square { 0.3 } else { 0.2 }, ..Robot::default() }
}

/// A set of moves, robot and number of the visit, for each move: which must be done before it.
type Closure = Vec<Vec<bool>>;

fn closure(mut reaches: Closure) -> Closure {
    for via in 0..reaches.len() {
        for from in 0..reaches.len() {
            if reaches[from][via] {
                let further = reaches[via].clone();
                reaches[from].iter_mut().zip(further).for_each(|(to, more)| *to |= more);
            }
        }
    }
    reaches
}

/// Every dependency there is, by definition: a robot's moves one after the other, and a move into a cell after every
/// move by which another robot left it before or in the same step.
fn by_definition(moves: &[(usize, usize, Cell, Cell)]) -> Closure {
    let must = |&(robot, step, from, _): &(usize, usize, Cell, Cell), later: &(usize, usize, Cell, Cell)| {
        robot == later.0 && step < later.1 || robot != later.0 && from == later.3 && step <= later.1
    };
    closure(moves.iter().map(|a| moves.iter().map(|b| must(b, a)).collect()).collect())
}

#[test]
fn one_dependency_a_move_says_all_and_only_rings_close() {
    let (mut dependencies, mut kept, mut rings) = (0, 0, 0);
    for seed in 0..1500 {
        let (map, plan) = random(seed, 16, 12);
        let schedule = Schedule::new(&map, &plan).unwrap();
        assert_eq!(check_schedule(&map, &plan, &schedule), Ok(()), "{seed}");
        let mut moves = Vec::new();
        for robot in 0..plan.robots() {
            for step in 1..=plan.steps() {
                let (from, to) = (plan.at(step - 1, robot), plan.at(step, robot));
                if from != to {
                    moves.push((robot, step, from, to));
                }
            }
        }
        assert_eq!(moves.len(), schedule.moves());
        let index = |robot: usize, visit: usize| {
            moves.iter().enumerate().filter(|(_, one)| one.0 == robot).nth(visit - 1).unwrap().0
        };
        let mut direct = vec![vec![false; moves.len()]; moves.len()];
        for robot in 0..plan.robots() {
            for (number, visit) in schedule.visits(robot).enumerate().skip(1) {
                let own = index(robot, number);
                if number > 1 {
                    direct[own][own - 1] = true;
                }
                if let Some((other, left)) = visit.after.filter(|after| after.0 != robot) {
                    direct[own][index(other, left + 1)] = true;
                    kept += 1;
                }
            }
        }
        let all = by_definition(&moves);
        dependencies += all.iter().flatten().filter(|&&must| must).count();
        assert_eq!(closure(direct), all, "{seed}");
        // A move that waits for itself is in a ring of its own step, each robot in the cell of the next.
        let circular: BTreeSet<_> =
            (0..moves.len()).filter(|&one| all[one][one]).map(|one| (moves[one].1, moves[one].0)).collect();
        let found: Vec<_> = schedule.rings().collect();
        let in_rings: BTreeSet<_> =
            found.iter().flat_map(|(step, ring)| ring.iter().map(|&robot| (*step, robot))).collect();
        assert_eq!(circular, in_rings, "{seed}");
        for (step, ring) in found {
            assert!(ring.len() > 2);
            for (place, &robot) in ring.iter().enumerate() {
                let next = ring[(place + 1) % ring.len()];
                assert_eq!(plan.at(step, robot), plan.at(step - 1, next));
            }
            rings += 1;
        }
    }
    println!("{kept} dependencies say what {dependencies} say; {rings} rings");
    assert!(rings > 100 && kept > 2000);
}

#[test]
fn a_schedule_of_another_plan_is_refused() {
    let mut refused = [0; 3];
    for seed in 0..1000 {
        let (map, plan) = random(seed, 8, 12);
        let other = {
            let mut rng = Rng::new(!seed);
            // Two steps in a row, changed for one robot: where both plans keep the rules, they may differ.
            let mut cells: Vec<Cell> = plan.rows().flatten().copied().collect();
            if plan.steps() == 0 {
                continue;
            }
            let (robot, step) =
                (rng.below(plan.robots() as u32) as usize, 1 + rng.below(plan.steps() as u32) as usize);
            cells[step * plan.robots() + robot] = plan.at(step - 1, robot);
            Plan::new(plan.robots(), cells).unwrap()
        };
        let Ok(schedule) = Schedule::new(&map, &other) else {
            refused[2] += 1;
            continue;
        };
        let found = check_schedule(&map, &plan, &schedule);
        if other == plan {
            assert_eq!(found, Ok(()));
        } else {
            assert!(matches!(found, Err(ScheduleFault::Cells { .. })), "{seed} {found:?}");
            refused[0] += 1;
        }
        let fewer = Plan::new(plan.robots() + 1, vec![Cell::new(0, 0); plan.robots() + 1]).unwrap();
        assert!(matches!(check_schedule(&map, &fewer, &schedule), Err(ScheduleFault::Robots { .. })));
        refused[1] += 1;
    }
    assert!(refused.iter().all(|&count| count > 80), "{refused:?}");
}

#[test]
fn programs_drive_along_the_cells_of_the_plan() {
    for seed in 0..300 {
        let (map, plan) = random(seed, 6, 15);
        let schedule = Schedule::new(&map, &plan).unwrap();
        for number in 0..plan.robots() {
            let body = Robot { can_reverse: seed % 3 == 0, ..Robot::default() };
            let cells: Vec<Cell> = schedule.visits(number).map(|visit| visit.cell).collect();
            let program = schedule.program(&map, number, &body);
            assert_eq!(check_program(&map, &body, &program, &cells), Ok(()), "{seed}");
        }
    }
}

#[test]
fn undisturbed_robots_are_never_later_than_the_plan() {
    let mut sooner = 0;
    for seed in 0..400 {
        let (map, plan) = random(seed, 20, 30);
        let schedule = Schedule::new(&map, &plan).unwrap();
        let execution = Execution::new(&map, &schedule, &robot(map.lattice()), Delays::default()).unwrap();
        let executed = execution.trial(&mut Rng::new(seed)).unwrap();
        for (robot, (&arrival, cost)) in executed.arrivals.iter().zip(plan.costs()).enumerate() {
            assert_eq!(cost, schedule.cost(robot));
            assert!(arrival < cost as f64 + 1e-6, "{seed}: robot {robot} after {arrival} instead of {cost}");
            sooner += usize::from(arrival < cost as f64 - 0.5);
        }
    }
    println!("{sooner} robots came sooner than planned");
}

/// Everything that can be late, drawn by chance.
fn troubles(plan: &Plan, rng: &mut Rng) -> Delays {
    let stop = |rng: &mut Rng| Stop {
        robot: rng.below(plan.robots() as u32) as usize,
        from: 20.0 * rng.unit(),
        steps: 40.0 * rng.unit(),
    };
    Delays {
        chance: 0.5 * rng.unit(),
        most_steps: 1 + rng.below(20),
        slow_share: 0.5 * rng.unit(),
        slow_speed: 0.1 + 0.9 * rng.unit(),
        stops: (0..rng.below(3)).map(|_| stop(rng)).collect(),
        lost_reports: 0.8 * rng.unit() * f64::from(rng.below(2)),
        turning: rng.chance(0.5),
    }
}

#[test]
fn nobody_collides_and_everybody_arrives_whoever_is_late() {
    let (mut rings, mut late) = (0, 0.0f64);
    for seed in 0..1500 {
        let (map, plan) = random(seed, 30, 60);
        let schedule = Schedule::new(&map, &plan).unwrap();
        let mut rng = Rng::new(seed);
        // Without rings, bodies may be nearly as large as cells.
        let large = rng.chance(0.5) && schedule.rings().len() == 0;
        let most = if map.lattice() == Lattice::Square { 0.49 } else { 0.42 };
        let radius_m = if large { most * rng.unit().max(0.01) } else { robot(map.lattice()).radius_m };
        let body = Robot { radius_m, can_reverse: rng.chance(0.5), ..Robot::default() };
        let execution = Execution::new(&map, &schedule, &body, troubles(&plan, &mut rng)).unwrap();
        let mut again = rng.clone();
        let executed = execution.trial(&mut rng).unwrap_or_else(|fault| panic!("{seed}: {fault}"));
        rings += schedule.rings().len();
        late = late.max(executed.makespan() - plan.makespan() as f64);
        assert_eq!(execution.trial(&mut again).as_ref(), Ok(&executed), "the same seed gives the same");
    }
    println!("{rings} rings turned; the latest came {late:.0} steps after the plan");
    assert!(rings > 1000);
}

#[test]
fn rings_turn_on_both_lattices_and_bodies_too_large_for_them_are_refused() {
    for (lattice, text, ring, most) in [
        (Lattice::Square, "..\n..", vec![(0, 0), (1, 0), (1, 1), (0, 1)], 0.34),
        (Lattice::Hex, "..\n..", vec![(0, 0), (1, 0), (0, 1)], 0.24),
        (Lattice::Hex, "...\n...\n...", vec![(1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 1)], 0.42),
    ] {
        let map = Map::parse(lattice, text).unwrap();
        let cells: Vec<Cell> = ring.iter().map(|&(x, y)| Cell::new(x, y)).collect();
        let rounds = 1 + 3 * cells.len();
        let plan: Vec<Cell> = (0..rounds)
            .flat_map(|step| (0..cells.len()).map(move |robot| robot + step))
            .map(|place| cells[place % cells.len()])
            .collect();
        let plan = Plan::new(cells.len(), plan).unwrap();
        let schedule = Schedule::new(&map, &plan).unwrap();
        assert_eq!(schedule.rings().len(), rounds - 1);
        let body = |radius_m| Robot { radius_m, ..Robot::default() };
        let error = Runner::new(&map, &schedule, &body(most + 0.01)).unwrap_err();
        assert!(matches!(error, Error::BadValue { .. }), "{error}");
        for seed in 0..50 {
            let delays =
                Delays { chance: 0.4, most_steps: 20, slow_share: 0.3, slow_speed: 0.3, ..Delays::default() };
            let execution = Execution::new(&map, &schedule, &body(most), delays).unwrap();
            execution.trial(&mut Rng::new(seed)).unwrap_or_else(|fault| panic!("{lattice} {seed}: {fault}"));
        }
    }
}
