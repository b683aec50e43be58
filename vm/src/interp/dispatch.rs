//! Dispatch: from one instruction to the next.
//!
//! Each instruction has a handler, expanded from the instruction table: it takes its operands from the word, executes
//! the method of the same name (`arith.rs`, `memory.rs`, `control.rs`) and continues with the handler of the next word.
//! That call is its last action, with the arguments in the same registers, so an optimising compiler turns it into a
//! jump: there is no central loop, and every instruction predicts its own successor.
//!
//! Rust does not promise that jump. Where the compiler is not known to make it (`tail_calls`, set by the build script),
//! a handler returns instead and the loop in [`execute`] calls the next one. Where it is, a handler must own nothing
//! that is dropped at its end, and must not lend its own data to its callees; an instruction that needs this leaves the
//! execution instead, as a block copy does ([`Exit::Copy`]). `tests/every.rs` executes every handler often enough in
//! one slice that the host's stack would overflow without the jumps.
//!
//! Frequent sequences of instructions have one handler each (`sequences.rs`).
//!
//! An instruction spends most of its time waiting. The address of the next word is one addition away; the test whether
//! it is in range is predicted and costs no time. Floating-point values that were assigned last are passed on in
//! processor registers: a load of a value that was just stored takes ten cycles for floating point, and almost none for
//! an integer. Six numbers and addresses can be passed on this way; rarely needed values are in the [`State`].

use super::activation::{Activation, Exit, Flow, State};
use super::code::Words;
use super::context::Window;
use super::parts::{AssignedRegisters, COND};
use super::sequences::{BREAK, for_each_sequence};
use crate::for_each_op;
use crate::memory::Sdram;
use crate::operand::Label;
use crate::shared::is_noticed;
use crate::slot::Slot;
use crate::trap::TrapKind;

/// Executes the first word of `code`, then the following words, until the state has an exit. Takes the double and the
/// single that were assigned last.
pub(super) type Handler = for<'m> fn(&mut State<'m>, &'m Window, code: &Words, &mut Sdram, f64, f32);

/// Executes one instruction after another; after a conditional branch, the next instruction is the same on both paths.
///
/// Brackets mark the operands that the previous instruction, or the one before it, has assigned; these are the
/// registers `$assigned`.
macro_rules! run {
    ($activation:ident, $assigned:expr, $last:ident $(($($link:ident),+))?) => {{
        let Some(word) = $activation.code.first() else { return lost($activation) };
        match step!($last $($($link)+)?)(&mut $activation, word, $assigned) {
            Flow::Next => go_on($activation, 1),
            Flow::Skip(count) => go_on($activation, 1 + count),
            Flow::Jump(to) => go_to($activation, to),
            Flow::Leave(exit) => leave($activation, exit),
        }
    }};
    ($activation:ident, $assigned:expr, $first:ident $(($($link:ident),+))? $($then:ident $(($($links:ident),+))?)+) => {{
        let Some((word, next)) = $activation.code.split_first() else { return lost($activation) };
        let assigned: AssignedRegisters = $assigned;
        match step!($first $($($link)+)?)(&mut $activation, word, assigned) {
            Flow::Next => {
                $activation.code = next;
                run!($activation, [word.assigned(), assigned[0]], $($then $(($($links),+))?)+)
            }
            Flow::Skip(count) => go_on($activation, 1 + count),
            Flow::Jump(to) => {
                let Some(code) = $activation.code_at(to) else { return lost($activation) };
                $activation.code = code;
                run!($activation, [word.assigned(), assigned[0]], $($then $(($($links),+))?)+)
            }
            Flow::Leave(exit) => leave($activation, exit),
        }
    }};
}

