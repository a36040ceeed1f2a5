//! Draws a group: `fleet MAP SCEN|random ROBOTS OUT [SQUARE|hex [SECONDS [WIDTH HEIGHT FRAMES BYTES]]]` writes OUT.svg,
//! OUT.png and OUT.gif.

#![expect(clippy::print_stdout, reason = "an example that says what it wrote")]

use activecell::{Lattice, Map, Team, check_plan};
use activecell_fleet::{Limits, Options, solve};
use activecell_formats::movingai::{read_map, read_scen};
use activecell_picture::{FilmLimits, FleetPicture, FleetView, fleet_gif, fleet_png, fleet_svg};
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [path, scen, robots, out, rest @ ..] = args.as_slice() else {
        return Err("fleet MAP SCEN|random ROBOTS OUT [LATTICE [SECONDS [WIDTH HEIGHT FRAMES BYTES]]]".into());
    };
    let lattice = if rest.first().is_some_and(|name| name == "hex") { Lattice::Hex } else { Lattice::Square };
    let bytes = std::fs::read(path)?;
    let map = if std::path::Path::new(path).extension().is_some_and(|end| end == "map") {
        read_map(&bytes)?.on(lattice)
    } else {
        Map::parse(lattice, &String::from_utf8(bytes)?)?
    };
    let team = team(&map, scen, robots.parse()?)?;
    let seconds: f64 = rest.get(1).map_or(Ok(5.0), |text| text.parse())?;
    let limits = Limits { time: Some(Duration::from_secs_f64(seconds)), ..Limits::default() };
    let outcome = solve(&map, &team, &Options { seed: 0, threads: 2, limits }, |_| {})?;
    let plan = outcome.plan.ok_or("no plan")?;
    check_plan(&map, &team, &plan)?;
    let name = std::path::Path::new(path).file_stem().and_then(|name| name.to_str()).unwrap_or_default();
    let lower_bound = Some(outcome.lower_bound);
    let picture = FleetPicture {
        map: &map,
        title: name,
        team: &team,
        plan: &plan,
        lower_bound,
        endless: false,
        view: FleetView::Fitting,
    };
    let number = |i: usize, usual: usize| rest.get(i).map_or(Ok(usual), |text: &String| text.parse());
    let usual = FilmLimits::default();
    let map_px = [number(2, 1020)? as u32, number(3, 720)? as u32];
    let limits = FilmLimits { map_px, frames: number(4, usual.frames)?, bytes: number(5, usual.bytes)? };
    let clock = Instant::now();
    let svg = fleet_svg(&picture);
    let png = fleet_png(&picture)?;
    let still_s = clock.elapsed().as_secs_f64();
    let film = fleet_gif(&picture, &limits)?;
    println!(
        "svg {} kB, png {} kB in {still_s:.1} s; gif {} kB in {:.1} s: {} frames, {} a step, {} steps a frame",
        svg.len() / 1000,
        png.len() / 1000,
        film.gif.len() / 1000,
        clock.elapsed().as_secs_f64() - still_s,
        film.frames,
        film.frames_a_step,
        film.steps_a_frame
    );
    std::fs::write(format!("{out}.svg"), svg)?;
    std::fs::write(format!("{out}.png"), png)?;
    std::fs::write(format!("{out}.gif"), film.gif)?;
    Ok(())
}

fn team(map: &Map, scen: &str, robots: usize) -> Result<Team, Failure> {
    if scen != "random" {
        let rows = read_scen(&std::fs::read(scen)?)?;
        let rows = &rows[..robots.min(rows.len())];
        return Ok(Team::new(
            map,
            rows.iter().map(|row| row.from).collect(),
            rows.iter().map(|row| row.to).collect(),
        )?);
    }
    Ok(Team::random(map, robots, 1)?)
}
