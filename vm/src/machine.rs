//! The machine: memory, threads, programs, an engine, the firmware, and the tick that ties them.
//!
//! Tick `k` begins `k` times 90 µs after power-up with the servo interrupt: the call-back, the kernel's work, the
//! choice of the next thread. The rest of the tick is that thread's slice. Rules: threads-and-time.md of the
//! specification.

mod called;
mod engines;
mod held;
mod lateness;
mod long;
mod snapshot;

use std::sync::Arc;

use kmotiondef::map::BOARD_STACK_SIZE;
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};

use self::engines::Engines;
use self::held::HoldPoint;
pub use self::snapshot::Snapshot;
use crate::dsp::{DspEngine, HotCode};
use crate::engine::{ContextId, Engine, ObservedAccesses, Polling, Preemption, Slice, Stop};
use crate::firmware::{Firmware, TickContext};
use crate::interp::BytecodeEngine;
use crate::loaded::LoadedCode;
use crate::memory::{FaultPolicy, GuestMemory};
use crate::program::Program;
use crate::scheduler::{self, SliceOwner, ThreadSet};
use crate::thread::{NotLoaded, Progress, ThreadState, Threads};
use crate::trap::{Trap, TrapKind};
use crate::wake::Wake;

/// Bytes of the board's stacks that a program can use: each interrupt takes 128 of the 2048.
pub const BOARD_STACK_USABLE: u32 = BOARD_STACK_SIZE - 128;

/// The limit of ticks for a call-back, after which it counts as endless; the board would stop.
const CALLBACK_TICKS: i64 = 100;
/// The host's work for a tick besides running programs, in program cycles that take the same time.
const TICK_WORK: u64 = 500;

const CALLBACK_LIMIT: Cycles = Cycles::new(CALLBACK_TICKS * Cycles::PER_TICK.get());

/// Settings of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// The cycles that the servo interrupt takes of each tick; `None` for the firmware's own figure.
    pub servo: Option<Cycles>,
    /// True if time in which nothing can happen is skipped; this never changes a result.
    pub shortcuts: bool,
    /// Stacks as small as the board's.
    pub strict_stack: bool,
    /// The effect of accesses that a program should not make.
    pub faults: FaultPolicy,
    /// The points at which threads that run bytecode lose the processor.
    pub preemption: Preemption,
    /// The accesses of bytecode to memory that threads can share which are reported to the firmware.
    pub observed: ObservedAccesses,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            servo: None,
            shortcuts: true,
            strict_stack: false,
            faults: FaultPolicy::Trap,
            preemption: Preemption::Segments,
            observed: ObservedAccesses::None,
        }
    }
}

/// A board without its firmware: it runs programs in ticks.
#[derive(Debug)]
pub struct Machine<F, E = BytecodeEngine> {
    config: Config,
    memory: GuestMemory,
    threads: Threads,
    loaded: [Option<LoadedCode>; ThreadId::MAX as usize],
    /// By thread, the most cycles that its code spends between two tests of the budget.
    longest_steps: [Cycles; ThreadId::MAX as usize],
    engines: Engines<E>,
    firmware: F,
    tick: Ticks,
    turn: SliceOwner,
    stack_reported: ThreadSet,
    /// The tick in progress, if a debugger holds it.
    held: Option<HoldPoint>,
    work: u64,
    /// The cycles by which the last slice has run beyond its end, in the delay slots of a branch.
    shadow: Option<Cycles>,
}

/// The span of one tick that a thread may use.
#[derive(Clone, Copy, Debug)]
struct Window {
    start: Cycles,
    end: Cycles,
    /// How many cycles of the tick the call-back took.
    callback: Cycles,
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// A machine at power-up.
    pub fn new(firmware: F, config: Config) -> Self {
        Self::with_engine(firmware, config, E::default())
    }

    /// A machine at power-up that runs bytecode on `engine`.
    pub fn with_engine(firmware: F, config: Config, engine: E) -> Self {
        let mut memory = GuestMemory::new();
        memory.set_faults(config.faults);
        // A constant, so that a machine that never translates does not contain a code generator.
        let hot = if E::TRANSLATES { HotCode::HERE } else { None };
        let mut engine = engine;
        engine.set_preemption(config.preemption);
        engine.observe(config.observed);
        Self {
            config,
            memory,
            threads: Threads::new(),
            loaded: Default::default(),
            longest_steps: Default::default(),
            engines: Engines {
                programs: engine,
                images: DspEngine::new(hot, E::KEEPS_ACCOUNT),
                ran: ThreadSet::EMPTY,
            },
            firmware,
            tick: Ticks::default(),
            turn: SliceOwner::Primary,
            stack_reported: ThreadSet::EMPTY,
            held: None,
            work: 0,
            shadow: None,
        }
    }

