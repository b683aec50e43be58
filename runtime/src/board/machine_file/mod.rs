//! The machine file: the equipment connected to the board, in TOML.
//!
//! Without a machine file there are eight ideal axes and nothing else; each key changes one aspect of that. Source:
//! plant.md section 9. Every error gives its line and column, and suggests the correct spelling of a misspelt key.

mod boards;
mod events;
mod pc;
mod read;
mod tables;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use kmotiondef::boards::TargetBoard;
use kmotiondef::{Axes, Bit};

pub use crate::machine::ConnectedEquipment;
pub use crate::machine::description::{
    Analog, AnalogSource, Axis, Channel, Condition, Connection, Encoder, Gantry, Handwheel, Index, KeyPlace,
    Model, Motor, Probe, Spindle, SpindleDrive, Spring, Switch, Travel, Wire,
};
use crate::out::{REMARKS, RemarkRow};
use crate::pc::Answers;
use crate::world::stimulus::Stimulus;

/// Nanoseconds of a cycle of the board's processor, in which the costs of instructions are counted.
pub(crate) const NS_PER_INSTRUCTION: f64 = 5.0;

/// A machine.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// The board that it is for.
    pub board: &'static TargetBoard,
    /// The name of the file in messages, if it has one.
    pub name: Option<Arc<str>>,
    /// The axes, including those that the board does not have.
    pub axes: [Axis; Axes::MAX],
    /// The equipment that is connected to the board, without the loads of the axes.
    pub connected: ConnectedEquipment,
    /// Connections of outputs with inputs.
    pub wires: Vec<Wire>,
    /// The events of the file, and the devices on pins.
    pub stimulus: Stimulus,
    /// Inputs that read 1 while they are not driven.
    pub idle_high: Vec<Bit>,
    /// True if a remark is made when a program reads an input that is not driven.
    pub hints: bool,
    /// Codes of remarks that are switched off.
    pub unwanted_remarks: BTreeSet<&'static str>,
    /// Option boards and flash.
    pub boards: Boards,
    /// The processor.
    pub cpu: Cpu,
    /// The PC.
    pub pc: Pc,
    /// The other end of the UART's line.
    pub uart: Uart,
}

impl Default for MachineFile {
    fn default() -> Self {
        Self {
            board: TargetBoard::default_board(),
            name: None,
            axes: std::array::from_fn(|_| Axis::default()),
            connected: ConnectedEquipment::default(),
            wires: Vec::new(),
            stimulus: Stimulus::default(),
            idle_high: Vec::new(),
            hints: true,
            unwanted_remarks: BTreeSet::new(),
            boards: Boards::default(),
            cpu: Cpu::default(),
            pc: Pc::default(),
            uart: Uart::default(),
        }
    }
}

/// Option boards that are there, and flash memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Boards {
    /// SnapAmp boards on the bus.
    pub snapamps: usize,
    /// True if a Kanalog is detected at power-up.
    pub has_kanalog: bool,
    /// The KStep on JP7, if there is one: true if its motors need the enable signal on bit 45.
    pub has_kstep: bool,
    /// See `has_kstep`.
    pub respect_enable: bool,
    /// Konnect boards that are there, a bit for each address: on JP4 and on JP6.
    pub konnects: [u8; 2],
    /// The file that keeps flash memory; `None` if it is kept for this run only.
    pub flash: Option<String>,
    /// True if reads of flash find the bank that `SetFlashBank` has selected, as the board's address lines do.
    pub strict_flash: bool,
}

impl Default for Boards {
    fn default() -> Self {
        Self {
            snapamps: 0,
            has_kanalog: false,
            has_kstep: false,
            respect_enable: false,
            konnects: [u8::MAX; 2],
            flash: None,
            strict_flash: false,
        }
    }
}

