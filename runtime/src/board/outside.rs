//! The surroundings of the board: the PC, signals on its pins and lines, and recorders.

use kmotiondef::{AxisId, Bit};
use vm::engine::Engine;

use super::Board;
use crate::firmware::parts::Parts;
use crate::pc::OpenBox;
use crate::servo::independent;
use crate::world::stimulus::Stimulus;
use crate::world::trace;

impl<E: Engine> Board<E> {
    /// Bytes from the PC arrive on the USB link: command lines, ended by CR. A line that begins with 0x1B and a second
    /// byte, which is ignored, is not echoed; 0x03 drops the line or download in progress.
    pub fn receive(&mut self, bytes: &[u8]) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.parts.pc.usb.receive(bytes);
        kernel.parts.note_external_change();
    }

    /// Returns whether the board has not yet taken all bytes from the PC.
    #[must_use]
    pub fn is_receiving(&self) -> bool {
        self.machine.firmware().parts.pc.usb.is_busy()
    }

    /// The lines that programs have printed and that wait to be sent, oldest first.
    #[must_use]
    pub fn unsent_lines(&self) -> Vec<Vec<u8>> {
        self.machine.firmware().parts.out.console.unsent().map(<[u8]>::to_vec).collect()
    }

    /// Sets whether the PC takes console lines. If not, they wait in the board's queue, and once that is full, programs
    /// that print wait, too.
    pub fn listen(&mut self, listens: bool) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.parts.pc.is_heard = listens;
    }

    /// Keeps from now on the bytes that the board sends to the PC, for one that is elsewhere.
    pub fn tap_wire(&mut self) {
        self.machine.firmware_mut().0.parts.out.tap_wire();
    }

    /// The bytes that the board has sent to the PC since the last call, exactly as on the wire.
    #[must_use]
    pub fn take_wire(&mut self) -> Vec<u8> {
        self.machine.firmware_mut().0.parts.out.take_wire()
    }

    /// Returns whether a command waits for its data lines, so that the next line is one.
    #[must_use]
    pub fn is_in_command(&self) -> bool {
        self.machine.firmware().scripts.is_in_command()
    }

    /// The box that a program has opened on the PC and that waits for an answer, where boxes do (`boxes=wait`).
    #[must_use]
    pub fn open_box(&self) -> Option<OpenBox> {
        self.machine.firmware().parts.pc.host.open_box(self.machine.memory())
    }

    /// Plays a stimulus to the board from now on.
    pub fn play(&mut self, stimulus: Stimulus) {
        let (kernel, context) = self.machine.firmware_mut();
        let (world, mut access) = kernel.parts.access(context.now);
        world.play(stimulus, &mut access, context.memory);
    }

    /// Plays an operator for programs that wait on undriven inputs.
    pub fn play_operator(&mut self) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.world.play_operator(context.now);
    }

    /// Starts a recording; its records come as events.
    pub fn record(&mut self, request: trace::TraceRequest) {
        let (kernel, context) = self.machine.firmware_mut();
        let Parts { world, io, .. } = &mut kernel.parts;
        world.record(request, io, context.memory);
    }

    /// Drives an input from outside.
    pub fn drive_input(&mut self, bit: Bit, level: bool) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.lines(context.now).drive(bit, level);
        kernel.parts.note_external_change();
    }

    /// Puts characters on the UART's line; they arrive one after another at its rate.
    pub fn send_to_uart(&mut self, bytes: &[u8]) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.io.uart.queue_bytes(bytes, context.now);
        kernel.parts.note_external_change();
    }

    /// The number of characters on the UART's line that have not arrived yet.
    #[must_use]
    pub fn uart_backlog(&self) -> usize {
        self.machine.firmware().parts.io.uart.backlog()
    }

    /// Reports every character that the UART sends from now on as an event.
    pub fn hear_uart(&mut self) {
        let Parts { world, io, .. } = &mut self.machine.firmware_mut().0.parts;
        world.hear_uart(io);
    }

    /// The present value of something that can be recorded.
    #[must_use]
    pub fn value(&self, item: trace::Item) -> f64 {
        item.read(&self.machine.firmware().parts.view(self.memory()))
    }

    /// The axes that execute a motion of their own, such as a jog that is never ended.
    #[must_use]
    pub fn moving(&self) -> Vec<AxisId> {
        self.memory().axes().iter().filter(|&axis| independent::is_moving(self.memory(), axis)).collect()
    }

    /// The level of a bit.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> bool {
        self.machine.firmware().parts.level(self.memory(), bit)
    }
}
