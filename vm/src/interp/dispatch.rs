//! Dispatch: from one instruction to the next.
//!
//! Each instruction has a handler, expanded from the instruction table: it takes its operands from the
//! word, does what the method of its name does (`arith.rs`, `memory.rs`, `control.rs`) and continues with
//! the handler of the next word. That call is the last thing it does, with the arguments in the same
//! registers, so an optimising compiler makes a jump of it: no loop to go back to, and every instruction
//! predicts its own successor.
//!
//! Rust does not promise that jump. Where the compiler is not known to make it (`tail_calls`, set by the
//! build script), a handler returns instead and the loop in [`execute`] calls the next one. Where it is, a
//! handler must own nothing that is dropped at its end and must lend nothing of its own to what it calls:
//! what needs that leaves the execution instead, as a copy does ([`Exit::Copy`]). `tests/every.rs` executes
//! every handler so often in one slice that the host's stack would not do without the jumps.
//!
//! What programs often do in a row has a handler for all of it (`sequences.rs`).

use super::activation::{Activation, Exit, Flow, State};
use super::code::{Word, Words, word_at};
use super::context::Window;
use super::sequences::{BREAK, for_each_sequence};
use crate::for_each_op;
use crate::trap::TrapKind;

/// Executes the word `word`, number `pc`, and what comes then, until something leaves the state an exit.
type Handler = for<'m> fn(&mut State<'m>, &'m Window, &Words, pc: usize, &Word);

/// Executes one instruction after another; where one may go two ways, the next is there on both.
macro_rules! run {
    ($activation:ident, $words:ident, $word:expr, $last:ident) => {
        match step::$last(&mut $activation, $word) {
            Flow::Next => go_to($activation.pc + 1, $activation, $words),
            Flow::Skip(count) => go_to($activation.pc + 1 + count, $activation, $words),
            Flow::Jump(to) => go_to(to.0 as usize, $activation, $words),
            Flow::Leave(exit) => leave($activation, exit),
        }
    };
    ($activation:ident, $words:ident, $word:expr, $first:ident $($then:ident)+) => {
        match step::$first(&mut $activation, $word) {
            Flow::Next => {
                $activation.pc += 1;
                let word = word_at($words, $activation.pc);
                run!($activation, $words, word, $($then)+)
            }
            Flow::Skip(count) => go_to($activation.pc + 1 + count, $activation, $words),
            Flow::Jump(to) => {
                $activation.pc = to.0 as usize;
                let word = word_at($words, $activation.pc);
                run!($activation, $words, word, $($then)+)
            }
            Flow::Leave(exit) => leave($activation, exit),
        }
    };
}

macro_rules! define_steps {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// The instructions with their operands taken from the word.
        mod step {
            use crate::operand::*;
            use crate::interp::activation::{Activation, Finish, Flow};
            use crate::interp::code::{Operands, Word};

            $(
                #[inline(always)]
                pub(super) fn $name(activation: &mut Activation<'_, '_>, word: &Word) -> Flow {
                    let mut _operands = Operands::of(word);
                    $(let $field: $operand = _operands.take();)*
                    activation.$name($($field),*).flow()
                }
            )*
        }

        for_each_sequence! { define_handlers $($name: $name;)* }
    };
}

macro_rules! define_handlers {
    ($($name:ident: $($step:ident)+;)*) => {
        mod handler {
            use super::{Activation, Flow, State, Window, Word, Words, go_to, leave, step, word_at};

            $(
                pub(super) fn $name<'m>(
                    state: &mut State<'m>,
                    window: &'m Window,
                    words: &Words,
                    pc: usize,
                    word: &Word,
                ) {
                    let mut activation = Activation { state, window, pc };
                    run!(activation, words, word, $($step)+);
                }
            )*
        }

        /// The handlers in the order of the instruction table, then of the sequences.
        const ROWS: &[Handler] = &[$(handler::$name),*];
    };
}
for_each_op!(define_steps);

/// The handlers by opcode, of a length that needs no check.
static HANDLERS: [Handler; 256] = {
    let mut handlers: [Handler; 256] = [handler::unreachable; 256];
    let mut code = 0;
    while code < ROWS.len() {
        handlers[code] = ROWS[code];
        code += 1;
    }
    handlers[BREAK as usize] = held;
    handlers
};

/// What a word does at which a debugger holds the context.
fn held<'m>(state: &mut State<'m>, window: &'m Window, _: &Words, pc: usize, _: &Word) {
    leave(Activation { state, window, pc }, Exit::Held);
}

/// The handler of a word; `sequences.rs` sees to it that an opcode fits a byte.
#[inline(always)]
fn handler_of(word: &Word) -> Handler {
    HANDLERS[usize::from(word[0] as u8)]
}

/// Executes from where the calls stand; yields why that ended, with the instruction that did it in `pc`.
pub(super) fn execute(state: &mut State<'_>, words: &Words) -> Exit {
    loop {
        let Some(window) = state.calls.window(state.registers) else {
            return Exit::Trap(TrapKind::Unreachable);
        };
        let pc = state.calls.pc;
        let word = word_at(words, pc);
        handler_of(word)(state, window, words, pc, word);
        if let Some(exit) = state.exit.take() {
            return exit;
        }
    }
}

/// Continues with the word `next`.
#[inline(always)]
fn go_to(next: usize, activation: Activation<'_, '_>, words: &Words) {
    let Activation { state, window, .. } = activation;
    if cfg!(tail_calls) {
        let pc = next % words.len();
        let word = &words[pc];
        handler_of(word)(state, window, words, pc, word);
    } else {
        state.calls.pc = next;
    }
}

/// Ends the execution at the instruction of `activation`.
#[inline(always)]
fn leave(activation: Activation<'_, '_>, exit: Exit) {
    activation.state.calls.pc = activation.pc;
    activation.state.exit = Some(exit);
}
