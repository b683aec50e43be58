//! Many repetitions, and numbers that are too large.

use std::fmt::Write;

use super::{Input, in_main};

/// The number of repetitions.
const MANY: usize = 100_000;

/// The length of a single item.
const LONG: usize = 1_000_000;

/// The items for `MANY` numbers.
fn many(item: impl Fn(usize) -> String) -> String {
    (0..MANY).map(item).collect()
}

/// All repeated or large inputs.
pub(super) fn inputs() -> Vec<Input> {
    let mut inputs = [sequences(), tokens(), macros(), sizes(), formats(), bytes()].concat();
    inputs.extend(heavy());
    inputs
}

/// Inputs that could take much memory.
pub(super) fn heavy() -> Vec<Input> {
    vec![
        Input::new("100,000 declarations", many(|n| format!("int x{n};\n")) + "main() { }\n"),
        Input::new("100,000 functions", many(|n| format!("f{n}() {{ return {n}; }}\n")) + "main() { }\n"),
        Input::new(
            "100,000 cases",
            in_main(format!("switch (a) {{ {} }}", many(|n| format!("case {n}: b = {n}; break;\n")))),
        ),
        Input::new("a million elements", format!("char x[] = {{ {} }};\nmain() {{ }}\n", "1, ".repeat(LONG))),
        Input::new("a million additions", in_main(format!("a = {}1;", "1 + ".repeat(LONG))))
            .says("30000 operators"),
        Input::new("a million statements", in_main("a++;\n".repeat(LONG / 4))),
        Input::new("two million tokens of string constants", in_main(strings())),
        Input::new("more tokens than there may be", in_main(";".repeat(3 * LONG))).says("2000000 tokens"),
        Input::new("a macro that doubles 40 times", bomb(40)),
        Input::new("a macro that doubles by arguments", argument_bomb()),
        Input::new("a gigantic array", "int x[0x7FFFFFFF / 8];\nmain() { x[0] = 1; }\n"),
        Input::new("a gigantic initialised array", "char x[1900000000] = { 1 };\nmain() { x[0] = 1; }\n"),
        Input::new("a gigantic range", "int x[] = { [0 ... 400000000] = 1 };\nmain() { x[0] = 1; }\n"),
        Input::new("a far designator", "int x[] = { [2147483000 / 4] = 1 };\nmain() { x[0] = 1; }\n"),
        Input::new("a structure that doubles", doubling_structure()),
        Input::new("an inclusion of itself", "#include \"hostile.c\"\nmain() { }\n").says("64"),
        Input::new(
            "two inclusions of itself",
            "#include \"hostile.c\"\n#include \"hostile.c\"\nmain() { }\n",
        )
        .says("64"),
    ]
}

/// The input whose tokens take the most memory.
fn strings() -> String {
    (0..LONG - LONG / 20).fold(String::new(), |mut text, n| {
        let _ = write!(text, "\"a{n}\";");
        text
    })
}

fn bomb(doublings: usize) -> String {
    let mut text = String::from("#define M0 1 +\n");
    for n in 1..=doublings {
        let _ = writeln!(text, "#define M{n} M{0} M{0}", n - 1);
    }
    format!("{text}int x = M{doublings} 0;\nmain() {{ }}\n")
}

fn argument_bomb() -> String {
    let calls = "F(".repeat(40);
    format!("#define F(x) x x\nint y = {calls}+1{} + 0;\nmain() {{ }}\n", ")".repeat(40))
}

fn doubling_structure() -> String {
    let mut text = String::from("struct s0 { int x; };\n");
    for n in 1..40 {
        let _ = writeln!(text, "struct s{n} {{ struct s{0} a, b; }};", n - 1);
    }
    format!("{text}struct s39 x;\nmain() {{ }}\n")
}

