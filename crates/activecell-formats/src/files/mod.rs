//! The disk: the only module that touches it.

mod write;

pub use write::{abandon_writes, write_atomically, write_folder, write_together};

use crate::drive_log;
use crate::elevation::{self, Georeference, HeightFormat, HeightOptions, Relief};
use crate::error::{Error, line_and_column, shown};
use crate::movingai;
use crate::raster;
use crate::ros::{self, MapYaml};
use activecell::{DriveLog, Frame, Ground, Lattice, Map, Robot};
use std::fs;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// The longest map or image that is read, in bytes: 1 GiB, a plain PGM of [`activecell::MAX_CELLS`] pixels.
pub const MAX_MAP_BYTES: u64 = 1 << 30;

/// Reads a whole file, or a pipe to its end, of at most `limit_bytes`.
///
/// # Errors
/// [`Error::TooLarge`], before anything is read where the length is known; [`Error::Io`].
pub fn read_bytes(path: &Path, limit_bytes: u64) -> Result<Vec<u8>, Error> {
    let failed = |cause| Error::Io { path: path.to_owned(), action: "read", cause };
    let too_large = || {
        let advice = "choose another file, or a part of it";
        Error::TooLarge { limit: limit_bytes, advice }.in_file(path)
    };
    let metadata = fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    if metadata.len() > limit_bytes {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(metadata.len() as usize)
        .map_err(|_| failed(io::ErrorKind::OutOfMemory.into()))?;
    // One byte more tells a file of exactly the limit from a longer one.
    let file = fs::File::open(path).map_err(failed)?;
    file.take(limit_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limit_bytes { Err(too_large()) } else { Ok(bytes) }
}

/// The files that a map is read from: the file itself, and the image that a ROS YAML file names.
pub fn sources(path: &Path) -> Vec<PathBuf> {
    let mut sources = vec![path.to_owned()];
    if MapFormat::of(path).is_ok_and(|format| format == MapFormat::Ros)
        && let Ok(bytes) = read_bytes(path, ros::MAX_YAML_BYTES)
        && let Ok(yaml) = MapYaml::read(&bytes)
    {
        sources.push(beside(path, &yaml.image));
    }
    sources
}

/// The files that [`write_map`] writes: the file itself, and the image beside a ROS YAML file.
pub fn outputs(path: &Path) -> Vec<PathBuf> {
    let mut outputs = vec![path.to_owned()];
    if MapFormat::of(path).is_ok_and(|format| format == MapFormat::Ros) {
        outputs.push(path.with_extension("pgm"));
    }
    outputs
}

/// The formats of map files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MapFormat {
    /// ROS `map_server`: `.yaml`, `.yml`, with an image beside it.
    Ros,
    /// `MovingAI`: `.map`.
    MovingAi,
    /// An image: `.png`.
    Png,
    /// An image: `.pgm`.
    Pgm,
    /// Text: `.txt`.
    Text,
    /// Heights of the ground: `.asc`, `.tif`, `.npy`, `.npz`.
    Elevation,
}

impl MapFormat {
    /// The format that the path's ending names, in upper or lower case.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    ///
    /// ```
    /// use activecell_formats::files::MapFormat;
    /// assert_eq!(MapFormat::of("maps/Office.YAML".as_ref())?, MapFormat::Ros);
    /// # Ok::<(), activecell_formats::Error>(())
    /// ```
    pub fn of(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        match ending.to_str() {
            Some("yaml" | "yml") => Ok(Self::Ros),
            Some("map") => Ok(Self::MovingAi),
            Some("png") => Ok(Self::Png),
            Some("pgm") => Ok(Self::Pgm),
            Some("txt") => Ok(Self::Text),
            Some("asc" | "tif" | "tiff" | "npy" | "npz") => Ok(Self::Elevation),
            _ => Err(Error::UnknownFormat { path: path.to_owned() }),
        }
    }
}

/// How a map is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadOptions {
    /// How images become free cells and obstacles.
    pub reading: ros::Reading,
    /// The size of a cell in metres for formats that state none; without it 1 m, in images 0.05 m.
    pub resolution_m: Option<f64>,
    /// How the values of an elevation become heights.
    pub heights: HeightOptions,
}

