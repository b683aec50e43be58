//! Writes an object as the bytes of a file.
//!
//! The layout is that of images (`coff.md` of the specification), with these additions:
//! - `.text` of bytecode begins with the unit's constants and signatures; addresses and labels count from
//!   the beginning of the section;
//! - the target is the same as for images: our own for bytecode, the processor's for its code;
//! - relocations of kind [`ADDRESS`] add the symbol's address to the 32 bits at their address, relocations of kind
//!   [`CALL`] complete the call instruction there, whose signature is their displacement;
//! - in code for the processor, [`LOW`] and [`HIGH`] put half of the symbol's address plus an offset into the constant
//!   of an instruction, which holds that half of the offset, the displacement the other half; [`NEAR`] completes a
//!   branch; [`OWN`] adds the function's address to the word;
//! - the symbols after the file symbols are in the order of the unit's symbols, without those that are only declared: a
//!   header has hundreds. A tentative external object is undefined with its size as value, as common objects always are
//!   in COFF; a `static` one is in `.bss`;
//! - the auxiliary entry of an object has its alignment, file and line; `.bf` and `.ef` have the index of the file
//!   before the line.

use coff::raw::{BoundaryAux, FunctionAux, ObjectAux};
use coff::{
    Aux, Container, Contents, Error, FileFlags, Image, Layout, Line, Name, Section, SectionFlags,
    SectionNumber, StorageClass, Symbol, SymbolType, Target,
};

use cranelift_entity::EntitySet;

use super::{
    Definition, Object, ObjectFunction, SourceLine, base_type, class, function_type, statement, to_u16,
    whole_lines,
};
use crate::bytecode::{WORD, head};
use crate::c67x::text::with_half_constant;
use crate::relocation::{FixupKind, RelocationKind};
use crate::typed::{Linkage, SymbolId};

/// The symbol's address is added to the 32 bits.
pub(super) const ADDRESS: u16 = 1;
/// A call instruction.
pub(super) const CALL: u16 = 2;
/// The low half of an address in an instruction.
pub(super) const LOW: u16 = 3;
/// The high half.
pub(super) const HIGH: u16 = 4;
/// The displacement of a branch.
pub(super) const NEAR: u16 = 5;
/// The address of the function.
pub(super) const OWN: u16 = 6;
/// Bytes of a word of code for the processor.
pub(super) const CODE_WORD: u32 = 4;

/// The section of code, counted from 1.
pub(super) const TEXT: SectionNumber = SectionNumber(1);
/// The section of initialised data.
pub(super) const DATA: SectionNumber = SectionNumber(2);
/// The section of uninitialised data.
pub(super) const BSS: SectionNumber = SectionNumber(3);

impl Object {
    /// The bytes of an object file.
    ///
    /// # Errors
    /// The object exceeds the limits of the format.
    pub fn write(&self) -> Result<Vec<u8>, Error> {
        let mut writer = Writer::new(self);
        for file in &self.files {
            writer.push(
                Name::from(file.as_str()),
                0,
                SectionNumber::DEBUG,
                SymbolType::default(),
                StorageClass::FILE,
                &[],
            );
        }
        let used = self.used_symbols();
        for id in self.symbols.keys() {
            writer.symbol(id, used.contains(id));
        }
        writer.image()?.write()
    }

    /// The symbols whose addresses are used by code or data.
    fn used_symbols(&self) -> EntitySet<SymbolId> {
        let mut used = EntitySet::new();
        used.extend(self.relocations.iter().map(|relocation| relocation.symbol));
        used.extend(self.data_relocations.iter().map(|relocation| relocation.symbol));
        used
    }
}

/// An object while its symbol table grows.
struct Writer<'a> {
    object: &'a Object,
    /// Words in front of the first function.
    head: u32,
    /// Bytes of a word.
    word: u32,
    symbols: Vec<Symbol>,
    /// The number of entries so far, including auxiliary ones.
    entries: u32,
    /// The index of each of the unit's symbols in the symbol table.
    indexes: Vec<u32>,
    bss: u32,
    lines: Vec<Line>,
    /// Position in `symbols` of each function, and its first entry in `lines`.
    first_lines: Vec<(usize, u32)>,
}

