//! The initial state of a board: the arguments of `cc67.Board`.

use std::path::{Path, PathBuf};

use cc67_host::{BootedFirmware, HostError, Setup, UserProgram};
use compiler::Options;
use kmotiondef::boards::TargetBoard;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{GuestAddr, ThreadId};
use pyo3::prelude::*;
use runtime::stimulus::Stimulus;
use runtime::{Config, Directory, MachineFile, ModelledBoard};
use vm::machine::Config as MachineConfig;

use crate::errors::{LoadError, input};
use crate::program::{LinkableProgram, read, thread};

/// The arguments as Python passes them; the texts of files are read there.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct BoardArguments<'py> {
    /// Thread, program, whether it is started.
    programs: Vec<(i32, PyRef<'py, LinkableProgram>, bool)>,
    /// The name of the machine file, its folder and its text.
    machine: Option<(String, PathBuf, String)>,
    /// Keys of the machine file, and `persist.N`.
    settings: Vec<(String, String)>,
    /// Names and texts of stimuli.
    stim: Vec<(String, String)>,
    /// The folder of files that programs open.
    files: Option<PathBuf>,
    /// Answers of the PC, `key=value`.
    answers: Vec<String>,
    assist: bool,
    shortcuts: bool,
    uart_input: Vec<u8>,
    /// The firmware file that is executed.
    boot: Option<PathBuf>,
}

/// A setup, and what is known about the axes.
pub(crate) struct PreparedSetup {
    pub(crate) setup: Setup,
    /// The firmware file that is executed, started.
    pub(crate) firmware: Option<BootedFirmware>,
    /// Name and unit of each axis.
    pub(crate) axes: Vec<(String, String)>,
}

impl BoardArguments<'_> {
    /// The setup that is requested.
    pub(crate) fn arrange(self) -> PyResult<PreparedSetup> {
        let options =
            self.programs.first().map_or_else(Options::default, |(_, program, _)| program.options.clone());
        let board = ModelledBoard::of(options.firmware.board()).unwrap_or_default();
        let mut machine_file = match &self.machine {
            Some((name, folder, text)) => machine_file(board.board(), name, folder, text)?,
            None => MachineFile { board: board.board(), ..MachineFile::default() },
        };
        let mut values = Vec::new();
        for (key, value) in &self.settings {
            match key.strip_prefix("persist.") {
                Some(index) => values.push(start_value(key, index, value)?),
                None => machine_file
                    .set(key.trim(), value.trim())
                    .map_err(|error| input(format!("set {key}={value}: {error}")))?,
            }
        }
        let stimulus = stimulus(&self.stim)?;
        let offered = offered(&[&machine_file.stimulus, &stimulus], &options)?;
        let programs = programs(&self.programs)?;
        let mut answers = machine_file.pc.answers.clone();
        for answer in &self.answers {
            answers.set(answer).map_err(|error| input(format!("answer {answer:?}: {error}")))?;
        }
        let folder = self.files.or_else(|| machine_file.pc.disk_root.as_deref().map(PathBuf::from));
        let folder = folder.unwrap_or_else(|| PathBuf::from("cc67-files"));
        let files = Box::new(Directory::new(folder).with_names(machine_file.pc.disk_files.clone()));
        let axes = board.board().axes.iter().map(|axis| &machine_file.axes[axis.index()]);
        let axes = axes.map(|axis| (axis.name.clone(), axis.units.clone())).collect();
        let machine = MachineConfig { shortcuts: self.shortcuts, ..MachineConfig::default() };
        let config =
            Config { board, machine, files, machine_file, answers: Some(answers), ..Config::default() };
        let setup = Setup {
            config,
            options,
            programs,
            offered,
            values,
            stimulus,
            is_assisted: self.assist,
            uart_input: self.uart_input,
            hears_uart: true,
        };
        let firmware = self.boot.as_deref().map(boot).transpose()?;
        Ok(PreparedSetup { setup, firmware, axes })
    }
}

