//! Sources and objects as units for linking.

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};

use compiler::object::{ReadError, is_object};
use compiler::pp::Disk;
use compiler::{Compilation, Options, files};

use crate::cli::io::input::read;

/// Compiles every source and reads every object.
pub(crate) fn compile(paths: &[PathBuf], options: &Options) -> Result<Vec<Compilation>> {
    paths.iter().map(|path| unit(path, read(path)?, options)).collect()
}

/// The unit of one file; its contents determine whether it is an object.
pub(crate) fn unit(path: &Path, bytes: Vec<u8>, options: &Options) -> Result<Compilation> {
    if !is_object_name(path) && !is_object(&bytes) {
        if is_image_name(path) {
            bail!("{}: {}", path.display(), ReadError::Linked);
        }
        return Ok(compiler::compile(path, bytes, options, &Disk));
    }
    Compilation::from_object(path, &bytes).map_err(|error| match (&error, files::describe(&bytes)) {
        (ReadError::NotCoff(_), Some(what)) => {
            anyhow!("{} is {what}, not an object of `cc67 build -c`", path.display())
        }
        _ => anyhow!("{}: {error}", path.display()),
    })
}

/// Returns whether a file is an object, judged by its name.
pub(crate) fn is_object_name(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("o") || extension.eq_ignore_ascii_case("obj")
}

fn is_image_name(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("out"))
}