/// Reads a map in the format that its ending names; a `.txt` that begins with `type ` is a `MovingAI` map.
/// The map is always of squares. An elevation becomes a map in which every cell with a height is free.
///
/// The image of a `.yaml` is looked for in the YAML's folder, unless its path is absolute; `~/` at its beginning
/// means that folder too.
///
/// # Errors
/// All errors of the formats, with the file. [`Error::BadFormat`] if a resolution is given for a file that states it.
pub fn read_map(path: &Path, options: &ReadOptions) -> Result<(Map, MapFormat), Error> {
    let format = MapFormat::of(path)?;
    read_map_as(path, format, options).map_err(|error| error.in_file(path))
}

fn read_map_as(path: &Path, format: MapFormat, options: &ReadOptions) -> Result<(Map, MapFormat), Error> {
    let bytes = || read_bytes(path, MAX_MAP_BYTES);
    let in_cells = |map: Map| match options.resolution_m {
        Some(cell_m) => Ok::<_, Error>(map.in_frame(Frame { cell_m, ..Frame::default() })?),
        None => Ok(map),
    };
    match format {
        MapFormat::Ros if options.resolution_m.is_some() => Err(Error::file(
            "the YAML states the cell size itself; leave the other one out, or edit `resolution`",
        )),
        MapFormat::Ros => Ok((read_ros(path, options.reading)?, format)),
        MapFormat::Png | MapFormat::Pgm => {
            let default = MapYaml::default();
            let yaml =
                MapYaml { resolution_m: options.resolution_m.unwrap_or(default.resolution_m), ..default };
            Ok((ros::to_map(&raster::read_image(&bytes()?)?, &yaml, &options.reading)?, format))
        }
        MapFormat::Elevation => {
            let heights = HeightOptions { apart_m: options.resolution_m, ..options.heights };
            let elevation = read_elevation(path, &heights)?.elevation;
            let [across, down] = elevation.posts().apart_m;
            Ok((Map::over(elevation, Lattice::Square, across.min(down), Ground::default())?, format))
        }
        MapFormat::MovingAi => Ok((in_cells(movingai::read_map(&bytes()?)?)?, format)),
        MapFormat::Text => {
            let bytes = bytes()?;
            let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
            if bytes.starts_with(b"type ") {
                return Ok((in_cells(movingai::read_map(bytes)?)?, MapFormat::MovingAi));
            }
            Ok((in_cells(Map::parse(Lattice::Square, text(bytes)?)?)?, format))
        }
    }
}

/// Reads the heights of the ground in the format that the ending names.
///
/// # Errors
/// All errors of [`elevation::read`], with the file; [`Error::BadFormat`] if the ending names no format, or a
/// distance of posts is given for a file that states it.
pub fn read_elevation(path: &Path, options: &HeightOptions) -> Result<Relief, Error> {
    let read = || {
        let format = HeightFormat::of(path).ok_or_else(|| {
            Error::file(
                "the ending names no elevation; use .tif (GeoTIFF), .asc (ESRI grid), .png, .npy or .npz",
            )
        })?;
        let relief = elevation::read(&read_bytes(path, MAX_MAP_BYTES)?, format, options)?;
        if options.apart_m.is_some() && relief.georeference != Georeference::None {
            return Err(Error::file(
                "the file states the distance of its posts itself; leave --resolution out",
            ));
        }
        Ok(relief)
    };
    read().map_err(|error| error.in_file(path))
}

fn read_ros(path: &Path, reading: ros::Reading) -> Result<Map, Error> {
    let yaml = MapYaml::read(&read_bytes(path, ros::MAX_YAML_BYTES)?)?;
    let image_path = beside(path, &yaml.image);
    if fs::metadata(&image_path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(Error::file(format!("image {} is no regular file; name an image", shown(&image_path))));
    }
    let image = match read_bytes(&image_path, MAX_MAP_BYTES) {
        Ok(bytes) => raster::read_image(&bytes).map_err(|error| error.in_file(&image_path))?,
        // Who named that file?
        Err(cause) => return Err(Error::InFile { path: path.to_owned(), cause: Box::new(cause) }),
    };
    ros::to_map(&image, &yaml, &reading)
}

