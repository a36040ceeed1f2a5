//! Temporary gallery.
use activecell::*;
use activecell_picture::*;
use std::time::Instant;
fn solve(map: &Map, from: Cell, to: Cell) -> (Vec<Option<u32>>, Vec<Cell>, Vec<Cell>) {
    let l = map.lattice();
    let mut wave = vec![None; map.cells()];
    let mut q = std::collections::VecDeque::from([to]);
    wave[map.index(to).unwrap()] = Some(0);
    while let Some(c) = q.pop_front() {
        for d in l.dirs() {
            let n = l.neighbour(c, d);
            if map.is_free(n) && wave[map.index(n).unwrap()].is_none() {
                wave[map.index(n).unwrap()] = Some(wave[map.index(c).unwrap()].unwrap() + 1);
                q.push_back(n);
            }
        }
    }
    let (mut cells, mut turns) = (vec![from], vec![]);
    let mut cur = from;
    let mut heading = None;
    while cur != to {
        let here: u32 = match wave[map.index(cur).unwrap()] {
            Some(h) => h,
            None => break,
        };
        let ok = |d: &Dir| {
            map.index(l.neighbour(cur, *d)).and_then(|i| wave[i]).is_some_and(|s: u32| s + 1 == here)
        };
        let d = heading.filter(ok).or_else(|| l.dirs().find(ok)).unwrap();
        if heading.is_some_and(|h| h != d) {
            turns.push(cur);
        }
        heading = Some(d);
        cur = l.neighbour(cur, d);
        cells.push(cur);
    }
    (wave, cells, turns)
}
fn office(lattice: Lattice, w: u32, h: u32, room: u32) -> Map {
    let mut b = BitPlane::new(w.into(), h.into()).unwrap();
    let mut r = Rng::new(5);
    for y in 0..h {
        for x in 0..w {
            let wall = (x % room == 0 && (y % room) * 3 / room != 1)
                || (y % room == 0 && (x % room) * 3 / room != 1);
            let edge = x == 0 || y == 0 || x + 1 == w || y + 1 == h;
            b.set(x, y, wall || edge || r.chance(0.03));
        }
    }
    Map::new(lattice, b)
}
fn main() {
    let dir = std::path::PathBuf::from("/tmp/gallery");
    std::fs::create_dir_all(&dir).unwrap();
    let only: Vec<String> = std::env::args().skip(1).collect();
    let show = |name: &str, map: &Map, from: Cell, to: Cell, with_wave: bool| {
        if !only.is_empty() && !only.iter().any(|o| name.contains(o.as_str())) {
            return;
        }
        let from = map.nearest_free(from).unwrap();
        let to = map.nearest_free(to).unwrap();
        let (wave, cells, turns) = solve(map, from, to);
        let title = format!(
            "{name}.yaml · {} · wave: {} steps, {} turns, {:.1} m",
            if map.lattice() == Lattice::Hex { "hexagonal" } else { "square" },
            cells.len() - 1,
            turns.len(),
            (cells.len() - 1) as f64 * map.frame().cell_m
        );
        let p = RoutePicture {
            map,
            title: &title,
            from,
            to,
            cells: &cells,
            turns: &turns,
            cycle: &[],
            wave: with_wave.then_some(&wave[..]),
        };
        let t = Instant::now();
        let s = svg(&p);
        let ts = t.elapsed();
        let t = Instant::now();
        let n = png(&p).unwrap();
        let tp = t.elapsed();
        let t = Instant::now();
        let g = gif(&p).unwrap();
        let tg = t.elapsed();
        println!(
            "{name}: svg {} kB {ts:.0?}, png {} kB {tp:.0?}, gif {} kB {tg:.0?}",
            s.len() / 1000,
            n.len() / 1000,
            g.len() / 1000
        );
        std::fs::write(dir.join(format!("{name}.svg")), s).unwrap();
        std::fs::write(dir.join(format!("{name}.png")), n).unwrap();
        std::fs::write(dir.join(format!("{name}.gif")), g).unwrap();
    };
    for l in Lattice::ALL {
        let c = Cell::new;
        let small = Map::parse(l, "......\n.##...\n..#.#.\n..#.#.\n....#.\n......").unwrap();
        show(&format!("small-{l}"), &small, c(0, 2), c(5, 3), false);
        show(&format!("smallwave-{l}"), &small, c(0, 2), c(5, 3), true);
        let mid = Map::random(l, 30, 18, 0.25, 3)
            .unwrap()
            .in_frame(Frame { cell_m: 0.5, ..Frame::default() })
            .unwrap();
        show(&format!("mid-{l}"), &mid, c(1, 1), c(28, 16), true);
        let off = office(l, 81, 61, 20).in_frame(Frame { cell_m: 0.25, ..Frame::default() }).unwrap();
        show(&format!("office-{l}"), &off, c(2, 2), c(77, 57), true);
        let big = office(l, 401, 301, 50).in_frame(Frame { cell_m: 0.05, ..Frame::default() }).unwrap();
        show(&format!("building-{l}"), &big, c(3, 3), c(396, 296), true);
        for n in [512u32, 1024] {
            let m = Map::random(l, n, n, 0.2, 7).unwrap();
            show(&format!("random{n}-{l}"), &m, c(3, 3), c(n as i32 - 4, n as i32 - 4), true);
        }
        let strip = Map::random(l, 3000, 20, 0.1, 7).unwrap();
        show(&format!("strip-{l}"), &strip, c(3, 3), c(2990, 15), true);
        let one = Map::parse(l, ".").unwrap();
        show(&format!("one-{l}"), &one, c(0, 0), c(0, 0), true);
        let map = Map::parse(
            l,
            ".........\n.#######.\n.......#.\n.###...#.\n...#...#.\n.......#.\n########.\n.........",
        )
        .unwrap();
        let cyc = [c(4, 2), c(5, 2), c(6, 2), c(6, 3), c(6, 4), c(5, 4), c(4, 4), c(4, 3)];
        let mut cells = vec![c(0, 5), c(1, 5), c(2, 5), c(3, 5), c(4, 5), c(5, 5), c(5, 4)];
        if l == Lattice::Square {
            cells.extend([c(4, 4), c(4, 3), c(4, 2), c(5, 2), c(6, 2), c(6, 3), c(6, 4), c(5, 4)]);
        }
        let title = "trap.yaml · published rule: trapped in a circle of 8 cells after 6 steps, with a title that is too long";
        let p = RoutePicture {
            map: &map,
            title,
            from: c(0, 5),
            to: c(8, 7),
            cells: &cells,
            turns: &[c(5, 5), c(4, 4), c(4, 2)],
            cycle: &cyc,
            wave: None,
        };
        std::fs::write(dir.join(format!("trap-{l}.svg")), svg(&p)).unwrap();
        std::fs::write(dir.join(format!("trap-{l}.png")), png(&p).unwrap()).unwrap();
        std::fs::write(dir.join(format!("trap-{l}.gif")), gif(&p).unwrap()).unwrap();
        if only.iter().any(|o| o == "term") {
            let (wave, cells, turns) =
                solve(&mid, mid.nearest_free(c(1, 1)).unwrap(), mid.nearest_free(c(28, 16)).unwrap());
            let q = RoutePicture {
                map: &mid,
                title,
                from: cells[0],
                to: *cells.last().unwrap(),
                cells: &cells,
                turns: &turns,
                cycle: &[],
                wave: Some(&wave),
            };
            println!("{}", terminal(&p, 80, 24, false));
            println!("{}", terminal(&q, 80, 24, false));
            println!("{}", terminal(&q, 25, 24, false));
        }
        if only.iter().any(|o| o == "huge") {
            let t = Instant::now();
            let m = Map::random(l, 1 << 14, 1 << 14, 0.4, 7).unwrap();
            println!("made {:.0?}", t.elapsed());
            let cells: Vec<Cell> = (0..16000).map(|i| c(i, i)).collect();
            let p = RoutePicture {
                map: &m,
                title: "huge",
                from: c(0, 0),
                to: c(15999, 15999),
                cells: &cells,
                turns: &[],
                cycle: &[],
                wave: None,
            };
            let t = Instant::now();
            let s = svg(&p);
            println!("huge svg {} kB {:.0?}", s.len() / 1000, t.elapsed());
            let t = Instant::now();
            let s = png(&p).unwrap();
            println!("huge png {} kB {:.0?}", s.len() / 1000, t.elapsed());
            std::fs::write(dir.join(format!("huge-{l}.png")), s).unwrap();
            let t = Instant::now();
            let s = gif(&p).unwrap();
            println!("huge gif {} kB {:.0?}", s.len() / 1000, t.elapsed());
            let t = Instant::now();
            let s = terminal(&p, 100, 40, false);
            println!("huge term {} {:.0?}", s.len(), t.elapsed());
        }
    }
}
