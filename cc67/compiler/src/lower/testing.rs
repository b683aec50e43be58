//! Helpers for the tests of the back ends: C source to a typed unit and to IR.

use kmotiondef::timing::Timing;

use crate::diag::Sink;
use crate::firmware::BuiltIn;
use crate::ir::function::{Function, Signatures};
use crate::ir::{text, verify};
use crate::lower::{Definitions, lower};
use crate::names::Names;
use crate::passes::{self, Level};
use crate::source::SourceMap;
use crate::typed::Unit;
use crate::{parse, pp, sema};

/// A unit without errors, and its sources.
pub(crate) fn unit(source: &str) -> (Unit, SourceMap) {
    let (mut sources, mut names, mut sink) = (SourceMap::new(), Names::new(), Sink::new());
    let main = sources.add_file("test.c", None, source.as_bytes().to_vec(), None);
    let files = pp::MemoryFiles::default();
    let tokens = pp::preprocess(main, &pp::Options::default(), &files, &mut sources, &mut names, &mut sink);
    let tree = parse::parse(&tokens, &sources, &names, &mut sink);
    let unit = sema::analyze(&tree, &mut names, &sources, &BuiltIn, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.diagnostics());
    (unit, sources)
}

/// The functions of a unit at an optimisation level, verified.
pub(crate) fn functions(unit: &Unit, level: Level) -> (Vec<Function>, Signatures) {
    let mut signatures = Signatures::default();
    let definitions = Definitions::new(unit, &mut signatures);
    let mut lowered = Vec::new();
    for function in &unit.functions {
        let mut function = lower(unit, function, &definitions, Timing::Fast, &mut signatures);
        assert_eq!(verify::verify(&function, &signatures), Ok(()));
        passes::run(&mut function, level);
        assert_eq!(verify::verify(&function, &signatures), Ok(()));
        lowered.push(function);
    }
    (lowered, signatures)
}

/// The text of all functions of a source.
pub(crate) fn ir(source: &str, level: Level) -> String {
    let (unit, _) = unit(source);
    let (functions, signatures) = functions(&unit, level);
    functions.iter().map(|function| text::print(function, &signatures, &unit.symbols)).collect()
}

/// Compares the text of a source's functions, without the indentation of `expected`.
pub(crate) fn check_ir(source: &str, level: Level, expected: &str) {
    let trim = |text: &str| {
        text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
    };
    let found = ir(source, level);
    assert_eq!(trim(&found), trim(expected), "\n{source}\n{found}");
}
