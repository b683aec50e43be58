//! Programs that are saved: a file that changes is compiled at once, on a thread of its own.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, SystemTime};

use cc67_host::{HostError, Options, UserProgram};

use crate::desk::{Compiled, Desk, Incoming};
use crate::{Program, names};

/// How often files are looked at.
const LOOK: Duration = Duration::from_millis(200);

/// Compiles a program.
pub(super) fn compile(program: &Program, options: &Options) -> Compiled {
    let compiled = match program.is_image {
        true => UserProgram::from_image(&program.path, program.thread),
        false => UserProgram::compile(&program.path, program.thread, options),
    };
    let result = compiled.map_err(|error: HostError| error.to_string());
    Compiled { program: program.clone(), result }
}

/// Looks at the files of some programs from now on, and hands in what becomes of those that are saved.
pub(super) fn watch(programs: Vec<Program>, include_dirs: Vec<PathBuf>, options: Options, desk: &Arc<Desk>) {
    let desk = Arc::clone(desk);
    thread::spawn(move || {
        let mut known: Vec<_> = programs.iter().map(|program| stamps(&program.path, &include_dirs)).collect();
        loop {
            thread::sleep(LOOK);
            for (program, known) in programs.iter().zip(&mut known) {
                let stamps = stamps(&program.path, &include_dirs);
                if stamps == *known || stamps.is_empty() {
                    continue;
                }
                *known = stamps;
                if !desk.hand_in(Incoming::Saved(Box::new(compile(program, &options)))) {
                    return;
                }
            }
        }
    });
}

/// When the files of a program were written, and how long they are.
fn stamps(path: &Path, include_dirs: &[PathBuf]) -> BTreeMap<PathBuf, (Option<SystemTime>, u64)> {
    let stamp = |path: PathBuf| {
        let data = fs::metadata(&path).ok()?;
        Some((path, (data.modified().ok(), data.len())))
    };
    names::files_of(path, include_dirs).into_iter().filter_map(stamp).collect()
}
