//! The executor, compared with the emulator's recordings.

mod faults;
mod flat;
mod stalls;
mod stops;
mod translated;
mod vectors;
