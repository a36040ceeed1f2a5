//! Pictures of all kinds, read back: their sizes, their colours at known cells, and that nothing strange breaks them.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use activecell::{Cell, Lattice, Map, Region};
use activecell_picture::{RoutePicture, Wave, gif, map_svg, png, svg, terminal};
use tiny_skia::Pixmap;

const FLOOR: &str = "......\n.##...\n..#.#.\n..#.#.\n....#.\n......";
const FROM: Cell = Cell::new(0, 2);
const TO: Cell = Cell::new(5, 5);

/// A route along the left and the lower edge: steps East are steps on both lattices, odd rows of hexagons lie
/// right of even ones.
fn route() -> Vec<Cell> {
    let down = (2..5).map(|y| Cell::new(0, y));
    down.chain((0..6).map(|x| Cell::new(x, 5))).collect()
}

fn floor(lattice: Lattice) -> Map {
    Map::parse(lattice, FLOOR).unwrap()
}

fn wave(map: &Map) -> impl Fn(Cell) -> Option<u32> {
    let field = map.wave(TO).unwrap();
    move |cell| field.steps(cell)
}

fn picture<'a>(map: &'a Map, cells: &'a [Cell], wave: Option<Wave<'a>>) -> RoutePicture<'a> {
    RoutePicture {
        map,
        floor: None,
        title: "floor",
        from: FROM,
        to: TO,
        cells,
        turns: &[],
        cycle: &[],
        regions: &[],
        wave,
    }
}

/// Where the SVG's only disc in the start's colour outside the legend lies, and how large a cell is: the page's
/// own words, so that the tests need not know the layout.
fn start_px(svg: &str) -> (f64, f64) {
    let circle = svg.lines().find(|line| line.starts_with("<circle") && line.contains("#009e73")).unwrap();
    let number = |name: &str| -> f64 {
        let rest = circle.split_once(&format!("{name}=\"")).unwrap().1;
        rest.split_once('"').unwrap().0.parse().unwrap()
    };
    (number("cx"), number("cy"))
}

/// Where a cell's centre lies, from where the start lies; the floor's cells are as large as cells can be.
fn pixel(map: &Map, svg: &str, cell: Cell, cell_px: f64) -> (u32, u32) {
    let (x, y) = start_px(svg);
    let (from, at) = (map.centre_m(FROM), map.centre_m(cell));
    ((x + (at[0] - from[0]) * cell_px) as u32, (y - (at[1] - from[1]) * cell_px) as u32)
}

fn rgb(pixmap: &Pixmap, (x, y): (u32, u32)) -> [u8; 3] {
    let colour = pixmap.pixel(x, y).unwrap();
    [colour.red(), colour.green(), colour.blue()]
}

/// Checks that tags are balanced and quotes closed, and that nothing but text lies between.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some((text, after)) = rest.split_once('<') {
        assert!(!text.contains('>'), "a bare > in {text}");
        for entity in text.split('&').skip(1) {
            assert!(["amp;", "lt;", "gt;", "quot;"].iter().any(|known| entity.starts_with(known)));
        }
        let (tag, after) = after.split_once('>').expect("an open tag");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap());
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.trim().is_empty());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

/// Every frame of an animation on the whole screen, as red, green, blue, alpha.
fn frames(data: &[u8]) -> Vec<Pixmap> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(data).unwrap();
    let mut screen = Pixmap::new(decoder.width().into(), decoder.height().into()).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        if frames.is_empty() {
            assert_eq!((frame.width.into(), frame.height.into()), (screen.width(), screen.height()));
        }
        let across = screen.width() as usize;
        for (i, colour) in frame.buffer.chunks_exact(4).enumerate() {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            let at = 4 * ((y + usize::from(frame.top)) * across + x + usize::from(frame.left));
            if colour[3] > 0 {
                screen.data_mut()[at..at + 4].copy_from_slice(colour);
            }
        }
        frames.push(screen.clone());
    }
    frames
}

#[test]
fn a_png_shows_what_it_should() {
    for lattice in Lattice::ALL {
        let map = floor(lattice);
        let cells = route();
        let drawn = picture(&map, &cells, None);
        let text = svg(&drawn);
        let pixmap = Pixmap::decode_png(&png(&drawn).unwrap()).unwrap();
        let size = format!("width=\"{}\" height=\"{}\"", pixmap.width(), pixmap.height());
        assert!(text.contains(&size));
        for y in 0..6 {
            for x in 0..6 {
                let cell = Cell::new(x, y);
                if cell == FROM || cell == TO || cells.contains(&cell) {
                    continue;
                }
                let colour = rgb(&pixmap, pixel(&map, &text, cell, 56.0));
                let right = if map.is_free(cell) { colour[1] > 0xf0 } else { colour[1] < 0x60 };
                assert!(right, "{lattice} {cell} {colour:?}");
            }
        }
        // Beside the letter.
        let (x, y) = pixel(&map, &text, FROM, 56.0);
        let [red, green, blue] = rgb(&pixmap, (x - 14, y));
        assert!(green > red + 50 && green > blue + 20);
        let (x, y) = pixel(&map, &text, TO, 56.0);
        let [red, green, blue] = rgb(&pixmap, (x - 12, y));
        assert!(red > green + 50 && green > blue + 50);
    }
}

