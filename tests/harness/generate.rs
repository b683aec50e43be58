//! Random C programs with defined behaviour, whose output must be the same with every compiler.
//!
//! Unspecified behaviour does not occur: expressions have no side effects, a call is the whole right-hand side of its
//! assignment and cannot change the left-hand side, shift counts and indices are masked, divisors are at least 2, a
//! double is converted to an integer only if it fits, everything is initialised. Integers wrap (`gcc -fwrapv`), `char`
//! is signed, and no type is used whose size differs between the board and a PC: no `long`, no sizes of pointers.
//! Dividing by 1 is defined, but GCC computes `-(a / b)` as `a / -b`, and the processor then refuses to divide the
//! least integer by -1.
//!
//! A program ends: loops count to a constant, and a function calls only earlier ones, a few times.

use std::fmt::Write as _;

use crate::random::Random;

/// Types of variables, each with whether it is floating.
const TYPES: &[(&str, bool)] = &[
    ("char", false),
    ("unsigned char", false),
    ("short", false),
    ("unsigned short", false),
    ("int", false),
    ("int", false),
    ("unsigned", false),
    ("long long", false),
    ("unsigned long long", false),
    ("float", true),
    ("double", true),
];

/// The number of elements of every array, a power of two.
const ELEMENTS: usize = 8;

/// The maximum nesting of loops, and of expressions.
const LOOPS: usize = 2;
const DEPTH: usize = 4;

/// A random program; all its names begin with `prefix`, its entry is `int PREFIXmain(void)`, whose result is
/// meaningless, and its lines of output begin with `label`.
#[must_use]
pub fn program(seed: u64, prefix: &str, label: &str) -> String {
    let mut writer = Writer::new(seed, prefix);
    writer.globals();
    for number in 0..4 {
        writer.function(number);
    }
    writer.main(label);
    writer.text
}

/// A variable that can be read and, unless it is a loop counter, assigned.
#[derive(Clone, Debug)]
struct Variable {
    /// The C expression for the variable; `@` is a placeholder for an index.
    place: String,
    is_float: bool,
    is_wide: bool,
}

struct Writer {
    random: Random,
    prefix: String,
    text: String,
    indent: usize,
    globals: Vec<Variable>,
    locals: Vec<Variable>,
    /// The counters of the enclosing loops.
    counters: Vec<String>,
    /// The results of the functions so far: whether each is floating.
    functions: Vec<bool>,
    calls_left: usize,
}

impl Writer {
    fn new(seed: u64, prefix: &str) -> Self {
        // Adjacent seeds must not give similar programs.
        Self {
            random: Random::of_seed(seed),
            prefix: prefix.to_owned(),
            text: String::new(),
            indent: 0,
            globals: Vec::new(),
            locals: Vec::new(),
            counters: Vec::new(),
            functions: Vec::new(),
            calls_left: 0,
        }
    }

    fn below(&mut self, end: usize) -> usize {
        self.random.below(end)
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        self.random.pick(from)
    }

    fn line(&mut self, text: &str) {
        let indent = 4 * self.indent;
        let _ = writeln!(self.text, "{:indent$}{text}", "");
    }

    /// A number as a constant of its type.
    fn constant(&mut self, is_float: bool) -> String {
        if is_float {
            return self.pick(&["0.5", "-1.25", "3.0f", "1e3", "-0.0625", "7.75f", "100.0"]).to_owned();
        }
        let edges =
            ["0", "1", "-1", "127", "-128", "255", "32767", "65535", "2147483647", "(-2147483647 - 1)"];
        match self.below(4) {
            0 => self.pick(&edges).to_owned(),
            1 => format!("{}u", self.below(1 << 31)),
            2 => format!("{}LL", self.below(1 << 31) * 4099),
            _ => format!("{}", self.below(100)),
        }
    }

