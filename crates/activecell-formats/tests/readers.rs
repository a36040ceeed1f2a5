//! Good input in all the shapes in which it comes.
#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell::{Cell, Lattice, Map};
use activecell_formats::movingai::{Task, read_map, read_scen, write_map, write_scen};
use activecell_formats::raster::{Channels, Image, read_image, read_pgm, read_png, write_pgm, write_png};
use activecell_formats::ros::{MapYaml, Mode};
use proptest::prelude::*;

#[test]
fn movingai_headers_and_line_ends() {
    let expected = Map::parse(Lattice::Square, "..#\n#..").unwrap();
    for text in [
        "type octile\nheight 2\nwidth 3\nmap\n..@\n@..\n",
        "type octile\nheight 2\nwidth 3\nmap\n..T\nO..",
        "type octile\r\nheight 2\r\nwidth 3\r\nmap\r\nGSW\r\n@E.\r\n\r\n \n",
        "\u{feff}type   octile  \n\n width\t3 \nheight 2\t\n map \n..@\n@..",
        "height 2\nwidth 3\nmap\n..@\n@..\n",
    ] {
        assert_eq!(read_map(text.as_bytes()).unwrap(), expected, "{text:?}");
    }
}

#[test]
fn scenarios_with_tabs_and_with_blanks() {
    let task = |line, map: &str| Task {
        line,
        bucket: 3,
        map: map.into(),
        width: 49,
        height: 50,
        from: Cell::new(1, 11),
        to: Cell::new(2, 13),
        expected: 2.5,
    };
    for (text, expected) in [
        ("version 1\n3\tmaps/my map.map\t49\t50\t1\t11\t2\t13\t2.5", task(2, "maps/my map.map")),
        ("version 1.0\r\n\r\n3 a.map 49 50 1 11 2 13 2.5 \r\n", task(3, "a.map")),
        ("3\ta.map\t49\t50\t1\t11\t2\t13\t2.50\t\n", task(1, "a.map")),
        ("version\t1\n3\ta.map 49\t50 1 11 2 13 2.50\n", task(2, "a.map")),
    ] {
        assert_eq!(read_scen(text.as_bytes()).unwrap(), [expected], "{text:?}");
    }
}

#[test]
fn pgm_and_ppm() {
    let samples = |bytes: &[u8]| read_pgm(bytes).map(|image| image.samples().to_vec()).unwrap();
    assert_eq!(samples(b"P5 3 1 255\n\x00\x20\xff"), [0, 32, 255]);
    assert_eq!(samples(b"P5\n# a\n3 # b\n#c\n1\n255 # d\n\x00\x20\xff"), [0, 32, 255]);
    assert_eq!(samples(b"P5\n3 1\n255#d\n\x00\x20\xff"), [0, 32, 255]);
    assert_eq!(samples(b"P5\r\n3 1\r\n255\r\n\x00\x20\xff"), [0, 32, 255]);
    assert_eq!(samples(b"P5 2 1 65535\n\x00\x80\xff\xff"), [0, 255]);
    assert_eq!(samples(b"P5 2 1 256 \x00\x80\x01\x00"), [128, 255]);
    assert_eq!(samples(b"P2 2 2 15 0 # zero\n 8\n15\t1"), [0, 136, 255, 17]);
    assert_eq!(samples(b"P3 1 1 1 1 0 1"), [255, 0, 255]);
    assert_eq!(samples(b"P6 1 1 255 abc"), *b"abc");
    // A raster that begins with what looks like a line end.
    assert_eq!(samples(b"P5 2 1 255\r\n."), [10, 46]);
    for maxval in [1, 2, 100, 254, 255, 256, 1023, 65535_u64] {
        for value in (0..=maxval).step_by(1 + maxval as usize / 300) {
            let text = format!("P2 1 1 {maxval} {value}");
            let expected = (value as f64 * 255.0 / maxval as f64).round() as u8;
            assert_eq!(samples(text.as_bytes()), [expected], "{value} of {maxval}");
        }
    }
}

#[test]
fn images_round_trip() {
    for channels in [Channels::Gray, Channels::GrayAlpha, Channels::Rgb, Channels::Rgba] {
        let samples: Vec<u8> = (0..7 * 5 * channels.count()).map(|i| (i * 37 % 256) as u8).collect();
        let image = Image::new(7, 5, channels, samples).unwrap();
        assert_eq!(read_png(&write_png(&image).unwrap()).unwrap(), image);
        assert_eq!(read_image(&write_png(&image).unwrap()).unwrap(), image);
        let grays: Vec<u8> = image.grays().collect();
        assert_eq!(read_image(&write_pgm(&image)).unwrap().samples(), grays);
    }
    assert!(Image::new(2, 2, Channels::Gray, vec![0; 3]).is_err());
    assert!(Image::new(0, 2, Channels::Gray, vec![]).is_err());
    assert!(Image::new(1 << 15, 1 << 15, Channels::Gray, vec![]).is_err());
}

