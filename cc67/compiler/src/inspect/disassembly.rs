//! The code with the source lines from which it was compiled.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use kmotiondef::variables::FIRMWARE_VARIABLES;
use vm::program::Program;

use super::Inspection;
use super::calls::firmware_name;
use crate::bytecode::references::{Reference, reference};

/// The provider of the text of source files; images contain their names without folders.
pub trait Sources {
    /// The text of the file with this name, if it is found.
    fn text(&self, name: &str) -> Option<String>;
}

impl Inspection {
    /// The instructions of every function, or of the one called `only`.
    #[must_use]
    pub fn disassembly(&self, sources: &dyn Sources, only: Option<&str>) -> String {
        if self.image.target == coff::Target::C6000 {
            return self.assembly(sources, only);
        }
        let program = match &self.program {
            Ok(program) => program,
            Err(reason) => return format!("no disassembly: {reason}\n"),
        };
        let mut printer =
            CodePrinter { inspection: self, program, sources, files: BTreeMap::new(), out: String::new() };
        for function in program.functions() {
            let start = function.at.0 as usize;
            let name = self.function_name(program.address_of(start).get()).unwrap_or("?");
            if only.is_none_or(|only| only == name) {
                printer.function(name, start..function.body.end);
            }
        }
        printer.out
    }
}

struct CodePrinter<'a> {
    inspection: &'a Inspection,
    program: &'a Program,
    sources: &'a dyn Sources,
    /// The lines of each file used so far; `None` if the file is not found.
    files: BTreeMap<String, Vec<String>>,
    out: String,
}

impl CodePrinter<'_> {
    fn function(&mut self, name: &str, words: std::ops::Range<usize>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.out, "{name}:");
        let mut last = None;
        for word in words {
            let Some(op) = self.program.ops().get(word) else { break };
            let address = self.program.address_of(word).get();
            let line = self.inspection.line_at(address).map(|line| (line.file.clone(), line.line));
            if line != last {
                self.source(line.as_ref());
                last = line;
            }
            let note = self.annotate(word, || op.to_string());
            let separator = if note.is_empty() { "" } else { "  ; " };
            let _ = writeln!(self.out, "  {address:08x} @{word}: {op}{separator}{note}");
        }
        self.out.push('\n');
    }

    /// A line of the source, or only its position if the file is not found.
    fn source(&mut self, line: Option<&(Option<String>, u32)>) {
        let Some((file, line)) = line else { return };
        let file = file.as_deref().unwrap_or("?");
        if !self.files.contains_key(file) {
            let text = self.sources.text(file).unwrap_or_default();
            self.files.insert(file.to_owned(), text.lines().map(str::to_owned).collect());
        }
        let lines = self.files.get(file).map_or(&[][..], Vec::as_slice);
        let text = (*line as usize).checked_sub(1).and_then(|index| lines.get(index));
        let _ = writeln!(self.out, "{file}:{line}: {}", text.map_or("", |text| text.trim_end()));
    }

    /// Names for the numbers of the instruction with number `word`.
    fn annotate(&self, word: usize, printed: impl FnOnce() -> String) -> String {
        match reference(self.program, word) {
            Reference::Call(address) => self.inspection.function_name(address).unwrap_or_default().to_owned(),
            Reference::Firmware(address) => firmware_name(self.inspection, address),
            Reference::Number(number) => self.object(number),
            Reference::Float(number) => number.to_string(),
            Reference::Single(number) => number.to_string(),
            // Loads and stores print the address that they use.
            Reference::Pointer(_) | Reference::Nothing => {
                printed().rsplit_once(", 0x").map_or_else(String::new, |(_, address)| {
                    u32::from_str_radix(address, 16)
                        .map_or_else(|_| String::new(), |address| self.object(address))
                })
            }
        }
    }

    /// "table+4" for an address of the program or of a firmware variable.
    fn object(&self, address: u32) -> String {
        let variable = || {
            let mut all = FIRMWARE_VARIABLES.iter();
            let found = all.find(|variable| address.wrapping_sub(variable.address.get()) < variable.size)?;
            Some((found.name, found.address.get()))
        };
        let entry = self.inspection.entry_at(address).map(|entry| (entry.name.as_str(), entry.address));
        match entry.or_else(variable) {
            Some((name, start)) if start == address => name.to_owned(),
            Some((name, start)) => format!("{name}+{}", address - start),
            None => String::new(),
        }
    }
}
