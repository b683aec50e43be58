//! What a session begins with.

use compiler::Options;
use kmotiondef::GuestAddr;
use runtime::debug::DebugInfo;
use runtime::stimulus::{Stimulus, StimulusError};
use runtime::{Board, Config};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;

use super::expression;
use super::journal::Journal;
use super::signals::Signals;
use super::{Interrupter, Recording, Session, UserProgram};
use crate::HostError;

/// A board, its programs and the world around it, before time begins.
#[derive(Debug, Default)]
pub struct Setup {
    /// The board and its PC: what is connected, files, answers, flash.
    pub config: Config,
    /// How expressions, and programs that are loaded later, are compiled.
    pub options: Options,
    /// Programs that are loaded at power-up, and started if they [should be](UserProgram::started).
    pub programs: Vec<UserProgram>,
    /// Programs that the stimulus may load while it is played.
    pub offered: Vec<UserProgram>,
    /// Bytes that are stored before the programs start, each from an address on.
    pub values: Vec<(GuestAddr, Vec<u8>)>,
    /// What the world does, and when.
    pub stimulus: Stimulus,
    /// Whether an operator is played who moves inputs that programs wait for.
    pub is_assisted: bool,
    /// What waits on the line to the serial port; it arrives from the moment a program first looks for it.
    pub uart_input: Vec<u8>,
    /// Whether every character that the serial port sends is reported as an event.
    pub hears_uart: bool,
}

impl Setup {
    /// The board at power-up with its programs loaded and started, on the interpreter.
    ///
    /// # Errors
    /// A program is refused, or an address is outside of the board's memory.
    pub fn session(self) -> Result<Session, HostError> {
        self.session_on(BytecodeEngine::default())
    }

    /// The same on an engine of the caller's choice; what happens is the same on all.
    ///
    /// # Errors
    /// A program is refused, or an address is outside of the board's memory.
    pub fn session_on<E: Engine>(self, engine: E) -> Result<Session<E>, HostError> {
        let Self {
            mut config,
            options,
            programs,
            offered,
            values,
            mut stimulus,
            is_assisted,
            uart_input,
            hears_uart,
        } = self;
        let known = [&programs[..], &offered].concat();
        for stimulus in [&mut config.machine_file.stimulus, &mut stimulus] {
            resolve(stimulus, &known, &options)?;
        }
        // What compiles the programs says for whom the time of all is counted.
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
            let stored = board.memory_mut().poke_bytes(*address, bytes);
            stored.map_err(|_| HostError::Unmapped(*address))?;
        }
        if !stimulus.is_empty() {
            board.play(stimulus);
        }
        for program in programs.iter().filter(|program| program.starts) {
            board.start(program.thread).map_err(|_| HostError::NotLoaded(program.thread))?;
        }
        if is_assisted {
            board.assist();
        }
        if !uart_input.is_empty() {
            board.send_to_uart(&uart_input);
        }
        if hears_uart {
            board.hear_uart();
        }
        Ok(Session {
            board,
            options,
            programs: programs.into(),
            offered,
            signals: Signals::default(),
            recording: Recording::default(),
            journal: Journal::default(),
            interrupter: Interrupter::default(),
        })
    }
}

/// Finds what computes the expressions of a stimulus, in the words of the programs and of those that it may load.
///
/// # Errors
/// The first expression that is none.
pub fn resolve(
    stimulus: &mut Stimulus,
    programs: &[UserProgram],
    options: &Options,
) -> Result<(), StimulusError> {
    stimulus.resolve(|text| expression::for_stimulus(text, programs, options))
}

/// Keeps a program that a stimulus may load; with what is known about it.
fn offer<E: Engine>(
    board: &mut Board<E>,
    program: UserProgram,
) -> Result<(UserProgram, DebugInfo), HostError> {
    let debug = board.offer(program.thread, &program.name(), program.image.clone(), program.details.clone());
    let debug = debug.map_err(|error| program.refused(error))?;
    Ok((program, debug))
}
