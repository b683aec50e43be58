//! Files as the vendor's tools write them, byte by byte from the description of the format.
//!
//! Nothing here uses the crate that reads them, so that a shared mistake cannot hide: two
//! programs that misread the same document in the same way would agree with each other.

use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, Origin};
use kmotiondef::limits::VERSION;
use kmotiondef::variables::FIRMWARE_VARIABLES;

/// Whose habits a file follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// TI's linker: the length of the string table counts itself.
    Linker,
    /// The vendor's compiler: it does not.
    Compiler,
}

/// A section of a file.
#[derive(Clone, Debug)]
pub struct Section {
    /// Its name.
    pub name: &'static str,
    /// Its address in the board's memory.
    pub address: u32,
    /// Its flags.
    pub flags: u32,
    /// Its bytes, or how many bytes it has without any in the file.
    pub data: Result<Vec<u8>, u32>,
    /// Line entries: value and line.
    pub lines: Vec<(u32, u16)>,
}

/// A symbol of a file.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: u32,
    /// Its section.
    pub section: i16,
    /// Its type.
    pub ty: u16,
    /// Its storage class.
    pub class: u8,
    /// Its auxiliary entries.
    pub aux: Vec<[u8; 18]>,
}

impl Symbol {
    /// A symbol without auxiliary entries.
    #[must_use]
    pub fn new(name: &str, value: u32, section: i16, ty: u16, class: u8) -> Self {
        Self { name: name.to_owned(), value, section, ty, class, aux: Vec::new() }
    }

    /// The entry that the vendor's compiler puts after everything that is not a function.
    #[must_use]
    pub fn plain_aux(mut self) -> Self {
        self.aux.push(bytes(&[(0, 4), (0x20, 4), (0, 10)]));
        self
    }
}

/// A whole file.
#[derive(Clone, Debug)]
pub struct File {
    /// The tool that wrote it.
    pub tool: Tool,
    /// Unix seconds.
    pub timestamp: u32,
    /// The seven words of the optional header after its magic number; the first is a half word.
    pub optional: [u32; 7],
    /// Its sections.
    pub sections: Vec<Section>,
    /// Its symbols.
    pub symbols: Vec<Symbol>,
}

/// Auxiliary entry of (value, size) pairs.
fn bytes(fields: &[(u32, usize)]) -> [u8; 18] {
    let mut out = Vec::new();
    for (value, size) in fields {
        let mut field = value.to_le_bytes().to_vec();
        field.resize(*size, 0);
        out.extend_from_slice(&field);
    }
    out.try_into().expect("the fields of an entry have eighteen bytes")
}

impl File {
    /// The bytes of the file.
    #[must_use]
    pub fn write(&self) -> Vec<u8> {
        let mut out = Vec::new();
        let mut strings = Vec::new();
        let raw_at = 50 + 48 * self.sections.len();
        let raw: usize = self.sections.iter().map(|s| s.data.as_ref().map_or(0, Vec::len)).sum();
        let lines: usize = self.sections.iter().map(|s| s.lines.len()).sum();
        let symbols_at = raw_at + raw + 6 * lines;
        let entries: usize = self.symbols.iter().map(|symbol| 1 + symbol.aux.len()).sum();
        let halves = |out: &mut Vec<u8>, values: &[usize]| {
            values.iter().for_each(|value| out.extend_from_slice(&(*value as u16).to_le_bytes()));
        };
        let words = |out: &mut Vec<u8>, values: &[usize]| {
            values.iter().for_each(|value| out.extend_from_slice(&(*value as u32).to_le_bytes()));
        };
        halves(&mut out, &[0xC2, self.sections.len()]);
        words(&mut out, &[self.timestamp as usize, symbols_at, entries]);
        halves(&mut out, &[28, 0x1143, 0x99, 0x108, self.optional[0] as usize]);
        words(&mut out, &self.optional[1..].iter().map(|word| *word as usize).collect::<Vec<_>>());
        let (mut data_at, mut lines_at) = (raw_at, raw_at + raw);
        for section in &self.sections {
            out.extend_from_slice(&name_field(section.name, &mut strings));
            let size = section.data.as_ref().map_or_else(|size| *size as usize, Vec::len);
            let at = if section.data.is_ok() { data_at } else { 0 };
            let lines = if section.lines.is_empty() { 0 } else { lines_at };
            let address = section.address as usize;
            let flags = section.flags as usize;
            words(&mut out, &[address, address, size, at, 0, lines, 0, section.lines.len(), flags, 0]);
            data_at += section.data.as_ref().map_or(0, Vec::len);
            lines_at += 6 * section.lines.len();
        }
        self.sections.iter().flat_map(|section| &section.data).for_each(|data| out.extend_from_slice(data));
        for (value, line) in self.sections.iter().flat_map(|section| &section.lines) {
            out.extend_from_slice(&value.to_le_bytes());
            out.extend_from_slice(&line.to_le_bytes());
        }
        for symbol in &self.symbols {
            out.extend_from_slice(&name_field(&symbol.name, &mut strings));
            words(&mut out, &[symbol.value as usize]);
            out.extend_from_slice(&symbol.section.to_le_bytes());
            halves(&mut out, &[symbol.ty.into()]);
            out.extend_from_slice(&[symbol.class, symbol.aux.len() as u8]);
            symbol.aux.iter().for_each(|aux| out.extend_from_slice(aux));
        }
        let counted = strings.len() + if self.tool == Tool::Linker { 4 } else { 0 };
        words(&mut out, &[counted]);
        out.extend_from_slice(&strings);
        out
    }
}

