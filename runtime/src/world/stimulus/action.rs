//! Actions of statements, as a table.
//!
//! A row is an action: how statements write it, what reads each form and what does it, both functions of a file of
//! [`acts`](super::acts); the key of an `[[event]]` table that writes it in a machine file; and what should be known of
//! it before time begins. The enum, the words, the keys and the dispatch are expanded from the rows.

use std::sync::Arc;

use kmotiondef::{AxisId, Bit, Cycles, ThreadId};
use vm::memory::GuestMemory;

use super::acts::manual::ManualStep;
use super::acts::{computer, lines, manual, mechanics, options};
use super::expectation;
use super::expectation::Expectation;
use super::reader::StatementReader;
use super::scene::Scene;
use super::tokens::Mistake;
use super::wave::Wave;
use crate::io::konnect::KonnectBoard;
use crate::io::snapamp::{Quantity, Side};
use crate::world::WorldAccess;
use crate::world::attached::DeviceSpec;

/// The translation of an event's key into statements: a template with the event's values in braces. Texts come in
/// quotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// One value, or an array of them, as `{value}`.
    One(&'static str),
    /// A table: a statement for each of its keys, as `{key}`, `{value}`, or both with `=` between them as `{setting}`.
    Each(&'static str),
    /// A table: the first template all of whose names it has.
    Fields(&'static [&'static str]),
    /// A table whose keys have forms of their own, or statements of their own after a word, in a text.
    Nested(&'static str, &'static [(&'static str, Form)]),
    /// A text, or several, that are statements themselves.
    Statement,
}

/// Reads the operands of an action, from after its first word on.
type ActionReader = fn(&mut StatementReader<'_>) -> Result<Action, Mistake>;

/// A form of an action as statements have it, and what reads it.
#[derive(Debug)]
struct StatementForm {
    usage: &'static str,
    read: ActionReader,
}

impl StatementForm {
    /// The word that it begins with.
    fn word(&self) -> &'static str {
        self.usage.split(' ').next().unwrap_or_default()
    }

    /// Returns whether a statement has the form's fixed words at the same positions, as far as it goes.
    fn fits(&self, reader: &StatementReader<'_>) -> bool {
        let is_word = |word: &str| word.chars().all(char::is_lowercase);
        let mut words = self.usage.split(' ').enumerate().filter(|(_, word)| is_word(word));
        words.all(|(index, word)| reader.word(index).is_none_or(|found| found == word))
    }
}

/// Expands the rows.
macro_rules! actions {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident($first:ident: $first_type:ty $(, $operand:ident: $type:ty)*) {
            does $act:path;
            $(announces $announce:path;)?
            $(keeps $keeps:literal;)?
            written { $($usage:literal => $read:path),+ }
            $(keys { $($key:literal => $form:expr),+ })?
        }
    )+) => {
        /// An action of the world on the board.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Action {
            $($(#[doc = $doc])+ $name($first_type $(, $type)*),)+
        }

        /// All forms of each action.
        const WRITTEN: &[&[StatementForm]] = &[$({
            fn made(($first, $($operand),*): ($first_type, $($type),*)) -> Action {
                Action::$name($first $(, $operand)*)
            }
            const FORMS: &[StatementForm] =
                &[$(StatementForm { usage: $usage, read: |reader| $read(reader).map(made) }),+];
            FORMS
        }),+];

        /// The keys of events, and how each becomes statements.
        pub(crate) const KEYS: &[(&str, Form)] =
            &[("do", Form::Statement), $($($(($key, $form)),+,)?)+];

        impl Action {
            /// Does it.
            pub(super) fn act(self, scene: &mut Scene<'_, '_, '_>) {
                match self {
                    $(Self::$name($first $(, $operand)*) => $act(scene, $first $(, $operand)*),)+
                }
            }

            /// Prepares for it before time begins.
            pub(super) fn announce(&self, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
                match self {
                    $(Self::$name(first, ..) => {
                        let _ = first;
                        $($announce(first, access, memory);)?
                    })+
                }
            }

            /// Returns whether a run continues until the action is done, because it begins something.
            pub(super) const fn keeps_the_run(&self) -> bool {
                match self {
                    $(Self::$name(..) => false $(|| $keeps)?,)+
                }
            }
        }
    };
}

actions! {
    /// Gives an input a level, or a virtual bit its state.
    Set(bit: Bit, level: bool) {
        does lines::set;
        announces lines::announce;
        written { "bit N = 1" => lines::read_bit, "set bit N" => lines::read_set, "clear bit N" => lines::read_clear }
        keys { "set_bit" => Form::Each("bit {key} = {value}") }
    }
    /// Inverts the level.
    Toggle(bit: Bit) {
        does lines::toggle;
        announces lines::announce;
        written { "toggle bit N" => lines::read_toggle }
    }
    /// Inverts the level for a time.
    Pulse(bit: Bit, duration: Cycles) {
        does lines::pulse;
        announces lines::announce;
        written { "pulse bit N for TIME" => lines::read_pulse }
    }
    /// Presses the switch of an input, or closes its contact: the level that it has there.
    Press(bit: Bit) {
        does lines::press;
        announces lines::announce;
        written { "press bit N" => lines::read_toggle }
    }
    /// Gives an input back to its switch, which an earlier action has overridden.
    Release(bit: Bit) {
        does lines::release;
        announces lines::announce;
        written { "release bit N" => lines::read_toggle }
    }
    /// Inverts the level of an input as a contact does that bounces for a time.
    Bounce(bit: Bit, duration: Cycles) {
        does lines::bounce;
        announces lines::announce;
        written { "bounce bit N for TIME" => lines::read_pulse }
    }
    /// Lets an analog input take a course.
    Adc(channel: usize, wave: Wave) {
        does lines::adc;
        announces lines::connect_adc;
        written { "adc N = VALUE" => lines::read_adc }
        keys { "adc" => Form::Each("adc {key} = {value}") }
    }
    /// Moves the load of an axis, in its units.
    Push(axis: AxisId, units: f64) {
        does mechanics::push;
        written { "axis N push UNITS" => mechanics::read_push }
        keys { "disturb" => Form::Fields(&["axis {axis} push {units}"]) }
    }
    /// Changes the constant load of the motor of an axis, in units per second.
    Pull(axis: AxisId, speed: f64) {
        does mechanics::pull;
        written { "axis N pull = SPEED" => mechanics::read_pull }
    }
    /// Loads the spindle on the encoder of an axis, from 0 to 1.
    LoadSpindle(axis: AxisId, load: f64) {
        does mechanics::load_spindle;
        written { "spindle N load = PART" => mechanics::read_load_spindle }
    }
    /// Turns the encoder on an input by counts, over a time.
    Turn(input: usize, counts: f64, over: Cycles) {
        does mechanics::turn;
        announces mechanics::announce_turn;
        written { "encoder N moves COUNTS" => mechanics::read_turn }
        keys { "encoder" => Form::Each("encoder {key} moves {value}") }
    }
    /// Both phases of an encoder input change at once, which its error bit keeps.
    EncoderError(channel: usize) {
        does mechanics::fail;
        written { "encoder N fails" => mechanics::read_fail }
        keys { "encoder_error" => Form::One("encoder {value} fails") }
    }
    /// Sends characters to the UART, at its rate.
    Uart(bytes: Vec<u8>) {
        does computer::uart;
        written { "uart \"text\"" => computer::read_uart }
        keys { "uart" => Form::One("uart {value}") }
    }
    /// Stores an element of `persist.UserData`.
    Persist(index: usize, value: i32) {
        does computer::persist;
        written { "persist N = VALUE" => computer::read_persist }
        keys { "persist" => Form::Each("persist {key} = {value}") }
    }
    /// Executes the program of a thread, as the PC does.
    Start(thread: ThreadId) {
        does computer::start;
        keeps true;
        written { "start thread N" => computer::read_start }
    }
    /// Loads a program of this name into a thread and executes it, as the PC does.
    Run(thread: ThreadId, name: Arc<str>) {
        does computer::run;
        keeps true;
        written { "run thread N \"FILE\"" => computer::read_run }
        keys { "run" => Form::Fields(&["run thread {thread} {program}", "start thread {thread}"]) }
    }
    /// Sets the PC's next answer, as `key=value`.
    Answer(setting: String) {
        does computer::answer;
        written { "answer \"KEY=VALUE\"" => computer::read_answer }
        keys { "host" => Form::Each("answer {setting}") }
    }
    /// Sends a script command, as the PC does.
    Command(line: String) {
        does computer::command;
        keeps true;
        written { "command \"LINE\"" => computer::read_command }
        keys { "command" => Form::One("command {value}") }
    }
    /// Stops a thread, as the PC does.
    Kill(thread: ThreadId) {
        does computer::kill;
        written { "stop thread N" => computer::read_kill, "kill thread N" => computer::read_kill }
        keys { "kill" => Form::One("kill {value}") }
    }
    /// Does what a person at the machine does; on a connected controller the person is asked to.
    Manual(step: ManualStep) {
        does manual::act;
        announces manual::announce;
        written { "manual \"TEXT\" ACTION" => manual::read_manual }
    }
    /// Connects a device.
    Attach(device: DeviceSpec) {
        does options::attach;
        announces options::announce_device;
        written { "device NAME KEY=VALUE" => options::read_device }
    }
    /// Gives an input of a Konnect board a level.
    Konnect(board: KonnectBoard, input: u8, level: bool) {
        does options::konnect;
        written { "konnect N input I = 1" => options::read_konnect }
    }
    /// Changes what a side of a SnapAmp measures.
    SnapAmp(board: usize, side: Side, quantity: Quantity, value: f64) {
        does options::snapamp;
        announces options::announce_snapamp;
        written { "snapamp N current A = VALUE" => options::read_snapamp }
    }
    /// Fails the run if something is not as it should be.
    Expect(expectation: Expectation) {
        does expectation::check;
        written { "expect CONDITION" => expectation::read }
        keys {
            "expect" => Form::Nested("expect", &[
                ("bit", Form::Each("expect bit {key} = {value}")),
                ("persist", Form::Each("expect persist {key} = {value}")),
                ("printed", Form::One("expect printed {value}")),
            ])
        }
    }
}

/// Reads an action.
pub(super) fn read(reader: &mut StatementReader<'_>) -> Result<Action, Mistake> {
    without_set(reader)?;
    let word = reader.peek().unwrap_or_default();
    let named = || WRITTEN.iter().copied().flatten().filter(|written| written.word() == word);
    let Some(StatementForm { read, .. }) =
        named().find(|written| written.fits(reader)).or_else(|| named().next())
    else {
        return reader.expected(&words());
    };
    reader.advance();
    read(reader)
}

/// Refuses `set` before what is written without it, as in `set adc 3 = 950`.
fn without_set(reader: &mut StatementReader<'_>) -> Result<(), Mistake> {
    let meant = reader.word(1).filter(|word| reader.peek() == Some("set") && *word != "bit");
    let meant = meant.and_then(|word| WRITTEN.iter().copied().flatten().find(|form| form.word() == word));
    let Some(StatementForm { usage, .. }) = meant else { return Ok(()) };
    Err((reader.column(), format!("write `{usage}` without `set`")))
}

/// The words that actions begin with, for a message.
fn words() -> String {
    let mut words: Vec<_> = WRITTEN.iter().copied().flatten().map(StatementForm::word).collect();
    words.dedup();
    let (last, others) = words.split_last().expect("there are actions");
    let quoted: Vec<_> = others.iter().map(|word| format!("`{word}`")).collect();
    format!("{} or `{last}`", quoted.join(", "))
}

/// All forms of all actions, as an explanation shows them.
pub fn usages() -> impl Iterator<Item = &'static str> {
    WRITTEN.iter().copied().flatten().map(|written| written.usage)
}
