//! Konnect boards on the auxiliary ports: the list of boards served, one of them in each tick.
//!
//! Every board is taken to be there and nothing drives its 32 inputs, so they read 0; its outputs have no reader.
//! Source: devices.md section 4.

use std::ops::Range;

use kmotiondef::{GuestAddr, Ticks};
use vm::memory::GuestMemory;

/// Boards that are served at most: 8 addresses on each of 2 ports.
const LIMIT: usize = 16;

/// The words of a served board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Service {
    pub(crate) outputs: GuestAddr,
    pub(crate) inputs: GuestAddr,
}

/// The boards served.
#[derive(Clone, Debug, Default)]
pub(crate) struct Konnects(Vec<Service>);

impl Konnects {
    /// Empties the list.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds a board; `false` when the list is full.
    pub(crate) fn add(&mut self, service: Service) -> bool {
        let has_room = self.0.len() < LIMIT;
        if has_room {
            self.0.push(service);
        }
        has_room
    }

    /// Ends the services whose words lie in a space that is loaded anew; whether there were any.
    pub(crate) fn drop_within(&mut self, space: &Range<u32>) -> bool {
        let before = self.0.len();
        self.0.retain(|service| {
            !space.contains(&service.outputs.get()) && !space.contains(&service.inputs.get())
        });
        self.0.len() < before
    }

    /// Exchanges the words of the board whose turn it is.
    pub(crate) fn tick(&self, memory: &mut GuestMemory, tick: Ticks) {
        let count = self.0.len().max(1) as u64;
        if let Some(service) = self.0.get((tick.get() % count) as usize) {
            memory.poke(service.inputs, 0_i32);
        }
    }

    /// Whether no exchange changes anything.
    pub(crate) fn is_settled(&self, memory: &GuestMemory) -> bool {
        self.0.iter().all(|service| memory.peek::<i32>(service.inputs) == 0)
    }
}
