//! The kernel: the board's firmware and devices behind the machine's traits.
//!
//! It keeps what guest memory does not hold: output latches, the console queue, step generators, what waiting calls
//! have to remember. Everything a program can see in memory is only there.

pub(crate) mod globals;
mod world;

use std::collections::BTreeSet;
use std::sync::Arc;

use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_at};
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::map::{FPGA, TIMER0};
use kmotiondef::variables::{
    CURRENT_THREAD, LAST_TIMER0, NEXT_AVAIL_IN, NEXT_AVAIL_OUT, SERVO_TICK, USER_CALL_BACK,
};
use kmotiondef::{AxisId, Bit, Cycles, GuestAddr, ThreadId};
use vm::bus::{AccessSize, Bus};
use vm::firmware::{Caller, Firmware, Outcome, Pure, Signature, TickContext, Value};
use vm::memory::GuestMemory;
use vm::scheduler::Turn;
use vm::trap::{Trap, TrapKind};

use crate::commands::{self, Downloads, Experiment, Link};
use crate::firmware::dispatch::{HANDLERS, signatures};
use crate::firmware::files::Reading;
use crate::firmware::heap::Heap;
use crate::firmware::serial::{self, SerialService};
use crate::io::encoder::Encoders;
use crate::io::flash::Banks;
use crate::io::fpga::{Behind, Fpga};
use crate::io::kanalog::{self, Kanalog};
use crate::io::konnect::Konnects;
use crate::io::pins::Pins;
use crate::io::snapamp::SnapAmps;
use crate::io::stepgen::StepGenerators;
use crate::io::timer;
use crate::io::uart::Uart;
use crate::kernel::globals::Globals;
use crate::machine::plant::Mechanics;
use crate::out::{Event, EventKind};
use crate::pc::console::Console;
use crate::pc::disk::{self, Disk};
use crate::pc::files::HostFiles;
use crate::pc::host::Host;
use crate::servo::Servo;
use crate::views::Typed;
use crate::world::attached::Attached;
use crate::world::stimulus::{Assist, Player};
use crate::world::trace::{Record, Recorder};

/// What a register access costs beyond the instruction: 200 ns, a timer 100 ns.
const FPGA_CYCLES: Cycles = Cycles::new(40);
const TIMER_CYCLES: Cycles = Cycles::new(20);

/// What a waiting call remembers until it is made again.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Continuation {
    /// Text that the console queue had no room for, and what the call returns.
    Print {
        /// The text.
        rest: Vec<u8>,
        /// The result.
        result: i32,
    },
    /// The target of a motion, as it was when the call began.
    Target(f64),
    /// That a stop was begun, and the axes that are still to be stopped once those are known.
    Stop(Option<Vec<AxisId>>),
    /// The axes that are still to go on after a feedhold.
    Resume(Vec<AxisId>),
}

/// What only the board as a whole can do, as it holds the programs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// Make a program of what was downloaded into a thread that was started.
    Load(ThreadId),
    /// Save programs and settings in flash.
    Flash,
    /// Restart from flash.
    Reboot,
    /// Load a program that was offered and start it.
    Run(ThreadId, Arc<str>),
}