    fn globals(&mut self) {
        let prefix = self.prefix.clone();
        self.text.push_str("int printf(const char *format, ...);\n\n");
        self.line(&format!("struct {prefix}pair {{ char c; double d; int i; short s; }};"));
        self.line(&format!(
            "static struct {prefix}pair {prefix}s0 = {{1, 2.5, 3, 4}}, {prefix}s1[{ELEMENTS}];"
        ));
        for (field, is_float) in [("c", false), ("d", true), ("i", false), ("s", false)] {
            self.globals.push(variable(format!("{prefix}s0.{field}"), is_float, false));
            self.globals.push(variable(format!("{prefix}s1[@].{field}"), is_float, false));
        }
        for (number, (ty, is_float)) in TYPES.iter().enumerate() {
            let start = self.constant(*is_float);
            let is_wide = ty.ends_with("long long");
            self.line(&format!("static {ty} {prefix}g{number} = {start}, {prefix}a{number}[{ELEMENTS}];"));
            self.globals.push(variable(format!("{prefix}g{number}"), *is_float, is_wide));
            self.globals.push(variable(format!("{prefix}a{number}[@]"), *is_float, is_wide));
        }
        self.line("");
    }

    fn function(&mut self, number: usize) {
        let (result, is_float) =
            [("int", false), ("double", true), ("unsigned", false), ("short", false)][number];
        let prefix = self.prefix.clone();
        let linkage = self.pick(&["static ", ""]);
        self.line(&format!("{linkage}{result} {prefix}f{number}(int p, double q, unsigned char r)"));
        self.line("{");
        self.indent = 1;
        self.locals = vec![
            variable("p".to_owned(), false, false),
            variable("q".to_owned(), true, false),
            variable("r".to_owned(), false, false),
        ];
        self.calls_left = 2;
        self.declarations();
        let count = 3 + self.below(5);
        self.statements(count);
        let value = self.typed(is_float);
        self.line(&format!("return {value};"));
        self.indent = 0;
        self.line("}\n");
        self.functions.push(is_float);
    }

    /// Declares locals, all of them initialised: plain ones, and an array accessed through a pointer.
    fn declarations(&mut self) {
        for number in 0..3 {
            let (ty, is_float) = TYPES[self.below(TYPES.len())];
            let start = self.typed(is_float);
            self.line(&format!("{ty} v{number} = {start};"));
            self.locals.push(variable(format!("v{number}"), is_float, ty.ends_with("long long")));
        }
        let (ty, is_float) = TYPES[self.below(TYPES.len())];
        let start = self.below(ELEMENTS);
        self.line(&format!("{ty} w[{ELEMENTS}] = {{1, 2, 3}}, *x = w + {start};"));
        let is_wide = ty.ends_with("long long");
        self.locals.push(variable("w[@]".to_owned(), is_float, is_wide));
        self.locals.push(variable("*x".to_owned(), is_float, is_wide));
        self.line("int i0 = 0, i1 = 0;");
    }

    fn statements(&mut self, count: usize) {
        for _ in 0..count {
            self.statement();
        }
    }

    fn statement(&mut self) {
        match self.below(12) {
            0 | 1 if self.counters.len() < LOOPS => self.repetition(),
            2 | 3 => self.alternative(),
            4 if self.indent < 4 => self.selection(),
            5 | 6 if self.calls_left > 0 && self.counters.is_empty() && !self.functions.is_empty() => {
                self.call();
            }
            7 => {
                let prefix = self.prefix.clone();
                let (a, b) = (self.index(), self.index());
                self.line(&format!("{prefix}s1[{a}] = {prefix}s1[{b}];"));
            }
            _ => self.assignment(),
        }
    }

    /// A loop that counts to a constant.
    fn repetition(&mut self) {
        let counter = format!("i{}", self.counters.len());
        let end = 1 + self.below(ELEMENTS);
        match self.below(3) {
            0 => self.line(&format!("for ({counter} = 0; {counter} < {end}; {counter}++) {{")),
            1 => self.line(&format!("for ({counter} = {end}; {counter} > 0; {counter} -= 1) {{")),
            _ => self.line(&format!("for ({counter} = 0; {counter} != {end}; ++{counter}) {{")),
        }
        self.counters.push(counter);
        self.indent += 1;
        let count = 1 + self.below(3);
        self.statements(count);
        if self.below(3) == 0 {
            let condition = self.integer(2);
            let word = self.pick(&["break", "continue"]);
            self.line(&format!("if ({condition}) {word};"));
            self.assignment();
        }
        self.indent -= 1;
        self.counters.pop();
        self.line("}");
    }

