//! Builds the object of a unit: symbols, data, and functions as they are generated.
//!
//! The builder takes symbols and data from the typed tree at once; functions are added one by one.

use super::{
    DataRelocation, Definition, Initialized, Line, Object, ObjectFunction, SourceLine, Symbol, SymbolKind,
};
use crate::bytecode::text::FunctionText;
use crate::bytecode::{GeneratedFunction, Text};
use crate::c67x::text::MachineText;
use crate::c67x::{Externs, externs};
use crate::ir::function::Signatures;
use crate::ir::inst::SignatureId;
use crate::relocation::{Relocation, RelocationKind};
use crate::source::{Place, SourceMap, Span};
use crate::ty::{ParameterTypes, Type, TypeId, Types};
use crate::typed::{self, Linkage, SymbolId, Unit};

/// The properties of a function other than its words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FunctionFacts {
    /// Its symbol.
    pub(crate) symbol: SymbolId,
    /// Its signature.
    pub(crate) signature: SignatureId,
    /// Its closing brace.
    pub(crate) end: Span,
}

/// An object while functions are added to it.
#[derive(Debug)]
pub(crate) struct UnitBuilder<'a> {
    unit: &'a Unit,
    sources: &'a SourceMap,
    object: Object,
}

impl<'a> UnitBuilder<'a> {
    /// The object of a unit without its functions.
    pub(crate) fn new(unit: &'a Unit, sources: &'a SourceMap) -> Self {
        let files = sources.files().map(|(_, file)| file.name.clone()).collect();
        let mut builder = Self { unit, sources, object: Object { files, ..Object::default() } };
        builder.symbols();
        builder.data();
        builder
    }

    /// The signatures of functions and calls, to which lowering adds.
    pub(crate) fn signatures(&mut self) -> &mut Signatures {
        &mut self.object.signatures
    }

    /// The name of a symbol.
    pub(crate) fn name(&self, symbol: SymbolId) -> &str {
        &self.object.symbols[symbol].name
    }

    /// Adds a function that was generated.
    pub(crate) fn function(&mut self, about: FunctionFacts, generated: GeneratedFunction) {
        let GeneratedFunction { text: added, frame, variables, inlined, exceeded } = generated;
        let file = self.object.symbols[about.symbol].place.file;
        let end = self.place(about.end);
        let exceeded = exceeded.into_iter().map(|span| self.place(span)).collect();
        let (relocations, lines) = (self.object.relocations.len() as u32, self.object.lines.len() as u32);
        self.object.relocations.extend(added.relocations);
        self.lines(file, &added.spans);
        let object = &mut self.object;
        object.symbols[about.symbol].definition = Definition::Function(object.functions.len() as u32);
        object.functions.push(ObjectFunction {
            symbol: about.symbol,
            signature: about.signature,
            words: added.words,
            relocations: relocations..object.relocations.len() as u32,
            lines: lines..object.lines.len() as u32,
            frame,
            end,
            variables,
            inlined,
            exceeded,
        });
    }

    /// The symbols as far as code cares, in their order.
    pub(crate) fn externs(&self) -> Externs {
        let mut externs = Externs::default();
        for (id, symbol) in &self.object.symbols {
            let ty = self.unit.symbols.get(id).map(|symbol| symbol.ty);
            let is_variadic = ty.is_some_and(|ty| match self.unit.types.get(ty) {
                Type::Function(function) => {
                    matches!(function.parameters, ParameterTypes::Prototype { is_variadic: true, .. })
                }
                _ => false,
            });
            let is_external = symbol.linkage == Linkage::External;
            let is_defined = (self.unit.symbols.get(id))
                .is_some_and(|symbol| !matches!(symbol.definition, typed::Definition::None));
            let about = externs::SymbolFacts { align: symbol.align, is_variadic, is_external, is_defined };
            externs.push(&symbol.name, about);
        }
        externs
    }

    /// Adds a function of the controller's code.
    pub(crate) fn add_machine_function(&mut self, about: FunctionFacts, words: MachineText) {
        let MachineText { words, fixups, spans, frame, exceeded } = words;
        let start = words.start;
        let relocations = fixups.into_iter().map(|fixup| Relocation {
            word: start + fixup.word,
            kind: RelocationKind::Processor(fixup.kind),
            symbol: fixup.symbol.unwrap_or(about.symbol),
        });
        let added = FunctionText { words, relocations: relocations.collect(), spans };
        let generated =
            GeneratedFunction { text: added, frame, variables: Vec::new(), inlined: Vec::new(), exceeded };
        self.function(about, generated);
    }

