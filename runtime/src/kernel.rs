//! The kernel: the board's parts as implementations of the machine's traits, and the order of a tick.
//!
//! It composes the parts and defines their order; the parts themselves do the work.

use kmotiondef::AccessSize;
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, FirmwareFunction, Function, function_at};
use kmotiondef::function::{Attributes, PolledState};
use kmotiondef::limits::MAX_GATHER_DATA;
use kmotiondef::map::{FPGA, TIMER0};
use kmotiondef::structs::Chan;
use kmotiondef::variables::{
    CURRENT_THREAD, LAST_TIMER0, NEXT_AVAIL_IN, NEXT_AVAIL_OUT, SERVO_TICK, USER_CALL_BACK,
};
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId};
use vm::bus::Bus;
use vm::firmware::{
    Caller, ExecutedPacket, Firmware, NextAccess, Outcome, Pure, ReadState, RepeatPolicy, SharedAccess,
    Signature, SwitchPoint, TickContext, Value,
};
use vm::memory::GuestMemory;
use vm::scheduler::SliceOwner;
use vm::trap::{Trap, TrapKind};

use crate::commands::Scripts;
use crate::firmware::calls::{Calls, HeldLock, Overlap, SmallMove, WrongWait, WrongZero};
use crate::firmware::dispatch::{Answer, HANDLERS, signatures};
use crate::firmware::later::{self, Callee, Callees, LATER_FUNCTIONS};
use crate::firmware::level::ModelledBoard;
use crate::firmware::parts::Parts;
use crate::firmware::races::shared;
use crate::firmware::{axis_check, kogna_bus, math, serial, time, waits};
use crate::io::Io;
use crate::io::bits::bit_state;
use crate::io::kanalog;
use crate::io::kogna::Kogna;
use crate::io::konnect::Konnects;
use crate::io::timer;
use crate::machine::Machine;
use crate::machine::description::Condition;
use crate::out::{Console, EventKind, Message, Out, Speaker};
use crate::pc::Pc;
use crate::pc::files::HostFiles;
use crate::pc::host;
use crate::servo::cache::Invalidation;
use crate::servo::{CallPlace, Servo, limits};
use crate::text::legible;
use crate::views::TypedAccess;
use crate::world::Moment;
use crate::world::trace::{Record, View};

/// The address after the gather buffer. Only programs write there.
const GATHER_END: GuestAddr = GuestAddr::new(0x8010_2010 + 8 * MAX_GATHER_DATA as u32);

/// The address after `persist.UserData`, its elements, and the words after it that only programs write.
const USER_DATA_END: u32 = 0x1001_7020;
const USER_DATA_ELEMENTS: u32 = 200;
const AFTER_USER_DATA: u32 = 100;

/// The cost of a register access in addition to the instruction, if time does not follow the board's: 200 ns, 100 ns
/// for a timer.
const FPGA_CYCLES: Cycles = Cycles::new(40);
const TIMER_CYCLES: Cycles = Cycles::new(20);

/// The board's firmware, and its surroundings.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The signatures of the functions of the table, then those of later functions.
    signatures: Vec<Signature>,
    callees: Callees,
    pub(crate) parts: Parts,
    pub(crate) scripts: Scripts,
}

impl Kernel {
    /// A kernel at power-up whose PC keeps its files in `files`.
    #[must_use]
    pub fn new(files: Box<dyn HostFiles>) -> Self {
        Self::of_board(ModelledBoard::default(), files)
    }

    /// A kernel with the firmware of a board.
    #[must_use]
    pub fn of_board(board: ModelledBoard, files: Box<dyn HostFiles>) -> Self {
        let mut signatures = signatures();
        signatures.extend(later::signatures());
        let mut parts = Parts { level: board, ..Parts::new(Pc::new(files)) };
        let method = parts.level.board().variable("StandardDerivativeMethod");
        parts.servo.cache.derivative_method = method;
        parts.servo.planner = parts.level.behaviour().planner;
        parts.io.kogna = devices(&parts.level);
        parts.pc.downloads.spaces = parts.level.board().programs();
        Self {
            signatures,
            callees: Callees::for_board(parts.level.board()),
            parts,
            scripts: Scripts::default(),
        }
    }

