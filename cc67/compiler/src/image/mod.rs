//! Writing the image of a linked program: TI COFF2 as in `coff.md` of the specification.
//!
//! Deliberate differences from the vendor's compiler:
//! - the target id of bytecode is our own, and its text begins with words that let a processor return at once, so that
//!   no board executes it, whichever loader is used (design.md D4);
//! - `.bss` has a section header, so that a load clears it;
//! - line entries are plain pairs of address and line (`coff.md` section 5);
//! - the auxiliary entry of an object holds its size in the same field as for a function, so that a trap can report "4
//!   bytes past the end of `table`";
//! - static functions are symbols like others, and only the firmware symbols that the program refers to are listed.

pub mod download;
pub mod map;

/// The error for a program that exceeds the limits of the format.
pub use coff::Error as WriteError;
use coff::raw::{BoundaryAux, FunctionAux};
use coff::{
    Aux, BaseType, Container, Contents, Derivation, Error, FileFlags, Image, Layout, Line, Name, Program,
    SectionFlags, SectionNumber, StorageClass, Symbol, SymbolType, Target,
};
use kmotiondef::GuestAddr;

use crate::link::{LinkedFunction, LinkedProgram, LinkedSymbol, Section};
use crate::object::{base_type, class, function_type, statement, to_u16, whole_lines};

/// Writes the image of a program.
///
/// # Errors
/// The program exceeds the limits of the format.
pub fn write(linked: &LinkedProgram) -> Result<Vec<u8>, Error> {
    write_as(Container::Coff, linked)
}

/// Writes the program in the given file format; ELF files have no line numbers.
///
/// # Errors
/// The program exceeds the limits of the format.
pub fn write_as(container: Container, linked: &LinkedProgram) -> Result<Vec<u8>, Error> {
    let mut image = Image { container, ..image_without_symbols(linked) };
    let mut table = SymbolTable::default();
    table.functions(linked);
    table.objects(linked);
    table.markers(linked);
    image.symbols = table.symbols;
    if container == Container::Elf {
        return image.write();
    }
    if let Some(text) = image.sections.first_mut() {
        text.lines = table.lines;
    }
    // The file offsets of each function's lines are only known now.
    let layout = Layout::of(&image)?;
    for (symbol, first_line) in table.first_lines {
        let at = layout.line_offset(0, first_line).unwrap_or(0);
        if let Some(aux) = image.symbols.get_mut(symbol).and_then(|symbol| symbol.aux.first_mut()) {
            *aux = Aux::new(&FunctionAux { lines_at: at.into(), ..aux.as_function() });
        }
    }
    image.write()
}

/// Writes the image of a program without symbols and line numbers, as the vendor's compiler does
/// unless they are requested.
///
/// # Errors
/// The program exceeds the limits of the format.
pub fn write_stripped(linked: &LinkedProgram) -> Result<Vec<u8>, Error> {
    image_without_symbols(linked).write()
}

/// The image without symbols and line numbers.
fn image_without_symbols(linked: &LinkedProgram) -> Image {
    Image {
        container: Container::Coff,
        target: match linked.target {
            crate::target::Target::Sim => Target::CC67,
            crate::target::Target::C67x => Target::C6000,
        },
        timestamp: linked.firmware.time_stamp,
        flags: FileFlags::LINKED,
        program: Some(header(linked)),
        sections: sections(linked),
        symbols: Vec::new(),
    }
}

fn header(linked: &LinkedProgram) -> Program {
    Program {
        version_stamp: linked.firmware.version_stamp,
        text_size: linked.text.bytes.len() as u32,
        data_size: linked.data.bytes.len() as u32,
        bss_size: linked.bss.size,
        entry: linked.entry.get(),
        text_start: linked.text.address.get(),
        data_start: linked.data.address.get(),
    }
}

fn sections(linked: &LinkedProgram) -> Vec<coff::Section> {
    let section = |name: &str, address: GuestAddr, flags, contents| coff::Section {
        name: Name::from(name),
        physical: address.get(),
        address: address.get(),
        flags,
        page: 0,
        contents,
        relocations: Vec::new(),
        lines: Vec::new(),
    };
    let text_flags = (SectionFlags::TEXT | SectionFlags::DATA).with_align(32);
    vec![
        section(".text", linked.text.address, text_flags, Contents::Data(linked.text.bytes.clone())),
        section(".data", linked.data.address, SectionFlags::DATA, Contents::Data(linked.data.bytes.clone())),
        section(".bss", linked.bss.address, SectionFlags::BSS, Contents::Uninitialised(linked.bss.size)),
    ]
}

