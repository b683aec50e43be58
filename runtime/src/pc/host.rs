//! The minimal PC: polls the board's status and answers requests of programs.
//!
//! Source: gather-persist-console.md sections 7 and 8. A program stores parameters from `UserData[101]` on, then a code
//! in `UserData[100]`, and waits until the code is no longer positive.

use kmotiondef::limits::{N_USER_DATA_VARS, PC_COMM_PERSIST};
use kmotiondef::structs::Persist;
use kmotiondef::variables::{
    COORD_SYSTEM0, CS0_LAST_FRO, CS0_LAST_RAPID_FRO, GATHER_BUFFER, HOST_STATUS, PERSIST,
    STATUS_REQUEST_COUNTER,
};
use kmotiondef::{Cycles, GuestAddr, Place, ThreadId};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use super::answers::{self, AnswerError, Answers, Boxes};
use super::boxes::OpenBox;
use super::requests::{Change, Direction, PcAction, Rate};
use super::{gcode, requests};
use crate::out::{EventKind, Message, Out};
use crate::servo::coordinated::rate;
use crate::servo::coordinated::system::nominal_change_time;
use crate::servo::hold;
use crate::views::TypedAccess;

/// Ticks between two polls: 0.1 s.
const POLL_TICKS: u64 = 1111;
/// The time for which a request waits for an absent PC before this is reported: 5 s.
const PATIENCE: Cycles = Cycles::new(5 * Cycles::PER_SECOND.get());
/// Longest string the PC reads, in words.
pub(super) const STRING_WORDS: u32 = 50;
/// Success.
const DONE: i32 = 0;
/// The request is invalid.
const INVALID: i32 = -1;
/// A tool that does not exist.
const BAD_TOOL: i32 = -2;
/// Tools of the table.
const TOOLS: i32 = 100;

/// The state of the PC.
#[derive(Clone, Debug)]
pub(crate) struct Host {
    /// True if there is a PC at all.
    is_connected: bool,
    /// Ticks until it polls.
    until_poll: u64,
    /// Its answers and variables.
    answers: Answers,
    jog_overrides: [f32; 6],
    /// The request that is not answered and was shown.
    unanswered: i32,
    /// The time since which a request waits for a missing PC; `None` once this was reported.
    waits_since: Option<Cycles>,
    /// The waiting request, and the thread that has made it.
    pending: Option<(i32, ThreadId)>,
}

impl Default for Host {
    fn default() -> Self {
        Self {
            is_connected: true,
            until_poll: POLL_TICKS,
            answers: Answers::default(),
            jog_overrides: [1.0; 6],
            unanswered: 0,
            waits_since: None,
            pending: None,
        }
    }
}

impl Host {
    /// Connects or removes the PC.
    pub(crate) fn connect(&mut self, is_connected: bool) {
        self.is_connected = is_connected;
    }

    /// Returns whether there is a PC, which also serves files.
    pub(crate) const fn is_connected(&self) -> bool {
        self.is_connected
    }

    /// Sets its answers.
    pub(crate) fn answer_with(&mut self, answers: Answers) {
        self.answers = answers;
    }

    /// Gives it its next answer.
    pub(crate) fn answer_next(&mut self, setting: &str) -> Result<(), AnswerError> {
        self.answers.set_next(setting)
    }

    /// Returns its answers and variables.
    pub(super) const fn answers(&self) -> &Answers {
        &self.answers
    }

    /// Returns whether it leaves a request without an answer.
    pub(super) fn is_silent(&self, code: i32) -> bool {
        self.answers.silent.contains(&code)
    }

    /// Returns whether a job runs on it when the board starts.
    pub(crate) const fn has_job(&self) -> bool {
        self.answers.has_job
    }

    /// Returns whether a program waits for an answer that will come.
    pub(crate) fn is_asked(&self, memory: &GuestMemory) -> bool {
        let code = memory.get(data(0));
        self.is_connected && code > 0 && !self.answers.silent.contains(&code) && !self.is_for_person(code)
    }