/// Eight bytes for a name: itself, or zeros and its place in the string table.
fn name_field(name: &str, strings: &mut Vec<u8>) -> [u8; 8] {
    let mut field = [0; 8];
    if name.len() <= 8 {
        field[..name.len()].copy_from_slice(name.as_bytes());
        return field;
    }
    field[4..].copy_from_slice(&(4 + strings.len() as u32).to_le_bytes());
    strings.extend_from_slice(name.as_bytes());
    strings.push(0);
    field
}

/// Names, addresses, sizes and flags of the sections of the firmware 4.34 file.
const FIRMWARE_SECTIONS: [(&str, u32, u32, u32); 28] = [
    ("$BRID", 0, 0x52C, 0x10),
    (".debug_loc", 0, 0, 0x10),
    (".debug_frame", 0, 0x6D5C, 0x10),
    (".debug_abbrev", 0, 0x443, 0x10),
    (".debug_info", 0, 0x2_B95F, 0x10),
    (".debug_line", 0, 0x5ED9, 0x10),
    ("vectors", 0x1000_0000, 0x460, 0x520),
    (".boot_bss", 0x1000_0D00, 0xC, 0x280),
    (".boot_iram", 0x1000_0460, 0x8A0, 0x520),
    (".AltProg", 0x1000_1040, 0x1_2440, 0x520),
    (".bstart", 0x1000_1000, 0x40, 0x520),
    (".boot", 0x8000_0000, 0, 0),
    (".bootf", 0x8000_0000, 0x6DE0, 0x560),
    (".big", 0x8002_7F20, 0x1_6228, 0x240),
    (".cinit", 0x8003_E148, 0x237C, 0x340),
    (".text", 0x8000_F000, 0x1_8F20, 0x520),
    (".sdramsa", 0x8004_04C4, 0xE0, 0x280),
    (".vec", 0x8000_F000, 0, 0),
    (".stack", 0x1001_AD40, 0x800, 0x380),
    (".bss", 0x1000_1040, 0, 0x80),
    (".const", 0x1001_B540, 0x57A, 0x340),
    (".data", 0x1001_BAC0, 0x228, 0x340),
    (".far", 0x1001_3480, 0x78BC, 0x380),
    (".switch", 0x1001_BCE8, 0xC0, 0x240),
    (".sdram", 0x80FF_9020, 0x1E00, 0x380),
    (".sysmem", 0x8010_0000, 0xEF_9020, 0x380),
    (".tables", 0x1000_1040, 0, 0),
    (".cio", 0x1000_1040, 0, 0),
];

/// The address of the firmware file's version text.
const VERSION_AT: u32 = 0x1001_B958;

/// A file like that of the firmware, `version` in place of the text of 4.34: its 28 sections and
/// 57 line entries, every function and variable that programs can name, `int` throughout, with
/// the underscore of TI's compiler; statics, labels and files up to the real number of symbols.
#[must_use]
pub fn firmware_file(version: &str) -> Vec<u8> {
    let sections = FIRMWARE_SECTIONS.map(|(name, address, size, flags)| {
        let uninitialised = flags & 0x80 != 0 || matches!(flags, 0x280 | 0x380) || size == 0;
        let mut data = if uninitialised { Err(size) } else { Ok(vec![0; size as usize]) };
        if let (".const", Ok(data)) = (name, &mut data) {
            let at = (VERSION_AT - address) as usize;
            data[at..at + version.len()].copy_from_slice(version.as_bytes());
        }
        let lines = if name == ".text" {
            (0..57).map(|n| (address + 32 * n, n as u16 + 1)).collect()
        } else {
            Vec::new()
        };
        Section { name, address, flags, data, lines }
    });
    let mut symbols = firmware_symbols();
    let mut serial = 0;
    while symbols.iter().map(|symbol| 1 + symbol.aux.len()).sum::<usize>() < 6487 {
        let (ty, class) = if serial % 6 == 0 { (0, 3) } else { (0, 6) };
        symbols.push(Symbol::new(&format!("$C$L{serial}"), 0x8000_F000 + serial, 16, ty, class));
        serial += 1;
    }
    let optional = [0x138B, 0x1_8F20, 0x228, 0, 0x1001_3360, 0x8000_F000, 0x1001_BAC0];
    File { tool: Tool::Linker, timestamp: 0x5B73_609E, optional, sections: sections.to_vec(), symbols }
        .write()
}

