//! Properties of the preprocessor, as pairs of input and output.

use super::*;

const EMBEDDED: &[(&str, &[u8])] = &[("KMotionDef.h", b"#ifndef KM\n#define KM\nint km;\n#endif\n")];

/// The preprocessed text of `main.c` and the messages about it.
fn run(files: &MemoryFiles, main: &str, options: &Options) -> (String, Vec<String>) {
    let mut sources = SourceMap::new();
    let mut names = Names::new();
    let mut sink = Sink::new();
    let text = files.read(main.as_ref()).unwrap();
    let main = sources.add_file(main, Some(main.as_ref()), text, None);
    let tokens = preprocess(main, options, files, &mut sources, &mut names, &mut sink);
    let text = String::from_utf8_lossy(&print(&tokens, &sources)).into_owned();
    let said = sink.diagnostics().iter().map(|diagnostic| {
        let place = diagnostic.span.and_then(|span| sources.place(span));
        let place = place.map(|place| format!("{}:{}", place.line, place.column)).unwrap_or_default();
        format!("{place}: {:?}: {}", diagnostic.severity, diagnostic.message).to_lowercase()
    });
    (text, said.collect())
}

fn options() -> Options {
    Options { include_dirs: vec!["inc".into()], embedded: EMBEDDED, ..Options::default() }
}

/// Input that is accepted silently.
fn check(input: impl AsRef<[u8]>, expect: &str) {
    said(input, expect, &[]);
}

/// Input with the messages about it.
fn said(input: impl AsRef<[u8]>, expect: &str, said: &[&str]) {
    let files = MemoryFiles::new().with("main.c", input.as_ref());
    let (text, found) = run(&files, "main.c", &options());
    let input = String::from_utf8_lossy(input.as_ref());
    assert_eq!(found, said, "said about:\n{input}");
    assert_eq!(text.trim_end(), expect, "output of:\n{input}");
}

#[test]
fn line_ends_and_blanks() {
    check("int a;\r\nint b;\r\n", "int a;\nint b;");
    check("int a;\rint b;", "int a; int b;");
    check("int\ta;\x0c\x0bint b;", "int a; int b;");
    check("\u{FEFF}int a;", "int a;");
    check("int a;\n\x1A", "int a;");
    check("int a;\n\x1A\0\0\r\n", "int a;");
    check("in\\\nt a\\\r\nb = 1\\\n2;", "int ab = 12;");
    said("int a \\ \nb;", "int a b;", &["1:7: warning: whitespace after a backslash at the end of a line"]);
    check("a+\\\n+b; c<\\\n<\\\n=d; e.\\\n.\\\n.;", "a++b; c<<=d; e...;");
}

#[test]
fn comments() {
    check("a // b\nc", "a\nc");
    check("a/* b */c", "a c");
    check("a/**/b /***/ c", "a b c");
    check("// \"don't\"\na /* 'x */", "a");
    check(b"// \xE9\n/* \xE4 */ a", "a");
    check("// C:\\dir\\\n\nb", "b");
    said("// C:\\dir\\\nb", "b", &["1:10: note: comment ends in a backslash"]);
    said("/* /* */ a", "a", &["1:4: warning: `/*` within a comment"]);
    said("a /* b", "a", &["1:3: error: comment is never closed"]);
    check("//*****/\na", "a");
    check("a /\\\n/ b\nc", "a\nc");
}

