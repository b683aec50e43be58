//! Plays a stimulus: what is due is done, and what the board does is watched for.

use std::collections::{BTreeMap, VecDeque};

use kmotiondef::bits::{BitDirection, range_of};
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{KANALOG_PRESENT, PERSIST, SNAP_AMP_PRESENT};
use kmotiondef::{AxisId, Bit, Cycles, ThreadId};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;
use vm::scheduler::ThreadSet;

use super::wave::conversion;
use super::{Action, Condition, Expectation, Rule, Stimulus, Trigger, Wave};
use crate::firmware::io::{bit_state, write_bit};
use crate::io::changes::BitChange;
use crate::io::kanalog::ADC_CHANNELS;
use crate::kernel::{Kernel, Request};
use crate::machine::plant::COUNTS_PER_TICK;
use crate::out::EventKind;
use crate::views::Typed;

/// Inputs of Kanalog.
const KANALOG_INPUTS: std::ops::RangeInclusive<u16> = 128..=143;

/// Settings of devices that name one of its analog inputs.
const KANALOG_SETTINGS: &[&str] = &["adc", "sine", "cosine"];

/// What is due at an instant.
#[derive(Clone, Copy, Debug)]
enum Due {
    /// A rule.
    Rule(usize),
    /// A pulse ends: the level before it.
    Level(Bit, bool),
}

/// The most that may be planned at a time.
pub const MOST_PLANNED: usize = 100_000;

/// An encoder on its way.
#[derive(Clone, Copy, Debug)]
struct Turning {
    axis: AxisId,
    counts: f64,
    begun: Cycles,
    over: Cycles,
    /// Counts already turned.
    turned: f64,
}

/// A stimulus under way.
#[derive(Debug)]
pub(crate) struct Player {
    rules: Vec<Rule>,
    /// What is due, by time and then in the order it became so.
    due: BTreeMap<(Cycles, u64), Due>,
    count: u64,
    waves: [Option<(Wave, Cycles)>; ADC_CHANNELS],
    turning: Vec<Turning>,
    /// When each rule that waited for something was due last. At one instant it happens once, so that rules which
    /// make each other happen do not multiply.
    last_due: Vec<Option<Cycles>>,
    /// Whether it was said that too much was planned.
    has_told_surplus: bool,
    /// Expectations of a printed text that has been printed.
    said: Vec<bool>,
    /// Console lines that no statement has been compared with yet.
    lines: VecDeque<(Cycles, String)>,
    active: ThreadSet,
    /// The analog value each input was last given.
    converted: [i32; ADC_CHANNELS],
}

impl Player {
    /// Nothing yet.
    pub(crate) fn new() -> Self {
        Self {
            rules: Vec::new(),
            due: BTreeMap::new(),
            count: 0,
            waves: [None; ADC_CHANNELS],
            turning: Vec::new(),
            last_due: Vec::new(),
            has_told_surplus: false,
            said: Vec::new(),
            lines: VecDeque::new(),
            active: ThreadSet::EMPTY,
            converted: [-1; ADC_CHANNELS],
        }
    }

    /// Gets ready for more; an option board that something happens to was found at power-up.
    pub(crate) fn extend(&mut self, stimulus: Stimulus, kernel: &mut Kernel, memory: &mut GuestMemory) {
        for rule in stimulus.rules {
            announce(&rule.action, kernel, memory);
            let index = self.rules.len();
            match rule.trigger {
                Trigger::At(time) | Trigger::Every { from: time, .. } => self.plan(time, Due::Rule(index)),
                Trigger::When { .. } | Trigger::End => {}
            }
            self.rules.push(rule);
            self.last_due.push(None);
            self.said.push(false);
        }
    }

    /// Bits whose changes statements wait for.
    pub(crate) fn watched(&self) -> impl Iterator<Item = Bit> {
        self.rules.iter().filter_map(|rule| match &rule.trigger {
            Trigger::When { condition: Condition::Bit(bit, _), .. } => Some(*bit),
            _ => None,
        })
    }

    fn plan(&mut self, at: Cycles, due: Due) {
        self.due.insert((at, self.count), due);
        self.count += 1;
    }

