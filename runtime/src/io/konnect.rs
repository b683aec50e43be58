//! Konnect boards on the auxiliary ports: the list of boards served, one of them in each tick.
//!
//! In its tick, a board takes the low 16 bits of its output word and returns its 32 inputs, which are 0 unless the
//! world drives them. A board is assumed at every address unless a machine file lists the addresses. Source: devices.md
//! section 4.

use std::collections::BTreeMap;
use std::ops::Range;

use kmotiondef::{GuestAddr, Ticks};
use vm::memory::GuestMemory;

/// The limit of boards that are served: 8 addresses on each of 2 ports.
const LIMIT: usize = 16;

/// An auxiliary port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Port {
    /// JP4.
    Aux0,
    /// JP6.
    Aux1,
}

/// A board: its port and the address set on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct KonnectBoard {
    /// The port.
    pub port: Port,
    /// The address, 0 to 7.
    pub address: u8,
}

/// The words of a served board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Service {
    pub(crate) board: KonnectBoard,
    pub(crate) outputs: GuestAddr,
    pub(crate) inputs: GuestAddr,
}

/// The boards that are served, and the levels of their terminals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Konnects {
    services: Vec<Service>,
    outputs: BTreeMap<KonnectBoard, u16>,
    inputs: BTreeMap<KonnectBoard, u32>,
    /// Addresses that are not there, a bit for each; on JP4 and on JP6.
    absent: [u8; 2],
}

impl Konnects {
    /// Says which addresses of a port are there, a bit for each.
    pub(crate) fn set_present(&mut self, port: Port, present: u8) {
        self.absent[port as usize] = !present;
    }

    /// Returns whether a board is present.
    pub(crate) fn is_present(&self, board: KonnectBoard) -> bool {
        self.absent[board.port as usize] >> board.address & 1 == 0
    }

    /// The word that a board has taken.
    pub(crate) fn outputs(&self, board: KonnectBoard) -> u16 {
        self.outputs.get(&board).copied().unwrap_or(0)
    }

    /// The word that a board gives.
    fn input_word(&self, board: KonnectBoard) -> u32 {
        if self.is_present(board) { self.inputs.get(&board).copied().unwrap_or(0) } else { 0 }
    }

    /// The level of an input of a board.
    pub(crate) fn input(&self, board: KonnectBoard, input: u8) -> bool {
        self.input_word(board) >> input & 1 != 0
    }

    /// Empties the list.
    pub(crate) fn clear(&mut self) {
        self.services.clear();
    }

    /// Adds a board; `false` when the list is full.
    pub(crate) fn add(&mut self, service: Service) -> bool {
        let has_room = self.services.len() < LIMIT;
        if has_room {
            self.services.push(service);
        }
        has_room
    }

    /// Gives an input of a board, 0 to 31, a level.
    pub(crate) fn drive(&mut self, board: KonnectBoard, input: u8, level: bool) {
        let word = self.inputs.entry(board).or_default();
        *word = *word & !(1 << input) | u32::from(level) << input;
    }

    /// Stops serving boards whose words are in a space that is loaded again; returns whether there were any.
    pub(crate) fn drop_within(&mut self, space: &Range<u32>) -> bool {
        let before = self.services.len();
        self.services.retain(|service| {
            !space.contains(&service.outputs.get()) && !space.contains(&service.inputs.get())
        });
        self.services.len() < before
    }

    /// Exchanges the words of the board that is due; returns the board if its outputs have changed.
    pub(crate) fn tick(&mut self, memory: &mut GuestMemory, tick: Ticks) -> Option<(KonnectBoard, u16)> {
        let count = self.services.len() as u64;
        let turn = tick.get().checked_rem(count)?;
        let service = *self.services.get(turn as usize)?;
        memory.poke(service.inputs, self.input_word(service.board));
        if !self.is_present(service.board) {
            return None;
        }
        let outputs = output_bits(memory, &service);
        (self.outputs.insert(service.board, outputs) != Some(outputs)).then_some((service.board, outputs))
    }

    /// Returns whether data is exchanged with any board.
    pub(crate) const fn has_any(&self) -> bool {
        !self.services.is_empty()
    }

    /// Returns whether no exchange changes anything.
    pub(crate) fn is_settled(&self, memory: &GuestMemory) -> bool {
        self.services.iter().all(|service| {
            memory.peek::<u32>(service.inputs) == self.input_word(service.board)
                && (!self.is_present(service.board)
                    || self.outputs.get(&service.board) == Some(&output_bits(memory, service)))
        })
    }
}

/// Returns the bits that a board takes from its output word.
fn output_bits(memory: &GuestMemory, service: &Service) -> u16 {
    memory.peek::<u32>(service.outputs) as u16
}