#[test]
fn quoted_text() {
    check(r#""a\"b" 'c' '\'' L"d" L'e'"#, r#""a\"b" 'c' '\'' L"d" L'e'"#);
    said("\"a\nb\" c", "\"a\nb\" c", &["1:1: warning: string runs over several lines"]);
    said("f(\"a);\nb", "f(\"a);\nb", &["1:3: error: string is never closed"]);
    said("'a;\nb", "'a;\nb", &["1:1: error: character constant is never closed"]);
    check("\"a\\\nb\"", "\"a\\\nb\"");
    check(b"\"\xE9\"", "\"\u{FFFD}\"");
}

#[test]
fn characters_that_c_does_not_know() {
    said("a\u{A0}b\u{A0}c", "a b c", &["1:2: warning: no-break space (u+00a0) is treated as a space"]);
    said(
        "f(\u{201C}a b\u{201D});",
        "f(\u{201C}a b\u{201D});",
        &["1:3: error: character `\u{201C}` (u+201c) is not a quote in c"],
    );
    said("a \u{2013} b", "a - b", &["1:3: error: character `\u{2013}` (u+2013) outside a comment or string"]);
    said(
        "gr\u{F6}\u{DF}e",
        "gr\u{F6}\u{DF}e",
        &["1:3: error: character `\u{F6}` (u+00f6) outside a comment or string"],
    );
    said(b"a\0\0b", "a b", &["1:2: error: nul byte in the source text"]);
    said("a\x1Ab", "a b", &["1:2: error: ctrl-z before the end of the source text"]);
    said(b"\xFF\xFEi\0n\0t\0", "", &["1:1: error: `main.c` is utf-16 text; save it as utf-8 or ansi"]);
    check("a ?? b $ @", "a ?? b $ @");
}

#[test]
fn object_like_macros() {
    check("#define A 1\nA B", "1 B");
    check("#define A B\n#define B A\nA B", "A B");
    check("#define A (1) // note\nA;", "(1);");
    check("#define A 1; /* x\n y */ 2\nA", "1; 2");
    check("#define A\n[A]", "[]");
    check("#define A x\n#undef A\nA", "A");
    check("#define A \\\n 1 \\\n 2\nA", "1 2");
    check("#define A 1\n#define A 1\nA", "1");
    check("#define a b##c\na", "bc");
    said("#define A 1\n#define A 2\nA", "2", &["2:9: warning: macro `a` is redefined with a different body"]);
    check("#define z z[0]\nz", "z[0]");
}

#[test]
fn function_like_macros() {
    check("#define f(x) ((x)+1)\nf(2) f (3)\nf\n(4) f f;", "((2)+1) ((3)+1)\n((4)+1) f f;");
    check("#define f /* c */ (x)\nf", "(x)");
    check("#define f(x) x\nf /* c */ (1) f // d\n(2)", "1 2");
    check("#define f(x,y) x-y\nf((1,2),3) f(,) f(f(1,2),4)", "(1,2)-3 - 1-2-4");
    check("#define f() 1\nf() f( )", "1 1");
    check("#define f(x) [x]\nf() f( )", "[] []");
    check("#define f(x) x f\nf(1)(2)", "1 f(2)");
    check("#define f(a) a*g\n#define g(a) f(a)\nf(2)(9)", "2*9*g");
    check("#define f(x) #x\nf( a  b ) f(\"a\\n\" 'b') f(1\n2)", r#""a b" "\"a\\n\" 'b'" "1 2""#);
    check("#define f(a,b) a##b\nf(x,y) f(,y) f(x,) f(1,e3) [f(,)] f(+,+)", "xy y x 1e3 [] ++");
    check("#define f(...) g(__VA_ARGS__)\nf() f(1) f(1,2)", "g() g(1) g(1,2)");
    check("#define f(a,...) g(a,##__VA_ARGS__)\nf(1) f(1,2) f(1,2,3)", "g(1) g(1,2) g(1,2,3)");
    check(
        "#define f(a,...) g(a __VA_OPT__(,) __VA_ARGS__)\nf(1) f(1,2) f(1,2,3)",
        "g(1) g(1 , 2) g(1 , 2,3)",
    );
    check(
        "#define f(a,...) [__VA_OPT__(a(a),) x]\n#define E\nf(1) f(1,) f(1,E) f(1,2)",
        "[ x] [ x] [ x] [1(1), x]",
    );
    check("#define f(a,...) a##__VA_OPT__(b c)##d\nf(x) f(x,y)", "xd xb cd");
    check("#define f(r...) __VA_OPT__(<r>)\nf() f(1,2)", "<1,2>");
    check("#define f(x) __VA_OPT__(x)\nf(1)", "__VA_OPT__(1)");
    check("#define f(a,r...) g(a, ## r)\nf(1) f(1,2,3)", "g(1) g(1, 2,3)");
    check("#define s(x) #x\n#define t(x) s(x)\n#define A 1\ns(A) t(A)", "\"A\" \"1\"");
    check("#define A 1\n#define f(x) x##A\nf(A)", "AA");
}

#[test]
fn misused_macros() {
    let two = "#define f(a,b) a b\n";
    said(format!("{two}f(1) x"), "f(1) x", &["2:1: error: macro `f` takes 2 arguments, 1 given"]);
    said(format!("{two}f(1,2,3)"), "f(1,2,3)", &["2:1: error: macro `f` takes 2 arguments, 3 given"]);
    said(format!("{two}f(1, g;"), "f(1, g;", &["2:1: error: macro call of `f` is never closed"]);
    said("#define f(a, a) 1", "", &["1:14: error: parameter `a` appears twice"]);
    said("#define f(a", "", &["1:10: error: parameter list is never closed"]);
    said("#define 1 2", "", &["1:9: error: `1` cannot be the name of a macro"]);
    said("#define", "", &["1:8: error: name missing in `#define`"]);
    said("#define f(x) #y", "", &["1:14: error: `#` is not followed by a parameter"]);
    said("#define f(x) ##x", "", &["1:14: error: `##` at the start or end of a macro has nothing to join"]);
    let pasted = &["2:1: warning: pasting `1` and `+` does not give a valid token"];
    said("#define f(a,b) a##b\nf(1,+)", "1+", pasted);
}

/// The examples in C11 6.10.3.5, which test every rule.
#[test]
fn the_examples_of_the_standard() {
    check(
        "#define x 3\n#define f(a) f(x * (a))\n#undef x\n#define x 2\n#define g f\n#define z z[0]\n#define h g(~\n\
         #define m(a) a(w)\n#define w 0,1\n#define t(a) a\n#define p() int\n#define q(x) x\n#define r(x,y) x ## y\n\
         #define str(x) # x\nf(y+1) + f(f(z)) % t(t(g)(0) + t)(1);\ng(x+(3,4)-w) | h 5) & m\n(f)^m(m);\n\
         p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };\nchar c[2][6] = { str(hello), str() };",
        "f(2 * (y+1)) + f(2 * (f(2 * (z[0])))) % f(2 * (0)) + t(1);\n\
         f(2 * (2+(3,4)-0,1)) | f(2 * (~ 5)) & f(2 * (0,1))^m(0,1);\n\
         int i[] = { 1, 23, 4, 5, };\nchar c[2][6] = { \"hello\", \"\" };",
    );
    check(
        "#define hash_hash # ## #\n#define mkstr(a) # a\n#define in_between(a) mkstr(a)\n\
         #define join(c, d) in_between(c hash_hash d)\nchar p[] = join(x, y);",
        "char p[] = \"x ## y\";",
    );
    check(
        "#define t(x,y,z) x ## y ## z\nint j[] = { t(1,2,3), t(,4,5), t(6,,7), t(8,9,),\nt(10,,), t(,11,), t(,,12), t(,,) };",
        "int j[] = { 123, 45, 67, 89,\n10, 11, 12, };",
    );
}

#[test]
fn predefined_macros() {
    check("__LINE__\n\n__LINE__ __FILE__", "1\n3 \"main.c\"");
    check("#define L __LINE__\n\nL", "3");
    check(
        "__STDC__ __TINYC__ __CC67__ __SIZE_TYPE__ __DATE__ __TIME__",
        "1 1 1 unsigned int \"Jan  1 2000\" \"00:00:00\"",
    );
    check("__COUNTER__ __COUNTER__", "0 1");
    check("linux unix __linux__ __x86_64__", "linux unix __linux__ __x86_64__");
    check("#line 100 \"x.c\"\n__LINE__ __FILE__", "100 \"x.c\"");
    check("# 33 \"x.c\" 1\n__LINE__", "33");
    let files = MemoryFiles::new().with("main.c", "A B __TINYC__");
    let defines = vec![("A".to_owned(), "x y".to_owned()), ("B".to_owned(), String::new())];
    let options = Options { defines, undefines: vec!["__TINYC__".to_owned()], ..Options::default() };
    assert_eq!(run(&files, "main.c", &options), ("x y __TINYC__\n".to_owned(), vec![]));
}

#[test]
fn conditionals() {
    check("#if 1\na\n#else\nb\n#endif\nc", "a\nc");
    check("#if 0\na\n#elif 0\nx\n#elif 1\nb\n#elif 1\ny\n#else\nc\n#endif", "b");
    check("#ifdef A\na\n#endif\n#ifndef A\nb\n#endif", "b");
    check("#if 0\n#if 1\na\n#else\nb\n#endif\n#else\nc\n#endif x y \"z\n", "c");
    check("#if 0\ndon't \"\n/* #endif */\n # foo\n#endif\na", "a");
    check("#if 0\n/*\n#endif\n*/\nx\n#endif\na", "a");
    check("#if 1\na\n#else junk ' here\nb\n#endif A's\nc", "a\nc");
    said("#if 1\na", "a", &["1:1: warning: `#if` without `#endif`"]);
    said("#endif", "", &["1:1: error: `#endif` without `#if`"]);
    said("#else\na", "a", &["1:1: error: `#else` without `#if`"]);
    said("#if 1\n#else\n#else\n#endif", "", &["3:1: error: `#else` after `#else`"]);
    said("#if 1\n#else\n#elif 1\n#endif", "", &["3:1: error: `#elif` after `#else`"]);
}

#[test]
fn if_expressions() {
    let holds = |expression: &str| check(format!("#if {expression}\n1\n#endif"), "1");
    for expression in [
        "1+2*3==7",
        "(1+2)*3==9",
        "-7/2==-3",
        "-7%2==-1",
        "7>>1==3",
        "-8>>1==-4",
        "1<<40",
        "~0==-1",
        "!0",
        "-1>0u",
        "0xFFFFFFFFFFFFFFFF == -1",
        "1?2:0",
        "0?0:3",
        "1||1/0",
        "!(0&&1/0)",
        "1?1:1/0",
        "'a'==97",
        "'\\377'<0",
        "unknown==0",
        "defined __TINYC__ && defined(__TINYC__)",
        "!defined(nothing)",
        "3&1|4^1",
        "2>1",
        "1>=1",
        "1<=1",
        "1!=2",
        "- - 1",
        "010==8",
        "0b11==3",
        "(1,2)==2",
        "10u%3u==1",
        "L'a'==97",
        "-9223372036854775807-1 == (-9223372036854775807-1)/-1",
    ] {
        holds(expression);
    }
    check("#define A 1\n#define B(x) x\n#if A && B(1) && defined A\ny\n#endif", "y");
    let fails =
        |expression: &str, message: &str| said(format!("#if {expression}\n1\n#endif"), "", &[message]);
    fails("", "1:1: error: expression missing after the directive");
    fails("1/0", "1:6: error: division by zero in `#if` expression");
    fails("1 2", "1:7: error: unexpected `2` in `#if` expression");
    fails("sizeof(int)", "1:11: error: unexpected `(` in `#if` expression");
    fails("\"a\"", "1:5: error: `\"a\"` is not allowed in an `#if` expression");
    fails("1.0", "1:5: error: floating constant in an `#if` expression");
    fails("(1", "1:6: error: expected `)` in `#if` expression");
    fails("1+", "1:6: error: `#if` expression ends too early");
    fails("defined", "1:5: error: expected a name after `defined`");
    fails("08", "1:5: error: invalid digit `8` in octal constant");
}

#[test]
fn other_directives() {
    check("#\n # \na", "a");
    check("#pragma TI_COMPILER\n#pragma once\na", "a");
    said("#pragma pack(1) don't\na", "a", &["1:1: note: `#pragma pack(1) don't` is ignored"]);
    said("#error don't \"x\na", "a", &["1:1: error: #error don't \"x"]);
    said("#warning it's old\na", "a", &["1:1: warning: #warning it's old"]);
    said("#import \"x\"\na", "a", &["1:2: error: unknown preprocessing directive `#import`"]);
    said("#foo\na", "a", &["1:2: error: unknown preprocessing directive `#foo`"]);
    check("a # b", "a # b");
    check("#define E\nE # define x\nx", "# define x\nx");
    check("#define f(x) x\nf(1\n#define A 2\nA)", "1 2");
    check("#if 0\n#foo\n#endif", "");
}

/// A message with the name of a file in this system's notation.
fn with_native_path(message: &str) -> String {
    let parts =
        message.split_once(" is `").and_then(|(start, rest)| Some((start, rest.strip_suffix("` on disk")?)));
    parts.map_or_else(
        || message.to_owned(),
        |(start, path)| format!("{start} is `{}` on disk", path.replace('/', std::path::MAIN_SEPARATOR_STR)),
    )
}

#[test]
fn includes() {
    let check = |line: &str, expect: &str, said: &[&str]| {
        let files = MemoryFiles::new()
            .with("src/main.c", format!("{line}\nend"))
            .with("src/a.h", "a1")
            .with("inc/a.h", "a2")
            .with("inc/b.h", "b")
            .with("inc/ModbusMaster.h", "m")
            .with("inc/sub/c.h", "#include \"d.h\"")
            .with("inc/sub/d.h", "d")
            .with("inc/x.h", "x1")
            .with("inc/X.h", "x2")
            .with("twice.h", "#ifndef T\n#define T\nt\n#endif\n")
            .with("other/e.c", "e");
        let (text, found) = run(&files, "src/main.c", &options());
        let said: Vec<_> = said.iter().map(|message| with_native_path(message)).collect();
        assert_eq!(found, said, "{line}");
        assert_eq!(text.replace('\n', " ").trim(), format!("{expect} end").trim(), "{line}");
    };
    check("#include \"a.h\"", "a1", &[]);
    check("#include <a.h>", "a2", &[]);
    check("#include \"b.h\" // note", "b", &[]);
    check("#include \"b.h\";", "b", &[]);
    check("#include \"sub\\c.h\"", "d", &[]);
    check("#include \"..\\other\\e.c\"", "e", &[]);
    check("#include \"/b.h\"", "b", &[]);
    check("#include \"..\\INC\\b.h\"", "b", &["1:10: note: `..\\inc\\b.h` is `src/../inc/b.h` on disk"]);
    check(
        "#include \"ModBusMaster.h\"",
        "m",
        &["1:10: note: `modbusmaster.h` is `inc/modbusmaster.h` on disk"],
    );
    check("#include \"x.h\"", "x1", &[]);
    check("#include \"inc/X.H\"", "", &["1:10: error: `inc/x.h` matches several files"]);
    check("#include \"b.h  ", "b", &["1:10: warning: missing `\"` after the file name"]);
    check("#define H \"b.h\"\n#include H", "b", &[]);
    check("#define H <b.h>\n#include H", "b", &[]);
    check("#include \"b.h\"\n#include \"b.h\"", "b b", &[]);
    check("#include \"twice.h\"\n#include \"twice.h\"", "t", &[]);
    check("#include \"KMotionDef.h\"\n#include <kmotiondef.h>", "int km;", &[]);
    check("#include \"/include/KMotionDef.h\"", "int km;", &[]);
    check("#include <iso646.h>\n#include \"MEMORY.H\"", "", &[]);
    check("#include <stdbool.h>\ntrue", "1", &[]);
    check("#include \"ab.h\"", "", &["1:10: error: file `ab.h` not found"]);
    check("#include x", "", &["1:10: error: expected a file name after `#include`"]);
    check("#include", "", &["1:1: error: file name missing"]);
}

#[test]
fn exceeding_a_limit_gives_one_message() {
    let check = |files: &MemoryFiles, message: &str| {
        let (_, said) = run(files, "main.c", &options());
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(said[0].contains(message), "{said:?}");
    };
    let one = |text: String| MemoryFiles::new().with("main.c", text);
    check(&one("#include \"main.c\"\n#include \"main.c\"\n".to_owned()), "files included deeper than 64");
    let bomb: String = (0..40).map(|n| format!("#define x{} x{n} x{n}\n", n + 1)).collect();
    check(&one(format!("{bomb}x40")), "macros expand to more than 2000000 tokens");
    let bomb: String = (0..40).map(|n| format!("#define x{}(a) x{n}(a a)\n", n + 1)).collect();
    check(&one(format!("{bomb}x40(1)")), "macros expand to more than 2000000 tokens");
    let calls = format!("#define f(x) x\n{}1{}", "f(".repeat(5000), ")".repeat(5000));
    check(&one(calls), "macro calls nested deeper than 640");
    check(&one(format!("#if {}1\n#endif", "(".repeat(5000))), "nested deeper than 640");
    let (_, said) = run(&one("#foo\n".repeat(100)), "main.c", &options());
    assert_eq!(
        (said.len(), said.last().unwrap().as_str()),
        (21, ": error: more than 20 errors; the rest of the program was not checked")
    );
    let paste: String = (0..40).map(|n| format!("#define p{}(a) p{n}(a##a)\n", n + 1)).collect();
    check(&one(format!("#define p0(a) a\n{paste}p40(x)")), "a token longer than 1048576 bytes");
}
