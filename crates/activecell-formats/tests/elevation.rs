//! Heights of the ground: good files read to the last digit, bad ones refused in one line, and soon.
#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell_formats::elevation::{Georeference, HeightFormat, HeightOptions, Relief, read};
use common::{TIFF_HEIGHTS, npy, npz, tiff};

const PLAIN: HeightOptions = HeightOptions { scale: None, offset_m: 0.0, apart_m: None };

fn heights(relief: &Relief) -> Vec<Option<f32>> {
    relief.elevation.heights_m().iter().map(|height| (!height.is_nan()).then_some(*height)).collect()
}

#[test]
fn grids_of_text_lie_where_they_say() {
    let text = "NCOLS 2\r\nnrows 2\r\nxllcenter 3\r\nyllcenter 5\r\ncellsize 2\r\nnodata_value -9999\r\n1.5 -9999\r\n-3 4e1\r\n";
    let relief = read(text.as_bytes(), HeightFormat::Asc, &PLAIN).unwrap();
    assert_eq!(heights(&relief), [Some(1.5), None, Some(-3.0), Some(40.0)]);
    let posts = relief.elevation.posts();
    assert_eq!((posts.apart_m, posts.corner_m), ([2.0; 2], [2.0, 4.0]));
    assert_eq!(relief.elevation.height_m([3.0, 5.0]), Some(-3.0));
    let degrees = "ncols 2\nnrows 2\nxllcorner -105.5\nyllcorner 40\ncellsize 0.001\n1 2 3 4";
    let relief = read(degrees.as_bytes(), HeightFormat::Asc, &PLAIN).unwrap();
    assert_eq!(relief.georeference, Georeference::Degrees { latitude_deg: 40.001 });
    let [across, down] = relief.elevation.posts().apart_m;
    assert!((across - 85.4).abs() < 0.1 && (down - 111.04).abs() < 0.1, "{across} {down}");
    // A robot's floor of 1 cm begins at (0, 0).
    let fine = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0.01\n1 2";
    assert_eq!(read(fine.as_bytes(), HeightFormat::Asc, &PLAIN).unwrap().georeference, Georeference::Metres);
}

#[test]
fn geotiffs_are_read_with_their_tags() {
    for floats in [false, true] {
        let relief = read(&tiff(floats), HeightFormat::GeoTiff, &PLAIN).unwrap();
        let expected = TIFF_HEIGHTS.map(|height| (height != -999).then_some(f32::from(height)));
        assert_eq!(heights(&relief), expected);
        assert_eq!(relief.georeference, Georeference::Metres);
        let posts = relief.elevation.posts();
        // The tie point is a post's centre, and rows go down.
        assert_eq!((posts.apart_m, posts.corner_m), ([2.0, 3.0], [99.0, 195.5]));
        assert_eq!(relief.elevation.height_m([100.0, 200.0]), Some(10.0));
        assert_eq!(relief.elevation.height_m([104.0, 197.0]), Some(60.0));
    }
}

#[test]
fn arrays_are_read_in_both_orders_and_many_types() {
    let bytes: Vec<u8> =
        [1.5f64, 2.0, f64::NAN, 4.0, 5.0, 6.0].iter().flat_map(|value| value.to_be_bytes()).collect();
    let relief = read(&npy(">f8", "(2, 3)", false, &bytes), HeightFormat::Npy, &PLAIN).unwrap();
    assert_eq!(heights(&relief), [Some(1.5), Some(2.0), None, Some(4.0), Some(5.0), Some(6.0)]);
    assert_eq!(relief.georeference, Georeference::None);
    let relief = read(&npy(">f8", "(2, 3)", true, &bytes), HeightFormat::Npy, &PLAIN).unwrap();
    assert_eq!(heights(&relief), [Some(1.5), None, Some(5.0), Some(2.0), Some(4.0), Some(6.0)]);
    let scaled = HeightOptions { scale: Some(0.5), offset_m: 10.0, apart_m: Some(0.25) };
    let relief = read(&npy("|u1", "(1, 3)", false, &[0, 1, 255]), HeightFormat::Npy, &scaled).unwrap();
    assert_eq!(heights(&relief), [Some(10.0), Some(10.5), Some(137.5)]);
    assert_eq!(format!("{:?}", relief.elevation.posts().apart_m), "[0.25, 0.25]");
    let (grid, other, line) = (
        npy("<i4", "(1, 1)", false, &[7, 0, 0, 0]),
        npy("<i2", "(1, 1)", false, &[9, 0]),
        npy("<f8", "()", false, &[0; 8]),
    );
    let relief = read(&npz(&[("dx.npy", &line), ("any.npy", &grid)]), HeightFormat::Npz, &PLAIN).unwrap();
    assert_eq!(heights(&relief), [Some(7.0)]);
    let relief =
        read(&npz(&[("any.npy", &grid), ("Elevation.npy", &other)]), HeightFormat::Npz, &PLAIN).unwrap();
    assert_eq!(heights(&relief), [Some(9.0)]);
}

