//! A trace as a value change dump: bits and threads as wires, items as real numbers, the console as a string.

use std::fmt::Write as _;

use super::{Log, nanoseconds};

/// The dump; its unit of time is the nanosecond. Numbers have their first sampled value from the start.
pub(super) fn text(log: &Log) -> String {
    let mut dump = Dump::default();
    for (bit, level) in log.bits() {
        let id = dump.variable("wire 1", &format!("bit{bit}"), &format!("{}", u8::from(level)));
        for change in log.changes.iter().filter(|change| change.bit == bit) {
            dump.change(nanoseconds(change.at), format!("{}{id}", u8::from(change.level)));
        }
    }
    let mut threads: Vec<_> = log.slices.iter().map(|(thread, ..)| *thread).collect();
    threads.sort_unstable();
    threads.dedup();
    for thread in threads {
        let id = dump.variable("wire 1", &format!("thread{thread}"), "0");
        for (_, start, end) in log.slices.iter().filter(|(other, ..)| *other == thread) {
            dump.change(nanoseconds(*start), format!("1{id}"));
            dump.change(nanoseconds(*end), format!("0{id}"));
        }
    }
    // A bit is a wire already.
    let bits: Vec<_> = log.bits().iter().map(|(bit, _)| format!("bit{bit}")).collect();
    for (index, quantity) in log.columns() {
        // A name has no blanks.
        let name: String = quantity.to_string().split_whitespace().collect();
        if bits.contains(&name) {
            continue;
        }
        // Readers differ in how they write what is no number.
        let of =
            |values: &[f64]| values.get(index).copied().filter(|value| value.is_finite()).unwrap_or_default();
        let mut last = log.samples.first().map_or(0.0, |(_, values)| of(values));
        let id = dump.variable("real 64", &name, &format!("r{last} "));
        for (at, values) in &log.samples {
            let value = of(values);
            if value != last {
                last = value;
                dump.change(nanoseconds(*at), format!("r{value} {id}"));
            }
        }
    }
    let id = dump.variable("string 1", "console", "s\\x20 ");
    for (at, line) in &log.lines {
        dump.change(nanoseconds(*at), format!("s{} {id}", escape(line)));
    }
    dump.finish()
}

/// A dump in the making.
#[derive(Default)]
struct Dump {
    head: String,
    start: String,
    variables: u32,
    changes: Vec<(i64, String)>,
}

impl Dump {
    /// Declares a variable and returns what stands for it.
    fn variable(&mut self, kind: &str, name: &str, start: &str) -> String {
        let id = id(self.variables);
        self.variables += 1;
        let _ = writeln!(self.head, "$var {kind} {id} {name} $end");
        let _ = writeln!(self.start, "{start}{id}");
        id
    }

    fn change(&mut self, at: i64, text: String) {
        self.changes.push((at, text));
    }

    fn finish(mut self) -> String {
        self.changes.sort_by_key(|(at, _)| *at);
        let mut text = format!(
            "$version cc67 $end\n$timescale 1 ns $end\n$scope module board $end\n{}$upscope $end\n\
             $enddefinitions $end\n#0\n$dumpvars\n{}$end\n",
            self.head, self.start
        );
        let mut now = 0;
        for (at, change) in &self.changes {
            if *at != now {
                now = *at;
                let _ = writeln!(text, "#{now}");
            }
            text.push_str(change);
            text.push('\n');
        }
        text
    }
}

/// A short name for the variable of a number; letters only, as some readers take other characters for commands.
fn id(mut number: u32) -> String {
    const LETTERS: u32 = 26;
    let mut id = String::new();
    loop {
        id.extend(char::from_u32(u32::from(b'a') + number % LETTERS));
        number /= LETTERS;
        if number == 0 {
            return id;
        }
    }
}

/// A string value has no spaces; those and what is not printable are written as viewers read them. Nor may it be empty.
fn escape(line: &str) -> String {
    let line = if line.is_empty() { " " } else { line };
    line.bytes().fold(String::new(), |mut text, byte| {
        if byte.is_ascii_graphic() && byte != b'\\' {
            text.push(char::from(byte));
        } else {
            let _ = write!(text, "\\x{byte:02x}");
        }
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dump_of_a_run() {
        insta::assert_snapshot!(text(&super::super::testing::log()), @r#"
        $version cc67 $end
        $timescale 1 ns $end
        $scope module board $end
        $var wire 1 a bit46 $end
        $var wire 1 b thread1 $end
        $var real 64 c dest0 $end
        $var string 1 d console $end
        $upscope $end
        $enddefinitions $end
        #0
        $dumpvars
        1a
        0b
        r0.5 c
        s\x20 d
        $end
        #205000
        1b
        #215000
        0a
        #230000
        0b
        #450000
        sa\x20"b" d
        #540000
        r2 c
        "#);
    }

    #[test]
    fn ids_are_short_and_differ() {
        assert_eq!([id(0), id(25), id(26)], ["a", "z", "ab"]);
    }
}
