//! What stands around the board: the PC, signals on its pins and lines, and who records them.

use kmotiondef::{AxisId, Bit};
use vm::engine::Engine;

use super::Board;
use crate::servo::independent;
use crate::world::stimulus::Stimulus;
use crate::world::trace;

impl<E: Engine> Board<E> {
    /// Bytes from the PC arrive on the USB link: command lines, ended by CR. A line that begins with 0x1B and a byte
    /// that is thrown away is not echoed; 0x03 drops what is under way.
    pub fn receive(&mut self, bytes: &[u8]) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.usb.receive(bytes);
        kernel.disturb();
    }

    /// Whether bytes from the PC wait to be taken.
    #[must_use]
    pub fn is_receiving(&self) -> bool {
        self.machine.firmware().usb.is_busy()
    }

    /// Says whether the PC takes console lines. If not, they wait in the board's queue, and once that is full, so do
    /// the programs that print.
    pub fn listen(&mut self, listens: bool) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.is_heard = listens;
    }

    /// Whether a command waits for its data lines, so that the next line is one.
    #[must_use]
    pub fn is_in_command(&self) -> bool {
        self.machine.firmware().usb.is_in_command()
    }

    /// Lets the world around the board act as a stimulus says, from now on.
    pub fn play(&mut self, stimulus: Stimulus) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.play(stimulus, context.memory);
    }

    /// Plays an operator for programs that wait on inputs nobody drives.
    pub fn assist(&mut self) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.assist(context.now);
    }

    /// Records from now on what is asked for; the records come as events.
    pub fn record(&mut self, request: trace::Request) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.record(request, context.memory);
    }

    /// Drives an input from outside.
    pub fn drive_input(&mut self, bit: Bit, level: bool) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.pins.drive(bit, level, context.now);
        kernel.settle(context.now);
        kernel.disturb();
    }

    /// Puts characters on the UART's line; they arrive one after the other at its rate.
    pub fn send_to_uart(&mut self, bytes: &[u8]) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.uart.arrive(bytes, context.now);
        kernel.disturb();
    }

    /// Characters on the UART's line that have not arrived yet.
    #[must_use]
    pub fn uart_backlog(&self) -> usize {
        self.machine.firmware().uart.backlog()
    }

    /// Tells every character that the UART sends from now on, as an event.
    pub fn hear_uart(&mut self) {
        self.machine.firmware_mut().0.hear_uart();
    }

    /// The present value of something that can be recorded.
    #[must_use]
    pub fn value(&self, item: trace::Item) -> f64 {
        item.read(self.machine.firmware(), self.memory())
    }

    /// The axes that execute a motion of their own, such as a jog that nobody ends.
    #[must_use]
    pub fn moving(&self) -> Vec<AxisId> {
        AxisId::all().filter(|&axis| independent::is_moving(self.memory(), axis)).collect()
    }

    /// The level of a bit.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> bool {
        crate::firmware::io::bit_state(self.machine.firmware(), self.memory(), bit).0
    }
}
