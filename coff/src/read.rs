//! Conversion of bytes to an image: a copy of the data that [`File`] has checked.

use crate::budget::{NAME_SHARING, length, spend};
use crate::elf;
use crate::error::{Error, Part};
use crate::file::{File, SectionView, SymbolView};
use crate::image::{Container, Contents, Image, Name, Section, Symbol};
use crate::raw;

impl Image {
    /// Reads an image: TI COFF2, or a linked ELF program.
    ///
    /// # Errors
    /// The bytes are neither of them, or are incomplete.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        if bytes.starts_with(elf::MAGIC) {
            return elf::read(bytes);
        }
        let file = File::parse(bytes)?;
        let mut reader = Reader::new(bytes);
        let sections = file.sections().zip(1..).map(|(section, number)| reader.section(&section?, number));
        let sections = sections.collect::<Result<_, _>>()?;
        let symbols = file.symbols().map(|symbol| reader.symbol(&symbol?)).collect::<Result<_, _>>()?;
        Ok(Self {
            container: Container::Coff,
            target: file.target(),
            timestamp: file.timestamp(),
            flags: file.flags(),
            program: file.program(),
            sections,
            symbols,
        })
    }
}

/// The remaining work for reading, bounded by the size of the file.
struct Reader {
    data_left: u64,
    relocations_left: u64,
    lines_left: u64,
    names_left: u64,
}

impl Reader {
    fn new(bytes: &[u8]) -> Self {
        let size = length(bytes.len());
        Self {
            data_left: size,
            relocations_left: size,
            lines_left: size,
            names_left: size.saturating_mul(NAME_SHARING),
        }
    }

    fn section(&mut self, section: &SectionView<'_>, number: usize) -> Result<Section, Error> {
        let header = section.header();
        let contents = match section.data() {
            Some(data) => {
                let at = u64::from(header.data_at.get());
                spend(&mut self.data_left, length(data.len()), at, Part::Data(number))?;
                Contents::Data(data.to_vec())
            }
            None => Contents::Uninitialised(header.size.get()),
        };
        let relocations = section.relocations();
        let at = u64::from(header.relocations_at.get());
        let size = length(relocations.len() * size_of::<raw::Relocation>());
        spend(&mut self.relocations_left, size, at, Part::Relocations(number))?;
        let lines = section.lines();
        let at = u64::from(header.lines_at.get());
        let size = length(lines.len() * size_of::<raw::Line>());
        spend(&mut self.lines_left, size, at, Part::Lines(number))?;
        Ok(Section {
            name: self.name(section.name, section.offset())?,
            physical: header.physical.get(),
            address: header.address.get(),
            flags: section.flags(),
            page: header.page.get(),
            contents,
            relocations: relocations.collect(),
            lines: lines.collect(),
        })
    }

    fn symbol(&mut self, symbol: &SymbolView<'_>) -> Result<Symbol, Error> {
        Ok(Symbol {
            name: self.name(symbol.name, symbol.at)?,
            value: symbol.value(),
            section: symbol.section(),
            ty: symbol.ty(),
            class: symbol.class(),
            aux: symbol.aux.to_vec(),
        })
    }

    fn name(&mut self, name: &[u8], at: u64) -> Result<Name, Error> {
        // A name that fits in its field does not use the string table.
        if name.len() > size_of::<raw::ShortName>() {
            spend(&mut self.names_left, length(name.len()), at, Part::Names)?;
        }
        Ok(Name::new(name))
    }
}
