//! Saved programs: when a file changes, it is compiled at once on a separate thread.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};
use std::thread;
use std::time::{Duration, SystemTime};

use cc67_host::{CompileMessage, HostError, Options, UserProgram};
use runtime::MachineFile;

use crate::hub::{CompileResult, Hub, Incoming};
use crate::{Program, names};

/// The interval at which files are checked.
const LOOK: Duration = Duration::from_millis(200);
/// The time for which a file may be missing while an editor replaces it.
const AWAY: Duration = Duration::from_millis(100);

/// Files are watched as long as one of these exists.
pub(super) type Watch = Arc<()>;

/// Compiles a program.
pub(super) fn compile(program: &Program, options: &Options) -> CompileResult {
    let compiled = match program.is_image {
        true => UserProgram::from_image(&program.path, program.thread),
        false => UserProgram::compile(&program.path, program.thread, options),
    };
    let result = compiled.map_err(|error: HostError| match &error {
        HostError::Compile(error) => error.messages().to_vec(),
        other => vec![CompileMessage::new(other.to_string())],
    });
    CompileResult { program: program.clone(), result }
}

/// Watches the files of some programs from now on, and sends the results for those that are saved or deleted.
pub(super) fn watch(
    programs: Vec<Program>,
    include_dirs: Vec<PathBuf>,
    options: Options,
    (watch, hub): (&Watch, &Arc<Hub>),
) {
    let (hub, watch) = (Arc::clone(hub), Arc::downgrade(watch));
    thread::spawn(move || {
        let mut known: Vec<_> = programs.iter().map(|program| stamps(&program.path, &include_dirs)).collect();
        while is_wanted(&watch) {
            thread::sleep(LOOK);
            for (program, known) in programs.iter().zip(&mut known) {
                let mut stamps = stamps(&program.path, &include_dirs);
                if !stamps.contains_key(&program.path) {
                    thread::sleep(AWAY);
                    stamps = self::stamps(&program.path, &include_dirs);
                }
                if stamps == *known {
                    continue;
                }
                *known = stamps;
                if !hub.hand_in(Incoming::Saved(Box::new(compile(program, &options)))) {
                    return;
                }
            }
        }
    });
}

/// Watches the machine file from now on, and sends the result of checking it when it is saved.
pub(super) fn watch_machine(path: PathBuf, watch: &Watch, hub: &Arc<Hub>) {
    let (hub, watch) = (Arc::clone(hub), Arc::downgrade(watch));
    thread::spawn(move || {
        let mut known = fs::read(&path).ok();
        while is_wanted(&watch) {
            thread::sleep(LOOK);
            let bytes = fs::read(&path).ok();
            if bytes == known {
                continue;
            }
            if bytes.is_none() {
                thread::sleep(AWAY);
            }
            known = fs::read(&path).ok();
            if !hub.hand_in(Incoming::Machine(check_machine(&path, known.as_deref()))) {
                return;
            }
        }
    });
}

/// Checks a machine file; the error is `file:line:column: reason`.
fn check_machine(path: &Path, bytes: Option<&[u8]>) -> Result<(), String> {
    let name = path.display();
    let bytes = bytes.ok_or_else(|| format!("{name} cannot be read"))?;
    let text = std::str::from_utf8(bytes).map_err(|_| format!("{name} is not text"))?;
    let parsed = MachineFile::parse(text);
    parsed.map(drop).map_err(|error| format!("{name}:{}:{}: {error}", error.line, error.column))
}

fn is_wanted(watch: &Weak<()>) -> bool {
    watch.strong_count() > 0
}

/// The modification times and sizes of a program's files.
fn stamps(path: &Path, include_dirs: &[PathBuf]) -> BTreeMap<PathBuf, (Option<SystemTime>, u64)> {
    let stamp = |path: PathBuf| {
        let data = fs::metadata(&path).ok()?;
        Some((path, (data.modified().ok(), data.len())))
    };
    names::files_of(path, include_dirs).into_iter().filter_map(stamp).collect()
}