    /// Makes `thread` ready to run `program` from `entry`, and replaces its previous program.
    ///
    /// The program's bytes are in guest memory already; its text is protected from now on.
    pub fn load_program(&mut self, thread: ThreadId, program: impl Into<Arc<Program>>, entry: GuestAddr) {
        self.load(thread, LoadedCode::Program(program.into()), entry);
    }

    /// Loads code of any engine.
    pub fn load(&mut self, thread: ThreadId, loaded: LoadedCode, entry: GuestAddr) {
        self.memory.protect(thread, loaded.text());
        self.longest_steps[thread.index()] = loaded.longest_step(&|function| self.firmware.pure(function));
        self.loaded[thread.index()] = Some(loaded);
        self.stack_reported = self.stack_reported.without(thread);
        self.threads.set_entry(thread, entry);
    }

    /// Makes `thread` empty.
    pub fn unload_program(&mut self, thread: ThreadId) {
        self.memory.unprotect(thread);
        self.loaded[thread.index()] = None;
        self.threads.clear(thread);
    }

    /// Starts `thread` at its entry point.
    ///
    /// # Errors
    /// [`NotLoaded`] for an empty thread.
    pub fn start(&mut self, thread: ThreadId) -> Result<(), NotLoaded> {
        self.threads.start(thread)
    }

    /// The program loaded in `thread`; `None` also if the program is not bytecode.
    #[must_use]
    pub fn program(&self, thread: ThreadId) -> Option<&Program> {
        Some(self.loaded(thread)?.program()?)
    }

    /// The code that is loaded in `thread`.
    #[must_use]
    pub fn loaded(&self, thread: ThreadId) -> Option<&LoadedCode> {
        self.loaded[thread.index()].as_ref()
    }

    /// The position of `thread`: its instruction, then the calls that led to it, innermost first.
    #[must_use]
    pub fn backtrace(&self, thread: ThreadId) -> Vec<CodeAddr> {
        let id = ContextId::of(thread);
        self.loaded(thread).map(|loaded| self.engines.backtrace(id, loaded)).unwrap_or_default()
    }

    /// The instruction before which the servo interrupt has stopped an active thread whose slices can end at any instruction.
    #[must_use]
    pub fn interrupted_at(&self, thread: ThreadId) -> Option<CodeAddr> {
        let is_going = matches!(self.threads.state(thread), ThreadState::Active(Progress::Going));
        let is_interrupted = is_going && self.splits_statements(thread);
        if is_interrupted { self.backtrace(thread).first().copied() } else { None }
    }

    /// Returns whether slices of a thread can end at any instruction: in code of the processor, and in bytecode with
    /// [`Preemption::Instructions`].
    fn splits_statements(&self, thread: ThreadId) -> bool {
        match self.loaded(thread) {
            Some(LoadedCode::Program(_)) => self.config.preemption == Preemption::Instructions,
            Some(LoadedCode::Image(_)) => true,
            None => false,
        }
    }

    /// The engine of bytecode.
    #[must_use]
    pub const fn engine(&self) -> &E {
        &self.engines.programs
    }

    /// The engine of bytecode, to set where it holds.
    pub const fn engine_mut(&mut self) -> &mut E {
        &mut self.engines.programs
    }

    /// The engine of real images.
    #[must_use]
    pub const fn images(&self) -> &DspEngine {
        &self.engines.images
    }

    /// The threads that have run bytecode since power-up; no snapshot sets that back.
    #[must_use]
    pub const fn ran(&self) -> ThreadSet {
        self.engines.ran
    }

    /// Guest memory.
    #[must_use]
    pub const fn memory(&self) -> &GuestMemory {
        &self.memory
    }

    /// Guest memory, to change it from outside.
    pub const fn memory_mut(&mut self) -> &mut GuestMemory {
        &mut self.memory
    }

    /// The seven threads.
    #[must_use]
    pub const fn threads(&self) -> &Threads {
        &self.threads
    }

    /// The seven threads, to start, pause and resume them from outside.
    pub const fn threads_mut(&mut self) -> &mut Threads {
        &mut self.threads
    }

    /// The firmware.
    #[must_use]
    pub const fn firmware(&self) -> &F {
        &self.firmware
    }

    /// The firmware together with its tick context, for requests from outside between two ticks.
    pub fn firmware_mut(&mut self) -> (&mut F, TickContext<'_>) {
        let now = end_of(self.tick);
        (
            &mut self.firmware,
            TickContext { memory: &mut self.memory, threads: &mut self.threads, tick: self.tick, now },
        )
    }

