//! Bad input: every reader answers with one line that says where, what is wrong, and what to do; and it answers
//! soon, because nothing is allocated for sizes that the file cannot hold.
#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell_formats::raster::{read_image, read_pgm, read_png};
use activecell_formats::ros::MapYaml;
use activecell_formats::{Error, movingai};
use common::{gray_png, with_header};
use std::time::Instant;

fn check<T>(read: impl Fn(&[u8]) -> Result<T, Error>, cases: &[(&[u8], &str)]) {
    for (bytes, expected) in cases {
        let started = Instant::now();
        let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(80)]).into_owned();
        let error = read(bytes).err().unwrap_or_else(|| panic!("{shown:?} was read")).to_string();
        assert_eq!(&error, expected, "{shown:?}");
        assert!(!error.contains('\n'), "{error:?}");
        assert!(started.elapsed().as_secs() < 5, "{shown:?} took {:?}", started.elapsed());
    }
}

#[test]
fn movingai_maps() {
    check(
        movingai::read_map,
        &[
            (
                b"type octile\nheight 4\nwidth 4000000000\nmap\n......................................",
                "the header declares 4000000000 columns × 4 rows, but the file has only 80 bytes; correct the header or fetch the whole file",
            ),
            (
                b"type octile\nheight 18446744073709551615\nwidth 18446744073709551615\nmap\n.",
                "the header declares 18446744073709551615 columns × 18446744073709551615 rows, but the file has only 72 bytes; correct the header or fetch the whole file",
            ),
            (
                b"type octile\nheight 3\nwidth 3\nmap\n...\n...\n",
                "the header declares 3 columns × 3 rows, but the file has only 41 bytes; correct the header or fetch the whole file",
            ),
            (
                b"type octile\nheight 3\nwidth 3\nmap\n...\r\n...\r\n.",
                "line 7: the row has 1 cells, the header declares 3 columns; make them agree",
            ),
            (
                b"type octile\nheight 2\nwidth 3\nmap\n...\n....\n",
                "line 6: the row has 4 cells, the header declares 3 columns; make them agree",
            ),
            (
                b"type octile\nheight 2\nwidth 3\nmap\n...\n.x.\n",
                "line 6, column 2: unexpected character `x`; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle",
            ),
            (
                b"type octile\nheight 2\nwidth 3\nmap\n...\n.\x1b.\n",
                "line 6, column 2: unexpected character `\\u{1b}`; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle",
            ),
            (
                "type octile\nheight 1\nwidth 3\nmap\n..é\n".as_bytes(),
                "line 5, column 3: unexpected character `é`; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle",
            ),
            (
                b"type octile\nheight 1\nwidth 3\nmap\n...\n...\n",
                "line 6: text after the 1 rows that the header declares; correct `height` or remove it",
            ),
            (
                b"type octile\nheight 0\nwidth 0\nmap\n",
                "the map has no cell; give it at least one row of `.` and `#`",
            ),
            (
                b"type hex\nheight 1\nwidth 1\nmap\n.\n",
                "line 1: the map type is `hex`; only `octile` is known",
            ),
            (
                b"type octile\nheight -2\nwidth 1\nmap\n.\n",
                "line 2: height is `-2`; give a whole number of cells",
            ),
            (b"type octile\nheight\nwidth 1\nmap\n.\n", "line 2: height is ``; give a whole number of cells"),
            (
                b"type octile\nheight 2\nheight 2\nmap\n.\n",
                "line 3: height is stated twice; remove one of the lines",
            ),
            (b"type octile\nheight 2 3\nmap\n.\n", "line 2: `height` has more than one value"),
            (b"type octile\nheight 2\nmap\n.\n", "line 3: `map` before `width W`; state the columns first"),
            (b"type octile\nwidth 2\nmap\n.\n", "line 3: `map` before `height H`; state the rows first"),
            (
                b"type octile\nheight 2\n",
                "line 2: the file ends before the line `map`; it is not a MovingAI map, or it was cut",
            ),
            (b"", "line 1: the file ends before the line `map`; it is not a MovingAI map, or it was cut"),
            (
                b"\x00\xff\x01binary rubbish\xfe",
                "line 1: `\\u{0}\u{fffd}\\u{1}binary rubbish\u{fffd}` is not a MovingAI header line; expected `type octile`, `height H`, `width W`, `map`",
            ),
        ],
    );
}