#[test]
fn grays_of_16_bits_keep_all_of_them() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&[0x12, 0x34, 0xff, 0xff]).unwrap();
    let scaled = HeightOptions { scale: Some(0.001), offset_m: -1.0, apart_m: None };
    let relief = read(&bytes, HeightFormat::Png, &scaled).unwrap();
    assert_eq!(heights(&relief), [Some(3.66), Some(64.535)]);
}

fn refused(bytes: &[u8], format: HeightFormat) -> String {
    let error = read(bytes, format, &HeightOptions { scale: Some(1.0), ..PLAIN }).unwrap_err().to_string();
    assert!(!error.contains('\n'), "{error:?}");
    error
}

#[test]
fn bad_grids_of_text_are_told_by_place() {
    let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    for (text, expected) in [
        (format!("{header}1 2\n3 x\n"), "line 7, column 3: `x` is no height; give a number"),
        (format!("{header}1 2\n3 inf\n"), "line 7, column 3: `inf` is no height; give a number"),
        (format!("{header}1 2\n3\n"), "the header declares 4 heights, the file has 3; fetch the whole file"),
        (
            format!("{header}1 2 3 4 5"),
            "line 6, column 9: a height after the 4 that the header declares; correct ncols or nrows",
        ),
        (
            "ncols 4000000\nnrows 4000000\ncellsize 1\n1".into(),
            "the elevation of 4000000 × 4000000 posts is too large: at most 134217728 posts; cut out a part of it",
        ),
        (
            "ncols 9999\nnrows 9999\ncellsize 1\n1 2 3".into(),
            "the header declares 9999 × 9999 posts, more than the file's 38 bytes can hold; fetch it again",
        ),
        (
            "ncols 18446744073709551615\nnrows 18446744073709551615\ncellsize 1\n1".into(),
            "the elevation of 18446744073709551615 × 18446744073709551615 posts is too large: at most 134217728 posts; cut out a part of it",
        ),
        ("ncols 0\nnrows 5\ncellsize 1\n".into(), "the elevation of 0 × 5 posts is empty"),
        ("ncols -2\n".into(), "line 1, column 7: ncols is `-2`; give a whole number"),
        (
            "ncols 1\nnrows 1\ncellsize 0\n5".into(),
            "the metres between posts is 0; it must be between 0.000001 and 1000000",
        ),
        (
            "ncols 1\nnrows 1\ncellsize 1\n1e9".into(),
            "a height in metres is 1000000000; it must be between -1000000 and 1000000, or NaN for none",
        ),
        ("ncols 1\ncellsize 1\n5".into(), "line 2: the header has no `nrows`; is this an ESRI ASCII grid?"),
        (
            "width 3\n".into(),
            "line 1, column 1: unknown key `width`; a grid has ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value",
        ),
        ("ncols".into(), "line 1, column 1: ncols has no value; is the file cut?"),
        (String::new(), "the file is empty; expected an elevation"),
    ] {
        assert_eq!(refused(text.as_bytes(), HeightFormat::Asc), expected);
    }
}

