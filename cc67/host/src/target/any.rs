//! One of several targets, chosen at run time: for views that are built once for all of them.

use std::fmt::Debug;

use kmotiondef::{Axes, AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::standing::{UnfinishedThread, UsedAxis};
use runtime::stimulus::Stimulus;
use runtime::trace::{Item, Quantity, TraceRequest};
use runtime::{Board, OpenBox};
use vm::engine::{AccessRange, CallEnd, ContextId, FrameView, Hold};
use vm::scheduler::{SliceOwner, ThreadSet};
use vm::thread::ThreadState;

use super::{BootedTarget, EventSink, Target, TargetSnapshot};
use crate::capability::Capability;
use crate::error::SnapshotError;
use crate::{HostError, UserProgram};

/// A target of any kind.
#[derive(Debug)]
pub enum AnyTarget {
    /// The modelled board on the interpreter.
    Model(Box<Board>),
    /// A firmware file.
    Booted(Box<BootedTarget>),
    /// A connected controller.
    Connected(Box<dyn ConnectedTarget>),
}

/// A target without snapshots, such as a connected controller.
pub trait ConnectedTarget: Target<Snapshot = NoSnapshot> + Debug + Send {}

impl<T: Target<Snapshot = NoSnapshot> + Debug + Send> ConnectedTarget for T {}

/// The state of a target that has no snapshots: there is none.
#[derive(Clone, Copy, Debug)]
pub enum NoSnapshot {}

impl TargetSnapshot for NoSnapshot {
    fn tick(&self) -> Ticks {
        match *self {}
    }

    fn is_held(&self) -> bool {
        match *self {}
    }

    fn bytes_beyond(&self, _: &Self) -> usize {
        match *self {}
    }
}

/// The state of an [`AnyTarget`] at an instant.
#[derive(Debug)]
pub enum AnySnapshot {
    /// Of the modelled board.
    Model(Box<<Board as Target>::Snapshot>),
    /// Of a firmware file.
    Booted(Box<<BootedTarget as Target>::Snapshot>),
}

/// Calls a method of the target inside.
macro_rules! with {
    ($any:expr, $it:ident => $body:expr) => {
        match $any {
            AnyTarget::Model($it) => $body,
            AnyTarget::Booted($it) => $body,
            AnyTarget::Connected($it) => $body,
        }
    };
}

impl TargetSnapshot for AnySnapshot {
    fn tick(&self) -> Ticks {
        match self {
            Self::Model(it) => TargetSnapshot::tick(it.as_ref()),
            Self::Booted(it) => TargetSnapshot::tick(it.as_ref()),
        }
    }

    fn is_held(&self) -> bool {
        match self {
            Self::Model(it) => TargetSnapshot::is_held(it.as_ref()),
            Self::Booted(it) => TargetSnapshot::is_held(it.as_ref()),
        }
    }

    fn bytes_beyond(&self, other: &Self) -> usize {
        match (self, other) {
            (Self::Model(one), Self::Model(other)) => TargetSnapshot::bytes_beyond(one.as_ref(), other),
            (Self::Booted(one), Self::Booted(other)) => TargetSnapshot::bytes_beyond(one.as_ref(), other),
            (Self::Model(_) | Self::Booted(_), _) => 0,
        }
    }
}

/// Methods that are those of whichever it is.
macro_rules! delegate {
    ($(fn $name:ident(&self $(, $argument:ident: $ty:ty)*) $(-> $result:ty)?;)*) => {$(
        #[inline]
        fn $name(&self $(, $argument: $ty)*) $(-> $result)? {
            with!(self, it => Target::$name(it.as_ref() $(, $argument)*))
        }
    )*};
    (mut $(fn $name:ident(&mut self $(, $argument:ident: $ty:ty)*) $(-> $result:ty)?;)*) => {$(
        fn $name(&mut self $(, $argument: $ty)*) $(-> $result)? {
            with!(self, it => Target::$name(it.as_mut() $(, $argument)*))
        }
    )*};
}

impl Target for AnyTarget {
    type Snapshot = AnySnapshot;

    delegate! {
        fn name(&self) -> &'static str;
        fn axes(&self) -> Axes;
        fn loss_reason(&self) -> Option<&str>;
        fn can(&self, capability: Capability) -> bool;
        fn tick(&self) -> Ticks;
        fn now(&self) -> Cycles;
        fn has_ended(&self) -> bool;
        fn turn(&self) -> SliceOwner;
        fn debug(&self, thread: ThreadId) -> Option<&DebugInfo>;
        fn thread(&self, thread: ThreadId) -> &ThreadState;
        fn active(&self) -> ThreadSet;
        fn backtrace(&self, thread: ThreadId) -> Vec<CodeAddr>;
        fn interrupted_at(&self, thread: ThreadId) -> Option<CodeAddr>;
        fn stack_used(&self, thread: ThreadId) -> Option<u32>;
        fn firmware_function(&self, address: CodeAddr) -> Option<String>;
        fn runs_processor_code(&self, thread: ThreadId) -> Option<bool>;
        fn standing_threads(&self) -> Vec<UnfinishedThread>;
        fn standing_axes(&self) -> Vec<UsedAxis>;
        fn threads_that_ran(&self) -> Vec<ThreadId>;
        fn contended_cell(&self) -> Option<(ThreadId, ThreadId, String)>;
        fn moving(&self) -> Vec<AxisId>;
        fn place_of(&self, address: GuestAddr) -> GuestAddr;
        fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Result<(), HostError>;
        fn peek(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()>;
        fn is_mapped(&self, address: GuestAddr) -> bool;
        fn word(&self, address: GuestAddr) -> Option<[u8; 8]>;
        fn unsent_lines(&self) -> Vec<Vec<u8>>;
        fn has_item(&self, item: Item) -> bool;
        fn value(&self, item: Item) -> f64;
        fn bit(&self, bit: Bit) -> bool;
        fn is_receiving(&self) -> bool;
        fn is_answering(&self) -> bool;
        fn exchange_ticks(&self) -> u64;
        fn is_in_command(&self) -> bool;
        fn flash(&self) -> Option<&[u8]>;
        fn uart_backlog(&self) -> usize;
        fn open_box(&self) -> Option<OpenBox>;
        fn work(&self) -> u64;
        fn held(&self) -> Option<(ContextId, Cycles)>;
        fn frames(&self, context: ContextId) -> Vec<FrameView>;
        fn result(&self, context: ContextId) -> Option<u64>;
        fn disassemble(&self, address: u32) -> Option<(String, u32)>;
        fn registers(&self) -> Vec<(String, u32)>;
    }

    delegate! { mut
        fn step(&mut self, limit: Ticks, events: EventSink<'_>);
        fn finish(&mut self, events: EventSink<'_>);
        fn load(&mut self, program: &UserProgram) -> Result<(), HostError>;
        fn start(&mut self, thread: ThreadId) -> Result<(), HostError>;
        fn stop(&mut self, thread: ThreadId);
        fn pause(&mut self, thread: ThreadId) -> Result<(), HostError>;
        fn resume(&mut self, thread: ThreadId) -> Result<(), HostError>;
        fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError>;
        fn refresh(&mut self);
        fn receive(&mut self, bytes: &[u8]);
        fn answer(&mut self, setting: &str) -> Result<(), HostError>;
        fn listen(&mut self, listens: bool);
        fn tap_wire(&mut self);
        fn take_wire(&mut self) -> Vec<u8>;
        fn play(&mut self, stimulus: Stimulus);
        fn drive_input(&mut self, bit: Bit, level: bool);
        fn send_to_uart(&mut self, bytes: &[u8]);
        fn record(&mut self, request: TraceRequest);
        fn sample(&mut self, quantities: Vec<Quantity>) -> Result<f64, HostError>;
        fn take_samples(&mut self) -> Option<Vec<(Ticks, Vec<f64>)>>;
        fn prepare_to_hold(&mut self);
        fn set_breakpoints(&mut self, addresses: &[CodeAddr]);
        fn set_stepping(&mut self, context: Option<ContextId>);
        fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]);
        fn set_accessed(&mut self, ranges: &[AccessRange]);
        fn take_change(&mut self) -> Option<usize>;
        fn take_hold(&mut self) -> Option<Hold>;
        fn set_register(&mut self, context: ContextId, frame: usize, register: u16, slot: u64) -> bool;
        fn call_function(&mut self, context: ContextId, function: GuestAddr, arguments: &[u64]) -> CallEnd;
    }

    fn snapshot(&mut self) -> Result<Self::Snapshot, SnapshotError> {
        Ok(match self {
            Self::Model(board) => AnySnapshot::Model(Box::new(Target::snapshot(board.as_mut())?)),
            Self::Booted(target) => AnySnapshot::Booted(Box::new(Target::snapshot(target.as_mut())?)),
            Self::Connected(target) => match target.snapshot()? {},
        })
    }

    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), SnapshotError> {
        match (self, snapshot) {
            (Self::Model(board), AnySnapshot::Model(snapshot)) => Target::restore(board.as_mut(), snapshot),
            (Self::Booted(target), AnySnapshot::Booted(snapshot)) => {
                Target::restore(target.as_mut(), snapshot)
            }
            (Self::Model(_) | Self::Booted(_) | Self::Connected(_), _) => Err(SnapshotError::OtherTarget),
        }
    }
}
