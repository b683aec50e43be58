//! The line table of an image as file, line and function.

use std::fmt::Write as _;

use coff::{Image, Line, Target};

use super::Inspection;
use super::symbols::{Entry, EntryKind};

/// The start of a source line in the code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceLine {
    /// The address.
    pub address: u32,
    /// The line.
    pub line: u32,
    /// The file; `None` if the image does not have it.
    pub file: Option<String>,
    /// The function.
    pub function: Option<String>,
}

/// The lines of all sections, by address.
pub(super) fn collect(image: &Image, symbols: &[Entry]) -> Vec<SourceLine> {
    let functions: Vec<_> = symbols.iter().filter(|entry| is_function(image, entry)).collect();
    let mut lines = Vec::new();
    let is_vendors = image.target == Target::C6000 && has_no_parallel(image);
    for section in &image.sections {
        let mut position = 0;
        for entry in &section.lines {
            let Line::Statement { address, line } = entry else {
                position = 0;
                continue;
            };
            position += 1;
            let after = functions.partition_point(|function| function.address <= *address);
            let function = after.checked_sub(1).and_then(|index| functions.get(index));
            lines.push(SourceLine {
                address: *address,
                line: statement_line(is_vendors, position, u32::from(line.get())),
                file: function.and_then(|function| function.file.clone()),
                function: function.map(|function| function.name.clone()),
            });
        }
    }
    lines.sort_by_key(|line| line.address);
    lines
}

/// In images of the vendor's compiler static functions are labels like any others, but have names.
fn is_function(image: &Image, entry: &Entry) -> bool {
    let is_static =
        || image.target == Target::C6000 && entry.section == ".text" && !entry.name.starts_with("L.");
    entry.kind == EntryKind::Function || (entry.kind == EntryKind::Label && is_static())
}

/// The vendor's compiler pairs every address but a function's first with the line after the
/// statement (`coff.md` section 5 of the specification).
const fn statement_line(is_vendors: bool, position: usize, line: u32) -> u32 {
    if is_vendors && position > 1 { line.saturating_sub(1) } else { line }
}

impl Inspection {
    /// The line of the code at `address`.
    #[must_use]
    pub fn line_at(&self, address: u32) -> Option<&SourceLine> {
        let after = self.lines.partition_point(|line| line.address <= address);
        self.lines.get(after.checked_sub(1)?)
    }

    /// The lines as a table.
    #[must_use]
    pub fn line_table(&self) -> String {
        if self.lines.is_empty() {
            return "no line numbers\n".to_owned();
        }
        let mut out = String::new();
        let mut function = None;
        for line in &self.lines {
            if function != Some(&line.function) {
                function = Some(&line.function);
                let name = line.function.as_deref().unwrap_or("?");
                // Writing to a string cannot fail.
                let _ = writeln!(out, "{name} in {}", line.file.as_deref().unwrap_or("?"));
            }
            let _ = writeln!(out, "  {:08x} line {}", line.address, line.line);
        }
        out
    }
}

/// Reports whether no instruction executes in parallel with another, as in all code of the vendor's compiler; ours pads
/// packets with parallel instructions even without optimisation.
fn has_no_parallel(image: &Image) -> bool {
    let words = image.section(".text").map(|text| text.data().as_chunks::<4>().0).unwrap_or_default();
    words.iter().all(|word| u32::from_le_bytes(*word) & c67x::PARALLEL == 0)
}