/// The board's firmware.
#[derive(Debug)]
pub struct Kernel {
    signatures: Vec<Signature>,
    continuations: [Option<Continuation>; ThreadId::MAX as usize + 1],
    pub(crate) console: Console,
    pub(crate) pins: Pins,
    pub(crate) fpga: Fpga,
    pub(crate) uart: Uart,
    pub(crate) serial: SerialService,
    pub(crate) snapamps: SnapAmps,
    pub(crate) konnects: Konnects,
    pub(crate) kanalog: Kanalog,
    pub(crate) encoders: Encoders,
    pub(crate) stepgens: StepGenerators,
    /// Devices on pins.
    attached: Vec<Box<dyn Attached>>,
    /// Whether characters that the UART sends are told.
    hears_uart: bool,
    /// What the world does, if anything.
    stimulus: Option<Box<Player>>,
    /// The operator, if there is one.
    pub(crate) assist: Option<Assist>,
    /// What is recorded, if anything.
    recorder: Option<Box<Recorder>>,
    pub(crate) servo: Servo,
    pub(crate) heap: Heap,
    /// How much of flash is seen.
    pub(crate) flash: Banks,
    /// The PC's disk, and what the board remembers of its files.
    pub(crate) disk: Disk,
    pub(crate) reading: Reading,
    pub(crate) globals: Globals,
    /// Ticks that a motion call plans before its motion begins.
    pub(crate) plan_ticks: u32,
    pub(crate) host: Host,
    /// The link to the PC over USB, and the one over the UART.
    pub(crate) usb: Link,
    pub(crate) uart_link: Link,
    pub(crate) downloads: Downloads,
    pub(crate) experiment: Option<Experiment>,
    /// Whether the PC takes console lines; if not, they wait in the queue, and then programs do.
    pub(crate) is_heard: bool,
    /// Whether a script command is being executed.
    pub(crate) is_commanding: bool,
    requests: Vec<Request>,
    /// State of `rand`.
    pub(crate) random: u32,
    /// Where `strtok` goes on.
    pub(crate) token: GuestAddr,
    /// When the present tick began.
    pub(crate) tick_start: Cycles,
    /// When the present slice began, and whose it is.
    slice_start: Cycles,
    turn: Turn,
    /// Whether the last tick changed nothing and no thread has run since.
    is_settled: bool,
    pub(crate) mechanics: Mechanics,
    /// Whether reading an input that nothing drives is worth a hint.
    pub(crate) hints: bool,
    /// Motion calls in a row that each came while the one before was planned, of each axis.
    pub(crate) hurried_calls: [u8; N_CHANNELS],
    hinted: BTreeSet<Bit>,
    /// Whether it was said that nothing serves Kanalog.
    told_kanalog: bool,
    events: Vec<Event>,
}

impl Kernel {
    /// A kernel at power-up whose PC keeps its files in `files`.
    #[must_use]
    pub fn new(files: Box<dyn HostFiles>) -> Self {
        Self {
            signatures: signatures(),
            continuations: Default::default(),
            console: Console::default(),
            pins: Pins::default(),
            fpga: Fpga::default(),
            uart: Uart::default(),
            serial: SerialService::default(),
            snapamps: SnapAmps::default(),
            konnects: Konnects::default(),
            kanalog: Kanalog::default(),
            encoders: Encoders::default(),
            stepgens: StepGenerators::default(),
            attached: Vec::new(),
            hears_uart: false,
            stimulus: None,
            assist: None,
            recorder: None,
            turn: Turn::Primary,
            servo: Servo::default(),
            heap: Heap::default(),
            flash: Banks::default(),
            disk: Disk::new(files),
            reading: Reading::default(),
            globals: Globals::default(),
            plan_ticks: 0,
            host: Host::default(),
            usb: Link::default(),
            uart_link: Link::default(),
            downloads: Downloads::default(),
            experiment: None,
            is_heard: true,
            is_commanding: false,
            requests: Vec::new(),
            random: 1,
            token: GuestAddr::NULL,
            tick_start: Cycles::default(),
            slice_start: Cycles::default(),
            is_settled: false,
            mechanics: Mechanics::default(),
            hints: true,
            hurried_calls: [0; N_CHANNELS],
            hinted: BTreeSet::new(),
            told_kanalog: false,
            events: Vec::new(),
        }
    }

    /// Remembers something for the call that is made again when its wake comes true.
    pub(crate) fn keep(&mut self, caller: &Caller<'_>, continuation: Continuation) {
        self.continuations[slot(caller.thread)] = Some(continuation);
    }

    /// What the call remembered.
    pub(crate) fn take(&mut self, caller: &Caller<'_>) -> Option<Continuation> {
        self.continuations[slot(caller.thread)].take()
    }