    /// The row of the function at an address, if the table has it.
    fn row(&self, address: GuestAddr) -> Option<&'static FirmwareFunction> {
        match self.callees.callee_at(address)? {
            Callee::Row(number) => Some(&FIRMWARE_FUNCTIONS[number]),
            Callee::Later(_) => None,
        }
    }

    /// Returns whether the function at an address takes a free lock.
    pub(crate) fn takes_lock(&self, address: GuestAddr) -> bool {
        self.row(address).is_some_and(|row| {
            matches!(row.attributes.polls, Some(PolledState::Lock)) || row.name == Function::TestAndSet.name()
        })
    }

    fn call_later(&mut self, number: usize, caller: &mut Caller<'_>) -> Answer {
        let function = &LATER_FUNCTIONS[number];
        if caller.woken.is_none() {
            caller.spend(function.cost);
        }
        if let Some(thread) = caller.thread {
            self.parts.calls.waits.act(thread, caller.now(), None);
        }
        (function.handler)(&mut self.parts, caller)
    }

    /// Resets all state of the firmware to that at power-up; the surroundings of the board are unchanged.
    pub(crate) fn restart(&mut self) {
        let Self { parts, scripts, signatures: _, callees: _ } = self;
        parts.calls.restart();
        parts.out.console = Console::default();
        parts.out.forget_remarks(&["uart-overrun", "uart-commands", "line-in-parts", "percent-twice"]);
        parts.io.konnects = Konnects::default();
        parts.io.kogna = devices(&parts.level);
        parts.pc.restart();
        *scripts = Scripts::default();
        parts.note_external_change();
    }

    /// Returns whether text, motion, a recording or a request to the PC is still in progress.
    pub(crate) fn is_busy(&self, memory: &GuestMemory) -> bool {
        let Parts { out, io, pc, world, calls, .. } = &self.parts;
        !out.console.is_idle()
            || Servo::is_busy(memory)
            || pc.host.is_asked(memory)
            || pc.usb.is_busy()
            || self.scripts.has_experiment()
            || calls.serial.is_busy(memory, &io.uart)
            || world.is_busy(out)
    }

    /// Ends the run: the final expectations of the stimulus are checked.
    pub(crate) fn finish(&mut self, context: &TickContext<'_>) {
        let (world, mut access) = self.parts.access(context.now);
        world.finish(&mut access, context);
    }

    /// Follows a call of a program, in order to find out whether it only waits, and for which event.
    fn note_call(&mut self, number: usize, caller: &Caller<'_>) {
        if caller.now() >= self.parts.calls.notices.due {
            self.settle_notices(caller.now());
        }
        let Attributes { polls, drives_axis, is_pure, .. } = &FIRMWARE_FUNCTIONS[number].attributes;
        let place = Some(CallPlace { thread: caller.thread, at: caller.at });
        self.parts.servo.last_call = place;
        if *drives_axis && let Some(axis) = caller.memory.axes().get(caller.arguments.get(0)) {
            self.parts.servo.commands[axis.index()] = place;
        }
        let calls = &mut self.parts.calls.waits;
        match (caller.thread, *polls) {
            (Some(thread), Some(state)) => calls.record_poll(thread, state, caller),
            // An engine may compute pure functions without calling the firmware.
            (Some(thread), None) if !is_pure => {
                calls.act(thread, caller.now(), Some(&FIRMWARE_FUNCTIONS[number]));
            }
            (Some(_) | None, _) => {}
        }
        if *drives_axis && let Some(axis) = caller.memory.axes().get(caller.arguments.get(0)) {
            calls.record_commanded(axis);
        }
        if let Some(assist) = &mut self.parts.world.assist {
            assist.note_call(polls.is_some() || *is_pure, caller.now());
        }
    }

    /// Makes the remarks that are only certain at the end of a run.
    pub(crate) fn sum_up(&mut self, context: &TickContext<'_>) {
        self.settle_notices(context.now);
        axis_check::note_unwatched_limits(&mut self.parts, context.memory, context.now);
        note_overruns(&mut self.parts, context, AFTER_USER_DATA);
        let Parts { out, machine, io, calls, races, pc, .. } = &mut self.parts;
        let held = String::from_utf8_lossy(out.console.held()).into_owned();
        if !held.is_empty() && !calls.notices.has_cut_text {
            let (thread, at) = calls.notices.last_print;
            out.remark_of(context.now, thread.into(), at, Message::UnfinishedLine { text: held });
        }
        if ThreadId::all().all(|thread| !context.threads.state(thread).is_active())
            && let Some(name) = pc.disk.written()
        {
            out.remark(context.now, Message::FileLeftOpen { name: name.to_owned() });
        }
        if let Some(races) = races {
            races.finish(context.threads, context.now, out);
        }
        if races.is_none() {
            note_kept_locks(calls, out, context);
        }
        for (axis, SmallMove { thread, at, function, way }) in calls.motions.small_moves() {
            let message = Message::TinyMove { function, axis, way: legible(way) };
            out.remark_of(context.now, Speaker::Thread(thread), at, message);
        }
        for WrongWait { thread, asked, moving, at } in calls.motions.wrong_waits() {
            let message = Message::WaitsForOther { asked, moving };
            out.remark_of(context.now, Speaker::Thread(thread), at, message);
        }
        for Overlap { thread, function, axis, moving, at } in calls.motions.unasked_overlaps() {
            let message = Message::NotWaitedFor { function, axis, moving };
            out.remark_of(context.now, Speaker::Thread(thread), at, message);
        }
        for WrongZero { thread, axis, homed, at } in calls.motions.wrong_zeros() {
            let message = Message::ZeroesOther { axis, homed };
            out.remark_of(context.now, Speaker::Thread(thread), at, message);
        }
        for thread in ThreadId::all().filter(|thread| context.threads.state(*thread).is_active()) {
            let reads =
                calls.waits.wait_of(thread).calls.iter().filter(|call| call.polls == PolledState::Bit);
            for bit in reads.filter_map(|call| Bit::new(call.argument)) {
                if let Some(message) = moves_away(machine, io, context.memory, bit) {
                    out.remark_of(context.now, Speaker::Thread(thread), None, message);
                }
            }
        }
    }

    /// Makes a remark on a call-back that replaces another thread's.
    fn note_call_back(&mut self, call_back: GuestAddr, now: Cycles) {
        let owner = |address: GuestAddr| {
            let spaces = self.parts.level.board().programs();
            ThreadId::all().find(|thread| spaces.space(*thread).contains(&address.get()))
        };
        let before = std::mem::replace(&mut self.parts.calls.notices.call_back, call_back);
        if let (Some(thread), Some(by)) = (owner(before), owner(call_back))
            && thread != by
        {
            self.parts.out.remark(now, Message::CallBackReplaced { thread, by });
        }
    }

    /// Reports levels that were written to pins which are still inputs.
    fn settle_notices(&mut self, now: Cycles) {
        let Parts { out, io, calls, .. } = &mut self.parts;
        calls.notices.report_pending(out, now, |bit| io.pins.is_output(bit));
    }

    /// The limit switch of an axis that is watched and active.
    pub(crate) fn active_limit(&self, memory: &GuestMemory, axis: AxisId) -> Option<Bit> {
        limits::active_switch(&self.parts.io, memory, axis)
    }

    /// Records the last of `count` ticks that should be recorded.
    #[inline]
    fn sample(&mut self, context: &TickContext<'_>, count: u64) {
        let Parts { out, io, machine, world, clock, .. } = &mut self.parts;
        if world.is_recording() {
            world.sample(&View::new(machine, io, clock.tick_start, context.memory), out, context, count);
        }
    }

    fn store_queue_indices(&self, memory: &mut GuestMemory) {
        let (write, read) = self.parts.out.console.indices();
        memory.untouched(|memory| {
            memory.set(NEXT_AVAIL_IN, write);
            memory.set(NEXT_AVAIL_OUT, read);
        });
    }
}

