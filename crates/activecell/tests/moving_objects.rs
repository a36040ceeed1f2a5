//! Robots among moving objects: drives in random worlds, looked at by a checker that knows no plan.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::predict::{Avoider, Bounds, Plan, Slots, Step, Track, first_contact};
use activecell::{Cell, Frame, Lattice, Map, PointM, Rng};
use std::collections::BTreeMap;

/// Ways of objects are cut into pieces of constant acceleration of this length.
const PIECE_S: f64 = 0.05;
const PIECES_A_SLOT: usize = 20;
/// Objects are seen after so many pieces.
const SEEN_EVERY: usize = 5;
const SLOT_S: f64 = PIECE_S * PIECES_A_SLOT as f64;

/// How an object goes on.
#[derive(Debug, Clone, Copy)]
enum Habit {
    Straight,
    Circles {
        turn_radps: f64,
    },
    /// To and fro: slower towards the ends, as the bound of acceleration demands.
    Patrols {
        middle_m: PointM,
        rate_radps: f64,
    },
    /// A new acceleration each second, back towards the middle of the floor where it strays.
    Wanders,
    Parked,
}

#[derive(Debug, Clone)]
struct Object {
    bounds: Bounds,
    habit: Habit,
    at_m: PointM,
    velocity_mps: PointM,
    push_mps2: PointM,
    way: Vec<(f64, PointM)>,
}

fn shortened(v: PointM, most: f64) -> PointM {
    let length = v[0].hypot(v[1]);
    if length > most { v.map(|x| x * most / length) } else { v }
}

impl Object {
    fn random(map: &Map, rng: &mut Rng) -> Self {
        let [width, height] = map.size_m();
        let at_m = [width * rng.unit(), height * rng.unit()];
        let bounds = Bounds {
            radius_m: 0.15 + 0.25 * rng.unit(),
            max_speed_mps: 0.5 + 0.7 * rng.unit(),
            max_accel_mps2: 0.1 + 0.4 * rng.unit(),
            seen_within_m: 0.03 * rng.unit(),
        };
        let (speed, bearing) = (0.95 * bounds.max_speed_mps * rng.unit(), 6.3 * rng.unit());
        let velocity_mps = [speed * bearing.cos(), speed * bearing.sin()];
        let turn_radps = 0.9 * bounds.max_accel_mps2 / speed.max(0.1) * (2.0 * rng.unit() - 1.0);
        // Harmonic motion: speed A ω and acceleration A ω² at the most.
        let rate_radps = 0.9 * bounds.max_accel_mps2 / speed.max(0.1);
        let habit = match rng.below(5) {
            0 => Habit::Straight,
            1 => Habit::Circles { turn_radps },
            2 => Habit::Patrols { middle_m: at_m, rate_radps },
            3 => Habit::Wanders,
            _ => Habit::Parked,
        };
        let velocity_mps = if matches!(habit, Habit::Parked) { [0.0; 2] } else { velocity_mps };
        Self { bounds, habit, at_m, velocity_mps, push_mps2: [0.0; 2], way: vec![(0.0, at_m)] }
    }

    /// One piece of its way, within its bounds.
    fn go_on(&mut self, size_m: PointM, piece: usize, rng: &mut Rng) {
        let ([x, y], [vx, vy]) = (self.at_m, self.velocity_mps);
        let wanted = match self.habit {
            Habit::Straight | Habit::Parked => [0.0; 2],
            Habit::Circles { turn_radps } => [-turn_radps * vy, turn_radps * vx],
            Habit::Patrols { middle_m, rate_radps } => {
                [0, 1].map(|k| -rate_radps * rate_radps * (self.at_m[k] - middle_m[k]))
            }
            Habit::Wanders => {
                if piece.is_multiple_of(20) {
                    let push = self.bounds.max_accel_mps2;
                    self.push_mps2 = [0, 1].map(|_| push * (2.0 * rng.unit() - 1.0));
                }
                let strayed = x < 0.0 || y < 0.0 || x > size_m[0] || y > size_m[1];
                if strayed { [size_m[0] / 2.0 - x, size_m[1] / 2.0 - y] } else { self.push_mps2 }
            }
        };
        let push = shortened(wanted, 0.99 * self.bounds.max_accel_mps2);
        let faster = [vx + push[0] * PIECE_S, vy + push[1] * PIECE_S];
        let velocity = shortened(faster, self.bounds.max_speed_mps);
        self.at_m = [0, 1].map(|k| self.at_m[k] + f64::midpoint(self.velocity_mps[k], velocity[k]) * PIECE_S);
        self.velocity_mps = velocity;
        self.way.push((PIECE_S * (piece + 1) as f64, self.at_m));
    }