    /// The box that the PC shows and that waits for a person, if there is one.
    pub(crate) fn open_box(&self, memory: &GuestMemory) -> Option<OpenBox> {
        let code = memory.get(data(0));
        if !self.is_connected || self.unanswered != code || !self.is_for_person(code) {
            return None;
        }
        Some(open_box_of(memory, code))
    }

    /// Returns whether a request opens a box that a person still has to answer.
    pub(super) fn is_for_person(&self, code: i32) -> bool {
        let Boxes { waits, buttons, inputs } = &self.answers.boxes;
        let is_open = requests::action(code).is_some_and(|action| {
            (action == PcAction::MessageBox && buttons.is_empty())
                || (action == PcAction::InputBox && inputs.is_empty())
        });
        *waits && is_open && !self.answers.results.contains_key(&code)
    }

    /// Shows the box of a request that waits for a person; returns its text the first time.
    pub(super) fn show_box(&mut self, memory: &GuestMemory, code: i32) -> Option<String> {
        let is_new = std::mem::replace(&mut self.unanswered, code) != code;
        is_new.then(|| open_box_of(memory, code).shown())
    }

    /// No request waits any more.
    pub(super) const fn forget_request(&mut self) {
        self.unanswered = 0;
    }

    /// Leaves boxes open until a person answers them.
    pub(super) const fn leave_boxes_open(&mut self) {
        self.answers.boxes.waits = true;
    }

    /// Returns the number of ticks until it polls the board again.
    pub(crate) fn quiet_ticks(&self) -> u64 {
        if self.is_connected { self.until_poll.saturating_sub(2) } else { u64::MAX }
    }

    /// Lets several ticks pass at once.
    pub(crate) fn skip(&mut self, ticks: u64) {
        self.until_poll = self.until_poll.saturating_sub(ticks);
    }

    /// Lets one tick pass.
    pub(crate) fn tick(&mut self) {
        self.until_poll = self.until_poll.saturating_sub(1);
    }

    /// The slice of a thread has ended: whether it has overwritten the request of another one.
    pub(crate) fn watch(&mut self, memory: &GuestMemory, thread: ThreadId) -> Option<Message> {
        let code = memory.get(data(0));
        let before = self.pending;
        if code <= 0 {
            self.pending = None;
        } else if before.is_none_or(|(pending, _)| pending != code) {
            self.pending = Some((code, thread));
        }
        let (lost, by) = before.filter(|(lost, _)| code > 0 && code != *lost)?;
        if by != thread {
            return Some(Message::RequestOverwritten { code: lost, by: code });
        }
        // A stop need not wait for earlier requests.
        let stops = matches!(requests::action(code), Some(PcAction::EmergencyStop | PcAction::EndJob));
        (!stops).then_some(Message::RequestReplaced { code: lost, by: code })
    }
}

/// An element of `UserData`, counted from the request's.
fn data(offset: usize) -> Place<i32> {
    PERSIST.field(Persist::USER_DATA).element(PC_COMM_PERSIST + offset)
}

/// An element of `UserData` that a parameter names.
fn named(memory: &GuestMemory, index: i32, count: usize) -> Option<GuestAddr> {
    let index = usize::try_from(index).ok().filter(|index| index + count <= N_USER_DATA_VARS)?;
    Some(memory.locate(PERSIST.field(Persist::USER_DATA).element(index)))
}

/// Doubles in `UserData`, by their index as such.
fn doubles(memory: &GuestMemory, index: i32, count: usize) -> Option<GuestAddr> {
    named(memory, index.checked_mul(2)?, count.checked_mul(2)?)
}