    /// The thread that had the slice of the last tick.
    #[must_use]
    pub const fn turn(&self) -> SliceOwner {
        self.turn
    }

    /// Number of servo interrupts since power-up.
    #[must_use]
    pub const fn tick(&self) -> Ticks {
        self.tick
    }

    /// Runs to the end of tick `target`.
    pub fn run_until(&mut self, target: Ticks) {
        while self.tick < target {
            self.step(target);
        }
    }

    /// Runs to the end of the next tick in which something can happen, or of tick `limit`, whichever
    /// comes first.
    ///
    /// A tick that is [held](Self::held) is continued regardless of the limit.
    pub fn step(&mut self, limit: Ticks) {
        if self.held.is_some() {
            return self.run_tick();
        }
        if self.config.shortcuts {
            self.skip_quiet_ticks(limit);
            if self.run_long_slice(limit) {
                return;
            }
        }
        if self.tick < limit {
            self.run_tick();
        }
    }

    /// Runs one tick, or the rest of one that is [held](Self::held).
    pub fn run_tick(&mut self) {
        if let Some(held) = self.held.take() {
            return self.go_on(held);
        }
        self.tick = self.tick.next();
        self.work += TICK_WORK;
        let begin = start_of(self.tick);
        if let Some(spent) = self.run_callback(begin) {
            self.after_callback(begin, spent);
        }
    }

    /// Executes the rest of the tick that begins at `begin`, after the call-back.
    fn after_callback(&mut self, begin: Cycles, callback: Cycles) {
        self.with_context(begin, |firmware, context| firmware.tick(context));
        self.turn = scheduler::next(self.threads.active(), self.turn);
        let end = end_of(self.tick);
        let start = begin + self.servo_time() + self.take_lateness();
        let window = Window { start: start.min(end), end, callback };
        let turn = self.turn;
        self.with_context(window.start + callback, |firmware, context| {
            firmware.switch_to(turn, context);
            if turn == SliceOwner::Primary {
                firmware.primary_slice(context);
            }
        });
        if let SliceOwner::User(thread) = turn {
            self.user_slice(thread, window);
        }
    }

    /// The cycles that the servo interrupt takes of the present tick.
    fn servo_time(&self) -> Cycles {
        self.config.servo.unwrap_or_else(|| self.firmware.servo_time(&self.memory))
    }

    /// Runs the call-back, if there is one, and returns the cycles it spent; `None` if it is held.
    fn run_callback(&mut self, begin: Cycles) -> Option<Cycles> {
        let address = self.firmware.callback(&self.memory);
        if address.is_null() {
            return Some(Cycles::default());
        }
        let id = ContextId::CALLBACK;
        let found = self.loaded.iter().flatten().find(|loaded| loaded.has_function(address));
        let started = found.ok_or(TrapKind::BadCallTarget { addr: address }).and_then(|loaded| {
            let stack = id.stack_in(self.memory.map(), self.config.strict_stack);
            self.engines.start(id, loaded, address, stack, &self.firmware)
        });
        if let Err(kind) = started {
            self.report_trap(begin, Trap::new(kind, code_at(address), None));
            return Some(Cycles::default());
        }
        self.resume_callback(address, begin, CALLBACK_LIMIT)
    }

    /// Runs the call-back at `address` until it returns; yields the cycles it has spent, `None` if it is held.
    fn resume_callback(&mut self, address: GuestAddr, begin: Cycles, budget: Cycles) -> Option<Cycles> {
        let id = ContextId::CALLBACK;
        let loaded = self.loaded.iter().flatten().find(|loaded| loaded.has_function(address))?;
        let mut slice = Slice {
            memory: &mut self.memory,
            threads: &mut self.threads,
            firmware: &mut self.firmware,
            tick: self.tick,
            start: begin,
            length: CALLBACK_LIMIT,
            budget,
            woken: None,
            is_long: false,
            polling: Polling::new(self.config.shortcuts),
        };
        let stop = self.engines.resume(id, loaded, &mut slice);
        let (left, spent) = (slice.budget, slice.length - slice.budget);
        self.work += (budget - left - slice.polling.passed()).get().unsigned_abs();
        let kind = match stop {
            Stop::Ended => {
                self.with_context(begin, |firmware, context| firmware.callback_returned(context, spent));
                return Some(spent);
            }
            Stop::Held => {
                self.held = Some(HoldPoint::Callback { address, begin, left });
                return None;
            }
            Stop::Trapped(trap) => {
                self.report_trap(begin, trap);
                return Some(spent);
            }
            Stop::Waiting(_) => TrapKind::CallbackWaits,
            Stop::Preempted | Stop::NeedsBoard => TrapKind::CallbackEndless { limit: CALLBACK_TICKS },
        };
        let at = self.engines.backtrace(id, loaded).first().copied().unwrap_or_else(|| code_at(address));
        self.report_trap(begin, Trap::new(kind, at, None));
        Some(spent)
    }