/// The logs that a path names: itself, or if it is a folder every `.csv` in it but metadata, by name.
///
/// # Errors
/// [`Error::Io`]; [`Error::BadFormat`] for a folder without logs.
pub fn drive_logs(path: &Path) -> Result<Vec<PathBuf>, Error> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let failed = |cause| Error::Io { path: path.to_owned(), action: "read", cause };
    let mut logs = Vec::new();
    for entry in fs::read_dir(path).map_err(failed)? {
        let log = entry.map_err(failed)?.path();
        let is_csv = log.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        let stem = log.file_stem().unwrap_or_default().to_string_lossy();
        if is_csv && !stem.ends_with("_metadata") {
            logs.push(log);
        }
    }
    logs.sort();
    if logs.is_empty() {
        return Err(Error::file("the folder holds no .csv; name a log, or a folder of logs").in_file(path));
    }
    Ok(logs)
}

/// Reads an encoder log, and the robot of the `OptiOdom` metadata file beside it (`NAME_metadata.csv` for
/// `NAME_run-01.csv`), if there is one.
///
/// # Errors
/// All errors of [`drive_log`], with the file.
pub fn read_drive_log(path: &Path) -> Result<(DriveLog, Option<Robot>), Error> {
    let log = drive_log::read(&read_bytes(path, drive_log::MAX_LOG_BYTES)?);
    let log = log.map_err(|error| error.in_file(path))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some((session, _)) = name.rsplit_once("_run-") else { return Ok((log, None)) };
    let metadata = path.with_file_name(format!("{session}_metadata.csv"));
    if !metadata.is_file() {
        return Ok((log, None));
    }
    let robot = drive_log::read_metadata(&read_bytes(&metadata, drive_log::MAX_METADATA_BYTES)?);
    Ok((log, Some(robot.map_err(|error| error.in_file(&metadata))?)))
}

fn beside(path: &Path, name: &str) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

fn text(bytes: &[u8]) -> Result<&str, Error> {
    std::str::from_utf8(bytes).map_err(|error| {
        let index = error.valid_up_to();
        let (line, column) = line_and_column(bytes, index);
        Error::at(line, column, format!("the byte {:#04x} is not text; is this a text map?", bytes[index]))
    })
}

/// Writes a map in the format that the ending names.
///
/// A `.yaml` gets its image beside it, with the same name and the ending `.pgm`. The other formats
/// do not keep the frame, and only `.txt` keeps the names of cells; no format keeps the lattice.
///
/// # Errors
/// [`Error::UnknownFormat`]; [`Error::Io`]; [`Error::BadFormat`] for a `.yaml` of hexagons.
pub fn write_map(path: &Path, map: &Map) -> Result<(), Error> {
    match MapFormat::of(path)? {
        MapFormat::Ros => write_ros(path, map).map_err(|error| error.in_file(path)),
        MapFormat::MovingAi => write_atomically(path, movingai::write_map(map).as_bytes()),
        MapFormat::Png => {
            let bytes = ros::to_image(map).and_then(|image| raster::write_png(&image));
            write_atomically(path, &bytes.map_err(|error| error.in_file(path))?)
        }
        MapFormat::Pgm => {
            let image = ros::to_image(map).map_err(|error| error.in_file(path))?;
            write_atomically(path, &raster::write_pgm(&image))
        }
        MapFormat::Text => write_atomically(path, map.to_text().as_bytes()),
        MapFormat::Elevation => Err(Error::UnknownFormat { path: path.to_owned() }),
    }
}

fn write_ros(path: &Path, map: &Map) -> Result<(), Error> {
    let (yaml, image) = ros::from_map(map)?;
    let image_path = path.with_extension("pgm");
    let Some(name) = image_path.file_name().and_then(|name| name.to_str()) else {
        return Err(Error::file(
            "the file's name is not text, and the YAML must name its image; choose another name",
        ));
    };
    let yaml = MapYaml { image: name.to_owned(), ..yaml };
    write_together(&[(&image_path, &raster::write_pgm(&image)), (path, yaml.write().as_bytes())])
}