#[test]
fn scenarios() {
    let fields = "bucket, map, its width and height, start x y, target x y, expected length";
    check(
        movingai::read_scen,
        &[
            (b"version 2\n", "line 1: the scenario's version is `2`; only 1 is known"),
            (
                b"version 1\n0\ta.map\t4\t4\t0\t0\t1\n",
                &format!("line 2: expected 9 fields separated by tabs, found 7: {fields}"),
            ),
            (
                b"0 my map.map 4 4 0 0 1 1 1\n",
                &format!("line 1: expected 9 fields separated by tabs, found more: {fields}"),
            ),
            (
                b"version 1\n\n0\ta.map\t4\t4\t0\t-1\t1\t1\t1\n",
                "line 3: start y is `-1`; give a whole number from 0",
            ),
            (
                b"0\ta.map\t4\t4\t0\t0\t1\t1\tnan\n",
                "line 1: expected length is `nan`; give a number of cells",
            ),
            (
                b"0\ta.map\t4\t4\t0\t0\t99999999999\t1\t1\n",
                "line 1: target x is `99999999999`; give a whole number from 0",
            ),
            (b"x\ta.map\t4\t4\t0\t0\t1\t1\t1\n", "line 1: bucket is `x`; give a whole number from 0"),
            (b"\xff\x00\x01", &format!("line 1: expected 9 fields separated by tabs, found 1: {fields}")),
        ],
    );
    assert_eq!(movingai::read_scen(b"").unwrap(), []);
}

/// A good YAML file with one line replaced, or left out.
fn yaml(key: &str, line: &str) -> String {
    let mut lines = [
        "image: a.pgm",
        "resolution: 0.05",
        "origin: [1, -2, 0]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
    ];
    let found = lines.iter().position(|old| old.starts_with(key)).unwrap();
    lines[found] = line;
    lines.join("\n")
}

fn yaml_error(text: &str) -> String {
    let started = Instant::now();
    let error = MapYaml::read(text.as_bytes()).unwrap_err().to_string();
    assert!(!error.contains('\n') && started.elapsed().as_secs() < 5, "{error:?} in {:?}", started.elapsed());
    error
}

#[test]
fn yaml_values() {
    let resolution = "give metres per pixel, for example 0.05";
    let origin = "give [x, y, yaw] in metres and radians, for example [-10.0, -10.0, 0.0]";
    for (key, line, expected) in [
        ("resolution", "resolution: .nan", format!("line 2, column 13: resolution is NaN; {resolution}")),
        ("resolution", "resolution: nan", format!("line 2, column 13: resolution is NaN; {resolution}")),
        ("resolution", "resolution: .inf", format!("line 2, column 13: resolution is inf; {resolution}")),
        ("resolution", "resolution: 1e999", format!("line 2, column 13: resolution is inf; {resolution}")),
        ("resolution", "resolution: -0.05", format!("line 2, column 13: resolution is -0.05; {resolution}")),
        ("resolution", "resolution: 0", format!("line 2, column 13: resolution is 0; {resolution}")),
        ("resolution", "resolution: 5 cm", format!("line 2, column 13: resolution is `5 cm`, not a number; {resolution}")),
        ("resolution", "resolution:", format!("line 2, column 11: resolution is empty; {resolution}")),
        ("resolution", "resolution: [1]", format!("line 2, column 13: resolution is a list; {resolution}")),
        ("resolution", "resolution: {a: 1}", "line 2, column 13: nested values are not allowed; a map has none".into()),
        ("origin", "origin: [0, 0]", format!("line 3, column 9: origin has 2 numbers; {origin}")),
        ("origin", "origin: [0, 0, .inf]", format!("line 3, column 16: origin yaw is inf; {origin}")),
        ("origin", "origin: [1e10, 0, 0]", format!("line 3, column 10: origin x is 10000000000, beyond a thousand million; {origin}")),
        ("origin", "origin: 0", format!("line 3, column 9: origin is `0`, not a list; {origin}")),
        ("origin", "origin: [[0], 0, 0]", "line 3, column 10: nested values are not allowed; a map has none".into()),
        ("negate", "negate: 2", "line 4, column 9: negate is `2`; give 0 (black is occupied) or 1 (white is occupied)".into()),
        ("occupied", "occupied_thresh: 65", "line 5, column 18: occupied_thresh is 65; give a probability from 0 to 1, for example 0.65".into()),
        ("free", "free_thresh: 0.7", "line 6, column 14: free_thresh 0.7 is not below occupied_thresh 0.65; make it smaller".into()),
        ("free", "free_thresh: 0.1\nmode: fuzzy", "line 7, column 7: mode is `fuzzy`; give trinary, scale or raw".into()),
        ("image", "image:", "line 1, column 6: image is empty; name the image's file, for example `image: map.pgm`".into()),
        ("image", "image: \"\"", "line 1, column 8: image is empty; name the image's file, for example `image: map.pgm`".into()),
        ("negate", "image: b.pgm", "line 4, column 1: the key `image` stands in line 1 already; remove one".into()),
        ("negate", "invert: 0", "the key is missing: `negate`; a map needs image, resolution, origin, negate, occupied_thresh, free_thresh".into()),
    ] {
        assert_eq!(yaml_error(&yaml(key, line)), expected);
    }
}