/// The devices that only a Kogna has, at power-up.
fn devices(level: &ModelledBoard) -> Option<Box<Kogna>> {
    level.behaviour().has_kogna_devices.then(|| Box::new(Kogna::of(level.board())))
}

/// Values that a program has stored after the end of an array of the board: in the first `words` after
/// `persist.UserData`.
fn note_overruns(parts: &mut Parts, context: &TickContext<'_>, words: u32) {
    if context.memory.peek::<f64>(context.memory.place_of(GATHER_END)).to_bits() != 0 {
        parts.servo_tick().remark_near(Message::GatherOverrun { most: MAX_GATHER_DATA });
    }
    let beyond = |word: &u32| context.memory.peek::<u32>(GuestAddr::new(USER_DATA_END + 4 * word)) != 0;
    if let Some(word) = (0..words).find(beyond).filter(|_| parts.level.board().is_default()) {
        parts.servo_tick().remark_near(Message::UserDataOverrun { index: USER_DATA_ELEMENTS + word });
    }
}

/// Makes remarks on locks that are still held by threads that have ended.
fn note_kept_locks(calls: &Calls, out: &mut Out, context: &TickContext<'_>) {
    for HeldLock { thread, lock, at } in calls.locks.held().iter().copied() {
        let has_ended = context.threads.state(thread).is_ready() && context.threads.has_run(thread);
        if has_ended && context.memory.peek::<i32>(lock) != 0 {
            let lock = calls.notices.name_of(lock, 4);
            out.remark_of(context.now, Speaker::Thread(thread), at, Message::LockKept { lock });
        }
    }
}