/// Many constructs of one kind, one after another.
fn sequences() -> Vec<Input> {
    let declared = |text: String| format!("{text}\nmain() {{ }}\n");
    vec![
        Input::new("many parameters", declared(format!("f({} int z);", many(|n| format!("int a{n}, "))))),
        Input::new("many arguments", in_main(format!("printf(\"\" {});", ", 1".repeat(MANY)))),
        Input::new(
            "many arguments of a macro",
            declared(format!("#define F(...) 1\nint x = F({} 1);", "1, ".repeat(MANY))),
        ),
        Input::new(
            "many parameters of a macro",
            declared(format!("#define F({} z) 1", many(|n| format!("a{n}, ")))),
        )
        .says("10000"),
        Input::new("many members", declared(format!("struct s {{ {} }} x;", many(|n| format!("int a{n};"))))),
        Input::new("many enumerators", declared(format!("enum {{ {} }};", many(|n| format!("a{n},"))))),
        Input::new("many declarators", declared(format!("int {} z;", many(|n| format!("a{n},"))))),
        Input::new(
            "many labels",
            in_main(many(|n| format!("l{n}: ;\n")) + &many(|n| format!("goto l{n};\n"))),
        ),
        Input::new("many undefined labels", in_main(many(|n| format!("goto l{n};\n")))),
        Input::new("many undeclared names", in_main(many(|n| format!("x{n} = 1;\n")))),
        Input::new("many undeclared functions", in_main(many(|n| format!("f{n}();\n")))),
        Input::new("many unknown types", many(|n| format!("t{n} x{n};\n"))),
        Input::new("many missing semicolons", in_main("a = 1\n".repeat(MANY))),
        Input::new("many warnings", in_main("if (a = 1) ;\n".repeat(MANY))),
        Input::new("many strings", in_main(format!("printf({});", "\"x\" ".repeat(MANY)))),
        Input::new("many commas", in_main(format!("a = ({} 1);", "1, ".repeat(MANY))))
            .says("30000 operators"),
        Input::new("many comparisons", in_main(format!("a = {} 1;", "1 < ".repeat(MANY))))
            .says("30000 operators"),
        Input::new("many ands", in_main(format!("a = {} 1;", "a && ".repeat(MANY)))).says("30000 operators"),
        Input::new(
            "operators of rising precedence",
            in_main(format!("a = {} 1;", "1 || 1 && 1 | 1 ^ 1 & 1 == 1 < 1 << 1 + 1 * ".repeat(MANY / 10))),
        ),
        Input::new("many members of members", in_main(format!("a = persist{};", ".x".repeat(MANY)))),
        Input::new("many empty calls", in_main(format!("main{};", "()".repeat(MANY)))),
        Input::new("many semicolons", in_main(";".repeat(LONG))),
        Input::new("many includes", declared("#include \"KMotionDef.h\"\n".repeat(MANY))),
        Input::new("many missing includes", declared(many(|n| format!("#include \"x{n}.h\"\n")))),
        Input::new("many macros", declared(many(|n| format!("#define M{n} {n}\n")))),
        Input::new("many wrong directives", declared("#nonsense\n".repeat(MANY))),
        Input::new("many #elif", declared(format!("#if 0\n{}#endif", "#elif 0\n".repeat(MANY)))),
        Input::new("many #else", declared(format!("#if 0\n{}#endif", "#else\n".repeat(MANY)))),
        Input::new("many type words", declared(format!("{}x;", "unsigned ".repeat(MANY)))),
        Input::new("many qualifiers", declared(format!("{}int x;", "const ".repeat(MANY)))),
        Input::new("many redefinitions", declared("f() { return 1; }\n".repeat(MANY / 10))),
        Input::new("many prototypes", declared("int f(int a);\n".repeat(MANY))),
        Input::new(
            "many calls in a chain",
            declared(format!(
                "f0() {{ }}\n{}",
                (1..MANY / 4).map(|n| format!("f{n}() {{ f{}(); }}\n", n - 1)).collect::<String>()
            )),
        ),
        Input::new("many locals", in_main(many(|n| format!("int x{n} = {n};\n")))),
        Input::new("many blocks", in_main("{ int x = 1; }\n".repeat(MANY))),
        Input::new("many ifs", in_main("if (a) b = a;\n".repeat(MANY / 2))),
        Input::new("many loops", in_main("while (a) b = a;\n".repeat(MANY / 2))),
    ]
}