impl<'a> Writer<'a> {
    fn new(object: &'a Object) -> Self {
        let (head, word) = match object.code {
            Some(_) => (0, CODE_WORD),
            None => (head::word_count(&object.pool, object.signatures.as_slice()), WORD as u32),
        };
        Self {
            object,
            head,
            word,
            symbols: Vec::new(),
            entries: 0,
            indexes: Vec::new(),
            bss: 0,
            lines: Vec::new(),
            first_lines: Vec::new(),
        }
    }

    fn push(
        &mut self,
        name: Name,
        value: u32,
        section: SectionNumber,
        ty: SymbolType,
        class: StorageClass,
        aux: &[Aux],
    ) {
        self.entries += 1 + aux.len() as u32;
        self.symbols.push(Symbol { name, value, section, ty, class, aux: aux.to_vec() });
    }

    fn symbol(&mut self, id: SymbolId, is_used: bool) {
        let symbol = &self.object.symbols[id];
        self.indexes.push(self.entries);
        if !is_used && symbol.definition == Definition::None {
            return;
        }
        let SourceLine { file, line } = symbol.place;
        let object = ObjectAux {
            size: symbol.size.into(),
            align: symbol.align.into(),
            file: file.into(),
            line: to_u16(line).into(),
            ..ObjectAux::default()
        };
        let (name, ty, class) =
            (Name::from(symbol.name.as_str()), base_type(symbol.kind), class(symbol.linkage));
        let aux = [Aux::new(&object)];
        match (symbol.definition, symbol.linkage) {
            (Definition::Function(index), _) => {
                let function = &self.object.functions[index as usize];
                self.function(name, symbol.place, class, function);
            }
            (Definition::Data(index), _) => {
                let start = self.object.objects[index as usize].bytes.start;
                self.push(name, start, DATA, ty, class, &aux);
            }
            (Definition::Tentative, Linkage::Internal) => {
                let start = self.bss.next_multiple_of(symbol.align.max(1));
                self.bss = start.saturating_add(symbol.size);
                self.push(name, start, BSS, ty, class, &aux);
            }
            (Definition::Tentative, Linkage::External) => {
                self.push(name, symbol.size, SectionNumber::UNDEFINED, ty, class, &aux);
            }
            (Definition::None, _) => self.push(name, 0, SectionNumber::UNDEFINED, ty, class, &[]),
        }
    }

    /// The six entries of a function, and its lines.
    fn function(&mut self, name: Name, place: SourceLine, class: StorageClass, function: &ObjectFunction) {
        let next = self.entries + 6;
        let first_line = self.lines.len() as u32;
        self.lines.push(Line::Function(self.entries));
        let lines = &self.object.lines[function.lines.start as usize..function.lines.end as usize];
        let statements = whole_lines(lines, |line| line.place)
            .filter_map(|line| statement(self.byte(line.word), line.place.line));
        let statements: Vec<_> = statements.collect();
        self.lines.extend(statements);
        let entries = self.lines.len() as u32 - first_line;
        self.first_lines.push((self.symbols.len(), first_line));

        let (start, end) = (self.byte(function.words.start), self.byte(function.words.end));
        let whole = FunctionAux { size: (end - start).into(), next: next.into(), ..FunctionAux::default() };
        self.push(name, start, TEXT, function_type(), class, &[Aux::new(&whole)]);
        let begin = BoundaryAux {
            tag: place.file.into(),
            line: to_u16(place.line).into(),
            lines: to_u16(entries - 1).into(),
            next: next.into(),
            ..BoundaryAux::default()
        };
        let finish = BoundaryAux {
            tag: function.end.file.into(),
            line: to_u16(function.end.line).into(),
            ..BoundaryAux::default()
        };
        for (name, value, aux) in [(".bf", start, begin), (".ef", end, finish)] {
            let aux = [Aux::new(&aux)];
            self.push(Name::from(name), value, TEXT, SymbolType::default(), StorageClass::FUNCTION, &aux);
        }
    }