#[test]
fn yaml_structure() {
    let anchors = "anchors (&) and aliases (*) are not allowed; write the value itself";
    let bomb =
        "a: &a [x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\n";
    for (text, expected) in [
        (bomb, format!("line 1, column 4: {anchors}")),
        ("image: &a x\nresolution: *a\n", format!("line 1, column 8: {anchors}")),
        ("", "the YAML is empty; a map needs image, resolution, origin and thresholds".into()),
        ("# nothing\n", "the YAML is empty; a map needs image, resolution, origin and thresholds".into()),
        ("hello", "line 1, column 1: expected lines of the form `key: value`, such as `image: map.pgm`".into()),
        ("- a\n- b\n", "line 1, column 1: expected lines of the form `key: value`, such as `image: map.pgm`".into()),
        ("[a]: b\n", "line 1, column 1: a key must be a plain word".into()),
        (
            "image: a.pgm\nnegate: 0\n",
            "the keys are missing: `resolution`, `origin`, `occupied_thresh`, `free_thresh`; a map needs image, resolution, origin, negate, occupied_thresh, free_thresh".into(),
        ),
        ("image: a\0\nnegate: 0\n", "line 1, column 9: the byte 0x00 is not text; is this a YAML file?".into()),
    ] {
        assert_eq!(yaml_error(text), expected);
    }
    let two = yaml("image", "image: a.pgm") + "\n---\nimage: b.pgm\n";
    assert_eq!(yaml_error(&two), "line 7, column 1: a second document begins here; a map has one");
    assert!(yaml_error("image: [a\nb: c\n").contains("not well-formed YAML ("));
    let garbage = MapYaml::read(b"image: \xff\xfe").unwrap_err().to_string();
    assert_eq!(garbage, "line 1, column 8: the byte 0xff is not text; is this a YAML file?");
    let long = "#".repeat(65537);
    assert_eq!(
        yaml_error(&long),
        "the file has more than 65536 bytes; a map's YAML has some hundred bytes; is this the right file?"
    );
}

#[test]
fn deep_and_long_yaml_is_refused_soon() {
    for part in [
        "[", "{", "- ", "? ", "a: ", "[a,", "{a: ", "!x ", "\"", "'", "*a ", "&a ", "a\n", "|\n", "%", "\t",
        ",", "{? ",
    ] {
        yaml_error(&part.repeat(65536 / part.len()));
        yaml_error(&format!("image: {}", part.repeat(65000 / part.len())));
    }
}

