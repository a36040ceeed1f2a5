//! Maps on the disk: formats by their endings, files written as a whole, errors that name the file.
#![allow(clippy::unwrap_used)] // A test may panic.

use activecell::{Frame, Lattice, Map};
use activecell_formats::files::{
    MapFormat, ReadOptions, read_bytes, read_map, write_atomically, write_folder, write_map, write_together,
};
use activecell_formats::ros::{Reading, Rules};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The message of reading a file of this name and content, without the folder's name.
fn error(name: &str, content: &[u8], options: &ReadOptions) -> String {
    let folder = folder();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    let error = read_map(&path, options).unwrap_err().to_string();
    assert!(!error.contains('\n'), "{error:?}");
    error.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn every_format_round_trips() {
    let folder = folder();
    let map = Map::random(Lattice::Square, 70, 9, 0.4, 7).unwrap();
    for (name, format, cell_m) in [
        ("a.yaml", MapFormat::Ros, 1.0),
        ("b.YML", MapFormat::Ros, 1.0),
        ("a.map", MapFormat::MovingAi, 1.0),
        ("a.png", MapFormat::Png, 0.05),
        ("c.pgm", MapFormat::Pgm, 0.05),
        ("a.txt", MapFormat::Text, 1.0),
    ] {
        let path = folder.path().join(name);
        write_map(&path, &map).unwrap();
        let expected = map.clone().in_frame(Frame { cell_m, ..Frame::default() }).unwrap();
        assert_eq!(read_map(&path, &ReadOptions::default()).unwrap(), (expected, format), "{name}");
        let options = ReadOptions { resolution_m: Some(0.3), ..ReadOptions::default() };
        if format != MapFormat::Ros {
            let expected = Frame { cell_m: 0.3, ..Frame::default() };
            assert_eq!(*read_map(&path, &options).unwrap().0.frame(), expected, "{name}");
        }
    }
}

#[test]
fn a_ros_map_keeps_its_frame() {
    let folder = folder();
    let path = folder.path().join("my floor.yaml");
    let frame = Frame { cell_m: 0.1 / 3.0, origin_m: [-1.234_567_8, 1e-9], yaw_rad: 0.1 };
    let map = Map::random(Lattice::Square, 20, 9, 0.4, 7).unwrap().in_frame(frame).unwrap();
    write_map(&path, &map).unwrap();
    for rules in [Rules::Humble, Rules::Jazzy] {
        let options = ReadOptions {
            reading: Reading { rules, ..Reading::default() },
            resolution_m: None,
            ..ReadOptions::default()
        };
        assert_eq!(read_map(&path, &options).unwrap().0, map);
    }
    let yaml = fs::read_to_string(&path).unwrap();
    assert!(
        yaml.starts_with("image: \"my floor.pgm\"\nmode: trinary\nresolution: 0.03333333333333333\n"),
        "{yaml}"
    );
}

#[test]
fn the_image_lies_in_the_folder_of_its_yaml() {
    let folder = folder();
    let map = Map::parse(Lattice::Square, "..#").unwrap();
    write_map(&folder.path().join("a.yaml"), &map).unwrap();
    let yaml = fs::read_to_string(folder.path().join("a.yaml")).unwrap();
    fs::create_dir(folder.path().join("images")).unwrap();
    fs::rename(folder.path().join("a.pgm"), folder.path().join("images/b.pgm")).unwrap();
    let absolute = folder.path().join("images/b.pgm").display().to_string();
    for image in ["images/b.pgm", "./images/../images/b.pgm", &absolute] {
        let path = folder.path().join("b.yaml");
        fs::write(&path, yaml.replace("a.pgm", &format!("\"{image}\""))).unwrap();
        assert_eq!(read_map(&path, &ReadOptions::default()).unwrap().0, map, "{image}");
    }
}

#[test]
fn text_that_is_a_movingai_map() {
    let folder = folder();
    let path = folder.path().join("map.txt");
    fs::write(&path, "type octile\nheight 1\nwidth 3\nmap\n.@.").unwrap();
    let (map, format) = read_map(&path, &ReadOptions::default()).unwrap();
    assert_eq!((map.to_text().as_str(), format), (".#.\n", MapFormat::MovingAi));
    fs::write(&path, "\u{feff}S.#\r\n..F").unwrap();
    let (map, format) = read_map(&path, &ReadOptions::default()).unwrap();
    assert_eq!((map.to_text().as_str(), format), ("S.#\n..F\n", MapFormat::Text));
}

#[test]
fn errors_name_the_file_and_the_place() {
    let plain = ReadOptions::default();
    let with_cell = ReadOptions { resolution_m: Some(0.1), ..plain };
    let zero = ReadOptions { resolution_m: Some(0.0), ..plain };
    let yaml = |resolution: &str| {
        let rest = "origin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
        format!("image: a.pgm\nresolution: {resolution}\n{rest}")
    };
    for (name, content, options, expected) in [
        (
            "o.yaml",
            yaml("NaN"),
            plain,
            "o.yaml line 2, column 13: resolution is NaN; give metres per pixel, for example 0.05",
        ),
        ("o.yaml", yaml("0.05"), plain, "o.yaml: a.pgm: there is no such file; check the path"),
        (
            "o.yaml",
            yaml("0.05"),
            with_cell,
            "o.yaml: the YAML states the cell size itself; leave the other one out, or edit `resolution`",
        ),
        (
            "o.yaml",
            yaml("0.05").replace("a.pgm", "o.yaml"),
            plain,
            "o.yaml: neither a PNG nor a PGM image; convert it to one of these",
        ),
        (
            "o.txt",
            "..\n...\n".into(),
            plain,
            "o.txt line 2, column 3: the row has 3 cells, the first row has 2; make all rows as long",
        ),
        (
            "o.txt",
            String::new(),
            plain,
            "o.txt: the map has no cell; give it at least one row of `.` and `#`",
        ),
        (
            "o.txt",
            "..\n".into(),
            zero,
            "o.txt: the cell size in metres is 0; it must be between 0.000001 and 1000000",
        ),
        (
            "o.map",
            "type octile\nheight 1\nwidth 2\nmap\n.#\n".into(),
            plain,
            "o.map line 5, column 2: unexpected character `#`; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle",
        ),
        ("o.png", String::new(), plain, "o.png: the file is empty; expected a PNG or PGM image"),
        (
            "o\n.txt",
            String::new(),
            plain,
            "o\\n.txt: the map has no cell; give it at least one row of `.` and `#`",
        ),
        (
            "o.bmp",
            String::new(),
            plain,
            "o.bmp: the ending names no map format; use .yaml (ROS map_server), .map (MovingAI), .png, .pgm or .txt",
        ),
    ] {
        assert_eq!(error(name, content.as_bytes(), &options), expected);
    }
}

#[test]
fn errors_of_bytes_and_of_paths() {
    let plain = ReadOptions::default();
    let garbage = error("o.txt", b"..\n.\xff\n", &plain);
    assert_eq!(garbage, "o.txt line 2, column 2: the byte 0xff is not text; is this a text map?");
    let read = |path: &str| read_map(Path::new(path), &plain).unwrap_err().to_string();
    assert_eq!(read("no/such.map"), "no/such.map: there is no such file; check the path");
    let folder = folder();
    fs::create_dir(folder.path().join("a.map")).unwrap();
    let error = read(&folder.path().join("a.map").display().to_string());
    assert!(error.ends_with("a.map: this is a folder; name a file"), "{error}");
}

#[test]
fn hexagons_are_written_as_cells() {
    let folder = folder();
    let map = Map::parse(Lattice::Hex, "..#\n#..").unwrap();
    for name in ["a.map", "a.png", "a.pgm", "a.txt"] {
        let path = folder.path().join(name);
        write_map(&path, &map).unwrap();
        let read =
            read_map(&path, &ReadOptions { resolution_m: Some(1.0), ..ReadOptions::default() }).unwrap().0;
        assert_eq!(read.on(Lattice::Hex), map);
    }
    let path = folder.path().join("b.yaml");
    let error = write_map(&path, &map).unwrap_err().to_string();
    assert!(error.ends_with(
        "b.yaml: a ROS map has square cells, this map has hexagons; write it as .txt or .map, or re-tile it"
    ));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
}

#[test]
fn reading_has_a_limit() {
    let folder = folder();
    let path = folder.path().join("a");
    write_atomically(&path, b"12345").unwrap();
    assert_eq!(read_bytes(&path, 5).unwrap(), b"12345");
    let error = read_bytes(&path, 4).unwrap_err().to_string();
    assert!(
        error.ends_with("/a: the file has more than 4 bytes; choose another file, or a part of it"),
        "{error}"
    );
}

#[test]
fn writing_replaces_a_file_as_a_whole() {
    let folder = folder();
    let path = folder.path().join("a");
    write_atomically(&path, b"first, longer").unwrap();
    write_atomically(&path, b"second").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"second");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left");
    let error = write_atomically(&folder.path().join("no/a"), b"").unwrap_err().to_string();
    assert!(error.ends_with("no/a: its folder does not exist; make the folder first"), "{error}");
    let error = write_atomically(folder.path(), b"").unwrap_err().to_string();
    assert!(error.ends_with(": this is a folder; name a file"), "{error}");
}

