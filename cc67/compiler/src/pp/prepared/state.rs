//! The progress in reading the prepared texts in one compilation.

use crate::source::FileId;

use super::super::{Headers, HeadersRead};
use super::index::TEXTS;

/// The texts in one compilation.
#[derive(Debug)]
pub(in crate::pp) struct PreparedState {
    /// The files that were opened.
    pub(super) files: [Option<FileId>; TEXTS.len()],
    pub(super) headers: HeaderState,
    /// True while a declaration is read, in which macros of the program have no effect.
    pub(super) in_declaration: bool,
}

/// The mode in which the headers are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeaderState {
    /// As any other file.
    Whole,
    /// As needed, once they are included.
    AsNeeded,
    /// As needed; the program has just included them.
    Begun,
    /// As needed; the declarations come before the token with this number.
    Included(usize),
    /// As needed, which was wrong.
    Wrong,
}

impl PreparedState {
    pub(in crate::pp) fn new(headers: Headers) -> Self {
        let headers = match headers {
            Headers::Whole => HeaderState::Whole,
            Headers::AsNeeded => HeaderState::AsNeeded,
        };
        Self { files: [None; TEXTS.len()], headers, in_declaration: false }
    }

    /// The part of the headers that was read.
    pub(in crate::pp) fn read(&self) -> HeadersRead {
        match self.headers {
            HeaderState::Whole | HeaderState::AsNeeded => HeadersRead::Whole,
            HeaderState::Begun | HeaderState::Included(_) => HeadersRead::Partly,
            HeaderState::Wrong => HeadersRead::TooLittle,
        }
    }

    /// Records the position of the headers' tokens, if the program has just included them.
    pub(in crate::pp) fn take_place(&mut self, tokens: usize) {
        if self.headers == HeaderState::Begun {
            self.headers = HeaderState::Included(tokens);
        }
    }
}
