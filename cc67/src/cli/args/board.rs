//! The options of a board: its connections, its initial state, its engine.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use cc67_host::Schedule;
use clap::{Args, ValueEnum};
use compiler::words::suggest;
use kmotiondef::boards::TargetBoard;
use runtime::{Directory, HostFiles, MachineFile, Overlay, REMARKS};
use vm::engine::{ObservedAccesses, Preemption};
use vm::machine::Config as MachineConfig;

use super::controller::ControllerArguments;
use super::engine::EngineName;
use super::heading;
use super::pc::PcArguments;
use super::uart::UartArguments;
use crate::cli::io::input::read;

/// The form of a run: fast, or closer to the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum RunForm {
    /// Threads are switched between statements only
    #[default]
    Fast,
    /// Threads are switched between any two accesses to memory, as on the board: updates can be lost
    Board,
}

impl RunForm {
    /// Returns the points at which threads lose the processor.
    pub(crate) const fn preemption(self) -> Preemption {
        match self {
            Self::Fast => Preemption::Segments,
            Self::Board => Preemption::Instructions,
        }
    }
}

/// The options of a board, of every command that has one.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = heading::BOARD)]
pub(crate) struct BoardArguments {
    /// Simulate the board this closely; `--as firmware FILE` executes your own firmware file
    #[arg(long = "as", value_name = "FIDELITY", value_enum, default_value_t, overrides_with = "form")]
    pub(crate) form: RunForm,
    /// Describe what is connected to the board, such as motors, switches, probes, encoders: a machine file (TOML)
    #[arg(long, value_name = "FILE")]
    pub(crate) machine: Option<PathBuf>,
    /// Let things happen around the board: a stimulus file, or statements such as "t=0.5 bit 136=1"
    #[arg(long, alias = "stimulus", value_name = "FILE|TEXT")]
    pub(crate) stim: Vec<String>,
    /// Set a start value, `persist.N=VALUE` (an integer, 0x…, a float f:1.5 or a double d:1.5), or a key of the machine
    /// file
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Act as an operator: when all programs wait for inputs, toggle those inputs one at a time
    #[arg(long)]
    pub(crate) assist: bool,
    /// Watch what threads do to memory that they share, and report what goes wrong on the board: lost updates, cells taken
    /// twice, values read half old, locks in opposite orders; programs are interpreted
    #[arg(long)]
    pub(crate) races: bool,
    /// Run under a schedule of `cc67 test --schedules`: a seed, or its parts (start2+7,switch57); implies --as board and --races
    #[arg(long, value_name = "SEED")]
    pub(crate) schedule: Option<Schedule>,
    /// Switch a remark off (`-R no-CODE`) or on again (`-R CODE`); `cc67 explain remarks` lists the codes
    #[arg(short = 'R', value_name = "no-CODE")]
    remarks: Vec<String>,
    /// Execute your own firmware file instead of the modelled firmware; same as `--as firmware FILE`
    #[arg(long, value_name = "FILE")]
    pub(crate) boot: Option<PathBuf>,
    /// Load a program without starting it, so that another program can start it
    #[arg(long, value_name = "N:FILE", help_heading = heading::PROGRAMS)]
    pub(crate) load: Vec<OsString>,
    /// Keep the files that programs open on the PC in DIR [default: that of the machine file, or cc67-files]
    #[arg(long, value_name = "DIR", help_heading = heading::PC)]
    files: Option<PathBuf>,
    /// Execute the programs on this engine
    #[arg(long, value_enum, help_heading = heading::EXPERTS)]
    engine: Option<EngineName>,
    /// Do what the board does on accesses to ROM, control registers and misaligned addresses, and on integer division
    /// by zero, which stop the thread otherwise; floating numbers are divided by the firmware's functions, as in the
    /// vendor's code
    #[arg(long, help_heading = heading::EXPERTS)]
    pub(crate) board_faults: bool,
    /// Simulate every tick and every wait in full; slower, with the same results
    #[arg(long, help_heading = heading::EXPERTS)]
    no_shortcuts: bool,
    /// True if files that programs write are only visible to them.
    #[arg(skip)]
    pub(crate) keeps_files: bool,
    #[command(flatten)]
    pub(crate) controller: ControllerArguments,
    #[command(flatten)]
    pub(crate) uart: UartArguments,
    #[command(flatten)]
    pub(crate) pc: PcArguments,
}

/// Returns the words of a command line with `--boot FILE` for `--as firmware FILE`, the only option with two values, and
/// with `--serves NAME=FILE` for `--board NAME=FILE`, which is about another board than `--board NAME`.
pub(crate) fn canonical_words(words: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut words = words.into_iter().peekable();
    let mut all: Vec<OsString> = Vec::new();
    let is_pair = |word: &OsString| word.to_str().is_some_and(|word| word.contains('='));
    while let Some(word) = words.next() {
        let pair = match word.to_str() {
            Some("--board") => words.next_if(is_pair),
            Some(word) => word.strip_prefix("--board=").map(Into::into).filter(is_pair),
            None => None,
        };
        if let Some(pair) = pair {
            all.extend([SERVES.into(), pair]);
            continue;
        }
        let is_firmware =
            word == "--as=firmware" || word == "--as" && words.next_if(|next| next == "firmware").is_some();
        all.push(match (is_firmware, words.peek()) {
            (true, Some(_)) => "--boot".into(),
            (true, None) => "--as=firmware".into(),
            (false, _) => word,
        });
    }
    all
}

