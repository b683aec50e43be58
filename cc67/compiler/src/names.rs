//! Identifiers as small numbers.
//!
//! Keywords and other words that the compiler tests by name have predefined numbers ([`word`]), so that a `match` on a
//! [`Name`] needs no strings. The table is a specialised open-addressed hash table, because it is used once for every
//! identifier token.

use std::collections::BTreeSet;

use cranelift_entity::{EntityRef, entity_impl};

/// An identifier; equal numbers are equal spellings.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(u32);
entity_impl!(Name, "name");

macro_rules! words {
    ($($id:ident = $text:literal,)*) => {
        #[expect(non_camel_case_types, clippy::upper_case_acronyms, reason = "only numbers the words")]
        enum Number { $($id),* }

        /// The words with predefined numbers.
        pub mod word {
            use super::{Name, Number};

            $(
                #[doc = concat!("`", $text, "`")]
                pub const $id: Name = Name(Number::$id as u32);
            )*
        }

        const WORDS: &[&str] = &[$($text),*];
    };
}

words! {
    // Keywords of C11; `ASM` is the first word that is none.
    AUTO = "auto", BREAK = "break", CASE = "case", CHAR = "char", CONST = "const", CONTINUE = "continue",
    DEFAULT = "default", DO = "do", DOUBLE = "double", ELSE = "else", ENUM = "enum", EXTERN = "extern",
    FLOAT = "float", FOR = "for", GOTO = "goto", IF = "if", INLINE = "inline", INT = "int", LONG = "long",
    REGISTER = "register", RESTRICT = "restrict", RETURN = "return", SHORT = "short", SIGNED = "signed",
    SIZEOF = "sizeof", STATIC = "static", STRUCT = "struct", SWITCH = "switch", TYPEDEF = "typedef",
    UNION = "union", UNSIGNED = "unsigned", VOID = "void", VOLATILE = "volatile", WHILE = "while",
    ALIGNAS = "_Alignas", ALIGNOF = "_Alignof", ATOMIC = "_Atomic", BOOL = "_Bool", COMPLEX = "_Complex",
    GENERIC = "_Generic", IMAGINARY = "_Imaginary", NORETURN = "_Noreturn",
    STATIC_ASSERT = "_Static_assert", THREAD_LOCAL = "_Thread_local",
    // Keywords of GNU C.
    ASM = "asm", ASM_ = "__asm", ASM__ = "__asm__", ATTRIBUTE = "__attribute", ATTRIBUTE__ = "__attribute__",
    ALIGNOF_ = "__alignof", ALIGNOF__ = "__alignof__", CONST_ = "__const", CONST__ = "__const__",
    EXTENSION = "__extension__", INLINE_ = "__inline", INLINE__ = "__inline__", RESTRICT_ = "__restrict",
    RESTRICT__ = "__restrict__", SIGNED_ = "__signed", SIGNED__ = "__signed__", TYPEOF = "typeof",
    TYPEOF_ = "__typeof", TYPEOF__ = "__typeof__", VOLATILE_ = "__volatile", VOLATILE__ = "__volatile__",
    BUILTIN_OFFSETOF = "__builtin_offsetof", BUILTIN_VA_START = "__builtin_va_start",
    BUILTIN_VA_ARG = "__builtin_va_arg", BUILTIN_VA_END = "__builtin_va_end",
    BUILTIN_VA_COPY = "__builtin_va_copy", BUILTIN_VA_LIST = "__builtin_va_list",
    FUNC = "__func__", FUNCTION = "__FUNCTION__",
    // Names with a meaning that a program may take away by declaring them.
    OFFSETOF = "offsetof", VA_START = "va_start", VA_ARG = "va_arg", VA_END = "va_end", VA_COPY = "va_copy",
    VA_LIST = "va_list", STATIC_ASSERT_MACRO = "static_assert",
    // Attributes with an effect here.
    ALIGNED = "aligned", ALIGNED__ = "__aligned__",
    // Directives and names of the preprocessor.
    DEFINE = "define", UNDEF = "undef", INCLUDE = "include", IFDEF = "ifdef", IFNDEF = "ifndef",
    ELIF = "elif", ENDIF = "endif", ERROR = "error", WARNING = "warning", PRAGMA = "pragma", LINE = "line",
    DEFINED = "defined", VA_ARGS = "__VA_ARGS__", VA_OPT = "__VA_OPT__", ONCE = "once", TI_COMPILER = "TI_COMPILER",
    MACRO_FILE = "__FILE__", MACRO_LINE = "__LINE__", MACRO_COUNTER = "__COUNTER__",
    MAIN = "main",
}

impl Name {
    /// Reports whether the word is a keyword of C11 or GNU C, which a program cannot declare.
    #[must_use]
    pub const fn is_keyword(self) -> bool {
        self.0 <= word::FUNCTION.0
    }
}

/// Room for the names of a usual program; a power of two.
const USUAL_NAMES: usize = 1024;

/// Every identifier of a compilation, each once.
#[derive(Clone, Debug)]
pub struct Names {
    /// All spellings, one after another.
    text: String,
    /// The end of each spelling in `text`.
    ends: Vec<usize>,
    /// Number + 1 of the name in each slot, 0 for an empty one; the size is a power of two.
    slots: Vec<u32>,
    /// Names of macros with parameters, past and present.
    function_macros: BTreeSet<Name>,
}

impl Default for Names {
    fn default() -> Self {
        Self::new()
    }
}