#[test]
fn a_gif_moves() {
    for lattice in Lattice::ALL {
        let map = floor(lattice);
        let (cells, wave) = (route(), wave(&map));
        for wave in [None, Some(&wave as Wave<'_>)] {
            let drawn = picture(&map, &cells, wave);
            let data = gif(&drawn).unwrap();
            assert_eq!(data, gif(&drawn).unwrap());
            assert!(data.len() < 100_000);
            let frames = frames(&data);
            assert!(frames.len() >= cells.len(), "{}", frames.len());
            assert!(frames[0].width() <= 720 && frames[0].height() <= 720);
            assert!(frames.windows(2).all(|pair| pair[0] != pair[1]));
            for frame in [&frames[0], &frames[frames.len() - 1]] {
                let count = |like: fn([i32; 3]) -> bool| {
                    let channels = |p: &[u8]| [p[0], p[1], p[2]].map(i32::from);
                    frame.data().chunks_exact(4).filter(|pixel| like(channels(pixel))).count() as f64
                };
                let cell = 56.0 * 56.0 * if lattice == Lattice::Hex { 0.75f64.sqrt() } else { 1.0 };
                let dark = count(|[r, g, b]| r < 0x50 && g < 0x58 && b < 0x60) / cell;
                assert!((6.7..7.8).contains(&dark), "{dark} cells of obstacles");
                assert!(count(|[r, g, b]| r < 60 && g > 140 && b < 160) > 500.0, "the start's disc");
                assert!(count(|[r, g, b]| r > 180 && g < 140 && b < 60) > 500.0, "the target's square");
                assert!(count(|[r, g, b]| r.min(g).min(b) > 0xb0) / cell > 25.0, "the floor is light");
            }
        }
    }
}

#[test]
fn an_svg_is_well_formed() {
    for lattice in Lattice::ALL {
        let map = floor(lattice);
        let (cells, wave) = (route(), wave(&map));
        let title = "a <b> & \"c\"\u{1b}[31m\0 \u{ffff}\n";
        let text = svg(&RoutePicture { title, ..picture(&map, &cells, Some(&wave)) });
        assert_well_formed(&text);
        assert!(text.contains("<title>a &lt;b&gt; &amp; &quot;c&quot;[31m  </title>"));
        assert!(text.contains(">7</text>"), "steps are numbered");
        assert_well_formed(&map_svg(&map, title));
    }
}

#[test]
fn a_circle_is_shown() {
    for lattice in Lattice::ALL {
        let map = floor(lattice);
        let cycle = [Cell::new(3, 2), Cell::new(3, 3), Cell::new(3, 4)];
        let drawn = RoutePicture { cycle: &cycle, turns: &cycle, ..picture(&map, &cycle, None) };
        let text = svg(&drawn);
        assert_well_formed(&text);
        assert!(text.contains(">trapped</text>") && text.contains("stroke-dasharray"));
        assert!(gif(&drawn).is_ok() && png(&drawn).is_ok());
    }
}

/// All pictures of a route, for those who only want to know that they can be made.
fn all(drawn: &RoutePicture<'_>) -> Pixmap {
    assert_well_formed(&svg(drawn));
    assert!(!frames(&gif(drawn).unwrap()).is_empty());
    for colour in [false, true] {
        assert!(!terminal(drawn, 80, 24, colour).is_empty());
    }
    Pixmap::decode_png(&png(drawn).unwrap()).unwrap()
}

#[test]
fn regions_are_shown_where_they_lie() {
    let map = floor(Lattice::Square);
    let cells = route();
    let region =
        |centre_m, semi_major_m| Region { centre_m, semi_major_m, semi_minor_m: 0.3, angle_rad: 0.5 };
    let near = region(map.centre_m(Cell::new(3, 5)), 0.8);
    let far = region([90.0, 90.0], 0.8);
    let huge = region(map.centre_m(TO), 400.0);
    for (regions, shown) in
        [(vec![], false), (vec![near], true), (vec![far], false), (vec![near, far, huge], true)]
    {
        let drawn = RoutePicture { regions: &regions, ..picture(&map, &cells, None) };
        let text = svg(&drawn);
        assert_well_formed(&text);
        assert_eq!(text.contains("95 %"), shown, "{regions:?}");
        assert!(png(&drawn).is_ok() && gif(&drawn).is_ok());
    }
}

#[test]
fn strange_routes_and_maps() {
    for lattice in Lattice::ALL {
        let map = floor(lattice);
        let stay = RoutePicture { to: FROM, ..picture(&map, &[FROM], None) };
        all(&stay);
        all(&picture(&map, &[], None));
        let larger = Map::random(lattice, 90, 90, 0.0, 1).unwrap();
        all(&picture(&map, &[], Some(&wave(&larger))));
        let outside = [Cell::new(-1, 0), Cell::new(i32::MAX, i32::MIN)];
        let lost = RoutePicture { from: outside[0], to: outside[1], turns: &outside, ..stay };
        all(&RoutePicture { cells: &outside, cycle: &outside, ..lost });

        let one = Map::parse(lattice, ".").unwrap();
        let origin = Cell::new(0, 0);
        let field = one.wave(origin).unwrap();
        let (cells, wave) = ([origin], |cell| field.steps(cell));
        let drawn = RoutePicture { from: origin, to: origin, ..picture(&one, &cells, Some(&wave)) };
        assert!(all(&drawn).width() > 400);
        let wall = Map::parse(lattice, "#").unwrap();
        all(&RoutePicture { map: &wall, ..drawn });

        for (width, height) in [(3000, 20), (20, 3000), (1, 500_000)] {
            let map = Map::random(lattice, width, height, 0.1, 1).unwrap();
            let cells: Vec<Cell> = (0..height as i32).map(|y| Cell::new(0, y)).collect();
            let to = Cell::new(0, height as i32 - 1);
            let pixmap = all(&RoutePicture { to, ..picture(&map, &cells, None) });
            assert!(pixmap.width() < 2400 && pixmap.height() < 2400);
        }
    }
}

#[test]
fn text_stays_within_the_terminal() {
    for lattice in Lattice::ALL {
        for (width, height) in [(1, 1), (6, 6), (40, 12), (200, 100), (3000, 20), (7, 400)] {
            let map = Map::random(lattice, width, height, 0.3, 4).unwrap();
            let (from, to) = (Cell::new(0, 0), Cell::new(width as i32 - 1, height as i32 - 1));
            let drawn = RoutePicture { from, to, ..picture(&map, &[], None) };
            for (columns, rows) in [(80, 24), (1, 1), (13, 5), (0, 4), (400, 3)] {
                let text = terminal(&drawn, columns, rows, false);
                assert!(text.lines().count() <= rows);
                assert!(text.lines().all(|line| line.chars().count() <= columns), "{width} {columns} {rows}");
                assert_eq!(columns * rows == 0, text.is_empty());
                let coloured = terminal(&drawn, columns, rows, true);
                let mut letters = String::new();
                for part in coloured.split("\x1b[") {
                    letters += part.split_once('m').map_or(part, |(_, text)| text);
                }
                assert_eq!(letters.lines().count(), text.lines().count());
                assert!(letters.lines().all(|line| line.chars().count() <= columns), "{letters}");
            }
        }
    }
}

#[test]
fn a_route_is_never_lost_in_a_terminal() {
    let map = Map::random(Lattice::Square, 300, 300, 1.0, 1).unwrap();
    let cells: Vec<Cell> = (0..300).map(|x| Cell::new(x, 150)).collect();
    let drawn = RoutePicture { from: cells[0], to: cells[299], ..picture(&map, &cells, None) };
    let text = terminal(&drawn, 60, 20, false);
    assert!(text.contains('S') && text.contains('F'));
    assert!(text.chars().filter(|&c| c == 'o').count() > 30);
}

#[test]
fn uneven_ground_is_lit_from_the_north_west() {
    use activecell::{Elevation, Ground, Posts};
    for lattice in Lattice::ALL {
        // A ridge from South-West to North-East, of 8 posts by 8.
        let heights = (0..64).map(|i| 1.0 - 0.3 * ((i % 8 + i / 8 - 7) as f32).abs().min(3.0));
        let ridge = Elevation::new(8, 8, heights.collect(), Posts::default()).unwrap();
        let flat = Map::random(lattice, 8, 8, 0.0, 1).unwrap();
        let map = flat.clone().elevated(ridge.laid_over(&flat).unwrap(), Ground::Surface);
        let picture = RoutePicture {
            map: &map,
            floor: None,
            title: "ridge",
            from: Cell::new(0, 7),
            to: Cell::new(0, 7),
            cells: &[],
            turns: &[],
            cycle: &[],
            regions: &[],
            wave: None,
        };
        let svg = svg(&picture);
        // Pixels as text may spell anything.
        let drawn: Vec<&str> = svg.lines().filter(|line| !line.starts_with("<image")).collect();
        assert_well_formed(&drawn.join("\n"));
        assert!(svg.contains("data:image/png;base64,") && svg.contains("ground 0.1 to 1.0 m"));
        let pixmap = Pixmap::decode_png(&png(&picture).unwrap()).unwrap();
        let (x, y) = start_px(&svg);
        let light = |cell: Cell| {
            let ([fx, fy], [cx, cy]) = (map.centre_m(Cell::new(0, 7)), map.centre_m(cell));
            let at = ((x + (cx - fx) * 56.0) as u32, (y - (cy - fy) * 56.0) as u32);
            rgb(&pixmap, at).map(u32::from).iter().sum::<u32>()
        };
        // Of two places of one height the one that faces the light is brighter.
        assert!(light(Cell::new(2, 3)) > light(Cell::new(5, 4)) + 60, "{lattice}");
        assert!(gif(&picture).unwrap().starts_with(b"GIF89a"));
    }
}