    fn alternative(&mut self) {
        let condition = self.integer(DEPTH - 1);
        self.line(&format!("if ({condition}) {{"));
        self.indent += 1;
        self.assignment();
        if self.below(2) == 0 {
            self.indent -= 1;
            self.line("} else {");
            self.indent += 1;
            self.assignment();
        }
        self.indent -= 1;
        self.line("}");
    }

    fn selection(&mut self) {
        let index = self.integer(2);
        self.line(&format!("switch ({index} & 7) {{"));
        for case in 0..2 + self.below(5) {
            self.line(&format!("case {case}:"));
            self.indent += 1;
            self.assignment();
            if self.below(3) != 0 {
                self.line("break;");
            }
            self.indent -= 1;
        }
        self.line("default:");
        self.indent += 1;
        self.assignment();
        self.indent -= 1;
        self.line("}");
    }

    /// A call of an earlier function, directly or through a pointer.
    fn call(&mut self) {
        self.calls_left -= 1;
        let number = self.below(self.functions.len());
        // Its index could be evaluated before or after the call, so it is a constant.
        let place = self.leaf(self.functions[number]);
        let (p, q, r) = (self.integer(2), self.float(2), self.integer(1));
        let pointer = if self.below(3) == 0 { "*&" } else { "" };
        let prefix = self.prefix.clone();
        self.line(&format!("{place} = ({pointer}{prefix}f{number})({p}, {q}, {r});"));
    }

    fn assignment(&mut self) {
        let is_float = self.below(3) == 0;
        let place = self.place(is_float);
        match self.below(6) {
            0 if !is_float => {
                let operator = self.pick(&["+=", "-=", "*=", "&=", "|=", "^="]);
                let value = self.integer(2);
                self.line(&format!("{place} {operator} {value};"));
            }
            1 if !is_float => {
                let (operator, count) = (self.pick(&["<<=", ">>="]), self.below(7));
                self.line(&format!("{place} {operator} {count};"));
            }
            2 => {
                let step = self.pick(&["++", "--"]);
                self.line(&format!("{place}{step};").replacen("*x", "(*x)", 1));
            }
            3 if is_float => {
                let (operator, value) = (self.pick(&["+=", "-=", "*="]), self.float(2));
                self.line(&format!("{place} {operator} {value};"));
            }
            _ => {
                let value = self.typed(is_float);
                self.line(&format!("{place} = {value};"));
            }
        }
    }

    /// A variable of the kind, for reading or assigning.
    fn place(&mut self, is_float: bool) -> String {
        let fits = |variable: &&Variable| variable.is_float == is_float;
        let all: Vec<_> = self.locals.iter().chain(&self.globals).filter(fits).cloned().collect();
        let found = all[self.below(all.len())].place.clone();
        if found.contains('@') { found.replace('@', &self.index()) } else { found }
    }

    /// An index for an array.
    fn index(&mut self) -> String {
        match (self.below(4), self.counters.last()) {
            (0 | 1, Some(counter)) => format!("{counter} & 7"),
            (2, _) => format!("{} & 7", self.integer(1)),
            _ => self.below(ELEMENTS).to_string(),
        }
    }

    /// An expression for assignment to a variable of the kind: integers are converted to floating, not the reverse.
    fn typed(&mut self, is_float: bool) -> String {
        if is_float { self.float(DEPTH) } else { self.integer(DEPTH) }
    }