    /// A remark of the simulation about a call.
    pub(crate) fn diagnose(&mut self, caller: &Caller<'_>, text: String) {
        let text = match caller.thread {
            Some(thread) => format!("thread {thread}: {text}"),
            None if self.is_commanding => format!("command: {text}"),
            None => format!("call-back: {text}"),
        };
        self.tell(caller.now(), EventKind::Diagnostic(text));
    }

    /// A program reads an input that nothing drives.
    pub(crate) fn undriven(&mut self, caller: &Caller<'_>, bit: Bit) {
        if self.hints && self.hinted.insert(bit) {
            let kind = EventKind::UndrivenInput { bit, thread: caller.thread, place: None };
            self.tell(caller.now(), kind);
        }
    }

    /// A program makes a pin of JP7 an output.
    pub(crate) fn check_jp7(&mut self, caller: &Caller<'_>, bit: Bit) {
        if kanalog::is_served(&self.fpga, caller.memory)
            && !self.pins.is_output(bit)
            && let Some(text) = self.fpga.note_jp7(bit)
        {
            self.diagnose(caller, text);
        }
    }

    /// A program writes an output of Kanalog.
    pub(crate) fn check_kanalog(&mut self, memory: &GuestMemory, bit: Bit, now: Cycles) {
        if !self.told_kanalog && !kanalog::is_served(&self.fpga, memory) {
            self.told_kanalog = true;
            let text = format!(
                "bit {bit} is an output of Kanalog, which nothing has switched on: it is stored, no more \
                 (`board.kanalog = true` in the machine file)"
            );
            self.tell(now, EventKind::Detail(text));
        }
    }

    /// Records an event.
    pub(crate) fn tell(&mut self, at: Cycles, kind: EventKind) {
        if let (EventKind::ConsoleLine(line), Some(player)) = (&kind, &mut self.stimulus) {
            player.note_line(line, at);
        }
        self.events.push(Event { at, kind });
    }

    /// The events since the last time.
    pub(crate) fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Asks the board as a whole for something, to be done behind this tick.
    pub(crate) fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// What was asked for since the last time.
    pub(crate) fn take_requests(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.requests)
    }

    /// Everything that the firmware keeps is as at power-up; what lies outside of the board is left alone.
    pub(crate) fn restart(&mut self) {
        self.continuations = Default::default();
        self.console = Console::default();
        self.reading = Reading::default();
        self.disk.forget_answers();
        self.serial = SerialService::default();
        self.konnects = Konnects::default();
        self.heap = Heap::default();
        self.usb = Link::default();
        self.uart_link = Link::default();
        self.downloads = Downloads::default();
        self.experiment = None;
        self.random = 1;
        self.token = GuestAddr::NULL;
        self.disturb();
    }

    /// Sends all console text that waits, the unfinished line included.
    pub(crate) fn flush_console(&mut self, now: Cycles) {
        for line in self.console.drain() {
            self.send_line(line, now);
        }
    }

    /// Sends a console line; the PC keeps those for itself that are requests for files.
    fn send_line(&mut self, line: Vec<u8>, now: Cycles) {
        if !self.host.is_connected() || !disk::take(self, &line, now) {
            self.tell(now, EventKind::ConsoleLine(line));
        }
    }

    /// Exchanges inputs and outputs with one of the Konnects, if there are any; whether that was done.
    fn exchange(&mut self, context: &mut TickContext<'_>) -> bool {
        let has_any = self.konnects.has_any();
        if has_any && let Some((board, outputs)) = self.konnects.tick(context.memory, context.tick) {
            self.attached.iter_mut().for_each(|device| device.konnect(board, outputs, context.now));
        }
        has_any
    }

    /// Something outside has changed what the next tick may depend on.
    pub(crate) fn disturb(&mut self) {
        self.is_settled = false;
        self.servo.still.interrupt();
        self.servo.forget_plans();
    }

    /// Whether text, motion, a recording or a request to the PC is still under way.
    pub(crate) fn is_busy(&self, memory: &GuestMemory) -> bool {
        !self.console.is_idle()
            || Servo::is_busy(memory)
            || self.host.is_asked(memory)
            || self.usb.is_busy()
            || self.experiment.is_some()
            || self.serial.is_busy(memory, &self.uart)
            || self.stimulus.as_ref().is_some_and(|player| player.is_busy())
    }

    /// The registers and what stands behind them.
    fn registers(&mut self, now: Cycles) -> (&mut Fpga, Behind<'_>) {
        let behind = Behind {
            pins: &mut self.pins,
            uart: &mut self.uart,
            kanalog: &self.kanalog,
            encoders: &mut self.encoders,
            stepgens: &mut self.stepgens,
            now,
        };
        (&mut self.fpga, behind)
    }

    fn store_queue_indices(&self, memory: &mut GuestMemory) {
        let (write, read) = self.console.indices();
        memory.untouched(|memory| {
            memory.set(NEXT_AVAIL_IN, write);
            memory.set(NEXT_AVAIL_OUT, read);
        });
    }
}