    /// Gives `thread` the rest of the tick.
    fn user_slice(&mut self, thread: ThreadId, window: Window) {
        let ThreadState::Active(progress) = *self.threads.state(thread) else {
            return;
        };
        let available = window.end - window.start - window.callback;
        let debt = self.threads.overdraft(thread);
        if available <= debt {
            // The last block of the previous slice, or the call-back, takes all of this slice, too.
            self.threads.set_debt(thread, debt - available.max(Cycles::default()));
            return;
        }
        self.threads.set_debt(thread, Cycles::default());
        let budget = available - debt;
        let (budget, woken) = match progress {
            Progress::Idle => return,
            Progress::Fresh => match self.start_context(thread) {
                Ok(()) => (budget, None),
                Err(trap) => return self.fault(window.start, thread, trap),
            },
            Progress::Going => (budget, None),
            Progress::Waiting(wake @ (Wake::NextSlice | Wake::Retry)) => (budget, Some(wake)),
            Progress::Waiting(Wake::At(time)) if time >= window.end => return,
            Progress::Waiting(wake @ Wake::At(time)) => (budget.min(window.end - time), Some(wake)),
        };
        self.run_thread(thread, window, budget, woken);
    }

    /// Gives `thread` a fresh context at its entry point.
    fn start_context(&mut self, thread: ThreadId) -> Result<(), Trap> {
        let entry = self.threads.entry(thread);
        let id = ContextId::of(thread);
        let stack = id.stack_in(self.memory.map(), self.config.strict_stack);
        let loaded = self.loaded[thread.index()].as_ref();
        loaded
            .ok_or(TrapKind::BadCallTarget { addr: entry })
            .and_then(|loaded| self.engines.start(id, loaded, entry, stack, &self.firmware))
            .map_err(|kind| Trap::new(kind, code_at(entry), Some(thread)))?;
        let now = start_of(self.tick);
        self.with_context(now, |firmware, context| firmware.begins(thread, context));
        Ok(())
    }

    /// Runs `thread` until it stops for this slice.
    fn run_thread(&mut self, thread: ThreadId, window: Window, budget: Cycles, woken: Option<Wake>) {
        let Some(loaded) = self.loaded[thread.index()].as_ref() else {
            return;
        };
        let id = ContextId::of(thread);
        self.threads.set_running(Some(thread));
        let mut slice = Slice {
            memory: &mut self.memory,
            threads: &mut self.threads,
            firmware: &mut self.firmware,
            tick: self.tick,
            start: window.start,
            length: window.end - window.start,
            budget,
            woken,
            is_long: false,
            polling: Polling::new(self.config.shortcuts),
        };
        let stop = loop {
            let stop = self.engines.resume(id, loaded, &mut slice);
            let Stop::Waiting(wake @ Wake::At(time)) = stop else {
                break stop;
            };
            if time >= window.end || slice.budget <= Cycles::default() {
                break stop;
            }
            // At least one cycle, so that a call which waits for the past ends some time.
            slice.budget = (slice.budget - Cycles::new(1)).min(window.end - time);
            slice.woken = Some(wake);
        };
        let (left, woken) = (slice.budget, slice.woken);
        self.work += (budget - left - slice.polling.passed()).get().unsigned_abs();
        self.threads.set_running(None);
        if stop == Stop::Held {
            self.held = Some(HoldPoint::Slice { thread, window, left, woken });
        }
        if self.firmware.follows_slices() {
            let is_interrupted = stop == Stop::Preempted && self.splits_statements(thread);
            let at = if is_interrupted { self.backtrace(thread).first().copied() } else { None };
            self.firmware.slice_ran(thread, window.end - budget, window.end - left, at);
        }
        match (stop, woken) {
            // Its call keeps waiting until the instruction is executed.
            (Stop::Held, Some(wake)) => {
                self.threads.set_state(thread, ThreadState::Active(Progress::Waiting(wake)));
            }
            (stop, _) => self.stopped(thread, window.end, left, stop),
        }
        if self.held.is_none() && self.threads.take_pausing() {
            self.threads.pause(thread);
        }
    }

