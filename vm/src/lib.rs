//! The deterministic machine that runs KFLOP user programs.
//!
//! A [`machine::Machine`] is guest memory, seven threads, an engine for each kind of code, and a firmware that it knows
//! by a trait alone. Time passes in ticks of 90 µs. Each tick begins with the firmware's servo interrupt; the
//! [`scheduler`] then says whose turn it is, and the rest of the tick is that thread's slice: a budget of cycles that its
//! engine may spend. The engine owns everything that belongs to a running thread, its context: registers, calls, the
//! place in the code. It runs the context until it stops ([`engine::Stop`]): the budget is spent, a firmware call waits,
//! the thread ends, or it does the impossible ([`trap`]). What a thread is loaded with ([`loaded`]) says which engine that
//! is. Bytecode comes as bytes that [`verify`] turns into a [`program::Program`], which is data that any engine of
//! bytecode can run without further checks; real images are words in guest memory. A firmware call gets its arguments by
//! position ([`call`]), whatever registers they come from. Between two ticks all of it can be kept as a
//! [`machine::Snapshot`] and taken back to it any number of times.
//!
//! From top to bottom:
//! - `machine/`: memory, threads, engines and firmware tied together in ticks; long slices; snapshots
//! - `profile`: the bytecode engine with an account of where the time went
//! - `interp/`: the bytecode engine; `native/`: machine code of the host made of bytecode; `dsp/`: the real processor
//! - `engine`, `access`, `translations`: what the machine asks of every engine, and what engines share
//! - `loaded`, `verify/`, `program`: what a thread is loaded with, and how bytes become a program
//! - `firmware`, `call`, `varargs`, `wake`: how a program leaves the machine, and what it waits for
//! - `thread`, `scheduler`: the states of the seven threads, and whose turn it is
//! - `guard`: what precedes bytecode in an image
//! - `op`, `kind`, `operand`, `slot`, `meter`, `patch`, `text`: the instruction table and what follows from it
//! - `memory/`, `bus`, `protection`: what a program can see; pages that snapshots share
//! - `arith`, `trap`: arithmetic as the processor does it; the impossible
//!
//! Invariants:
//! - The machine knows no firmware function, device or axis; it meets them through
//!   [`firmware::Firmware`] and [`bus::Bus`].
//! - A program is data. What an engine makes of it belongs to the engine; nothing belongs to the process.
//! - A run is a function of images, inputs and options: no clock, no randomness, no
//!   operating-system thread, no order of a hash.
//! - `charge` is the only place where a thread of bytecode can lose the processor.
//! - A restored machine continues exactly as it did after the snapshot; nothing on a native stack owns anything.

mod access;
pub mod arith;
pub mod bus;
pub mod call;
pub mod dsp;
pub mod engine;
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
pub mod profile;
pub mod program;
mod protection;
pub mod scheduler;
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