/// The function of a step with the places of linked operands.
macro_rules! step {
    ($step:ident) => {
        step::$step::<0, 0>
    };
    ($step:ident $link:ident) => {
        step::$step::<{ place_in(stringify!($step), stringify!($link)) }, 0>
    };
    ($step:ident $link:ident $far:ident) => {
        step::$step::<
            { place_in(stringify!($step), stringify!($link)) },
            { place_in(stringify!($step), stringify!($far)) },
        >
    };
}

macro_rules! define_steps {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// The instructions with their operands taken from the word.
        mod step {
            use crate::operand::*;
            use crate::interp::activation::{Activation, IntoFlow, Flow};
            use crate::interp::code::Word;
            use crate::interp::parts::{AssignedRegisters, Operands};

            $(
                #[inline(always)]
                pub(super) fn $name<const LINK: usize, const FAR: usize>(
                    activation: &mut Activation<'_, '_>,
                    word: &Word,
                    assigned: AssignedRegisters,
                ) -> Flow {
                    let mut _operands = Operands::of(&word.parts, [LINK, FAR], assigned);
                    $(let $field: $operand = _operands.take();)*
                    activation.$name($($field),*).into_flow()
                }
            )*
        }

        for_each_sequence! { define_handlers $($name: $name;)* }
    };
}

macro_rules! define_handlers {
    ($($name:ident: $first:ident $([$recalled:ident = $last:ident])? $($step:ident $(($($link:ident),+))?)*;)*) => {
        mod handler {
            use super::super::sequences::place_in;
            use super::{
                Activation, AssignedRegisters, Flow, Sdram, Slot, State, Window, Words, go_on, go_to, leave, lost, step,
            };

            $(
                pub(super) fn $name<'m>(
                    state: &mut State<'m>,
                    window: &'m Window,
                    code: &Words,
                    sdram: &mut Sdram,
                    double: f64,
                    single: f32,
                ) {
                    let mut activation = Activation { state, window, sdram, code, double, single };
                    // One comparison for all steps, and for the word after them.
                    if code.len() < 2 $(+ count!($step))* {
                        return lost(activation);
                    }
                    $(
                        let place = const { place_in(stringify!($first), stringify!($recalled)) };
                        activation.store_last_value(place, activation.$last.into_slot());
                    )?
                    run!(activation, [0; 2], $first $($step $(($($link),+))?)*);
                }
            )*
        }

        /// The handlers in the order of the instruction table, then of the sequences.
        const ROWS: &[Handler] = &[$(handler::$name),*];
    };
}

/// A step as a number.
macro_rules! count {
    ($step:ident) => {
        1
    };
}
for_each_op!(define_steps);

/// The handler of an opcode.
pub(super) const fn handler_of(code: u16) -> Handler {
    if code == BREAK { held } else { ROWS[code as usize] }
}

/// Handlers of observed accesses: through a register; through a register in a program that shares its own data with a
/// call-back; and through a constant address in shared memory.
pub(super) const OBSERVED: Handler = observed_through_register::<false>;
pub(super) const OBSERVED_WITH_CALL_BACK: Handler = observed_through_register::<true>;
pub(super) const OBSERVED_AT: Handler = observed_at;
/// An access that is always reported.
pub(super) const SHARED: Handler = shared;

fn observed_through_register<'m, const HAS_CALL_BACK: bool>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    let Some(word) = code.first() else { return };
    let [opcode, _, base, off] = word.parts;
    let address = (window[usize::from(base)].get() as u32).wrapping_add_signed((off as i16).into());
    let is_reported = is_noticed(address, HAS_CALL_BACK)
        && !is_known(state, code, address)
        && !state.filter.is_some_and(|filter| filter.owns(address));
    if is_reported {
        return shared(state, window, code, sdram, double, single);
    }
    ROWS[usize::from(opcode)](state, window, code, sdram, double, single);
}

fn observed_at<'m>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    let Some(word) = code.first() else { return };
    let [opcode, _, low, high] = word.parts;
    if !is_known(state, code, u32::from(low) | u32::from(high) << 16) {
        return shared(state, window, code, sdram, double, single);
    }
    ROWS[usize::from(opcode)](state, window, code, sdram, double, single);
}

