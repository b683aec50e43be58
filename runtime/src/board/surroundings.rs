//! The surroundings of a board that runs a real firmware: the same machine, devices, stimulus and PC as for the
//! modelled one, attached to its registers.
//!
//! The parts are those of the modelled board, without its servo and its firmware functions: inputs and outputs answer
//! the registers, loads move by what the firmware outputs, switches and encoders show them, the PC serves requests and
//! files. All of them find the axes and other variables by the addresses of the tables; if a firmware keeps them at
//! other addresses, its memory maps them ([`place_of`](GuestMemory::place_of)).
//!
//! Source: `dsp-board.md` section 8.

use kmotiondef::AccessSize;
use kmotiondef::firmware::row_named;
use kmotiondef::function::PolledState;
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::{Chan, TripCoeff};
use kmotiondef::variables::{ADC_BUFFER_IN, CURRENT_THREAD, HOST_STATUS, KSTEP_PRESENT, trip_coeffs};
use kmotiondef::{Axes, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use vm::firmware::{ExecutedPacket, TickContext};
use vm::memory::GuestMemory;
use vm::scheduler::{SliceOwner, ThreadSet};
use vm::thread::Threads;

use super::machine_file::MachineFile;
use super::{Config, connect};
use crate::firmware::parts::Parts;
use crate::io::bits::bit_state;
use crate::machine::{COUNTS_PER_TICK, Channel, Drive};
use crate::out::{Event, EventKind, Message, Remark, Request, Speaker};
use crate::pc::{Pc, host};
use crate::servo::{input, load_drive, plan, wired};
use crate::views::{AxisView, TypedAccess};
use crate::world::stimulus::{InputReader, Stimulus};
use crate::world::{Moment, trace};
use chips::fpga::register_address;
use chips::kanalog::ADC_CHANNELS;
use chips::stepgen::generator_of;

/// The ranges of registers that are answered by the surroundings instead of the board itself.
const ANSWERED: [std::ops::Range<usize>; 5] = [0x08..0x09, 0x88..0x8A, 0x90..0x99, 0xC0..0xC2, 0x130..0x136];
/// An analog input of 0 V.
const ADC_ZERO: i32 = 2048;
/// The index of the first register of the converters.
const CONVERTERS: usize = 0x90;
/// Inputs of a KStep.
const KSTEP_INPUTS: i32 = 168;
/// The limit of steps by which a load can be moved in a tick: as many as a generator makes.
const ANY_STEPS: f64 = f64::MAX;

/// The shortest interrupt, before whose end no thread has run in a tick.
const INTERRUPT: Cycles = Cycles::new(2006);

/// A request of a stimulus to the board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StimulusRequest {
    /// The PC sends these bytes.
    Send(Vec<u8>),
    /// A program that was offered should be loaded under this name, and started.
    Run(ThreadId, String),
}

/// A program on the firmware calls one of its functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramCall {
    /// Its name.
    pub function: &'static str,
    /// The first argument, if it is an integer.
    pub argument: i32,
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// The instruction that calls.
    pub at: Option<CodeAddr>,
}

/// The view of a firmware's tick.
#[derive(Debug)]
pub struct Instant<'a> {
    /// Memory.
    pub memory: &'a mut GuestMemory,
    /// Since when the firmware is ready.
    pub now: Cycles,
    /// The time in ticks.
    pub tick: Ticks,
    /// The steps made by each generator.
    pub steps: [f64; N_CHANNELS],
    /// The count bytes of the encoders.
    pub encoders: &'a mut [u8; N_CHANNELS],
    /// The word of a KStep, if there is one.
    pub kstep: &'a mut Option<u16>,
}

/// The surroundings of a board.
#[derive(Clone, Debug)]
pub struct Surroundings {
    parts: Parts,
    threads: Threads,
    /// The steps of each generator at the last update.
    steps: [f64; N_CHANNELS],
    /// The commanded position of each axis' step generator, in position units.
    stepped: [f64; Axes::MAX],
    /// The position of each axis after the interrupt, if no program writes it.
    positions: [f64; Axes::MAX],
    was_enabled: [bool; Axes::MAX],
    /// The address of the word in which this firmware keeps the set of active threads.
    active: GuestAddr,
    /// The results of the converters from the previous tick.
    conversions: [u16; ADC_CHANNELS],
    asked: Vec<StimulusRequest>,
}

