//! The board's serial port: `--uart` and related options.

use std::path::PathBuf;

use clap::Args;
use runtime::MachineFile;

use super::heading;

/// The connection of the serial port.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = heading::PC)]
pub(crate) struct UartArguments {
    /// Let the serial port receive the characters of FILE, once the program first reads the port
    #[arg(long, value_name = "FILE", conflicts_with = "uart")]
    pub(crate) uart_input: Option<PathBuf>,
    /// Write the serial port's output to FILE
    #[arg(long, value_name = "FILE")]
    pub(crate) uart_output: Option<PathBuf>,
    /// Connect the serial port in real time: pty, tcp:PORT (waits for a client on this computer), run:COMMAND
    #[arg(long, value_name = "PEER")]
    pub(crate) uart: Option<String>,
}

impl UartArguments {
    /// Returns these options; if they are absent, the files named in the machine file.
    pub(crate) fn or_those_of(&self, machine: &MachineFile) -> Self {
        let file = |name: &Option<String>| name.as_ref().map(PathBuf::from);
        let input = file(&machine.uart.input).filter(|_| self.uart.is_none());
        Self {
            uart_input: self.uart_input.clone().or(input),
            uart_output: self.uart_output.clone().or_else(|| file(&machine.uart.output)),
            uart: self.uart.clone(),
        }
    }
}
