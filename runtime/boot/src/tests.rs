//! The recorded start of the real firmware, where there is one (`CC67_FIRMWARE`), and devices without it.

mod exchanges;
mod recorded;
mod small;