/// The symbol table and the line table while they grow.
#[derive(Default)]
struct SymbolTable {
    symbols: Vec<Symbol>,
    lines: Vec<Line>,
    /// The number of entries so far, including auxiliary ones: the index of the next symbol in the format.
    entries: u32,
    /// Position in `symbols` of each function, and its first entry in `lines`.
    first_lines: Vec<(usize, u32)>,
}

impl SymbolTable {
    fn push(
        &mut self,
        name: &str,
        value: u32,
        section: SectionNumber,
        ty: SymbolType,
        class: StorageClass,
        aux: &[Aux],
    ) {
        self.entries += 1 + aux.len() as u32;
        self.symbols.push(Symbol { name: Name::from(name), value, section, ty, class, aux: aux.to_vec() });
    }

    /// A file symbol for each source file, followed by the functions defined in it.
    fn functions(&mut self, linked: &LinkedProgram) {
        for (file, path) in (0..).zip(&linked.files) {
            let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
            self.push(name, 33, SectionNumber::DEBUG, SymbolType::default(), StorageClass::FILE, &[]);
            let functions = linked.symbols.iter().zip(&linked.functions);
            for (symbol, function) in functions.filter(|(symbol, _)| symbol.place.file == file) {
                self.function(linked, symbol, function);
            }
        }
    }

    /// The six entries of a function, and its lines.
    fn function(&mut self, linked: &LinkedProgram, symbol: &LinkedSymbol, function: &LinkedFunction) {
        let text = SectionNumber(1);
        let end = symbol.address.offset(symbol.size).get();
        let next = self.entries + 6;
        let first_line = self.lines.len() as u32;
        self.lines.push(Line::Function(self.entries));
        let places = linked.lines.get(function.lines.clone()).unwrap_or_default();
        let lines = whole_lines(places, |line| line.place);
        self.lines.extend(lines.filter_map(|line| statement(line.address.get(), line.place.line)));
        let entries = self.lines.len() as u32 - first_line;
        self.first_lines.push((self.symbols.len(), first_line));

        let ty = function_type();
        let sizes = FunctionAux { size: symbol.size.into(), next: next.into(), ..FunctionAux::default() };
        self.push(&symbol.name, symbol.address.get(), text, ty, class(symbol.linkage), &[Aux::new(&sizes)]);
        let begin =
            BoundaryAux { lines: to_u16(entries - 1).into(), next: next.into(), ..BoundaryAux::default() };
        let none = SymbolType::default();
        self.push(".bf", symbol.address.get(), text, none, StorageClass::FUNCTION, &[Aux::new(&begin)]);
        let finish = BoundaryAux { line: to_u16(function.end.line).into(), ..BoundaryAux::default() };
        self.push(".ef", end, text, none, StorageClass::FUNCTION, &[Aux::new(&finish)]);
    }

    /// The program's objects and the firmware symbols that it refers to.
    fn objects(&mut self, linked: &LinkedProgram) {
        for symbol in linked.symbols.iter().skip(linked.functions.len()) {
            let section = SectionNumber(if symbol.section == Section::Bss { 3 } else { 2 });
            let size = FunctionAux { size: symbol.size.into(), ..FunctionAux::default() };
            let aux = [Aux::new(&size)];
            self.push(
                &symbol.name,
                symbol.address.get(),
                section,
                base_type(symbol.kind),
                class(symbol.linkage),
                &aux,
            );
        }
        for import in &linked.firmware.imports {
            let int = SymbolType::new(BaseType::INT);
            let ty = if import.is_function { int.derived(Derivation::Function) } else { int };
            self.push(
                &import.name,
                import.address.get(),
                SectionNumber::ABSOLUTE,
                ty,
                StorageClass::EXTERNAL,
                &[],
            );
        }
    }

    /// The limits of the sections, from which the vendor's tools compute sizes.
    fn markers(&mut self, linked: &LinkedProgram) {
        let text = linked.text.address.get();
        let text_end = text + linked.text.bytes.len() as u32;
        let data = linked.data.address.get();
        let data_end = data + linked.data.bytes.len() as u32;
        let bss = linked.bss.address.get();
        let bss_end = bss + linked.bss.size;
        for (name, value) in [
            ("_etext", text_end),
            ("_edata", data_end),
            ("_end", bss_end),
            ("__start_.text", text),
            ("__stop_.text", text_end),
            ("__start_.data", data),
            ("__stop_.data", data_end),
            ("__start_.bss", bss),
            ("__stop_.bss", bss_end),
        ] {
            let ty = SymbolType::new(BaseType::INT);
            self.push(name, value, SectionNumber::ABSOLUTE, ty, StorageClass::EXTERNAL, &[]);
        }
    }
}
