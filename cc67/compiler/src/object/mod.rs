//! The compiled form of one translation unit, ready to be linked with others.
//!
//! Code and data are divided into pieces, one for each function and object, so that the linker can place each
//! separately and omit unused ones. Words that depend on a symbol's address have relocations; labels count from the
//! beginning of the unit's text.
//!
//! `cc67 build -c` keeps an object in a file: COFF with our target and relocations, as described in `write` and `read`.
//! The file contains source files and lines, but not the positions in the source text.

mod coff_words;
mod read;
mod unit;
mod write;

pub use coff_words::kind_of;
pub(crate) use coff_words::{base_type, class, function_type, statement, to_u16};
pub use read::{ReadError, is_object};
pub(crate) use unit::{FunctionFacts, UnitBuilder};

use std::ops::Range;

use cranelift_entity::PrimaryMap;

use crate::bytecode::Text;
pub use crate::bytecode::{InlinedPlaces, Location, VariablePlaces};
use crate::ir::function::Signatures;
use crate::ir::inst::SignatureId;
use crate::relocation::Relocation;
use crate::source::Span;
use crate::target::Target;
use crate::typed::{Linkage, SymbolId};

/// The result of compiling one unit.
#[derive(Clone, Debug, Default)]
pub struct Object {
    /// Source files in the order of first inclusion, the unit's own first.
    pub files: Vec<String>,
    /// Every symbol that the unit defines or names.
    pub symbols: PrimaryMap<SymbolId, Symbol>,
    /// Signatures of functions and calls.
    pub signatures: Signatures,
    /// Constants of eight bytes, each once.
    pub pool: Vec<u64>,
    /// The words of all functions.
    pub text: Text,
    /// The words of all functions for the controller's processor; the unit is for one target.
    pub code: Option<Vec<u32>>,
    /// Words of the text that hold an address, ascending.
    pub relocations: Vec<Relocation>,
    /// The starts of source lines, ascending by word.
    pub lines: Vec<Line>,
    /// The functions in the order of the text.
    pub functions: Vec<ObjectFunction>,
    /// The bytes of all initialised objects.
    pub data: Vec<u8>,
    /// Words of the data that hold an address, ascending.
    pub data_relocations: Vec<DataRelocation>,
    /// The initialised objects in the order of definition.
    pub objects: Vec<Initialized>,
}

impl Object {
    /// The target of its code.
    #[must_use]
    pub const fn target(&self) -> Target {
        if self.code.is_some() { Target::C67x } else { Target::Sim }
    }

    /// File and line as text; only the file if the line is unknown.
    #[must_use]
    pub fn describe(&self, place: SourceLine) -> String {
        let file = self.files.get(place.file as usize).map_or("?", String::as_str);
        if place.line == 0 { file.to_owned() } else { format!("{file}:{}", place.line) }
    }

    /// The line of the unit's word `word` in `function`, in words.
    #[must_use]
    pub fn describe_word(&self, function: &ObjectFunction, word: u32) -> String {
        let lines = &self.lines[function.lines.start as usize..function.lines.end as usize];
        let after = lines.partition_point(|line| line.word <= word);
        let line = after.checked_sub(1).and_then(|index| lines.get(index));
        self.describe(line.map_or(self.symbols[function.symbol].place, |line| line.place))
    }
}

/// A symbol of a unit.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The name; anonymous objects have one that no program can spell.
    pub name: String,
    /// Its linkage: internal or external.
    pub linkage: Linkage,
    /// Its definition in the unit.
    pub definition: Definition,
    /// The kind of its type, as the image's symbol table records it.
    pub kind: SymbolKind,
    /// Bytes of an object; 0 for a function.
    pub size: u32,
    /// Alignment of an object.
    pub align: u32,
    /// The defining declaration, otherwise the first one; `None` in an object from a file.
    pub span: Option<Span>,
    /// The position as file and line.
    pub place: SourceLine,
    /// The first use, for messages.
    pub used_at: Option<Span>,
}

/// The definition of a symbol in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Definition {
    /// Defined elsewhere.
    None,
    /// A function; index into [`Object::functions`].
    Function(u32),
    /// An initialised object; index into [`Object::objects`].
    Data(u32),
    /// An object without initialiser.
    Tentative,
}

/// The kinds of type that the image's symbol table distinguishes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolKind {
    /// A function.
    Function,
    /// `char`, `unsigned char`
    Char,
    /// `short`, `unsigned short`
    Short,
    /// `int`, `unsigned` and all other numbers.
    Int,
    /// `float`
    Float,
    /// `double`
    Double,
    /// Arrays, pointers, structures.
    Other,
}

/// A line of a source file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SourceLine {
    /// Index into [`Object::files`].
    pub file: u32,
    /// Line, counted from 1; 0 if unknown.
    pub line: u32,
}

/// The source position of the code from a word on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Index of the word.
    pub word: u32,
    /// The line.
    pub place: SourceLine,
    /// The column, counted from 1; 0 in an object from a file, as object files have no columns.
    pub column: u32,
}

/// The first position in each line, for formats without columns.
pub(crate) fn whole_lines<T>(places: &[T], line: impl Fn(&T) -> SourceLine) -> impl Iterator<Item = &T> {
    places.chunk_by(move |one, next| line(one) == line(next)).filter_map(|same| same.first())
}

/// A function.
#[derive(Clone, Debug)]
pub struct ObjectFunction {
    /// Its symbol.
    pub symbol: SymbolId,
    /// Its signature.
    pub signature: SignatureId,
    /// Its words, beginning with the `func` word.
    pub words: Range<u32>,
    /// Its part of [`Object::relocations`].
    pub relocations: Range<u32>,
    /// Its part of [`Object::lines`].
    pub lines: Range<u32>,
    /// Bytes of its frame in guest memory.
    pub frame: u32,
    /// The line of its closing brace.
    pub end: SourceLine,
    /// The locations of its locals; unknown in an object from a file.
    pub variables: Vec<VariablePlaces>,
    /// The inlined calls; unknown in an object from a file.
    pub inlined: Vec<InlinedPlaces>,
    /// The loops that are scheduled without overlap because the search exceeded its budget; unknown in an object from a
    /// file.
    pub exceeded: Vec<SourceLine>,
}

/// An initialised object.
#[derive(Clone, Debug)]
pub struct Initialized {
    /// Its symbol.
    pub symbol: SymbolId,
    /// Its part of [`Object::data`].
    pub bytes: Range<u32>,
    /// Its part of [`Object::data_relocations`].
    pub relocations: Range<u32>,
}

/// A word of the data to which the linker adds an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataRelocation {
    /// Offset in [`Object::data`].
    pub offset: u32,
    /// The symbol whose address is stored.
    pub symbol: SymbolId,
}
