//! Reads an object from the bytes of a file: the reverse of `write`.
//!
//! A file is not trusted. The assumptions of the linker are checked here: every number of a symbol, signature, constant
//! or word exists. The code itself is checked by the machine's verifier.

use std::ops::Range;

use coff::{Contents, FileFlags, Image, Line as CoffLine, SectionNumber, StorageClass, Target};
use cranelift_entity::EntityRef;

use super::write::{ADDRESS, BSS, CALL, CODE_WORD, DATA, HIGH, LOW, NEAR, OWN, TEXT};
use super::{
    DataRelocation, Definition, Initialized, Line, Object, ObjectFunction, SourceLine, Symbol, kind_of,
};
use crate::bytecode::{Text, WORD, head};
use crate::c67x::text::constant;
use crate::ir::function::Signature;
use crate::ir::inst::SignatureId;
use crate::relocation::{FixupKind, Relocation, RelocationKind};
use crate::typed::{Linkage, SymbolId};

/// Largest alignment of an object.
const MAX_ALIGN: u32 = 64;

/// The reason why a file is not an object.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReadError {
    /// The bytes are not COFF.
    #[error("not an object file: {0}")]
    NotCoff(#[from] coff::Error),
    /// It is for another machine.
    #[error("not an object file of cc67: it is for target {0}")]
    OtherTarget(Target),
    /// It is linked already.
    #[error("the file is a linked image; a program is linked from sources and objects")]
    Linked,
    /// A section is missing.
    #[error("the object has no section {0}")]
    Missing(&'static str),
    /// It was written by another version of cc67, or is damaged.
    #[error("the object was compiled by another version of cc67; compile it again")]
    Code,
    /// A symbol does not fit the sections.
    #[error("symbol `{0}` is outside its section")]
    Symbol(String),
    /// A relocation does not fit the code or the data.
    #[error("the relocation at {address:#x} of {section} is wrong")]
    Relocation {
        /// Its section.
        section: &'static str,
        /// Its address there.
        address: u32,
    },
}

/// Reports whether bytes are one of our object files rather than an image or another file.
#[must_use]
pub fn is_object(bytes: &[u8]) -> bool {
    coff::File::parse(bytes)
        .is_ok_and(|file| is_ours(file.target()) && !file.flags().contains(FileFlags::EXECUTABLE))
}

/// Reports whether our objects have this target.
fn is_ours(target: Target) -> bool {
    target == Target::CC67 || target == Target::C6000
}

impl Object {
    /// Reads an object file.
    ///
    /// # Errors
    /// Why the bytes are none.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        let image = Image::read(bytes)?;
        if !is_ours(image.target) {
            return Err(ReadError::OtherTarget(image.target));
        }
        if image.flags.contains(FileFlags::EXECUTABLE) {
            return Err(ReadError::Linked);
        }
        let mut reader = ObjectReader::new(&image)?;
        reader.symbols()?;
        reader.functions()?;
        reader.data()?;
        Ok(reader.object)
    }
}

struct ObjectReader<'a> {
    text: &'a coff::Section,
    data: &'a coff::Section,
    symbols: &'a [coff::Symbol],
    object: Object,
    /// Words in front of the first function.
    head: u32,
    /// Bytes of a word.
    word: u32,
    /// The unit's symbol at each index of the format.
    ids: Vec<Option<SymbolId>>,
    functions: Vec<FunctionSymbols>,
    objects: Vec<(Range<u32>, SymbolId)>,
}

/// A function as its symbols describe it.
struct FunctionSymbols {
    words: Range<u32>,
    symbol: SymbolId,
    /// The index in the format.
    index: u32,
    end: SourceLine,
}