/// Very long tokens and lines.
fn tokens() -> Vec<Input> {
    let long = |text: &str| text.repeat(LONG);
    let declared = |text: String| format!("{text}\nmain() {{ }}\n");
    vec![
        Input::new("a long identifier", declared(format!("int {};", long("a")))),
        Input::new("a long undeclared identifier", in_main(format!("{} = 1;", long("a")))),
        Input::new("a long undefined function", in_main(format!("{}();", long("f")))),
        Input::new("a long string", in_main(format!("printf(\"{}\");", long("x")))),
        Input::new("a long unclosed string", in_main(format!("printf(\"{}", long("x")))),
        Input::new("a long string of wrong escapes", in_main(format!("printf(\"{}\");", long("\\q")))),
        Input::new("a long character constant", in_main(format!("a = '{}';", long("x")))),
        Input::new("a long number", in_main(format!("a = {};", long("1")))),
        Input::new("a long floating number", in_main(format!("a = 0.{}e5;", long("1")))),
        Input::new("a long exponent", in_main(format!("a = 1e{};", long("9")))),
        Input::new("a long hexadecimal number", in_main(format!("a = 0x{};", long("f")))),
        Input::new("a long suffix", in_main(format!("a = 1{};", long("u")))),
        Input::new("a long comment", declared(format!("/* {} */", long("x*")))),
        Input::new("a long unclosed comment", declared(format!("/* {}", long("x*")))),
        Input::new("a long line comment", declared(format!("// {}", long("x")))),
        Input::new("a long line of blanks", declared(long(" "))),
        Input::new("a long line of statements", in_main("a = 1; ".repeat(MANY))),
        Input::new("a mistake in a long line", in_main(format!("{} b c;", "a = 1; ".repeat(MANY)))),
        Input::new("empty lines", declared(long("\n"))),
        Input::new("continued lines", declared(long("\\\n"))),
        Input::new("a continued name", declared(format!("int {};", "a\\\n".repeat(MANY)))),
        Input::new("a long include name", declared(format!("#include \"{}\"", long("x/")))),
        Input::new("a long upward include name", declared(format!("#include \"{}x.h\"", "../".repeat(MANY)))),
        Input::new("a long directive", declared(format!("#{}", long("x")))),
        Input::new("a long error message", declared(format!("#error {}", long("x")))),
        Input::new("a long #if", declared(format!("#if {}1\n#endif", "1 + ".repeat(MANY)))),
        Input::new("hashes", declared(long("#"))),
        Input::new("hash lines", declared("#\n".repeat(MANY))),
    ]
}

/// Macros that grow, and line numbers.
fn macros() -> Vec<Input> {
    let declared = |text: &str| format!("{text}\nmain() {{ }}\n");
    let doubled = |body: &str| {
        let mut text = String::from(
            "#define S0 x\n#define J(a, b) a ## b\n#define K(a, b) J(a, b)\n#define Q(a) #a\n#define R(a) Q(a)\n",
        );
        for n in 1..40 {
            let _ = writeln!(text, "#define S{n} K(S{0}, S{0})", n - 1);
        }
        format!("{text}{body}\nmain() {{ }}\n")
    };
    vec![
        Input::new("a name that doubles", doubled("int S39;")),
        Input::new("a quoted name that doubles", doubled("char *s = R(S39);")),
        Input::new(
            "quotes of quotes",
            declared(&format!(
                "#define Q(a) #a\n#define R(a) Q(a)\nchar *s = {}x{};",
                "R(".repeat(60),
                ")".repeat(60)
            )),
        ),
        Input::new("macros that call each other", declared("#define A B\n#define B A\nint x = A;")),
        Input::new("a macro that calls itself", declared("#define F(x) F(x) F(x)\nint x = F(F(F(F(1))));")),
        Input::new(
            "a call across directives",
            declared("#define F(x) x\nint x = F(\n#if 1\n1\n#define G\n)\n#endif\n;"),
        ),
        Input::new(
            "an include within a call",
            declared("#define F(x) x\nint x = F(\n#include \"hostile.c\"\n);"),
        ),
        Input::new("pastes of nothing", declared("#define P(a, b) a ## b ## a ## b\nint x = P(,) 1;")),
        Input::new("bad pastes", declared(&"#define P(a, b) a ## b\nint x = P(+, /) 1;\n".repeat(1000))),
        Input::new(
            "wrong line numbers",
            declared("#line 4294967296\n#line 0\n#line -1\n#line 99999999999999999999 \"x\""),
        ),
        Input::new("a division by zero in #if", declared("#if 1 / 0\n#elif 1 % 0\n#endif")),
        Input::new(
            "extreme numbers in #if",
            declared("#if -9223372036854775808 / -1 || 1 << 1000 || 0xFFFFFFFFFFFFFFFF + 1\n#endif"),
        ),
        Input::new(
            "redefined keywords",
            "#define int float\n#define main() main(void)\n#define return\nint main() { return 1; }\n",
        ),
        Input::new(
            "redefined directives",
            "#define include define\n#define define if\n#include include\nmain() { }\n",
        ),
        Input::new(
            "undefined predefined macros",
            "#undef __LINE__\n#undef __FILE__\n#define __LINE__ x\n#define defined 1\nmain() { }\n",
        ),
        Input::new("counters", in_main("a = __COUNTER__;\n".repeat(20_000))),
    ]
}

