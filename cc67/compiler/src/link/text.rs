//! Writes text and data with their final addresses.

use std::collections::BTreeMap;
use std::sync::Arc;

use kmotiondef::GuestAddr;
use vm::guard;

use super::error::{LinkError, LinkErrorKind};
use super::names::DefinitionIndex;
use super::place::Placement;
use super::processor;
use super::reach::{ReachableParts, Target};
use super::{LinkedFunction, LinkedLine};
use crate::bytecode::text::{Renumbering, call, call_firmware};
use crate::bytecode::{WORD, head};
use crate::ir::function::{Signature, Signatures};
use crate::ir::inst::SignatureId;
use crate::object::{Object, ObjectFunction, SourceLine};
use crate::relocation::{Relocation, RelocationKind};

/// The order of the text and the numbers that objects share in it.
#[derive(Debug, Default)]
pub(super) struct TextLayout {
    /// The functions: object, index, number of the `func` word.
    pub(super) functions: Vec<(usize, u32, u32)>,
    /// Words of the text.
    pub(super) words: u32,
    /// Bytes of a word.
    pub(super) word_bytes: u32,
    /// Bytes of the text before the first of these words.
    pub(super) guard: u32,
    /// Jumps to functions that a branch does not reach: the function's address, the number of the word.
    pub(super) far: BTreeMap<u32, u32>,
    /// Source files, each once.
    pub(super) files: Vec<String>,
    file_numbers: Vec<Vec<u32>>,
    pool: Vec<u64>,
    pool_numbers: Vec<Vec<u32>>,
    signatures: Signatures,
    signature_numbers: Vec<Vec<u16>>,
}

impl TextLayout {
    pub(super) fn new(
        objects: &[Object],
        reached: &ReachableParts,
        base: GuestAddr,
    ) -> Result<Self, Vec<LinkError>> {
        let mut layout = Self { word_bytes: WORD as u32, guard: guard::BYTES as u32, ..Self::default() };
        layout.share_files(objects);
        if objects.iter().any(|object| object.code.is_some()) {
            layout.processor(objects, reached, base);
            return Ok(layout);
        }
        layout.share_pool(objects);
        layout.share_signatures(objects, reached)?;
        let mut word = head::word_count(&layout.pool, layout.signatures.as_slice());
        for (object, unit) in objects.iter().enumerate() {
            let needed =
                unit.functions.iter().enumerate().filter(|(index, _)| reached.functions[object][*index]);
            for (index, function) in needed {
                layout.functions.push((object, index as u32, word));
                word += function.words.end - function.words.start;
            }
        }
        layout.words = word;
        Ok(layout)
    }

    /// A line of an object as a line of the program.
    pub(super) fn place(&self, object: usize, place: SourceLine) -> SourceLine {
        let file = self.file_numbers[object].get(place.file as usize).copied().unwrap_or(0);
        SourceLine { file, ..place }
    }

    fn share_files(&mut self, objects: &[Object]) {
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        for object in objects {
            let mut own = Vec::with_capacity(object.files.len());
            for file in &object.files {
                let next = self.files.len() as u32;
                let number = *numbers.entry(file).or_insert(next);
                if number == next {
                    self.files.push(file.clone());
                }
                own.push(number);
            }
            self.file_numbers.push(own);
        }
    }

    fn share_pool(&mut self, objects: &[Object]) {
        let mut numbers: BTreeMap<u64, u32> = BTreeMap::new();
        for object in objects {
            let mut own = Vec::with_capacity(object.pool.len());
            for value in &object.pool {
                let next = self.pool.len() as u32;
                let number = *numbers.entry(*value).or_insert(next);
                if number == next {
                    self.pool.push(*value);
                }
                own.push(number);
            }
            self.pool_numbers.push(own);
        }
    }

    /// Numbers the signatures of the objects and of the firmware functions they call.
    fn share_signatures(
        &mut self,
        objects: &[Object],
        reached: &ReachableParts,
    ) -> Result<(), Vec<LinkError>> {
        for object in objects {
            let own = object.signatures.as_slice().iter();
            let numbers = own.map(|signature| self.signatures.intern(signature).as_u32() as u16).collect();
            self.signature_numbers.push(numbers);
        }
        for target in reached.targets.iter().flat_map(|targets| targets.values()) {
            if let Target::Function(_, Some(signature)) = target {
                self.signatures.intern(signature);
            }
        }
        if self.signatures.as_slice().len() > usize::from(u16::MAX) {
            return Err(vec![LinkError::global(LinkErrorKind::TooManySignatures)]);
        }
        Ok(())
    }

