//! The known memory of the controller: the values in the status record, and the elements of `persist.UserData` that
//! were read.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;

use cc67_wire::Status;
use kmotiondef::boards::TargetBoard;
use kmotiondef::limits::{N_PC_COMM_PERSIST, N_USER_DATA_VARS, PC_COMM_PERSIST};
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{
    ADC_BUFFER_IN, BIT_DIR_SHADOW, CS0_STOPPING_STATE, DAC_BUFFER, PERSIST, VIRTUAL_BITS, chan,
};
use kmotiondef::{Axes, GuestAddr};
use vm::memory::places::Places;

/// The number of elements of `persist.UserData` that are read with each status record while a view needs them: all
/// within a second.
const ELEMENTS_AT_ONCE: usize = 10;
/// The converters' value at 0 V.
const ZERO: i32 = 2048;

/// Known bytes by their addresses.
#[derive(Debug)]
pub(crate) struct SeenMemory {
    bytes: BTreeMap<u32, u8>,
    /// True if memory was read since the last [call](Self::take_look).
    is_looked_at: Cell<bool>,
    /// The next element of `persist.UserData` to be read for views.
    next_element: usize,
    /// The addresses of the tables' variables in the board's firmware.
    places: Places,
    axes: Axes,
}

impl SeenMemory {
    /// Creates an empty memory; the variables of an unknown firmware are assumed at the addresses of the default one.
    pub(crate) fn new(board: Option<&TargetBoard>) -> Self {
        let axes = board.map_or(Axes::default(), |board| board.axes);
        let board = board.filter(|board| !board.is_default());
        let moved = board.map(TargetBoard::moved_objects).unwrap_or_default();
        let places = Places::new(moved.into_iter().map(|object| (object.table, object.size, object.place)));
        Self { bytes: BTreeMap::new(), is_looked_at: Cell::new(false), next_element: 0, places, axes }
    }

    /// Returns the board's address for an address in the tables.
    pub(crate) fn place_of(&self, address: GuestAddr) -> GuestAddr {
        self.places.of(address)
    }

    /// The axes of the board.
    pub(crate) const fn axes(&self) -> Axes {
        self.axes
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.bytes.clear();
    }

    /// Notes the bytes at an address of the board.
    pub(crate) fn note(&mut self, address: GuestAddr, bytes: &[u8]) {
        self.bytes.extend((address.get()..).zip(bytes.iter().copied()));
    }

    /// Notes the bytes of an object of the tables.
    fn note_object(&mut self, object: GuestAddr, bytes: &[u8]) {
        self.note(self.place_of(object), bytes);
    }

    /// Reads bytes at an address of the board; `None` if one is unknown.
    pub(crate) fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()> {
        for (at, byte) in (address.get()..).zip(bytes) {
            *byte = *self.bytes.get(&at)?;
        }
        Some(())
    }

    /// Reads bytes as [`read`](Self::read) does, for a view that will read again.
    pub(crate) fn look(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()> {
        self.is_looked_at.set(true);
        self.read(address, bytes)
    }

    /// Returns whether memory was read since the last call.
    pub(crate) fn take_look(&self) -> bool {
        self.is_looked_at.take()
    }

    /// Returns the range of the next elements of `persist.UserData` to be read.
    pub(crate) fn next_elements(&mut self) -> Range<usize> {
        let first = self.next_element;
        let end = (first + ELEMENTS_AT_ONCE).min(N_USER_DATA_VARS);
        self.next_element = end % N_USER_DATA_VARS;
        first..end
    }

    /// Notes the objects in a status record.
    pub(crate) fn note_status(&mut self, status: &Status) {
        for axis in self.axes.iter() {
            let chan = chan(axis);
            self.note_object(chan.field(Chan::DEST).address(), &status.dest(axis).to_le_bytes());
            self.note_object(chan.field(Chan::POSITION).address(), &status.position(axis).to_le_bytes());
            let ints = [
                (Chan::ENABLE, i32::from(status.is_enabled(axis))),
                (Chan::INPUT_MODE, status.input_mode(axis).into()),
                (Chan::OUTPUT_MODE, status.output_mode(axis).into()),
            ];
            for (field, value) in ints {
                self.note_object(chan.field(field).address(), &value.to_le_bytes());
            }
        }
        // A Kogna has adjacent inputs of two bytes.
        let [first, second] = [0, 1].map(|index| self.place_of(ADC_BUFFER_IN.element(index).address()).get());
        let input_size = second.wrapping_sub(first).min(4) as usize;
        for index in 0..8 {
            let input = status.adc(index) + ZERO;
            let address = ADC_BUFFER_IN.element(index).address();
            self.note_object(address, &input.to_le_bytes()[..input_size]);
            let output = (status.dac(index) + ZERO) as u16;
            self.note_object(DAC_BUFFER.element(index).address(), &output.to_le_bytes());
        }
        for (index, word) in status.directions().into_iter().enumerate() {
            self.note_object(BIT_DIR_SHADOW.element(index).address(), &word.to_le_bytes());
        }
        for index in 0..N_PC_COMM_PERSIST {
            let element = PERSIST.field(Persist::USER_DATA).element(PC_COMM_PERSIST + index);
            self.note_object(element.address(), &status.request(index).to_le_bytes());
        }
        let start_up = PERSIST.field(Persist::RUN_ON_START_UP).address();
        self.note_object(start_up, &status.run_on_start_up().to_le_bytes());
        self.note_object(CS0_STOPPING_STATE.address(), &status.stop_state().to_le_bytes());
        self.note_object(VIRTUAL_BITS.address(), &status.virtual_bits().to_le_bytes());
    }
}