/// Reports whether the first instruction of `code` has already made its access in this slice.
#[inline(always)]
fn is_known(state: &State<'_>, code: &Words, address: u32) -> bool {
    state.filter.is_some_and(|filter| filter.knows(state.words.len() - code.len(), address))
}

fn shared<'m>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    leave(Activation { state, window, sdram, code, double, single }, Exit::Shared);
}

/// A jump, and the two conditional branches, with which an iteration of a waiting loop may end.
pub(super) const ENDS_ITERATION: Handler = ends_iteration;
pub(super) const ENDS_ITERATION_IF: Handler = ends_iteration_if::<true>;
pub(super) const ENDS_ITERATION_UNLESS: Handler = ends_iteration_if::<false>;

fn ends_iteration<'m>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    leave(Activation { state, window, sdram, code, double, single }, Exit::EndsIteration);
}

fn ends_iteration_if<'m, const IS_SET: bool>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    let Some(word) = code.first() else { return };
    let is_set = window[usize::from(word.register(COND))].get() as u32 != 0;
    if is_set == IS_SET {
        return ends_iteration(state, window, code, sdram, double, single);
    }
    go_on(Activation { state, window, sdram, code, double, single }, 1);
}

/// Handles a word at which a debugger holds the context.
fn held<'m>(
    state: &mut State<'m>,
    window: &'m Window,
    code: &Words,
    sdram: &mut Sdram,
    double: f64,
    single: f32,
) {
    leave(Activation { state, window, sdram, code, double, single }, Exit::Held);
}

/// Executes from the current position of the calls; returns the reason for which it ended, with the instruction that
/// caused it in `pc`.
pub(super) fn execute(state: &mut State<'_>, sdram: &mut Sdram) -> Exit {
    loop {
        let (words, pc) = (state.words, state.calls.pc);
        let Some(window) = state.calls.window(state.registers) else {
            return Exit::Trap(TrapKind::Unreachable);
        };
        let Some((word, _)) = words.get(pc..).and_then(<[_]>::split_first) else {
            return Exit::Trap(TrapKind::Unreachable);
        };
        // The value assigned by the previous word, if this one is linked with it.
        let last = pc.checked_sub(1).map_or(0, |before| window[usize::from(words[before].assigned())].get());
        (word.handler)(state, window, &words[pc..], sdram, f64::from_slot(last), f32::from_slot(last));
        if let Some(exit) = state.exit.take() {
            return exit;
        }
    }
}

/// Continues `count` words later.
#[inline(always)]
fn go_on(activation: Activation<'_, '_>, count: usize) {
    match activation.code.get(count..) {
        Some(code) => enter(activation, code),
        None => lost(activation),
    }
}

/// Continues with the word `to`.
#[inline(always)]
fn go_to(activation: Activation<'_, '_>, to: Label) {
    match activation.code_at(to) {
        Some(code) => enter(activation, code),
        None => lost(activation),
    }
}

/// Continues with the first word of `code`.
#[inline(always)]
fn enter(activation: Activation<'_, '_>, code: &Words) {
    let Activation { state, window, sdram, double, single, .. } = activation;
    if cfg!(tail_calls) {
        if let Some(word) = code.first() {
            (word.handler)(state, window, code, sdram, double, single);
        }
    } else {
        state.calls.pc = state.words.len() - code.len();
    }
}

/// Ends the execution at a point that a verified program does not reach.
#[cold]
fn lost(activation: Activation<'_, '_>) {
    leave(activation, Exit::Trap(TrapKind::Unreachable));
}

/// Ends the execution at the instruction of `activation`.
#[inline(always)]
fn leave(activation: Activation<'_, '_>, exit: Exit) {
    activation.state.calls.pc = activation.pc();
    activation.state.exit = Some(exit);
}