/// The behaviour of the processor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cpu {
    /// The duration of the servo interrupt in microseconds; the measured duration if absent.
    pub servo_us: Option<f64>,
    /// Nanoseconds of an instruction on average.
    pub ns_per_instruction: f64,
    /// Ticks that a motion call plans before its motion begins.
    pub plan_ticks: u32,
    /// True if a program that is started again finds its globals as they were loaded.
    pub fresh_globals: bool,
    /// Byte put into uninitialised data at a load.
    pub bss_fill: u8,
    /// True if stacks are as small as the board's.
    pub strict_stack: bool,
    /// True if ROM, control registers and misaligned addresses behave as on the board; otherwise accesses to them trap.
    pub board_faults: bool,
}

impl Default for Cpu {
    fn default() -> Self {
        Self {
            servo_us: None,
            ns_per_instruction: NS_PER_INSTRUCTION,
            plan_ticks: 0,
            fresh_globals: false,
            bss_fill: 0,
            strict_stack: false,
            board_faults: false,
        }
    }
}

/// The PC and its files.
#[derive(Clone, Debug, PartialEq)]
pub struct Pc {
    /// True if the built-in PC polls and answers.
    pub is_connected: bool,
    /// Its answers to programs.
    pub answers: Answers,
    /// The folder of its files; `None` for the usual one.
    pub disk_root: Option<String>,
    /// The time that a round trip to its files takes, in seconds.
    pub disk_latency_s: f64,
    /// Names that programs use for its files, and the files meant, relative to the folder.
    pub disk_files: Vec<(String, String)>,
}

impl Default for Pc {
    fn default() -> Self {
        Self {
            is_connected: true,
            answers: Answers::default(),
            disk_root: None,
            disk_latency_s: 0.02,
            disk_files: Vec::new(),
        }
    }
}

/// The other end of the UART's line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Uart {
    /// File with the characters that it receives.
    pub input: Option<String>,
    /// File for the characters that it sends.
    pub output: Option<String>,
}

impl MachineFile {
    /// Reads a machine file for the default board.
    ///
    /// # Errors
    /// The first error, with its location.
    pub fn parse(text: &str) -> Result<Self, MachineFileError> {
        Self::parse_for(TargetBoard::default_board(), text)
    }

    /// Reads a machine file for a board, which decides the axes and bits that it can name.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_for(board: &'static TargetBoard, text: &str) -> Result<Self, MachineFileError> {
        let mut machine = Self { board, ..Self::default() };
        tables::apply(&mut machine, text, false)?;
        Ok(machine)
    }

    /// Takes the name of its file, without the folder, for messages.
    pub fn set_name(&mut self, path: &Path) {
        self.name = path.file_name().map(|name| name.to_string_lossy().into());
    }

    /// Takes names of files that do not begin at a root as relative to `folder`, the one of the machine file.
    pub fn resolve_paths(&mut self, folder: &Path) {
        let names =
            [&mut self.pc.disk_root, &mut self.boards.flash, &mut self.uart.input, &mut self.uart.output];
        for name in names.into_iter().flatten() {
            *name = folder.join(&*name).to_string_lossy().into_owned();
        }
    }

    /// Shows or hides the remarks of a code; `None` if there is no such code.
    pub fn want_remark(&mut self, code: &str, is_wanted: bool) -> Option<()> {
        let RemarkRow { code, .. } = REMARKS.iter().find(|row| row.code == code)?;
        if is_wanted {
            self.unwanted_remarks.remove(code);
        } else {
            self.unwanted_remarks.insert(code);
        }
        Some(())
    }

    /// Changes one key, given as `axis.0.model=motor`: the path of the key, and a value with or without quotes.
    ///
    /// # Errors
    /// The error in the key or its value.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), MachineFileError> {
        let plain = format!("{key} = {value}");
        let is_toml = toml::de::DeTable::parse(&plain).is_ok();
        let text = if is_toml { plain } else { format!("{key} = {value:?}") };
        let mut changed = self.clone();
        tables::apply(&mut changed, &text, true)?;
        *self = changed;
        Ok(())
    }
}

/// An error in a machine file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct MachineFileError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The message.
    pub message: String,
}

#[cfg(test)]
mod tests;
