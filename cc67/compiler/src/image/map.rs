//! The map of a linked program: all addresses, and the largest items.

use std::cmp::Reverse;
use std::fmt::{self, Write};

use crate::link::{LinkedProgram, LinkedSymbol, Section};
use crate::typed::Linkage;

/// The number of the largest symbols that are listed.
const LARGEST: usize = 10;

/// The map as text.
#[must_use]
pub fn render(linked: &LinkedProgram) -> String {
    let mut out = String::new();
    let written = write(&mut out, linked);
    debug_assert!(written.is_ok(), "writing to a string cannot fail");
    out
}

fn write(out: &mut String, linked: &LinkedProgram) -> fmt::Result {
    writeln!(out, "program for thread {}, entry {}\n", linked.thread, linked.entry)?;
    writeln!(out, "section  address     bytes")?;
    for (name, address, size) in [
        (".text", linked.text.address, linked.text.bytes.len()),
        (".data", linked.data.address, linked.data.bytes.len()),
        (".bss", linked.bss.address, linked.bss.size as usize),
    ] {
        writeln!(out, "{name:8} {:08x} {size:8}", address.get())?;
    }
    for section in [Section::Text, Section::Data, Section::Bss] {
        let mut symbols = linked.symbols.iter().filter(|symbol| symbol.section == section).peekable();
        if symbols.peek().is_some() {
            writeln!(out, "\n{}", title(section))?;
        }
        symbols.try_for_each(|symbol| write_symbol(out, linked, symbol))?;
    }
    if !linked.firmware.imports.is_empty() {
        writeln!(out, "\nof the firmware")?;
    }
    for import in &linked.firmware.imports {
        writeln!(out, "{:08x}          {}", import.address.get(), import.name)?;
    }
    let mut largest: Vec<_> = linked.symbols.iter().collect();
    largest.sort_by_key(|symbol| Reverse(symbol.size));
    writeln!(out, "\nlargest")?;
    largest.into_iter().take(LARGEST).try_for_each(|symbol| write_symbol(out, linked, symbol))
}

const fn title(section: Section) -> &'static str {
    match section {
        Section::Text => "functions",
        Section::Data => "initialised objects",
        Section::Bss => "uninitialised objects",
    }
}

fn write_symbol(out: &mut String, linked: &LinkedProgram, symbol: &LinkedSymbol) -> fmt::Result {
    let file = linked.files.get(symbol.place.file as usize).map_or("?", String::as_str);
    let linkage = if symbol.linkage == Linkage::Internal { " (static)" } else { "" };
    writeln!(
        out,
        "{:08x} {:8} {}{linkage} {file}:{}",
        symbol.address.get(),
        symbol.size,
        symbol.name,
        symbol.place.line
    )
}