impl Names {
    /// Makes a table that contains only the predefined words.
    #[must_use]
    pub fn new() -> Self {
        let mut names = Self {
            text: String::with_capacity(USUAL_NAMES * 16),
            ends: Vec::with_capacity(USUAL_NAMES),
            slots: vec![0; 2 * USUAL_NAMES],
            function_macros: BTreeSet::new(),
        };
        for spelling in WORDS {
            names.intern(spelling);
        }
        names
    }

    /// The number of a spelling, new if it was not seen before.
    pub fn intern(&mut self, spelling: &str) -> Name {
        let slot = self.slot_of(spelling.as_bytes(), SpellingHash::of(spelling.as_bytes()));
        self.name_in(slot).unwrap_or_else(|| self.add(spelling, slot))
    }

    /// The number of a spelling whose hash was computed while it was read; `None` if it is not UTF-8.
    pub fn intern_hashed(&mut self, spelling: &[u8], hash: SpellingHash) -> Option<Name> {
        let slot = self.slot_of(spelling, hash);
        match self.name_in(slot) {
            Some(name) => Some(name),
            None => Some(self.add(std::str::from_utf8(spelling).ok()?, slot)),
        }
    }

    /// The number of a spelling that was seen before.
    #[must_use]
    pub fn find(&self, spelling: &str) -> Option<Name> {
        let spelling = spelling.as_bytes();
        self.name_in(self.slot_of(spelling, SpellingHash::of(spelling)))
    }

    /// The spelling of a name.
    #[must_use]
    pub fn get(&self, name: Name) -> &str {
        let index = name.index();
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.text[start..self.ends[index]]
    }

    /// Notes that a macro with parameters has this name, so that it is only expanded before `(`.
    pub fn mark_function_macro(&mut self, name: Name) {
        self.function_macros.insert(name);
    }

    /// Reports whether a macro with parameters has this name.
    #[must_use]
    pub fn is_function_macro(&self, name: Name) -> bool {
        self.function_macros.contains(&name)
    }

    /// Number of names; their indexes are lower.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Always false: the predefined words are always present.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The name in a slot; `None` if it is empty.
    fn name_in(&self, slot: usize) -> Option<Name> {
        self.slots[slot].checked_sub(1).map(Name)
    }

    /// The slot that holds `spelling`, or the empty slot where it belongs.
    fn slot_of(&self, spelling: &[u8], hash: SpellingHash) -> usize {
        let mask = self.slots.len() - 1;
        let mut slot = hash.finish() as usize & mask;
        while let Some(name) = self.name_in(slot) {
            if self.get(name).as_bytes() == spelling {
                break;
            }
            slot = (slot + 1) & mask;
        }
        slot
    }

    /// Adds a spelling that was not seen before, in the slot where it belongs.
    fn add(&mut self, spelling: &str, slot: usize) -> Name {
        let name = Name::new(self.ends.len());
        self.text.push_str(spelling);
        self.ends.push(self.text.len());
        self.slots[slot] = name.0 + 1;
        if self.ends.len() * 2 > self.slots.len() {
            self.grow();
        }
        name
    }

    fn grow(&mut self) {
        self.slots = vec![0; self.slots.len() * 2];
        for index in 0..self.ends.len() {
            let name = Name::new(index);
            let spelling = self.get(name).as_bytes();
            let slot = self.slot_of(spelling, SpellingHash::of(spelling));
            self.slots[slot] = name.0 + 1;
        }
    }
}

/// Reports whether a byte can continue an identifier.
#[must_use]
pub const fn is_name_byte(byte: u8) -> bool {
    const NAME_BYTES: [bool; 256] = {
        let mut table = [false; 256];
        let mut byte = 0;
        while byte < 128 {
            table[byte as usize] = (byte as u8).is_ascii_alphanumeric() || byte as u8 == b'_';
            byte += 1;
        }
        table
    };
    NAME_BYTES[byte as usize]
}

/// The FNV-1a hash of a spelling, which the lexer computes while it searches for the end of the spelling.
#[derive(Clone, Copy, Debug)]
pub struct SpellingHash(u64);

impl SpellingHash {
    /// The hash of no bytes.
    pub const START: Self = Self(0xcbf2_9ce4_8422_2325);

    /// The hash of a spelling.
    #[must_use]
    pub fn of(spelling: &[u8]) -> Self {
        spelling.iter().fold(Self::START, |hash, byte| hash.with(*byte))
    }

    /// The hash with one more byte.
    #[must_use]
    pub const fn with(self, byte: u8) -> Self {
        Self((self.0 ^ byte as u64).wrapping_mul(0x100_0000_01b3))
    }

    /// The number that chooses a slot: its low bits depend on all others.
    #[must_use]
    pub const fn finish(self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_words_have_fixed_numbers() {
        let mut names = Names::new();
        assert_eq!(names.intern("auto"), word::AUTO);
        assert_eq!(names.find("main"), Some(word::MAIN));
        assert_eq!(names.get(word::STATIC_ASSERT), "_Static_assert");
        assert!(word::FUNCTION.is_keyword() && !word::OFFSETOF.is_keyword());
    }

    #[test]
    fn names_survive_the_growth_of_the_table() {
        let mut names = Names::new();
        let many: Vec<_> = (0..5000).map(|number| names.intern(&format!("n{number}"))).collect();
        for (number, name) in many.iter().enumerate() {
            assert_eq!(names.get(*name), format!("n{number}"));
            assert_eq!(names.find(&format!("n{number}")), Some(*name));
        }
        assert_eq!(names.find("unseen"), None);
    }
}
