//! Remarks that depend on earlier or later calls.
//!
//! A level written to a pin that is still an input is correct if the pin becomes an output soon; a move called while
//! another one has just begun replaces it; a text is known to be too long by the arrays of the programs.

use std::sync::Arc;

use kmotiondef::firmware::Function;
use kmotiondef::variables::cell_name;
use kmotiondef::{Axes, AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId};
use vm::firmware::Caller;

use crate::out::{Message, Out};

/// The time for which a level may be written before its pin becomes an output: half a second.
const PATIENCE: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 2);
/// Levels that are followed at a time.
const MOST: usize = 64;
/// Never.
const NEVER: Cycles = Cycles::new(i64::MAX);

/// A named object of a program, an array perhaps.
#[derive(Clone, Debug)]
pub(crate) struct NamedObject {
    /// Its name.
    pub(crate) name: String,
    /// Its first address.
    pub(crate) start: u32,
    /// Its size in bytes.
    pub(crate) size: u32,
}

/// A level that was written to an input.
#[derive(Clone, Copy, Debug)]
struct Latch {
    bit: Bit,
    function: Function,
    thread: Option<ThreadId>,
    at: Option<CodeAddr>,
}

/// A motion that a program commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CommandedMotion {
    /// A move to a place.
    Move(f64),
    /// A move by a distance, to a place.
    MoveRel(f64, f64),
    /// A jog at a speed.
    Jog(f64),
}

/// The last motion of an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionCall {
    pub(crate) thread: ThreadId,
    pub(crate) at: Option<CodeAddr>,
    pub(crate) motion: CommandedMotion,
    /// Dest at the call, and its time.
    pub(crate) dest: f64,
    pub(crate) called: Cycles,
    /// The last time at which the thread had waited or polled anything, and the number of times it had done so.
    pub(crate) last_poll: Cycles,
    pub(crate) poll_count: u32,
    /// The number of polls of motions, and of anything except the time, before it; true once it has polled this one.
    pub(crate) motion_polls: u32,
    pub(crate) other_polls: u32,
    pub(crate) is_polled: bool,
}

/// The observations in progress.
#[derive(Clone, Debug)]
pub(crate) struct Notices {
    latches: Vec<Latch>,
    /// When the levels are checked.
    pub(crate) due: Cycles,
    moves: [Option<MotionCall>; Axes::MAX],
    /// The last call that printed.
    pub(crate) last_print: (Option<ThreadId>, Option<CodeAddr>),
    /// True if a call printed more than the board takes from one, so that lines end elsewhere.
    pub(crate) has_cut_text: bool,
    /// The thread that has begun a line of text and not ended it.
    line_of: Option<ThreadId>,
    /// The call-back in the last tick.
    pub(crate) call_back: GuestAddr,
    /// The named objects of the programs that are loaded.
    objects: [Arc<[NamedObject]>; ThreadId::MAX as usize],
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            latches: Vec::new(),
            due: NEVER,
            moves: Default::default(),
            last_print: (None, None),
            has_cut_text: false,
            line_of: None,
            call_back: GuestAddr::NULL,
            objects: std::array::from_fn(|_| Arc::from([])),
        }
    }
}

impl Notices {
    /// Notes that a thread prints; returns the other thread whose line is continued by that.
    pub(crate) fn record_print(
        &mut self,
        thread: Option<ThreadId>,
        at: Option<CodeAddr>,
        text: &[u8],
    ) -> Option<ThreadId> {
        self.last_print = (thread, at);
        let begun = self.line_of.filter(|begun| Some(*begun) != thread && !text.is_empty());
        if let Some(last) = text.last() {
            self.line_of = thread.filter(|_| *last != b'\n');
        }
        begun
    }

    /// A level is written to a pin that is an input.
    pub(crate) fn latch(&mut self, caller: &Caller<'_>, function: Function, bit: Bit) {
        if self.latches.len() < MOST && self.latches.iter().all(|latch| latch.bit != bit) {
            self.latches.push(Latch { bit, function, thread: caller.thread, at: caller.at });
            self.due = self.due.min(caller.now() + PATIENCE);
        }
    }

    /// Reports the levels whose pins are still inputs.
    pub(crate) fn report_pending(&mut self, out: &mut Out, now: Cycles, is_output: impl Fn(Bit) -> bool) {
        self.due = NEVER;
        for Latch { bit, function, thread, at } in std::mem::take(&mut self.latches) {
            if !is_output(bit) {
                out.remark_of(now, thread.into(), at, Message::StillAnInput { function, bit });
            }
        }
    }

    /// Notes that a motion of an axis is called, or ended for `None`; returns the previous one.
    pub(crate) fn record_motion(&mut self, axis: AxisId, called: Option<MotionCall>) -> Option<MotionCall> {
        std::mem::replace(&mut self.moves[axis.index()], called)
    }

    /// Notes that a thread polls the motion of an axis.
    pub(crate) fn record_poll(&mut self, thread: ThreadId, axis: AxisId) {
        if let Some(called) = &mut self.moves[axis.index()] {
            called.is_polled |= called.thread == thread;
        }
    }

    /// A program with these named objects is loaded.
    pub(crate) fn load(&mut self, thread: ThreadId, objects: Arc<[NamedObject]>) {
        self.objects[thread.index()] = objects;
    }

    /// The name in programs for the memory at an address, their own data included.
    pub(crate) fn name_of(&self, address: GuestAddr, size: u32) -> String {
        let mut objects = self.objects.iter().flat_map(|objects| objects.iter());
        let own = objects.find(|object| address.get().wrapping_sub(object.start) < object.size);
        own.map_or_else(
            || cell_name(address, size),
            |object| match address.get() - object.start {
                0 => object.name.clone(),
                offset => format!("{} + {offset}", object.name),
            },
        )
    }

    /// The object in which a range of bytes begins, if the range exceeds it.
    pub(crate) fn overrun(&self, to: GuestAddr, size: usize) -> Option<&NamedObject> {
        let begin = u64::from(to.get());
        let end = begin + size as u64;
        self.objects.iter().flat_map(|objects| objects.iter()).find(|object| {
            let (first, past) = (u64::from(object.start), u64::from(object.start) + u64::from(object.size));
            (first..past).contains(&begin) && end > past
        })
    }
}
