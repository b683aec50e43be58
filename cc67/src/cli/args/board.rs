//! The options of a board: its connections, its initial state, its engine.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use clap::{Args, ValueEnum};
use compiler::words::suggest;
use runtime::{Directory, HostFiles, MachineFile, Overlay, REMARKS};
use vm::engine::Preemption;

use super::engine::EngineName;
use super::pc::PcArguments;
use super::uart::UartArguments;
use crate::cli::io::input::read;

/// How close to the board a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum RunForm {
    /// Threads are switched between statements only
    #[default]
    Fast,
    /// Threads are switched between any two accesses to memory, as on the board: updates can be lost
    Board,
}

impl RunForm {
    /// Where threads lose the processor.
    pub(crate) const fn preemption(self) -> Preemption {
        match self {
            Self::Fast => Preemption::Segments,
            Self::Board => Preemption::Instructions,
        }
    }
}

/// The options of a board, of every command that has one.
#[derive(Debug, Args)]
pub(crate) struct BoardArguments {
    /// Load a program without starting it, so that another program can start it
    #[arg(long, value_name = "N:FILE")]
    pub(crate) load: Vec<OsString>,
    /// Set a start value, `persist.N=VALUE` (an integer, 0x…, a float f:1.5 or a double d:1.5), or a key of the machine
    /// file
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Machine file (TOML): what is connected to the board, such as motors, switches, probes, encoders
    #[arg(long, value_name = "FILE")]
    pub(crate) machine: Option<PathBuf>,
    /// Folder for the files that programs open on the PC [default: that of the machine file, or cc67-files]
    #[arg(long, value_name = "DIR")]
    files: Option<PathBuf>,
    /// Stimulus: what happens around the board, and when; a file, or statements such as "t=0.5 bit 136=1"
    #[arg(long, alias = "stimulus", value_name = "FILE|TEXT")]
    pub(crate) stim: Vec<String>,
    /// Switch a remark off (`-R no-CODE`) or on again (`-R CODE`); `--explain remarks` lists the codes
    #[arg(short = 'R', value_name = "no-CODE")]
    remarks: Vec<String>,
    /// Act as an operator: when all programs wait for inputs, toggle those inputs one at a time
    #[arg(long)]
    pub(crate) assist: bool,
    /// Simulate every tick and every wait in full; slower, with the same results
    #[arg(long)]
    pub(crate) no_shortcuts: bool,
    /// Behave like the board on accesses to ROM, control registers and misaligned addresses, and on integer division by
    /// zero; without this they stop the thread
    #[arg(long)]
    pub(crate) board_faults: bool,
    /// The engine that executes the programs
    #[arg(long, value_enum, default_value_t)]
    pub(crate) engine: EngineName,
    /// How close the run is to the board: `fast` never switches threads inside a statement, `board` does, between any
    /// two accesses to memory
    #[arg(long = "as", value_name = "FORM", value_enum, default_value_t, overrides_with = "form")]
    pub(crate) form: RunForm,
    /// Watch what threads do to memory that they share, and report what goes wrong on the board: lost updates, cells taken
    /// twice, values read half old, locks in opposite orders; programs are interpreted
    #[arg(long)]
    pub(crate) races: bool,
    /// Execute your own firmware file in place of the modelled firmware
    #[arg(long, value_name = "FILE")]
    pub(crate) boot: Option<PathBuf>,
    /// Whether what programs write to files is only seen by them.
    #[arg(skip)]
    pub(crate) keeps_files: bool,
    #[command(flatten)]
    pub(crate) uart: UartArguments,
    #[command(flatten)]
    pub(crate) pc: PcArguments,
}

impl BoardArguments {
    /// Refuses an option that a firmware file does not know.
    pub(crate) fn refuse_with_boot(&self) -> Result<()> {
        ensure!(self.engine == EngineName::default(), "`--engine` does not work with `--boot`");
        ensure!(self.form == RunForm::default(), "`--as` does not work with `--boot`");
        ensure!(!self.races, "`--races` does not work with `--boot`");
        Ok(())
    }

    /// What is connected to the board, and which of its remarks are shown.
    pub(crate) fn machine_file(&self) -> Result<MachineFile> {
        let mut machine = self.described()?;
        for switch in &self.remarks {
            let (code, is_wanted) =
                switch.strip_prefix("no-").map_or((&**switch, true), |code| (code, false));
            // Codes of remarks may begin with this, too.
            let known = machine.want_remark(switch, true).or_else(|| machine.want_remark(code, is_wanted));
            if known.is_none() {
                let near = suggest(code, REMARKS.iter().map(|row| row.code));
                let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                anyhow::bail!(
                    "`-R {switch}`: no such remark: `{code}`{near} (`--explain remarks` lists all)"
                );
            }
        }
        Ok(machine)
    }

    /// What the machine file describes.
    fn described(&self) -> Result<MachineFile> {
        let Some(path) = self.machine.as_deref() else { return Ok(MachineFile::default()) };
        let bytes = read(path)?;
        let Ok(text) = String::from_utf8(bytes) else { anyhow::bail!("{} is not text", path.display()) };
        let mut machine = MachineFile::parse(&text).map_err(|error| {
            anyhow::anyhow!("{}:{}:{}: {error}", path.display(), error.line, error.column)
        })?;
        machine.beside(path.parent().unwrap_or(Path::new("")));
        Ok(machine)
    }

    /// Where the PC's files are: in the folder that is named here, in that of the machine file, or in the usual one.
    pub(crate) fn files(&self, machine: &MachineFile) -> Box<dyn HostFiles> {
        let folder = self.files.as_deref().or(machine.pc.disk_root.as_deref().map(Path::new));
        let folder = folder.unwrap_or(Path::new("cc67-files"));
        let files = Directory::new(folder).with_names(machine.pc.disk_files.clone());
        if self.keeps_files { Box::new(Overlay::new(files)) } else { Box::new(files) }
    }
}