/// Makes a remark if a bit is waited for while the axes that would close its switches move in the other direction.
fn moves_away(machine: &Machine, io: &Io, memory: &GuestMemory, bit: Bit) -> Option<Message> {
    let mut away = None;
    for (axis, condition, active) in machine.mechanics.contacts(bit) {
        let (condition, load) = (condition?, machine.loads[axis].load);
        let velocity = memory.axis(axis, Chan::LAST_VEL);
        if memory.axis(axis, Chan::ENABLE) == 0 || velocity == 0.0 {
            continue;
        }
        let goes_away = match condition {
            Condition::AtMost(place) => load > place && velocity > 0.0,
            Condition::AtLeast(place) => load < place && velocity < 0.0,
            Condition::Between(from, to) => load > to && velocity > 0.0 || load < from && velocity < 0.0,
        };
        // A switch at the other end of the travel will do.
        if !goes_away || bit_state(io, memory, bit).0 == active {
            return None;
        }
        let place = condition.to_string();
        away.get_or_insert(Message::MovesAway { axis, bit, place, load });
    }
    away
}

/// Sends text from the console queue: as much as the primary thread has time for in its slice, or one string if time
/// does not follow the board's.
fn send_lines(parts: &mut Parts, now: Cycles) {
    let Some(waits) = parts.timing.wait_states() else {
        if let Some(line) = parts.out.console.send() {
            parts.send_line(line, now);
        }
        return;
    };
    let length = Cycles::PER_TICK - (now - parts.clock.tick_start);
    let mut spent = std::mem::take(&mut parts.clock.sending);
    while spent < length
        && let Some(line) = parts.out.console.send()
    {
        spent += waits::sending(line.len(), waits);
        parts.send_line(line, now);
    }
    parts.clock.sending = (spent - length).max(Cycles::default());
}

