//! Properties of the parser, as pairs of source and tree or message.

use std::fmt::Write;

use super::*;
use crate::pp::{self, MemoryFiles};
use crate::render::human::{Color, Renderer};

/// Fragments of valid and invalid C programs.
const FRAGMENTS: &[&str] = &[
    "int ",
    "x",
    "main",
    "(",
    ")",
    "{",
    "}",
    "[",
    "]",
    ";",
    ",",
    "#define ",
    "#if ",
    "#endif\n",
    "#else\n",
    "\n",
    "#include \"a.h\"\n",
    "\\\n",
    "\"",
    "'",
    "/*",
    "*/",
    "//",
    "##",
    "#",
    "__VA_ARGS__",
    "...",
    "F(",
    "F",
    "#define F(a,b) a##b #a\n",
    "struct ",
    "enum ",
    "typedef ",
    "T",
    "1",
    "0x1p3",
    "1.5f",
    "for (",
    "while (",
    "if (",
    "else ",
    "return ",
    "switch (",
    "case 1:",
    "default:",
    "goto ",
    "x:",
    "?",
    ":",
    "=",
    "+",
    "-",
    "*",
    "&&",
    "->",
    ".",
    "sizeof ",
    "static ",
    "\u{E9}",
    "\u{A0}",
    "\u{201C}",
    "\0",
    "\r\n",
    " ",
    "va_arg(",
    "_Generic(",
    "defined ",
    "#undef F\n",
    "#line 3\n",
    "__LINE__",
    "do ",
    "asm",
    "unsigned ",
    "__attribute__((x))",
    "({",
    "})",
    "(int)",
    "L\"a\"",
    "\x1A",
    "@",
    "#error x\n",
    "0 ... 1",
    "\\",
];

struct Outcome {
    tree: String,
    said: Vec<String>,
}

fn run(input: &str) -> Outcome {
    let mut sources = SourceMap::new();
    let mut names = Names::new();
    let mut sink = Sink::new();
    let main = sources.add_file("main.c", None, input.as_bytes().to_vec(), None);
    let files = MemoryFiles::new().with("main.c", input);
    let tokens = pp::preprocess(main, &pp::Options::default(), &files, &mut sources, &mut names, &mut sink);
    let unit = parse(&tokens, &sources, &names, &mut sink);
    let said = sink.diagnostics().iter().map(|diagnostic| {
        let mut text = String::new();
        if let Some(place) = diagnostic.span.and_then(|span| sources.place(span)) {
            write!(text, "{}:{}: ", place.line, place.column).unwrap();
        }
        let _ = Renderer::new(&sources, Color::Never).render(diagnostic);
        text + &diagnostic.message
    });
    Outcome { said: said.collect(), tree: print::print(&unit, &names) }
}

/// External declarations that are accepted silently.
fn unit(input: &str, expect: &str) {
    let Outcome { tree, said } = run(input);
    assert_eq!(said, Vec::<String>::new(), "said about:\n{input}");
    assert_eq!(tree.trim_end(), expect, "tree of:\n{input}");
}

/// Statements of a function.
fn body(input: &str, expect: &str) {
    let Outcome { tree, said } = run(&format!("typedef int T; f() {{ {input} }}"));
    assert_eq!(said, Vec::<String>::new(), "said about:\n{input}");
    let tree = tree.lines().nth(1).unwrap();
    let tree = tree.strip_prefix("(function ? f () (block ").unwrap_or(tree);
    assert_eq!(tree.strip_suffix("))").unwrap_or(tree), expect, "tree of:\n{input}");
}

fn expression(input: &str, expect: &str) {
    body(&format!("{input};"), expect);
}

/// Source that has exactly these errors.
fn errors(input: &str, expect: &[&str]) {
    assert_eq!(run(input).said, expect, "said about:\n{input}");
}

