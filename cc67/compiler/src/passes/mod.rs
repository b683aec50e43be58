//! Optimisations of the IR, one per file.
//!
//! All are local to a block or to the control-flow graph and take linear time, except for the loop passes, which take
//! one pass over the function per loop, up to a limit. They only change values: loads, stores and calls keep their
//! number and order (specification, `dialect.md` 1.5); only calls of small functions are inlined.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

pub mod dead;
pub mod divide;
pub mod evaluate;
pub mod fold;
pub mod inline;
pub mod jumps;
pub mod loops;
pub mod reuse;
mod strength;
pub mod unroll;

use crate::ir::function::Function;
use inline::Candidates;

/// The level of optimisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Nothing: the code follows the source (`-O0`).
    None,
    /// Optimise for size (`-Os`): only calls of short functions are inlined, and no recursive ones; loops that only
    /// compute with known numbers are replaced by their final values.
    Small,
    /// Everything that makes code faster without making it much larger (`-O1`).
    #[default]
    Full,
    /// For the controller's processor, also optimisations that make code larger (`-O2`); bytecode is the same as for
    /// `Full`.
    Fast,
}

/// A pass over the functions of a unit, in their order.
pub type Pass = fn(&mut [Function]);

/// All passes by name; [`run`] and the driver determine the order.
pub const ALL: &[(&str, Pass)] = &[
    ("jumps", |unit| unit.iter_mut().for_each(jumps::run)),
    ("fold", |unit| unit.iter_mut().for_each(|function| _ = fold::run(function))),
    ("reuse", |unit| unit.iter_mut().for_each(|function| _ = reuse::run(function))),
    ("loops", |unit| unit.iter_mut().for_each(|function| _ = loops::run(function))),
    ("dead", |unit| unit.iter_mut().for_each(dead::run)),
    ("divide", |unit| unit.iter_mut().for_each(divide::run)),
    ("evaluate", |unit| unit.iter_mut().for_each(|function| _ = evaluate::run(function))),
    ("unroll", |unit| unit.iter_mut().for_each(|function| _ = unroll::run(function))),
    ("inline", inline_all),
];

/// Inlines functions of the unit, taken as one file, into later functions.
fn inline_all(unit: &mut [Function]) {
    let mut candidates = Candidates::default();
    for function in unit {
        candidates.add(function, 0);
        candidates.run(function, 0);
    }
}

/// Runs the optimisations of a level.
pub fn run(function: &mut Function, level: Level) {
    if level == Level::None {
        return;
    }
    jumps::run(function);
    if fold::run(function) {
        jumps::run(function);
    }
    if reuse::run(function) | loops::run(function) {
        fold::run(function);
    }
    dead::run(function);
    divide::run(function);
}

/// Optimises loops again: values folded in the first run may have become linear.
pub fn loops_again(function: &mut Function) {
    if loops::run(function) {
        fold::run(function);
        reuse::run(function);
        fold::run(function);
        dead::run(function);
    }
}

/// Replaces loops that only compute with known numbers by their final values, and cleans up afterwards.
pub fn evaluate(function: &mut Function) {
    if evaluate::run(function) {
        reuse::run(function);
        fold::run(function);
        dead::run(function);
    }
}

/// Unrolls loops, and cleans up after it.
pub fn unroll(function: &mut Function) {
    jumps::run(function);
    if unroll::run(function) {
        jumps::run(function);
        if fold::run(function) {
            jumps::run(function);
        }
        reuse::run(function);
        fold::run(function);
        dead::run(function);
    }
}

#[cfg(test)]
mod tests;
