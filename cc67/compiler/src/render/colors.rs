//! The colours of a diagnostic, as escape sequences of ANSI.
//!
//! The renderer is independent of the terminal: the caller that prints the text decides whether it is coloured.

use std::io::{Result, Write};

use codespan_reporting::diagnostic::{LabelStyle, Severity};
use codespan_reporting::term::WriteStyle;

/// Text with its colours.
#[derive(Debug, Default)]
pub(super) struct ColoredText(Vec<u8>);

/// A colour of the sixteen that every terminal has, by its number among the first eight.
#[derive(Clone, Copy)]
enum Hue {
    Red = 1,
    Green = 2,
    Yellow = 3,
    Cyan = 6,
}

/// The colour of marks around the primary range: line numbers, borders, further ranges.
const ASIDE: Hue = Hue::Cyan;

impl ColoredText {
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    fn set(&mut self, hue: Hue) -> Result<()> {
        write!(self.0, "\x1B[0m\x1B[3{}m", hue as u8)
    }

    fn set_bright(&mut self, hue: Hue) -> Result<()> {
        write!(self.0, "\x1B[0m\x1B[1m\x1B[38;5;{}m", hue as u8 + 8)
    }
}

impl Write for ColoredText {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl WriteStyle for ColoredText {
    fn set_header(&mut self, severity: Severity) -> Result<()> {
        self.set_bright(hue(severity))
    }

    fn set_header_message(&mut self) -> Result<()> {
        self.0.write_all(b"\x1B[0m\x1B[1m")
    }

    fn set_line_number(&mut self) -> Result<()> {
        self.set(ASIDE)
    }

    fn set_note_bullet(&mut self) -> Result<()> {
        self.set(ASIDE)
    }

    fn set_source_border(&mut self) -> Result<()> {
        self.set(ASIDE)
    }

    fn set_label(&mut self, severity: Severity, style: LabelStyle) -> Result<()> {
        match style {
            LabelStyle::Primary => self.set(hue(severity)),
            LabelStyle::Secondary => self.set(ASIDE),
        }
    }

    fn reset(&mut self) -> Result<()> {
        self.0.write_all(b"\x1B[0m")
    }
}

/// The colour of a severity.
const fn hue(severity: Severity) -> Hue {
    match severity {
        Severity::Bug | Severity::Error => Hue::Red,
        Severity::Warning => Hue::Yellow,
        Severity::Note => Hue::Green,
        Severity::Help => Hue::Cyan,
    }
}