    /// The number of a signature that has one.
    fn number(&self, signature: &Signature) -> u16 {
        self.signatures.find(signature).map_or(0, |id| id.as_u32() as u16)
    }
}

/// The sources of all addresses.
pub(super) struct Addresses<'a> {
    /// The address of the first word.
    pub(super) base: GuestAddr,
    pub(super) reached: &'a ReachableParts,
    pub(super) placed: &'a Placement,
}

impl Addresses<'_> {
    pub(super) fn address_of(&self, target: &Target) -> GuestAddr {
        match *target {
            Target::Unknown => GuestAddr::NULL,
            Target::Function(address, _) | Target::Variable(address) => address,
            Target::Program(DefinitionIndex::Function(object, index)) => {
                self.placed.function((object, index))
            }
            Target::Program(DefinitionIndex::Data(object, index)) => self.placed.data[object][index as usize],
            Target::Program(DefinitionIndex::Bss(index)) => self.placed.bss[index],
        }
    }
}

/// The bytes of the text.
pub(super) fn text(
    objects: &[Object],
    layout: &TextLayout,
    addresses: &Addresses<'_>,
) -> Result<Vec<u8>, Vec<LinkError>> {
    if layout.word_bytes != WORD as u32 {
        return Ok(processor::text(objects, layout, addresses));
    }
    let mut writer = Writer { objects, layout, addresses, text: Vec::new(), errors: Vec::new() };
    writer.text.reserve_exact(guard::BYTES + layout.words as usize * WORD);
    writer.text.extend(guard::words(addresses.placed.function(addresses.reached.main)));
    head::write(&layout.pool, layout.signatures.as_slice(), &mut writer.text);
    for (object, index, word) in &layout.functions {
        writer.function(*object, &objects[*object].functions[*index as usize], *word);
    }
    if writer.errors.is_empty() { Ok(writer.text) } else { Err(writer.errors) }
}

struct Writer<'a> {
    objects: &'a [Object],
    layout: &'a TextLayout,
    addresses: &'a Addresses<'a>,
    text: Vec<u8>,
    errors: Vec<LinkError>,
}

impl Writer<'_> {
    /// Appends a function whose `func` word has number `word` in the program.
    fn function(&mut self, object: usize, function: &ObjectFunction, word: u32) {
        let unit = &self.objects[object];
        let relocations = function.relocations.start as usize..function.relocations.end as usize;
        let mut relocations = unit.relocations[relocations].iter().peekable();
        let numbers = Renumbering {
            // Labels count from the beginning of the object's text.
            word_offset: word.wrapping_sub(function.words.start),
            pool: &self.layout.pool_numbers[object],
            signatures: &self.layout.signature_numbers[object],
        };
        let start = self.text.len();
        for (at, mut bytes) in
            (function.words.start..).zip(unit.text.linked_bytes(function.words.clone(), &numbers))
        {
            if let Some(relocation) = relocations.next_if(|relocation| relocation.word == at) {
                match relocation.kind {
                    RelocationKind::Address => {
                        let target = &self.addresses.reached.targets[object][relocation.symbol];
                        add_address(&mut bytes[4..], self.addresses.address_of(target));
                    }
                    // Units for different targets cannot be linked together.
                    RelocationKind::Processor(_) => {}
                    RelocationKind::Call(signature) => match self.call(object, relocation, signature) {
                        Ok(word) => bytes = word,
                        Err(kind) => self.errors.push(fail(object, unit, function, relocation, kind)),
                    },
                }
            }
            self.text.extend_from_slice(&bytes);
        }
        debug_assert_eq!(start, guard::BYTES + word as usize * WORD, "functions are where they were placed");
    }

    /// The call of a symbol.
    fn call(
        &self,
        object: usize,
        relocation: &Relocation,
        signature: SignatureId,
    ) -> Result<[u8; WORD], LinkErrorKind> {
        let unit = &self.objects[object];
        let symbol = &unit.symbols[relocation.symbol];
        let called = unit.signatures.get(signature);
        let check = |defined: &Signature| {
            let fits = called.params == defined.params
                && (called.result.is_none() || called.result == defined.result);
            if fits {
                return Ok(());
            }
            let (name, called, defined) =
                (symbol.name.clone(), signature_text(called), signature_text(defined));
            Err(LinkErrorKind::CallMismatch { name, called, defined })
        };
        match &self.addresses.reached.targets[object][relocation.symbol] {
            Target::Program(DefinitionIndex::Function(unit, index)) => {
                let function = &self.objects[*unit].functions[*index as usize];
                check(self.objects[*unit].signatures.get(function.signature))?;
                let address = self.addresses.placed.function((*unit, *index));
                Ok(call(address.get() - self.addresses.base.get()))
            }
            Target::Function(address, defined) => {
                let defined = defined.as_ref().unwrap_or(called);
                check(defined)?;
                Ok(call_firmware(address.get(), self.layout.number(defined)))
            }
            _ => Err(LinkErrorKind::NotAFunction { name: symbol.name.clone() }),
        }
    }
}