    fn integer(&mut self, depth: usize) -> String {
        if depth == 0 {
            return match self.below(4) {
                0 => self.constant(false),
                1 if !self.counters.is_empty() => {
                    let index = self.below(self.counters.len());
                    self.counters[index].clone()
                }
                _ => self.leaf(false),
            };
        }
        let a = self.integer(depth - 1);
        match self.below(14) {
            0..=3 => {
                format!("({a} {} {})", self.pick(&["+", "-", "*", "&", "|", "^"]), self.integer(depth - 1))
            }
            4 => format!(
                "({a} {} {})",
                self.pick(&["<", ">", "<=", ">=", "==", "!="]),
                self.integer(depth - 1)
            ),
            5 => format!("({a} {} {})", self.pick(&["&&", "||"]), self.integer(depth - 1)),
            6 => format!("({a} {} ({} & 31))", self.pick(&["<<", ">>"]), self.integer(depth - 1)),
            7 => format!("({} {a})", self.pick(&["~", "!", "-"])),
            8 => format!("(({}){a})", TYPES[self.below(9)].0),
            9 => format!("({a} ? {} : {})", self.integer(depth - 1), self.integer(depth - 1)),
            // From 2 to 257, or from 3 to 18.
            10 => format!("({a} {} (({} & 255) + 2))", self.pick(&["/", "%"]), self.integer(depth - 1)),
            11 => format!("({a} {} {})", self.pick(&["/", "%"]), 3 + self.below(16)),
            12 => {
                let operator = self.pick(&["<", ">", "<=", ">=", "==", "!="]);
                format!("({} {operator} {})", self.float(depth - 1), self.float(depth - 1))
            }
            _ => {
                let place = self.leaf(true);
                format!("({place} > -1e6 && {place} < 1e6 ? (int)({place} * 4) : 7)")
            }
        }
    }

    fn float(&mut self, depth: usize) -> String {
        if depth == 0 {
            return if self.below(4) == 0 { self.constant(true) } else { self.leaf(true) };
        }
        let a = self.float(depth - 1);
        match self.below(8) {
            0..=3 => format!("({a} {} {})", self.pick(&["+", "-", "*", "/"]), self.float(depth - 1)),
            4 => format!("(({}){a})", self.pick(&["float", "double"])),
            5 => format!("(({}){})", self.pick(&["float", "double"]), self.integer(depth - 1)),
            6 => format!("({} ? {a} : {})", self.integer(1), self.float(depth - 1)),
            _ => format!("(- {a})"),
        }
    }

    /// A variable of the kind, with a constant as its index, so that expressions stay small.
    fn leaf(&mut self, is_float: bool) -> String {
        let fits = |variable: &&Variable| variable.is_float == is_float;
        let all: Vec<_> = self.locals.iter().chain(&self.globals).filter(fits).cloned().collect();
        let found = &all[self.below(all.len())].place;
        if found.contains('@') {
            found.replace('@', &self.below(ELEMENTS).to_string())
        } else {
            found.clone()
        }
    }

    /// The function that calls and prints everything.
    fn main(&mut self, label: &str) {
        let prefix = self.prefix.clone();
        self.line(&format!("int {prefix}main(void)"));
        self.line("{");
        self.indent = 1;
        self.locals.clear();
        self.line("unsigned sum = 0;");
        self.line("double part = 0;");
        self.line("int i;\n");
        for (number, is_float) in self.functions.clone().into_iter().enumerate() {
            let target = if is_float { "part" } else { "sum" };
            let operator = if is_float { "=" } else { "+=" };
            let (p, q, r) = (self.integer(2), self.float(2), self.integer(1));
            self.line(&format!("{target} {operator} {prefix}f{number}({p}, {q}, {r});"));
        }
        let globals = self.globals.clone();
        self.line(&format!("for (i = 0; i < {ELEMENTS}; i++) {{"));
        self.indent = 2;
        for Variable { place, is_float, is_wide } in globals {
            let place = place.replace('@', "i");
            match (is_float, is_wide) {
                // Comparisons with a NaN are false.
                (true, _) => {
                    self.line(&format!("part = {place};"));
                    self.line("sum = sum * 31 + (part > -1e8 && part < 1e8 ? (int)(part * 16) : part > 0);");
                }
                (_, true) => self.line(&format!("sum = sum * 31 + (unsigned)({place} ^ ({place} >> 32));")),
                _ => self.line(&format!("sum = sum * 31 + {place};")),
            }
        }
        self.indent = 1;
        self.line("}");
        self.line(&format!("printf(\"{label}%08x\\n\", sum);"));
        self.line("return 0;");
        self.indent = 0;
        self.line("}");
    }
}

const fn variable(place: String, is_float: bool, is_wide: bool) -> Variable {
    Variable { place, is_float, is_wide }
}
