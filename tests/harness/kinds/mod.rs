//! Random C programs for specific features of code generation: bit-fields, designators, variable arguments, structures
//! by value, switches, jumps into loops, 64-bit integers, conversions of floating point, loops for software pipelining.
//!
//! Their behaviour is defined as in [`crate::generate`]: `gcc -fwrapv` agrees, integers wrap, a number is converted to
//! an integer only if it fits. Floating values are compared exactly unless they are tiny: the processor has no
//! denormals.

mod conversions;
mod fields;
mod flow;
mod initialisers;
mod loops;
mod values;

use std::fmt::Write as _;

use crate::generate;
use crate::random::Random;

/// A kind: its name, and the writer of its functions.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its name, with which the names of its functions begin.
    pub name: &'static str,
    write: fn(&mut Writer),
}

/// All kinds.
pub const KINDS: &[Kind] = &[
    Kind { name: "fields", write: fields::write },
    Kind { name: "initialisers", write: initialisers::write },
    Kind { name: "arguments", write: values::write_arguments },
    Kind { name: "structures", write: values::write_structures },
    Kind { name: "switches", write: flow::write_switches },
    Kind { name: "jumps", write: flow::write_jumps },
    Kind { name: "wide", write: conversions::write_wide },
    Kind { name: "conversions", write: conversions::write_conversions },
    Kind { name: "loops", write: loops::write },
];

/// The number of functions in a program.
const FUNCTIONS: usize = 4;

/// The beginning of every program; `@` is its prefix.
const HEAD: &str = "#include <stdarg.h>
int printf(const char *format, ...);

static unsigned @mix(unsigned sum, unsigned value)
{
    return ((sum << 5) | (sum >> 27)) ^ value * 2654435761u;
}

static unsigned @wide(unsigned sum, unsigned long long value)
{
    return @mix(@mix(sum, (unsigned)value), (unsigned)(value >> 32));
}

static unsigned @real(unsigned sum, double value)
{
    union { double d; unsigned u[2]; } bits;

    if (!(value > 1e-30 && value < 1e30) && !(value < -1e-30 && value > -1e30))
        return @mix(sum, value > 0 ? 1 : value < 0 ? 2 : value == 0 ? 3 : 4);
    bits.d = value;
    return @mix(@mix(sum, bits.u[0]), bits.u[1]);
}

";

/// A random program; all its names begin with `prefix`, and its entry is `int PREFIXmain(void)`, which prints a line
/// that begins with `label`.
#[must_use]
pub fn program(seed: u64, prefix: &str, label: &str) -> String {
    let mut writer = Writer::new(seed, prefix);
    let chosen: Vec<_> = (0..FUNCTIONS).map(|_| KINDS[writer.below(KINDS.len())]).collect();
    writer.of_kinds(&chosen, label)
}

/// A random program from either generator: statements and expressions, or these kinds.
#[must_use]
pub fn of_any_kind(seed: u64, prefix: &str, label: &str) -> String {
    if seed.is_multiple_of(2) { generate::program(seed, prefix, label) } else { program(seed, prefix, label) }
}

/// A random program of one kind.
#[must_use]
pub fn program_of(kind: Kind, seed: u64, prefix: &str, label: &str) -> String {
    Writer::new(seed, prefix).of_kinds(&[kind], label)
}

struct Writer {
    random: Random,
    prefix: String,
    text: String,
    /// The name of the function that is being written.
    function: String,
    /// Integer variables that can be read in it.
    names: Vec<String>,
}

impl Writer {
    fn new(seed: u64, prefix: &str) -> Self {
        Self {
            random: Random::of_seed(seed),
            prefix: prefix.to_owned(),
            text: HEAD.replace('@', prefix),
            function: String::new(),
            names: Vec::new(),
        }
    }

