//! An index of the names in the texts at the beginning of every compilation, built together with the compiler.
//!
//! The predefined macros and the headers of the board have a thousand names, of which a program uses a few. The index
//! contains the position of each name's macro or declaration, so that only those few are read. It is a constant: the
//! functions here run when the compiler is built. They support only the subset of C in those texts, and refuse to index
//! anything else; a test of [`crate::driver`] checks that they agree with the parser on the headers.

#![expect(
    clippy::indexing_slicing,
    clippy::as_conversions,
    clippy::panic,
    reason = "runs when the compiler is built, where a panic is an error of the build"
)]

use kmotiondef::headers::EMBEDDED;

use crate::names::{SpellingHash, is_name_byte};

/// The texts; the headers follow each other as the first of them includes the rest.
pub(super) const TEXTS: [&[u8]; 3] = [include_bytes!("../predefined.h"), EMBEDDED[0].1, EMBEDDED[1].1];

/// The names of the texts.
const NAMES: [&str; 3] = ["<predefined>", EMBEDDED[0].0, EMBEDDED[1].0];

/// The text of the predefined macros.
pub(super) const PREDEFINED: usize = 0;

/// The header that programs include.
pub(super) const BOARD: usize = 1;

const SLOTS: usize = 1 << 12;
const WORDS: usize = 1 << 11;
const PIECES: usize = 1 << 9;

/// The name of a text.
pub(super) const fn name(text: usize) -> &'static str {
    NAMES[text]
}

/// The index of the texts.
pub(super) static INDEX: Index = Index::of_texts();

/// A place in one of the texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TextPosition(u32);

impl TextPosition {
    const NOWHERE: Self = Self(u32::MAX);
    const OFFSET_BITS: u32 = 24;

    const fn new(text: usize, offset: usize) -> Self {
        Self((text as u32) << Self::OFFSET_BITS | offset as u32)
    }

    /// The number of the text.
    pub(super) const fn text(self) -> usize {
        (self.0 >> Self::OFFSET_BITS) as usize
    }

    /// Bytes in front of the place.
    pub(super) const fn offset(self) -> usize {
        (self.0 & ((1 << Self::OFFSET_BITS) - 1)) as usize
    }

    const fn is_nowhere(self) -> bool {
        self.0 == Self::NOWHERE.0
    }
}

/// A name in the texts.
#[derive(Clone, Copy, Debug)]
pub(super) struct IndexedName {
    spelling: TextPosition,
    length: u8,
    /// It is read when the headers are: as the name of a macro, or within a declaration.
    is_of_headers: bool,
    /// True if a declaration of the headers changes its meaning when a program defines a macro with the name.
    pub(super) is_in_declaration: bool,
    definition: TextPosition,
    piece: u16,
}

impl IndexedName {
    const NONE: Self = Self {
        spelling: TextPosition::NOWHERE,
        length: 0,
        is_of_headers: false,
        is_in_declaration: false,
        definition: TextPosition::NOWHERE,
        piece: u16::MAX,
    };

    /// The position of the name in the `#define` of a macro.
    pub(super) const fn definition(&self) -> Option<TextPosition> {
        if self.definition.is_nowhere() { None } else { Some(self.definition) }
    }

    /// The number of the declaration.
    pub(super) const fn piece(&self) -> Option<usize> {
        if self.piece == u16::MAX { None } else { Some(self.piece as usize) }
    }

    /// Reports whether the headers change their meaning, or cause a diagnostic, if the program has a macro of this name
    /// before it includes them.
    pub(super) const fn is_of_headers(&self) -> bool {
        self.is_of_headers || self.is_in_declaration
    }
}

/// A declaration at file scope, its semicolon included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its first byte.
    pub(super) start: TextPosition,
    /// Offset of the byte after its last.
    pub(super) end: usize,
}

/// The positions in the first entry of a prepared header.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeadPlaces {
    /// The text that includes it, and the range of the name there with its quotes; of no meaning for the first.
    pub(super) included_at: (usize, usize, usize),
    /// The name of the macro that guards it.
    pub(super) guard: (usize, usize),
}

/// Every name of the texts.
pub(super) struct Index {
    slots: [u16; SLOTS],
    words: [IndexedName; WORDS],
    count: usize,
    pieces: [Piece; PIECES],
    piece_count: usize,
    heads: [HeadPlaces; TEXTS.len()],
}