    fn seen(&self, rng: &mut Rng) -> PointM {
        let (far, angle) = (self.bounds.seen_within_m * rng.unit().sqrt(), 6.3 * rng.unit());
        [self.at_m[0] + far * angle.cos(), self.at_m[1] + far * angle.sin()]
    }
}

#[derive(Debug, Default)]
struct Drive {
    arrived: bool,
    slots: usize,
    waits: usize,
    /// Slots for which no safe step was found.
    helpless: usize,
    /// Contacts in slots that the plan had called safe.
    broken: usize,
    /// Contacts in helpless slots.
    run_over: usize,
    cells: Vec<Cell>,
}

struct Drives<'a> {
    map: &'a Map,
    from: Cell,
    to: Cell,
    slots: Slots,
    objects: Vec<Object>,
}

impl Drives<'_> {
    fn drive(mut self, most: usize, rng: &mut Rng) -> Drive {
        let mut avoider = Avoider::new(self.map, self.to, self.slots).unwrap();
        let mut tracks = BTreeMap::new();
        let size_m = self.map.size_m();
        let mut drive = Drive { cells: vec![self.from], ..Drive::default() };
        let mut cell = self.from;
        let mut promised = 0;
        // The objects are watched for a second before the robot sets out.
        for slot in 0..=most {
            let begin = slot * PIECES_A_SLOT;
            let plan = (slot > 0).then(|| avoider.plan(&tracks, cell, PIECE_S * begin as f64).unwrap());
            let next = plan.as_ref().map_or(cell, |plan| self.after(cell, plan));
            if let Some(plan) = &plan {
                assert!(
                    plan.is_safe() || plan.safe_slots() + 1 >= promised,
                    "{promised} were promised: {plan:?}"
                );
                promised = plan.safe_slots();
                drive.slots += 1;
                drive.waits += usize::from(next == cell);
                drive.helpless += usize::from(plan.step() == Step::NoSafeStep);
            }
            for piece in begin..begin + PIECES_A_SLOT {
                for (name, object) in (0..).zip(&mut self.objects) {
                    if piece.is_multiple_of(SEEN_EVERY) || piece + 1 == begin + PIECES_A_SLOT {
                        let track = tracks.entry(name).or_insert_with(|| Track::new(object.bounds).unwrap());
                        assert!(track.may_be_at(PIECE_S * piece as f64, object.at_m), "{object:?}");
                        if piece.is_multiple_of(SEEN_EVERY) {
                            assert!(track.observe(PIECE_S * piece as f64, object.seen(rng)).unwrap());
                        }
                    }
                    object.go_on(size_m, piece, rng);
                }
            }
            if let Some(plan) = &plan {
                let contact = self.contact(slot, cell, next, rng);
                drive.broken += usize::from(contact && plan.step() != Step::NoSafeStep);
                drive.run_over += usize::from(contact && plan.step() == Step::NoSafeStep);
                drive.cells.push(next);
                if next == self.to {
                    drive.arrived = true;
                    break;
                }
            }
            cell = next;
        }
        drive
    }

    fn after(&self, cell: Cell, plan: &Plan) -> Cell {
        match plan.step() {
            Step::Go(dir) => self.map.lattice().neighbour(cell, dir),
            Step::Wait | Step::NoSafeStep => cell,
        }
    }

    /// Whether the robot, which moves at any time of the slot, touches an object in it.
    fn contact(&self, slot: usize, cell: Cell, next: Cell, rng: &mut Rng) -> bool {
        let begin_s = SLOT_S * slot as f64;
        let (sets_out, takes) = (0.5 * rng.unit(), 0.5 * rng.unit());
        let (from, to) = (self.map.centre_m(cell), self.map.centre_m(next));
        let robot = [
            (begin_s, from),
            (begin_s + SLOT_S * sets_out, from),
            (begin_s + SLOT_S * (sets_out + takes), to),
            (begin_s + SLOT_S, to),
        ];
        self.objects.iter().any(|object| {
            // Straight pieces cut the curves by less than a PIECE_S² ÷ 8.
            let slack = object.bounds.max_accel_mps2 * PIECE_S * PIECE_S / 8.0;
            let radii = self.slots.robot_radius_m + object.bounds.radius_m - slack - 1e-9;
            let way = &object.way[slot * PIECES_A_SLOT..];
            first_contact(&robot, way, radii).is_some()
        })
    }
}

