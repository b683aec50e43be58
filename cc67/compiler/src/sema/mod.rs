//! Semantic analysis: from the syntax tree to the typed tree.
//!
//! There are two passes. The first binds every file-scope declaration and the type of every function definition, in
//! order; the second analyses the bodies. So a call can use the type of a function that is defined later, on which
//! programs for this board rely (`dialect.md` 2.3), while names still become visible only where they are declared.
//!
//! Analysis continues after an error. A diagnosed expression yields `None`, and expressions derived from it are not
//! reported, so each mistake is reported once.
//!
//! This module depends on the target only through the sizes in [`crate::ty::layout`] and the arithmetic of `vm::arith`.

mod advice;
mod alignment;
mod assignments;
mod body;
mod builtins;
mod calls;
pub(crate) mod constants;
mod conversions;
mod declarations;
mod declarators;
mod designators;
mod enums;
mod expressions;
mod functions;
mod initializers;
mod literals;
mod locals;
mod operands;
mod operators;
mod places;
pub mod print;
mod records;
mod scope;
mod specifiers;
mod statements;
mod statics;
mod switches;
mod symbols;
#[cfg(test)]
mod tests;
mod undeclared;

pub use initializers::MAX_VALUES;

use std::collections::{BTreeMap, BTreeSet};

use crate::ast;
use crate::diag::{Diagnostic, Sink, TOO_MANY_ERRORS};
use crate::firmware::FirmwareNames;
use crate::names::{Name, Names};
use crate::pp::Standard;
use crate::source::{SourceMap, Span};
use crate::ty::{RecordId, TypeId, Types};
use crate::typed::{Definition, Linkage, Unit};
use crate::words::foreign::Origin;

use body::Body;
use functions::PendingDefinition;
use scope::Scopes;
use symbols::Symbols;

/// Checks a translation unit and builds its typed tree.
///
/// The result is complete even after errors, but it can only be lowered if `sink` has none.
pub fn analyze(
    unit: &ast::TranslationUnit,
    names: &mut Names,
    sources: &SourceMap,
    firmware: &dyn FirmwareNames,
    sink: &mut Sink,
) -> Unit {
    analyze_as(Standard::default(), unit, names, sources, firmware, sink)
}

/// Analyses a program that is written to a given standard of C.
pub fn analyze_as(
    standard: Standard,
    unit: &ast::TranslationUnit,
    names: &mut Names,
    sources: &SourceMap,
    firmware: &dyn FirmwareNames,
    sink: &mut Sink,
) -> Unit {
    let persist = names.intern("persist");
    let mut sema = Sema {
        names,
        sources,
        firmware,
        sink,
        types: Types::new(),
        symbols: Symbols::default(),
        scopes: Scopes::new(),
        body: Body::new(String::new(), Types::VOID),
        persist,
        standard,
        unevaluated: 0,
        noted: MessageFacts::default(),
    };
    let pending = sema.declare_items(unit);
    let functions: Vec<_> = pending.into_iter().filter_map(|pending| sema.define_function(pending)).collect();
    sema.finish_symbols();
    Unit { types: sema.types, symbols: sema.symbols.finish(), functions, divisions: None }
}

/// The state of an analysis.
struct Sema<'a> {
    names: &'a Names,
    sources: &'a SourceMap,
    firmware: &'a dyn FirmwareNames,
    sink: &'a mut Sink,
    types: Types,
    symbols: Symbols,
    scopes: Scopes,
    /// The function being built; between functions, a scratch body for constant expressions.
    body: Body,
    /// The name of the memory that threads and the PC share.
    persist: Name,
    /// The C standard of the program.
    standard: Standard,
    /// Depth of operands that are not evaluated, only analysed for their type.
    unevaluated: u32,
    noted: MessageFacts,
}

/// Facts noted for later messages.
#[derive(Debug, Default)]
struct MessageFacts {
    /// Structures with a wrong definition, for whose members no messages are reported.
    broken: BTreeSet<RecordId>,
    /// The declarations of enumerations without negative constants, and of their typedefs.
    unsigned_enums: BTreeSet<Span>,
    /// The origins of words that other languages have and C does not.
    origins: BTreeSet<Origin>,
    /// Variables of functions: the function, and where it declares them.
    locals_elsewhere: BTreeMap<Name, (String, Span)>,
}

impl Sema<'_> {
    /// The first pass.
    fn declare_items<'t>(&mut self, unit: &'t ast::TranslationUnit) -> Vec<PendingDefinition<'t>> {
        let mut pending = Vec::new();
        for (index, item) in unit.items.iter().enumerate() {
            self.scopes.at_item(index);
            match item {
                ast::Item::Function(definition) => pending.extend(self.declare_definition(definition, index)),
                ast::Item::Declaration(declaration) => self.file_declaration(declaration),
                ast::Item::StaticAssert(assertion) => self.static_assert(assertion),
            }
        }
        pending
    }

    /// Reports symbols that are still incomplete at the end of the unit.
    fn finish_symbols(&mut self) {
        let mut open = Vec::new();
        for (id, symbol) in self.symbols.iter() {
            match symbol.definition {
                Definition::None if symbol.linkage == Linkage::Internal && symbol.used_at.is_some() => {
                    let message = format!("`{}` is declared `static` and used, but not defined", symbol.name);
                    open.push(Err(Diagnostic::error(symbol.span, message).at("declared here")));
                }
                Definition::Tentative if self.types.size_of(symbol.ty).is_none() => {
                    match self.types.array(symbol.ty).filter(|(element, _)| self.types.is_object(element.ty))
                    {
                        // `int a[];` at file scope is one element (C90 6.7.2).
                        Some((element, _)) => open.push(Ok((id, element))),
                        None => {
                            let spelled = self.types.spell(self.names, symbol.ty);
                            let message = format!("`{}` has the incomplete type `{spelled}`", symbol.name);
                            open.push(Err(Diagnostic::error(symbol.span, message)));
                        }
                    }
                }
                _ => {}
            }
        }
        for finding in open {
            match finding {
                Ok((id, element)) => {
                    let ty = self.types.intern(crate::ty::Type::Array(element, Some(1)));
                    self.symbols.get_mut(id).ty = ty;
                }
                Err(diagnostic) => self.report(diagnostic),
            }
        }
    }

    /// Reports a diagnostic, unless there are too many.
    fn report(&mut self, diagnostic: Diagnostic) {
        if self.sink.is_full() {
            return;
        }
        self.sink.report(diagnostic);
        if self.sink.is_full() {
            self.sink.report(Diagnostic::global_error(TOO_MANY_ERRORS));
        }
    }

    /// Reports the finding of a lint, if there is one.
    fn report_finding(&mut self, finding: Option<Diagnostic>) {
        self.sink.report_if(finding);
    }

    /// A type as C spells it.
    fn spell(&self, ty: TypeId) -> String {
        self.types.spell(self.names, ty)
    }

    /// The spelling of a name.
    fn spelling(&self, name: Name) -> &str {
        self.names.get(name)
    }
}