#[test]
fn operators_bind_as_in_c() {
    expression("a+b*c", "(+ a (* b c))");
    expression("a-b-c", "(- (- a b) c)");
    expression("a=b=c", "(= a (= b c))");
    expression(
        "a||b&&c|d^e&f==g<h<<i+j*k",
        "(|| a (&& b (| c (^ d (& e (== f (< g (<< h (+ i (* j k))))))))))",
    );
    expression("a?b:c?d:e", "(? a b (? c d e))");
    expression("a?b,c:d=e", "(= (? a (, b c) d) e)");
    expression("a ?: b", "(?: a b)");
    expression("a+=b, c<<=1", "(, (+= a b) (<<= c 1))");
    expression("-a[1].b->c++", "(- (post++ (-> (. (index a 1) b) c)))");
    expression("*p++ = ~!&x", "(= (* (post++ p)) (~ (! (& x))))");
    expression("- -a + + +b", "(+ (- (- a)) (+ (+ b)))");
    expression("++*--p", "(pre++ (* (pre-- p)))");
    expression("f(a, (b, c))(d)()", "(call (call (call f a (, b c)) d))");
    expression("a<=b>=c!=d", "(!= (>= (<= a b) c) d)");
    expression("a*b/c%d>>e", "(>> (% (/ (* a b) c) d) e)");
}

#[test]
fn casts_and_types_in_expressions() {
    expression("(int)a+b", "(+ (cast (int) a) b)");
    expression("(a)+b", "(+ a b)");
    expression("(T)+b", "(cast (T) (+ b))");
    expression("*(float *)&x", "(* (cast (float *) (& x)))");
    expression("(unsigned char)(int)a[1]", "(cast (uchar) (cast (int) (index a 1)))");
    expression("(void (*)(int))p", "(cast (void * (fn int)) p)");
    expression("sizeof(int)*2", "(* (sizeof-type (int)) 2)");
    expression("sizeof(a)*2", "(* (sizeof a) 2)");
    expression("sizeof a[1]", "(sizeof (index a 1))");
    expression("sizeof(int[3])", "(sizeof-type (int [3]))");
    expression("sizeof(int){1}", "(sizeof (literal (int) (list 1)))");
    expression("(struct s){1, .x = 2}.y", "(. (literal ((struct s)) (list 1 .x = 2)) y)");
    expression("_Alignof(double)", "(alignof (double))");
    expression("(int)-1", "(cast (int) (- 1))");
    expression("__builtin_offsetof(struct s, a[1].b)", "(offsetof ((struct s)) .a (at 1) .b)");
    expression(
        "_Generic(x, int: 1, T *: 2, default: 3)",
        "(generic x (case (int) 1) (case (T *) 2) (default 3))",
    );
    expression("({ int a; a; })", "(statements (var int a) a)");
    expression("__extension__ (1)", "1");
}

