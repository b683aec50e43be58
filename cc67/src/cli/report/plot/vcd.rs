//! Value change dumps, as written by `cc67 run --trace` and logic analysers.
//!
//! Wires of one bit become strips, real numbers and vectors become panels, texts are omitted. The dump declares its
//! variables in scopes; the scope distinguishes variables with the same name.

use std::collections::BTreeMap;

use anyhow::{Result, bail};

use super::chart::{Chart, Strip};
use super::samples::{Column, Samples};

/// A chart of the dump.
pub(super) fn chart(title: &str, text: &str) -> Result<Chart> {
    let dump = read(text)?;
    let end = dump.now;
    let mut variables: Vec<&Variable> = dump.variables.values().collect();
    variables.sort_by_key(|variable| variable.order);
    let of = |kind| variables.iter().copied().filter(move |variable| variable.kind == kind);
    let samples = samples(&of(VariableKind::Number).collect::<Vec<_>>(), end);
    let mut strips: Vec<Strip> = of(VariableKind::Wire).map(|variable| strip(variable, end)).collect();
    strips.splice(0..0, samples.strips());
    let panels = samples.panels();
    if panels.is_empty() && strips.is_empty() {
        bail!("there is nothing in it that can be drawn");
    }
    Ok(Chart {
        title: title.to_owned(),
        abscissa: "time (s)".to_owned(),
        panels,
        strips,
        range: (0.0, end),
        ..Chart::default()
    })
}

/// The numbers as rows: one for each time at which one of them changes.
fn samples(variables: &[&Variable], end: f64) -> Samples {
    let names = variables.iter().map(|variable| variable.name.clone());
    let columns: Vec<_> = names.map(|name| Column { name, unit: String::new() }).collect();
    let mut changes: Vec<(f64, usize, f64)> = Vec::new();
    for (column, variable) in variables.iter().enumerate() {
        changes.extend(variable.changes.iter().map(|(time, value)| (*time, column, *value)));
    }
    changes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut rows: Vec<(f64, Vec<f64>)> = Vec::new();
    for instant in changes.chunk_by(|a, b| a.0 == b.0) {
        let mut values = rows.last().map_or_else(|| vec![0.0; columns.len()], |(_, values)| values.clone());
        for (_, column, value) in instant {
            values[*column] = *value;
        }
        rows.push((instant[0].0, values));
    }
    let gaps = rows.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let step = gaps.fold(f64::INFINITY, f64::min);
    Samples { columns, rows, step, end, ..Samples::default() }
}

fn strip(variable: &Variable, end: f64) -> Strip {
    let mut spans = Vec::new();
    let mut high_since = None;
    for (time, value) in &variable.changes {
        match (high_since, *value != 0.0) {
            (None, true) => high_since = Some(*time),
            (Some(since), false) => {
                spans.push((since, *time));
                high_since = None;
            }
            _ => {}
        }
    }
    spans.extend(high_since.map(|since| (since, end)));
    Strip { name: run_notation(&variable.name), spans, marks: Vec::new() }
}

/// `bit46` in the notation of a run's plots.
fn run_notation(name: &str) -> String {
    for word in ["bit", "thread"] {
        match name.strip_prefix(word) {
            Some(number) if number.parse::<u32>().is_ok() => return format!("{word} {number}"),
            _ => {}
        }
    }
    name.to_owned()
}

/// The kind of a variable's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum VariableKind {
    Wire,
    Number,
    Text,
}

/// A variable of the dump.
#[derive(Debug)]
struct Variable {
    /// Its position in the order of declarations.
    order: usize,
    name: String,
    kind: VariableKind,
    /// Times in seconds, and values.
    changes: Vec<(f64, f64)>,
}

/// A partially read dump.
#[derive(Debug)]
struct Dump {
    /// The variables by their short names.
    variables: BTreeMap<String, Variable>,
    /// The unit of time in seconds.
    unit: f64,
    scopes: Vec<String>,
    now: f64,
}

fn read(text: &str) -> Result<Dump> {
    let mut dump = Dump { variables: BTreeMap::new(), unit: 1e-9, scopes: Vec::new(), now: 0.0 };
    let mut words = text.split_ascii_whitespace();
    if !text.contains("$enddefinitions") {
        bail!("this is not a value change dump: `$enddefinitions` is missing");
    }
    while let Some(word) = words.next() {
        match word {
            "$dumpvars" | "$dumpall" | "$dumpon" | "$dumpoff" | "$end" => {}
            _ if word.starts_with('$') => {
                let body: Vec<&str> = words.by_ref().take_while(|word| *word != "$end").collect();
                dump.declare(word, &body)?;
            }
            _ => dump.change(word, &mut words)?,
        }
    }
    Ok(dump)
}

