//! Files that are there as a whole, or not at all.

use crate::error::Error;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Writes a file so that it is there as a whole or, after an error, as it was before.
///
/// The bytes go to a new file in the same folder, which then takes the place of the old one. Devices and pipes
/// (`/dev/stdout`) are written to directly.
///
/// # Errors
/// [`Error::Io`].
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("plan.txt");
/// activecell_formats::files::write_atomically(&path, b"done\n")?;
/// assert_eq!(std::fs::read(&path)?, b"done\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_together(&[(path, bytes)])
}

/// Writes files that belong together, each as [`write_atomically`] does: none takes its place before all are written,
/// so after an error all are as they were before.
///
/// They take their places in this order. [`abandon_writes`] waits until the last one has.
///
/// # Errors
/// [`Error::Io`].
pub fn write_together(files: &[(&Path, &[u8])]) -> Result<(), Error> {
    let failed = |path: &Path, cause| Error::Io { path: path.to_owned(), action: "write", cause };
    let mut written = Vec::new();
    for &(path, bytes) in files {
        written.extend(write_beside(path, bytes).map_err(|cause| failed(path, cause))?);
    }
    let _no_interrupt = made();
    let mut places = written.iter();
    places.try_for_each(|Written { new, target }| {
        fs::rename(&new.0, target).map_err(|cause| failed(target, cause))
    })
}

/// Writes files into a folder as [`write_together`] does, and makes the folders that are missing. Paths begin in the folder.
///
/// # Errors
/// [`Error::Io`]; then the folders that were made are gone, too.
///
/// ```
/// use activecell_formats::files::write_folder;
/// # let temporary = tempfile::tempdir()?;
/// let folder = temporary.path().join("robot");
/// write_folder(&folder, &[("src/main.c", b"int main(void) { return 0; }\n"), ("README", b"A robot.\n")])?;
/// assert!(write_folder(&folder, &[("README", b"Another.\n"), ("src", b"")]).is_err(), "src is a folder");
/// assert_eq!(std::fs::read(folder.join("README"))?, b"A robot.\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_folder(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), Error> {
    let paths: Vec<PathBuf> = files.iter().map(|(path, _)| folder.join(path)).collect();
    let mut folders = NewFolders::default();
    for path in &paths {
        folders.make(path.parent().unwrap_or(folder))?;
    }
    let files = paths.iter().zip(files).map(|(path, &(_, bytes))| (path.as_path(), bytes));
    write_together(&files.collect::<Vec<_>>())
}

/// A file that is written, and where it will be.
struct Written {
    new: Made,
    target: PathBuf,
}

/// Writes a new file beside the one whose place it will take; `None` if it could be written only directly.
fn write_beside(path: &Path, bytes: &[u8]) -> io::Result<Option<Written>> {
    if path == Path::new("/dev/stdout") {
        // Opening it anew would begin at the start of a file to which standard output was redirected.
        let mut out = io::stdout().lock();
        out.write_all(bytes)?;
        return out.flush().map(|()| None);
    }
    let old = fs::metadata(path).ok();
    let old_is_file = old.as_ref().is_some_and(fs::Metadata::is_file);
    if old.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if old.is_some() && (!old_is_file || path.starts_with("/dev")) {
        return fs::OpenOptions::new().write(true).open(path)?.write_all(bytes).map(|()| None);
    }
    // A link stays a link: the file that it names is replaced, or made.
    let target = match fs::read_link(path) {
        _ if old_is_file => fs::canonicalize(path)?,
        Ok(named) => path.parent().unwrap_or(Path::new("")).join(named),
        Err(_) => path.to_owned(),
    };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(io::ErrorKind::NotFound.into());
    }
    let permissions = old.map(|old| old.permissions());
    if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    let (mut file, new) = Made::file_in(folder)?;
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    // A full disk may show only now.
    file.sync_all()?;
    Ok(Some(Written { new, target }))
}

/// The files and folders that a write has made and not ended with, the oldest first.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn made() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole even if somebody panicked over it.
    MADE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file or folder on that list while it lives. Then it goes, unless it took its place or has something in it.
struct Made(PathBuf);

impl Made {
    /// A new file with a name of its own.
    fn file_in(folder: &Path) -> io::Result<(fs::File, Self)> {
        // Nothing is made that an interrupt does not find on the list.
        let mut made = made();
        let (file, path) = new_file_in(folder)?.keep().map_err(|error| error.error)?;
        made.push(path.clone());
        Ok((file, Self(path)))
    }

    fn folder(path: &Path) -> io::Result<Self> {
        let mut made = made();
        fs::create_dir(path)?;
        made.push(path.to_owned());
        Ok(Self(path.to_owned()))
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        made().retain(|path| *path != self.0);
        take_back(&self.0);
    }
}

fn take_back(path: &Path) {
    // A file that took its place is no longer there, and a folder with something in it stays.
    let _ = fs::remove_file(path).or_else(|_| fs::remove_dir(path));
}

/// Takes back the writes that are under way, and lets none go on: for a program that is about to be ended.
pub fn abandon_writes() {
    let mut made = made();
    for path in made.drain(..).rev() {
        take_back(&path);
    }
    // Never unlocked.
    std::mem::forget(made);
}

/// Folders that were missing, the outermost first. Those that stay empty go when it is dropped.
#[derive(Default)]
struct NewFolders(Vec<Made>);

impl NewFolders {
    /// Makes a folder, and those that it lies in.
    fn make(&mut self, folder: &Path) -> Result<(), Error> {
        let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.is_dir();
        let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
        for folder in missing.into_iter().rev() {
            match Made::folder(folder) {
                Ok(made) => self.0.push(made),
                // Somebody else was faster.
                Err(_) if folder.is_dir() => {}
                Err(cause) => return Err(Error::Io { path: folder.to_owned(), action: "make", cause }),
            }
        }
        Ok(())
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        while self.0.pop().is_some() {}
    }
}

fn new_file_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".activecell-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any new file; the process's mask takes its share.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