/// Serves the primary thread's slice; returns whether an answer was stored.
pub(crate) fn slice(host: &mut Host, out: &mut Out, context: &mut TickContext<'_>) -> bool {
    if !host.is_connected {
        report_missing_pc(host, out, context);
        return false;
    }
    if host.until_poll > 0 {
        return false;
    }
    host.until_poll = POLL_TICKS;
    let polls = context.memory.get(STATUS_REQUEST_COUNTER).wrapping_add(1);
    context.memory.set(STATUS_REQUEST_COUNTER, polls);
    hold::update_state(context.memory);
    let code = context.memory.get(data(0));
    if code <= 0 {
        host.unanswered = 0;
    } else if host.answers.silent.contains(&code) {
        if host.unanswered != code {
            host.unanswered = code;
            emit_remark_text(out, context, format!("request {code} gets no answer"));
        }
    } else if host.is_for_person(code) {
        if let Some(text) = host.show_box(context.memory, code) {
            emit_remark_text(out, context, text);
        }
    } else {
        host.unanswered = 0;
        host.pending = None;
        let answer = answer(host, out, context, code);
        context.memory.set(data(0), answer);
        return true;
    }
    false
}

/// The box that a request opens.
fn open_box_of(memory: &GuestMemory, code: i32) -> OpenBox {
    let text = string(memory, memory.get(data(1)));
    if requests::action(code) == Some(PcAction::InputBox) {
        OpenBox::Input { text }
    } else {
        OpenBox::message(text, memory.get(data(2)))
    }
}

/// Says of a request that waits for a PC which is not there that it does.
fn report_missing_pc(host: &mut Host, out: &mut Out, context: &TickContext<'_>) {
    let code = context.memory.get(data(0));
    if code <= 0 || code != host.unanswered {
        host.unanswered = code.max(0);
        host.waits_since = (code > 0).then_some(context.now);
    } else if host.waits_since.is_some_and(|since| context.now - since > PATIENCE) {
        host.waits_since = None;
        out.remark(context.now, Message::NoPc { code });
    }
}

/// Executes a request; its results are stored before the answer.
pub(super) fn answer(host: &mut Host, out: &mut Out, context: &mut TickContext<'_>, code: i32) -> i32 {
    let parameters: [i32; 3] = std::array::from_fn(|index| context.memory.get(data(index + 1)));
    if let Some(text) = requests::shown(code, parameters[0]) {
        emit_remark_text(out, context, text);
    }
    if let Some(&result) = host.answers.results.get(&code) {
        emit_remark_text(out, context, format!("request {code} is answered {result}"));
        return result;
    }
    if matches!(requests::action(code), Some(PcAction::MessageBox | PcAction::Mdi | PcAction::InputBox)) {
        find_text(out, context, code, parameters[0]);
    }
    let number = f32::from_bits(parameters[0] as u32);
    let memory = &mut *context.memory;
    match requests::action(code) {
        None => return INVALID,
        Some(PcAction::Show) => {}
        Some(PcAction::EmergencyStop) => emergency_stop(context),
        Some(PcAction::EndJob) => set_job(memory, false),
        Some(PcAction::BeginJob) if host.answers.has_job => set_job(memory, true),
        Some(PcAction::BeginJob) => {}
        Some(PcAction::Override(Rate::Feed, Change::To)) if !(0.001..=1000.0).contains(&number) => {
            let bits = parameters[0];
            let held = match bits {
                1..=100_000 => {
                    format!("persist.UserData[101] holds the integer {bits}, and a float is needed")
                }
                _ => format!("{number:?}, the float in persist.UserData[101], is not from 0.001 to 1000"),
            };
            emit_remark_text(out, context, format!("feed override: refused, as {held}"));
            return INVALID;
        }
        Some(PcAction::Override(rate, change)) => set_override(out, context, (rate, change), number),
        Some(PcAction::Display(axis)) => host.answers.dros[axis] = f64::from(number),
        Some(PcAction::MessageBox) => message_box(host, out, context, parameters),
        Some(PcAction::Variables(direction)) => return variables(host, memory, direction, parameters),
        Some(PcAction::Mdi) => mdi(host, out, context, parameters[0]),
        Some(PcAction::Resolutions) => return store_floats(memory, parameters[0], &host.answers.resolutions),
        Some(PcAction::Tool(kind, direction)) => return tool(host, memory, (kind, direction), parameters),
        Some(PcAction::Settings) => return store_words(memory, parameters[0], &host.answers.setup),
        Some(PcAction::Displays) => return store_doubles(memory, parameters[0], &host.answers.dros),
        Some(PcAction::InputBox) => input_box(host, out, context, parameters[0]),
        Some(PcAction::JogOverride(axis, Direction::Get)) => {
            memory.set(data(1), host.jog_overrides[axis].to_bits() as i32);
        }
        Some(PcAction::JogOverride(axis, Direction::Set)) => host.jog_overrides[axis] = number,
        Some(PcAction::Cell) => return edit_cell(host, memory, parameters[0]),
    }
    DONE
}

