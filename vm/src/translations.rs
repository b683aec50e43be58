//! An engine's translations of its programs.
//!
//! A program is shared by reference, and is identified by that reference. Its translation is dropped when the last
//! other reference to the program is gone.

use std::sync::{Arc, Weak};

use crate::program::Program;

/// The translations of programs, by program.
#[derive(Clone, Debug)]
pub(crate) struct Translations<T>(Vec<(Weak<Program>, T)>);

impl<T> Default for Translations<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Clone> Translations<T> {
    /// Returns the translation of `program`; `make` creates it when it is first requested.
    pub(crate) fn get(&mut self, program: &Arc<Program>, make: impl FnOnce(&Program) -> T) -> T {
        // A weak reference prevents the address of its program from being reused.
        let is_same = |(known, _): &&(Weak<Program>, T)| known.as_ptr() == Arc::as_ptr(program);
        if let Some((_, made)) = self.0.iter().find(is_same) {
            return made.clone();
        }
        self.0.retain(|(known, _)| known.strong_count() > 0);
        let made = make(program);
        self.0.push((Arc::downgrade(program), made.clone()));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::program;

    #[test]
    fn a_program_is_translated_once_and_forgotten_with_its_last_owner() {
        let mut translations = Translations::default();
        let mut made = 0;
        let mut get = |program: &Arc<Program>, translations: &mut Translations<u32>| {
            translations.get(program, |_| {
                made += 1;
                made
            })
        };
        let [one, other] =
            [1, 2].map(|number| Arc::new(program(number, "@main: func sig0, 0, 0\ncharge 2\nret")));
        assert_eq!([&one, &other, &one].map(|program| get(program, &mut translations)), [1, 2, 1]);
        drop(one);
        let third = Arc::new(program(3, "@main: func sig0, 0, 0\ncharge 2\nret"));
        assert_eq!(get(&third, &mut translations), 3);
        assert_eq!(translations.0.len(), 2);
    }
}