    /// The offset of a word of the unit's text in the section.
    fn byte(&self, word: u32) -> u32 {
        (self.head + word) * self.word
    }

    fn image(self) -> Result<Image, Error> {
        let index = |symbol: SymbolId| self.indexes.get(symbol.as_u32() as usize).copied().unwrap_or(0);
        let text_relocations = self.object.relocations.iter().map(|relocation| {
            let at = self.byte(relocation.word);
            let (address, kind, displacement) = match relocation.kind {
                RelocationKind::Address => (at + 4, ADDRESS, 0),
                RelocationKind::Call(signature) => (at, CALL, to_u16(signature.as_u32())),
                RelocationKind::Processor(kind) => match kind {
                    FixupKind::Low(offset) => (at, LOW, (offset >> 16) as u16),
                    FixupKind::High(offset) => (at, HIGH, offset as u16),
                    FixupKind::Near => (at, NEAR, 0),
                    FixupKind::Own(_) => (at, OWN, 0),
                },
            };
            coff::Relocation { address, symbol: index(relocation.symbol), displacement, kind }
        });
        let data_relocations = self.object.data_relocations.iter().map(|relocation| coff::Relocation {
            address: relocation.offset,
            symbol: index(relocation.symbol),
            displacement: 0,
            kind: ADDRESS,
        });
        let text =
            section(".text", SectionFlags::TEXT, Contents::Data(self.text()), text_relocations.collect());
        let data = Contents::Data(self.object.data.clone());
        let data = section(".data", SectionFlags::DATA, data, data_relocations.collect());
        let bss = section(".bss", SectionFlags::BSS, Contents::Uninitialised(self.bss), Vec::new());
        let mut image = Image {
            container: Container::Coff,
            target: if self.object.code.is_some() { Target::C6000 } else { Target::CC67 },
            timestamp: 0,
            flags: FileFlags::LITTLE_ENDIAN,
            program: None,
            sections: vec![Section { lines: self.lines, ..text }, data, bss],
            symbols: self.symbols,
        };
        let layout = Layout::of(&image)?;
        for (symbol, first_line) in self.first_lines {
            let at = layout.line_offset(0, first_line).unwrap_or(0);
            if let Some(aux) = image.symbols.get_mut(symbol).and_then(|symbol| symbol.aux.first_mut()) {
                *aux = Aux::new(&FunctionAux { lines_at: at.into(), ..aux.as_function() });
            }
        }
        Ok(image)
    }

    fn text(&self) -> Vec<u8> {
        if let Some(code) = &self.object.code {
            return self.code(code);
        }
        let mut text = Vec::with_capacity(self.byte(self.object.text.len()) as usize);
        head::write(&self.object.pool, self.object.signatures.as_slice(), &mut text);
        self.object.text.write(self.head, &mut text);
        text
    }

    /// The words of the controller's code, with the offsets of their relocations.
    fn code(&self, code: &[u32]) -> Vec<u8> {
        let mut words = code.to_vec();
        for relocation in &self.object.relocations {
            let (Some(word), RelocationKind::Processor(kind)) =
                (words.get_mut(relocation.word as usize), relocation.kind)
            else {
                continue;
            };
            match kind {
                FixupKind::Low(offset) => *word = with_half_constant(*word, offset.cast_unsigned()),
                FixupKind::High(offset) => *word = with_half_constant(*word, offset.cast_unsigned() >> 16),
                FixupKind::Near => {}
                FixupKind::Own(offset) => *word = offset.cast_unsigned(),
            }
        }
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

fn section(
    name: &str,
    flags: SectionFlags,
    contents: Contents,
    relocations: Vec<coff::Relocation>,
) -> Section {
    let flags = flags.with_align(WORD as u32);
    Section {
        name: name.into(),
        physical: 0,
        address: 0,
        flags,
        page: 0,
        contents,
        relocations,
        lines: Vec::new(),
    }
}
