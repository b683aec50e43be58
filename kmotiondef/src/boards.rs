//! The boards that programs can be built for, each with its firmware.
//!
//! KFLOP with firmware 4.34 is described by the tables of this crate. Every other board is a file of facts in `boards/`
//! that says what differs: addresses of all names, declarations, structures, constants. The C headers of a board are
//! those in `include/` with these differences applied. Nothing of a file is read before a board other than the default
//! is requested.
//!
//! A line of a file is one fact:
//!
//! | line | meaning |
//! |---|---|
//! | `board NAME`, `version TEXT`, `time SECONDS` | the name for `--board`, the answer to `Version`, the time stamp of the firmware file |
//! | `programs BASE SIZE LIMIT`, `axes N` | the space of thread 1's program, its size, the end of the last; the number of axes |
//! | `clock MHZ`, `counter MHZ` | the clock of the processor, the rate of TIMER0 |
//! | `iram BASE SIZE`, `sdram BASE SIZE`, `fpga BASE SIZE`, `timer BASE SIZE` | on-chip RAM, SDRAM, the registers of the FPGA and of the timer |
//! | `hrpwm BASE BASE BASE`, `buffers BASE` | the registers of the fast PWM channels; the buffers and the heap after the programs |
//! | `unmapped flash` | flash memory is in no addresses of programs |
//! | `elf` | its firmware file is an ELF file, and its loader takes ELF images beside COFF2 ones |
//! | `unproven` | nothing of it was compared with a board or its firmware in execution |
//! | `declare PROTOTYPE`, `undeclare NAME` | a function that the header declares, or does not |
//! | `function PROTOTYPE` | a function that the header does not declare |
//! | `extern DECLARATION` | a variable |
//! | `define NAME VALUE`, `undefine NAME` | a constant or a macro |
//! | `enum NAME ENUMERATOR=VALUE …` | an enumeration |
//! | `struct NAME SIZE ALIGN`, then `OFFSET SIZE DECLARATION // meaning` | a structure and its fields |
//! | `ADDRESS NAME` | a name that the firmware has |

mod header;
mod moved;
mod prototype;

use std::collections::BTreeMap;
use std::sync::{LazyLock, OnceLock};

use crate::bits::{BitRange, kogna_range_of, range_of};
use crate::firmware::{ABSENT, FIRMWARE_FUNCTIONS, FirmwareFunction, Origin, row_named};
use crate::hidden;
use crate::ids::{Axes, Bit, GuestAddr, ThreadId};
use crate::limits::{N_CHANNELS, VERSION};
use crate::map::{MemoryMap, ProgramSpaces, Region};
use crate::structs::STRUCTURES;
use crate::variables::{ADC_BUFFER_IN, FIRMWARE_VARIABLES, variable_named};

pub use moved::{MovedObject, moved_objects};
pub use prototype::FunctionType;

/// The files of facts.
const FILES: &[&str] = include!(concat!(env!("OUT_DIR"), "/facts.rs"));

/// A C header: the name that `#include` uses, and its text.
pub type Header = (&'static str, &'static [u8]);

/// A board and its firmware.
#[derive(Debug)]
pub struct TargetBoard {
    /// The name for `--board`.
    pub name: &'static str,
    /// The answer to `Version`, without the newline.
    pub version: &'static str,
    /// The time stamp of the firmware file, seconds since 1970; `None` if it is unknown.
    pub time_stamp: Option<u32>,
    /// The axes.
    pub axes: Axes,
    /// The clock of the processor, in megahertz: 200 on a KFLOP.
    pub clock: u32,
    /// True if programs for the board were compared with its firmware in execution.
    pub is_proven: bool,
    /// True if its firmware file is an ELF file and its loader takes ELF images beside COFF2 ones.
    pub has_elf: bool,
    map: MemoryMap,
    /// The differences from the default board; `None` for that board.
    facts: Option<BoardFacts>,
}

impl PartialEq for TargetBoard {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for TargetBoard {}

/// Every board; the first is the default. The others are read when the first of them is looked at.
pub fn boards() -> impl Iterator<Item = &'static TargetBoard> + Clone {
    static OTHERS: LazyLock<Vec<TargetBoard>> =
        LazyLock::new(|| FILES.iter().map(|text| TargetBoard::read(text)).collect());
    let others = (0..FILES.len()).map(|number| &OTHERS[number]);
    std::iter::once(TargetBoard::default_board()).chain(others)
}