    fn of_kinds(mut self, kinds: &[Kind], label: &str) -> String {
        let mut calls = String::new();
        for (number, kind) in kinds.iter().enumerate() {
            self.function = format!("{}{}{number}", self.prefix, kind.name);
            self.names = ["x", "y", "(int)z", "i"].map(str::to_owned).to_vec();
            (kind.write)(&mut self);
            let (step, start) = (self.below(1 << 20), self.below(200));
            let _ = writeln!(
                calls,
                "        sum = {}(sum, i * {step} - {start}, sum, i * {step}00077LL - (long long)sum * {start}, i * 1.75 - {start}.5);",
                self.function
            );
        }
        let prefix = &self.prefix;
        let _ = write!(
            self.text,
            "int {prefix}main(void)\n{{\n    unsigned sum = 1;\n    int i;\n\n    for (i = 0; i < 3; i++) {{\n{calls}    }}\n    \
             printf(\"{label}%08x\\n\", sum);\n    return 0;\n}}\n"
        );
        self.text
    }

    fn below(&mut self, end: usize) -> usize {
        self.random.below(end)
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        self.random.pick(from)
    }

    /// Writes text, with `@` replaced by the prefix of the program, and `$` by the name of the function.
    fn put(&mut self, text: &str) {
        self.text.push_str(&text.replace('@', &self.prefix).replace('$', &self.function));
    }

    /// Writes a statement of a function.
    fn line(&mut self, text: &str) {
        self.put(&format!("    {text}\n"));
    }

    /// Begins the function; `locals` are additional declarations.
    fn open(&mut self, locals: &str) {
        self.put(
            "static unsigned $(unsigned sum, int x, unsigned y, long long z, double w)\n{\n    int i = 0;\n",
        );
        self.put(locals);
        self.put("\n");
    }

    /// Ends the function.
    fn close(&mut self) {
        self.put("    return @mix(sum, i);\n}\n\n");
    }

    /// Adds an integer to the sum.
    fn add(&mut self, value: &str) {
        self.line(&format!("sum = @mix(sum, {value});"));
    }

    /// An integer constant: a small one, or a limit of a type.
    fn constant(&mut self) -> String {
        const EDGES: &[&str] =
            &["0", "1", "-1", "127", "-128", "255", "32767", "65535", "2147483647", "(-2147483647 - 1)"];
        if self.below(3) == 0 {
            self.pick(EDGES).to_owned()
        } else {
            (self.below(300) as i64 - 100).to_string()
        }
    }

    /// A 32-bit integer expression without side effects.
    fn integer(&mut self, depth: usize) -> String {
        if depth == 0 {
            return if self.below(3) == 0 {
                self.constant()
            } else {
                let at = self.below(self.names.len());
                self.names[at].clone()
            };
        }
        let (a, b) = (self.integer(depth - 1), self.integer(depth - 1));
        match self.below(9) {
            0..=3 => format!("({a} {} {b})", self.pick(&["+", "-", "*", "&", "|", "^"])),
            4 => format!("({a} {} ({b} & 31))", self.pick(&["<<", ">>"])),
            5 => format!("({a} {} {b})", self.pick(&["<", ">", "<=", ">=", "==", "!="])),
            6 => format!("({a} {} (({b} & 63) + 2))", self.pick(&["/", "%"])),
            7 => format!("({} {a})", self.pick(&["-", "~", "!"])),
            _ => format!("({a} {} {b})", self.pick(&["&&", "||"])),
        }
    }

    /// A floating constant of moderate size.
    fn fraction(&mut self) -> String {
        format!("{}.{}", self.below(40), self.pick(&["0", "5", "25", "1", "3", "0625"]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_program_and_another_seed_another() {
        assert_eq!(program(5, "", ""), program(5, "", ""));
        assert_ne!(program(5, "", ""), program(6, "", ""));
    }

    #[test]
    fn every_kind_occurs_among_few_programs() {
        let texts: String = (0..30).map(|seed| program(seed, "", "")).collect();
        for kind in KINDS {
            assert!(texts.contains(&format!("static unsigned {}", kind.name)), "{}", kind.name);
        }
    }
}
