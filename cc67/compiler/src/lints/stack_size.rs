//! Frames and call chains beyond the board's small stack.
//!
//! A thread has 2048 bytes, of which about 1.9 KiB are usable. There is no guard after them: the next thread's stack
//! begins there. The frame is that of the vendor's compiler (`dialect.md` section 7): all locals, aligned to 8 bytes, 8
//! bytes for each parameter, and 16 more.

use std::collections::BTreeMap;

use super::call_graph::CallGraph;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Function, Local, SymbolId};

/// The size above which a single frame is reported.
const FRAME_LIMIT: u32 = 1024;

/// A call chain from `main` larger than this is reported: 1.9 KiB.
const CHAIN_LIMIT: u32 = 1945;

/// Reports large frames, and the deepest chain of calls if it is too deep.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let bytes = frame(program, function);
        if bytes > FRAME_LIMIT {
            sink.report(large_frame(program, function, bytes));
        }
    }
    let graph = CallGraph::new(program);
    let Some(main) = program.symbol("main").filter(|main| graph.function(*main).is_some()) else { return };
    let mut depths = Depths { program, graph: &graph, known: BTreeMap::new() };
    if depths.below(main) > CHAIN_LIMIT {
        sink.report_if(deep_chain(&depths, main));
    }
}

/// The bytes that the vendor's compiler takes for a call of the function.
fn frame(program: &AnalysedProgram<'_>, function: &Function) -> u32 {
    const FIXED: u32 = 16;
    const PARAMETER: u32 = 8;
    let types = &program.unit.types;
    let locals = variables(function).fold(0_u32, |end, local| {
        let start = end.checked_next_multiple_of(types.align_of(local.ty)).unwrap_or(u32::MAX);
        start.saturating_add(types.size_of(local.ty).unwrap_or(0))
    });
    let parameters = u32::try_from(function.parameters.len()).unwrap_or(u32::MAX).saturating_mul(PARAMETER);
    locals.checked_next_multiple_of(8).unwrap_or(u32::MAX).saturating_add(parameters).saturating_add(FIXED)
}

/// The locals that the program declares, parameters left out.
fn variables(function: &Function) -> impl Iterator<Item = &Local> {
    function
        .locals
        .iter()
        .filter(|(id, local)| !local.name.is_empty() && !function.parameters.contains(id))
        .map(|(_, local)| local)
}

fn large_frame(program: &AnalysedProgram<'_>, function: &Function, bytes: u32) -> Diagnostic {
    let name = program.name(function.symbol);
    let message = format!("`{name}` needs {bytes} bytes of the board's stack, which has 2048");
    let diagnostic = Diagnostic::warning(Lint::StackSize, function.span, message)
        .note("nothing guards the end of the stack: an overflow overwrites the next thread's stack")
        .help("make large arrays `static`, or declare them outside the function");
    let size = |local: &Local| program.unit.types.size_of(local.ty).unwrap_or(0);
    match variables(function).max_by_key(|local| size(local)) {
        Some(largest) => diagnostic.label(largest.span, format!("{} bytes", size(largest))),
        None => diagnostic,
    }
}

/// The stack that functions need together with their callees.
struct Depths<'a> {
    program: &'a AnalysedProgram<'a>,
    graph: &'a CallGraph<'a>,
    /// The functions visited; `None` while a function is analysed, so that a recursive one counts once.
    known: BTreeMap<SymbolId, Option<Depth>>,
}

/// The stack that a function needs.
#[derive(Clone, Copy)]
struct Depth {
    /// Its frame and those of its callees.
    bytes: u32,
    /// The call that leads deepest.
    next: Option<(SymbolId, Span)>,
}

impl Depths<'_> {
    fn below(&mut self, symbol: SymbolId) -> u32 {
        if let Some(known) = self.known.get(&symbol) {
            return known.map_or(0, |depth| depth.bytes);
        }
        self.known.insert(symbol, None);
        let (mut deepest, mut next) = (0, None);
        for (callee, span) in self.graph.callees(symbol).iter().copied() {
            let bytes = self.below(callee);
            if bytes > deepest {
                (deepest, next) = (bytes, Some((callee, span)));
            }
        }
        let own = self.graph.function(symbol).map_or(0, |function| frame(self.program, function));
        let bytes = own.saturating_add(deepest);
        self.known.insert(symbol, Some(Depth { bytes, next }));
        bytes
    }
}

/// The finding about the chain that begins at `main`; `None` if it consists of `main` alone.
fn deep_chain(depths: &Depths<'_>, main: SymbolId) -> Option<Diagnostic> {
    let program = depths.program;
    let (mut symbol, mut chain, mut first_call) = (main, Vec::new(), None);
    let total = depths.known.get(&main).copied().flatten()?.bytes;
    while let Some(function) = depths.graph.function(symbol) {
        chain.push(format!("{} {}", program.name(symbol), frame(program, function)));
        let depth = depths.known.get(&symbol).copied().flatten();
        let Some((callee, span)) = depth.and_then(|depth| depth.next) else { break };
        first_call.get_or_insert(span);
        symbol = callee;
    }
    let message = format!("the calls from `main` need {total} bytes of the board's stack, which has 2048");
    Some(
        Diagnostic::warning(Lint::StackSize, first_call?, message)
            .at("the deepest chain begins here")
            .note(format!("bytes: {}", chain.join(" → ")))
            .note("nothing guards the end of the stack: an overflow overwrites the next thread's stack")
            .help("make large arrays `static`, or declare them outside the functions"),
    )
}
