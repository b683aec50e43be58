//! Names that are not known: which one was meant, and what other boards' words are called here.

pub mod foreign;
mod suggest;

pub use suggest::suggest;
