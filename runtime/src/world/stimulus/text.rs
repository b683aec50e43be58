//! Statements from text. A mistake is told with its line and column.

use std::sync::Arc;

use kmotiondef::bits::{BitDirection, range_of};
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::{AxisId, Bit, Cycles, ThreadId};

use super::tokens::{Mistake, Token, TokenKind, tokens};
use crate::io::encoder::CHANNELS;
use crate::io::konnect::{Board, Port};
use crate::io::snapamp::{Quantity, Side};
use crate::pc::Answers;
use crate::world::attached::DeviceSpec;

use super::{Action, Condition, Edge, Expectation, Place, Rule, Trigger, Wave};

/// Length of a pulse that does not say it: 10 ms.
const PULSE: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 100);
/// Counts of an analog input in a volt: 2048 in 10 V.
const COUNTS_PER_VOLT: f64 = 204.8;
/// Analog inputs.
const ADC_CHANNELS: usize = 8;

/// A statement that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct StimulusError {
    /// Where.
    pub place: Place,
    /// What is wrong.
    pub message: String,
}

/// Reads all statements of a text.
pub(super) fn parse(text: &str, source: &str) -> Result<Vec<Rule>, StimulusError> {
    let source: Arc<str> = source.into();
    let mut rules = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let place = |column| Place { source: source.clone(), line: number, column };
        let fail = |(column, message): Mistake| StimulusError { place: place(column), message };
        let tokens = tokens(line).map_err(fail)?;
        let mut rest = tokens.as_slice();
        while let Some(first) = rest.first() {
            let end = rest.iter().position(|token| token.kind == TokenKind::Semicolon).unwrap_or(rest.len());
            let behind = rest.get(end).map_or(line.trim_end().chars().count() + 1, |token| token.column);
            let (statement, others) = rest.split_at(end);
            rest = others.get(1..).unwrap_or_default();
            if statement.is_empty() {
                continue;
            }
            let (trigger, action) = Reader { tokens: statement, behind }.statement().map_err(fail)?;
            rules.push(Rule { place: place(first.column), trigger, action });
        }
    }
    Ok(rules)
}

/// Goes through the tokens of a statement.
struct Reader<'a> {
    tokens: &'a [Token],
    /// The column behind the last token.
    behind: usize,
}