impl Surroundings {
    /// Creates the surroundings that a machine file describes, with a PC that keeps its files. The word at `active`
    /// holds the active threads.
    ///
    /// [`begin`](Self::begin) sets up the firmware and its memory.
    #[must_use]
    pub fn new(config: Config, active: GuestAddr) -> Self {
        let machine = &config.machine_file;
        let mut parts = Parts::new(Pc::new(config.files));
        parts.pc.host.connect(config.host && machine.pc.is_connected);
        parts.pc.host.answer_with(config.answers.unwrap_or_else(|| machine.pc.answers.clone()));
        connect::install(&mut parts, machine);
        Self {
            parts,
            threads: Threads::new(),
            steps: [0.0; N_CHANNELS],
            stepped: [0.0; Axes::MAX],
            positions: [0.0; Axes::MAX],
            was_enabled: [false; Axes::MAX],
            active,
            conversions: [ADC_ZERO as u16; ADC_CHANNELS],
            asked: Vec::new(),
        }
    }

    /// Begins the actions of the machine itself, and a stimulus, once the firmware is ready.
    pub fn begin(&mut self, machine: &MachineFile, stimulus: Stimulus, memory: &mut GuestMemory) {
        let status = i32::from(self.parts.pc.host.has_job());
        memory.set(HOST_STATUS, status);
        // Without a Kanalog nothing fills them: their contents at power-up are accidental, and these are the model's.
        (0..ADC_CHANNELS).for_each(|channel| memory.set(ADC_BUFFER_IN.element(channel), ADC_ZERO));
        // Firmware 5.3.2 loses the first jog of an axis if the mode of its first state happens to be 0.
        for axis in memory.axes().iter() {
            let first = trip_coeffs(axis).element(0).field(TripCoeff::TRAJECTORY_MODE);
            if memory.get(first) == 0 {
                memory.set(first, 1);
            }
        }
        connect::connect_surroundings(&mut self.parts, machine, memory);
        if !stimulus.is_empty() {
            let (world, mut access) = self.parts.access(Cycles::default());
            world.play(stimulus, &mut access, memory);
        }
        self.positions = std::array::from_fn(|axis| {
            memory.axes().get(axis as i32).map_or(0.0, |axis| memory.axis(axis, Chan::POSITION))
        });
    }

    /// Plays a further stimulus from now on.
    pub fn play(&mut self, stimulus: Stimulus, memory: &mut GuestMemory, now: Cycles) {
        let (world, mut access) = self.parts.access(now);
        world.play(stimulus, &mut access, memory);
    }

    /// Drives an input from outside.
    pub fn drive_input(&mut self, bit: Bit, level: bool, now: Cycles) {
        self.parts.lines(now).drive(bit, level);
    }

    /// Puts characters on the line to the serial port; they arrive one after another at its rate.
    pub fn send_to_uart(&mut self, bytes: &[u8], now: Cycles) {
        self.parts.io.uart.queue_bytes(bytes, now);
    }

    /// The number of characters on the line to the serial port that have not arrived yet.
    #[must_use]
    pub fn uart_backlog(&self) -> usize {
        self.parts.io.uart.backlog()
    }

    /// Queues characters for the serial port, and sets whether each character that the port sends is reported.
    pub fn connect_uart(&mut self, waiting: &[u8], is_heard: bool) {
        if !waiting.is_empty() {
            self.parts.io.uart.queue_bytes(waiting, Cycles::default());
        }
        if is_heard {
            let Parts { world, io, .. } = &mut self.parts;
            world.hear_uart(io);
        }
    }

    /// Plays an operator, from power-up on, for programs that wait on undriven inputs; their calls are reported to
    /// [`note_call`](Self::note_call).
    pub fn play_operator(&mut self) {
        self.parts.world.play_operator(Cycles::default());
    }

