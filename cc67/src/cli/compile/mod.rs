//! From files to programs: sources compiled, objects read, programs linked, with the compiler's messages.

pub(crate) mod images;
pub(crate) mod units;