/// The external symbols of the firmware, first those of the files and sections.
fn firmware_symbols() -> Vec<Symbol> {
    let mut symbols = Vec::new();
    for n in 0..79 {
        symbols.push(Symbol::new(&format!("module{n}.c"), 0, -2, 0, 103));
    }
    for (index, (name, address, size, _)) in FIRMWARE_SECTIONS.iter().enumerate() {
        let mut symbol = Symbol::new(name, *address, index as i16 + 1, 0, 3);
        symbol.aux.push(bytes(&[(*size, 4), (0, 2), (0, 2), (0, 10)]));
        symbols.push(symbol);
    }
    let functions = FIRMWARE_FUNCTIONS.iter().filter(|function| function.origin != Origin::Library);
    let functions = functions.map(|function| (function.name, function.address.get(), 16));
    let variables = FIRMWARE_VARIABLES.iter().map(|variable| (variable.name, variable.address.get(), 23));
    for (name, address, section) in functions.chain(variables) {
        if name != "VersionAndBuildTime" {
            symbols.push(Symbol::new(&format!("_{name}"), address, section, 4, 2));
        }
    }
    symbols.push(Symbol::new("_VersionAndBuildTime", VERSION_AT, 21, 4, 2));
    symbols.push(Symbol::new("_main", 0x8001_0000, 16, 4, 2));
    symbols.push(Symbol::new("_OnlyInTheFile", 0x8001_2340, 16, 4, 2));
    for limit in ["etext", "___bss__", "__STACK_SIZE"] {
        symbols.push(Symbol::new(limit, 0x1000_1040, -1, 0, 2));
    }
    symbols
}

/// The firmware file of the board that is simulated.
#[must_use]
pub fn board_firmware() -> Vec<u8> {
    firmware_file(VERSION)
}

/// The image that the vendor's compiler makes of
///
/// ```c
/// int count = 7;
/// int total;
/// static int helper() { return 1; }
/// int main()
/// {
///     total = total + count;
///     return total;
/// }
/// ```
///
/// for thread 1, the code replaced by zeros. `helper` is a label whose opening line entry names
/// the symbol after the last one.
#[must_use]
pub fn image() -> Vec<u8> {
    let (text, data, bss) = (0x8005_0000, 0x8005_0080, 0x8005_00A0);
    let file = Symbol::new("tiny.c", 33, -2, 0, 103);
    let lines_at = 50 + 2 * 48 + 0x7C + 4;
    let mut main = Symbol::new("main", text + 0x20, 1, 0x24, 2);
    main.aux.push(bytes(&[(0, 4), (0x5C, 4), (lines_at + 4 * 6, 4), (7, 4), (0, 2)]));
    let mut begin = Symbol::new(".bf", text + 0x20, 1, 0, 101);
    begin.aux.push(bytes(&[(0, 4), (0, 2), (4, 2), (0, 4), (7, 4), (0, 2)]));
    let mut end = Symbol::new(".ef", text + 0x7C, 1, 0, 101);
    end.aux.push(bytes(&[(0, 4), (8, 2), (0, 12)]));
    let mut symbols = vec![file, main, begin, end];
    let int = |name: &str, value: u32| Symbol::new(name, value, 2, 4, 2).plain_aux();
    symbols.extend([int("", 0), int("", text), int("count", data), int("total", bss)]);
    symbols.push(Symbol::new("helper", text, 2, 4, 6).plain_aux());
    symbols.push(Symbol::new("L.0", text + 0x64, 2, 4, 6).plain_aux());
    let firmware = FIRMWARE_FUNCTIONS.iter().filter(|function| function.origin != Origin::Library);
    symbols.extend(firmware.map(|function| int(function.name, function.address.get())));
    symbols.extend(FIRMWARE_VARIABLES.iter().map(|variable| int(variable.name, variable.address.get())));
    for (name, value) in [
        ("_etext", text + 0x7C),
        ("_edata", data + 4),
        ("_end", bss),
        ("__start_.text", text),
        ("__stop_.text", text + 0x7C),
        ("__start_.data", data),
        ("__stop_.data", data + 4),
        ("__start_.bss", bss),
        ("__stop_.bss", bss + 4),
        ("_GLOBAL_OFFSET_TABLE_", data),
    ] {
        symbols.push(int(name, value));
    }
    let entries: usize = symbols.iter().map(|symbol| 1 + symbol.aux.len()).sum();
    let lines = vec![
        (entries as u32, 0),
        (text, 3),
        (text + 0x08, 4),
        (text + 0x14, 4),
        (1, 0),
        (text + 0x20, 5),
        (text + 0x34, 6),
        (text + 0x34, 7),
        (text + 0x64, 8),
    ];
    let sections = vec![
        Section { name: ".text", address: text, flags: 0x560, data: Ok(vec![0; 0x7C]), lines },
        Section { name: ".data", address: data, flags: 0x40, data: Ok(vec![7, 0, 0, 0]), lines: Vec::new() },
    ];
    let optional = [0x190, 0x7C, 4, 4, text + 0x20, text, data];
    File { tool: Tool::Compiler, timestamp: 0, optional, sections, symbols }.write()
}
