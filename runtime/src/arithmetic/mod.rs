//! The arithmetic of the board: divisions, roots, and the elementary functions of the firmware's library, to the bit.
//!
//! Programs print the last digits, and a last digit decides which profile a motion has: firmware functions and the servo
//! compute with the functions of this room.

pub(crate) mod division;
pub(crate) mod doubles;
pub(crate) mod powers;
pub(crate) mod singles;