impl Reader<'_> {
    fn column(&self) -> usize {
        self.tokens.first().map_or(self.behind, |token| token.column)
    }

    /// The mistake that something else should stand here.
    fn expected<T>(&self, what: &str) -> Result<T, Mistake> {
        let found = match self.tokens.first().map(|token| &token.kind) {
            None => "the end of the statement".to_owned(),
            Some(TokenKind::Word(word)) => format!("`{word}`"),
            Some(TokenKind::Text(_)) => "a text".to_owned(),
            Some(TokenKind::Equals) => "`=`".to_owned(),
            Some(TokenKind::Semicolon) => "`;`".to_owned(),
        };
        Err((self.column(), format!("expected {what}, found {found}")))
    }

    fn peek(&self) -> Option<&str> {
        match &self.tokens.first()?.kind {
            TokenKind::Word(word) => Some(word),
            _ => None,
        }
    }

    fn advance(&mut self) {
        self.tokens = self.tokens.get(1..).unwrap_or_default();
    }

    /// Takes a certain word, if it comes next.
    fn accept(&mut self, word: &str) -> bool {
        let is_next = self.peek() == Some(word);
        if is_next {
            self.advance();
        }
        is_next
    }

    fn expect(&mut self, word: &str) -> Result<(), Mistake> {
        if self.accept(word) { Ok(()) } else { self.expected(&format!("`{word}`")) }
    }

    fn equals(&mut self) -> Result<(), Mistake> {
        if self.tokens.first().is_some_and(|token| token.kind == TokenKind::Equals) {
            self.advance();
            return Ok(());
        }
        self.expected("`=`")
    }

    /// Takes a word that `read` understands.
    fn take<T>(&mut self, what: &str, read: impl Fn(&str) -> Option<T>) -> Result<T, Mistake> {
        match self.peek().and_then(read) {
            Some(value) => {
                self.advance();
                Ok(value)
            }
            None => self.expected(what),
        }
    }

    fn number(&mut self, what: &str) -> Result<f64, Mistake> {
        self.take(what, number)
    }

    fn time(&mut self) -> Result<Cycles, Mistake> {
        self.take("a time such as 1.5s, 20ms or 90us", time)
    }

    fn text(&mut self) -> Result<Vec<u8>, Mistake> {
        let Some(TokenKind::Text(bytes)) = self.tokens.first().map(|token| token.kind.clone()) else {
            return self.expected("a text in \"…\"");
        };
        self.advance();
        Ok(bytes)
    }

    fn string(&mut self) -> Result<String, Mistake> {
        Ok(String::from_utf8_lossy(&self.text()?).into_owned())
    }

    fn level(&mut self) -> Result<bool, Mistake> {
        self.take("0 or 1", |word| match word {
            "0" => Some(false),
            "1" => Some(true),
            _ => None,
        })
    }

    /// A number that must name something.
    fn index<T>(&mut self, what: &str, find: impl Fn(i32) -> Option<T>) -> Result<T, Mistake> {
        self.take(what, |word| find(word.parse().ok()?))
    }

    fn axis(&mut self) -> Result<AxisId, Mistake> {
        self.index("an axis from 0 to 7", AxisId::new)
    }

    fn thread(&mut self) -> Result<ThreadId, Mistake> {
        self.accept("thread");
        self.index("a thread from 1 to 7", ThreadId::new)
    }

    fn persist(&mut self) -> Result<usize, Mistake> {
        let last = N_USER_DATA_VARS as i32 - 1;
        self.index(&format!("an index from 0 to {last}"), |index| {
            usize::try_from(index).ok().filter(|_| index <= last)
        })
    }

    /// The number of a bit.
    fn bit(&mut self) -> Result<Bit, Mistake> {
        self.expect("bit")?;
        self.index(&format!("a bit from 0 to {}", Bit::MAX), Bit::new)
    }

    /// A bit that the world can drive.
    fn input(&mut self) -> Result<Bit, Mistake> {
        let column = self.tokens.get(1).map_or(self.behind, |token| token.column);
        let bit = self.bit()?;
        let Some(range) = range_of(bit) else {
            return Err((column, format!("nothing answers bit {bit}")));
        };
        match range.direction {
            BitDirection::Output => {
                Err((column, format!("bit {bit} ({}) is an output, only the board drives it", range.name)))
            }
            BitDirection::Programmable | BitDirection::Input | BitDirection::Memory => Ok(bit),
        }
    }

    fn statement(&mut self) -> Result<(Trigger, Action), Mistake> {
        let trigger = self.trigger()?;
        let action = self.action()?;
        // Without a moment it holds from the beginning; what is expected then is expected at the end.
        let trigger = trigger.unwrap_or(match action {
            Action::Expect(_) => Trigger::End,
            _ => Trigger::At(Cycles::default()),
        });
        if trigger == Trigger::End && !matches!(action, Action::Expect(_)) {
            return Err((self.behind, "at the end there is only something to `expect`".to_owned()));
        }
        if self.tokens.is_empty() { Ok((trigger, action)) } else { self.expected("the end of the statement") }
    }

    /// The moment, if the statement begins with one.
    fn trigger(&mut self) -> Result<Option<Trigger>, Mistake> {
        let word = self.peek().unwrap_or_default().to_owned();
        match word.as_str() {
            "at" => {
                self.advance();
                if self.accept("end") {
                    return Ok(Some(Trigger::End));
                }
                self.time().map(Trigger::At).map(Some)
            }
            "t" => {
                self.advance();
                self.equals()?;
                self.time().map(Trigger::At).map(Some)
            }
            "when" | "once" => {
                self.advance();
                let condition = self.condition()?;
                let after = if self.accept("after") { self.time()? } else { Cycles::default() };
                Ok(Some(Trigger::When { condition, after, is_once: word == "once" }))
            }
            "every" => self.every().map(Some),
            _ => Ok(None),
        }
    }

    fn every(&mut self) -> Result<Trigger, Mistake> {
        self.advance();
        let column = self.column();
        let period = self.time()?;
        if period < Cycles::PER_TICK {
            return Err((column, "a period is at least one tick, 90us".to_owned()));
        }
        let from = if self.accept("from") { self.time()? } else { Cycles::default() };
        let until = if self.accept("until") { Some(self.time()?) } else { None };
        Ok(Trigger::Every { period, from, until })
    }

    fn condition(&mut self) -> Result<Condition, Mistake> {
        match self.peek() {
            Some("bit") => {
                let bit = self.bit()?;
                let edge = self.take("`rises`, `falls` or `changes`", |word| match word {
                    "rises" => Some(Edge::Rises),
                    "falls" => Some(Edge::Falls),
                    "changes" => Some(Edge::Changes),
                    _ => None,
                })?;
                Ok(Condition::Bit(bit, edge))
            }
            Some("printed") => {
                self.advance();
                self.string().map(Condition::Printed)
            }
            Some("thread") => {
                let thread = self.thread()?;
                self.take("`starts` or `ends`", |word| match word {
                    "starts" | "started" => Some(Condition::Starts(thread)),
                    "ends" | "ended" => Some(Condition::Ends(thread)),
                    _ => None,
                })
            }
            _ => self.expected("`bit N rises`, `printed \"…\"` or `thread N starts`"),
        }
    }

    fn action(&mut self) -> Result<Action, Mistake> {
        let word = self.peek().unwrap_or_default().to_owned();
        if word != "bit" {
            self.advance_over(&word)?;
        }
        Ok(match word.as_str() {
            "bit" => {
                let bit = self.input()?;
                self.equals()?;
                Action::Set(bit, self.level()?)
            }
            "set" => Action::Set(self.input()?, true),
            "clear" => Action::Set(self.input()?, false),
            "toggle" => Action::Toggle(self.input()?),
            "pulse" => {
                let bit = self.input()?;
                Action::Pulse(bit, if self.accept("for") { self.time()? } else { PULSE })
            }
            "adc" => {
                let channel = self.index("an analog input from 0 to 7", |channel| {
                    usize::try_from(channel).ok().filter(|&channel| channel < ADC_CHANNELS)
                })?;
                self.equals()?;
                Action::Adc(channel, self.wave()?)
            }
            "axis" => {
                let axis = self.axis()?;
                self.expect("push")?;
                Action::Push(axis, self.number("a distance")?)
            }
            "encoder" => {
                let column = self.column();
                let channel = self.index("an encoder input from 0 to 15", |channel| {
                    usize::try_from(channel).ok().filter(|&channel| channel < CHANNELS)
                })?;
                if self.accept("fails") {
                    return Ok(Action::EncoderError(channel));
                }
                let axis = AxisId::new(channel as i32)
                    .ok_or_else(|| (column, "only encoders 0 to 7 can be moved".to_owned()))?;
                self.expect("moves")?;
                let counts = self.number("a number of counts")?;
                Action::Turn(axis, counts, if self.accept("in") { self.time()? } else { Cycles::default() })
            }
            "uart" => Action::Uart(self.text()?),
            "persist" => {
                let index = self.persist()?;
                self.equals()?;
                Action::Persist(index, self.integer()?)
            }
            "konnect" => {
                let address = self.index("an address from 0 to 7", |address| {
                    u8::try_from(address).ok().filter(|&address| address < 8)
                })?;
                let port = if self.accept("aux0") { Port::Aux0 } else { Port::Aux1 };
                self.expect("input")?;
                let input = self.index("an input from 0 to 31", |input| {
                    u8::try_from(input).ok().filter(|&input| input < 32)
                })?;
                self.equals()?;
                Action::Konnect(Board { port, address }, input, self.level()?)
            }
            "snapamp" => self.snapamp()?,
            "device" => Action::Attach(self.device()?),
            "command" => Action::Command(self.string()?),
            "start" => Action::Start(self.thread()?),
            "run" => {
                let thread = self.thread()?;
                Action::Run(thread, self.string()?.into())
            }
            "answer" => {
                let column = self.column();
                let setting = self.string()?;
                let known = Answers::default().set(&setting);
                known.map_err(|error| (column, error.to_string()))?;
                Action::Answer(setting)
            }
            "stop" | "kill" => Action::Kill(self.thread()?),
            _ => Action::Expect(self.expectation()?),
        })
    }

    /// Goes over the word that begins an action.
    fn advance_over(&mut self, word: &str) -> Result<(), Mistake> {
        const ACTIONS: &[&str] = &[
            "set", "clear", "toggle", "pulse", "adc", "axis", "encoder", "uart", "persist", "konnect",
            "snapamp", "device", "command", "start", "run", "answer", "stop", "kill", "expect",
        ];
        if !ACTIONS.contains(&word) {
            return self.expected(
                "`bit`, `set`, `clear`, `toggle`, `pulse`, `adc`, `axis`, `encoder`, `uart`, `persist`, `konnect`, \
                 `snapamp`, `device`, `command`, `start`, `run`, `answer`, `stop` or `expect`",
            );
        }
        self.advance();
        Ok(())
    }

    fn snapamp(&mut self) -> Result<Action, Mistake> {
        let board =
            self.index("a board, 0 or 1", |board| usize::try_from(board).ok().filter(|&board| board < 2))?;
        let quantity = self.take("`current`, `volts` or `degrees`", |word| match word {
            "current" => Some(Quantity::Current),
            "volts" => Some(Quantity::Voltage),
            "degrees" => Some(Quantity::Temperature),
            _ => None,
        })?;
        let side = self.take("a side, `A` or `B`", |word| match word {
            "A" => Some(Side::A),
            "B" => Some(Side::B),
            _ => None,
        })?;
        self.equals()?;
        Ok(Action::SnapAmp(board, side, quantity, self.number("a number")?))
    }

    /// The name of a device and its settings.
    fn device(&mut self) -> Result<DeviceSpec, Mistake> {
        let column = self.column();
        let name = self.take("the name of a device", |word| Some(word.to_owned()))?;
        let mut settings = Vec::new();
        while let Some(key) = self.peek().map(str::to_owned) {
            self.advance();
            self.equals()?;
            settings.push((key, self.take("a value", |word| Some(word.to_owned()))?));
        }
        let device = DeviceSpec { name, settings };
        match device.build() {
            Ok(_) => Ok(device),
            Err(message) => Err((column, message)),
        }
    }

    fn expectation(&mut self) -> Result<Expectation, Mistake> {
        match self.peek() {
            Some("bit") => {
                let bit = self.bit()?;
                self.equals()?;
                Ok(Expectation::Bit(bit, self.level()?))
            }
            Some("printed") => {
                self.advance();
                Ok(Expectation::Printed(self.string()?, true))
            }
            Some("not") => {
                self.advance();
                self.expect("printed")?;
                Ok(Expectation::Printed(self.string()?, false))
            }
            Some("persist") => {
                self.advance();
                let index = self.persist()?;
                self.equals()?;
                Ok(Expectation::Persist(index, self.integer()?))
            }
            Some("thread") => {
                let thread = self.thread()?;
                let is_active = self.take("`active` or `ended`", |word| match word {
                    "active" => Some(true),
                    "ended" => Some(false),
                    _ => None,
                })?;
                Ok(Expectation::Active(thread, is_active))
            }
            _ => self.expected("`bit`, `printed`, `not printed`, `persist` or `thread`"),
        }
    }

    fn integer(&mut self) -> Result<i32, Mistake> {
        self.take("an integer of 32 bits", integer)
    }

    fn wave(&mut self) -> Result<Wave, Mistake> {
        let word = self.peek().unwrap_or_default().to_owned();
        match word.as_str() {
            "sine" => {
                self.advance();
                let mean = if self.accept("mean") { self.counts()? } else { 0.0 };
                self.expect("amplitude")?;
                let amplitude = self.counts()?;
                self.expect("hz")?;
                Ok(Wave::Sine { mean, amplitude, hz: self.number("a frequency")? })
            }
            "square" => {
                self.advance();
                self.expect("low")?;
                let low = self.counts()?;
                self.expect("high")?;
                let high = self.counts()?;
                self.expect("hz")?;
                Ok(Wave::Square { low, high, hz: self.number("a frequency")? })
            }
            "ramp" => {
                self.advance();
                self.expect("from")?;
                let from = self.counts()?;
                self.expect("to")?;
                let to = self.counts()?;
                self.expect("in")?;
                Ok(Wave::Ramp { from, to, over: self.time()? })
            }
            "follows" => {
                self.advance();
                self.expect("axis")?;
                let axis = self.axis()?;
                let gain = if self.accept("gain") { self.number("a factor")? } else { 1.0 };
                let offset = if self.accept("offset") { self.counts()? } else { 0.0 };
                Ok(Wave::Follows { axis, gain, offset })
            }
            _ => self.counts().map(Wave::Constant),
        }
    }

    /// Counts of an analog input, or volts.
    fn counts(&mut self) -> Result<f64, Mistake> {
        self.take("counts, volts such as 2.5V, `sine`, `square`, `ramp` or `follows`", |word| {
            match word.strip_suffix('V') {
                Some(volts) => number(volts).map(|volts| volts * COUNTS_PER_VOLT),
                None => number(word),
            }
        })
    }
}

