//! A second party, beside the owner of a session, that may stop its time.

use std::fmt::Debug;
use std::ops::ControlFlow;

use crate::target::Target;
use kmotiondef::Ticks;
use runtime::Event;

use super::Session;

/// The work that is done while an attendant holds the board; returns whether it may go on holding it.
pub type Idle<'a, T> = &'a mut dyn FnMut(&mut Session<T>) -> ControlFlow<()>;

/// Somebody through whom the owner of a session lets time pass, and who may stop it: a debugger that an editor attaches.
pub trait Attendant<T: Target>: Debug {
    /// Does what is asked of it, and runs to the end of tick `limit`, also when everything has ended. While it stops the
    /// board it calls `idle` about a hundred times in a second; it comes back when the board may continue.
    fn advance(
        &mut self,
        session: &mut Session<T>,
        limit: Ticks,
        events: &mut dyn FnMut(Event),
        idle: Idle<'_, T>,
    );
}
