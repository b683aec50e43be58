//! `x`: memory, in the form of gdb.

use std::fmt::Write as _;

use cc67_host::Target;
use compiler::debug::NumberFormat;
use kmotiondef::GuestAddr;

use super::Shell;
use crate::debugger::{DebugError, Debugger};

/// The number of bytes per line, except for single bytes.
const LINE: u32 = 16;
/// The maximum number of units that one command shows.
const MOST: u32 = 4096;
/// The maximum number of characters of a string.
const CHARACTERS: u32 = 200;

/// The form in which memory is shown, and the address at which the next command continues.
#[derive(Clone, Copy, Debug)]
pub(super) struct MemoryForm {
    letter: char,
    size: u32,
    next: Option<u32>,
}

impl Default for MemoryForm {
    fn default() -> Self {
        Self { letter: 'x', size: 4, next: None }
    }
}

/// The part of the command after the slash: count, size and format.
struct MemoryRequest {
    count: u32,
    form: MemoryForm,
}

impl MemoryRequest {
    fn of(format: &str, last: MemoryForm) -> Result<Self, DebugError> {
        let digits: String = format.chars().take_while(char::is_ascii_digit).collect();
        let mut request = Self { count: digits.parse().unwrap_or(1).min(MOST), form: last };
        let mut has_size = false;
        for letter in format[digits.len()..].chars() {
            match letter {
                'b' => request.form.size = 1,
                'h' => request.form.size = 2,
                'w' => request.form.size = 4,
                'g' => request.form.size = 8,
                'i' => request.form.letter = 'i',
                _ if NumberFormat::from_letter(letter).is_some() => request.form.letter = letter,
                _ => return Err(format!("Undefined output format \"{letter}\".").into()),
            }
            has_size |= "bhwg".contains(letter);
        }
        match request.form.letter {
            'c' | 's' if !has_size => request.form.size = 1,
            'a' => request.form.size = 4,
            'f' if request.form.size < 4 => request.form.size = 8,
            _ if request.form.size == 1 && !has_size && "cs".contains(last.letter) => request.form.size = 4,
            _ => {}
        }
        Ok(request)
    }
}

impl<T: Target> Shell<T> {
    /// `x/NFU EXPRESSION`; without an expression, the memory after the part that was shown last.
    pub(super) fn memory(&mut self, format: &str, expression: &str) -> Result<String, DebugError> {
        let MemoryRequest { count, mut form } = MemoryRequest::of(format, self.memory_form)?;
        let address = match expression {
            "" => form.next.ok_or("Argument required (starting display address).")?,
            _ => self.address_of(expression)?,
        };
        let text = match form.letter {
            'i' => {
                let (text, next) = self.code(address, count);
                form.next = Some(next);
                text
            }
            's' => {
                let (text, next) = self.strings(address, count)?;
                form.next = Some(next);
                text
            }
            _ => {
                form.next = Some(address.wrapping_add(count * form.size));
                self.units(address, count, form)?
            }
        };
        self.memory_form = form;
        Ok(text)
    }

    /// The address for an expression: the address of an array or a function, otherwise its value.
    fn address_of(&mut self, expression: &str) -> Result<u32, DebugError> {
        let replaced = self.replaced(expression)?;
        let value = self.debugger.evaluate(&replaced)?;
        let is_place = value.ty.ends_with(']') || value.ty.ends_with(')') && !value.ty.contains("(*)");
        match value.address.filter(|_| is_place) {
            Some(address) => Ok(address),
            None => Ok(self.debugger.number(&replaced)? as i64 as u32),
        }
    }