/// The time variables of a tick.
fn store_time(context: &mut TickContext<'_>) {
    let (tick, now) = (context.tick, context.now);
    context.memory.untouched(|memory| {
        memory.set(SERVO_TICK, tick.get() as f64);
        let count = if memory.has_other_map() {
            timer::count_of(memory.map(), now) as u32
        } else {
            timer::count(now)
        };
        memory.set(LAST_TIMER0, count);
    });
}

impl Bus for Kernel {
    fn read(&mut self, addr: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
        if self.parts.io.kogna.is_some() {
            return kogna_bus::read(&mut self.parts, addr, size, now);
        }
        if addr == TIMER0 {
            return timer::count(now);
        }
        if addr < FPGA.base {
            return 0;
        }
        self.parts.read_register(addr, size, now)
    }

    fn write(&mut self, addr: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
        if self.parts.io.kogna.is_some() {
            return kogna_bus::write(&mut self.parts, addr, size, value, now);
        }
        if addr < FPGA.base {
            self.parts.out.remark(now, Message::NoEffect { address: addr });
            return;
        }
        self.parts.write_register(addr, size, value, now);
    }

    fn access_cycles(&self, addr: GuestAddr) -> Cycles {
        match self.parts.timing.wait_states() {
            Some(waits) => Cycles::new(waits.register.into()),
            None if addr >= FPGA.base => FPGA_CYCLES,
            None if self.parts.level.board().map().fpga.holds(addr) => FPGA_CYCLES,
            None => TIMER_CYCLES,
        }
    }
}

/// The firmware function at `address` if it only computes its result from its arguments.
#[must_use]
pub fn pure_function(address: GuestAddr) -> Option<Pure> {
    pure(&FIRMWARE_FUNCTIONS[function_at(address)?])
}

fn pure(row: &FirmwareFunction) -> Option<Pure> {
    let function = row.attributes.is_pure.then(|| math::pure(row.rust_name)).flatten()?;
    Some(Pure { cost: row.cost, function })
}

impl Firmware for Kernel {
    fn signature(&self, address: GuestAddr) -> Option<&Signature> {
        match self.callees.callee_at(address)? {
            Callee::Row(number) => self.signatures.get(number),
            Callee::Later(number) => self.signatures.get(FIRMWARE_FUNCTIONS.len() + number),
        }
    }

    fn call(&mut self, address: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        let callee = self.callees.callee_at(address);
        let number = match callee.ok_or(TrapKind::UnknownFirmwareFunction { addr: address })? {
            Callee::Row(number) => number,
            Callee::Later(number) => return self.call_later(number, caller),
        };
        let row = &FIRMWARE_FUNCTIONS[number];
        match (caller.woken, self.parts.timing.wait_states()) {
            (None, _) => caller.spend(row.cost),
            (Some(wake), Some(waits)) => caller.spend(waits::after(row, wake, waits)),
            (Some(_), None) => {}
        }
        self.note_call(number, caller);
        if self.parts.races.is_none() {
            return HANDLERS[number](&mut self.parts, caller);
        }
        let before = shared::examine_call(&mut self.parts, Function::ALL[number], caller);
        let outcome = HANDLERS[number](&mut self.parts, caller)?;
        shared::after(&mut self.parts, before, &outcome, caller);
        Ok(outcome)
    }

    fn accessed(&mut self, access: &SharedAccess<'_>, memory: &GuestMemory) -> RepeatPolicy {
        let Parts { races, out, switches, .. } = &mut self.parts;
        let repeats = races.as_mut().map(|races| races.record_access(access, memory, out));
        if let (Some(switches), Some(thread)) = (switches, access.thread) {
            switches.record_access(thread, access.at, access.address);
        }
        repeats.unwrap_or(RepeatPolicy::Redundant)
    }

    fn take_ordering(&mut self) -> bool {
        self.parts.races.as_mut().is_some_and(|races| races.take_ordering())
    }