    /// Notes how `thread` has stopped in the slice that ends at `end`, with `left` of its budget.
    fn stopped(&mut self, thread: ThreadId, end: Cycles, left: Cycles, stop: Stop) {
        let debt = self.overdrawn(&stop, (Cycles::default() - left).max(Cycles::default()));
        self.threads.set_debt(thread, debt);
        self.report_stack(thread);
        match stop {
            Stop::Preempted | Stop::NeedsBoard | Stop::Held => {
                self.threads.set_state(thread, ThreadState::Active(Progress::Going));
            }
            Stop::Waiting(wake) => {
                self.threads.set_state(thread, ThreadState::Active(Progress::Waiting(wake)));
            }
            Stop::Ended => self.threads.set_state(thread, ThreadState::Ready),
            Stop::Trapped(trap) => self.fault(end - left, thread, trap),
        }
    }

    /// The most bytes of its stack that a thread has had in use since it was started.
    #[must_use]
    pub fn stack_used(&self, thread: ThreadId) -> u32 {
        let loaded = self.loaded[thread.index()].as_ref();
        loaded.map_or(0, |loaded| self.engines.stack_used(ContextId::of(thread), loaded))
    }

    /// Tells the firmware when a thread's stack first holds more than the board's could.
    fn report_stack(&mut self, thread: ThreadId) {
        let used = self.stack_used(thread);
        if used > BOARD_STACK_USABLE && !self.stack_reported.contains(thread) {
            self.stack_reported = self.stack_reported.with(thread);
            self.firmware.stack_exceeded(thread, used);
        }
    }

    fn fault(&mut self, now: Cycles, thread: ThreadId, trap: Trap) {
        self.threads.set_state(thread, ThreadState::Faulted(trap.clone()));
        self.report_trap(now, trap);
    }

    fn report_trap(&mut self, now: Cycles, trap: Trap) {
        self.with_context(now, |firmware, context| firmware.trapped(&trap, context));
    }

    /// Skips ticks in which no thread can run and the firmware has nothing to do.
    fn skip_quiet_ticks(&mut self, limit: Ticks) {
        if !self.firmware.callback(&self.memory).is_null() {
            return;
        }
        let idle = self.idle_ticks();
        if idle == 0 {
            return;
        }
        let count = idle
            .min(limit.get().saturating_sub(self.tick.get()))
            .min(self.firmware.quiet_ticks(&self.memory));
        if count > 0 {
            self.pass_ticks(count);
        }
    }

    /// Lets ticks pass in which the firmware has nothing to do, up to the beginning of a slice.
    fn pass_ticks(&mut self, count: u64) {
        self.tick = Ticks::new(self.tick.get() + count);
        self.turn = scheduler::after(self.threads.active(), self.turn, count);
        let begin = start_of(self.tick);
        let turn = self.turn;
        self.with_context(begin, |firmware, context| firmware.skip_ticks(count, context));
        if count > 1 {
            self.shadow = None;
        }
        let start = begin + self.servo_time() + self.take_lateness();
        self.with_context(start, |firmware, context| firmware.switch_to(turn, context));
    }

    /// Number of the next ticks in which no user thread can run.
    fn idle_ticks(&self) -> u64 {
        let next = self.tick.get() + 1;
        ThreadId::all()
            .map(|thread| match *self.threads.state(thread) {
                ThreadState::Active(_) if self.threads.overdraft(thread) > Cycles::default() => 0,
                ThreadState::Active(Progress::Waiting(Wake::At(time))) => {
                    let tick = time.get() / Cycles::PER_TICK.get();
                    u64::try_from(tick).unwrap_or(0).saturating_sub(next)
                }
                ThreadState::Active(Progress::Fresh | Progress::Going | Progress::Waiting(_)) => 0,
                _ => u64::MAX,
            })
            .min()
            .unwrap_or(u64::MAX)
    }

    fn with_context(&mut self, now: Cycles, work: impl FnOnce(&mut F, &mut TickContext<'_>)) {
        let mut context =
            TickContext { memory: &mut self.memory, threads: &mut self.threads, tick: self.tick, now };
        work(&mut self.firmware, &mut context);
    }
}

/// The beginning of a tick.
fn start_of(tick: Ticks) -> Cycles {
    let tick = i64::try_from(tick.get()).unwrap_or(i64::MAX);
    Cycles::new(tick.saturating_mul(Cycles::PER_TICK.get()))
}

/// The end of a tick.
fn end_of(tick: Ticks) -> Cycles {
    start_of(tick) + Cycles::PER_TICK
}

/// The code address for an unchecked address, rounded down to a multiple of 4.
fn code_at(addr: GuestAddr) -> CodeAddr {
    CodeAddr::new(addr.get() & !3).expect("it is made a multiple of 4")
}

#[cfg(test)]
mod tests;
