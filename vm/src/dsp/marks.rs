//! Lines of RAM that translated code must not store to: the interpreter performs these stores and checks the line.

use std::ops::Range;

use kmotiondef::map::{IRAM, SDRAM};

use crate::native::{LINES, MARK_BITS, Marks};
use crate::protection::Texts;

/// Words of the line were decoded.
const CODE: u8 = 1;
/// Some of the line is protected.
const PROTECTED: u8 = 2;

/// A mark for each line of both RAMs; allocated when something is translated for the first time.
#[derive(Debug, Default)]
pub(super) struct LineMarks {
    marks: Option<Box<Marks>>,
    /// The protected ranges that are marked.
    texts: Texts,
}

impl LineMarks {
    /// Allocates the marks; returns whether there were none.
    pub(super) fn begin(&mut self) -> bool {
        if self.marks.is_some() {
            return false;
        }
        // Through a vector, because an array of this size must not pass over the stack.
        self.marks = vec![0; LINES].into_boxed_slice().try_into().ok();
        self.texts = Texts::default();
        true
    }

    /// Marks the line of a decoded word.
    pub(super) fn mark_code(&mut self, at: u32) {
        if let (Some(marks), Some(line)) = (&mut self.marks, line(at)) {
            marks[line] |= CODE;
        }
    }

    /// The marks, for these protected ranges.
    #[inline]
    pub(super) fn follow(&mut self, texts: &Texts) -> Option<&Marks> {
        if self.texts != *texts {
            self.redraw(texts);
        }
        self.marks.as_deref()
    }

    #[cold]
    fn redraw(&mut self, texts: &Texts) {
        let Some(marks) = &mut self.marks else { return };
        let lines = |text: &Range<u32>| {
            text.clone().step_by(1 << MARK_BITS).chain(text.clone().last()).filter_map(line)
        };
        self.texts.iter().flat_map(lines).for_each(|line| marks[line] &= !PROTECTED);
        texts.iter().flat_map(lines).for_each(|line| marks[line] |= PROTECTED);
        self.texts.clone_from(texts);
    }
}

/// The number of the line of an address.
const fn line(at: u32) -> Option<usize> {
    let (sdram, iram) = (at.wrapping_sub(SDRAM.base.get()), at.wrapping_sub(IRAM.base.get()));
    if sdram < SDRAM.size {
        Some((sdram >> MARK_BITS) as usize)
    } else if iram < IRAM.size {
        Some(((SDRAM.size + iram) >> MARK_BITS) as usize)
    } else {
        None
    }
}