/// An error about the call that `relocation` completes.
fn fail(
    object: usize,
    unit: &Object,
    function: &ObjectFunction,
    relocation: &Relocation,
    kind: LinkErrorKind,
) -> LinkError {
    let symbol = &unit.symbols[relocation.symbol];
    let (caller, place) =
        (&unit.symbols[function.symbol].name, unit.describe_word(function, relocation.word));
    LinkError {
        object: Some(object),
        span: symbol.used_at.or(symbol.span),
        kind,
        users: vec![format!("`{caller}` ({place})")],
    }
}

/// A signature for messages.
fn signature_text(signature: &Signature) -> String {
    let params: Vec<String> = signature.params.iter().map(ToString::to_string).collect();
    let result = signature.result.map_or_else(|| "void".to_owned(), |class| class.to_string());
    format!("{result} ({})", params.join(", "))
}

/// Adds an address to the little-endian word at the start of `bytes`.
fn add_address(bytes: &mut [u8], address: GuestAddr) {
    if let Some(word) = bytes.first_chunk_mut::<4>() {
        *word = u32::from_le_bytes(*word).wrapping_add(address.get()).to_le_bytes();
    }
}

/// The bytes of the initialised data.
pub(super) fn data(objects: &[Object], addresses: &Addresses<'_>) -> Vec<u8> {
    let placed = addresses.placed;
    let mut data = vec![0; placed.data_size as usize];
    for (index, object) in objects.iter().enumerate() {
        for (item, initialized) in object.objects.iter().enumerate() {
            let address = placed.data[index][item];
            if address.is_null() {
                continue;
            }
            let start = (address.get() - placed.data_address.get()) as usize;
            let bytes = &object.data[initialized.bytes.start as usize..initialized.bytes.end as usize];
            data[start..start + bytes.len()].copy_from_slice(bytes);
            let relocations = initialized.relocations.start as usize..initialized.relocations.end as usize;
            for relocation in &object.data_relocations[relocations] {
                let target = &addresses.reached.targets[index][relocation.symbol];
                let at = start + (relocation.offset - initialized.bytes.start) as usize;
                add_address(&mut data[at..], addresses.address_of(target));
            }
        }
    }
    data
}

/// The further data of the functions, in addition to their symbols.
pub(super) fn functions(objects: &[Object], layout: &TextLayout) -> Vec<LinkedFunction> {
    let mut first_line = 0;
    let describe = |(object, index, _): &(usize, u32, u32)| {
        let function = &objects[*object].functions[*index as usize];
        let count = (function.lines.end - function.lines.start) as usize;
        let lines = first_line..first_line + count;
        first_line += count;
        let place = |place: &SourceLine| layout.place(*object, *place);
        let exceeded = function.exceeded.iter().map(place).collect();
        LinkedFunction { lines, frame: function.frame, end: place(&function.end), exceeded }
    };
    layout.functions.iter().map(describe).collect()
}

/// The line table.
pub(super) fn lines(objects: &[Object], layout: &TextLayout, base: GuestAddr) -> Vec<LinkedLine> {
    let mut lines = Vec::new();
    for (object, index, word) in &layout.functions {
        let unit = &objects[*object];
        let function = &unit.functions[*index as usize];
        let own = &unit.lines[function.lines.start as usize..function.lines.end as usize];
        lines.extend(own.iter().map(|line| LinkedLine {
            address: base.offset((word + line.word - function.words.start) * layout.word_bytes),
            place: layout.place(*object, line.place),
            column: line.column,
            inlined: inlined(unit, function, line.place),
        }));
    }
    lines
}

/// The function to which a source line belongs, if it is not the function it is compiled into.
fn inlined(unit: &Object, around: &ObjectFunction, place: SourceLine) -> Option<Arc<str>> {
    let contains = |function: &&ObjectFunction| {
        let begin = unit.symbols[function.symbol].place;
        begin.file == place.file && (begin.line..=function.end.line).contains(&place.line)
    };
    let is_elsewhere = place.line > 0 && !contains(&around);
    let other = if is_elsewhere { unit.functions.iter().find(contains) } else { None };
    other.map(|other| unit.symbols[other.symbol].name.as_str().into())
}