fn random_worlds(count: u64, objects: u32) -> Vec<Drive> {
    let mut drives = Vec::new();
    for seed in 0..count {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let frame = Frame { cell_m: 0.6 + 0.4 * rng.unit(), ..Frame::default() };
        let map = Map::random(lattice, 16, 14, 0.15 * rng.unit(), seed).unwrap().in_frame(frame).unwrap();
        let free: Vec<Cell> = map.free().collect();
        let from = free[rng.below(free.len() as u32) as usize];
        let to = free[rng.below(free.len() as u32) as usize];
        let field = map.wave(to).unwrap();
        if from == to || field.steps(from).is_none() {
            continue;
        }
        let slots = Slots { slot_s: SLOT_S, robot_radius_m: 0.1 + 0.15 * rng.unit(), ..Slots::default() };
        let objects: Vec<Object> = (0..=rng.below(objects)).map(|_| Object::random(&map, &mut rng)).collect();
        // A task whose start or target is parked on from the beginning is none.
        let open = |cell: Cell| {
            let [x, y] = map.centre_m(cell);
            objects.iter().all(|object| {
                let apart = (object.at_m[0] - x).hypot(object.at_m[1] - y);
                apart > object.bounds.radius_m + slots.robot_radius_m + 1.0
            })
        };
        if open(from) && open(to) {
            drives.push(Drives { map: &map, from, to, slots, objects }.drive(300, &mut rng));
        }
    }
    drives
}

#[test]
fn no_contact_while_the_plan_is_safe() {
    let drives = random_worlds(3000, 4);
    let sum = |f: fn(&Drive) -> usize| drives.iter().map(f).sum::<usize>();
    let arrived = sum(|d| d.arrived.into());
    println!(
        "{} drives: {arrived} arrived ({:.1} %), {} slots, {} of them waiting; {} slots without a safe step in {} drives; contacts: {} promised safe, {} else",
        drives.len(),
        100.0 * arrived as f64 / drives.len() as f64,
        sum(|d| d.slots),
        sum(|d| d.waits),
        sum(|d| d.helpless),
        sum(|d| (d.helpless > 0).into()),
        sum(|d| d.broken),
        sum(|d| d.run_over),
    );
    assert_eq!(sum(|d| d.broken), 0);
    assert!(drives.len() > 2000 && arrived * 100 > drives.len() * 99);
    assert!(sum(|d| (d.helpless > 0).into()) * 100 < 3 * drives.len());
}

/// A robot of 0.2 m on cells of 1 m, and one object that comes straight on.
fn meet(map: &Map, at_m: PointM, velocity_mps: PointM, habit: Habit) -> Drive {
    let bounds = Bounds { radius_m: 0.25, max_speed_mps: 0.6, max_accel_mps2: 0.05, seen_within_m: 0.01 };
    let object = Object { bounds, habit, at_m, velocity_mps, push_mps2: [0.0; 2], way: vec![(0.0, at_m)] };
    let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
    let slots = Slots { slot_s: SLOT_S, ..Slots::default() };
    let drives = Drives { map, from, to, slots, objects: vec![object] };
    let drive = drives.drive(200, &mut Rng::new(1));
    assert_eq!((drive.broken, drive.run_over, drive.helpless), (0, 0, 0), "{drive:?}");
    assert!(drive.arrived, "{drive:?}");
    drive
}

#[test]
fn the_robot_waits_for_an_object_that_crosses() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "####.#####\n####.#####\nS........F\n####.#####\n####.#####").unwrap();
        let [x, y] = map.centre_m(Cell::new(4, 2));
        let drive = meet(&map, [x, y + 2.5], [0.0, -0.5], Habit::Straight);
        assert!(drive.waits >= 1, "{drive:?}");
        let back = drive.cells.windows(2).any(|pair| pair[1].x < pair[0].x);
        assert!(!back, "{lattice}: {:?}", drive.cells);
    }
}

#[test]
fn the_robot_goes_aside_for_an_object_that_comes_along_its_corridor() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "############\nS..........F\n###.########\n###.########").unwrap();
        let [x, y] = map.centre_m(Cell::new(11, 1));
        let drive = meet(&map, [x + 2.0, y], [-0.5, 0.0], Habit::Straight);
        assert!(drive.cells.iter().any(|cell| cell.y > 1), "{lattice}: {:?}", drive.cells);
    }
}

#[test]
fn the_robot_goes_round_a_parked_object_however_long_the_way() {
    let way = ".".repeat(40);
    let text = format!(".S...F{way}\n.####.{}\n.####.{}\n.....{way}.", ".".repeat(40), ".".repeat(40));
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, &text).unwrap();
        let drive = meet(&map, map.centre_m(Cell::new(3, 0)), [0.0, 0.0], Habit::Parked);
        let alone = map.wave(map.mark('F').unwrap()).unwrap().steps(map.mark('S').unwrap()).unwrap();
        assert!(drive.cells.len() as u32 > alone + 6, "{lattice}: {:?}", drive.cells);
        assert!(drive.slots < 30, "{lattice}: {drive:?}");
    }
}

