//! The setup of a session.

use compiler::Options;
use kmotiondef::GuestAddr;
use runtime::Config;
use runtime::stimulus::Stimulus;

use crate::UserProgram;

/// A board, its programs and the world around it, before time begins.
#[derive(Debug, Default)]
pub struct Setup {
    /// The board and its PC: what is connected, files, answers, flash.
    pub config: Config,
    /// The options with which expressions, and programs that are loaded later, are compiled.
    pub options: Options,
    /// Programs that are loaded at power-up, and started if they [should be](UserProgram::started).
    pub programs: Vec<UserProgram>,
    /// Programs that the stimulus may load while it is played.
    pub offered: Vec<UserProgram>,
    /// Bytes that are stored before the programs start, each from an address on.
    pub values: Vec<(GuestAddr, Vec<u8>)>,
    /// The stimulus.
    pub stimulus: Stimulus,
    /// True if an operator is simulated who moves inputs that programs wait for.
    pub is_assisted: bool,
    /// The bytes on the line to the serial port; they arrive from the moment a program first polls for them.
    pub uart_input: Vec<u8>,
    /// True if every character that the serial port sends is reported as an event.
    pub hears_uart: bool,
}
