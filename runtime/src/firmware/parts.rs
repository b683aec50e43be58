//! The parts of the board, as firmware functions and script commands access them.
//!
//! This type has no behaviour of its own: a call goes to one part, and passes the other parts that it works on.

use kmotiondef::AccessSize;
use kmotiondef::firmware::Function;
use kmotiondef::timing::Timing;
use kmotiondef::{Bit, Cycles, GuestAddr};
use vm::firmware::{Caller, TickContext};
use vm::memory::GuestMemory;
use vm::scheduler::SliceOwner;

use super::calls::Calls;
use super::level::ModelledBoard;
use super::races::Races;
use super::races::switches::Switches;
use crate::io::remark_on;
use crate::io::{Io, bits};
use crate::machine::{Lines, Machine};
use crate::out::{Message, Out};
use crate::pc::Pc;
use crate::servo::cache::Invalidation;
use crate::servo::{Servo, Tick};
use crate::world::trace::View;
use crate::world::{World, WorldAccess};

/// The board times of the tick and of the slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// When the present tick began.
    pub(crate) tick_start: Cycles,
    /// The beginning of the present slice.
    pub(crate) slice_start: Cycles,
    pub(crate) turn: SliceOwner,
    /// The time that the primary thread still needs to send the string it has begun.
    pub(crate) sending: Cycles,
}

/// The parts of the board.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub(crate) out: Out,
    pub(crate) io: Io,
    pub(crate) machine: Machine,
    pub(crate) servo: Servo,
    pub(crate) pc: Pc,
    pub(crate) world: World,
    pub(crate) calls: Calls,
    /// The firmware that the board models.
    pub(crate) level: ModelledBoard,
    pub(crate) clock: Clock,
    /// Whose time is counted.
    pub(crate) timing: Timing,
    /// The accesses of threads to shared memory, if races are detected.
    pub(crate) races: Option<Box<Races>>,
    /// The switches of a schedule.
    pub(crate) switches: Option<Box<Switches>>,
}

impl Parts {
    /// The parts at power-up.
    pub(crate) fn new(pc: Pc) -> Self {
        Self {
            out: Out::default(),
            io: Io::default(),
            machine: Machine::default(),
            servo: Servo::default(),
            pc,
            world: World::default(),
            calls: Calls::default(),
            level: ModelledBoard::default(),
            clock: Clock {
                tick_start: Cycles::default(),
                slice_start: Cycles::default(),
                turn: SliceOwner::Primary,
                sending: Cycles::default(),
            },
            timing: Timing::Fast,
            races: None,
            switches: None,
        }
    }

    /// The board's lines at an instant.
    pub(crate) fn lines(&mut self, now: Cycles) -> Lines<'_> {
        Lines { machine: &mut self.machine, io: &mut self.io, out: &mut self.out, now }
    }

    /// Returns the parts that a tick of the servo works on, and the tick's beginning.
    pub(crate) fn servo_tick(&mut self) -> Tick<'_> {
        Tick {
            servo: &mut self.servo,
            machine: &mut self.machine,
            io: &mut self.io,
            out: &mut self.out,
            now: self.clock.tick_start,
        }
    }

    /// The world, and the parts on which it acts.
    pub(crate) fn access(&mut self, now: Cycles) -> (&mut World, WorldAccess<'_>) {
        let access = WorldAccess {
            machine: &mut self.machine,
            io: &mut self.io,
            pc: &mut self.pc,
            out: &mut self.out,
            now,
        };
        (&mut self.world, access)
    }

    /// The values of the board.
    pub(crate) fn view<'a>(&'a self, memory: &'a GuestMemory) -> View<'a> {
        View::new(&self.machine, &self.io, self.clock.tick_start, memory)
    }

    /// The level of a bit.
    pub(crate) fn level(&self, memory: &GuestMemory, bit: Bit) -> bool {
        bits::bit_state(&self.io, memory, bit).0
    }

    /// Reads a register of the FPGA.
    pub(crate) fn read_register(&mut self, address: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
        let (fpga, chips) = self.io.registers(now);
        fpga.read(chips, address, size)
    }

    /// Writes a register of the FPGA.
    pub(crate) fn write_register(&mut self, address: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
        let (fpga, chips) = self.io.registers(now);
        if let Some(notice) = fpga.write(chips, address, size, value) {
            self.out.remark(now, remark_on(notice));
        }
        self.lines(now).settle();
    }

    /// Sends a console line; the PC handles requests for files itself.
    pub(crate) fn send_line(&mut self, line: Vec<u8>, now: Cycles) {
        self.pc.take_line(&mut self.out, line, now);
    }

    /// Sends all console lines that wait; one that has not ended stays.
    pub(crate) fn flush_console(&mut self, now: Cycles) {
        for line in self.out.console.drain() {
            self.send_line(line, now);
        }
    }

    /// Checks that the array in which a store of `size` bytes begins has room for them, and makes a remark otherwise.
    pub(crate) fn check_room(&mut self, caller: &Caller<'_>, function: Function, to: GuestAddr, size: usize) {
        if let Some(array) = self.calls.notices.overrun(to, size) {
            let (name, room) = (array.name.clone(), array.size);
            self.out.diagnose(caller, Message::BeyondArray { function, name, size: room, bytes: size });
        }
    }

    /// Exchanges inputs and outputs with one of the Konnects, if there are any; returns whether it did.
    pub(crate) fn exchange_konnect(&mut self, context: &mut TickContext<'_>) -> bool {
        let has_any = self.io.konnects.has_any();
        if has_any && let Some((board, outputs)) = self.io.konnects.tick(context.memory, context.tick) {
            self.machine.konnect(board, outputs, context.now);
        }
        has_any
    }

    /// Notes that something outside has changed a state on which the next tick may depend.
    pub(crate) fn note_external_change(&mut self) {
        self.servo.cache.invalidate(Invalidation::Anything);
    }
}