#[test]
fn constants() {
    expression("1 + 2u + 3LL + 0x10", "(+ (+ (+ 1 2u) 3ll) 16)");
    expression("1.5 + 1e-6f + 08.5", "(+ (+ 1.5 9.999999974752427e-7f) 8.5)");
    expression("'a' + '\\377' + L'b'", "(+ (+ '97' '-1') L'98')");
    expression(r#""a" "b\n" L"c""#, r#"L"ab\nc""#);
    expression("__func__, __FUNCTION__", "(, __func__ __func__)");
    errors("int a = 2000f;", &["1:9: `2000f` is an integer"]);
    errors("int a = 08;", &["1:10: invalid digit `8` in octal constant"]);
    errors("int a = 20s;", &["1:11: invalid suffix `s` on integer constant"]);
    errors("int a = 99999999999999999999;", &["1:9: integer constant does not fit 64 bits"]);
    errors(r#"char *a = "C:\Program";"#, &[r"1:14: unknown escape `\P`"]);
    errors(
        "int a = 'ab', b = '';",
        &["1:9: character constant has more than one character", "1:19: character constant is empty"],
    );
}

#[test]
fn declarators() {
    unit(
        "int a, *b, c[3], *d[3], (*e)[3], f(), (*g)(), *h();",
        "(var int a, b *, c [3], d [3] *, e * [3], f (), g * (), h () *)",
    );
    unit("int (*(*a)(int))[3];", "(var int a * (fn int) * [3])");
    unit("char *const *volatile p;", "(var char p * volatile * const)");
    unit(
        "void f(int, char *s, double [], int (*)(void), ...);",
        "(var void f (fn int, char s *, double [], int * (fn) ...))",
    );
    unit("int f(void), g(int (x), int (*y));", "(var int f (fn), g (fn int x, int y *))");
    unit(
        "typedef int T; void f(T), g(int T), h(int (T));",
        "(var typedef int T)\n(var void f (fn T), g (fn int T), h (fn int (fn T)))",
    );
    unit("int a[2][3] = {{1,2,3},{4}};", "(var int a [2] [3] = (list (list 1 2 3) (list 4)))");
    unit("int a[static 3], b[*p];", "(var int a [3], b [(* p)])");
    unit("int (a), ((*b));", "(var int a, b *)");
    unit("__attribute__((aligned(8))) int a __attribute__((unused)), b;", "(var int a, b)");
}

#[test]
fn specifiers() {
    unit("unsigned long int a;", "(var ulong a)");
    unit("int long unsigned b;", "(var ulong b)");
    unit(
        "long long c; short d; signed char e; unsigned f; long double g;",
        "(var llong c)\n(var short d)\n(var schar e)\n(var uint f)\n(var ldouble g)",
    );
    unit(
        "static const volatile int a; extern register_t;",
        "(var static const volatile int a)\n(var extern ? register_t)",
    );
    unit("static inline int f(int *restrict p);", "(var static inline int f (fn int p *))");
    unit("_Noreturn void f(void); __inline__ g();", "(var void f (fn))\n(var inline ? g ())");
    unit("typeof(1+2) a; typeof(int *) b;", "(var (typeof (+ 1 2)) a)\n(var (typeof int *) b)");
    unit("va_list a; int va_list;", "(var (typeof char *) a)\n(var int va_list)");
    errors("unsigned double a;", &["1:1: `unsigned double` is not a type"]);
    errors("static extern int a;", &["1:8: two storage classes in one declaration"]);
    errors("int double a;", &["1:5: two types in one declaration; `double` is the second"]);
    errors("asm(\"nop\");", &["1:1: inline assembly is not supported"]);
}

#[test]
fn implicit_int() {
    unit("main() {}", "(function ? main () (block))");
    unit(
        "x; y = 5; static z; extern w; *p;",
        "(var ? x)\n(var ? y = 5)\n(var static ? z)\n(var extern ? w)\n(var ? p *)",
    );
    unit("f(int a) {} g(const x);", "(function ? f (fn int a) (block))\n(var ? g (fn const ? x))");
    body(
        "static x = 0; register y; const z = 1; auto w; volatile v;",
        "(var static ? x = 0) (var register ? y) (var const ? z = 1) (var auto ? w) (var volatile ? v)",
    );
}

#[test]
fn old_style_functions() {
    unit("f(a, b) int a; float b; {}", "(function ? f (names a b) (var int a) (var float b) (block))");
    unit("int f(a) { return a; }", "(function int f (names a) (block (return a)))");
    unit("int f(p) int (*p)(); {}", "(function int f (names p) (var int p * ()) (block))");
}

#[test]
fn typedef_names_can_be_hidden() {
    body("T T; T = 1; T * T;", "(var T T) (= T 1) (* T T)");
    body("T * a; { int T; T * a; } T * b;", "(var T a *) (block (var int T) (* T a)) (var T b *)");
    body("T: goto T;", "(label T (goto T))");
    body("for (int T = 0;;) T * a; T b;", "(for (var int T = 0) () () (* T a)) (var T b)");
    body("enum { T }; T * a;", "(type (enum T)) (* T a)");
    unit(
        "typedef int T; f(int T) { T * 2; } T x;",
        "(var typedef int T)\n(function ? f (fn int T) (block (* T 2)))\n(var T x)",
    );
    unit(
        "typedef int T; typedef int T; struct T { T T; };",
        "(var typedef int T)\n(var typedef int T)\n(type (struct T (member T T)))",
    );
}

#[test]
fn records_and_enumerations() {
    unit(
        "struct s { int a, *b; char c : 3, : 5; ; };",
        "(type (struct s (member int a, b *) (member char c : 3, : 5)))",
    );
    unit(
        "struct { union { int a; float b; }; struct t *n; } x;",
        "(var (struct (member (union (member int a) (member float b))) (member (struct t) n *)) x)",
    );
    unit("struct e {}; union u;", "(type (struct e))\n(type (union u))");
    unit("enum e { A, B = 2, C, } x;", "(var (enum e A (= B 2) C) x)");
    unit(
        "struct { char c; unsigned int i[]; } __attribute__((packed)) p;",
        "(var (struct (member char c) (member uint i [])) p)",
    );
}

#[test]
fn initializers() {
    unit("int a[] = {1, 2,}, b = 3;", "(var int a [] = (list 1 2), b = 3)");
    unit(
        "struct s x = {.a = 1, b: 2, .c[1].d = {3}};",
        "(var (struct s) x = (list .a = 1 .b = 2 .c (at 1) .d = (list 3)))",
    );
    unit(
        "int a[9] = {[0 ... 3] = 1, [5] = 2, [6] 7};",
        "(var int a [9] = (list (from 0 3) = 1 (at 5) = 2 (at 6) = 7))",
    );
    unit("int a[3] = {};", "(var int a [3] = (list))");
}

#[test]
fn statements() {
    body("if (a) b; else if (c) d; else e;", "(if a b (if c d e))");
    body("while (a) ; do b; while (c);", "(while a ()) (do b c)");
    body(
        "for (;;) ; for (i = 0; i < 3; i++) {}",
        "(for () () () ()) (for (= i 0) (< i 3) (post++ i) (block))",
    );
    body("for (int i = 0, j; i;) break;", "(for (var int i = 0, j) i () break)");
    body(
        "switch (a) { case 1: case 2 ... 5: b; break; default: c; }",
        "(switch a (block (case 1 (case 2 ... 5 b)) break (default c)))",
    );
    body("p = &&a; goto *p; a: ;", "(= p (&& a)) (goto* p) (label a ())");
    body("a: b; goto a; return; return 1+2;", "(label a b) (goto a) (return) (return (+ 1 2))");
    body("int a; a = 1; int b = a;", "(var int a) (= a 1) (var int b = a)");
    body("switch (a) { case 1: }", "(switch a (block (case 1 ())))");
    body("{ end: }", "(block (label end ()))");
    body(
        "a: int b; switch (c) { case 1: int d; default: }",
        "(label a (var int b)) (switch c (block (case 1 (var int d)) (default ())))",
    );
    body(
        "int g(int); extern int h; struct s { int a; } x;",
        "(var int g (fn int)) (var extern int h) (var (struct s (member int a)) x)",
    );
    body("; ; {}", "() () (block)");
    body("_Static_assert(1, \"m\"); static_assert(2);", "(static-assert 1) (static-assert 2)");
    unit(";;int a;;", "(var int a)");
    unit(";", "");
}

#[test]
fn variable_argument_macros_work_unless_the_program_declares_them() {
    body(
        "va_list p; va_start(p, a); va_arg(p, int *); va_copy(q, p); va_end(p);",
        "(var (typeof char *) p) (va_start p a) (va_arg (int *) p) (va_copy q p) (va_end p)",
    );
    unit(
        "int va_end(int); f() { va_end(1); offsetof; }",
        "(var int va_end (fn int))\n(function ? f () (block (call va_end 1) offsetof))",
    );
}

#[test]
fn missing_semicolons_are_shown_where_they_belong() {
    errors("main() { x = 1\n y = 2; }", &["1:15: expected `;` after `x = 1`"]);
    errors("main() { x = 1 }", &["1:15: expected `;` after `x = 1`"]);
    errors("main() { int x\n x = 1; }", &["1:15: expected `;` after `int x`"]);
    errors("int x\nint y;", &["1:6: expected `;` after `int x`"]);
    errors("main() { f(1) g(2); h(3); }", &["1:14: expected `;` after `f(1)`"]);
    errors("main() { return 1\n}", &["1:18: expected `;` after `return 1`"]);
    errors("struct s { int a; }\nint b;", &["1:20: expected `;` after `struct s { int a; }`"]);
    errors("#define A x = 1\nmain() { A\n A; }", &["2:11: expected `;` after `A`"]);
    errors("do x(); while (1)", &["1:1: statement outside a function, at `do`"]);
}

#[test]
fn unclosed_brackets_point_to_the_opener() {
    errors("main() { if (a) { b; }", &["1:8: `{` is never closed"]);
    errors("main() { f(a; b; }", &["1:13: expected `)`"]);
    errors("main() { if (a { b; } c; }", &["1:16: expected `)`, found `{`"]);
    errors("main() { a[1; }", &["1:13: expected `]`"]);
    errors("int a[] = {1, 2;", &["1:16: expected `}`"]);
    errors("main() { } }", &["1:12: `}` without `{`"]);
    errors(
        "main() { f(a b); g(; h(1); }",
        &["1:13: expected `,` between two arguments", "1:20: expected an expression, found `;`"],
    );
}

#[test]
fn several_errors_are_found_in_one_run() {
    errors(
        "main() {\n a = ;\n b = 1;\n c = * ;\n if (d +) e;\n for (i = 0, i < 3; i++) { j; }\n while) x;\n}\nint k = ;\nint l;",
        &[
            "2:6: expected an expression, found `;`",
            "4:8: expected an expression, found `;`",
            "5:9: expected an expression, found `)`",
            "6:24: expected `;` after the condition of `for`, found `)`",
            "7:7: expected `(` after `while`, found `)`",
            "9:9: expected an expression, found `;`",
        ],
    );
    let many: String = (0..100).map(|n| format!("int a{n} = ;\n")).collect();
    let said = run(&many).said;
    assert_eq!(said.len(), 21);
    assert_eq!(said.last().unwrap(), "more than 20 errors; the rest of the program was not checked");
}

#[test]
fn unknown_types_are_reported_once() {
    errors("CHAN *ch0; CHAN *ch1; f(CHAN *c) { CHAN *d; c = d; }", &["1:1: unknown type `CHAN`"]);
    errors("void f(CHANN *ch) { }", &["1:8: unknown type `CHANN`"]);
    errors("f(int a, b) { }", &["1:10: unknown type `b`"]);
    errors(
        "main() { BYTE x; WORD *p = 0; x = 1; }",
        &["1:10: unknown type `BYTE`", "1:18: unknown type `WORD`"],
    );
    errors("static FOO x; BAR f(void) { }", &["1:8: unknown type `FOO`", "1:15: unknown type `BAR`"]);
    errors("struct s { FOO x; int y; };", &["1:12: unknown type `FOO`"]);
    errors("viod f() { }", &["1:1: unknown type `viod`"]);
    body("int a; a * b;", "(var int a) (* a b)");
}

#[test]
fn unsupported_constructs_are_reported_as_such() {
    errors(
        "main() { int f(int a) { return a; } x; }",
        &["1:14: function `f` is defined inside another function"],
    );
    errors("main() { f(a) { return a; } x; }", &["1:10: function `f` is defined inside another function"]);
    errors(
        "main() {\n if (x) {\n y;\n}\n\nint f() { return 1; }\nint g() { return 2; }",
        &["6:5: function `f` is defined inside another function"],
    );
    errors("main() { p = &&1; x; }", &["1:14: `&&` before an operand needs a label"]);
    errors("main() { asm(\"nop\"); x; }", &["1:10: inline assembly is not supported"]);
    errors("double _Complex z;", &["1:8: complex numbers are not supported"]);
}

#[test]
fn misplaced_constructs_are_reported() {
    errors("main() { else x; }", &["1:10: `else` without `if`"]);
    errors("main() { a = int; }", &["1:14: expected an expression, found `int`"]);
    errors("main() { a = @; }", &["1:14: expected an expression, found the character `@`"]);
    errors(
        "persist.x = 1;\nfor(;;);\nch0->a = 2;\nint x;",
        &["1:1: statement outside a function, at `persist`"],
    );
    errors(
        "main() { switch (a) { case 1; b; case 2\n c; } }",
        &["1:29: expected `:` after the value of `case`", "1:40: expected `:` after the value of `case`"],
    );
    errors("int 3x;", &["1:5: expected a name, found `3x`"]);
    errors("main() { int a = 1", &["1:8: `{` is never closed"]);
    errors("int a =", &["1:8: expected an expression, found the end of the file"]);
    errors("main( {", &["1:7: expected a parameter, found `{`"]);
}

proptest::proptest! {
    /// For any text, there is a tree and a message for each diagnostic.
    #[test]
    fn no_text_makes_the_compiler_panic(words in proptest::collection::vec(0..FRAGMENTS.len(), 0..80)) {
        let text: String = words.into_iter().map(|word| FRAGMENTS[word]).collect();
        run(&text);
    }
}

#[test]
fn text_abandoned_by_the_preprocessor_is_not_reported_as_unclosed() {
    errors(
        "#include \"main.c\"\nmain() {",
        &["1:10: files included deeper than 64; does `main.c` include itself?"],
    );
}

/// Runs on a larger stack than a test has: frames are larger on Windows.
fn on_large_stack<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> T {
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(work);
    thread.expect("a thread starts").join().expect("nothing panics")
}

fn said_on_large_stack(input: String) -> Vec<String> {
    on_large_stack(move || run(&input).said)
}

#[test]
fn chains_of_operators_have_a_limit() {
    let check = |input: String, expect: &[&str]| assert_eq!(said_on_large_stack(input), expect);
    check(format!("main() {{ a{}; }}", "+a".repeat(30_000)), &[]);
    check(
        format!("main() {{ a{}; }}", "+a".repeat(30_001)),
        &["1:60012: more than 30000 operators in a row"],
    );
    check(format!("main() {{ a{}; }}", "[1]".repeat(641)), &["1:1931: nested deeper than 640 levels"]);
    check(format!("int {}a;", "*".repeat(641)), &["1:647: nested deeper than 640 levels"]);
}

#[test]
fn nesting_has_a_limit() {
    let deep =
        |open: &str, close: &str| format!("main() {{ {}a{}; }}", open.repeat(10_000), close.repeat(10_000));
    for (open, close) in [
        ("(", ")"),
        ("-", ""),
        ("f(", ")"),
        ("a[", "]"),
        ("{", "}"),
        ("if (a) ", ""),
        ("a=", ""),
        ("a?", ":b"),
        ("a?b:", ""),
        ("(int)", ""),
        ("sizeof ", ""),
        ("({", ";})"),
        ("x:", ""),
        ("do ", "while(a);"),
    ] {
        let said = said_on_large_stack(deep(open, close));
        assert_eq!(said.len(), 1, "{open}: {said:?}");
        assert!(said[0].ends_with("nested deeper than 640 levels"), "{open}: {said:?}");
    }
    for input in ["(".repeat(10_000), "{".repeat(10_000)] {
        let said = said_on_large_stack(format!("int a = {input}"));
        assert_eq!(said.len(), 1, "{said:?}");
    }
    for (open, close) in [("(", ")"), ("(*", ")()"), ("(*", ")(int)")] {
        let said = said_on_large_stack(format!("int {}a{};", open.repeat(10_000), close.repeat(10_000)));
        assert_eq!(said.len(), 1, "{said:?}");
    }
    let said = said_on_large_stack(format!("{}int x;{}", "struct {".repeat(10_000), "} a;".repeat(10_000)));
    assert_eq!(said.len(), 1, "{said:?}");
    on_large_stack(|| body(&format!("{}a{};", "(".repeat(600), ")".repeat(600)), "a"));
}
