//! The code that a thread is loaded with, for any engine.

mod image;

use std::ops::Range;
use std::sync::Arc;

use kmotiondef::{Cycles, GuestAddr};

use crate::firmware::Pure;
use crate::program::Program;

pub use self::image::Image;

/// The code that a thread is loaded with; each kind has its engine.
#[derive(Clone, Debug)]
pub enum LoadedCode {
    /// Bytecode, for the bytecode engine of the machine.
    Program(Arc<Program>),
    /// Code of the real processor.
    Image(Arc<Image>),
}

impl LoadedCode {
    /// The program, if it is bytecode.
    #[must_use]
    pub fn program(&self) -> Option<&Arc<Program>> {
        match self {
            Self::Program(program) => Some(program),
            Self::Image(_) => None,
        }
    }

    /// The addresses that hold its code, into which no thread may write.
    #[must_use]
    pub fn text(&self) -> Range<GuestAddr> {
        match self {
            Self::Program(program) => program.text(),
            Self::Image(image) => image.text(),
        }
    }

    /// The range of addresses that contains its code.
    #[must_use]
    pub fn code(&self) -> Range<GuestAddr> {
        match self {
            Self::Program(program) => program.text(),
            Self::Image(image) => image.code(),
        }
    }

    /// Reports whether `address` is that of one of its functions.
    #[must_use]
    pub fn has_function(&self, address: GuestAddr) -> bool {
        match self {
            Self::Program(program) => program.function_at(address).is_some(),
            Self::Image(image) => image.has_function(address),
        }
    }

    /// The most cycles spent from one instant at which it can lose the processor to the next.
    pub(crate) fn longest_step(&self, pure: &dyn Fn(GuestAddr) -> Option<Pure>) -> Cycles {
        match self {
            Self::Program(program) => program.longest_step(pure),
            // It takes no long slices.
            Self::Image(_) => Cycles::default(),
        }
    }
}
