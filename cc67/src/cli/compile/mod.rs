//! From files to programs: sources compiled, objects read, programs linked, with what the compiler says of them.

pub(crate) mod images;
pub(crate) mod units;