/// Differences from the default board.
#[derive(Debug, Default)]
struct BoardFacts {
    symbols: BTreeMap<&'static str, GuestAddr>,
    /// Functions by name: those declared in the header, and the others.
    declared: BTreeMap<&'static str, &'static str>,
    undeclared: BTreeMap<&'static str, &'static str>,
    /// Names that only the default header declares.
    removed: Vec<&'static str>,
    variables: BTreeMap<&'static str, &'static str>,
    defines: Vec<(&'static str, &'static str)>,
    undefines: Vec<&'static str>,
    enumerations: Vec<(&'static str, &'static str)>,
    structures: Vec<StructureLayout>,
    /// The C headers, created at the first use.
    headers: OnceLock<Vec<Header>>,
    /// The lines that apply to all boards of this kind, without addresses and the facts of one version.
    kind: Vec<&'static str>,
}

/// The layout of a structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructureLayout {
    /// Its name in C.
    pub name: &'static str,
    /// Its size in bytes.
    pub size: u32,
    /// Its alignment in bytes.
    pub align: u32,
    /// Its fields in ascending order.
    pub fields: Vec<FieldLayout>,
}

/// The layout of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldLayout {
    /// Its name.
    pub name: &'static str,
    /// Bytes from the start of the structure.
    pub offset: u32,
    /// Its size in bytes.
    pub size: u32,
    /// The C declaration, without the semicolon; empty for fields of the default board.
    declaration: &'static str,
    meaning: &'static str,
}

/// A name that is not the same on two boards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The name of a function, variable, constant, macro or structure.
    pub name: &'static str,
    /// The difference, in words.
    pub change: String,
}

/// A function as a board has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardFunction {
    /// The address.
    pub address: GuestAddr,
    /// Its type.
    pub ty: FunctionType,
    /// The origin: firmware or library.
    pub origin: Origin,
}

impl TargetBoard {
    /// KFLOP with firmware 4.34.
    const DEFAULT: Self = Self {
        name: "kflop-4.34",
        version: VERSION.trim_ascii_end(),
        time_stamp: Some(1_534_288_030),
        axes: Axes::new(N_CHANNELS),
        clock: 200,
        is_proven: true,
        has_elf: false,
        map: MemoryMap::KFLOP,
        facts: None,
    };

