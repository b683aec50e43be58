//! Statements from text. A mistake is reported with its line and column.

use std::sync::Arc;

use kmotiondef::Cycles;

use super::reader::{self, StatementReader};
use super::tokens::{Mistake, TokenKind, tokens};
use super::{Action, Condition, Edge, Rule, StatementPlace, Trigger, action, expectation};

/// A statement that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct StimulusError {
    /// The location of the statement.
    pub place: StatementPlace,
    /// The message.
    pub message: String,
}

/// Reads all statements of a text.
pub(super) fn parse(text: &str, source: &str) -> Result<Vec<Rule>, StimulusError> {
    let source: Arc<str> = source.into();
    let mut rules = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let place = |column| StatementPlace { source: source.clone(), line: number, column };
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
            let mut reader = StatementReader { tokens: statement, behind, highest_axis: None };
            let (trigger, action) = reader.statement().map_err(fail)?;
            let highest_axis = reader.highest_axis;
            rules.push(Rule { place: place(first.column), trigger, action, highest_axis });
        }
    }
    Ok(rules)
}

impl StatementReader<'_> {
    fn statement(&mut self) -> Result<(Trigger, Action), Mistake> {
        let read = match self.peek() {
            Some("never") => {
                self.advance();
                (Trigger::Always { while_met: None }, Action::Expect(expectation::never(self)?))
            }
            Some("always") => self.always()?,
            Some("within") => self.within()?,
            _ => self.moment_and_action()?,
        };
        if self.tokens.is_empty() { Ok(read) } else { self.expected("the end of the statement") }
    }

    /// `always [while CONDITION] expect …`
    fn always(&mut self) -> Result<(Trigger, Action), Mistake> {
        self.advance();
        let while_met = if self.accept("while") { Some(expectation::expectation(self)?) } else { None };
        self.expect("expect")?;
        Ok((Trigger::Always { while_met }, Action::Expect(expectation::expectation(self)?)))
    }

    /// `within TIME of CONDITION expect …`
    fn within(&mut self) -> Result<(Trigger, Action), Mistake> {
        self.advance();
        let limit = self.time()?;
        self.expect("of")?;
        let condition = self.condition()?;
        self.expect("expect")?;
        Ok((Trigger::Within { limit, condition }, Action::Expect(expectation::expectation(self)?)))
    }

    fn moment_and_action(&mut self) -> Result<(Trigger, Action), Mistake> {
        let trigger = self.trigger()?;
        let action = action::read(self)?;
        // Without a moment it applies from the beginning, but an expectation at the end.
        let trigger = trigger.unwrap_or(match action {
            Action::Expect(_) => Trigger::End,
            _ => Trigger::At(Cycles::default()),
        });
        if trigger == Trigger::End && !matches!(action, Action::Expect(_)) {
            return Err((self.behind, "at the end there is only something to `expect`".to_owned()));
        }
        Ok((trigger, action))
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
                self.expect_equals()?;
                self.time().map(Trigger::At).map(Some)
            }
            "when" | "once" => {
                self.advance();
                let condition = self.condition()?;
                let after = if self.accept("after") { self.time()? } else { Cycles::default() };
                Ok(Some(Trigger::When { condition, after, is_once: word == "once" }))
            }
            "every" => self.every().map(Some),
            _ => self.without_moment(&word),
        }
    }

    /// Returns no trigger, unless the statement begins with a time as in a log: no statement begins in this way.
    fn without_moment(&self, word: &str) -> Result<Option<Trigger>, Mistake> {
        let moment = word.trim_end_matches([':', ',']);
        match reader::time(moment) {
            Some(_) => Err((self.column(), format!("a moment begins with `at`: `at {moment} ...`"))),
            None => Ok(None),
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
        let while_met = if self.accept("while") { Some(expectation::expectation(self)?) } else { None };
        Ok(Trigger::Every { period, from, until, while_met })
    }

    fn condition(&mut self) -> Result<Condition, Mistake> {
        match self.peek() {
            Some("bit") => {
                let bit = self.bit()?;
                if self.accept_sign("=") {
                    let edge = self.take("`1` or `0`", |word| match word {
                        "1" => Some(Edge::Rises),
                        "0" => Some(Edge::Falls),
                        _ => None,
                    })?;
                    return Ok(Condition::Bit(bit, edge));
                }
                let edge = self.take("`rises`, `falls`, `changes` or `= 1`", |word| match word {
                    "rises" => Some(Edge::Rises),
                    "falls" => Some(Edge::Falls),
                    "changes" => Some(Edge::Changes),
                    _ => None,
                })?;
                Ok(Condition::Bit(bit, edge))
            }
            Some("axis" | "persist") => expectation::expectation(self).map(Condition::Becomes),
            Some("printed") => {
                self.advance();
                self.string().map(Condition::Printed)
            }
            Some("uart") => {
                self.advance();
                self.expect("sends")?;
                let column = self.column();
                match self.text()? {
                    empty if empty.is_empty() => Err((column, "expected at least one character".to_owned())),
                    bytes => Ok(Condition::UartSent(bytes)),
                }
            }
            Some("thread") => {
                let thread = self.thread()?;
                self.take("`starts` or `ends`", |word| match word {
                    "starts" | "started" => Some(Condition::Starts(thread)),
                    "ends" | "ended" => Some(Condition::Ends(thread)),
                    _ => None,
                })
            }
            _ => self.expected("`bit N rises`, `printed \"…\"`, `uart sends \"…\"` or `thread N starts`"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expectation, Predicate};
    use super::*;

    /// Checks the debug form of a parsed statement.
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
                "when bit 152 = 0 set bit 136",
                "When { condition: Bit(Bit(152), Falls), after: Cycles(0), is_once: false } Set(Bit(136), true)",
            ),
            (
                "once printed \"go\" uart \"A\\r\"",
                "When { condition: Printed(\"go\"), after: Cycles(0), is_once: true } Uart([65, 13])",
            ),
            (
                "every 10ms from 1s until 2s toggle bit 24",
                "Every { period: Cycles(2000000), from: Cycles(200000000), until: Some(Cycles(400000000)), while_met: None } \
                 Toggle(Bit(24))",
            ),
            ("adc 3 = 2.5V", "At(Cycles(0)) Adc(3, Constant(512.0))"),
            ("adc 3 = 2.5 V", "At(Cycles(0)) Adc(3, Constant(512.0))"),
            ("axis 0 push 100", "At(Cycles(0)) Push(AxisId(0), 100.0)"),
            ("encoder 3 moves -40 in 0.5s", "At(Cycles(0)) Turn(3, -40.0, Cycles(100000000))"),
            ("encoder 3 moves -40 in 500 ms", "At(Cycles(0)) Turn(3, -40.0, Cycles(100000000))"),
            ("at 1 start thread 2", "At(Cycles(200000000)) Start(ThreadId(2))"),
            ("run thread 3 \"jog.c\"", "At(Cycles(0)) Run(ThreadId(3), \"jog.c\")"),
            ("answer \"msgbox=no\"", "At(Cycles(0)) Answer(\"msgbox=no\")"),
            ("at 1s encoder 9 fails", "At(Cycles(200000000)) EncoderError(9)"),
            ("persist 10 = 0xFFFFFFFF", "At(Cycles(0)) Persist(10, -1)"),
            (
                "expect not printed \"x\"",
                "End Expect(Expectation { predicate: Printed(\"x\"), sense: IsNot })",
            ),
            ("kill 2; # no more", "At(Cycles(0)) Kill(ThreadId(2))"),
            ("bit 0=1; bit 1=1", "At(Cycles(0)) Set(Bit(0), true); At(Cycles(0)) Set(Bit(1), true)"),
        ] {
            check(text, expect);
        }
    }

    #[test]
    fn every_form_of_expectation_is_parsed() {
        for (text, expect) in [
            ("at end expect axis 0 position = 500 ± 1", "End: axis 0 position = 500 ± 1 Is"),
            ("expect axis 0 velocity<=0.5", "End: axis 0 velocity <= 0.5 ± 0 Is"),
            ("expect axis 7 enabled", "End: Enabled(AxisId(7), true) Is"),
            ("expect thread 1 ended", "End: Active(ThreadId(1), false) Is"),
            ("expect bit 1050 = 1", "End: bit 1050 = 1 ± 0 Is"),
            ("expect persist 20 = f:1.25", "End: persist 20 = 1.25 ± 0 Is"),
            ("expect persist 20 = d:-1.25+-0.5", "End: persist 20 = -1.25 ± 0.5 Is"),
            ("expect persist 20 = 0xFFFFFFFF", "End: persist 20 = -1 ± 0 Is"),
            ("expect Parts = 3", "End: Parts = 3 ± 0 Is"),
            ("expect ch0->Dest != 3", "End: ch0->Dest != 3 ± 0 Is"),
            ("expect \"ch0->Dest - 200\" = 300 +- 1", "End: ch0->Dest - 200 = 300 ± 1 Is"),
            ("expect adc3 > -5", "End: adc3 > -5 ± 0 Is"),
            (
                "within 0.5s of printed \"start\" expect printed \"moved\"",
                "Within { limit: Cycles(100000000), condition: Printed(\"start\") }: Printed(\"moved\") Is",
            ),
            ("never printed \"boom\"", "Always { while_met: None }: Printed(\"boom\") Never"),
            ("never axis 0 dest > 501", "Always { while_met: None }: axis 0 dest > 501 ± 0 Never"),
            ("always expect axis 0 dest>-1", "Always { while_met: None }: axis 0 dest > -1 ± 0 Is"),
        ] {
            let rules = parse(text, "x.stim").unwrap_or_else(|error| panic!("{error}"));
            let Action::Expect(Expectation { predicate, sense }) = &rules[0].action else { panic!("{text}") };
            let predicate = match predicate {
                Predicate::Value { subject, relation, number, tolerance } => {
                    format!("{subject} {} {number} ± {tolerance}", relation.sign())
                }
                other => format!("{other:?}"),
            };
            assert_eq!(format!("{:?}: {predicate} {sense:?}", rules[0].trigger), expect, "{text}");
        }
    }

    #[test]
    fn the_condition_of_always_is_parsed_as_an_expectation() {
        let rules = parse("always while bit 1050 = 1 expect axis 0 enabled", "x").expect("it is right");
        let Trigger::Always {
            while_met: Some(Expectation { predicate: Predicate::Value { subject, .. }, .. }),
        } = &rules[0].trigger
        else {
            panic!("{rules:?}")
        };
        assert_eq!(subject.to_string(), "bit 1050");
    }

    #[test]
    fn set_also_accepts_a_level() {
        for (one, same) in [
            ("set bit 5 = 0", "bit 5 = 0"),
            ("set bit 5 0", "bit 5 = 0"),
            ("set bit 5 = 1", "bit 5 = 1"),
            ("set bit 5", "bit 5 = 1"),
        ] {
            let action = |text| parse(text, "x").map(|rules| format!("{:?}", rules[0].action));
            assert_eq!(action(one), action(same), "{one}");
        }
    }

    #[test]
    fn waves_are_parsed() {
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
            ("set bit 184", "x.stim:1:9: nothing is connected to bit 184"),
            ("at soon set bit 3", "x.stim:1:4: expected a time such as 1.5s, 20ms or 90us, found `soon`"),
            ("0.3s: bit 5 = 1", "x.stim:1:1: a moment begins with `at`: `at 0.3s ...`"),
            ("20ms bit 5 = 1", "x.stim:1:1: a moment begins with `at`: `at 20ms ...`"),
            ("at -1s set bit 3", "x.stim:1:4: expected a time such as 1.5s, 20ms or 90us, found `-1s`"),
            ("at 1s set bit", "x.stim:1:14: expected a bit from 0 to 2047, found the end of the statement"),
            ("set bit 5 now", "x.stim:1:11: expected 0 or 1, found `now`"),
            (
                "set bit 5 at 2s",
                "x.stim:1:11: expected 0 or 1, found `at`: separate statements with `;`, or write each on its own line",
            ),
            ("set adc 3 = 950", "x.stim:1:1: write `adc N = VALUE` without `set`"),
            ("set bit 5 =", "x.stim:1:12: expected 0 or 1, found the end of the statement"),
            ("bit 5 = 2", "x.stim:1:9: expected 0 or 1, found `2`"),
            ("bit 5 = 1 now", "x.stim:1:11: expected the end of the statement, found `now`"),
            ("every 10us toggle bit 1", "x.stim:1:7: a period is at least one tick, 90us"),
            ("at end set bit 1", "x.stim:1:17: at the end there is only something to `expect`"),
            ("adc 8 = 0", "x.stim:1:5: expected an analog input from 0 to 7, found `8`"),
            ("bit 0=1; kill 8", "x.stim:1:15: expected a thread from 1 to 7, found `8`"),
            (
                "answer \"box=no\"",
                "x.stim:1:8: there is no answer `box`; known: msgbox, input, boxes, mdi, request.N, var.N, tool.N.KIND, dro.AXIS, resolution.AXIS, cell.N, setup and job",
            ),
            (
                "expect axis 0 place = 1",
                "x.stim:1:15: expected `position`, `dest`, `velocity`, `output`, `load`, `enabled` or `disabled`, found `place`",
            ),
            (
                "expect axis 0 position 1",
                "x.stim:1:24: expected `=`, `!=`, `<`, `<=`, `>` or `>=`, found `1`",
            ),
            ("expect Parts = 3 ± -1", "x.stim:1:20: expected a distance of 0 or more, found `-1`"),
            (
                "expect persist 199 = d:1",
                "x.stim:1:22: expected an integer, a float such as f:1.25, or a double such as d:1.25, found `d:1`",
            ),
            (
                "within 1s of Parts expect Parts = 1",
                "x.stim:1:14: expected `bit N rises`, `printed \"…\"`, `uart sends \"…\"` or `thread N starts`, found `Parts`",
            ),
            ("always while bit 5 = 1 set bit 1", "x.stim:1:24: expected `expect`, found `set`"),
            ("encoder 16 moves 5", "x.stim:1:9: expected an encoder input from 0 to 15, found `16`"),
            ("uart 5", "x.stim:1:6: expected a text in \"…\", found `5`"),
            ("persist 200 = 1", "x.stim:1:9: expected an index from 0 to 199, found `200`"),
        ] {
            let error = parse(text, "x.stim").expect_err("it is wrong").to_string();
            assert_eq!(error, expect, "{text}");
        }
    }
}