/// Sizes, counts and constants beyond all bounds.
fn sizes() -> Vec<Input> {
    let declared = |name: &str, text: &str| Input::new(name, format!("{text}\nmain() {{ }}\n"));
    let inside = |name: &str, text: &str| Input::new(name, in_main(text));
    vec![
        declared("an array of 2^31", "int x[2147483648];"),
        declared("an array of 2^63", "int x[9223372036854775808];"),
        declared("an array of -1", "int x[-1];"),
        declared("an array of arrays", "int x[65536][65536][65536];"),
        declared("an array of its own size", "int x[sizeof x];"),
        declared(
            "a structure of gigantic arrays",
            "struct s { char a[0x7FFFFFFF], b[0x7FFFFFFF], c[0x7FFFFFFF]; } x;",
        ),
        declared("a union of gigantic arrays", "union u { double a[0x10000000]; char b[0x7FFFFFFF]; } x[4];"),
        declared("the size of what is too large", "int x[sizeof(char[0x7FFFFFFF][0x7FFFFFFF])];"),
        declared("a structure within itself", "struct s { struct s x; };"),
        declared(
            "structures within each other",
            "struct a { struct b x; };\nstruct b { struct a x; };\nstruct a y;",
        ),
        declared("a type that names itself", "typedef t t;\ntypedef struct s s; typedef s *s;\nt x;"),
        declared("an enumerator of itself", "enum e { x = x + 1, y = sizeof(enum e) };"),
        declared(
            "enumerators that overflow",
            "enum e { x = 2147483647, y, z = -2147483648, w = 99999999999 };",
        ),
        declared("an object that initialises itself", "int x = x; int y = *&y; int *z = &z;"),
        declared(
            "wide bit-fields",
            "struct s { int a : 33; int b : -1; int c : 0; int : 99999999999; char d : 1 / 0; } x;",
        ),
        declared(
            "gigantic alignment",
            "int x __attribute__((aligned(1073741824)));\n_Alignas(2147483648) int y;\n_Alignas(3) int z;",
        ),
        declared(
            "designators out of range",
            "int x[3] = { [5] = 1, [-1] = 2, [1 ... 0] = 3, [9999999999999] = 4 };",
        ),
        declared("too many initialisers", &format!("int x[2] = {{ {} }};", "1, ".repeat(10_000))),
        declared(
            "a flexible array of flexible arrays",
            "struct s { int n; int x[]; } y[] = { { 1, { 2, 3 } } };",
        ),
        declared("an array without size", "int x[], y[][], z[][3]; extern void v; void w[3];"),
        declared("a function that returns an array", "int f()[3]; int g()(); int h[3]();"),
        declared(
            "a conflict of everything",
            "int x; double x; x() { } struct x { } x[3]; typedef int x; enum { x };",
        ),
        inside("gigantic locals", "char x[0x7FFFFFFF]; double y[0x0FFFFFFF]; x[0] = y[0];"),
        inside(
            "impossible shifts",
            "a = 1 << 1000000 | 1 >> -5 | -1 >> 99999999999 | 1LL << 64 | 1 << (1 << 31);",
        ),
        inside(
            "impossible quotients",
            "a = -2147483648 / -1 + 1 / 0 + 5 % 0 + (-9223372036854775807LL - 1) / -1 + 1.0 / 0;",
        ),
        inside(
            "impossible conversions",
            "a = (int)1e300; b = (unsigned)-1e300; a = (char)1e-400; b = (int)(0.0 / 0.0);",
        ),
        inside(
            "impossible constants",
            "a = 99999999999999999999; b = 0xFFFFFFFFFFFFFFFFF; a = 1e99999; b = 0b2; a = 1.2.3; b = 08;",
        ),
        inside(
            "a gigantic range of cases",
            "switch (a) { case -2147483648 ... 2147483647: b = 1; case 5 ... 1: case 7: ; }",
        ),
        inside(
            "overlapping ranges of cases",
            "switch (a) { case 0 ... 2000000000: case 1 ... 1999999999: case 2: default: default: ; }",
        ),
        inside(
            "pointers far away",
            "p = (int *)0xFFFFFFFF + 0x7FFFFFFF; a = p[2147483647] + *(p - 2147483647 * 4); b = &p[1] - (int *)0;",
        ),
        inside(
            "the value of nothing",
            "a = main; b = (void)a; a = *(void *)p; p = &*p + (main()); a = sizeof(void) / sizeof(main);",
        ),
    ]
}

