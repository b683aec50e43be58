//! The target: what a session controls.
//!
//! A [`Target`] is a board whose time somebody lets pass: the model on any engine ([`model`]), a firmware file that was
//! booted ([`booted`]), or a connected controller. Everything above it exists once: sessions, debugger, page and clients
//! ask a target what it can do ([`Target::can`]) and say by name what it cannot ([`Unsupported`]).
//!
//! ```text
//! any      one of several targets, chosen at run time
//! model    the modelled board
//! booted   the booted firmware
//! ```
//!
//! Time. A target has ticks. [`Target::step`] lets time pass up to the end of a tick: a simulated target runs, one whose
//! time passes by itself waits. Between two calls a simulated target is at rest; what is read of one that is not may be
//! stale, and may fail.

mod any;
mod booted;
mod model;

pub use any::{AnyTarget, ConnectedTarget, NoSnapshot};
pub use booted::{BootedFirmware, BootedTarget, FirmwareError};

use std::fmt::Debug;

use kmotiondef::{Axes, AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::standing::{UnfinishedThread, UsedAxis};
use runtime::stimulus::Stimulus;
use runtime::trace::{Item, Quantity, TraceRequest};
use runtime::{Event, OpenBox};
use vm::engine::{AccessRange, CallEnd, ContextId, FrameView, Hold};
use vm::scheduler::{SliceOwner, ThreadSet};
use vm::thread::ThreadState;

use crate::capability::{Capability, Unsupported};
use crate::error::SnapshotError;
use crate::{HostError, UserProgram};

/// Ticks that a line and its answer take on the wire, as recorded.
pub const EXCHANGE: u64 = 28;
/// Console lines that wait for a client; then the board waits too, or loses them.
pub const CONSOLE_LINES: usize = 1000;

/// The receiver of the events of a call.
pub type EventSink<'a> = &'a mut dyn FnMut(Event);

/// A target as it was at an instant.
pub trait TargetSnapshot: Debug {
    /// Number of the last tick that was over.
    fn tick(&self) -> Ticks;

    /// Returns whether a program held the tick in progress.
    fn is_held(&self) -> bool;

    /// Bytes of memory that this snapshot has besides those that it shares with `other`.
    fn bytes_beyond(&self, other: &Self) -> usize;
}

/// The eight bytes that a target reads from an address on; `None` without memory there.
fn word_of<T: Target + ?Sized>(target: &T, address: GuestAddr) -> Option<[u8; 8]> {
    let mut bytes = [0; 8];
    target.read(address, &mut bytes).ok()?;
    // Only where there is no memory nothing but zeros is read.
    (bytes != [0; 8] || target.is_mapped(address)).then_some(bytes)
}

/// A board under control.
///
/// Methods for something that not every target can do have a default: what a target without it does. Whoever calls them
/// asks [`can`](Self::can) first.
pub trait Target {
    /// The state at an instant.
    type Snapshot: TargetSnapshot;

    /// The target in words, such as "the firmware file".
    fn name(&self) -> &'static str;

    /// The axes of the board.
    fn axes(&self) -> Axes {
        Axes::default()
    }

    /// Returns whether it has a capability.
    fn can(&self, capability: Capability) -> bool;

    /// Returns nothing where it can, and otherwise the sentence that it cannot.
    ///
    /// # Errors
    /// [`Unsupported`].
    fn require(&self, capability: Capability) -> Result<(), Unsupported> {
        if self.can(capability) { Ok(()) } else { Err(Unsupported { target: self.name(), capability }) }
    }

    /// The reason why a connected target cannot be reached any more; `None` of one that can be.
    fn loss_reason(&self) -> Option<&str> {
        None
    }

    /// Number of the last tick that is over.
    fn tick(&self) -> Ticks;

    /// The present instant.
    fn now(&self) -> Cycles;

    /// Lets time pass to the end of the next tick in which something can happen, or of tick `limit`, whichever comes
    /// first; or to where a program is [held](Self::held). A target whose processor has stopped for good has reported
    /// that with an event, and lets the time pass in which nothing happens any more.
    fn step(&mut self, limit: Ticks, events: EventSink<'_>);

    /// Ends the run: sends what is still waiting, and checks what the stimulus expects at the end.
    fn finish(&mut self, events: EventSink<'_>);

    /// Returns whether no thread is active and nothing is in progress that a program has begun.
    fn has_ended(&self) -> bool;

    /// The owner of the processor in the last tick.
    fn turn(&self) -> SliceOwner;

    /// Loads a program into its thread, which is stopped first.
    ///
    /// # Errors
    /// Why it is refused; the program in the thread stays and continues.
    fn load(&mut self, program: &UserProgram) -> Result<(), HostError>;

    /// Names and lines of the program in a thread.
    fn debug(&self, thread: ThreadId) -> Option<&DebugInfo>;

    /// Starts a thread at its entry point, also if it is active.
    ///
    /// # Errors
    /// [`HostError::NotLoaded`].
    fn start(&mut self, thread: ThreadId) -> Result<(), HostError>;

    /// Stops a thread where it is.
    fn stop(&mut self, thread: ThreadId);

    /// Pauses a thread while the others run ([`Capability::Pauses`]).
    ///
    /// # Errors
    /// [`Unsupported`], or a connected target does not answer.
    fn pause(&mut self, thread: ThreadId) -> Result<(), HostError> {
        let _ = thread;
        Err(Unsupported { target: self.name(), capability: Capability::Pauses }.into())
    }

    /// Lets a paused thread continue ([`Capability::Pauses`]).
    ///
    /// # Errors
    /// As [`pause`](Self::pause).
    fn resume(&mut self, thread: ThreadId) -> Result<(), HostError> {
        let _ = thread;
        Err(Unsupported { target: self.name(), capability: Capability::Pauses }.into())
    }

    /// The state of a thread.
    fn thread(&self, thread: ThreadId) -> &ThreadState;

    /// The threads that are active.
    fn active(&self) -> ThreadSet {
        ThreadId::all().filter(|thread| self.thread(*thread).is_active()).collect()
    }

    /// The present instruction of a thread, then the calls that led there, innermost first; empty where unknown.
    fn backtrace(&self, thread: ThreadId) -> Vec<CodeAddr> {
        let _ = thread;
        Vec::new()
    }

    /// The instruction before which the servo interrupt has stopped a thread, where slices can end at any instruction; `None`
    /// of a thread that has ended its slice by a call, or whose statements are not split, and where unknown.
    fn interrupted_at(&self, thread: ThreadId) -> Option<CodeAddr> {
        let _ = thread;
        None
    }

    /// Bytes of its stack that a thread has used since its start; `None` where unknown.
    fn stack_used(&self, thread: ThreadId) -> Option<u32> {
        let _ = thread;
        None
    }

    /// The function of the firmware that has an address, where the firmware is code.
    fn firmware_function(&self, address: CodeAddr) -> Option<String> {
        let _ = address;
        None
    }

    /// Returns whether the program of a thread is code of the processor; `None` without a program.
    fn runs_processor_code(&self, thread: ThreadId) -> Option<bool>;

    /// Threads that have not ended, and what they wait for; empty where unknown.
    fn standing_threads(&self) -> Vec<UnfinishedThread> {
        Vec::new()
    }

    /// Axes that programs have used, and what they do; empty where unknown.
    fn standing_axes(&self) -> Vec<UsedAxis> {
        Vec::new()
    }

    /// The threads that have run on an engine that does not split statements in the fast form; empty where unknown.
    fn threads_that_ran(&self) -> Vec<ThreadId> {
        Vec::new()
    }

    /// Two threads that change the same cell by a load and a store, and the name of the cell; `None` where that is unknown.
    fn contended_cell(&self) -> Option<(ThreadId, ThreadId, String)> {
        None
    }

    /// Axes that execute a motion of their own, such as a jog that nobody ends; empty where unknown.
    fn moving(&self) -> Vec<AxisId> {
        Vec::new()
    }

    /// The place in memory of an address of the board's tables: a firmware file may keep its variables elsewhere.
    fn place_of(&self, address: GuestAddr) -> GuestAddr {
        address
    }

    /// Reads memory from an address on; where there is none, zeros.
    ///
    /// # Errors
    /// A connected target does not answer.
    fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Result<(), HostError>;

    /// Reads memory from an address on as far as it is known without an exchange: of a connected target what its last
    /// status record has, and elements of `persist.UserData` that are at most about a second old. `None` where a byte is
    /// unknown.
    fn peek(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()> {
        self.read(address, bytes).ok()
    }

    /// Returns whether there is memory or a register at an address.
    fn is_mapped(&self, address: GuestAddr) -> bool {
        let _ = address;
        true
    }

    /// The eight bytes from an address on, for expressions that are evaluated every tick; `None` without memory there.
    fn word(&self, address: GuestAddr) -> Option<[u8; 8]> {
        word_of(self, address)
    }

    /// Reads the status record of a connected target: what was known before is out of date.
    fn refresh(&mut self) {}

    /// Writes memory from an address on.
    ///
    /// # Errors
    /// [`HostError::Unmapped`], or a connected target does not answer.
    fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError>;

    /// Returns whether an item exists on this target.
    fn has_item(&self, item: Item) -> bool {
        let _ = item;
        true
    }

    /// The present value of an item, such as `bit46`; not a number where it cannot be read.
    fn value(&self, item: Item) -> f64;

    /// The level of a bit.
    fn bit(&self, bit: Bit) -> bool {
        self.value(Item::of_bit(bit)) != 0.0
    }

    /// Bytes from the PC arrive on the link.
    fn receive(&mut self, bytes: &[u8]);

    /// Returns whether bytes from the PC wait to be taken.
    fn is_receiving(&self) -> bool;

    /// Returns whether the latest bytes may still be answered.
    fn is_answering(&self) -> bool {
        self.is_receiving()
    }

    /// Ticks that a line and its answer take at least.
    fn exchange_ticks(&self) -> u64;

    /// Returns whether a command waits for its data lines, so that the next line is one.
    fn is_in_command(&self) -> bool;

    /// Says whether the PC takes console lines.
    fn listen(&mut self, listens: bool);

    /// The lines that programs have printed and the board has not sent yet, oldest first; empty where unknown.
    fn unsent_lines(&self) -> Vec<Vec<u8>> {
        Vec::new()
    }

    /// Keeps from now on the bytes that the board sends over its link, for a PC that is elsewhere.
    fn tap_wire(&mut self);

    /// Takes the bytes of the link since the last call.
    fn take_wire(&mut self) -> Vec<u8>;

    /// Returns the contents of flash memory, if they can be read.
    fn flash(&self) -> Option<&[u8]> {
        None
    }

    /// Lets the world around the board act by a stimulus ([`Capability::Surroundings`]).
    fn play(&mut self, stimulus: Stimulus) {
        let _ = stimulus;
    }

    /// Drives an input from outside ([`Capability::Surroundings`]).
    fn drive_input(&mut self, bit: Bit, level: bool) {
        let _ = (bit, level);
    }

    /// Puts characters on the line to the serial port ([`Capability::Surroundings`]).
    fn send_to_uart(&mut self, bytes: &[u8]) {
        let _ = bytes;
    }

    /// Characters on that line that have not arrived yet.
    fn uart_backlog(&self) -> usize {
        0
    }

    /// Records from now on what is requested; the records come as events ([`Capability::Recordings`]), those of a connected
    /// target at the end of the run.
    fn record(&mut self, request: TraceRequest) {
        let _ = request;
    }

    /// Samples variables by itself from now on, or no longer if there are none ([`Capability::FastSamples`]); returns how many
    /// times a second.
    ///
    /// # Errors
    /// [`Unsupported`], nothing of it is a variable, or a connected target does not take it.
    fn sample(&mut self, quantities: Vec<Quantity>) -> Result<f64, HostError> {
        let _ = quantities;
        Err(Unsupported { target: self.name(), capability: Capability::FastSamples }.into())
    }

    /// Takes the samples since the last call, each with its tick; a value that is unknown there is not a number. `None` of a
    /// target that does not sample by itself.
    fn take_samples(&mut self) -> Option<Vec<(Ticks, Vec<f64>)>> {
        None
    }

    /// The box that a program has opened on the PC and that waits for an answer.
    fn open_box(&self) -> Option<OpenBox> {
        None
    }

    /// Gives the PC of a connected target its next answer, such as `msgbox=ok`; that of a simulated one gets it by a
    /// statement of a stimulus.
    ///
    /// # Errors
    /// The answer is wrong.
    fn answer(&mut self, setting: &str) -> Result<(), HostError> {
        let _ = setting;
        Err(Unsupported { target: self.name(), capability: Capability::Answers }.into())
    }

    /// The target as it is ([`Capability::Snapshots`]).
    ///
    /// # Errors
    /// [`SnapshotError::Unsupported`].
    fn snapshot(&mut self) -> Result<Self::Snapshot, SnapshotError>;

    /// Makes the target what it was when `snapshot` was taken ([`Capability::Snapshots`]).
    ///
    /// # Errors
    /// The snapshot is of another target; nothing has changed then.
    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), SnapshotError>;

    /// A measure of what the computer has done so far, about the number of executed instructions, from which a timeline
    /// decides when a snapshot is due.
    fn work(&self) -> u64 {
        self.tick().get()
    }

    /// Prepares it for a debugger ([`Capability::Breakpoints`]): follows calls in progress from now on.
    fn prepare_to_hold(&mut self) {}

    /// Whose program holds the tick in progress, and the instant; `None` between two ticks.
    fn held(&self) -> Option<(ContextId, Cycles)> {
        None
    }

    /// Holds programs before these instructions, and before no others ([`Capability::Breakpoints`]).
    fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        let _ = addresses;
    }

    /// Holds a context after each instruction, the next one included ([`Capability::Breakpoints`]); `None` none.
    fn set_stepping(&mut self, context: Option<ContextId>) {
        let _ = context;
    }

    /// Holds programs after these bytes, addresses and how many, have changed, and after no others
    /// ([`Capability::Watchpoints`]).
    fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        let _ = ranges;
    }

    /// Holds programs after instructions that access these bytes, and after no others
    /// ([`Capability::AccessWatchpoints`]).
    fn set_accessed(&mut self, ranges: &[AccessRange]) {
        let _ = ranges;
    }

    /// Returns which of the watched bytes have changed, once.
    fn take_change(&mut self) -> Option<usize> {
        None
    }

    /// Returns which context was held last, and why, once.
    fn take_hold(&mut self) -> Option<Hold> {
        None
    }

    /// The calls in progress of a context, innermost first.
    fn frames(&self, context: ContextId) -> Vec<FrameView> {
        let _ = context;
        Vec::new()
    }

    /// Sets a register of a call in progress, the innermost of which is number 0; whether there is such a register.
    fn set_register(&mut self, context: ContextId, frame: usize, register: u16, slot: u64) -> bool {
        let _ = (context, frame, register, slot);
        false
    }

    /// The slot of the result of the call from which a context has returned last; `None` where that is unknown.
    fn result(&self, context: ContextId) -> Option<u64> {
        let _ = context;
        None
    }

    /// Calls a function of a program or of the firmware in a context, with the arguments each as a slot; the board stands
    /// meanwhile ([`Capability::Calls`]).
    fn call_function(&mut self, context: ContextId, function: GuestAddr, arguments: &[u64]) -> CallEnd {
        let _ = (context, function, arguments);
        CallEnd::Unsupported
    }

    /// The text of the instruction, or of the packet, at an address, and how many bytes it has; `None` where no program
    /// is.
    fn disassemble(&self, address: u32) -> Option<(String, u32)> {
        let _ = address;
        None
    }

    /// The registers of the processor by name, where the target is one; empty otherwise.
    fn registers(&self) -> Vec<(String, u32)> {
        Vec::new()
    }
}
