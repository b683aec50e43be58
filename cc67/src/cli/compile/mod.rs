//! From files to programs: compiles sources, reads objects, links programs, and shows the compiler's messages.

pub(crate) mod images;
pub(crate) mod units;
