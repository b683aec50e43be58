//! The parts of the board that an action reaches.

use kmotiondef::Bit;
use vm::firmware::TickContext;

use super::plans::Plans;
use crate::world::WorldAccess;

/// The board, the planned actions, and the statement that acts.
#[derive(Debug)]
pub(crate) struct Scene<'a, 'b, 'c> {
    pub(crate) plans: &'a mut Plans,
    pub(crate) access: &'a mut WorldAccess<'b>,
    pub(crate) context: &'a mut TickContext<'c>,
    /// The location of the statement, for messages.
    pub(crate) place: &'a str,
    /// The bits whose levels statements have changed.
    pub(crate) moved: &'a [Bit],
    /// True if its expectation should be checked.
    pub(crate) is_checked: bool,
}
