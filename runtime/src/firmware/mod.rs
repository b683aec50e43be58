//! The firmware functions, one file a group, named as in the table.

pub(crate) mod axis_check;
pub(crate) mod calls;
pub(crate) mod console;
pub(crate) mod coord;
mod costs;
pub(crate) mod dispatch;
pub(crate) mod files;
mod float_bits;
pub(crate) mod gather;
pub(crate) mod io;
pub(crate) mod kogna;
pub(crate) mod kogna_bus;
pub(crate) mod konnect;
pub(crate) mod later;
pub(crate) mod level;
pub(crate) mod math;
pub(crate) mod motion;
pub(crate) mod parts;
pub(crate) mod persist;
pub(crate) mod races;
pub(crate) mod serial;
pub(crate) mod snapamp;
pub(crate) mod spindle;
pub(crate) mod stdlib;
pub(crate) mod string;
pub(crate) mod sync;
pub(crate) mod thread;
pub(crate) mod time;
pub(crate) mod waits;

use kmotiondef::firmware::Function;
use vm::trap::TrapKind;

/// Marks a function that can be linked but is not modelled yet: a call traps instead of silently doing nothing.
pub(crate) fn not_modelled<T>(function: Function) -> Result<T, TrapKind> {
    Err(TrapKind::NotModelled { name: function.name() })
}
