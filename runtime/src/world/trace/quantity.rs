//! Quantities that can be sampled: the items of the board, and values computed from its memory.

use std::fmt;
use std::sync::Arc;

use kmotiondef::modes::GatherType;
use kmotiondef::{Cycles, GuestAddr};
use vm::memory::GuestMemory;

use super::Item;
use crate::io::Io;
use crate::machine::Machine;

/// A value that is sampled.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// An item of the board.
    Item(Item),
    /// A value computed by a formula, and its name.
    Formula(String, Arc<dyn Formula>),
}

/// A computation of a value from the board's state.
pub trait Formula: fmt::Debug + Send + Sync {
    /// The value now.
    fn value(&self, view: &View<'_>) -> f64;

    /// The items from which it is computed.
    fn items(&self) -> &[Item];

    /// The variable that holds it, for a recorder on the board; `None` if it is computed.
    fn cell(&self) -> Option<RecordedCell> {
        None
    }
}

/// A variable as the board's data recorder reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedCell {
    /// Its address in the board's tables, or in a program.
    pub address: GuestAddr,
    /// Its type.
    pub kind: GatherType,
    /// The number that is added to the value that was recorded.
    pub offset: f64,
}

impl RecordedCell {
    /// A variable whose recorded value is its own value.
    #[must_use]
    pub const fn new(address: GuestAddr, kind: GatherType) -> Self {
        Self { address, kind, offset: 0.0 }
    }
}

/// The board for read-only access.
#[derive(Debug)]
pub struct View<'a> {
    pub(in crate::world) machine: &'a Machine,
    pub(in crate::world) io: &'a Io,
    /// When the present tick began.
    pub(super) tick_start: Cycles,
    /// Guest memory, as programs see it.
    pub memory: &'a GuestMemory,
}

impl<'a> View<'a> {
    /// The board in the tick that began at `tick_start`.
    pub(crate) const fn new(
        machine: &'a Machine,
        io: &'a Io,
        tick_start: Cycles,
        memory: &'a GuestMemory,
    ) -> Self {
        Self { machine, io, tick_start, memory }
    }

    /// When the present tick began.
    pub(in crate::world) const fn tick_start(&self) -> Cycles {
        self.tick_start
    }

    /// The value of an item.
    #[must_use]
    pub fn item(&self, item: Item) -> f64 {
        item.read(self)
    }
}

impl Quantity {
    /// The item, if the quantity is an item.
    #[must_use]
    pub const fn item(&self) -> Option<Item> {
        match self {
            Self::Item(item) => Some(*item),
            Self::Formula(..) => None,
        }
    }

    /// The items that it is, or from which it is computed.
    #[must_use]
    pub fn items(&self) -> &[Item] {
        match self {
            Self::Item(item) => item.items(),
            Self::Formula(_, formula) => formula.items(),
        }
    }

    /// The variable that holds it, for a recorder on the board; `None` if it is computed.
    #[must_use]
    pub fn cell(&self) -> Option<RecordedCell> {
        match self {
            Self::Item(item) => item.cell(),
            Self::Formula(_, formula) => formula.cell(),
        }
    }

    pub(crate) fn read(&self, view: &View<'_>) -> f64 {
        match self {
            Self::Item(item) => item.read(view),
            Self::Formula(_, formula) => formula.value(view),
        }
    }
}

impl From<Item> for Quantity {
    fn from(item: Item) -> Self {
        Self::Item(item)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Item(item) => item.fmt(formatter),
            Self::Formula(name, _) => formatter.write_str(name),
        }
    }
}
