//! The deterministic machine that runs KFLOP user programs.
//!
//! A [`machine::Machine`] consists of guest memory, seven threads, an engine for each kind of code, and a firmware that
//! it sees only as a trait. Time passes in ticks of 90 µs. Each tick starts with the firmware's servo interrupt; then
//! the [`scheduler`] selects a thread, and the rest of the tick is that thread's slice: a budget of cycles that its
//! engine may spend. The engine owns the context of a running thread: registers, calls, the position in the code. It
//! runs the context until it stops ([`engine::Stop`]): the budget is spent, a firmware call waits, the thread ends, or
//! it traps ([`trap`]). The thread's program ([`loaded`]) determines the engine. Bytecode comes as bytes that
//! [`verify`] turns into a [`program::Program`], which is data that any engine of bytecode can run without further
//! checks; real images are words in guest memory. A firmware call gets its arguments by position ([`call`]),
//! independent of registers. Between two ticks, the whole state can be saved as a [`machine::Snapshot`] and restored
//! any number of times.
//!
//! From top to bottom:
//! - `machine/`: memory, threads, engines and firmware tied together in ticks; long slices; snapshots
//! - `profile`: the bytecode engine with a record of where time was spent
//! - `interp/`: the bytecode engine; `native/`: bytecode translated to machine code of the host; `dsp/`: the real
//!   processor
//! - `engine`, `access`, `translations`: the interface of every engine, and code shared by engines
//! - `polling`: the loops of a program that may only wait
//! - `shared`, `filter`: accesses to memory that threads can share, and which of them are reported
//! - `loaded`, `verify/`, `program`: the program of a thread, and how bytes become a program
//! - `firmware`, `call`, `varargs`, `wake`: how a program leaves the machine, and what it waits for
//! - `thread`, `scheduler`: the states of the seven threads, and their rotation
//! - `guard`: what precedes bytecode in an image
//! - `op`, `kind`, `operand`, `slot`, `meter`, `patch`, `text`: the instruction table and everything expanded from it
//! - `memory/`, `bus`, `protection`: the memory that a program can see; pages shared by snapshots
//! - `arith`, `trap`: the processor's arithmetic; impossible actions
//!
//! Invariants:
//! - The machine knows no firmware function, device or axis; it accesses them through [`firmware::Firmware`] and
//!   [`bus::Bus`].
//! - A program is data. Anything derived from it belongs to an engine; nothing belongs to the process.
//! - A run is a function of images, inputs and options: no clock, no randomness, no operating-system thread, no hash
//!   order.
//! - `charge` is the only place where a thread of bytecode can lose the processor; with
//!   [`Preemption::Instructions`](engine::Preemption) also before the instructions of a segment that the budget does
//!   not cover, in the cycles given by [`meter::steps`].
//! - A restored machine continues exactly as it did after the snapshot; nothing on a native stack owns anything.

mod access;
pub mod arith;
pub mod bus;
pub mod call;
pub mod dsp;
pub mod engine;
mod filter;
pub mod firmware;
pub mod guard;
pub mod interp;
pub mod kind;
pub mod loaded;
pub mod machine;
pub mod memory;
pub mod meter;
#[cfg(feature = "native")]
pub mod native;
pub mod op;
pub mod operand;
pub mod patch;
mod polling;
pub mod profile;
pub mod program;
mod protection;
pub mod scheduler;
mod shared;
pub mod slot;
#[cfg(test)]
mod testing;
pub mod text;
pub mod thread;
mod translations;
pub mod trap;
pub mod varargs;
pub mod verify;
pub mod wake;