    /// Notes that a program calls the firmware, in order to find out whether it only waits, and for which event.
    pub fn note_call(&mut self, call: ProgramCall, memory: &GuestMemory, now: Cycles) {
        let Parts { world, io, .. } = &mut self.parts;
        let Some(assist) = &mut world.assist else { return };
        let polls = row_named(call.function).and_then(|row| row.attributes.polls);
        assist.note_call(polls.is_some(), now);
        if polls == Some(PolledState::Bit)
            && let Some(bit) = Bit::new(call.argument)
            && bit_state(io, memory, bit).1
        {
            assist.polled(bit, InputReader { thread: call.thread, at: call.at });
        }
    }

    /// A program has executed a packet.
    pub fn packet_ran(&mut self, packet: ExecutedPacket) {
        let ExecutedPacket { thread, at: address, start, cycles, text } = packet;
        let Parts { world, out, .. } = &mut self.parts;
        if world.records_packets(thread) {
            out.emit(start, EventKind::Trace(trace::Record::Packet { thread, address, cycles, text }));
        }
    }

    /// Starts a recording; its records come as events.
    pub fn record(&mut self, request: trace::TraceRequest, memory: &GuestMemory) {
        let Parts { world, io, .. } = &mut self.parts;
        world.record(request, io, memory);
    }

    /// The present value of something that can be recorded.
    #[must_use]
    pub fn value(&self, item: trace::Item, memory: &GuestMemory) -> f64 {
        self.parts.view(memory).item(item)
    }

    /// Returns the value of a register; `None` where the board itself answers.
    pub fn read(&mut self, register: usize, is_byte: bool, now: Cycles) -> Option<u16> {
        if let Some(conversion) = register.checked_sub(CONVERTERS).and_then(|at| self.conversions.get(at)) {
            return Some(*conversion);
        }
        let is_answered = ANSWERED.iter().any(|registers| registers.contains(&register));
        is_answered
            .then(|| self.parts.read_register(register_address(register as u32), size(is_byte), now) as u16)
    }

    /// The firmware writes a register.
    pub fn write(&mut self, register: usize, is_byte: bool, value: u16, now: Cycles) {
        let (fpga, chips) = self.parts.io.registers(now);
        // The firmware knows its registers; remarks would only concern programs.
        let _ = fpga.write(chips, register_address(register as u32), size(is_byte), value.into());
        self.parts.lines(now).settle();
    }

    /// Takes a console line sent by the firmware; the PC handles requests for files itself.
    pub fn receive_line(&mut self, line: Vec<u8>, now: Cycles) {
        self.parts.send_line(line, now);
    }

    /// The timer matches: the world acts, then the machine moves, before the interrupt sees it.
    pub fn tick(&mut self, instant: &mut Instant<'_>) {
        let now = instant.now;
        self.parts.clock.tick_start = now;
        self.conversions = std::array::from_fn(|channel| self.parts.io.kanalog.conversion(channel) as u16);
        let active = active_threads(instant.memory, self.active);
        self.follow_threads(active);
        self.parts.io.stepgens.follow(instant.steps, &mut self.parts.io.pins, now);
        let moment = self.slice(instant);
        let mut context =
            TickContext { memory: instant.memory, threads: &mut self.threads, tick: instant.tick, now };
        let (world, mut access) = self.parts.access(now);
        world.tick(&mut access, &mut context, moment);
        self.parts.pc.host.tick();
        if context.memory.get(CURRENT_THREAD) == 0 {
            let Parts { pc, out, .. } = &mut self.parts;
            pc.disk.slice(&mut context);
            host::slice(&mut pc.host, out, &mut context);
        }
        let Parts { machine, io, out, .. } = &mut self.parts;
        machine.drive(io, out, context.memory, now);
        self.move_loads(instant);
        self.parts.machine.signal(&mut self.parts.io, now);
        self.drive_inputs(instant);
        self.sample(instant);
        self.store_requests(active);
    }

    /// The owner of the slice that ends with a tick: the thread to which the previous interrupt has given the
    /// processor.
    ///
    fn slice(&mut self, instant: &Instant<'_>) -> Moment {
        let start = instant.now - Cycles::PER_TICK;
        let Some(thread) = ThreadId::new(instant.memory.get(CURRENT_THREAD)) else {
            return Moment { turn: SliceOwner::Primary, slice_start: instant.now };
        };
        let Parts { world, out, .. } = &mut self.parts;
        if world.records_changes() && start >= Cycles::default() {
            // The thread's registers, which the firmware saves, are not located here.
            let slice = trace::Record::Slice { thread, end: instant.now, interrupted_at: None };
            out.emit(start, EventKind::Trace(slice));
        }
        Moment { turn: SliceOwner::User(thread), slice_start: start + INTERRUPT }
    }

