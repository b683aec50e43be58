//! Devices on the board's lines: pins, Konnect outputs, the UART.
//!
//! They respond to an edge immediately. A device that is attached gets every bit that is high, so that it can assume
//! that all others are low. Without devices, a tick costs nothing. The devices are defined in `world`.

use std::fmt::Debug;

use kmotiondef::{Bit, Cycles};

use super::Loads;
use crate::io::konnect::KonnectBoard;
use chips::changes::BitChange;
use chips::fpga::Fpga;
use chips::kanalog::Kanalog;
use chips::pins::Pins;
use chips::uart::Uart;

/// The parts of the board that a device can reach.
#[derive(Debug)]
pub(crate) struct DeviceContext<'a> {
    pub(crate) pins: &'a mut Pins,
    pub(crate) kanalog: &'a mut Kanalog,
    pub(crate) uart: &'a mut Uart,
    pub(crate) fpga: &'a Fpga,
    pub(crate) loads: &'a mut Loads,
}

/// Another device in the same state.
pub(crate) trait CloneDevice {
    /// The copy.
    fn clone_device(&self) -> Box<dyn AttachedDevice>;
}

impl<T: AttachedDevice + Clone + 'static> CloneDevice for T {
    fn clone_device(&self) -> Box<dyn AttachedDevice> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn AttachedDevice> {
    fn clone(&self) -> Self {
        // Of the device, not of the box.
        (**self).clone_device()
    }
}

/// A device around the board.
pub(crate) trait AttachedDevice: Debug + Send + CloneDevice {
    /// A bit has changed.
    fn edge(&mut self, change: BitChange, outside: &mut DeviceContext<'_>) {
        let _ = (change, outside);
    }

    /// The outputs of a Konnect board have changed.
    fn konnect(&mut self, board: KonnectBoard, outputs: u16, at: Cycles) {
        let _ = (board, outputs, at);
    }

    /// The UART has sent a character.
    fn sent(&mut self, byte: u8, at: Cycles, outside: &mut DeviceContext<'_>) {
        let _ = (byte, at, outside);
    }

    /// A tick begins.
    fn tick(&mut self, now: Cycles, outside: &mut DeviceContext<'_>) {
        let _ = (now, outside);
    }

    /// The input that it drives, if there is one.
    fn drives(&self) -> Option<Bit> {
        None
    }

    /// Returns whether it needs every edge of a bit; otherwise one level per tick is enough.
    fn watches(&self, bit: Bit) -> bool {
        let _ = bit;
        false
    }

    /// Returns whether the next tick would repeat the last one.
    fn is_settled(&self) -> bool {
        true
    }
}