impl Index {
    /// The word of a spelling.
    pub(super) fn find(&self, spelling: &[u8]) -> Option<&IndexedName> {
        match self.slot(spelling) {
            (_, Some(word)) => self.words.get(word),
            (_, None) => None,
        }
    }

    /// The declarations, in the order of reading.
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces[..self.piece_count]
    }

    /// The start of the header with this number.
    pub(super) const fn head(&self, text: usize) -> HeadPlaces {
        self.heads[text]
    }

    const fn of_texts() -> Self {
        let nothing = Piece { start: TextPosition::NOWHERE, end: 0 };
        let head = HeadPlaces { included_at: (0, 0, 0), guard: (0, 0) };
        let mut index = Self {
            slots: [0; SLOTS],
            words: [IndexedName::NONE; WORDS],
            count: 0,
            pieces: [nothing; PIECES],
            piece_count: 0,
            heads: [head; TEXTS.len()],
        };
        index.predefined();
        index.header(BOARD);
        index.propagate_names();
        index
    }

    /// Enters the macros of a text that only defines macros.
    const fn predefined(&mut self) {
        let text = TEXTS[PREDEFINED];
        let mut at = 0;
        while at < text.len() {
            let name = past_word(text, at, b"#define ");
            let word = self.intern(PREDEFINED, name);
            self.words[word].definition = TextPosition::new(PREDEFINED, name);
            at = line_end(text, name) + 1;
        }
    }

    /// Adds the definitions and declarations of a header, and the header that it includes.
    const fn header(&mut self, number: usize) {
        let text = TEXTS[number];
        let mut at = past_space(text, 0);
        while at < text.len() {
            at = if text[at] == b'#' { self.directive(number, at) } else { self.piece(number, at) };
            at = past_space(text, at);
        }
    }

    /// Obeys the directive at `at`; the offset of the end of its line.
    const fn directive(&mut self, number: usize, at: usize) -> usize {
        let text = TEXTS[number];
        let end = line_end(text, at);
        if is_at(text, at, b"#define ") {
            let name = past_word(text, at, b"#define ");
            let word = self.intern(number, name);
            assert!(self.words[word].definition.is_nowhere(), "a macro of the headers is defined twice");
            self.words[word].definition = TextPosition::new(number, name);
            self.words[word].is_of_headers = true;
        } else if is_at(text, at, b"#ifndef ") {
            // As long as no macro of the program has a name of the headers, the lines count.
            let name = past_word(text, at, b"#ifndef ");
            let word = self.intern(number, name);
            assert!(self.words[word].definition.is_nowhere(), "a header leaves out lines of its own");
            self.words[word].is_of_headers = true;
            if self.heads[number].guard.1 == 0 {
                self.heads[number].guard = (name, name_end(text, name));
            }
        } else if is_at(text, at, b"#include \"") {
            let name = past_word(text, at, b"#include \"");
            let mut included = BOARD + 1;
            while !is_at(text, name, NAMES[included].as_bytes()) {
                included += 1;
            }
            self.heads[included].included_at = (number, name - 1, name + NAMES[included].len() + 1);
            self.header(included);
        } else {
            assert!(is_at(text, at, b"#endif"), "a directive that no header of the board had so far");
        }
        end
    }

    /// Enters the declaration at `at`; the offset after its semicolon.
    const fn piece(&mut self, number: usize, start: usize) -> usize {
        let text = TEXTS[number];
        let (mut at, mut parens, mut braces) = (start, 0, 0);
        loop {
            match text[at] {
                b'(' => parens += 1,
                b')' => parens -= 1,
                b'{' => braces += 1,
                b'}' => braces -= 1,
                b';' if braces == 0 => break,
                b'"' | b'\'' | b'=' | b'\\' => panic!("headers only declare"),
                b'0'..=b'9' => at = name_end(text, at) - 1,
                byte if is_name_byte(byte) => {
                    let end = name_end(text, at);
                    let word = self.intern(number, at);
                    self.words[word].is_in_declaration = true;
                    let next = text[past_space(text, end)];
                    assert!(
                        !is_at(text, at, b"enum") && (!is_at(text, at, b"struct") || next == b'{'),
                        "the index knows no tags"
                    );
                    if parens == 0 && braces == 0 && matches!(next, b'(' | b'[' | b';' | b',') {
                        assert!(self.words[word].piece == u16::MAX, "a header declares a name twice");
                        self.words[word].piece = self.piece_count as u16;
                    }
                    at = end - 1;
                }
                _ => {}
            }
            at = past_space(text, at + 1);
        }
        self.pieces[self.piece_count] = Piece { start: TextPosition::new(number, start), end: at + 1 };
        self.piece_count += 1;
        at + 1
    }

    /// Adds the names in macros to the declarations that use them.
    const fn propagate_names(&mut self) {
        let mut is_new = true;
        while is_new {
            is_new = false;
            let mut word = 0;
            while word < self.count {
                let IndexedName { definition, is_in_declaration, .. } = self.words[word];
                is_new |= is_in_declaration && !definition.is_nowhere() && self.spread_body(definition);
                word += 1;
            }
        }
    }

    /// Marks the names in the body of a macro; returns whether any was not marked before.
    const fn spread_body(&mut self, definition: TextPosition) -> bool {
        let text = TEXTS[definition.text()];
        let mut at = name_end(text, definition.offset());
        let (end, mut is_new) = (line_end(text, at), false);
        while at < end && !is_at(text, at, b"//") {
            if !is_name_byte(text[at]) {
                at += 1;
                continue;
            }
            if !text[at].is_ascii_digit() {
                let word = self.intern(definition.text(), at);
                is_new |= !self.words[word].is_in_declaration;
                self.words[word].is_in_declaration = true;
            }
            at = name_end(text, at);
        }
        is_new
    }

    /// The number of the word at an offset, new if there is none.
    const fn intern(&mut self, number: usize, at: usize) -> usize {
        let text = TEXTS[number];
        let end = name_end(text, at);
        let (_, spelling) = text.split_at(at);
        let (spelling, _) = spelling.split_at(end - at);
        let (slot, word) = self.slot(spelling);
        if let Some(word) = word {
            return word;
        }
        let word = self.count;
        let spelling = TextPosition::new(number, at);
        self.words[word] = IndexedName { spelling, length: (end - at) as u8, ..IndexedName::NONE };
        self.count += 1;
        self.slots[slot] = self.count as u16;
        word
    }

    /// The slot of a spelling, and the word in it.
    const fn slot(&self, spelling: &[u8]) -> (usize, Option<usize>) {
        let mut hash = SpellingHash::START;
        let mut at = 0;
        while at < spelling.len() {
            hash = hash.with(spelling[at]);
            at += 1;
        }
        let mut slot = hash.finish() as usize % SLOTS;
        loop {
            let Some(word) = (self.slots[slot] as usize).checked_sub(1) else { return (slot, None) };
            let IndexedName { spelling: known, length, .. } = self.words[word];
            if length as usize == spelling.len() && is_at(TEXTS[known.text()], known.offset(), spelling) {
                return (slot, Some(word));
            }
            slot = (slot + 1) % SLOTS;
        }
    }
}