    /// The PC has received a line.
    pub(crate) fn note_line(&mut self, line: &[u8], at: Cycles) {
        let line = String::from_utf8_lossy(line).into_owned();
        for (rule, said) in self.rules.iter().zip(&mut self.said) {
            if let Action::Expect(Expectation::Printed(text, _)) = &rule.action {
                *said |= line.contains(text.as_str());
            }
        }
        self.lines.push_back((at, line));
    }

    /// Whether a thread is still to be started or a command to be sent, so that the run must go on.
    pub(crate) fn is_busy(&self) -> bool {
        self.due.values().any(|due| match due {
            Due::Rule(index) => {
                matches!(self.rules[*index].action, Action::Start(_) | Action::Run(..) | Action::Command(_))
            }
            Due::Level(..) => false,
        })
    }

    /// How many of the ticks behind the one that began at `now` have nothing to do.
    pub(crate) fn quiet_ticks(&self, now: Cycles) -> u64 {
        let moves = self.waves.iter().flatten().any(|(wave, begun)| !wave.is_over(now - *begun));
        if moves || !self.turning.is_empty() || !self.lines.is_empty() {
            return 0;
        }
        let Some((&(at, _), _)) = self.due.first_key_value() else { return u64::MAX };
        let tick = Cycles::PER_TICK.get();
        let first = at.get().saturating_add(tick - 1) / tick;
        u64::try_from(first - now.get() / tick - 1).unwrap_or(0)
    }

    /// What the world does at the beginning of a tick; whether it did anything.
    pub(crate) fn tick(
        &mut self,
        kernel: &mut Kernel,
        context: &mut TickContext<'_>,
        changes: &[BitChange],
    ) -> bool {
        self.watch_bits(changes);
        self.watch_lines();
        self.watch_threads(context);
        self.limit(kernel, context.now);
        let mut acted = false;
        while let Some(entry) = self.due.first_entry()
            && entry.key().0 <= context.now
        {
            acted = true;
            match entry.remove() {
                Due::Level(bit, level) => drive(kernel, context, bit, level),
                Due::Rule(index) => self.act(kernel, context, index),
            }
        }
        self.turn_encoders(kernel, context);
        self.run_waves(kernel, context);
        acted || !self.turning.is_empty()
    }

    /// Leaves out what is farthest in the future if too much is planned.
    fn limit(&mut self, kernel: &mut Kernel, now: Cycles) {
        if self.due.len() <= MOST_PLANNED {
            return;
        }
        while self.due.len() > MOST_PLANNED {
            self.due.pop_last();
        }
        if !std::mem::replace(&mut self.has_told_surplus, true) {
            let text =
                format!("the stimulus has more than {MOST_PLANNED} things to do; later ones are left out");
            kernel.tell(now, EventKind::Diagnostic(text));
        }
    }

    fn watch_bits(&mut self, changes: &[BitChange]) {
        for change in changes {
            self.happened(change.at, |condition| {
                matches!(condition, Condition::Bit(bit, edge) if *bit == change.bit && edge.fits(change.level))
            });
        }
    }

    fn watch_lines(&mut self) {
        while let Some((at, line)) = self.lines.pop_front() {
            self.happened(
                at,
                |condition| matches!(condition, Condition::Printed(text) if line.contains(text.as_str())),
            );
        }
    }

    fn watch_threads(&mut self, context: &TickContext<'_>) {
        let before = std::mem::replace(&mut self.active, context.threads.active());
        let after = self.active;
        if before == after {
            return;
        }
        for thread in ThreadId::all().filter(|&thread| before.contains(thread) != after.contains(thread)) {
            let is_active = after.contains(thread);
            self.happened(context.now, |condition| match condition {
                Condition::Starts(named) => is_active && *named == thread,
                Condition::Ends(named) => !is_active && *named == thread,
                Condition::Bit(..) | Condition::Printed(_) => false,
            });
        }
    }

    /// Something has happened at `at`: plans the rules that waited for it.
    fn happened(&mut self, at: Cycles, fits: impl Fn(&Condition) -> bool) {
        for index in 0..self.rules.len() {
            let Trigger::When { condition, after, is_once } = &self.rules[index].trigger else { continue };
            let time = at + *after;
            let was_due = self.last_due[index];
            if fits(condition) && !(*is_once && was_due.is_some()) && was_due != Some(time) {
                self.last_due[index] = Some(time);
                self.plan(time, Due::Rule(index));
            }
        }
    }

