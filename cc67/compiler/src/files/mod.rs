//! Input files: read up to a maximum size, recognised if they are of another kind, with readable errors.

mod binary;
mod foreign;
mod read;
mod reason;

pub(crate) use binary::not_source;
pub use foreign::describe;
pub use read::{DATA_BYTES, FILE_BYTES, SOURCE_BYTES, read, read_up_to};
pub use reason::reason;
