//! A whole unit: every function through all stages, data and symbols beside them.

use vm::op::{Op, WORD};
use vm::operand::{Classes, Count, SigRef};
use vm::verify::MAX_REGISTERS;

use super::pool::ConstantPool;
use super::registers::{self, Registers};
use super::select::Code;
use super::{legalize, meter, select};
use crate::diag::{Diagnostic, Sink};
use crate::ir::function::Function;
use crate::lower;
use crate::object::{
    self, DataRelocation, Definition, Initialized, Line, Object, Relocation, SourceLine, Symbol, SymbolKind,
};
use crate::passes::inline::Candidates;
use crate::passes::{self, Level};
use crate::source::{SourceMap, Span};
use crate::ty::{Type, TypeId, Types};
use crate::typed::{self, Unit};

/// Bytes of guest frame that a function can have: 16 bits of units of eight bytes.
pub const MAX_FRAME: u32 = u16::MAX as u32 * WORD as u32;

/// Compiles a unit that has no errors.
///
/// Functions that are too large for the machine are reported to `sink`.
#[must_use]
pub fn compile(unit: &Unit, sources: &SourceMap, level: Level, sink: &mut Sink) -> Object {
    let mut compiler = Compiler {
        unit,
        sources,
        sink,
        pool: ConstantPool::default(),
        object: Object {
            files: sources.files().map(|(_, file)| file.name.clone()).collect(),
            ..Object::default()
        },
    };
    compiler.symbols();
    compiler.data();
    let definitions = lower::Definitions::new(unit, &mut compiler.object.signatures);
    let mut candidates = Candidates::default();
    for function in &unit.functions {
        let mut ir = lower::lower(unit, function, &definitions, &mut compiler.object.signatures);
        passes::run(&mut ir, level);
        if level != Level::None {
            let file = compiler.place(ir.span).file;
            candidates.offer(&ir, file);
            if candidates.run(&mut ir, file) {
                passes::run(&mut ir, level);
            }
        }
        compiler.function(ir);
    }
    compiler.object.pool = compiler.pool.into_values();
    compiler.object
}

struct Compiler<'a> {
    unit: &'a Unit,
    sources: &'a SourceMap,
    sink: &'a mut Sink,
    pool: ConstantPool,
    object: Object,
}

impl Compiler<'_> {
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

    /// Takes one optimised function through the remaining stages.
    fn function(&mut self, mut ir: Function) {
        let frame = legalize::legalize(&mut ir);
        let name = &self.object.symbols[ir.symbol].name;
        let Some(size) = frame.size.filter(|size| *size <= MAX_FRAME) else {
            self.sink.report(
                Diagnostic::error(ir.span, format!("the local variables of `{name}` are too large"))
                    .note(format!("a function can have {MAX_FRAME} bytes of them"))
                    .help("make large arrays `static` or global"),
            );
            return;
        };
        let Some(registers) = registers::assign(&ir, &frame.prologue) else {
            self.sink.report(too_large(ir.span, name));
            return;
        };
        let mut code = select::select(&ir, &frame, &registers, &mut self.pool);
        if code.is_too_large {
            self.sink.report(too_large(ir.span, name));
            return;
        }
        meter::insert_charges(&mut code);
        self.append(&ir, &registers, code, size);
    }

    /// Appends a function's words to the text.
    fn append(&mut self, ir: &Function, registers: &Registers, code: Code, frame: u32) {
        let end = self.place(ir.end);
        let first = self.object.text.len() as u32;
        let (first_relocation, first_line) =
            (self.object.relocations.len() as u32, self.object.lines.len() as u32);
        let regs = Count(registers.classes.len() as u16);
        let frame_units = Count((frame / WORD as u32) as u16);
        let sig = SigRef(ir.signature.as_u32() as u16);
        self.object.text.push(Op::Func { sig, regs, frame: frame_units });
        for classes in registers.classes.chunks(16) {
            let bits = classes.iter().rev().fold(0, |bits, class| bits << 2 | *class as u32);
            self.object.text.push(Op::Types { classes: Classes(bits) });
        }
        let start = self.object.text.len() as u32;
        let file = self.object.symbols[ir.symbol].place.file;
        self.lines(file, first, start, &code.spans);
        let object = &mut self.object;
        object.text.extend(code.ops.into_iter().map(|mut op| {
            if let Op::Br { to } | Op::BrIf { to, .. } | Op::BrUnless { to, .. } = &mut op {
                to.0 += start;
            }
            op
        }));
        object.relocations.extend(
            (code.relocations.into_iter())
                .map(|relocation| Relocation { word: relocation.word + start, ..relocation }),
        );
        object.symbols[ir.symbol].definition = Definition::Function(object.functions.len() as u32);
        object.functions.push(object::Function {
            symbol: ir.symbol,
            signature: ir.signature,
            words: first..object.text.len() as u32,
            relocations: first_relocation..object.relocations.len() as u32,
            lines: first_line..object.lines.len() as u32,
            frame,
            end,
        });
    }

    /// Records the lines of a function of `file` that begins at word `first` and whose code begins at `start`.
    fn lines(&mut self, file: u32, first: u32, start: u32, spans: &[(u32, Span)]) {
        let mut last = None;
        for (index, (word, span)) in spans.iter().enumerate() {
            let place = self.place_in(file, *span);
            if last != Some(place) {
                let word = if index == 0 { first } else { start + word };
                self.object.lines.push(Line { word, place });
                last = Some(place);
            }
        }
    }

    /// The line of `file` that `span` belongs to: what a function's body includes counts as the
    /// line of the `#include`, because an image knows one file a function.
    fn place_in(&self, file: u32, span: Span) -> SourceLine {
        let mut at = span;
        loop {
            let place = self.place(at);
            if place.file == file {
                return place;
            }
            let included = self.sources.place(at).and_then(|at| self.sources.file(at.file).included_at);
            let Some(include) = included else { return self.place(span) };
            at = include;
        }
    }

    fn place(&self, span: Span) -> SourceLine {
        let place = self.sources.place(span);
        place
            .map_or(SourceLine::default(), |place| SourceLine { file: place.file.as_u32(), line: place.line })
    }
}

fn too_large(span: Span, name: &str) -> Diagnostic {
    Diagnostic::error(span, format!("function `{name}` is too large"))
        .note(format!("it needs more than {MAX_REGISTERS} registers, signatures or table entries"))
        .help("split it")
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