fn emit_remark_text(out: &mut Out, context: &TickContext<'_>, text: String) {
    out.emit(context.now, EventKind::Host(text));
}

/// Stops threads 2 to 7 and coordinated motion.
fn emergency_stop(context: &mut TickContext<'_>) {
    ThreadId::all().skip(1).for_each(|thread| context.threads.pause(thread));
    context.memory.set(kmotiondef::variables::CS0_STOPPING_STATE, 0);
    context.memory.set(COORD_SYSTEM0, GuestAddr::NULL);
}

/// Sets the feed or the rapid override, or changes it by a factor.
fn set_override(out: &mut Out, context: &mut TickContext<'_>, (rate, change): (Rate, Change), number: f32) {
    let memory = &mut *context.memory;
    let time = nominal_change_time(memory);
    let old = match (change, rate) {
        (Change::To, _) => 1.0,
        (Change::By, Rate::Feed) => memory.get(CS0_LAST_FRO),
        (Change::By, Rate::Rapid) => memory.get(CS0_LAST_RAPID_FRO),
    };
    let value = old * number;
    let name = match rate {
        Rate::Feed => {
            rate::set_feed(memory, value, time);
            "feed"
        }
        Rate::Rapid => {
            rate::set_rapid(memory, value, time);
            "rapid"
        }
    };
    emit_remark_text(out, context, format!("{name} override {value}"));
}

/// Tells the board whether a job runs.
fn set_job(memory: &mut GuestMemory, runs: bool) {
    let status = memory.get(HOST_STATUS);
    memory.set(HOST_STATUS, status & !1 | i32::from(runs));
}

/// Makes a remark about a request without a text, if there is a text at the same offset counted in bytes or in doubles.
fn find_text(out: &mut Out, context: &TickContext<'_>, code: i32, offset: i32) {
    const LEAST: usize = 2;
    let memory = &*context.memory;
    let buffer = memory.get(GATHER_BUFFER);
    let is_text_at = |address: GuestAddr| {
        let bytes = memory.read_c_string(address, 4 * STRING_WORDS).unwrap_or_default();
        bytes.len() >= LEAST && bytes.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace())
    };
    let is_text = |unit: u32| is_text_at(buffer.offset(offset.cast_unsigned().wrapping_mul(unit)));
    // Addresses of the memory of programs are negative as numbers.
    if offset < 0 && is_text_at(GuestAddr::new(offset.cast_unsigned())) {
        return out.remark(context.now, Message::TextAddress { code });
    }
    if offset <= 0 || is_text(4) {
        return;
    }
    let found = [("bytes", 1, offset / 4), ("doubles", 8, offset.saturating_mul(2))];
    if let Some((unit, _, words)) = found.into_iter().find(|(_, size, _)| is_text(*size)) {
        out.remark(context.now, Message::TextElsewhere { code, offset, unit, words });
    }
}