    fn act(&mut self, kernel: &mut Kernel, context: &mut TickContext<'_>, index: usize) {
        let now = context.now;
        if let Trigger::Every { period, from, until } = self.rules[index].trigger {
            // Counted from the first, so that rounding to ticks does not add up.
            let next = from + Cycles::new(((now - from).get() / period.get() + 1) * period.get());
            if until.is_none_or(|until| next <= until) {
                self.plan(next, Due::Rule(index));
            }
        }
        match self.rules[index].action.clone() {
            Action::Set(bit, level) => drive(kernel, context, bit, level),
            Action::Toggle(bit) => {
                let level = level(kernel, context.memory, bit);
                drive(kernel, context, bit, !level);
            }
            Action::Pulse(bit, duration) => {
                let level = level(kernel, context.memory, bit);
                drive(kernel, context, bit, !level);
                self.plan(now + duration, Due::Level(bit, level));
            }
            Action::Adc(channel, wave) => self.waves[channel] = Some((wave, now)),
            Action::Push(axis, units) => self.push(kernel, context, axis, units),
            Action::EncoderError(channel) => kernel.encoders.fail(channel),
            Action::Turn(axis, counts, over) => {
                self.turning.push(Turning { axis, counts, begun: now, over, turned: 0.0 });
            }
            Action::Uart(bytes) => kernel.uart.arrive(&bytes, now),
            Action::Persist(index, value) => {
                context.memory.set(PERSIST.field(Persist::USER_DATA).element(index), value);
            }
            Action::Start(thread) => {
                if context.threads.start(thread).is_err() {
                    let text = format!("{}: thread {thread} holds no program", self.rules[index].place);
                    kernel.tell(now, EventKind::Diagnostic(text));
                }
            }
            Action::Run(thread, name) => kernel.ask(Request::Run(thread, name)),
            Action::Answer(setting) => {
                let taken = kernel.host.answer_next(&setting);
                debug_assert!(taken.is_ok(), "it was checked when it was read");
            }
            // No echo is wanted.
            Action::Command(line) => kernel.usb.receive(format!("\u{1b}.{line}\r").as_bytes()),
            Action::Kill(thread) => context.threads.pause(thread),
            Action::Konnect(board, input, level) => kernel.konnects.drive(board, input, level),
            Action::SnapAmp(board, side, quantity, value) => {
                kernel.snapamps.set(board, side, quantity, value, now);
            }
            Action::Attach(device) => {
                if let Ok(device) = device.build() {
                    kernel.attach(device, context.memory, now);
                }
            }
            Action::Expect(_) => self.check(kernel, context, index),
        }
    }

    /// Tells what is not as expected.
    fn check(&self, kernel: &mut Kernel, context: &TickContext<'_>, index: usize) {
        let rule = &self.rules[index];
        let Action::Expect(expectation) = &rule.action else { return };
        if let Some(text) = self.unmet(kernel, context, index, expectation) {
            kernel.tell(context.now, EventKind::Unmet(format!("{}: {text}", rule.place)));
        }
    }

    /// What is not as it should be with the expectation of a rule.
    fn unmet(
        &self,
        kernel: &Kernel,
        context: &TickContext<'_>,
        index: usize,
        expectation: &Expectation,
    ) -> Option<String> {
        match expectation {
            Expectation::Bit(bit, expected) => {
                let level = bit_state(kernel, context.memory, *bit).0;
                (level != *expected)
                    .then(|| format!("bit {bit} is {}, expected {}", u8::from(level), u8::from(*expected)))
            }
            Expectation::Printed(text, expected) => {
                let is_printed = self.said[index];
                (is_printed != *expected).then(|| {
                    let what = if *expected { "no line contains" } else { "a line contains" };
                    format!("{what} \"{text}\"")
                })
            }
            Expectation::Persist(word, expected) => {
                let value = context.memory.get(PERSIST.field(Persist::USER_DATA).element(*word));
                (value != *expected).then(|| format!("UserData[{word}] is {value}, expected {expected}"))
            }
            Expectation::Active(thread, expected) => {
                let is_active = context.threads.state(*thread).is_active();
                (is_active != *expected).then(|| {
                    let state = if is_active { "active" } else { "not active" };
                    format!("thread {thread} is {state}")
                })
            }
        }
    }

