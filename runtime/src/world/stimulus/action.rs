//! What a statement does.

use std::sync::Arc;

use kmotiondef::{AxisId, Bit, Cycles, ThreadId};

use super::Wave;
use crate::io::konnect::Board;
use crate::io::snapamp::{Quantity, Side};
use crate::world::attached::DeviceSpec;

/// What the world does to the board.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Gives an input a level, or a virtual bit its state.
    Set(Bit, bool),
    /// Inverts the level.
    Toggle(Bit),
    /// Inverts the level for a time.
    Pulse(Bit, Cycles),
    /// Lets an analog input take a course.
    Adc(usize, Wave),
    /// Moves the load of an axis, in its units.
    Push(AxisId, f64),
    /// Turns the encoder of an axis by counts, over a time.
    Turn(AxisId, f64, Cycles),
    /// Both phases of an encoder input change at once, which its error bit keeps.
    EncoderError(usize),
    /// Sends characters to the UART, at its rate.
    Uart(Vec<u8>),
    /// Stores an element of `persist.UserData`.
    Persist(usize, i32),
    /// Executes the program of a thread, as the PC does.
    Start(ThreadId),
    /// Loads a program of this name into a thread and executes it, as the PC does.
    Run(ThreadId, Arc<str>),
    /// What the PC answers next, as `key=value`.
    Answer(String),
    /// Sends a script command, as the PC does.
    Command(String),
    /// Stops a thread, as the PC does.
    Kill(ThreadId),
    /// Connects a device.
    Attach(DeviceSpec),
    /// Gives an input of a Konnect board a level.
    Konnect(Board, u8, bool),
    /// Changes what a side of a SnapAmp measures.
    SnapAmp(usize, Side, Quantity, f64),
    /// Fails the run if something is not as it should be.
    Expect(Expectation),
}

/// What should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// The level of a bit.
    Bit(Bit, bool),
    /// A console line so far contains the text, or none does.
    Printed(String, bool),
    /// An element of `persist.UserData`.
    Persist(usize, i32),
    /// Whether a thread is active.
    Active(ThreadId, bool),
}