fn slot(thread: Option<ThreadId>) -> usize {
    thread.map_or(0, |thread| usize::from(thread.get()))
}

/// The time variables of a tick.
fn store_time(context: &mut TickContext<'_>) {
    let (tick, now) = (context.tick, context.now);
    context.memory.untouched(|memory| {
        memory.set(SERVO_TICK, tick.get() as f64);
        memory.set(LAST_TIMER0, timer::count(now));
    });
}

impl Bus for Kernel {
    fn read(&mut self, addr: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
        if addr == TIMER0 {
            return timer::count(now);
        }
        if addr < FPGA.base {
            return 0;
        }
        let (fpga, behind) = self.registers(now);
        fpga.read(behind, addr, size)
    }

    fn write(&mut self, addr: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
        if addr < FPGA.base {
            self.tell(now, EventKind::Diagnostic(format!("write to {addr} has no effect")));
            return;
        }
        let (fpga, behind) = self.registers(now);
        if let Some(remark) = fpga.write(behind, addr, size, value) {
            self.tell(now, remark);
        }
        self.settle(now);
    }

    fn access_cycles(&self, addr: GuestAddr) -> Cycles {
        if addr >= FPGA.base { FPGA_CYCLES } else { TIMER_CYCLES }
    }
}

/// The firmware function at `address` if it only computes its result from its arguments.
#[must_use]
pub fn pure_function(address: GuestAddr) -> Option<Pure> {
    let row = &FIRMWARE_FUNCTIONS[function_at(address)?];
    let is_math = row.group == "math";
    let function = is_math.then(|| crate::firmware::math::pure(row.rust_name)).flatten()?;
    Some(Pure { cost: row.cost, function })
}

impl Firmware for Kernel {
    fn signature(&self, address: GuestAddr) -> Option<&Signature> {
        self.signatures.get(function_at(address)?)
    }

    fn call(&mut self, address: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        let number = function_at(address).ok_or(TrapKind::UnknownFirmwareFunction { addr: address })?;
        if caller.woken.is_none() {
            caller.spend(FIRMWARE_FUNCTIONS[number].cost);
        }
        if let Some(assist) = &mut self.assist {
            assist.called(FIRMWARE_FUNCTIONS[number].name, caller.now());
        }
        HANDLERS[number](self, caller)
    }

    fn pure(&self, address: GuestAddr) -> Option<Pure> {
        pure_function(address)
    }

    fn begins(&mut self, thread: ThreadId, memory: &mut GuestMemory) {
        self.globals.restore(thread, memory);
    }

    fn callback(&self, memory: &GuestMemory) -> GuestAddr {
        memory.get(USER_CALL_BACK)
    }