    /// The default board.
    #[must_use]
    pub fn default_board() -> &'static Self {
        static DEFAULT: TargetBoard = TargetBoard::DEFAULT;
        &DEFAULT
    }

    /// The board with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        match name == Self::DEFAULT.name {
            true => Some(Self::default_board()),
            false => boards().find(|board| board.name.eq_ignore_ascii_case(name)),
        }
    }

    /// The board whose firmware answers this to `Version`.
    #[must_use]
    pub fn of_version(version: &str) -> Option<&'static Self> {
        match version == Self::DEFAULT.version {
            true => Some(Self::default_board()),
            false => boards().find(|board| board.version == version),
        }
    }

    /// The board that an image is linked for: that of its version stamp, with its code in a space for programs.
    #[must_use]
    pub fn of_image(version_stamp: i16, code: u32) -> Option<&'static Self> {
        let holds = |board: &&Self| board.map.programs.holds(code);
        boards().filter(|board| board.version_stamp() == version_stamp).find(holds)
    }

    /// Cycles of the processor between two interrupts of the servo.
    #[must_use]
    pub const fn cycles_of_tick(&self) -> u32 {
        // The interrupts are 90 µs apart on every board.
        self.clock * 90
    }

    /// The kind of board: `KFLOP`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.version.split_whitespace().next().unwrap_or(self.version)
    }

    /// The version's number: `4.34`.
    #[must_use]
    pub fn number(&self) -> &'static str {
        self.version.split_whitespace().nth(1).unwrap_or(self.version)
    }

    /// The name for messages: `KFLOP firmware 4.34`.
    #[must_use]
    pub fn title(&self) -> String {
        format!("{} firmware {}", self.kind(), self.number())
    }

    /// The first other board that has a function, variable or constant which this one has not.
    #[must_use]
    pub fn other_with(&self, name: &str) -> Option<&'static Self> {
        let has = |board: &Self| board.has(name) || board.defines(name);
        boards().find(|other| has(other)).filter(|_| !has(self))
    }

    /// Reports whether it is the default board.
    #[must_use]
    pub const fn is_default(&self) -> bool {
        self.facts.is_none()
    }

    /// The stamp of images that are linked for it: 434 for 4.34, 532 for 5.3.2.
    #[must_use]
    pub fn version_stamp(&self) -> i16 {
        stamp(self.version).unwrap_or(0)
    }

    /// The start of the program of a thread.
    #[must_use]
    pub fn program_base(&self, thread: ThreadId) -> GuestAddr {
        self.map.programs.start(thread)
    }

    /// The spaces of all programs.
    #[must_use]
    pub const fn programs(&self) -> ProgramSpaces {
        self.map.programs
    }

    /// Its memories and devices.
    #[must_use]
    pub const fn map(&self) -> &MemoryMap {
        &self.map
    }

    /// The range that a bit is in, if anything on the board or its option boards answers it.
    #[must_use]
    pub fn bit_range(&self, bit: Bit) -> Option<&'static BitRange> {
        range_of(bit).or_else(|| self.map.has_kogna_bits().then(|| kogna_range_of(bit)).flatten())
    }

    /// The C headers.
    #[must_use]
    pub fn headers(&self) -> &[Header] {
        let Some(facts) = &self.facts else { return crate::headers::EMBEDDED };
        facts.headers.get_or_init(|| header::of_board(facts, (self.kind(), self.number())))
    }

    /// The function of this name, if programs can call one on this board.
    #[must_use]
    pub fn function(&self, name: &str) -> Option<BoardFunction> {
        let row = row_named(name);
        let of_row = |row: &FirmwareFunction| BoardFunction {
            address: row.address,
            ty: FunctionType::of_row(row),
            origin: row.origin,
        };
        let Some(facts) = &self.facts else {
            return row.filter(|_| !ABSENT.contains(&name)).map(of_row);
        };
        let Some(address) = facts.symbols.get(name).copied() else {
            return row.filter(|row| row.origin == Origin::Library).map(of_row);
        };
        let ty = match row {
            Some(row) => FunctionType::of_row(row),
            None => FunctionType::parse(facts.declared.get(name).or_else(|| facts.undeclared.get(name))?)?,
        };
        let is_declared = facts.declared.contains_key(name)
            || row.is_some_and(|row| row.origin == Origin::Header && !facts.removed.contains(&name));
        let origin = if is_declared { Origin::Header } else { Origin::Firmware };
        Some(BoardFunction { address, ty, origin })
    }

    /// The prototype of a function declared in this board's header or present in its firmware.
    fn prototype_text(&self, name: &str) -> Option<String> {
        let facts = self.facts.as_ref();
        let own = facts.and_then(|facts| facts.declared.get(name).or_else(|| facts.undeclared.get(name)));
        self.function(name)?;
        own.map(|text| (*text).to_owned()).or_else(|| row_named(name).map(FirmwareFunction::prototype))
    }

    /// The C declaration of a function or variable that only this board's facts describe.
    #[must_use]
    pub fn declaration(&self, name: &str) -> Option<String> {
        let variable = self.facts.as_ref().and_then(|facts| facts.variables.get(name));
        self.prototype_text(name).or_else(|| variable.map(|text| (*text).to_owned()))
    }

    /// The address of a variable.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<GuestAddr> {
        let row = variable_named(name).filter(|_| !ABSENT.contains(&name));
        match &self.facts {
            None => row.map(|row| row.address),
            Some(facts) if row.is_some() || facts.variables.contains_key(name) => {
                facts.symbols.get(name).copied()
            }
            Some(_) => None,
        }
    }

    /// Reports whether the firmware uses the name internally: neither a function nor a variable for programs.
    #[must_use]
    pub fn is_hidden(&self, name: &str) -> bool {
        match &self.facts {
            None => hidden::is_hidden(name),
            Some(facts) => {
                facts.symbols.contains_key(name)
                    && self.function(name).is_none()
                    && self.variable(name).is_none()
            }
        }
    }

    /// Reports whether the firmware has a function or variable of this name for programs.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.function(name).is_some_and(|function| function.origin != Origin::Library)
            || self.variable(name).is_some()
    }

    /// Every function and variable that programs can use, those of the library included.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        let known = FIRMWARE_FUNCTIONS.iter().map(|row| row.name);
        let known = known.chain(FIRMWARE_VARIABLES.iter().map(|row| row.name));
        let is_known = |name: &str| row_named(name).is_some() || variable_named(name).is_some();
        let own = self.facts.iter().flat_map(|facts| facts.symbols.keys().copied());
        known
            .chain(own.filter(move |name| !is_known(name)))
            .filter(|name| self.function(name).is_some() || self.variable(name).is_some())
    }

    /// Reports whether the header defines a constant or macro of this name.
    #[must_use]
    pub fn defines(&self, name: &str) -> bool {
        self.headers().iter().any(|(_, text)| header::defines(text, name))
    }

    /// Every name that the firmware has, with its address; for the default board those that programs can use.
    pub fn symbols(&self) -> Vec<(&'static str, GuestAddr)> {
        match &self.facts {
            Some(facts) => facts.symbols.iter().map(|(name, address)| (*name, *address)).collect(),
            None => {
                let functions = FIRMWARE_FUNCTIONS.iter().filter(|row| row.origin != Origin::Library);
                let functions = functions.map(|row| (row.name, row.address));
                let variables = FIRMWARE_VARIABLES.iter().map(|row| (row.name, row.address));
                functions.chain(variables).filter(|(name, _)| !ABSENT.contains(name)).collect()
            }
        }
    }

    /// The facts of a firmware that is like this board's: of another version, with these names and addresses.
    ///
    /// Declarations, structures and constants are this board's; what has changed in them is written by hand.
    #[must_use]
    pub fn facts_of(&self, version: &str, time_stamp: u32, symbols: &[(&str, GuestAddr)]) -> String {
        let mut words = version.split_whitespace();
        let kind = words.next().unwrap_or_default().to_lowercase();
        let number = words.next().unwrap_or_default();
        let mut text = format!(
            "# The facts of one board where they differ from those of kflop-4.34, which the tables in src/ hold.\n\
             # Written by `cc67 firmware facts`; declarations, constants and structures are those of {}.\n\n\
             board {kind}-{number}\nversion {version}\n",
            self.name
        );
        // ELF files have no time stamp.
        if time_stamp > 0 {
            text += &format!("time {time_stamp}\n");
        }
        let own = format!("define KMOTION_VER \"{}\"", self.number());
        for line in self.facts.iter().flat_map(|facts| &facts.kind).filter(|line| **line != own) {
            text += &format!("{line}\n");
        }
        text += &format!("define KMOTION_VER \"{number}\"\n\n");
        let mut symbols = symbols.to_vec();
        symbols.sort_by_key(|(name, address)| (*address, *name));
        for (name, address) in symbols {
            text += &format!("{:08X} {name}\n", address.get());
        }
        text
    }

    /// The prototypes, declarations and definitions by which the header of this board differs from the default one: the
    /// text for each name; empty for a removed name.
    fn stated(&self) -> BTreeMap<&'static str, &'static str> {
        let Some(facts) = &self.facts else { return BTreeMap::new() };
        let defines = facts.defines.iter().map(|(name, value)| (*name, value.trim()));
        let undefines = facts.undefines.iter().map(|name| (*name, ""));
        let texts = facts.declared.iter().chain(&facts.variables).map(|(name, text)| (*name, *text));
        defines.chain(undefines).chain(texts).collect()
    }

    /// The names of functions, variables, constants and structures that a program meets otherwise on another board, with
    /// what is different, sorted by name.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        let mut found = BTreeMap::new();
        let names = self.names().chain(other.names());
        for name in names {
            match (self.has(name), other.has(name)) {
                (true, false) => drop(found.insert(name, format!("only in {}", self.name))),
                (false, true) => drop(found.insert(name, format!("only in {}", other.name))),
                _ => {}
            }
        }
        let (own, others) = (self.stated(), other.stated());
        for name in own.keys().chain(others.keys()).copied() {
            let text = |stated: Option<&&'static str>| match stated {
                Some(text) => Some(*text).filter(|text| !text.is_empty()),
                None => header::stated(name),
            };
            let (first, second) = (text(own.get(name)), text(others.get(name)));
            if first != second && !found.contains_key(name) {
                let show = |board: &Self, text: Option<&str>| match text {
                    Some(text) => format!("`{text}` in {}", board.name),
                    None => format!("not in {}", board.name),
                };
                found.insert(name, format!("{}, {}", show(self, first), show(other, second)));
            }
        }
        let structures = other.structures();
        for layout in self.structures() {
            let Some(another) = structures.iter().find(|another| another.name == layout.name) else {
                continue;
            };
            if let Some(change) = layout.change(another) {
                found.insert(layout.name, change);
            }
        }
        found.into_iter().map(|(name, change)| Difference { name, change }).collect()
    }

    /// The addresses of the variables of the tables on this board.
    #[must_use]
    pub fn moved_objects(&self) -> Vec<MovedObject> {
        let mut objects = moved_objects(|name| self.variable(name), self.own_structures(), self.axes);
        if self.has_short_inputs() {
            moved::halve(&mut objects, ADC_BUFFER_IN.address());
        }
        objects.extend(moved::buffers(&objects, self.map.buffers));
        objects
    }

    /// Returns whether the analog inputs have 16 bits, where the tables have 32.
    fn has_short_inputs(&self) -> bool {
        let declared = self.facts.as_ref().and_then(|facts| facts.variables.get("ADC_BufferIn"));
        declared.is_some_and(|declaration| declaration.starts_with("short"))
    }

    /// The layouts of structures that are not those of the default board.
    #[must_use]
    pub fn own_structures(&self) -> &[StructureLayout] {
        self.facts.as_ref().map_or(&[], |facts| &facts.structures)
    }

    /// The layouts of all structures.
    #[must_use]
    pub fn structures(&self) -> Vec<StructureLayout> {
        let own = self.own_structures();
        let of_table = |structure: &crate::structs::Structure| StructureLayout {
            name: structure.name,
            size: structure.size,
            align: structure.align,
            fields: structure.fields.iter().map(FieldLayout::of_row).collect(),
        };
        let layout = |structure: &&crate::structs::Structure| {
            own.iter()
                .find(|layout| layout.name == structure.name)
                .cloned()
                .unwrap_or_else(|| of_table(structure))
        };
        STRUCTURES.iter().map(|structure| layout(&structure)).collect()
    }

    /// Reads a file of facts.
    ///
    /// # Panics
    /// A line is not in the format described at the beginning of this module: the files are part of cc67.
    fn read(text: &'static str) -> Self {
        let mut board = Self { name: "", version: "", time_stamp: None, facts: None, ..Self::DEFAULT };
        let mut facts = BoardFacts::default();
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let (word, rest) = line.trim_start().split_once(' ').unwrap_or((line, ""));
            let is_address = word.len() == 8 && word.bytes().all(|byte| byte.is_ascii_hexdigit());
            if !is_address && !matches!(word, "board" | "version" | "time") {
                facts.kind.push(line);
            }
            match word {
                "board" => board.name = rest,
                "version" => board.version = rest,
                "time" => board.time_stamp = Some(number(rest, 10)),
                "axes" => board.axes = Axes::new(number(rest, 10) as usize),
                "programs" => {
                    let mut words = rest.split(' ').map(hexadecimal);
                    let mut next = || words.next().unwrap_or_default();
                    board.map.programs = ProgramSpaces { base: next(), size: next(), limit: next() };
                }
                "iram" => board.map.iram = region(board.map.iram, rest),
                "sdram" => board.map.sdram = region(board.map.sdram, rest),
                "fpga" => board.map.fpga = region(board.map.fpga, rest),
                "timer" => board.map.timer = region(board.map.timer, rest),
                "unmapped" => board.map.flash = None,
                "hrpwm" => board.map.hrpwm = Some(hrpwm(rest)),
                "buffers" => board.map.buffers = GuestAddr::new(hexadecimal(rest)),
                "clock" => board.clock = number(rest, 10),
                "counter" => board.map.counter = number(rest, 10),
                "elf" => board.has_elf = true,
                "unproven" => board.is_proven = false,
                _ => facts.read(line, word, rest),
            }
        }
        board.facts = Some(facts);
        board
    }
}

