//! Bad input: one clear line, exit 1 or 2, within a small memory.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command in `folder` with at most 200 MB of address space (of which the program itself takes a few).
fn run(folder: &Path, arguments: &str) -> Output {
    let binary = env!("CARGO_BIN_EXE_activecell");
    Command::new("sh")
        .args(["-c", &format!("ulimit -v 200000; exec {binary} {arguments}")])
        .current_dir(folder)
        .output()
        .unwrap()
}

/// A PNG whose header says what it likes.
fn png(width: u32, height: u32) -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        !bytes.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
        })
    };
    let chunk = |kind: &[u8], body: &[u8]| {
        let named = [kind, body].concat();
        [&(body.len() as u32).to_be_bytes()[..], &named, &crc(&named).to_be_bytes()].concat()
    };
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 0, 0, 0, 0]].concat();
    let pixels = [0x78, 0x01, 0x63, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01];
    [&b"\x89PNG\r\n\x1a\n"[..], &chunk(b"IHDR", &header), &chunk(b"IDAT", &pixels), &chunk(b"IEND", &[])]
        .concat()
}

/// A folder of files that are not what they say.
fn traps() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let bomb: String = std::iter::once("a0: &a0 [x, x, x, x, x, x, x, x, x]\n".to_owned())
        .chain((1..12).map(|i| format!("a{i}: &a{i} [{}]\n", vec![format!("*a{}", i - 1); 9].join(", "))))
        .collect();
    let yaml = |image: &str, resolution: &str| {
        format!(
            "image: {image}\nresolution: {resolution}\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
        )
    };
    let row = |row: &str| {
        format!("time_s,x_m,y_m,bearing_rad,left_ticks,right_ticks\n0,0,0,0,0,0\n{row}\n").into_bytes()
    };
    let written: [(&str, Vec<u8>); 25] = [
        (
            "vast.json",
            b"{\"activecell\":\"plan\",\"version\":1,\"lattice\":\"hex\",\"steps\":99999999,\"robots\":[{\"start\":[0,0],\"moves\":\"\"}]}"
                .to_vec(),
        ),
        ("tiny.toml", b"wheel_perimeter_m = 1e-310\n".to_vec()),
        ("zero.yaml", yaml("/dev/zero", "0.05").into_bytes()),
        ("huge.map", b"type octile\nheight 4\nwidth 4000000000\nmap\n....\n".to_vec()),
        ("cut.map", b"type octile\nheight 4\nwidth 4\nmap\n....\n..".to_vec()),
        ("bomb.yaml", bomb.into_bytes()),
        ("nan.yaml", yaml("ok.pgm", "nan").into_bytes()),
        ("lying.png", png(60_000, 60_000)),
        ("lying.yaml", yaml("lying.png", "0.05").into_bytes()),
        ("ok.pgm", b"P5 4 2 255\n\xfe\xfe\xfe\xfe\x00\xfe\xfe\xfe".to_vec()),
        ("lying.pgm", b"P5 60000 60000 255\n\x00".to_vec()),
        ("ok.txt", b"S.#F\n....\n".to_vec()),
        ("empty.txt", Vec::new()),
        ("binary.txt", (0..=255).collect()),
        ("ok.csv", row("1,1,0,0,9,9")),
        ("nan.csv", row("1,1,nan,0,9,9")),
        ("half.csv", row("1,1,,0,9,9")),
        ("back.csv", row("-1,1,0,0,9,9")),
        ("cut.csv", row("1,1,0")),
        ("open.csv", row("1,,,,9,9")),
        ("still.csv", row("1,1,0,0,0,0")),
        ("ticks.csv", row("1,1,0,0,9.5,9")),
        ("names.csv", b"time,x,y,theta,left,right\n0,0,0,0,0,0\n".to_vec()),
        ("steered.toml", b"drive = \"steered\"\n".to_vec()),
        ("bad.toml", b"[errors]\nturn_red = 0.1\n".to_vec()),
    ];
    for (name, bytes) in written {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

#[test]
fn bad_input_gets_one_clear_line() {
    let folder = traps();
    let cells = "--from 0,0 --to 3,1";
    let cases = [
        (format!("route huge.map {cells}"), 1, "huge.map: the header declares 4000000000 columns"),
        (format!("route cut.map {cells}"), 1, "cut.map: the header declares 4 columns"),
        (format!("route bomb.yaml {cells}"), 1, "bomb.yaml line 1"),
        (format!("route nan.yaml {cells}"), 1, "nan.yaml line 2, column 13: resolution is NaN"),
        (format!("route lying.png {cells}"), 1, "lying.png: "),
        (format!("route lying.yaml {cells}"), 1, "lying.png: "),
        (format!("route lying.pgm {cells}"), 1, "lying.pgm: "),
        (format!("route empty.txt {cells}"), 1, "empty.txt: the map has no cell"),
        (format!("route binary.txt {cells}"), 1, "binary.txt line 2, column 118: the byte 0x80 is not text"),
        (format!("route missing.map {cells}"), 1, "missing.map: there is no such file"),
        (format!("route . {cells}"), 1, "the ending names no map format"),
        ("route ok.txt --from 2,0 --to 0,1".into(), 1, "the start (2,0) lies in an obstacle"),
        ("route ok.txt --from 0,1 --to 2,0".into(), 1, "the target (2,0) lies in an obstacle"),
        ("route ok.txt --from 0,0 --to 9,9".into(), 1, "cell (9,9) is outside the map"),
        ("route ok.txt --from 0,0 --to -1,0".into(), 1, "cell (-1,0) is outside the map"),
        ("route ok.txt --from 99m,0m --to 0,0".into(), 1, "the point 99 m, 0 m is outside the map"),
        ("route ok.txt --from S --to Q".into(), 1, "the map names no cell `Q`; it names: S, F"),
        (format!("route ok.txt {cells} --cell nan"), 2, "give a number from 0.000001 to 1000000"),
        (format!("route ok.txt {cells} --cell 0.000001"), 1, "is too large"),
        (format!("route ok.txt {cells} --cell 1 --radius -1"), 2, "give a number from 0 to 1000000"),
        (format!("route ok.txt {cells} --robot bad.toml"), 1, "bad.toml line 2, column 1: unknown key"),
        (format!("route ok.txt {cells} --picture a.bmp"), 2, "must end in .svg, .png or .gif"),
        (format!("route ok.txt {cells} --save no/where.json"), 1, "its folder does not exist"),
        (format!("route ok.txt {cells} --heading NE"), 2, "no such direction on this lattice"),
        (format!("route ok.txt {cells} --rule learning --max-steps 1"), 1, "gave up after 1 steps"),
        ("route ok.txt --from 0;0 --to 1,1".into(), 2, ""),
        ("route ok.txt --from 0,0".into(), 2, ""),
        (format!("route ok.txt {cells} --rule fastest"), 2, ""),
        ("table success --pairs 0".into(), 2, ""),
        ("convert ok.txt ok.txt".into(), 2, "the map is read from this file"),
        ("convert ok.pgm ok.yaml".into(), 2, "the map is read from this file"),
        (format!("route ok.txt {cells} --save a.svg --picture a.svg"), 2, "is to be written twice"),
        (
            format!("route ok.txt {cells} --robot tiny.toml"),
            1,
            "tiny.toml line 1, column 21: wheel_perimeter_m is",
        ),
        (format!("route zero.yaml {cells}"), 1, "is no regular file"),
        ("convert ok.txt out.bmp".into(), 2, "out.bmp: the ending names no map format"),
        ("scen ok.txt".into(), 1, "ok.txt line 1"),
        ("check ok.txt vast.json".into(), 1, "vast.json: 1 robots with 99999999 steps need 800000000 bytes"),
    ];
    for (arguments, code, message) in cases {
        refused(folder.path(), &arguments, code, message);
    }
}

#[test]
fn bad_logs_get_one_clear_line() {
    let folder = traps();
    let cases = [
        ("calibrate nan.csv", 1, "nan.csv line 3, column 5: y_m is `nan`; give a number"),
        ("calibrate half.csv", 1, "half.csv line 3, column 5: y_m is ``; give x, y and bearing"),
        ("calibrate back.csv", 1, "back.csv line 3: the time goes back"),
        ("calibrate cut.csv", 1, "cut.csv line 3: the row has 3 columns, the first line 6"),
        ("calibrate open.csv", 1, "open.csv: the log needs two poses of ground truth"),
        ("calibrate ticks.csv", 1, "ticks.csv line 3, column 9: left_ticks is `9.5`; give a whole number"),
        ("calibrate names.csv", 1, "names.csv line 1: no column time_s in the header"),
        ("calibrate binary.txt", 1, "binary.txt"),
        ("calibrate empty.txt", 1, "empty.txt: the log needs two poses"),
        ("calibrate /dev/zero", 1, "the file has more than 33554432 bytes"),
        ("calibrate ok.csv -o ok.csv", 2, "ok.csv is a log; give another name to write to"),
        ("calibrate ok.csv --hold-out ok.csv", 2, "ok, so it cannot be held out; name it once"),
        ("calibrate ok.csv ./ok.csv", 2, "./ok.csv is named twice; name it once"),
        ("calibrate missing.csv", 1, "missing.csv: there is no such file"),
        ("calibrate ok.csv", 2, "ok.csv does not say which robot drove; give --robot"),
        ("calibrate ok.csv --robot steered.toml", 1, "of a steered robot only the perimeter shows in a log"),
        ("calibrate still.csv --robot tiny.toml", 1, "tiny.toml line 1"),
        ("calibrate ok.csv --robot steered.toml --picture a.gif", 2, "must end in .svg or .png"),
    ];
    for (arguments, code, message) in cases {
        refused(folder.path(), arguments, code, message);
    }
}

/// The command fails with this code and message, and nothing else.
fn refused(folder: &Path, arguments: &str, code: i32, message: &str) {
    let output = run(folder, &arguments.replace(';', "\\;"));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments}: {stderr}");
    assert!(stderr.contains(message), "{arguments}: {stderr}");
    assert!(output.stdout.is_empty(), "{arguments}");
    if code == 1 {
        assert_eq!(stderr.trim_end().lines().count(), 1, "{arguments}: {stderr}");
        assert!(stderr.starts_with("activecell: "), "{stderr}");
    }
}

