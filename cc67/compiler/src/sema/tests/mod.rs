//! Properties of semantic analysis, as pairs of C text and typed tree, or C text and messages.

mod calls;
mod declarations;
mod expressions;
mod initializers;
mod layout;
mod lints;
mod names;
mod statements;

use kmotiondef::CType;

use super::{analyze, print};
use crate::diag::{Lint, Preset, Severity, Sink};
use crate::firmware::{FirmwareNames, Prototype};
use crate::lints::{LintContext, check as run_lints};
use crate::names::Names;
use crate::parse::parse;
use crate::pp::{MemoryFiles, Options, preprocess};
use crate::source::SourceMap;
use crate::typed::Unit;

/// A board with a few names.
struct Board;

impl FirmwareNames for Board {
    fn prototype(&self, name: &str) -> Option<Prototype> {
        let (result, parameters, is_variadic) = match name {
            "ReadBit" => (CType::Int, vec![CType::Int], false),
            "Delay_sec" => (CType::Void, vec![CType::Double], false),
            "sqrt" => (CType::Double, vec![CType::Double], false),
            "printf" => (CType::Int, vec![CType::Pointer(&CType::Const(&CType::Char))], true),
            _ => return None,
        };
        Some(Prototype { result, parameters, is_variadic })
    }

    fn is_variable(&self, name: &str) -> bool {
        name == "persist"
    }

    fn is_type(&self, name: &str) -> bool {
        name == "CHAN"
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        Box::new(["ReadBit", "Delay_sec", "sqrt", "printf", "persist"].into_iter())
    }
}

/// The typed tree of a program and the messages about it.
fn run(source: &str) -> (String, Vec<String>) {
    let (unit, names, said) = analyzed(source);
    (print::unit(&unit, &names), said)
}

fn analyzed(source: &str) -> (Unit, Names, Vec<String>) {
    let (mut sources, mut names, mut sink) = (SourceMap::new(), Names::new(), Sink::new());
    let files = MemoryFiles::new();
    let main = sources.add_file("main.c", None, source.as_bytes().to_vec(), None);
    let tokens = preprocess(main, &Options::default(), &files, &mut sources, &mut names, &mut sink);
    let tree = parse(&tokens, &sources, &names, &mut sink);
    let unit = analyze(&tree, &mut names, &sources, &Board, &mut sink);
    let context = LintContext { firmware: &Board, float_elements: &[] };
    run_lints(&unit, &names, &sources, context, &mut sink);
    let is_shown = |lint: Lint| lint.preset() == Preset::On;
    let shown = sink.diagnostics().iter().filter(|diagnostic| diagnostic.lint.is_none_or(is_shown));
    let said = shown.map(|diagnostic| {
        let line = diagnostic.span.and_then(|span| sources.place(span)).map_or(0, |place| place.line);
        let kind = match (diagnostic.severity, diagnostic.lint) {
            (Severity::Error, _) => "error".to_owned(),
            (_, lint) => lint.map_or_else(|| "note".to_owned(), |lint| lint.name().to_owned()),
        };
        let help = diagnostic.help.as_ref().map_or_else(String::new, |help| format!(" ({help})"));
        format!("{line}: {kind}: {}{help}", diagnostic.message)
    });
    let said = said.collect();
    (unit, names, said)
}

/// A program that is accepted silently, and its typed tree.
fn check(source: &str, expect: &str) {
    let (tree, said) = run(source);
    assert_eq!(said, [""; 0], "said about:\n{source}");
    let trim = |text: &str| {
        text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(trim(&tree), trim(expect), "tree of:\n{source}");
}

/// A program that is accepted silently.
fn accept(source: &str) {
    let (_, said) = run(source);
    assert_eq!(said, [""; 0], "said about:\n{source}");
}

/// The messages about a program.
fn said(source: &str, expect: &[&str]) {
    let (_, said) = run(source);
    assert_eq!(said, expect, "said about:\n{source}");
}

/// Checks the typed tree of an expression in a function with some variables.
fn expression(source: &str, expect: &str) {
    let program = format!(
        "struct S {{ int a; double b; struct {{ short c[3]; }}; int f : 3; unsigned u : 5; }};\n\
         int gi, ga[10]; double gd; struct S gs, *gp;\n\
         void test(int i, unsigned u, char c, float f, double d, int *p, char *s, long long l, double *q)\n\
         {{ {source}; }}"
    );
    let (tree, mut said) = run(&program);
    // A store to a parameter is the whole body of the function.
    said.retain(|message| !message.contains("parameter-copy"));
    assert_eq!(said, [""; 0], "said about:\n{source}");
    let body =
        tree.split_once("test(").and_then(|(_, rest)| rest.split_once("{\n")).map_or("", |(_, body)| body);
    let body = body.trim_end().trim_end_matches('}').trim().trim_end_matches(';');
    assert_eq!(body, expect, "tree of: {source}");
}
