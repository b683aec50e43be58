//! Nested constructs, deeper than any real program.

use super::{Input, in_main};

/// The depth of nesting.
const DEPTH: usize = 10_000;

/// Repeats `open`, then adds `middle`, then as many times `close`.
fn nest(open: &str, middle: &str, close: &str) -> String {
    format!("{}{middle}{}", open.repeat(DEPTH), close.repeat(DEPTH))
}

/// Constructs within a function: name, opening, middle, closing, and the limit that is exceeded.
const WITHIN: &[(&str, &str, &str, &str, Option<&str>)] = &[
    ("parentheses", "a = ", "(", "1", Some("640")),
    ("negations", "a = ", "!", "1", Some("640")),
    ("minus signs", "a = ", "- ", "1", Some("640")),
    ("complements", "a = ", "~", "1", Some("640")),
    ("increments", "", "++ ", "a", Some("640")),
    ("dereferences", "a = ", "*", "p", Some("640")),
    ("addresses", "a = ", "& ", "p", Some("640")),
    ("casts", "a = ", "(int)", "1", Some("640")),
    ("sizeof", "a = ", "sizeof ", "a", Some("640")),
    ("assignments", "", "a = ", "1", Some("640")),
    ("left conditionals", "a = ", "a ? ", "1", Some("640")),
    ("right conditionals", "a = ", "a ? 1 : ", "1", Some("640")),
    ("calls", "a = ", "ReadBit(", "1", Some("640")),
    ("indexes", "a = ", "p[", "1", Some("640")),
    ("blocks", "", "{", "", Some("640")),
    ("if", "", "if (a) ", "b = 1;", Some("640")),
    ("if with blocks", "", "if (a) { ", "b = 1;", Some("640")),
    ("else if", "", "if (a) b = 1; else ", "b = 2;", Some("640")),
    ("while", "", "while (a) ", "b = 1;", Some("640")),
    ("for", "", "for (;a;) ", "b = 1;", Some("640")),
    ("do", "", "do ", "b = 1;", Some("640")),
    ("switch", "", "switch (a) ", "case 1: ;", Some("640")),
    ("labels", "", "x: ", ";", Some("640")),
    ("cases", "switch (a) { ", "case 1: ", ";", Some("640")),
    ("statement expressions", "a = ", "({ ", "1;", Some("640")),
    ("compound literals", "p = ", "(int[]){", "1", Some("640")),
    ("brackets that close nothing", "a = ", ")", ";", None),
    ("braces that close nothing", "", "}", "", None),
    ("else without if", "", "else ", ";", None),
    ("opening quotes of other languages", "a = ", "«", ";", None),
];

/// Constructs at file scope: name, text before, opening, middle, closing, text after.
const OUTSIDE: &[(&str, &str, &str, &str, &str, &str)] = &[
    ("declarators", "int ", "(", "x", ")", ";\nmain() { }\n"),
    ("pointers", "int ", "*", "x", "", ";\nmain() { }\n"),
    ("arrays", "int x", "[1]", "", "", ";\nmain() { }\n"),
    ("functions that return functions", "int x", "()", "", "", ";\nmain() { }\n"),
    ("pointers to functions", "int ", "(*", "x", ")()", ";\nmain() { }\n"),
    ("parameters", "int f", "(int g", "(void)", ")", ";\nmain() { }\n"),
    ("initialisers", "int x[] = ", "{", "1", "}", ";\nmain() { }\n"),
    ("designators", "int x[2] = { ", "[0]", " = 1", "", "};\nmain() { }\n"),
    ("structures", "", "struct {", "int x;", "} y;", "\nmain() { }\n"),
    ("unions", "", "union {", "int x;", "};", "\nmain() { }\n"),
    ("enumerations", "enum { x = ", "sizeof(enum { y = ", "1", "})", "};\nmain() { }\n"),
    ("typeof", "", "typeof(", "int", ")", " x;\nmain() { }\n"),
    ("attributes", "int x __attribute__(", "(", "packed", ")", ");\nmain() { }\n"),
    ("#if", "", "#if 1\n", "", "#endif\n", "main() { }\n"),
    ("#if in skipped text", "#if 0\n", "#if 1\n", "", "#endif\n", "#endif\nmain() { }\n"),
    ("#ifdef without end", "", "#ifdef X\n", "", "", "main() { }\n"),
    ("parentheses of #if", "#if ", "(", "1", ")", "\nmain() { }\n#endif\n"),
    ("operators of #if", "#if ", "!", "1", "", "\n#endif\nmain() { }\n"),
    ("conditionals of #if", "#if ", "1 ? ", "1", " : 0", "\n#endif\nmain() { }\n"),
    ("defined", "#if ", "defined ", "x", "", "\n#endif\nmain() { }\n"),
    ("macro calls", "#define F(x) x\nint x = ", "F(", "1", ")", ";\nmain() { }\n"),
    ("macro calls without end", "#define F(x) x\nint x = ", "F(", "1", "", ";\nmain() { }\n"),
    ("arguments without parentheses", "#define F(x) F\nint x = F", "(1)", "", "", ";\nmain() { }\n"),
    ("static assertions", "_Static_assert(", "(", "1", ")", ", \"\");\nmain() { }\n"),
    ("old-style parameters", "f(", "a,", "b", "", ") { }\nmain() { }\n"),
];

/// All nested inputs.
pub(super) fn inputs() -> Vec<Input> {
    let within = WITHIN.iter().flat_map(|(name, before, open, middle, says)| {
        let closing = match open.trim_end().chars().last() {
            Some('(') => ")",
            Some('[') => "]",
            Some('{') if name.contains("expressions") => "})",
            Some('{') => "}",
            _ => "",
        };
        let closed = in_main(format!("{before}{};", nest(open, middle, closing)));
        let open = in_main(format!("{before}{}", nest(open, middle, "")));
        [(closed, "closed", *says), (open, "left open", None)]
            .map(|(text, how, says)| Input { says, ..Input::new(format!("nested {name}, {how}"), text) })
    });
    let outside = OUTSIDE.iter().map(|(name, before, open, middle, close, behind)| {
        Input::new(format!("nested {name}"), format!("{before}{}{behind}", nest(open, middle, close)))
    });
    within.chain(outside).collect()
}