    /// The object with the processor's code of its functions, and the further names that the code needs.
    pub(crate) fn finish_code(mut self, code: Vec<u32>, added: Vec<&'static str>) -> Object {
        for name in added {
            self.object.symbols.push(Symbol {
                name: name.to_owned(),
                linkage: Linkage::External,
                definition: Definition::None,
                kind: SymbolKind::Function,
                size: 0,
                align: 1,
                span: None,
                place: SourceLine::default(),
                used_at: None,
            });
        }
        self.object.code = Some(code);
        self.object
    }

    /// The object with the words of its functions and the constants that they use.
    pub(crate) fn finish(mut self, (text, pool): (Text, Vec<u64>)) -> Object {
        (self.object.text, self.object.pool) = (text, pool);
        self.object
    }

    /// Takes over every symbol; functions and data are filled in later.
    fn symbols(&mut self) {
        for symbol in self.unit.symbols.values() {
            let types = &self.unit.types;
            let definition = match symbol.definition {
                typed::Definition::Tentative => Definition::Tentative,
                _ => Definition::None,
            };
            let kind = symbol_kind(types, symbol.ty);
            let size = if kind == SymbolKind::Function { 0 } else { types.size_of(symbol.ty).unwrap_or(0) };
            let place = self.place(symbol.span);
            self.object.symbols.push(Symbol {
                name: symbol.name.clone(),
                linkage: symbol.linkage,
                definition,
                kind,
                size,
                align: types.align_of(symbol.ty).max(symbol.align).max(1),
                span: Some(symbol.span),
                place,
                used_at: symbol.used_at,
            });
        }
    }

    /// Copies the initialised objects, in the order in which the source defines them.
    fn data(&mut self) {
        let unit = self.unit;
        let mut initialized: Vec<_> = (unit.symbols.iter())
            .filter_map(|(id, symbol)| match &symbol.definition {
                typed::Definition::Data(data) => Some((self.sources.call_site(symbol.span).lo, id, data)),
                _ => None,
            })
            .collect();
        initialized.sort_by_key(|(position, ..)| *position);
        let object = &mut self.object;
        for (_, id, data) in initialized {
            let (start, first) = (object.data.len(), object.data_relocations.len() as u32);
            object.data.extend_from_slice(&data.bytes);
            for address in &data.addresses {
                let at = start + address.offset as usize;
                if let Some(word) = object.data.get_mut(at..at + 4) {
                    word.copy_from_slice(&address.addend.to_le_bytes());
                    object
                        .data_relocations
                        .push(DataRelocation { offset: at as u32, symbol: address.symbol });
                }
            }
            object.symbols[id].definition = Definition::Data(object.objects.len() as u32);
            object.symbols[id].size = data.bytes.len() as u32;
            object.objects.push(Initialized {
                symbol: id,
                bytes: start as u32..object.data.len() as u32,
                relocations: first..object.data_relocations.len() as u32,
            });
        }
    }

    /// Records where the lines of a function of `file` begin, and the calls and other places in them.
    fn lines(&mut self, file: u32, spans: &[(u32, Span)]) {
        let mut last = None;
        for (word, span) in spans {
            let place = self.place_in(file, *span);
            if last != Some(place) {
                let (place, column) = place;
                self.object.lines.push(Line { word: *word, place, column });
                last = Some((place, column));
            }
        }
    }

    /// The line and the column of `span` in `file`: text included in a function's body counts as the line of the
    /// `#include`, because an image has one file per function.
    fn place_in(&self, file: u32, span: Span) -> (SourceLine, u32) {
        let mut at = span;
        loop {
            let Some(place) = self.sources.place(at) else { return self.line_and_column(span) };
            if place.file.as_u32() == file {
                return line_and_column(place);
            }
            let Some(include) = self.sources.file(place.file).included_at else {
                return self.line_and_column(span);
            };
            at = include;
        }
    }

    fn line_and_column(&self, span: Span) -> (SourceLine, u32) {
        self.sources.place(span).map_or_else(Default::default, line_and_column)
    }

    fn place(&self, span: Span) -> SourceLine {
        self.line_and_column(span).0
    }
}

fn line_and_column(place: Place) -> (SourceLine, u32) {
    (SourceLine { file: place.file.as_u32(), line: place.line }, place.column)
}

/// The kind that the image's symbol table records for a type.
fn symbol_kind(types: &Types, ty: TypeId) -> SymbolKind {
    match types.get(ty) {
        Type::Function(_) => SymbolKind::Function,
        Type::Bool | Type::Char | Type::SignedChar | Type::UnsignedChar => SymbolKind::Char,
        Type::Short | Type::UnsignedShort => SymbolKind::Short,
        Type::Float => SymbolKind::Float,
        Type::Double => SymbolKind::Double,
        Type::Void | Type::Int | Type::Unsigned | Type::LongLong | Type::UnsignedLongLong => SymbolKind::Int,
        Type::Pointer(_) | Type::Array(..) | Type::Record(_) => SymbolKind::Other,
    }
}
