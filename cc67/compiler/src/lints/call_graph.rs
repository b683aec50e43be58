//! The calls between the functions of a unit, for lints about call chains.
//!
//! Calls through pointers are not followed, nor are functions that the unit does not define.

use std::collections::{BTreeMap, BTreeSet};

use super::program::AnalysedProgram;
use crate::source::Span;
use crate::typed::{Callee, Function, SymbolId};

/// The functions of a unit and their calls.
pub(super) struct CallGraph<'a> {
    functions: BTreeMap<SymbolId, &'a Function>,
    calls: BTreeMap<SymbolId, Vec<(SymbolId, Span)>>,
}

impl<'a> CallGraph<'a> {
    pub(super) fn new(program: &AnalysedProgram<'a>) -> Self {
        let functions: BTreeMap<_, _> =
            program.functions().map(|function| (function.symbol, function)).collect();
        let calls =
            functions.iter().map(|(symbol, function)| (*symbol, calls(&functions, function))).collect();
        Self { functions, calls }
    }

    /// A function that the unit defines.
    pub(super) fn function(&self, symbol: SymbolId) -> Option<&'a Function> {
        self.functions.get(&symbol).copied()
    }

    /// The functions of the unit that a function calls, each with the place of its first call.
    pub(super) fn callees(&self, symbol: SymbolId) -> &[(SymbolId, Span)] {
        self.calls.get(&symbol).map_or(&[], Vec::as_slice)
    }

    /// Every function reachable from `root`, each with its first caller; `root` has none.
    pub(super) fn reached_from(&self, root: SymbolId) -> BTreeMap<SymbolId, Option<SymbolId>> {
        let mut reached = BTreeMap::from([(root, None)]);
        let mut open = vec![root];
        while let Some(caller) = open.pop() {
            for (callee, _) in self.callees(caller) {
                reached.entry(*callee).or_insert_with(|| {
                    open.push(*callee);
                    Some(caller)
                });
            }
        }
        reached
    }
}

fn calls(functions: &BTreeMap<SymbolId, &Function>, function: &Function) -> Vec<(SymbolId, Span)> {
    let mut seen = BTreeSet::new();
    let called = function.calls().filter_map(|(expr, call)| match call.callee {
        Callee::Symbol(callee) => Some((callee, expr.span)),
        Callee::Pointer(_) => None,
    });
    called.filter(|(callee, _)| functions.contains_key(callee) && seen.insert(*callee)).collect()
}
