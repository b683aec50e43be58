//! Advice about undeclared names: the most likely of many reasons.

use kmotiondef::structs::STRUCTURES;

use super::Sema;
use crate::diag::Diagnostic;
use crate::names::Name;
use crate::words::foreign::{self as foreign_words, Origin, Word};

/// The advice when the vendor's header seems to be missing.
pub(super) const HEADER_HELP: &str = "is `KMotionDef.h` included?";

/// The advice about an undeclared name.
pub(super) enum Advice {
    /// It follows from another error, and is not reported.
    Silence,
    /// Something to add to the error.
    Say(Box<dyn FnOnce(Diagnostic) -> Diagnostic>),
}

/// The axes that have pointers, and structures with a variable through which programs reach the members.
const OWNERS: &[(&str, &str)] = &[("CHAN", "ch0->"), ("PERSIST", "persist.")];

impl Sema<'_> {
    /// Finds the advice about an undeclared name.
    pub(super) fn advice(&mut self, name: Name) -> Advice {
        if self.sink.lacks_names() || self.sink.is_full() {
            return Advice::Silence;
        }
        let spelling = self.names.get(name).to_owned();
        if let Some(word) = foreign_words::word(&spelling).filter(|word| !self.is_own(name, word)) {
            return self.foreign_advice(word);
        }
        if self.firmware.is_variable(&spelling) || self.firmware.prototype(&spelling).is_some() {
            return say(|it| it.note("the firmware has this name").help(HEADER_HELP));
        }
        if self.names.is_function_macro(name) {
            return say(move |it| {
                it.note(format!("`{spelling}` is a macro with parameters"))
                    .help(format!("write them in parentheses: `{spelling}(…)`"))
            });
        }
        if is_axis(&spelling) {
            return say(|it| it.help("the axes are `ch0` to `ch7`"));
        }
        let near = self.near_name(&spelling).map(str::to_owned);
        let owner = owner(&spelling)
            .filter(|_| near.as_deref().is_none_or(|near| !near.eq_ignore_ascii_case(&spelling)));
        if let Some(owner) = owner {
            return say(move |it| it.help(format!("it is a member: write `{owner}{spelling}`")));
        }
        if let Some((function, span)) = self.noted.locals_elsewhere.get(&name).cloned() {
            return say(move |it| {
                it.label(span, format!("this one exists only in `{function}`"))
                    .help("declare the variable before the functions that use it, outside them")
            });
        }
        match near {
            Some(near) => say(move |it| it.help(format!("did you mean `{near}`?"))),
            None => say(|it| it),
        }
    }

    /// Reports whether the program itself probably has a name, where only a pattern speaks for the word.
    fn is_own(&self, name: Name, word: &Word) -> bool {
        let has_case =
            || self.near_name(word.spelling).is_some_and(|near| near.eq_ignore_ascii_case(word.spelling));
        matches!(word.origin, Origin::Board | Origin::Console)
            && (self.noted.locals_elsewhere.contains_key(&name) || has_case())
    }

    fn foreign_advice(&mut self, word: &'static Word) -> Advice {
        let is_first = self.noted.origins.insert(word.origin);
        // After an error about `bool`, `true` needs no second error.
        let is_answered = matches!(word.spelling, "true" | "false")
            && self.sink.has_errors()
            && self.names.find("bool").is_some();
        if is_answered || word.is_companion && !is_first {
            return Advice::Silence;
        }
        say(|it| it.help(word.advice))
    }
}

fn say(change: impl FnOnce(Diagnostic) -> Diagnostic + 'static) -> Advice {
    Advice::Say(Box::new(change))
}

/// Reports whether a name is an axis pointer's except for the number.
pub(super) fn is_axis(spelling: &str) -> bool {
    spelling
        .strip_prefix("ch")
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// The prefix through which programs reach a member of this name.
fn owner(spelling: &str) -> Option<&'static str> {
    OWNERS.iter().find_map(|(structure, prefix)| {
        let structure = STRUCTURES.iter().find(|known| known.name == *structure)?;
        structure.fields.iter().any(|field| field.name == spelling).then_some(*prefix)
    })
}