#[test]
fn png() {
    let good = gray_png(8, 8);
    let damaged = |detail: &str| format!("the PNG is damaged or not a PNG ({detail}); fetch the image again");
    let lying = |width, height, bits, colour| with_header(&good, width, height, bits, colour);
    let size = good.len();
    for (bytes, expected) in [
        (
            lying(100_000, 100_000, 8, 0),
            format!(
                "the PNG header declares 100000 × 100000 pixels, more than its {size} bytes can hold; fetch the image again"
            ),
        ),
        (
            lying(2_147_483_647, 2_147_483_647, 1, 0),
            format!(
                "the PNG header declares 2147483647 × 2147483647 pixels, more than its {size} bytes can hold; fetch the image again"
            ),
        ),
        (
            lying(100, 200, 16, 6),
            format!(
                "the PNG header declares 100 × 200 pixels, more than its {size} bytes can hold; fetch the image again"
            ),
        ),
        (good[..good.len() - 20].to_vec(), "the PNG is cut short; fetch the image again".into()),
        (good[..20].to_vec(), "the PNG is cut short; fetch the image again".into()),
        (good[..5].to_vec(), "the PNG is cut short; fetch the image again".into()),
        (vec![], "the file is empty; expected a PNG image".into()),
        (b"\x00\x01\x02\x03\x04\x05\x06\x07\x08rubbish".to_vec(), damaged("Invalid PNG signature")),
    ] {
        check(read_png, &[(&bytes, &expected)]);
    }
    // A header that promises more than there is, but not too much: found while decoding.
    assert!(read_png(&lying(64, 64, 8, 0)).is_err());
    // One bit a pixel: 300 million pixels would fit into 40 kB, but not into a map.
    let mut padded = lying(20_000, 15_000, 1, 0);
    padded.resize(40_000, 0);
    check(
        read_png,
        &[(
            &padded,
            "map of 20000 x 15000 cells is too large: at most 268435456 cells; choose larger cells or a part of the floor",
        )],
    );
    let mut flipped = good.clone();
    flipped[45] ^= 0xff;
    let error = read_png(&flipped).unwrap_err().to_string();
    assert!(error.starts_with("the PNG is damaged or not a PNG ("), "{error}");
}

#[test]
fn pgm() {
    check(
        read_pgm,
        &[
            (
                b"P5\n60000 60000\n255\n....",
                "the PGM header declares 60000 × 60000 pixels, but the file has only 23 bytes; fetch the image again",
            ),
            (
                b"P2\n60000 60000\n255\n1 2",
                "the PGM header declares 60000 × 60000 pixels, but the file has only 22 bytes; fetch the image again",
            ),
            (
                b"P6\n18446744073709551615 2\n255\n",
                "the PGM header declares 18446744073709551615 × 2 pixels, but the file has only 30 bytes; fetch the image again",
            ),
            (
                b"P5\n99999999999999999999 1\n255\n",
                "line 2, column 1: width is `99999999999999999999`; give a whole number",
            ),
            (
                b"P5 2 2 256\n.......",
                "the PGM header declares 2 × 2 pixels, 8 bytes, but 7 follow; fetch the image again",
            ),
            (
                b"P5 2 2 255\n.......",
                "the PGM header declares 2 × 2 pixels, 4 bytes, but 7 follow; fetch the image again",
            ),
            (
                b"P5 2 2 255",
                "the PGM header declares 2 × 2 pixels, but the file has only 10 bytes; fetch the image again",
            ),
            (b"P5 0 2 255\n", "the image of 0 × 2 pixels is empty"),
            (b"P5 2 1 0\n..", "line 1, column 8: maxval is 0; it must be from 1 to 65535"),
            (b"P5 2 1 65536\n....", "line 1, column 8: maxval is 65536; it must be from 1 to 65535"),
            (b"P5 2 1 100\nAz", "pixel (1,0) is 122, above the maxval 100"),
            (b"P2 2 1 100\n# x\n7 101\n", "line 3, column 3: a sample is 101, above the maxval 100"),
            (b"P2 2 1 100\n7 -1\n", "line 2, column 3: a sample is `-1`; give a whole number"),
            (
                b"P2 3 1 100\n 7    \n",
                "the PGM has 1 samples of the 3 that its header declares; fetch the image again",
            ),
            (
                b"P2 2 1 100\n7 7 7\n",
                "line 2, column 5: more than the 2 samples that the header declares; correct the header",
            ),
            (b"P2 2", "the PGM ends before its height; fetch the image again"),
            (b"", "the file is empty; expected a PGM image"),
            (b"P7\n", "not a PGM image: it begins with `P7`, not with `P5` or `P2`"),
            (b"\x00\xff", "not a PGM image: it begins with `\\u{0}\u{fffd}`, not with `P5` or `P2`"),
        ],
    );
    check(
        read_image,
        &[
            (b"", "the file is empty; expected a PNG or PGM image"),
            (b"BM....", "neither a PNG nor a PGM image; convert it to one of these"),
        ],
    );
}