impl BoardFacts {
    /// Reads a line about a name.
    fn read(&mut self, line: &'static str, word: &'static str, rest: &'static str) {
        match word {
            "declare" => drop(self.declared.insert(prototype::name(rest), rest)),
            "function" => drop(self.undeclared.insert(prototype::name(rest), rest)),
            "undeclare" => self.removed.push(rest),
            "extern" => drop(self.variables.insert(prototype::name(rest), rest)),
            "define" => {
                let end = rest.find(|c: char| c != '_' && !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
                self.defines.push((&rest[..end], &rest[end..]));
            }
            "undefine" => self.undefines.push(rest),
            "enum" => self.enumerations.push(rest.split_once(' ').unwrap_or((rest, ""))),
            "struct" => {
                let mut words = rest.split(' ');
                let mut next = || words.next().unwrap_or_default();
                let (name, size, align) = (next(), number(next(), 10), number(next(), 10));
                self.structures.push(StructureLayout { name, size, align, fields: Vec::new() });
            }
            _ if line.starts_with(' ') => {
                let (size, rest) = rest.split_once(' ').unwrap_or_default();
                let (declaration, meaning) = rest.split_once(" // ").unwrap_or((rest, ""));
                let name = prototype::name(declaration);
                let (offset, size) = (number(word, 10), number(size, 10));
                let structure = self.structures.last_mut().expect("a field is after its structure");
                structure.fields.push(FieldLayout { name, offset, size, declaration, meaning });
            }
            _ => drop(self.symbols.insert(rest, GuestAddr::new(number(word, 16)))),
        }
    }
}

impl StructureLayout {
    /// A description of the fields that have another offset in a different layout of the structure, or are missing
    /// there.
    fn change(&self, other: &Self) -> Option<String> {
        let place = |fields: &[FieldLayout], name: &str| {
            fields.iter().find(|field| field.name == name).map(|field| (field.offset, field.size))
        };
        let mut parts = Vec::new();
        if self.size != other.size {
            parts.push(format!("{} and {} bytes", self.size, other.size));
        }
        let mut moved: Vec<&str> = Vec::new();
        for name in self.fields.iter().chain(&other.fields).map(|field| field.name) {
            if !moved.contains(&name) && place(&self.fields, name) != place(&other.fields, name) {
                moved.push(name);
            }
        }
        if !moved.is_empty() {
            parts.push(format!("fields that are new, gone or elsewhere: {}", moved.join(", ")));
        }
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

impl FieldLayout {
    const fn of_row(field: &crate::structs::StructureField) -> Self {
        let crate::structs::StructureField { name, offset, size, .. } = *field;
        Self { name, offset, size, declaration: "", meaning: "" }
    }
}

/// A region with the base and size in a line.
fn region(kind: Region, line: &str) -> Region {
    let (base, size) = line.split_once(' ').unwrap_or((line, "0"));
    kind.at(hexadecimal(base), hexadecimal(size))
}

/// The registers of the fast PWM channels.
fn hrpwm(line: &str) -> [Region; 3] {
    let mut bases = line.split(' ').map(hexadecimal);
    [(); 3].map(|()| MemoryMap::HRPWM.at(bases.next().unwrap_or_default(), MemoryMap::HRPWM.size))
}

fn hexadecimal(text: &str) -> u32 {
    number(text.trim_start_matches("0x"), 16)
}

/// Parses a number in a file of facts.
fn number(text: &str, radix: u32) -> u32 {
    u32::from_str_radix(text, radix).unwrap_or_else(|_| panic!("a file of facts has `{text}` for a number"))
}

/// The number of the version in `KFLOP 4.34 Build …` as images state it: 434 for 4.34, 532 for 5.3.2.
#[must_use]
pub fn stamp(version: &str) -> Option<i16> {
    let number = version.split_whitespace().find(|word| word.contains('.'))?;
    let mut parts = number.split('.');
    let digits = |part: &str| part.chars().take_while(char::is_ascii_digit).collect::<String>();
    let major: i16 = parts.next()?.parse().ok()?;
    let minor = match (digits(parts.next()?), parts.next().map(digits)) {
        (minor, Some(patch)) => format!("{minor}{patch}"),
        (minor, None) => minor,
    };
    let minor: i16 = minor.get(..minor.len().min(2))?.parse().ok()?;
    major.checked_mul(100)?.checked_add(minor)
}

#[cfg(test)]
mod tests;
