//! Pictures of groups: the same bytes, limits kept, both lattices, plans that are wrong.

#![expect(clippy::unwrap_used, reason = "tests stop at what they did not expect")]

use activecell::{Cell, Lattice, Map, Plan, Team};
use activecell_picture::{FilmLimits, FleetPicture, FleetView, fleet_gif, fleet_png, fleet_svg};

/// Robots that walk to and fro in their rows, each as far as its number says.
fn case(lattice: Lattice, robots: i32, steps: usize) -> (Map, Team, Plan) {
    let map = Map::random(lattice, 24, robots as u32, 0.0, 1).unwrap();
    let at = |step: usize, robot: i32| {
        let there = step as i32 % 46;
        Cell::new(if there < 24 { there } else { 46 - there }, robot)
    };
    let row = |step: usize| (0..robots).map(move |robot| at(step, robot));
    let team = Team::new(&map, row(0).collect(), row(steps).collect()).unwrap();
    let plan = Plan::new(robots as usize, (0..=steps).flat_map(row).collect()).unwrap();
    (map, team, plan)
}

fn picture<'a>(map: &'a Map, team: &'a Team, plan: &'a Plan, view: FleetView) -> FleetPicture<'a> {
    FleetPicture { map, title: "rows <1>", team, plan, lower_bound: Some(7), endless: false, view }
}

fn frames(data: &[u8]) -> (usize, [u16; 2]) {
    let mut decoder = gif::DecodeOptions::new().read_info(data).unwrap();
    let size = [decoder.width(), decoder.height()];
    let mut frames = 0;
    while decoder.read_next_frame().unwrap().is_some() {
        frames += 1;
    }
    (frames, size)
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    for lattice in Lattice::ALL {
        let (map, team, plan) = case(lattice, 9, 60);
        for view in [FleetView::Ways, FleetView::Traffic] {
            let drawn = picture(&map, &team, &plan, view);
            assert_eq!(fleet_svg(&drawn), fleet_svg(&drawn));
            assert!(
                fleet_svg(&drawn)
                    .contains("rows &lt;1&gt; · 9 robots, 60 steps, sum of costs 540 (lower bound 7)")
            );
            assert_eq!(fleet_png(&drawn).unwrap(), fleet_png(&drawn).unwrap());
        }
        let drawn = picture(&map, &team, &plan, FleetView::Fitting);
        let film = fleet_gif(&drawn, &FilmLimits::default()).unwrap();
        assert_eq!(film, fleet_gif(&drawn, &FilmLimits::default()).unwrap());
        assert_eq!((film.frames_a_step, film.steps_a_frame, film.frames), (6, 1, 361));
        assert_eq!(frames(&film.gif).0, 361);
    }
}

#[test]
fn runs_without_end_have_no_targets_and_no_costs() {
    let (map, team, plan) = case(Lattice::Hex, 3, 20);
    for view in [FleetView::Ways, FleetView::Traffic] {
        let drawn = FleetPicture { endless: true, ..picture(&map, &team, &plan, view) };
        let svg = fleet_svg(&drawn);
        assert!(svg.contains("rows &lt;1&gt; · 3 robots, 20 steps<"), "{svg}");
        assert!(!svg.contains("target") && !svg.contains("sum of costs"), "{svg}");
        assert_eq!(svg.contains("at the end"), view == FleetView::Ways);
    }
}

#[test]
fn films_keep_their_limits() {
    let (map, team, plan) = case(Lattice::Square, 12, 200);
    let drawn = picture(&map, &team, &plan, FleetView::Fitting);
    let whole = fleet_gif(&drawn, &FilmLimits::default()).unwrap();
    assert!(frames(&whole.gif).1[0] <= 1020 + 32);
    for bytes in [whole.gif.len() / 2, whole.gif.len() / 10] {
        let film = fleet_gif(&drawn, &FilmLimits { bytes, ..FilmLimits::default() }).unwrap();
        assert!(film.gif.len() <= bytes && film.frames < whole.frames);
        assert!(film.gif.len() > bytes / 4, "{} of {bytes} bytes used", film.gif.len());
    }
    let film = fleet_gif(&drawn, &FilmLimits { map_px: [240, 240], frames: 20, bytes: 1 << 30 }).unwrap();
    assert!(film.frames <= 20 && film.steps_a_frame == 11);
    // No limit makes it hang or fail.
    let film = fleet_gif(&drawn, &FilmLimits { map_px: [0, 0], frames: 0, bytes: 0 }).unwrap();
    assert!(film.frames <= 3 && frames(&film.gif).0 <= 3);
}

#[test]
fn many_robots_take_little_space() {
    let (map, team, plan) = case(Lattice::Square, 500, 300);
    let ways = fleet_svg(&picture(&map, &team, &plan, FleetView::Ways));
    let fitting = fleet_svg(&picture(&map, &team, &plan, FleetView::Fitting));
    assert!(ways.len() < 500_000 && fitting.len() < 100_000, "{} {}", ways.len(), fitting.len());
    // Six times to and fro, then 24 steps: all cells but the ends 13 times, the last but one, 4 % of all, 14 times.
    let legend = fitting.lines().find(|line| line.contains("visits a cell")).unwrap();
    assert!(legend.contains("visits a cell: 1 to 14 or more"), "{legend}");
}

#[test]
fn strange_plans_are_drawn() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "A#B\n...").unwrap();
        let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
        let team = Team::new(&map, vec![a], vec![b]).unwrap();
        let none = Team::new(&map, vec![], vec![]).unwrap();
        let far = Cell::new(i32::MAX, i32::MIN);
        for (team, plan) in [
            (&none, Plan::new(0, vec![]).unwrap()),
            (&team, Plan::new(1, vec![a]).unwrap()),
            (&team, Plan::new(1, vec![far, a, far]).unwrap()),
            (&team, Plan::new(2, vec![a, b, b, far]).unwrap()),
            (&none, Plan::new(2, vec![a, b, b, a]).unwrap()),
        ] {
            for view in [FleetView::Ways, FleetView::Traffic] {
                let drawn = picture(&map, team, &plan, view);
                assert!(fleet_png(&drawn).is_ok() && fleet_svg(&drawn).ends_with("</svg>\n"));
                assert!(fleet_gif(&drawn, &FilmLimits::default()).unwrap().gif.starts_with(b"GIF89a"));
            }
        }
    }
}
