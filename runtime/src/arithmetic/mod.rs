//! The arithmetic of the board: divisions, roots, and the elementary functions of the firmware's library, bit by bit.
//!
//! Programs print the last digits, and a last digit can decide which profile a motion has: so firmware functions and
//! the servo use the functions of this module.

pub(crate) mod division;
pub(crate) mod doubles;
pub(crate) mod powers;
pub(crate) mod singles;
