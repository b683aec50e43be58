//! A listing of an image, for users and for golden tests.
//!
//! The listing does not depend on the positions of parts in the file, so two images with the same listing load
//! identically.

use std::fmt::{self, Write};

use crate::auxiliary::Auxiliary;
use crate::image::{Container, Contents, Image, Line, Section, Symbol};
use crate::names::SectionNumber;

/// The headers of the file and of its sections.
#[must_use]
pub fn headers(image: &Image) -> String {
    listing(|out| {
        if image.container == Container::Elf {
            write!(out, "ELF, ")?;
        }
        write!(out, "target {}, flags {}", image.target, image.flags)?;
        writeln!(out, ", timestamp {}", image.timestamp)?;
        if let Some(program) = &image.program {
            write!(out, "entry {:08x}, version {:#06x}", program.entry, program.version_stamp)?;
            write!(out, ", text {:#x} at {:08x}", program.text_size, program.text_start)?;
            write!(out, ", data {:#x} at {:08x}", program.data_size, program.data_start)?;
            writeln!(out, ", bss {:#x}", program.bss_size)?;
        }
        writeln!(out, "  # name         physical address  size     flags")?;
        for (number, section) in (1..).zip(&image.sections) {
            write!(out, "{number:3} {:12} {:08x} {:08x}", section.name, section.physical, section.address)?;
            write!(out, " {:08x} {}", section.size(), section.flags)?;
            let kind = match section.contents {
                Contents::Data(_) => "",
                Contents::Uninitialised(_) => ", no data",
            };
            writeln!(out, "{kind}")?;
        }
        Ok(())
    })
}

/// The symbols.
#[must_use]
pub fn symbols(image: &Image) -> String {
    listing(|out| {
        writeln!(out, "index value    section  class  name: type")?;
        let mut index = 0;
        for symbol in &image.symbols {
            let section = section_name(image, symbol.section);
            write!(
                out,
                "{index:5} {:08x} {section:8} {:6} {}: {}",
                symbol.value, symbol.class, symbol.name, symbol.ty
            )?;
            describe_aux(out, symbol)?;
            writeln!(out)?;
            index += 1 + symbol.aux.len();
        }
        Ok(())
    })
}

/// The relocations.
#[must_use]
pub fn relocations(image: &Image) -> String {
    listing(|out| {
        for section in image.sections.iter().filter(|section| !section.relocations.is_empty()) {
            writeln!(out, "relocations of {}", section.name)?;
            for relocation in &section.relocations {
                write!(out, "  {:08x} symbol {}", relocation.address, relocation.symbol)?;
                writeln!(out, " kind {} with {:#x}", relocation.kind, relocation.displacement)?;
            }
        }
        Ok(())
    })
}

/// The line numbers.
#[must_use]
pub fn lines(image: &Image) -> String {
    listing(|out| {
        for section in image.sections.iter().filter(|section| !section.lines.is_empty()) {
            writeln!(out, "lines of {}", section.name)?;
            for line in &section.lines {
                match line {
                    Line::Function(index) => writeln!(out, "  function with symbol {index}")?,
                    Line::Statement { address, line } => writeln!(out, "  {address:08x} line {line}")?,
                }
            }
        }
        Ok(())
    })
}

/// The bytes of a section, sixteen per row.
#[must_use]
pub fn data(section: &Section) -> String {
    listing(|out| {
        let mut address = section.address;
        for row in section.data().chunks(16) {
            write!(out, "{address:08x} ")?;
            for byte in row {
                write!(out, " {byte:02x}")?;
            }
            writeln!(out)?;
            address = address.wrapping_add(16);
        }
        Ok(())
    })
}

/// Collects the output of `write`; writing to a string cannot fail.
fn listing(write: impl FnOnce(&mut String) -> fmt::Result) -> String {
    let mut out = String::new();
    let written = write(&mut out);
    debug_assert!(written.is_ok(), "writing to a string cannot fail");
    out
}

fn section_name(image: &Image, number: SectionNumber) -> String {
    let index = usize::try_from(number.0).ok().and_then(|number| number.checked_sub(1));
    match index.and_then(|index| image.sections.get(index)) {
        Some(section) => section.name.to_string(),
        None => number.to_string(),
    }
}

/// Describes the first auxiliary entry; the vendor's compiler writes one without content.
fn describe_aux(out: &mut String, symbol: &Symbol) -> fmt::Result {
    match symbol.auxiliary() {
        Some(Auxiliary::Function(aux)) => write!(out, ", {:#x} bytes", aux.size.get()),
        Some(Auxiliary::Boundary(aux)) if aux.line.get() > 0 => write!(out, ", line {}", aux.line),
        Some(Auxiliary::Section(aux)) => {
            write!(out, ", {:#x} bytes, {} relocations, {} lines", aux.size.get(), aux.relocations, aux.lines)
        }
        Some(Auxiliary::Tag(aux)) => write!(out, ", {:#x} bytes", aux.size.get()),
        Some(Auxiliary::Array(aux)) => {
            write!(out, ", {:#x} bytes, dimensions", aux.size.get())?;
            aux.dimensions
                .iter()
                .filter(|dimension| dimension.get() > 0)
                .try_for_each(|size| write!(out, " {size}"))
        }
        Some(Auxiliary::Object(aux)) if aux.size.get() > 0 => write!(out, ", {:#x} bytes", aux.size.get()),
        Some(Auxiliary::Boundary(_) | Auxiliary::Object(_)) | None => Ok(()),
    }
}
