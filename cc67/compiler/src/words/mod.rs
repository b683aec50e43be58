//! Unknown names: the probable intended name, and the counterparts of other boards' words.

pub mod foreign;
mod suggest;

pub use suggest::suggest;
