//! No reader panics, whatever the bytes: arbitrary ones, and good files with something changed.
#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell_formats::elevation::{self, HeightFormat, HeightOptions};
use activecell_formats::raster::{Channels, Image, read_image, read_pgm, read_png, write_png};
use activecell_formats::ros::{MapYaml, Reading, to_map};
use activecell_formats::{Error, drive_log, movingai, robot};
use proptest::prelude::*;

fn read_all(bytes: &[u8]) {
    let one_line = |error: Error| assert!(!error.to_string().contains(char::is_control), "{error:?}");
    movingai::read_map(bytes).map_or_else(one_line, drop);
    movingai::read_scen(bytes).map_or_else(one_line, drop);
    MapYaml::read(bytes).map_or_else(one_line, drop);
    drive_log::read(bytes).map_or_else(one_line, drop);
    drive_log::read_metadata(bytes).map_or_else(one_line, drop);
    if let Ok(text) = std::str::from_utf8(bytes) {
        let other = activecell::Robot { track_m: 0.3, ..activecell::Robot::default() };
        robot::update(text, &other).map_or_else(one_line, drop);
    }
    read_png(bytes).map_or_else(one_line, drop);
    read_pgm(bytes).map_or_else(one_line, drop);
    for format in
        [HeightFormat::Asc, HeightFormat::GeoTiff, HeightFormat::Png, HeightFormat::Npy, HeightFormat::Npz]
    {
        let options = HeightOptions { scale: Some(0.1), ..HeightOptions::default() };
        elevation::read(bytes, format, &options).map_or_else(one_line, drop);
    }
    if let Ok(image) = read_image(bytes) {
        to_map(&image, &MapYaml::default(), &Reading::default()).map_or_else(one_line, drop);
    }
}

fn good_files() -> Vec<Vec<u8>> {
    let rgba = Image::new(5, 4, Channels::Rgba, (0..80).collect()).unwrap();
    vec![
        b"type octile\nheight 2\nwidth 3\nmap\n..@\nT..\n".to_vec(),
        b"version 1\n0\ta.map\t49\t49\t1\t11\t2\t13\t2.4\n0\ta.map\t49\t49\t1\t11\t2\t13\t2.4\n".to_vec(),
        b"image: a.pgm\nresolution: 0.05\norigin: [0, -1.5, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
            .to_vec(),
        b"image: 'a.pgm'\norigin:\n  - 0\n  - -1.5\n  - &x 0\nmode: \"raw\" # comment\nmore: |\n  text\n".to_vec(),
        b"time_s,x_m,y_m,bearing_rad,left_ticks,right_ticks\n0,0,0,0,0,0\n1,,,,90,91\n2,1.5,0,0,80,79\n".to_vec(),
        b"0,0,0,0,0,0\n0.05,1e-3,-2,3.1,7,8\n".to_vec(),
        b"type,diff,\nngear,43.7,\nencRes,64,\nLi,0.2,\nDi,0.084,0.084\n".to_vec(),
        b"track_m = 0.5 # c\n[errors] # here\nturn_rad = 1\n\n[power]\nidle_w = 3\n".to_vec(),
        b"P5\n# c\n3 2\n255\nabcdef".to_vec(),
        b"P2 3 2 15\n1 2 3 4 5 6\n".to_vec(),
        b"P6 2 1 300 aabbccddeeff".to_vec(),
        common::gray_png(9, 7),
        write_png(&rgba).unwrap(),
        b"ncols 3\nnrows 2\nxllcenter 1\nyllcorner -2\ncellsize 0.5\nNODATA_value -9\n1 2 3\n4 -9 6.5\n".to_vec(),
        common::npy("<i2", "(2, 3)", false, &[1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0]),
        common::npz(&[("a.npy", &common::npy("<f4", "(1, 2)", false, &[0; 8]))]),
        common::tiff(true),
        common::tiff(false),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        read_all(&bytes);
    }

    #[test]
    fn arbitrary_text(text in "(type octile\n|height |width |map\n|version 1\n|P[2-6] |[0-9]{1,3}[ \t\n]|[.@:\\[\\]{}&*!|>\"'#,?-]|\\PC){0,40}") {
        read_all(text.as_bytes());
    }

    #[test]
    fn changed_files(
        file in prop::sample::select(good_files()),
        changes in common::changes(),
    ) {
        read_all(&common::changed(file, changes));
    }

    /// With a right checksum the header gets past the first check of a PNG.
    #[test]
    fn changed_png_headers(
        width in prop_oneof![0..40_u32, any::<u32>()],
        height in prop_oneof![0..40_u32, any::<u32>()],
        bits in prop::sample::select(vec![0, 1, 2, 3, 4, 8, 16, 255_u8]),
        colour in 0..8_u8,
        interlaced in 0..3_u8,
        cut in 0..60_usize,
    ) {
        let mut png = common::gray_png(9, 7);
        png[28] = interlaced;
        let mut png = common::with_header(&png, width, height, bits, colour);
        read_all(&png);
        png.truncate(png.len() - cut.min(png.len()));
        read_all(&png);
    }
}
