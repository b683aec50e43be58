//! The classes of values, from the text of a function.
//!
//! A parameter list names classes, and so does every instruction that writes a value, except for a copy: that has the
//! class of its source. The class of a value that is read and never written, or that is only a copy of such values, is
//! declared before the first block.

use super::inst::{Class, ValueId};
use cranelift_entity::SecondaryMap;

/// Collects the classes that a text states.
#[derive(Debug, Default)]
pub(super) struct Classes {
    known: SecondaryMap<ValueId, Option<Class>>,
    /// Values and their originals.
    copies: Vec<(ValueId, ValueId)>,
}

impl Classes {
    /// Records the class of a value; returns its earlier class, if that differs.
    pub(super) fn record(&mut self, value: ValueId, class: Class) -> Result<(), Class> {
        match self.known[value].replace(class) {
            Some(before) if before != class => Err(before),
            _ => Ok(()),
        }
    }

    /// Records that two values have the same class.
    pub(super) fn copy(&mut self, dst: ValueId, src: ValueId) {
        self.copies.push((dst, src));
    }

    /// Carries classes along the copies.
    pub(super) fn propagate(&mut self) {
        let mut is_changed = true;
        while is_changed {
            is_changed = false;
            let known = &mut self.known;
            self.copies.retain(|&(dst, src)| match (known[dst], known[src]) {
                (Some(_), _) => false,
                (None, Some(class)) => {
                    known[dst] = Some(class);
                    is_changed = true;
                    false
                }
                (None, None) => true,
            });
        }
    }

    /// The class of a value, if the text states it.
    pub(super) fn get(&self, value: ValueId) -> Option<Class> {
        self.known[value]
    }
}