    fn units(&self, address: u32, count: u32, form: MemoryForm) -> Result<String, DebugError> {
        let MemoryForm { letter, size, .. } = form;
        let number = NumberFormat::from_letter(letter).unwrap_or(NumberFormat::Hexadecimal);
        let row = if size == 1 || size == 2 { 8 } else { LINE / size };
        let symbol = |at: GuestAddr| symbol_at(&self.debugger, at.get());
        let mut out = String::new();
        for index in 0..count {
            let at = address.wrapping_add(index * size);
            if index % row == 0 {
                let _ =
                    write!(out, "{}{}:", if index == 0 { "" } else { "\n" }, labelled(&self.debugger, at));
            }
            self.must_be_mapped(at)?;
            let mut bytes = [0; 8];
            bytes[..size as usize].copy_from_slice(&self.debugger.bytes(at, size));
            let bits = u64::from_le_bytes(bytes);
            let text = match number {
                // All units of a column have the same width.
                NumberFormat::Hexadecimal => NumberFormat::Padded.text(bits, size, &symbol),
                NumberFormat::Binary => format!("{bits:0width$b}", width = 8 * size as usize),
                other => other.text(bits, size, &symbol),
            };
            let _ = write!(out, "\t{text}");
        }
        Ok(out + "\n")
    }

    fn strings(&self, address: u32, count: u32) -> Result<(String, u32), DebugError> {
        let mut at = address;
        let mut out = String::new();
        for _ in 0..count {
            self.must_be_mapped(at)?;
            let shown = self.debugger.evaluate(&format!("(char *){at:#x}"))?;
            let text =
                shown.text.split_once('"').map_or_else(|| "\"\"".to_owned(), |(_, rest)| format!("\"{rest}"));
            let _ = writeln!(out, "{}:\t{text}", labelled(&self.debugger, at));
            let bytes = self.debugger.bytes(at, CHARACTERS);
            at = at.wrapping_add(bytes.iter().take_while(|byte| **byte != 0).count() as u32 + 1);
        }
        Ok((out, at))
    }

    fn must_be_mapped(&self, address: u32) -> Result<(), DebugError> {
        let is_mapped = self.debugger.session().target().is_mapped(GuestAddr::new(address));
        if is_mapped { Ok(()) } else { Err(format!("Cannot access memory at address {address:#x}").into()) }
    }

    fn code(&self, address: u32, count: u32) -> (String, u32) {
        let lines: Vec<_> = disassembly(&self.debugger, address, u32::MAX).take(count as usize + 1).collect();
        let next = lines.get(count as usize).map_or(address, |(at, _)| *at);
        (self.instructions(address, count, u32::MAX), next)
    }

    /// The instructions between two addresses, at most `count` of them.
    pub(super) fn instructions(&self, address: u32, count: u32, end: u32) -> String {
        let mut out = String::new();
        let here = self
            .debugger
            .frames(self.debugger.context())
            .get(self.debugger.frame())
            .map(|frame| frame.address.get());
        for (at, text) in disassembly(&self.debugger, address, end).take(count as usize) {
            let mark = if here == Some(at) { "=>" } else { "  " };
            let _ = writeln!(out, "{mark} {}:\t{text}", labelled(&self.debugger, at));
        }
        out
    }
}

/// An address with the symbol at it.
fn labelled<T: Target>(debugger: &Debugger<T>, address: u32) -> String {
    match symbol_at(debugger, address) {
        Some(name) => format!("{address:#x} <{name}>"),
        None => format!("{address:#x}"),
    }
}

fn symbol_at<T: Target>(debugger: &Debugger<T>, address: u32) -> Option<String> {
    debugger.programs().all().find_map(|(_, model)| model.symbol_at(address))
}

/// The instructions between two addresses, each with its address.
fn disassembly<T: Target>(
    debugger: &Debugger<T>,
    address: u32,
    end: u32,
) -> impl Iterator<Item = (u32, String)> {
    let mut at = address & !3;
    std::iter::from_fn(move || {
        let (text, size) = debugger.session().target().disassemble(at).filter(|_| at < end)?;
        let line = (at, text);
        at = at.checked_add(size)?;
        Some(line)
    })
}
