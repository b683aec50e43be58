//! The setup of a session.

use compiler::Options;
use kmotiondef::GuestAddr;
use runtime::Config;
use runtime::stimulus::Stimulus;

use crate::UserProgram;

/// A board, its programs and the world around it, before time begins.
#[derive(Debug, Default)]
pub struct Setup {
    /// The board and its PC: connected hardware, files, answers, flash.
    pub config: Config,
    /// The options for compiling expressions, and programs that are loaded later.
    pub options: Options,
    /// Programs that are loaded at power-up, and started if they are marked as [started](UserProgram::started).
    pub programs: Vec<UserProgram>,
    /// Programs that the stimulus may load during the run.
    pub offered: Vec<UserProgram>,
    /// Bytes that are stored before the programs start, each with its address.
    pub values: Vec<(GuestAddr, Vec<u8>)>,
    /// The stimulus.
    pub stimulus: Stimulus,
    /// True if a simulated operator moves inputs for which programs wait.
    pub is_assisted: bool,
    /// The bytes on the line to the serial port; they arrive from the time at which a program first polls for them.
    pub uart_input: Vec<u8>,
    /// True if every character sent by the serial port is reported as an event.
    pub hears_uart: bool,
}