    fn tick(&mut self, context: &mut TickContext<'_>) {
        self.tick_start = context.now;
        let is_touched = context.memory.take_touched();
        store_time(context);
        self.kanalog.tick(&self.fpga, context.memory);
        if self.snapamps.is_present() {
            self.snapamps.tick(context.memory);
        }
        let acted = self.play_tick(context) | self.assist_tick(context.now);
        self.host.tick();
        // What goes in here may be stored wherever a program has said.
        let received = serial::tick(self, context) | self.exchange(context);
        if acted || received || is_touched {
            self.servo.forget_plans();
        }
        let changed = crate::servo::tick(self, context, is_touched);
        self.sample(context, 1);
        let calls_back = !context.memory.get(USER_CALL_BACK).is_null();
        self.is_settled = !changed && !acted && !calls_back;
    }

    fn servo_time(&self, memory: &GuestMemory) -> Cycles {
        self.servo.duration(memory)
    }

    fn switch_to(&mut self, turn: Turn, context: &mut TickContext<'_>) {
        self.slice_start = context.now;
        self.turn = turn;
        context.memory.untouched(|memory| memory.set(CURRENT_THREAD, i32::from(turn.number())));
        if turn != Turn::Primary {
            self.is_settled = false;
        }
    }

    fn primary_slice(&mut self, context: &mut TickContext<'_>) {
        if self.is_heard
            && !self.usb.is_in_command()
            && let Some(line) = self.console.send()
        {
            self.send_line(line, context.now);
        }
        disk::slice(self, context);
        crate::servo::limits::slice(self, context.memory);
        crate::pc::host::slice(self, context);
        serial::slice(self, context);
        if self.usb.is_busy() {
            commands::slice(self, context, |kernel| &mut kernel.usb);
        }
        if self.uart_link.is_busy() {
            commands::slice(self, context, |kernel| &mut kernel.uart_link);
        }
        commands::advance(self, context);
        self.store_queue_indices(context.memory);
    }

    fn slice_ran(&mut self, thread: ThreadId, start: Cycles, end: Cycles) {
        if self.recorder.as_ref().is_some_and(|recorder| recorder.records_changes()) {
            self.tell(start, EventKind::Trace(Record::Slice { thread, end }));
        }
    }

    fn trapped(&mut self, trap: &Trap, context: &mut TickContext<'_>) {
        if trap.thread.is_none() {
            context.memory.set(USER_CALL_BACK, GuestAddr::NULL);
        }
        self.tell(context.now, EventKind::Trap(trap.clone()));
    }

    fn stack_exceeded(&mut self, thread: ThreadId, used: u32) {
        let text = format!("thread {thread}: {used} bytes of stack used; the board has about 1900");
        self.tell(self.slice_start, EventKind::Diagnostic(text));
    }

    fn quiet_ticks(&self, memory: &GuestMemory) -> u64 {
        let is_quiet = self.is_settled
            && self.console.is_idle()
            && !self.usb.is_busy()
            && self.experiment.is_none()
            && self.konnects.is_settled(memory)
            && self.kanalog.is_settled(&self.fpga, memory)
            && self.attached.iter().all(|device| device.is_settled())
            && !self.uart.is_sending()
            && !self.records_motion()
            && !self.serial.is_busy(memory, &self.uart);
        if !is_quiet {
            return 0;
        }
        let now = self.tick_start;
        let stimulus = self.stimulus.as_ref().map_or(u64::MAX, |player| player.quiet_ticks(now));
        let assist = self.assist.as_ref().map_or(u64::MAX, |assist| assist.quiet_ticks(now));
        self.host.quiet_ticks().min(stimulus).min(assist).min(self.disk.quiet_ticks(now))
    }

    fn quiet_slices(&self, memory: &GuestMemory) -> u64 {
        // The words that Konnect boards exchange lie where the program has said; all else is in on-chip RAM.
        if self.recorder.is_some() || self.konnects.has_any() { 0 } else { self.quiet_ticks(memory) }
    }

    fn skip_ticks(&mut self, count: u64, context: &mut TickContext<'_>) {
        self.tick_start = context.now;
        store_time(context);
        self.host.skip(count);
        self.sample(context, count);
    }
}