    /// The threads as the firmware has them.
    fn follow_threads(&mut self, active: ThreadSet) {
        for thread in ThreadId::all() {
            // Only the firmware knows whether there is a program.
            if self.threads.entry(thread).is_null() {
                self.threads.set_entry(thread, GuestAddr::new(1));
            }
            if active.contains(thread) == self.threads.state(thread).is_active() {
                continue;
            }
            if active.contains(thread) {
                let _ = self.threads.start(thread);
            } else {
                self.threads.pause(thread);
            }
        }
    }

    /// Moves each load by the outputs of the firmware for its axis in the last tick.
    fn move_loads(&mut self, instant: &mut Instant<'_>) {
        for axis in instant.memory.axes().iter() {
            let at = axis.index();
            let chan = AxisView::of(instant.memory, axis);
            let plant = &mut self.parts.machine.loads[axis];
            plant.note_position(self.positions[at]);
            let is_encoder = InputMode::new(chan.get(Chan::INPUT_MODE)) == Some(InputMode::Encoder);
            if !is_encoder {
                plant.note_position(chan.get(Chan::POSITION));
            }
            let mode = OutputMode::new(chan.get(Chan::OUTPUT_MODE));
            let wired = self.parts.machine.wiring.drive(axis);
            let generator = match wired {
                Some(Channel::Generator(generator)) => Some(generator),
                Some(Channel::Dac(_) | Channel::Pwm(_) | Channel::Relays(..)) => None,
                None => OutputMode::has_generator(mode).then(|| generator_of(chan.get(Chan::OUTPUT_CHAN0))),
            };
            let is_others = |generator: &usize| {
                self.parts.machine.wiring.motor_on(*generator).is_some_and(|owner| owner != axis)
            };
            let gain = f64::from(chan.get(Chan::OUTPUT_GAIN));
            let made = generator
                .filter(|generator| gain != 0.0 && !is_others(generator))
                .map_or(0.0, |generator| (instant.steps[generator] - self.steps[generator]) / gain);
            let is_enabled = chan.get(Chan::ENABLE) != 0;
            let was_enabled = std::mem::replace(&mut self.was_enabled[at], is_enabled);
            if let Some(Channel::Generator(_)) = wired {
                self.parts.machine.loads.push(axis, made);
                self.parts.machine.loads[axis].drive = Drive::None;
            } else if let Some(drive) =
                wired::drive(&self.parts.machine, &self.parts.io, instant.memory, axis)
            {
                self.parts.machine.loads[axis].drive = drive;
            } else if is_enabled {
                let chan = AxisView::of(instant.memory, axis);
                let plant = &mut self.parts.machine.loads[axis];
                self.stepped[at] += made;
                plant.drive = load_drive(&chan, self.stepped[at]);
                if let (Drive::Steps(command), false) = (plant.drive, was_enabled || made != 0.0) {
                    plant.refer_to(command);
                }
            } else {
                self.parts.machine.loads[axis].release();
            }
            let chan = AxisView::of(instant.memory, axis);
            let plant = &mut self.parts.machine.loads[axis];
            let reach = COUNTS_PER_TICK * f64::from(chan.get(Chan::INPUT_GAIN0)).abs();
            plant.advance(&chan, reach, || ANY_STEPS);
            plant.take_stepped();
        }
        self.steps = instant.steps;
    }