/// Reports whether a text continues with some bytes.
const fn is_at(text: &[u8], at: usize, bytes: &[u8]) -> bool {
    let mut index = 0;
    while index < bytes.len() {
        if at + index >= text.len() || text[at + index] != bytes[index] {
            return false;
        }
        index += 1;
    }
    true
}

/// The offset after `bytes`, which must come next.
const fn past_word(text: &[u8], at: usize, bytes: &[u8]) -> usize {
    assert!(is_at(text, at, bytes), "a line that the index does not know");
    at + bytes.len()
}

/// The offset after the name at `at`.
const fn name_end(text: &[u8], at: usize) -> usize {
    let mut end = at;
    while end < text.len() && is_name_byte(text[end]) {
        end += 1;
    }
    end
}

/// The offset of the end of a line, with the lines that backslashes join to it.
const fn line_end(text: &[u8], at: usize) -> usize {
    let mut end = at;
    while end < text.len() && (text[end] != b'\n' || text[end - 1] == b'\\') {
        end += 1;
    }
    end
}

/// The offset after white space and comments.
const fn past_space(text: &[u8], at: usize) -> usize {
    let mut at = at;
    loop {
        if is_at(text, at, b"//") {
            at = line_end(text, at);
        } else if is_at(text, at, b"/*") {
            panic!("comments in headers begin with //");
        } else if at < text.len() && matches!(text[at], b' ' | b'\n' | b'\t' | b'\r') {
            at += 1;
        } else {
            return at;
        }
    }
}