    fn switch_at(&mut self, access: &NextAccess) -> Option<SwitchPoint> {
        let Parts { switches, out, .. } = &mut self.parts;
        switches.as_mut()?.switch_point(access, out)
    }

    fn pure(&self, address: GuestAddr) -> Option<Pure> {
        pure(self.row(address)?)
    }

    fn reads(&self, address: GuestAddr) -> Option<ReadState> {
        let row = self.row(address)?;
        match row.attributes.polls {
            Some(PolledState::Bit | PolledState::Motion | PolledState::Path | PolledState::Recording) => {
                Some(ReadState::Steady)
            }
            Some(PolledState::Time) => row.attributes.waits.is_none().then_some(ReadState::Time),
            Some(PolledState::Lock) => None,
            None => row.attributes.is_pure.then_some(ReadState::Steady),
        }
    }

    fn time(&self, memory: &GuestMemory, now: Cycles) -> f64 {
        time::seconds(memory, now)
    }

    fn steady_until(&self) -> Option<Cycles> {
        Some(self.parts.calls.notices.due)
    }

    fn is_variadic(&self, address: GuestAddr) -> bool {
        self.row(address).is_some_and(|row| row.is_variadic)
    }

    fn changed_registers(&self, address: GuestAddr) -> u64 {
        self.row(address).map_or(0, |row| row.attributes.changed_registers)
    }

    fn begins(&mut self, thread: ThreadId, context: &mut TickContext<'_>) {
        self.parts.calls.motions.start_thread(thread);
        self.parts.calls.globals.restore(thread, context.memory);
        if let Some(races) = &mut self.parts.races {
            races.begin_thread(thread, context.threads, context.now);
        }
    }

    fn callback(&self, memory: &GuestMemory) -> GuestAddr {
        memory.get(USER_CALL_BACK)
    }

    fn tick(&mut self, context: &mut TickContext<'_>) {
        let parts = &mut self.parts;
        parts.clock.tick_start = context.now;
        let is_touched = context.memory.take_touched();
        store_time(context);
        kanalog::tick(&parts.io.kanalog, &parts.io.fpga, context.memory);
        if parts.io.snapamps.is_present() {
            parts.io.snapamps.tick(context.memory);
        }
        let moment = Moment { turn: parts.clock.turn, slice_start: parts.clock.slice_start };
        let (world, mut access) = parts.access(context.now);
        let acted = world.tick(&mut access, context, moment);
        parts.pc.host.tick();
        // These may be stored at addresses chosen by a program.
        let received = serial::tick(parts, context) | parts.exchange_konnect(context);
        if acted || received || is_touched {
            parts.servo.cache.invalidate(Invalidation::Memory);
        }
        if let SliceOwner::User(thread) = moment.turn
            && let Some(message) = parts.pc.host.watch(context.memory, thread)
        {
            let last = parts.servo.last_call.filter(|last| last.thread == Some(thread));
            parts.out.remark_of(context.now, Speaker::Thread(thread), last.and_then(|last| last.at), message);
        }
        note_overruns(parts, context, 1);
        let changed = crate::servo::tick(&mut parts.servo_tick(), context.memory, is_touched);
        self.sample(context, 1);
        let call_back = context.memory.get(USER_CALL_BACK);
        let calls_back = !call_back.is_null();
        if call_back != self.parts.calls.notices.call_back {
            self.note_call_back(call_back, context.now);
        }
        self.parts.servo.cache.settle(!changed && !acted && !calls_back);
    }

    fn servo_time(&self, memory: &GuestMemory) -> Cycles {
        let cache = &self.parts.servo.cache;
        match self.parts.timing.wait_states() {
            Some(waits) => cache.interrupt(memory, waits),
            None => cache.duration(memory),
        }
    }