    /// Shows the firmware the counts of encoders and the levels of switches.
    fn drive_inputs(&mut self, instant: &mut Instant<'_>) {
        for axis in instant.memory.axes().iter() {
            let chan = AxisView::of(instant.memory, axis);
            let position = chan.get(Chan::POSITION);
            self.positions[axis.index()] = position;
            if InputMode::new(chan.get(Chan::INPUT_MODE)) != Some(InputMode::Encoder) {
                continue;
            }
            let Some(channel) =
                usize::try_from(chan.get(Chan::INPUT_CHAN0)).ok().filter(|channel| *channel < N_CHANNELS)
            else {
                continue;
            };
            let gain = f64::from(chan.get(Chan::INPUT_GAIN0));
            let last = chan.get(Chan::LAST_ENC);
            let Some(encoder) = plan::encoder(instant.memory, &self.parts.machine.wiring, axis) else {
                continue;
            };
            let count = input::register(&encoder, &mut self.parts.machine.loads);
            if instant.encoders[channel] != count.cast_unsigned() {
                instant.encoders[channel] = count.cast_unsigned();
                self.parts.io.encoders.count(channel, count, &mut self.parts.io.pins, instant.now);
            }
            self.positions[axis.index()] = position + gain * f64::from(count.wrapping_sub(last));
        }
        *instant.kstep = (instant.memory.get(KSTEP_PRESENT) != 0).then(|| {
            let inputs = (0..16).filter_map(|input| Bit::new(KSTEP_INPUTS + input));
            let levels = inputs.map(|bit| self.parts.io.pins.input(bit));
            (0..).zip(levels).fold(0, |word, (index, level)| word | u16::from(level) << index)
        });
    }

    fn sample(&mut self, instant: &mut Instant<'_>) {
        let Parts { out, io, machine, world, clock, .. } = &mut self.parts;
        if world.is_recording() {
            let context = TickContext {
                memory: instant.memory,
                threads: &mut self.threads,
                tick: instant.tick,
                now: instant.now,
            };
            let view = trace::View::new(machine, io, clock.tick_start, context.memory);
            world.sample(&view, out, &context, 1);
        }
    }

    /// Stores the requests of the stimulus to threads and to the PC.
    fn store_requests(&mut self, active: ThreadSet) {
        for thread in ThreadId::all() {
            match (active.contains(thread), self.threads.state(thread).is_active()) {
                (false, true) => self.command(&format!("Execute{thread}")),
                (true, false) => self.command(&format!("Kill{thread}")),
                _ => {}
            }
        }
        let bytes = self.parts.pc.usb.take_all();
        if !bytes.is_empty() {
            self.asked.push(StimulusRequest::Send(bytes));
        }
        for request in self.parts.out.take_requests() {
            if let Request::Run(thread, name) = request {
                self.asked.push(StimulusRequest::Run(thread, name.to_string()));
            }
        }
    }

    fn command(&mut self, line: &str) {
        self.asked.push(StimulusRequest::Send(format!("\u{1b}.{line}\r").into_bytes()));
    }

    /// Takes the requests to the board since the last call.
    pub fn take_asked(&mut self) -> Vec<StimulusRequest> {
        std::mem::take(&mut self.asked)
    }

    /// Takes the events since the last call.
    pub fn take_events(&mut self) -> Vec<Event> {
        let is_told = |event: &Event| match &event.kind {
            // Remarks are about programs, and nothing is known about the programs on a booted board.
            EventKind::Remark(Remark { speaker: Speaker::Board, .. }) => true,
            EventKind::Remark(remark) => matches!(remark.message, Message::Assisted { .. }),
            _ => true,
        };
        let mut events = self.parts.out.take_events();
        events.retain(is_told);
        events
    }

    /// Returns whether something is still pending: a statement that starts something, or an answer for which a program
    /// waits.
    #[must_use]
    pub fn is_busy(&self, memory: &GuestMemory) -> bool {
        let Parts { out, pc, world, .. } = &self.parts;
        pc.host.is_asked(memory) || world.is_busy(out)
    }

    /// Ends the run: the final expectations of the stimulus are checked.
    pub fn finish(&mut self, memory: &mut GuestMemory, now: Cycles) {
        self.follow_threads(active_threads(memory, self.active));
        let context = TickContext { memory, threads: &mut self.threads, tick: Ticks::new(0), now };
        let (world, mut access) = self.parts.access(now);
        world.finish(&mut access, &context);
    }
}

/// The threads that are active.
fn active_threads(memory: &GuestMemory, at: GuestAddr) -> ThreadSet {
    let active: u32 = memory.peek(at);
    ThreadId::all().filter(|thread| active >> thread.get() & 1 != 0).collect()
}

const fn size(is_byte: bool) -> AccessSize {
    if is_byte { AccessSize::Byte } else { AccessSize::Half }
}