/// A string in the gather buffer at a word offset.
fn string(memory: &GuestMemory, offset: i32) -> String {
    let address = memory.get(GATHER_BUFFER).offset((offset as u32).wrapping_mul(4));
    let bytes = memory.read_c_string(address, 4 * STRING_WORDS).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Buttons of a message box.
const BUTTONS: i32 = 0xf;

/// Shows a box and presses the button that was chosen for it, or its first one that continues the program. The line
/// names the button, unless there is only one.
fn message_box(host: &mut Host, out: &mut Out, context: &mut TickContext<'_>, [offset, flags, _]: [i32; 3]) {
    let text = string(context.memory, offset);
    let default = match flags & BUTTONS {
        2 => 5,
        3 | 4 => 6,
        5 => 4,
        _ => 1,
    };
    let named = host.answers.boxes.press();
    let pressed = named.unwrap_or(default);
    let has_choice = OpenBox::message(String::new(), flags).has_choice();
    let answer = match answers::button_name(pressed) {
        _ if named.is_none() && !has_choice => String::new(),
        Some(name) => format!(" ({name}, {pressed})"),
        None => format!(" ({pressed})"),
    };
    emit_remark_text(out, context, format!("message box: {text}{answer}"));
    context.memory.set(data(3), pressed);
}

/// Shows a prompt and types the number that was named for it, or 0.
fn input_box(host: &mut Host, out: &mut Out, context: &mut TickContext<'_>, offset: i32) {
    let prompt = string(context.memory, offset);
    let typed = host.answers.boxes.type_in().unwrap_or(Some(0.0));
    let answer = typed.map_or_else(|| "cancel".to_owned(), |number| number.to_string());
    emit_remark_text(out, context, format!("input box: {prompt} ({answer})"));
    context.memory.set(data(2), typed.unwrap_or(0.0).to_bits().cast_signed());
    context.memory.set(data(3), i32::from(typed.is_none()));
}

/// Shows a line of G code. Only assignments to #variables are executed, all of them or none.
fn mdi(host: &mut Host, out: &mut Out, context: &mut TickContext<'_>, offset: i32) {
    let line = string(context.memory, offset);
    let found = gcode::assignments(&line, &host.answers.variables);
    let result = host.answers.mdi.next();
    let answer = result.map_or(String::new(), |result| format!(" (result {result})"));
    let trouble = match found {
        Ok(assignments) => {
            host.answers.variables.extend(assignments);
            String::new()
        }
        Err(gcode::UnsupportedText(text)) => format!(": {text}; no variable is changed"),
    };
    emit_remark_text(out, context, format!("MDI: {line}{answer}{trouble}"));
    context.memory.set(data(2), result.unwrap_or(0));
}

/// Copies #variables to or from `UserData`.
fn variables(
    host: &mut Host,
    memory: &mut GuestMemory,
    direction: Direction,
    [first, count, index]: [i32; 3],
) -> i32 {
    let Some(place) = usize::try_from(count).ok().and_then(|count| doubles(memory, index, count)) else {
        return INVALID;
    };
    for (number, offset) in (first..first.saturating_add(count)).zip((0..).step_by(8)) {
        let place = place.offset(offset);
        match direction {
            Direction::Set => {
                host.answers.variables.insert(number, memory.peek(place));
            }
            Direction::Get => memory.poke(place, host.answers.variables.get(&number).copied().unwrap_or(0.0)),
        }
    }
    DONE
}

/// Gets or sets one entry of the tool table.
fn tool(
    host: &mut Host,
    memory: &mut GuestMemory,
    (kind, direction): (i32, Direction),
    [tool, index, _]: [i32; 3],
) -> i32 {
    if !(0..TOOLS).contains(&tool) {
        return BAD_TOOL;
    }
    let Some(place) = doubles(memory, index, 1) else { return INVALID };
    match direction {
        Direction::Set => {
            host.answers.tools.insert((kind, tool), memory.peek(place));
        }
        Direction::Get => memory.poke(place, host.answers.tools.get(&(kind, tool)).copied().unwrap_or(0.0)),
    }
    DONE
}

fn store_words(memory: &mut GuestMemory, index: i32, words: &[i32]) -> i32 {
    let Some(place) = named(memory, index, words.len()) else { return INVALID };
    for (offset, word) in (0..).step_by(4).zip(words) {
        memory.poke(place.offset(offset), *word);
    }
    DONE
}

fn store_floats(memory: &mut GuestMemory, index: i32, floats: &[f32]) -> i32 {
    let words: Vec<i32> = floats.iter().map(|float| float.to_bits() as i32).collect();
    store_words(memory, index, &words)
}

fn store_doubles(memory: &mut GuestMemory, index: i32, values: &[f64]) -> i32 {
    let Some(place) = doubles(memory, index, values.len()) else { return INVALID };
    for (offset, value) in (0..).step_by(8).zip(values) {
        memory.poke(place.offset(offset), *value);
    }
    DONE
}

/// The text of a screen cell: "0" where no other was named.
fn edit_cell(host: &Host, memory: &mut GuestMemory, variable: i32) -> i32 {
    let Some(place) = named(memory, variable, 1) else { return INVALID };
    let offset: u32 = memory.peek(place);
    let address = memory.get(GATHER_BUFFER).offset(offset.wrapping_mul(4));
    let text = host.answers.cells.get(&variable).map_or("0", String::as_str);
    let stored = memory.write_bytes(address, &[text.as_bytes(), b"\0"].concat());
    if stored.is_ok() { DONE } else { INVALID }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    /// Makes a request and returns the answer, which takes at most 0.2 s.
    fn ask(bench: &mut TestBench, code: i32, parameters: &[i32]) -> i32 {
        for (index, parameter) in parameters.iter().enumerate() {
            bench.memory.set(data(index + 1), *parameter);
        }
        bench.memory.set(data(0), code);
        bench.run(2222);
        bench.memory.get(data(0))
    }

    #[test]
    fn a_message_box_is_answered() {
        let mut bench = TestBench::new();
        let buffer = bench.memory.get(GATHER_BUFFER);
        bench.memory.poke_bytes(buffer.offset(400), b"go on?\0").expect("mapped");
        let boxes = [
            (0, 1, ""),
            (1, 1, " (ok, 1)"),
            (2, 5, " (ignore, 5)"),
            (3, 6, " (yes, 6)"),
            (4, 6, " (yes, 6)"),
            (5, 4, " (retry, 4)"),
        ];
        for (flags, pressed, shown) in boxes {
            assert_eq!(ask(&mut bench, 15, &[100, flags, 0]), DONE);
            assert_eq!(bench.memory.get(data(3)), pressed);
            let told: Vec<_> = bench.kernel.parts.out.take_events();
            assert_eq!(told[0].kind, EventKind::Host(format!("message box: go on?{shown}")));
        }
        ask(&mut bench, 29, &[100]);
        let told: Vec<_> = bench.kernel.parts.out.take_events();
        assert_eq!(told[0].kind, EventKind::Host("input box: go on? (0)".to_owned()));
    }

    #[test]
    fn every_request_gets_an_answer_that_lets_the_program_continue() {
        let mut bench = TestBench::new();
        for code in 1..=55 {
            // An element of UserData, an index of doubles, a tool and a number: each is valid for requests that take
            // it.
            let first = match code {
                5..=12 | 21 | 22 | 46..=51 | 54 | 55 => 1.0_f32.to_bits().cast_signed(),
                _ => 10,
            };
            assert_eq!(ask(&mut bench, code, &[first, 1, 20]), DONE, "request {code}");
            let shown = bench
                .kernel
                .parts
                .out
                .take_events()
                .into_iter()
                .any(|event| matches!(event.kind, EventKind::Host(_)));
            assert!(shown, "request {code} is not shown");
        }
    }

    #[test]
    fn a_request_without_a_pc_is_reported_once() {
        let mut bench = TestBench::new();
        bench.kernel.parts.pc.host.connect(false);
        assert_eq!(ask(&mut bench, 15, &[100, 0, 0]), 15);
        bench.run(60_000);
        bench.run(60_000);
        let expect = "request 15 waits for a PC, but none is connected (`host.enabled = false`)".to_owned();
        assert_eq!(bench.diagnostics(), [expect]);
    }

    #[test]
    fn requests_that_cannot_be_met_return_an_error() {
        let mut bench = TestBench::new();
        assert_eq!(ask(&mut bench, 99, &[]), INVALID);
        assert_eq!(ask(&mut bench, 23, &[100, 10]), BAD_TOOL);
        assert_eq!(ask(&mut bench, 5, &[0]), INVALID);
        assert_eq!(ask(&mut bench, 19, &[198]), INVALID);
    }

    #[test]
    fn overrides_reach_the_board() {
        let mut bench = TestBench::new();
        for (code, number, expect) in [(5, 0.5, (0.5, 1.0)), (6, 1.5, (0.75, 1.0)), (54, 0.25, (0.75, 0.25))]
        {
            assert_eq!(ask(&mut bench, code, &[f32::to_bits(number) as i32]), DONE);
            let overrides = (bench.memory.get(CS0_LAST_FRO), bench.memory.get(CS0_LAST_RAPID_FRO));
            assert_eq!(overrides, expect, "{code}");
        }
    }

    #[test]
    fn variables_and_tools_are_kept() {
        let mut bench = TestBench::new();
        let place = doubles(&bench.memory, 5, 1).expect("inside");
        bench.memory.poke(place, 2.5);
        for (set, get, parameters) in [(17, 16, [500, 1, 5]), (24, 23, [7, 5, 0]), (31, 30, [7, 5, 0])] {
            assert_eq!(ask(&mut bench, set, &parameters), DONE);
            bench.memory.poke(place, 0.0);
            assert_eq!(ask(&mut bench, get, &parameters), DONE);
            assert_eq!(bench.memory.peek::<f64>(place), 2.5, "{get}");
        }
    }

    #[test]
    fn answers_can_be_set_in_advance() {
        let mut bench = TestBench::new();
        let mut answers = Answers::default();
        for setting in
            ["msgbox=no", "input=2.5", "mdi=-3", "request.14=-7", "cell.110=1.25", "request.13=never"]
        {
            answers.set(setting).expect(setting);
        }
        bench.kernel.parts.pc.host.answer_with(answers);
        let buffer = bench.memory.get(GATHER_BUFFER);
        bench.memory.poke_bytes(buffer.offset(400), b"#5=1.5 #6 = -2\0").expect("mapped");
        assert_eq!(ask(&mut bench, 15, &[100, 4, 0]), DONE);
        assert_eq!(bench.memory.get(data(3)), 7);
        assert_eq!(ask(&mut bench, 29, &[100]), DONE);
        assert_eq!(f32::from_bits(bench.memory.get(data(2)).cast_unsigned()), 2.5);
        assert_eq!(ask(&mut bench, 18, &[100]), DONE);
        assert_eq!(bench.memory.get(data(2)), -3);
        assert_eq!(ask(&mut bench, 16, &[5, 2, 10]), DONE);
        let variables = [0, 8].map(|offset| {
            bench.memory.peek::<f64>(doubles(&bench.memory, 10, 1).expect("inside").offset(offset))
        });
        assert_eq!(variables, [1.5, -2.0]);
        assert_eq!(ask(&mut bench, 14, &[3]), -7);
        assert_eq!(ask(&mut bench, 53, &[110]), DONE);
        assert_eq!(bench.memory.read_c_string(buffer, 10).expect("mapped"), b"1.25");
        assert_eq!(ask(&mut bench, 13, &[1]), 13);
    }
}