impl Dump {
    /// Handles a section of the head.
    fn declare(&mut self, section: &str, body: &[&str]) -> Result<()> {
        match (section, body) {
            ("$timescale", _) => self.unit = timescale(&body.concat())?,
            ("$scope", [_, name, ..]) => self.scopes.push((*name).to_owned()),
            ("$upscope", _) => drop(self.scopes.pop()),
            ("$var", [kind, width, id, name, ..]) => {
                let kind = match (*kind, *width) {
                    ("string", _) => VariableKind::Text,
                    ("real" | "realtime", _) => VariableKind::Number,
                    (_, "1") => VariableKind::Wire,
                    _ => VariableKind::Number,
                };
                let is_taken = self.variables.values().any(|other| other.name == *name);
                let scope = self.scopes.last().filter(|_| is_taken);
                let name = scope.map_or((*name).to_owned(), |scope| format!("{scope}.{name}"));
                let variable = Variable { order: self.variables.len(), name, kind, changes: Vec::new() };
                self.variables.entry((*id).to_owned()).or_insert(variable);
            }
            ("$var", _) => bail!("a variable of the dump has no name: `$var {}`", body.join(" ")),
            _ => {}
        }
        Ok(())
    }

    /// Handles a time or the value of a variable.
    fn change<'a>(&mut self, word: &'a str, words: &mut impl Iterator<Item = &'a str>) -> Result<()> {
        let (kind, rest) = word.split_at(word.chars().next().map_or(0, char::len_utf8));
        let (id, value) = match kind {
            "#" => {
                let Ok(time) = rest.parse::<f64>() else { bail!("`{word}` is not a time") };
                if time * self.unit < self.now {
                    bail!("the time goes back at `{word}`");
                }
                self.now = time * self.unit;
                return Ok(());
            }
            "0" | "1" | "x" | "X" | "z" | "Z" => (rest, f64::from(u8::from(kind == "1"))),
            "b" | "B" => (words.next().unwrap_or_default(), binary(rest)),
            "r" | "R" => match rest.parse() {
                Ok(value) => (words.next().unwrap_or_default(), value),
                Err(_) => bail!("`{word}` is not a real number"),
            },
            "s" | "S" => {
                words.next();
                return Ok(());
            }
            _ => bail!("`{word}` is neither a time nor a value"),
        };
        let Some(variable) = self.variables.get_mut(id) else {
            bail!("`{word}`: there is no variable `{id}`")
        };
        variable.changes.push((self.now, value));
        Ok(())
    }
}

/// The value of `1ns` in seconds.
fn timescale(text: &str) -> Result<f64> {
    let digits = text.len() - text.trim_start_matches(|character: char| character.is_ascii_digit()).len();
    let (count, unit) = text.split_at(digits);
    let units = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9), ("ps", 1e-12), ("fs", 1e-15)];
    match (count.parse::<f64>(), units.iter().find(|(name, _)| *name == unit)) {
        (Ok(count), Some((_, seconds))) => Ok(count * seconds),
        _ => bail!("`$timescale {text}` is not a unit of time"),
    }
}

/// The value of a vector; unknown bits count as 0.
fn binary(text: &str) -> f64 {
    text.chars().fold(0.0, |number, digit| 2.0 * number + f64::from(u8::from(digit == '1')))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expect: &str) {
        let shown = match chart("", text) {
            Ok(chart) => {
                let panels =
                    chart.panels.iter().map(|panel| format!("{} {:?}", panel.title, panel.lines[0].points));
                let strips = chart.strips.iter().map(|strip| format!("{} {:?}", strip.name, strip.spans));
                panels.chain(strips).collect::<Vec<_>>().join("; ")
            }
            Err(error) => error.to_string(),
        };
        assert_eq!(shown, expect);
    }

    #[test]
    fn wires_become_strips_and_numbers_panels() {
        check(
            "$timescale 1 s $end $scope module board $end $var wire 1 a bit46 $end $var real 64 b speed $end \
             $var reg 4 c [3:0] $end $var string 1 d console $end $upscope $end $enddefinitions $end \
             #0 $dumpvars 1a r0.5 b b0 c shello d $end #1 0a r1 b #2 b101 c #3 1a #4",
            "speed [(0.0, 0.5), (1.0, 1.0), (2.0, 1.0), (4.0, 1.0)]; \
             [3:0] [(0.0, 0.0), (1.0, 0.0), (2.0, 5.0), (4.0, 5.0)]; bit 46 [(0.0, 1.0), (3.0, 4.0)]",
        );
    }

    #[test]
    fn invalid_dumps_are_explained() {
        check("1,2\n", "this is not a value change dump: `$enddefinitions` is missing");
        check("$enddefinitions $end", "there is nothing in it that can be drawn");
        check("$timescale 1 day $end $enddefinitions $end", "`$timescale 1day` is not a unit of time");
        check("$enddefinitions $end #x", "`#x` is not a time");
        check("$enddefinitions $end #2 #1", "the time goes back at `#1`");
        check("$enddefinitions $end 1a", "`1a`: there is no variable `a`");
        check("$enddefinitions $end q", "`q` is neither a time nor a value");
        check("$enddefinitions $end r1,5 a", "`r1,5` is not a real number");
        check("$var wire 1 $end $enddefinitions $end", "a variable of the dump has no name: `$var wire 1`");
    }
}
