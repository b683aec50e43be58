//! The third engine: executes the real processor's packets.
//!
//! A [`Core`] is one processor context: registers, results and branches in flight. It reaches memory through [`Memory`]
//! and knows nothing of threads, firmware or boards.
//!
//! The model is that of the specification (`c67x.md` 2.6): all instructions of a packet read their sources before any
//! of them writes; a result of stage Ek lands k cycles after the issue; until then, reads see the old value. The
//! implementation differs from a plain queue only for speed: results in flight wait in sixteen [`pipeline`] slots, one
//! a cycle, and packets are decoded once ([`decode`]) and kept by address ([`cache`]). Loops are executed with their
//! registers renamed, so that no result has to wait ([`loops`]), or as host code.
//!
//! Invariants:
//!
//! - [`work`] is the only file that maps an instruction to its operation, without a `_` arm.
//! - A run depends only on the words, the registers and the memory.

mod account;
mod alu;
mod cache;
mod core;
mod decode;
mod execute;
mod flight;
mod float;
mod idle;
mod inspect;
mod loops;
#[cfg(feature = "native")]
mod marks;
mod memory;
#[cfg(feature = "native")]
mod native;
mod pipeline;
mod product;
mod threads;
mod view;
mod watched;
mod work;

#[cfg(test)]
mod tests;

pub use self::account::{Account, Callers, Spender, Time};
pub(crate) use self::core::HotCode;
pub use self::core::{Core, Halt};
pub use self::decode::is_code;
pub use self::inspect::packet_text;
pub use self::memory::{Clock, Memory};
pub use self::pipeline::State;
pub use self::threads::{DspEngine, DspSnapshot};