/// The internal spelling of `--board NAME=FILE` of `serve`.
pub(crate) const SERVES: &str = "--serves";

impl BoardArguments {
    /// Returns the engine that executes the programs.
    pub(crate) fn engine(&self) -> EngineName {
        self.engine.unwrap_or_default()
    }

    /// Returns how faithfully the run models the board.
    pub(crate) fn form(&self) -> RunForm {
        if self.schedule.is_some() { RunForm::Board } else { self.form }
    }

    /// Returns how the machine works.
    pub(crate) fn machine_config(&self) -> MachineConfig {
        MachineConfig {
            shortcuts: !self.no_shortcuts,
            preemption: self.form().preemption(),
            observed: match (self.schedule.is_some(), self.races) {
                (true, _) => ObservedAccesses::All,
                (false, true) => ObservedAccesses::Fresh,
                (false, false) => ObservedAccesses::None,
            },
            ..MachineConfig::default()
        }
    }

    /// Refuses an option that a firmware file does not know.
    pub(crate) fn refuse_with_boot(&self) -> Result<()> {
        self.refuse_beside_boot()?;
        ensure!(!self.board_faults, "`--board-faults` does not work with `--boot`");
        Ok(())
    }

    /// Refuses an option that has no meaning where the model runs beside a firmware file, either.
    pub(crate) fn refuse_beside_boot(&self) -> Result<()> {
        let refused = [
            ("--engine", self.engine.is_some()),
            ("--as", self.form != RunForm::default()),
            ("--races", self.races),
            ("--schedule", self.schedule.is_some()),
        ];
        for (option, is_given) in refused {
            ensure!(!is_given, "`{option}` does not work with `--boot`");
        }
        Ok(())
    }

    /// Refuses an option that a connected controller does not know.
    pub(crate) fn refuse_with_controller(&self) -> Result<()> {
        let refused = [
            ("--boot", self.boot.is_some()),
            ("--engine", self.engine.is_some()),
            ("--as", self.form != RunForm::default()),
            ("--races", self.races),
            ("--schedule", self.schedule.is_some()),
            ("--assist", self.assist),
            ("--machine", self.machine.is_some()),
            ("--flash", self.pc.has_flash()),
            ("--uart", self.uart.uart.is_some()),
            ("--uart-input", self.uart.uart_input.is_some()),
            ("--uart-output", self.uart.uart_output.is_some()),
            ("--board-faults", self.board_faults),
            ("--no-shortcuts", self.no_shortcuts),
        ];
        for (option, is_given) in refused {
            ensure!(!is_given, "`{option}` is about a simulated board: it does not work with `--on`");
        }
        Ok(())
    }

    /// Reads the machine file, and sets which remarks are shown.
    pub(crate) fn machine_file(&self, board: &'static TargetBoard) -> Result<MachineFile> {
        let mut machine = self.described(board)?;
        for switch in &self.remarks {
            let (code, is_wanted) =
                switch.strip_prefix("no-").map_or((&**switch, true), |code| (code, false));
            // Codes of remarks may begin with this, too.
            let known = machine.want_remark(switch, true).or_else(|| machine.want_remark(code, is_wanted));
            if known.is_none() {
                let near = suggest(code, REMARKS.iter().map(|row| row.code));
                let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                anyhow::bail!(
                    "`-R {switch}`: no such remark: `{code}`{near} (`cc67 explain remarks` lists all)"
                );
            }
        }
        Ok(machine)
    }

    /// Reads the machine file.
    fn described(&self, board: &'static TargetBoard) -> Result<MachineFile> {
        let Some(path) = self.machine.as_deref() else {
            return Ok(MachineFile { board, ..MachineFile::default() });
        };
        read_machine_file(path, board)
    }

    /// Returns the PC's files: those of the folder that is named here, of the machine file's folder, or of the default
    /// one.
    pub(crate) fn files(&self, machine: &MachineFile) -> Box<dyn HostFiles> {
        let folder = self.files.as_deref().or(machine.pc.disk_root.as_deref().map(Path::new));
        let folder = folder.unwrap_or(Path::new("cc67-files"));
        let files = Directory::new(folder).with_names(machine.pc.disk_files.clone());
        if self.keeps_files { Box::new(Overlay::new(files)) } else { Box::new(files) }
    }
}

/// Reads a machine file for a board.
///
/// # Errors
/// It cannot be read, or something in it is wrong: its place comes first.
pub(crate) fn read_machine_file(path: &Path, board: &'static TargetBoard) -> Result<MachineFile> {
    let Ok(text) = String::from_utf8(read(path)?) else { anyhow::bail!("{} is not text", path.display()) };
    let mut machine = MachineFile::parse_for(board, &text)
        .map_err(|error| anyhow::anyhow!("{}:{}:{}: {error}", path.display(), error.line, error.column))?;
    machine.set_name(path);
    machine.resolve_paths(path.parent().unwrap_or(Path::new("")));
    Ok(machine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_firmware_file_is_boot_file() {
        for (words, expect) in [
            ("run --as firmware a.out b.c", "run --boot a.out b.c"),
            ("run --as=firmware a.out", "run --boot a.out"),
            ("run --as board firmware", "run --as board firmware"),
            ("run b.c --as firmware", "run b.c --as=firmware"),
        ] {
            let words = canonical_words(words.split(' ').map(OsString::from));
            assert_eq!(words.join(std::ffi::OsStr::new(" ")), expect);
        }
    }
}