    /// The run is over: checks what is expected then, or later than it lasted.
    pub(crate) fn finish(&mut self, kernel: &mut Kernel, context: &TickContext<'_>) {
        let late: Vec<usize> = std::mem::take(&mut self.due)
            .into_values()
            .filter_map(|due| match due {
                Due::Rule(index) => Some(index),
                Due::Level(..) => None,
            })
            .collect();
        let at_end = (0..self.rules.len()).filter(|&index| self.rules[index].trigger == Trigger::End);
        for index in late.into_iter().chain(at_end) {
            self.check(kernel, context, index);
        }
    }

    /// Moves a load at once, or as fast as an encoder can be read.
    fn push(&mut self, kernel: &mut Kernel, context: &TickContext<'_>, axis: AxisId, units: f64) {
        let gain = f64::from(context.memory.axis(axis, Chan::INPUT_GAIN0));
        let ticks = (units / gain / COUNTS_PER_TICK).abs().ceil();
        if gain == 0.0 || ticks <= 1.0 {
            return kernel.servo.push(axis, units);
        }
        let over = Cycles::new((ticks as i64).saturating_mul(Cycles::PER_TICK.get()));
        self.turning.push(Turning { axis, counts: units / gain, begun: context.now, over, turned: 0.0 });
    }

    fn turn_encoders(&mut self, kernel: &mut Kernel, context: &TickContext<'_>) {
        for turning in &mut self.turning {
            let elapsed = context.now - turning.begun;
            let part =
                if elapsed < turning.over { elapsed.get() as f64 / turning.over.get() as f64 } else { 1.0 };
            let step = turning.counts * part - turning.turned;
            turning.turned += step;
            let gain = f64::from(context.memory.axis(turning.axis, Chan::INPUT_GAIN0));
            kernel.servo.push(turning.axis, step * gain);
        }
        self.turning.retain(|turning| context.now - turning.begun < turning.over);
    }

    fn run_waves(&mut self, kernel: &mut Kernel, context: &TickContext<'_>) {
        for channel in 0..ADC_CHANNELS {
            let Some((wave, begun)) = &self.waves[channel] else { continue };
            let load = |axis: AxisId| kernel.servo.plants[axis.index()].load;
            let value = conversion(wave.value(context.now - *begun, load));
            if self.converted[channel] != value {
                self.converted[channel] = value;
                kernel.kanalog.drive(channel, value);
            }
        }
    }
}

/// What will be driven is no accident, and an option board that something happens to is there.
fn announce(action: &Action, kernel: &mut Kernel, memory: &mut GuestMemory) {
    if needs_kanalog(action) {
        memory.set(KANALOG_PRESENT, 1);
    }
    match action {
        Action::SnapAmp(board, ..) => {
            crate::machine::plant::connect_snapamp(kernel, *board);
            memory.set(SNAP_AMP_PRESENT, 1);
        }
        Action::Set(bit, _) | Action::Toggle(bit) | Action::Pulse(bit, _) => kernel.pins.declare(*bit),
        _ => {}
    }
}

/// Whether an action is only possible with a Kanalog.
fn needs_kanalog(action: &Action) -> bool {
    match action {
        Action::Adc(..) => true,
        Action::Attach(device) => {
            device.settings.iter().any(|(key, _)| KANALOG_SETTINGS.contains(&key.as_str()))
        }
        Action::Set(bit, _) | Action::Toggle(bit) | Action::Pulse(bit, _) => {
            KANALOG_INPUTS.contains(&bit.get())
        }
        _ => false,
    }
}

/// Whether a bit lives in guest memory.
fn is_memory(bit: Bit) -> bool {
    range_of(bit).is_some_and(|range| range.direction == BitDirection::Memory)
}

/// The level that the world gives a bit.
fn level(kernel: &Kernel, memory: &GuestMemory, bit: Bit) -> bool {
    if is_memory(bit) { bit_state(kernel, memory, bit).0 } else { kernel.pins.input(bit) }
}

fn drive(kernel: &mut Kernel, context: &mut TickContext<'_>, bit: Bit, level: bool) {
    if is_memory(bit) {
        write_bit(kernel, context.memory, bit, level, context.now);
    } else {
        kernel.pins.drive(bit, level, context.now);
        kernel.settle(context.now);
    }
}