/// Starts a firmware file.
fn boot(path: &Path) -> PyResult<BootedFirmware> {
    let failed = |error| input(format!("boot={:?}: {error}", path.display().to_string()));
    BootedFirmware::new(&read(path)?).map_err(failed)
}

fn machine_file(board: &'static TargetBoard, name: &str, folder: &Path, text: &str) -> PyResult<MachineFile> {
    let file = MachineFile::parse_for(board, text);
    let mut file = file.map_err(|error| input(format!("{name}:{}:{}: {error}", error.line, error.column)))?;
    file.set_name(Path::new(name));
    file.resolve_paths(folder);
    Ok(file)
}

fn stimulus(texts: &[(String, String)]) -> PyResult<Stimulus> {
    let mut all = Stimulus::default();
    for (name, text) in texts {
        all.extend(Stimulus::parse(text, name).map_err(input)?);
    }
    Ok(all)
}

/// Programs that stimuli load while they are played, each once.
fn offered(stimuli: &[&Stimulus], options: &Options) -> PyResult<Vec<UserProgram>> {
    let mut known: Vec<(ThreadId, PathBuf)> = Vec::new();
    for (thread, name) in stimuli.iter().flat_map(|stimulus| stimulus.programs()) {
        let program = (thread, PathBuf::from(&**name));
        if !known.contains(&program) {
            known.push(program);
        }
    }
    let compile = |(thread, path): (ThreadId, PathBuf)| {
        let is_image = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("out"));
        if is_image {
            UserProgram::from_image(&path, thread)
        } else {
            UserProgram::compile(&path, thread, options)
        }
    };
    known.into_iter().map(compile).collect::<Result<_, _>>().map_err(refused)
}

fn programs(wanted: &[(i32, PyRef<'_, LinkableProgram>, bool)]) -> PyResult<Vec<UserProgram>> {
    let mut programs: Vec<UserProgram> = Vec::new();
    for (number, program, starts) in wanted {
        let program = program.for_thread(thread(*number)?)?;
        if let Some(other) = programs.iter().find(|other| other.thread == program.thread) {
            let (one, two) = (other.name(), program.name());
            return Err(input(format!("two programs for thread {}: {one} and {two}", program.thread)));
        }
        programs.push(if *starts { program.started() } else { program });
    }
    Ok(programs)
}

/// Converts a board's refusal of a program into an exception.
pub(crate) fn refused(error: HostError) -> PyErr {
    LoadError::new_err(error.to_string())
}

/// A start value of `persist.UserData`, by the text that `--set` takes.
fn start_value(key: &str, index: &str, value: &str) -> PyResult<(GuestAddr, Vec<u8>)> {
    let wrong = |why: &str| input(format!("set {key}={value}: {why}"));
    let index: usize = index.parse().map_err(|_| wrong("the index is not a number"))?;
    let bytes: Vec<u8> = if let Some(single) = value.strip_prefix("f:") {
        single.parse::<f32>().map_err(|_| wrong("not a number"))?.to_le_bytes().into()
    } else if let Some(double) = value.strip_prefix("d:") {
        double.parse::<f64>().map_err(|_| wrong("not a number"))?.to_le_bytes().into()
    } else {
        let number: i64 = match value.strip_prefix("0x") {
            Some(digits) => i64::from_str_radix(digits, 16),
            None => value.parse(),
        }
        .map_err(|_| wrong("not an integer, f:FLOAT or d:DOUBLE"))?;
        let word = i32::try_from(number).map(i32::cast_unsigned).or_else(|_| u32::try_from(number));
        word.map_err(|_| wrong("does not fit 32 bits"))?.to_le_bytes().into()
    };
    if index.saturating_add(bytes.len() / 4) > N_USER_DATA_VARS {
        return Err(wrong("is outside persist.UserData[0..199]"));
    }
    Ok((PERSIST.field(Persist::USER_DATA).element(index).address(), bytes))
}
