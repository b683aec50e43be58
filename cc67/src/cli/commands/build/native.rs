//! `--emit native`: an object file of this computer, and the executable that `cc` makes of it.
//!
//! The object holds the program's machine code, its image and a `main`. All else, the board and the way the program
//! is loaded and run, is the simulator library: the archive that `cargo build` leaves beside the command.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, anyhow, ensure};
use kmotiondef::{CodeAddr, ThreadId};
use runtime::loader::prepare;
use vm::native::{Parts, object};

use crate::cli::io::output;
use compiler::files::reason;

/// The simulator library's file.
const LIBRARY: &str = if cfg!(windows) { "cc67board.lib" } else { "libcc67board.a" };

/// What the library needs of the system, and how what it does not need, and names for debuggers, are left out; at a
/// fixed address it needs no table of what to move.
const SYSTEM: &[&str] = if cfg!(target_os = "linux") {
    &["-s", "-no-pie", "-Wl,--gc-sections", "-lpthread", "-ldl", "-lm"]
} else if cfg!(target_os = "macos") {
    &["-Wl,-dead_strip", "-Wl,-x", "-liconv", "-lm"]
} else {
    &["-lm"]
};

/// Writes the executable of an image for `thread`, or its object file if `target` is named like one.
pub(super) fn write(target: &Path, image: &[u8], thread: ThreadId) -> Result<()> {
    let prepared = prepare(image, thread, |_| false).context("the image that was just made")?;
    let name = |at: CodeAddr| Some(prepared.debug.place(at)?.function.to_owned());
    let program = prepared.code.program().context("`--emit native` translates bytecode")?;
    let parts = Parts { program, image, thread, name: &name, pure: &runtime::pure_function };
    let object = object(parts).context("`--emit native`")?;
    if super::has_extension(target, &["o", "obj"]) {
        return output::write(target, &object);
    }
    let library = library()?;
    let temporary = output::Temporary::beside(target, "o");
    output::write(temporary.path(), &object)?;
    let executable = output::Temporary::beside(target, "tmp");
    link(temporary.path(), &library, executable.path())
        .with_context(|| format!("{} is not made", target.display()))?;
    executable.commit(target)
}

/// The simulator library: beside the command, where cargo leaves it in `deps` if a package needed it, or in the
/// folder `lib` of an installation.
fn library() -> Result<PathBuf> {
    let own = env::current_exe().context("where this command lies")?;
    let folder = own.parent().context("where this command lies")?;
    let mut places = ["", "deps", "../lib"].iter().map(|place| folder.join(place).join(LIBRARY));
    places.find(|place| place.is_file()).ok_or_else(|| {
        anyhow!(
            "`--emit native` needs the simulator library {LIBRARY} beside this command, in {}; \
             `cargo build --release -p cc67-capi` makes it. `cc67 run` needs neither that nor a linker",
            folder.display()
        )
    })
}

/// Has the host's linker make the executable.
fn link(object: &Path, library: &Path, target: &Path) -> Result<()> {
    let compiler = env::var_os("CC").filter(|name| !name.is_empty()).unwrap_or_else(|| OsString::from("cc"));
    let shown = compiler.to_string_lossy().into_owned();
    let linked = Command::new(&compiler)
        .arg("-o")
        .arg(target)
        .arg(object)
        .arg(library)
        .args(SYSTEM)
        .output()
        .map_err(|error| {
            anyhow!("`--emit native` links with `{shown}`, which does not start: {}", reason(&error))
        })?;
    let said = String::from_utf8_lossy(&linked.stderr);
    ensure!(linked.status.success(), "`{shown}` cannot link it:\n{}", said.trim_end());
    Ok(())
}