fn number(word: &str) -> Option<f64> {
    let starts = word.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '-' | '+' | '.'));
    word.parse().ok().filter(|number: &f64| starts && number.is_finite())
}

/// A decimal or hexadecimal integer.
fn integer(word: &str) -> Option<i32> {
    match word.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok().map(u32::cast_signed),
        None => word.parse().ok(),
    }
}

/// A time; a bare number is seconds.
fn time(word: &str) -> Option<Cycles> {
    let units = [("us", 1e-6), ("µs", 1e-6), ("ms", 1e-3), ("s", 1.0)];
    let (digits, unit) = units
        .into_iter()
        .find_map(|(name, unit)| word.strip_suffix(name).map(|digits| (digits, unit)))
        .unwrap_or((word, 1.0));
    let seconds = number(digits)? * unit;
    let cycles = libm::round(seconds * Cycles::PER_SECOND.get() as f64);
    (seconds >= 0.0).then_some(Cycles::new(cycles as i64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a statement means, as Rust writes it.
    fn check(text: &str, expect: &str) {
        let rules = parse(text, "x.stim").unwrap_or_else(|error| panic!("{error}"));
        let read: Vec<_> = rules.iter().map(|rule| format!("{:?} {:?}", rule.trigger, rule.action)).collect();
        assert_eq!(read.join("; "), expect, "{text}");
    }

    #[test]
    fn statements_say_when_and_what() {
        for (text, expect) in [
            ("at 1.5s set bit 26", "At(Cycles(300000000)) Set(Bit(26), true)"),
            ("t=0.5 bit 136=1", "At(Cycles(100000000)) Set(Bit(136), true)"),
            ("bit 48 = 0", "At(Cycles(0)) Set(Bit(48), false)"),
            (
                "when bit 46 rises after 20ms pulse bit 0",
                "When { condition: Bit(Bit(46), Rises), after: Cycles(4000000), is_once: false } \
                 Pulse(Bit(0), Cycles(2000000))",
            ),
            (
                "once printed \"go\" uart \"A\\r\"",
                "When { condition: Printed(\"go\"), after: Cycles(0), is_once: true } Uart([65, 13])",
            ),
            (
                "every 10ms from 1s until 2s toggle bit 24",
                "Every { period: Cycles(2000000), from: Cycles(200000000), until: Some(Cycles(400000000)) } \
                 Toggle(Bit(24))",
            ),
            ("adc 3 = 2.5V", "At(Cycles(0)) Adc(3, Constant(512.0))"),
            ("axis 0 push 100", "At(Cycles(0)) Push(AxisId(0), 100.0)"),
            ("encoder 3 moves -40 in 0.5s", "At(Cycles(0)) Turn(AxisId(3), -40.0, Cycles(100000000))"),
            ("at 1 start thread 2", "At(Cycles(200000000)) Start(ThreadId(2))"),
            ("run thread 3 \"jog.c\"", "At(Cycles(0)) Run(ThreadId(3), \"jog.c\")"),
            ("answer \"msgbox=no\"", "At(Cycles(0)) Answer(\"msgbox=no\")"),
            ("at 1s encoder 9 fails", "At(Cycles(200000000)) EncoderError(9)"),
            ("persist 10 = 0xFFFFFFFF", "At(Cycles(0)) Persist(10, -1)"),
            ("expect not printed \"x\"", "End Expect(Printed(\"x\", false))"),
            ("kill 2; # no more", "At(Cycles(0)) Kill(ThreadId(2))"),
            ("bit 0=1; bit 1=1", "At(Cycles(0)) Set(Bit(0), true); At(Cycles(0)) Set(Bit(1), true)"),
        ] {
            check(text, expect);
        }
    }

    #[test]
    fn waves_have_their_words() {
        for text in [
            "adc 0 = sine mean 0 amplitude 1000 hz 2",
            "adc 0 = square low -1V high 1V hz 5",
            "adc 0 = ramp from 0 to 100 in 1s",
            "adc 0 = follows axis 1 gain 2 offset 5",
        ] {
            assert!(parse(text, "x").is_ok(), "{text}");
        }
    }

    #[test]
    fn mistakes_name_line_and_column() {
        for (text, expect) in [
            ("\nat 1s set bit 9999", "x.stim:2:15: expected a bit from 0 to 2047, found `9999`"),
            ("set bit 46", "x.stim:1:9: bit 46 (LED) is an output, only the board drives it"),
            ("set bit 184", "x.stim:1:9: nothing answers bit 184"),
            ("at soon set bit 3", "x.stim:1:4: expected a time such as 1.5s, 20ms or 90us, found `soon`"),
            ("at -1s set bit 3", "x.stim:1:4: expected a time such as 1.5s, 20ms or 90us, found `-1s`"),
            ("at 1s set bit", "x.stim:1:14: expected a bit from 0 to 2047, found the end of the statement"),
            ("bit 5 = 2", "x.stim:1:9: expected 0 or 1, found `2`"),
            ("bit 5 = 1 now", "x.stim:1:11: expected the end of the statement, found `now`"),
            ("every 10us toggle bit 1", "x.stim:1:7: a period is at least one tick, 90us"),
            ("at end set bit 1", "x.stim:1:17: at the end there is only something to `expect`"),
            ("adc 8 = 0", "x.stim:1:5: expected an analog input from 0 to 7, found `8`"),
            ("bit 0=1; kill 8", "x.stim:1:15: expected a thread from 1 to 7, found `8`"),
            (
                "answer \"box=no\"",
                "x.stim:1:8: there is no answer `box`; there are msgbox, input, mdi, request.N, var.N, tool.N.KIND, dro.AXIS, resolution.AXIS, cell.N, setup and job",
            ),
            ("encoder 8 moves 5", "x.stim:1:9: only encoders 0 to 7 can be moved"),
            ("uart 5", "x.stim:1:6: expected a text in \"…\", found `5`"),
            ("persist 200 = 1", "x.stim:1:9: expected an index from 0 to 199, found `200`"),
        ] {
            let error = parse(text, "x.stim").expect_err("it is wrong").to_string();
            assert_eq!(error, expect, "{text}");
        }
    }
}