#[test]
fn a_png_of_one_colour_is_not_taken_for_a_lie() {
    // Nothing is denser than this: about 1000 bytes from one.
    let image = read_png(&common::gray_png(6000, 6000)).unwrap();
    assert!(image.samples().iter().all(|&gray| gray == 200));
}

#[test]
fn yaml_in_the_shapes_that_tools_write() {
    let base = MapYaml {
        image: "a.pgm".into(),
        origin_m: [-10.0, 2.5],
        yaw_rad: 0.5,
        free_thresh: 0.196,
        ..MapYaml::default()
    };
    let lines = "image: a.pgm\nresolution: 0.05\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    for (rest, expected) in [
        ("origin: [-10, 2.5, 0.5]\nnegate: 0", base.clone()),
        ("origin:\n- -10.000000\n- 2.5\n- .5\nnegate: false\n", base.clone()),
        ("origin:\n  - -1e1\n  - +2.5\n  - 5.0e-1\nnegate: 1", MapYaml { negate: true, ..base.clone() }),
        (
            "origin: [-10, 2.5,\n  0.5]\nnegate: True\r\nmode: Scale",
            MapYaml { negate: true, mode: Mode::Scale, ..base.clone() },
        ),
        (
            "negate: 0 # no\nmode: \"RAW\"\norigin: ['-10', \"2.5\", 0.5]\nunknown: [1, 2]\nmore: x\n",
            MapYaml { mode: Mode::Raw, ..base.clone() },
        ),
        ("{\"origin\": [-10, 2.5, 0.5], negate: 0}", base.clone()),
    ] {
        let text = if let Some(rest) = rest.strip_prefix('{') {
            format!("{{image: a.pgm, resolution: 0.05, occupied_thresh: 0.65, free_thresh: 0.196, {rest}")
        } else {
            format!("---\n{lines}{rest}")
        };
        assert_eq!(MapYaml::read(text.as_bytes()).unwrap(), expected, "{text}");
    }
}

fn image_name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z./_-]{1,12}", "[ -~]{1,12}", any::<String>().prop_filter("no name", |s| !s.is_empty())]
        .prop_filter("the empty name of YAML", |name| name != "~")
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_yaml_round_trips(
        image in image_name(),
        resolution_m in 1e-6..1e6_f64,
        origin_m in prop::array::uniform2(-1e9..1e9_f64),
        yaw_rad in -1e9..1e9_f64,
        negate: bool,
        free_thresh in 0.0..0.5_f64,
        above in 1e-9..0.5_f64,
        mode in prop::sample::select(vec![Mode::Trinary, Mode::Scale, Mode::Raw]),
    ) {
        let occupied_thresh = free_thresh + above;
        let yaml = MapYaml { image, resolution_m, origin_m, yaw_rad, negate, occupied_thresh, free_thresh, mode };
        prop_assert_eq!(MapYaml::read(yaml.write().as_bytes()).unwrap(), yaml);
    }

    #[test]
    fn any_map_round_trips(width in 1..90_u32, height in 1..9_u32, density in 0.0..1.0_f64, seed: u64) {
        let map = Map::random(Lattice::Square, width, height, density, seed).unwrap();
        prop_assert_eq!(read_map(write_map(&map).as_bytes()).unwrap(), map);
    }

    #[test]
    fn any_scenario_round_trips(
        rows in prop::collection::vec((any::<u32>(), "[!-~][ -~]{0,20}[!-~]", any::<u32>(), 0..i32::MAX, any::<f64>()), 0..5)
    ) {
        let tasks: Vec<Task> = rows
            .into_iter()
            .filter(|row| row.4.is_finite())
            .enumerate()
            .map(|(i, (size, map, bucket, x, expected))| Task {
                line: i + 2,
                bucket,
                map,
                width: size,
                height: size / 2,
                from: Cell::new(x, x / 2),
                to: Cell::new(x / 3, x),
                expected,
            })
            .collect();
        prop_assert_eq!(read_scen(write_scen(&tasks).as_bytes()).unwrap(), tasks);
    }
}