#[test]
fn files_that_belong_together_are_written_all_or_not_at_all() {
    let folder = folder();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    write_together(&[(&a, b"old a"), (&b, b"old b")]).unwrap();
    let none = folder.path().join("none/c");
    let error = write_together(&[(&a, b"new a"), (&b, b"new b"), (&none, b"")]).unwrap_err().to_string();
    assert!(error.ends_with("none/c: its folder does not exist; make the folder first"), "{error}");
    assert_eq!([&a, &b].map(|path| fs::read(path).unwrap()), [b"old a", b"old b"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing else is left");
}

#[test]
fn a_folder_that_cannot_be_written_leaves_nothing() {
    let folder = folder();
    let new = folder.path().join("new/one");
    let files: [(&str, &[u8]); 3] = [("deep/er/a", b"a"), ("deep/b", b"b"), ("deep/er", b"a folder by now")];
    let error = write_folder(&new, &files).unwrap_err().to_string();
    assert!(error.ends_with("er: this is a folder; name a file"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "no folder is left");
    write_folder(&new, &files[..2]).unwrap();
    assert_eq!(fs::read(new.join("deep/er/a")).unwrap(), b"a");
    let error = write_folder(&new, &[("deep/b/c", b"c")]).unwrap_err().to_string();
    assert!(error.ends_with("b: this is a file where a folder must be; move it away"), "{error}");
}

/// The YAML is refused, so the image is not written either.
#[test]
fn a_map_of_two_files_is_written_as_a_whole() {
    let folder = folder();
    fs::create_dir(folder.path().join("a.yaml")).unwrap();
    fs::write(folder.path().join("a.pgm"), "another image").unwrap();
    let map = Map::parse(Lattice::Square, "..#\n#..").unwrap();
    write_map(&folder.path().join("a.yaml"), &map).unwrap_err();
    assert_eq!(fs::read(folder.path().join("a.pgm")).unwrap(), b"another image");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn permissions_are_those_of_any_file() {
        let folder = folder();
        let (ours, usual) = (folder.path().join("a"), folder.path().join("b"));
        write_atomically(&ours, b"").unwrap();
        fs::write(&usual, b"").unwrap();
        assert_eq!(mode(&ours), mode(&usual));
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        write_atomically(&ours, b"new").unwrap();
        assert_eq!(mode(&ours), 0o640, "as before");
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o440)).unwrap();
        let error = write_atomically(&ours, b"newer").unwrap_err().to_string();
        assert!(error.ends_with("a: no permission to write it; change its permissions"), "{error}");
        assert_eq!(fs::read(&ours).unwrap(), b"new");
    }

    #[test]
    fn links_stay_links() {
        let folder = folder();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        symlink("file", &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }

    #[test]
    fn devices_are_written_and_read_directly() {
        write_atomically(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        assert_eq!(read_bytes(Path::new("/dev/null"), 0).unwrap(), b"");
        if Path::new("/dev/full").exists() {
            let error = write_atomically(Path::new("/dev/full"), b"x").unwrap_err().to_string();
            assert_eq!(error, "/dev/full: the disk is full; make room and try again");
        }
        // A device without an end is read up to the limit alone.
        let error = read_bytes(Path::new("/dev/zero"), 1000).unwrap_err().to_string();
        assert_eq!(
            error,
            "/dev/zero: the file has more than 1000 bytes; choose another file, or a part of it"
        );
    }
}
