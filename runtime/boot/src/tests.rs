//! The recorded start of the real firmware, if a file is available (`CC67_FIRMWARE`), and devices without it.

mod exchanges;
mod recorded;
mod small;
