//! Files as they come: read up to a size, recognised when they are not what is wanted, failures in words.

mod binary;
mod foreign;
mod read;
mod reason;

pub(crate) use binary::not_source;
pub use foreign::describe;
pub use read::{DATA_BYTES, FILE_BYTES, SOURCE_BYTES, read, read_up_to};
pub use reason::reason;