    fn switch_to(&mut self, turn: SliceOwner, context: &mut TickContext<'_>) {
        self.parts.clock.slice_start = context.now;
        self.parts.clock.turn = turn;
        context.memory.untouched(|memory| memory.set(CURRENT_THREAD, i32::from(turn.number())));
        if turn != SliceOwner::Primary {
            self.parts.servo.cache.invalidate(Invalidation::Thread);
        }
    }

    fn primary_slice(&mut self, context: &mut TickContext<'_>) {
        let parts = &mut self.parts;
        if parts.pc.is_heard && !self.scripts.is_in_command() {
            // As recorded, it comes before the text printed by programs in the same slice.
            if let Some(message) = parts.out.console.take_servo_message() {
                parts.send_line(message, context.now);
            }
            send_lines(parts, context.now);
        }
        let Parts { pc, servo, out, .. } = parts;
        for acts in [
            pc.disk.slice(context),
            limits::slice(servo, out, context.memory),
            host::slice(&mut pc.host, out, context),
        ] {
            if acts {
                servo.cache.invalidate(Invalidation::Anything);
            }
        }
        serial::slice(parts, context);
        self.scripts.slice(parts, context);
        self.store_queue_indices(context.memory);
    }

    fn follows_slices(&self) -> bool {
        self.parts.world.records_changes()
    }

    fn slice_ran(&mut self, thread: ThreadId, start: Cycles, end: Cycles, interrupted_at: Option<CodeAddr>) {
        self.parts.out.emit(start, EventKind::Trace(Record::Slice { thread, end, interrupted_at }));
    }

    fn follows_packets(&self, thread: Option<ThreadId>) -> bool {
        self.parts.world.records_packets(thread)
    }

    fn packet_ran(&mut self, packet: ExecutedPacket) {
        let ExecutedPacket { thread, at: address, start, cycles, text } = packet;
        self.parts.out.emit(start, EventKind::Trace(Record::Packet { thread, address, cycles, text }));
    }

    fn trapped(&mut self, trap: &Trap, context: &mut TickContext<'_>) {
        if trap.thread.is_none() {
            context.memory.set(USER_CALL_BACK, GuestAddr::NULL);
        }
        self.parts.out.emit(context.now, EventKind::Trap(trap.clone()));
    }

    fn stack_exceeded(&mut self, thread: ThreadId, used: u32) {
        let at = self.parts.clock.slice_start;
        self.parts.out.remark_of(at, Speaker::Thread(thread), None, Message::StackUsed { used });
    }

    fn quiet_ticks(&self, memory: &GuestMemory) -> u64 {
        let Parts {
            out,
            io,
            machine,
            servo,
            pc,
            world,
            calls,
            clock,
            timing: _,
            races: _,
            switches: _,
            level: _,
        } = &self.parts;
        let now = clock.tick_start;
        let is_quiet = servo.cache.is_settled()
            && out.console.is_idle()
            && !pc.usb.is_busy()
            && !self.scripts.has_experiment()
            && io.konnects.is_settled(memory)
            && kanalog::is_settled(&io.kanalog, &io.fpga, memory)
            && machine.is_settled()
            && !io.uart.is_sending()
            && !world.records_motion(io, now)
            && !calls.serial.is_busy(memory, &io.uart);
        if !is_quiet {
            return 0;
        }
        pc.host.quiet_ticks().min(world.quiet_ticks(out, now)).min(pc.disk.quiet_ticks(now))
    }

    fn quiet_slices(&self, memory: &GuestMemory) -> u64 {
        // The words that Konnect boards exchange are at addresses chosen by the program; everything else is in on-chip
        // RAM.
        let world = &self.parts.world;
        let is_seen = world.is_recording() || world.is_watching() || self.parts.io.konnects.has_any();
        if is_seen { 0 } else { self.quiet_ticks(memory) }
    }

    fn skip_ticks(&mut self, count: u64, context: &mut TickContext<'_>) {
        self.parts.clock.tick_start = context.now;
        store_time(context);
        self.parts.pc.host.skip(count);
        self.sample(context, count);
    }
}