/// Meaningless formats.
fn formats() -> Vec<Input> {
    [
        ("percent signs", "%".repeat(LONG)),
        ("an odd percent sign", "%".repeat(99_999)),
        ("a gigantic width", "%999999999d".to_owned()),
        ("a gigantic precision", "%.999999999f".to_owned()),
        ("a width beyond numbers", format!("%{}d", "9".repeat(MANY))),
        ("many lengths", format!("%{}d", "l".repeat(MANY))),
        ("many flags", format!("%{}d", "-+ #0".repeat(MANY))),
        ("many stars", "%*.*d".repeat(MANY)),
        ("many conversions", "%d%s%f%n%q%y".repeat(MANY / 10)),
        ("an unfinished scan set", "%[^]abc".to_owned()),
    ]
    .into_iter()
    .map(|(name, format)| {
        Input::new(format!("a format of {name}"), in_main(format!("printf(\"{format}\", 1);")))
    })
    .collect()
}

/// Bytes that no editor writes.
fn bytes() -> Vec<Input> {
    // The simplest kind of generator is random enough here.
    let random = |seed: u32, length: usize| -> Vec<u8> {
        let step = |state: &mut u32| {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Some((*state >> 24) as u8)
        };
        std::iter::repeat_n((), length).scan(seed, |state, ()| step(state)).collect()
    };
    let program = in_main("a = ReadBit(46); printf(\"%d\\n\", a);");
    let mut inputs = vec![
        Input::new("nothing", ""),
        Input::new("one byte", "{"),
        Input::new("every byte", (0..=255).collect::<Vec<u8>>()),
        Input::new("NULs", vec![0; LONG]),
        Input::new("a NUL in a program", program.replace("46", "4\u{0}6")),
        Input::new("NULs in a string", program.replace("%d", &"\u{0}".repeat(1000))),
        Input::new("a byte order mark in the middle", program.replace("46", "\u{FEFF}46")),
        Input::new("bytes of no encoding", [program.as_bytes(), &[0xFF; 1000]].concat()),
        Input::new("emoji", program.replace("46", &"🙂".repeat(1000))),
        Input::new("text from right to left", program.replace("46", &"\u{202E}64".repeat(1000))),
        Input::new("UTF-16", program.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>()),
        Input::new("carriage returns", "\r".repeat(LONG)),
        Input::new("vertical tabs", format!("{}{program}", "\u{B}\u{C}".repeat(MANY))),
        Input::new("control Z at once", format!("\u{1A}{program}")),
        Input::new(
            "trigraphs and digraphs",
            "??=define X ??( ??)\n%:define Y <: :>\nint x<:3:>;\nmain() <% %>\n",
        ),
    ];
    inputs.extend((0..16).map(|n| Input::new(format!("random bytes {n}"), random(n, 20_000))));
    inputs.extend((0..16).map(|n| {
        let text: Vec<u8> = random(n, 20_000).iter().map(|byte| 32 + byte % 96).collect();
        Input::new(format!("random characters {n}"), text)
    }));
    inputs.extend((0..24).map(|n: u32| {
        // A program with a random byte at a random position.
        let mut text = program.clone().into_bytes();
        let noise = random(n + 99, 12);
        for pair in noise.chunks_exact(3) {
            let at = (usize::from(pair[0]) * 256 + usize::from(pair[1])) % text.len();
            text[at] = pair[2];
        }
        Input::new(format!("a program with random bytes {n}"), text)
    }));
    inputs
}