#[test]
fn outcomes_have_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("walls.txt"), "S.#F\n..#.\n").unwrap();
    fs::write(folder.path().join("cage.txt"), "S#F\n##.\n").unwrap();
    for (arguments, code, outcome) in [
        ("route walls.txt --from S --to 1,1 --json", 0, "\"arrived\""),
        ("route walls.txt --from S --to F --json", 3, "\"unreachable\""),
        ("route walls.txt --from S --to F --rule learning --json", 3, "\"unreachable\""),
        ("route walls.txt --from S --to F --rule published --json", 3, "\"trapped\""),
        ("route cage.txt --from S --to F --rule published --json", 3, "\"enclosed\""),
        ("route walls.txt --from S --to S --json", 0, "\"arrived\""),
    ] {
        let output = run(folder.path(), arguments);
        let stdout = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments}");
        assert!(stdout.starts_with(&format!("{{\"outcome\":{outcome}")), "{arguments}: {stdout}");
    }
}

#[test]
fn nothing_is_lost_when_the_disk_is_full() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("ok.txt"), "S..F\n").unwrap();
    fs::write(path.join("run.json"), "the old run").unwrap();
    // A limit on file sizes stands for the full disk; the signal that comes with it is ignored by the shell.
    let output = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 0; exec \"$0\" route ok.txt --from S --to F --save run.json -q",
        ])
        .arg(env!("CARGO_BIN_EXE_activecell"))
        .current_dir(path)
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("run.json"), "{stderr}");
    assert_eq!(fs::read_to_string(path.join("run.json")).unwrap(), "the old run");
    assert_eq!(fs::read_dir(path).unwrap().count(), 2, "no temporary file is left");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ok.txt"), "S..F\n").unwrap();
    let binary = env!("CARGO_BIN_EXE_activecell");
    let script = format!("{{ {binary} completions bash; echo $? >&2; }} | true");
    let output = Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr).trim(), "0");
}