impl<'a> ObjectReader<'a> {
    fn new(image: &'a Image) -> Result<Self, ReadError> {
        let section = |number: SectionNumber, name: &'static str| {
            let section = image.sections.get(usize::from(number.0.unsigned_abs()) - 1);
            section.filter(|section| section.name == *name).ok_or(ReadError::Missing(name))
        };
        let (text, data, bss) = (section(TEXT, ".text")?, section(DATA, ".data")?, section(BSS, ".bss")?);
        if !matches!(bss.contents, Contents::Uninitialised(_)) {
            return Err(ReadError::Missing(".bss"));
        }
        let (ids, functions, objects) = (Vec::new(), Vec::new(), Vec::new());
        if image.target == Target::C6000 {
            let (words, rest) = text.data().as_chunks();
            if !rest.is_empty() {
                return Err(ReadError::Code);
            }
            let code = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
            let object = Object { code: Some(code), data: data.data().to_vec(), ..Object::default() };
            let (symbols, word) = (&image.symbols, CODE_WORD);
            return Ok(Self { text, data, symbols, object, head: 0, word, ids, functions, objects });
        }
        let (words, rest) = text.data().as_chunks::<WORD>();
        let (pool, signatures, head) =
            head::read(words).filter(|_| rest.is_empty()).ok_or(ReadError::Code)?;
        let mut object = Object { pool, data: data.data().to_vec(), ..Object::default() };
        for signature in &signatures {
            object.signatures.intern(signature);
        }
        if object.signatures.as_slice().len() != signatures.len() {
            return Err(ReadError::Code);
        }
        let head = head as u32;
        object.text = Text::read(words, head, &object.pool, &signatures).ok_or(ReadError::Code)?;
        let (symbols, word) = (&image.symbols, WORD as u32);
        Ok(Self { text, data, symbols, object, head, word, ids, functions, objects })
    }

    fn symbols(&mut self) -> Result<(), ReadError> {
        let mut symbols = self.symbols.iter();
        while let Some(symbol) = symbols.next() {
            let index = self.ids.len() as u32;
            self.ids.resize(self.ids.len() + 1 + symbol.aux.len(), None);
            match symbol.class {
                StorageClass::FILE => self.object.files.push(symbol.name.to_string()),
                StorageClass::EXTERNAL | StorageClass::STATIC => {
                    let id = self.symbol(symbol, index)?;
                    self.ids[index as usize] = Some(id);
                    if symbol.section == TEXT {
                        let (Some(begin), Some(end)) = (symbols.next(), symbols.next()) else {
                            return Err(symbol_error(symbol));
                        };
                        self.ids.resize(self.ids.len() + 2 + begin.aux.len() + end.aux.len(), None);
                        self.boundaries(id, begin, end);
                    }
                }
                _ => return Err(symbol_error(symbol)),
            }
        }
        Ok(())
    }

    fn symbol(&mut self, symbol: &coff::Symbol, index: u32) -> Result<SymbolId, ReadError> {
        let aux = symbol.aux.first().map(coff::Aux::as_object).unwrap_or_default();
        let (size, align) = (aux.size.get(), aux.align.get().max(1));
        let is_function = symbol.section == TEXT;
        if !is_function && (align > MAX_ALIGN || !align.is_power_of_two()) {
            return Err(symbol_error(symbol));
        }
        let id = SymbolId::new(self.object.symbols.len());
        let end = symbol.value.checked_add(size).ok_or_else(|| symbol_error(symbol))?;
        let definition = match (symbol.section, symbol.aux.is_empty()) {
            (TEXT, _) => {
                let words = self.function_words(symbol.value..end).ok_or_else(|| symbol_error(symbol))?;
                self.functions.push(FunctionSymbols { words, symbol: id, index, end: SourceLine::default() });
                Definition::None
            }
            (DATA, _) if u64::from(end) <= self.data.size() => {
                self.objects.push((symbol.value..end, id));
                Definition::None
            }
            (BSS, _) | (SectionNumber::UNDEFINED, false) => Definition::Tentative,
            (SectionNumber::UNDEFINED, true) => Definition::None,
            _ => return Err(symbol_error(symbol)),
        };
        self.object.symbols.push(Symbol {
            name: symbol.name.to_string(),
            linkage: if symbol.class == StorageClass::EXTERNAL {
                Linkage::External
            } else {
                Linkage::Internal
            },
            definition,
            kind: kind_of(symbol.ty),
            size: if is_function { 0 } else { size },
            align: if is_function { 1 } else { align },
            span: None,
            place: SourceLine { file: aux.file.get(), line: u32::from(aux.line.get()) },
            used_at: None,
        });
        Ok(id)
    }

    /// Reads the bounds of a function from `.bf` and `.ef`.
    fn boundaries(&mut self, id: SymbolId, begin: &coff::Symbol, end: &coff::Symbol) {
        let place = |symbol: &coff::Symbol| {
            let aux = symbol.aux.first().map(coff::Aux::as_boundary).unwrap_or_default();
            SourceLine { file: aux.tag.get(), line: u32::from(aux.line.get()) }
        };
        self.object.symbols[id].place = place(begin);
        if let Some(function) = self.functions.last_mut() {
            function.end = place(end);
        }
    }

    /// Words of the unit's text.
    fn length(&self) -> u32 {
        self.object.code.as_ref().map_or(self.object.text.len(), |code| code.len() as u32)
    }

    /// Signature and frame of a function; code for the processor has neither.
    fn head_of(&mut self, words: &Range<u32>) -> Option<(SignatureId, u32)> {
        if self.object.code.is_some() {
            let none = Signature { params: Vec::new(), result: None };
            return Some((self.object.signatures.intern(&none), 0));
        }
        self.object.text.function(words)
    }

    /// The words of a function in the unit's text, at addresses of the section.
    fn function_words(&self, bytes: Range<u32>) -> Option<Range<u32>> {
        let word = |at: u32| {
            let word = at.is_multiple_of(self.word).then_some(at / self.word)?.checked_sub(self.head)?;
            (word <= self.length()).then_some(word)
        };
        let words = word(bytes.start)?..word(bytes.end)?;
        let begins = self.object.code.is_some() || self.object.text.begins_function(words.start);
        (words.start < words.end && begins).then_some(words)
    }

    /// Functions in the order of the text, with the relocations and lines of each.
    fn functions(&mut self) -> Result<(), ReadError> {
        self.functions.sort_by_key(|function| function.words.start);
        let mut relocations = self.text.relocations.clone();
        relocations.sort_by_key(|relocation| relocation.address);
        let mut relocations = relocations.into_iter().peekable();
        for FunctionSymbols { words, symbol, index, end } in std::mem::take(&mut self.functions) {
            let first = self.object.relocations.len() as u32;
            let limit = (self.head + words.end) * self.word;
            while let Some(relocation) = relocations.next_if(|next| next.address < limit) {
                let relocation = self.relocation(&relocation, &words)?;
                self.object.relocations.push(relocation);
            }
            let lines = self.lines(index, &words, self.object.symbols[symbol].place.file);
            let (signature, frame) = self.head_of(&words).ok_or(ReadError::Code)?;
            self.object.symbols[symbol].definition = Definition::Function(self.object.functions.len() as u32);
            self.object.functions.push(ObjectFunction {
                symbol,
                signature,
                words,
                relocations: first..self.object.relocations.len() as u32,
                lines,
                frame,
                end,
                variables: Vec::new(),
                inlined: Vec::new(),
                exceeded: Vec::new(),
            });
        }
        relocations.next().map_or(Ok(()), |left| Err(misplaced_error(".text", left.address)))
    }

    fn relocation(&self, relocation: &coff::Relocation, words: &Range<u32>) -> Result<Relocation, ReadError> {
        let fail = || misplaced_error(".text", relocation.address);
        let symbol = self.referenced_symbol(relocation.symbol).ok_or_else(fail)?;
        let (at, kind) = match relocation.kind {
            ADDRESS => (relocation.address.checked_sub(4).ok_or_else(fail)?, RelocationKind::Address),
            CALL => {
                let number = usize::from(relocation.displacement);
                if number >= self.object.signatures.as_slice().len() {
                    return Err(fail());
                }
                (relocation.address, RelocationKind::Call(SignatureId::new(number)))
            }
            kind => {
                let own = self.fixup(relocation, kind).ok_or_else(fail)?;
                (relocation.address, RelocationKind::Processor(own))
            }
        };
        let is_code = matches!(kind, RelocationKind::Processor(_));
        let word = (at / self.word).checked_sub(self.head).filter(|word| words.contains(word));
        let word = word.filter(|_| at.is_multiple_of(self.word) && is_code == self.object.code.is_some());
        Ok(Relocation { word: word.ok_or_else(fail)?, kind, symbol })
    }

    /// The completion of a word of code for the processor.
    fn fixup(&self, relocation: &coff::Relocation, kind: u16) -> Option<FixupKind> {
        let word = *self.object.code.as_ref()?.get((relocation.address / CODE_WORD) as usize)?;
        let (own, other) = (constant(word), u32::from(relocation.displacement));
        Some(match kind {
            LOW => FixupKind::Low((own | other << 16).cast_signed()),
            HIGH => FixupKind::High((own << 16 | other).cast_signed()),
            NEAR => FixupKind::Near,
            OWN => FixupKind::Own(word.cast_signed()),
            _ => return None,
        })
    }

    fn referenced_symbol(&self, index: u32) -> Option<SymbolId> {
        self.ids.get(index as usize).copied().flatten()
    }

    /// The lines after the entry of the function with symbol `index`.
    fn lines(&mut self, index: u32, words: &Range<u32>, file: u32) -> Range<u32> {
        let first = self.object.lines.len() as u32;
        let own = self.text.lines.iter().skip_while(|line| **line != CoffLine::Function(index)).skip(1);
        for line in own {
            let CoffLine::Statement { address, line } = line else { break };
            let word = (address / self.word).wrapping_sub(self.head);
            if words.contains(&word) {
                let place = SourceLine { file, line: u32::from(line.get()) };
                self.object.lines.push(Line { word, place, column: 0 });
            }
        }
        first..self.object.lines.len() as u32
    }

    /// Initialised objects in the order of the data, with the relocations of each.
    fn data(&mut self) -> Result<(), ReadError> {
        self.objects.sort_by_key(|(bytes, _)| (bytes.start, bytes.end));
        let mut relocations = self.data.relocations.clone();
        relocations.sort_by_key(|relocation| relocation.address);
        let mut relocations = relocations.into_iter().peekable();
        for (bytes, symbol) in std::mem::take(&mut self.objects) {
            let first = self.object.data_relocations.len() as u32;
            while let Some(relocation) = relocations.next_if(|next| next.address < bytes.end) {
                let target = self.referenced_symbol(relocation.symbol).filter(|_| {
                    let end = relocation.address.checked_add(4);
                    relocation.address >= bytes.start && end.is_some_and(|end| end <= bytes.end)
                });
                let target = target.ok_or_else(|| misplaced_error(".data", relocation.address))?;
                self.object
                    .data_relocations
                    .push(DataRelocation { offset: relocation.address, symbol: target });
            }
            self.object.symbols[symbol].definition = Definition::Data(self.object.objects.len() as u32);
            let relocations = first..self.object.data_relocations.len() as u32;
            self.object.objects.push(Initialized { symbol, bytes, relocations });
        }
        relocations.next().map_or(Ok(()), |left| Err(misplaced_error(".data", left.address)))
    }
}

fn symbol_error(symbol: &coff::Symbol) -> ReadError {
    ReadError::Symbol(symbol.name.to_string())
}

fn misplaced_error(section: &'static str, address: u32) -> ReadError {
    ReadError::Relocation { section, address }
}
