//! A second party, besides the owner of a session, that can stop its time.

use std::fmt::Debug;
use std::ops::ControlFlow;

use crate::target::Target;
use kmotiondef::Ticks;
use runtime::Event;

use super::Session;

/// The work done while an attendant holds the board; returns whether the attendant may continue to hold it.
pub type IdleWork<'a, T> = &'a mut dyn FnMut(&mut Session<T>) -> ControlFlow<()>;

/// A party through which the owner of a session lets time pass, and which can stop time: a debugger attached by an
/// editor.
pub trait Attendant<T: Target>: Debug {
    /// Executes pending requests, and runs to the end of tick `limit`, even when everything has ended. While it holds
    /// the board it calls `idle` about a hundred times per second; it returns when the board may continue.
    fn advance(
        &mut self,
        session: &mut Session<T>,
        limit: Ticks,
        events: &mut dyn FnMut(Event),
        idle: IdleWork<'_, T>,
    );
}
