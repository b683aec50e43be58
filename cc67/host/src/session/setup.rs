//! Creation of a session from a setup: on the model, or on a firmware file.

use compiler::Options;
use runtime::Board;
use runtime::debug::DebugInfo;
use runtime::stimulus::{Stimulus, StimulusError};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;

use super::{Session, expression};
use crate::setup::Setup;
use crate::target::{AnyTarget, BootedFirmware, BootedTarget};
use crate::{HostError, UserProgram};

impl Setup {
    /// Creates the board at power-up with its programs loaded and started, on the interpreter.
    ///
    /// # Errors
    /// A program is refused, or an address is outside the board's memory.
    pub fn session(self) -> Result<Session, HostError> {
        self.session_on(BytecodeEngine::default())
    }

    /// Creates the session on an engine chosen by the caller; the events are the same on all engines.
    ///
    /// # Errors
    /// A program is refused, or an address is outside the board's memory.
    pub fn session_on<E: Engine>(mut self, engine: E) -> Result<Session<Board<E>>, HostError> {
        self.resolve_stimuli()?;
        let Self {
            mut config,
            options,
            programs,
            offered,
            values,
            stimulus,
            is_assisted,
            uart_input,
            hears_uart,
        } = self;
        // The options of the compiler determine for which threads time is counted.
        config.timing = options.timing;
        let mut board = Board::with_engine(config, engine);
        for program in &programs {
            board
                .load_detailed(program.thread, &program.image, program.details.clone())
                .map_err(|error| program.refused(error))?;
        }
        let offered = offered.into_iter().map(|program| offer(&mut board, program));
        let offered = offered.collect::<Result<_, _>>()?;
        for (address, bytes) in &values {
            let place = board.memory().place_of(*address);
            let stored = board.memory_mut().poke_bytes(place, bytes);
            stored.map_err(|_| HostError::Unmapped(*address))?;
        }
        if !stimulus.is_empty() {
            board.play(stimulus);
        }
        for program in programs.iter().filter(|program| program.starts) {
            board.start(program.thread).map_err(|_| HostError::NotLoaded(program.thread))?;
        }
        if is_assisted {
            board.play_operator();
        }
        if !uart_input.is_empty() {
            board.send_to_uart(&uart_input);
        }
        if hears_uart {
            board.hear_uart();
        }
        Ok(Session::new(board, options, programs, offered))
    }

    /// Creates a session on a firmware file with the programs loaded and started; they are compiled [for
    /// it](BootedFirmware::options).
    ///
    /// # Errors
    /// A program is rejected, the flash belongs to another firmware, or this firmware cannot be connected to hardware.
    pub fn session_on_firmware(
        mut self,
        firmware: &BootedFirmware,
    ) -> Result<Session<BootedTarget>, HostError> {
        self.resolve_stimuli()?;
        let (options, programs, offered) =
            (self.options.clone(), self.programs.clone(), self.offered.clone());
        let target = BootedTarget::begin(firmware, self)?;
        Ok(Session::on_target(target, options, programs, offered))
    }

    /// Creates a session on the modelled board, or on a firmware file if one is given.
    ///
    /// # Errors
    /// As [`session`](Self::session) and [`session_on_firmware`](Self::session_on_firmware).
    pub fn session_on_any(self, firmware: Option<&BootedFirmware>) -> Result<Session<AnyTarget>, HostError> {
        Ok(match firmware {
            None => self.session()?.map_target(|board| AnyTarget::Model(Box::new(board))),
            Some(firmware) => {
                self.session_on_firmware(firmware)?.map_target(|target| AnyTarget::Booted(Box::new(target)))
            }
        })
    }

    /// Compiles the expressions of the stimuli.
    fn resolve_stimuli(&mut self) -> Result<(), StimulusError> {
        let known = [&self.programs[..], &self.offered].concat();
        for stimulus in [&mut self.config.machine_file.stimulus, &mut self.stimulus] {
            resolve(stimulus, &known, &self.options)?;
        }
        Ok(())
    }
}

/// Compiles the expressions of a stimulus, with the names in the programs and in those that it may load.
///
/// # Errors
/// The first expression that is not valid.
pub fn resolve(
    stimulus: &mut Stimulus,
    programs: &[UserProgram],
    options: &Options,
) -> Result<(), StimulusError> {
    let axes = options.firmware.board().axes;
    stimulus.resolve(axes, |text| expression::for_stimulus(text, programs, options))
}

/// Keeps a program that a stimulus may load, with its debug information.
fn offer<E: Engine>(
    board: &mut Board<E>,
    program: UserProgram,
) -> Result<(UserProgram, DebugInfo), HostError> {
    let debug = board.offer(program.thread, &program.name(), program.image.clone(), program.details.clone());
    let debug = debug.map_err(|error| program.refused(error))?;
    Ok((program, debug))
}