/// Objects that move as the filter believes: its innovations and its forecasts are as uncertain as it says.
#[test]
fn the_filter_knows_how_uncertain_it_is() {
    let (seen_std_m, wander, turn) = (0.03, 0.1, 0.6);
    for (true_turn, rates) in
        [(0.0, vec![0.0]), (0.0, vec![0.0, turn, -turn]), (turn, vec![turn]), (turn, vec![0.0, turn, -turn])]
    {
        let (mut innovations, mut count, mut inside, mut forecasts) = (0.0, 0, [0, 0], 0);
        for seed in 0..600 {
            let mut rng = Rng::new(seed);
            let mut filter = activecell::predict::Turning::new(seen_std_m, wander, 0.5, &rates);
            let (mut at, mut v): (PointM, PointM) = ([0.0; 2], [0, 1].map(|_| 0.5 * rng.normal()));
            let mut waiting = None;
            for i in 0..120 {
                let t = 0.25 * f64::from(i);
                let seen = at.map(|x| x + seen_std_m * rng.normal());
                filter.observe(t, seen);
                if i >= 40 {
                    innovations += filter.normalized_innovation().unwrap();
                    count += 1;
                }
                if i == 60 {
                    waiting = filter.forecast(t + 2.0);
                }
                if let (68, Some(forecast)) = (i, waiting) {
                    let off = (at[0] - forecast.at_m[0]).hypot(at[1] - forecast.at_m[1]);
                    forecasts += 1;
                    inside[0] += usize::from(off <= forecast.radius_m(0.5));
                    inside[1] += usize::from(off <= forecast.radius_m(0.95));
                }
                // 50 small pieces, each a turn and a push of white noise.
                for _ in 0..50 {
                    let piece = 0.25 / 50.0_f64;
                    let (sin, cos) = (true_turn * piece).sin_cos();
                    let before = v;
                    v = [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
                    v = v.map(|x| x + wander * piece.sqrt() * rng.normal());
                    at = [0, 1].map(|k| at[k] + f64::midpoint(before[k], v[k]) * piece);
                }
            }
        }
        let mean = innovations / f64::from(count);
        let share = inside.map(|n| n as f64 / f64::from(forecasts));
        println!("turn {true_turn}, {} models: innovation {mean:.3}, inside 50 %: {share:.3?}", rates.len());
        let (slack, least) = if rates.len() == 1 { (0.05, 0.93) } else { (0.4, 0.9) };
        assert!((mean - 2.0).abs() < slack && share[1] > least, "{mean} {share:?}");
    }
}

#[test]
fn what_breaks_its_bounds_is_noticed_and_begun_anew() {
    let bounds = Bounds { radius_m: 0.3, max_speed_mps: 1.0, max_accel_mps2: 0.2, seen_within_m: 0.01 };
    let mut track = Track::new(bounds).unwrap();
    assert!(track.observe(0.0, [0.0, 0.0]).unwrap() && track.observe(1.0, [0.5, 0.0]).unwrap());
    assert!(!track.observe(2.0, [0.5, 0.9]).unwrap(), "it turned at once");
    assert!((track.breaks(), track.observe(3.0, [0.5, 1.8]).unwrap()) == (1, true));
    assert!(track.observe(3.0, [0.5, 1.8]).is_err() && track.observe(4.0, [f64::NAN, 0.0]).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(Track::new(Bounds { max_accel_mps2: bad, ..bounds }).is_err());
        assert!(Slots { slot_s: bad, ..Slots::default() }.checked().is_err());
    }
    assert!(Slots { certain: 20, likely: 12, ..Slots::default() }.checked().is_err());
    assert!(Slots { certain: 0, ..Slots::default() }.checked().is_err());
    // Of an object that was never seen nothing is known: everything is closed.
    let map = Map::parse(Lattice::Hex, "S..\n...\n..F").unwrap();
    let mut avoider = Avoider::new(&map, map.mark('F').unwrap(), Slots::default()).unwrap();
    let tracks = BTreeMap::from([(1, Track::new(bounds).unwrap())]);
    assert_eq!(avoider.plan(&tracks, map.mark('S').unwrap(), 0.0).unwrap().step(), Step::NoSafeStep);
    assert!(avoider.plan(&tracks, Cell::new(9, 9), 0.0).is_err());
    assert!(avoider.plan(&tracks, Cell::new(0, 0), f64::NAN).is_err());
}