#[test]
fn bad_arrays_are_refused_before_memory_is_taken() {
    let deep = format!("{}{}", "(".repeat(3000), ")".repeat(3000));
    for (bytes, expected) in [
        (npy("<f4", "(99999, 99999)", false, &[0; 8]), "the elevation of 99999 × 99999 posts is too large"),
        (npy("<f4", "(9999, 9999)", false, &[0; 8]), "the header declares 9999 × 9999 posts, more than"),
        (
            npy("<f4", "(18446744073709551615, 18446744073709551615)", false, &[]),
            "the array's header declares more than any file can hold",
        ),
        (npy("<f4", "(2, 2)", false, &[0; 12]), "the array is cut short"),
        (npy("<f4", "(2, 2, 2)", false, &[0; 32]), "an array of 3 dimensions"),
        (npy("<c8", "(1, 1)", false, &[0; 8]), "an array of 2 dimensions of"),
        (npy("|O", "(1, 1)", false, &[0; 8]), "an array of 2 dimensions of"),
        (npy("<f4", &deep, false, &[0; 8]), "the array's header has too many brackets"),
        (npy("<f4", "(2", false, &[]), "the array "),
        (
            b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(),
            "the array's header of 4294967295 bytes is too long",
        ),
        (b"\x93NUMPY\x01\x00".to_vec(), "the array is cut short"),
        (b"hello".to_vec(), "this is no NumPy array"),
    ] {
        let error = refused(&bytes, HeightFormat::Npy);
        assert!(error.starts_with(expected), "{error}; not {expected}");
    }
    // A bomb: a thousand times what it takes.
    let bomb = npy("<f8", "(16384, 8193)", false, &vec![0; 1 << 22]);
    let error = refused(&npz(&[("z.npy", &bomb)]), HeightFormat::Npz);
    assert!(error.contains("too large"), "{error}");
    let lie = npy("<f8", "(8000, 8000)", false, &[0; 64]);
    let error = refused(&npz(&[("z.npy", &lie)]), HeightFormat::Npz);
    assert!(error.starts_with("the header declares 8000 × 8000 posts"), "{error}");
    let small = npy("<f8", "(1, 1)", false, &[0; 8]);
    let error = refused(&npz(&[("a.npy", &small), ("b.npy", &small)]), HeightFormat::Npz);
    assert_eq!(error, "the archive has several arrays: `a`, `b`; save the heights alone, or as `elevation`");
    let error = refused(&npz(&[("a.npy", &npy("<f8", "(1,)", false, &[0; 8]))]), HeightFormat::Npz);
    assert_eq!(error, "no array of the archive has two dimensions of numbers");
    assert!(refused(b"PK\x05\x06", HeightFormat::Npz).starts_with("the archive is damaged or no .npz"));
}

#[test]
fn bad_images_are_refused() {
    let cut = &tiff(false)[..40];
    assert!(
        refused(cut, HeightFormat::GeoTiff).starts_with("the TIFF is damaged"),
        "{}",
        refused(cut, HeightFormat::GeoTiff)
    );
    assert!(refused(b"II*\0", HeightFormat::GeoTiff).contains("TIFF"));
    let mut wide = tiff(false);
    // The width's entry in the directory, whose place the header tells.
    let directory = u32::from_le_bytes(wide[4..8].try_into().unwrap()) as usize;
    let at = directory + wide[directory..].windows(2).position(|tag| tag == [0, 1]).unwrap();
    wide[at + 8..at + 12].copy_from_slice(&60_000_000u32.to_le_bytes());
    let error = refused(&wide, HeightFormat::GeoTiff);
    assert!(error.contains("more than the file's") || error.contains("damaged"), "{error}");
    let rgb = "a PNG of Rgb with Eight bits holds no heights; save it as gray of 16 bits";
    let image =
        activecell_formats::raster::Image::new(1, 1, activecell_formats::raster::Channels::Rgb, vec![0; 3])
            .unwrap();
    assert_eq!(refused(&activecell_formats::raster::write_png(&image).unwrap(), HeightFormat::Png), rgb);
    let gray = common::gray_png(9, 7);
    let error = read(&gray, HeightFormat::Png, &PLAIN).unwrap_err().to_string();
    assert_eq!(
        error,
        "a PNG holds grays, not metres; say how many metres one step of gray is (--height-scale)"
    );
    assert!(
        refused(&common::with_header(&gray, 100_000, 100_000, 8, 0), HeightFormat::Png).contains("too large")
    );
    assert!(
        refused(&common::with_header(&gray, 9000, 9000, 8, 0), HeightFormat::Png)
            .contains("more than the file's")
    );
}
