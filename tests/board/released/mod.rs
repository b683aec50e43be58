//! Recorded behaviour of the released firmware, compared with the firmware itself: threads, motion, servo and outputs.
//!
//! The vectors were recorded from it in another emulator, so everything that does not depend on the compiler of a
//! program must be reproduced exactly. If `CC67_FIRMWARE` names no file, each test reports that it is skipped; for
//! firmware 5.3.2 the variable is `CC67_FIRMWARE_5`.

mod firmware_5;
mod motion;
mod outputs;
mod protection;
mod servo;
mod threads;

use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};
use std::{env, fs};

use boot::{BootedBoard, ExternalHardware, FirmwareFile, TimerMatch};
use coff::{Image, Symbol};
use compiler::firmware::{Firmware, FirmwareFile as Symbols};
use compiler::target::Target;
use compiler::{Options, compile, image, pp};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{CType, GuestAddr, ThreadId};
use serde_json::Value as Json;
use vm::memory::GuestMemory;

/// Cycles of a tick.
const TICK: u64 = 18_000;
/// The number of ticks after which a line has been executed and answered.
const ANSWER: u32 = 40;
/// The number of digits with which floats were recorded.
const SINGLE: usize = 9;
/// The minimum number of cycles of an interrupt.
const SHORTEST: u64 = 1500;
/// The number of cycles between checks for its end, too few for any work of a slice.
const STEP: u64 = 20;

/// The rows of a recording.
fn rows(name: &str) -> Vec<Json> {
    let path = harness::root().join("tests/data/vectors").join(name);
    let text = fs::read_to_string(path).expect("the measurements are there");
    text.lines().map(|line| serde_json::from_str(&quoted(line)).expect("each line is JSON")).collect()
}

/// A line with its fractions as texts: the JSON reader rounds the last of 17 digits, which would prevent an exact
/// comparison.
fn quoted(line: &str) -> String {
    let mut quoted = String::new();
    for (index, part) in line.split('"').enumerate() {
        if index % 2 == 1 {
            quoted.push_str(&format!("\"{part}\""));
            continue;
        }
        for token in part.split_inclusive(|c| ", []{}:".contains(c)) {
            let number = token.trim_end_matches(|c| ", []{}:".contains(c));
            let is_fraction = number.contains(['.', 'e']) && number.parse::<f64>().is_ok();
            quoted.push_str(&if is_fraction {
                token.replacen(number, &format!("\"{number}\""), 1)
            } else {
                token.to_owned()
            });
        }
    }
    quoted
}

fn number(value: &Json) -> f64 {
    let fraction = value.as_str().and_then(|text| text.parse().ok());
    fraction.or(value.as_f64()).unwrap_or_else(|| panic!("{value} is a number"))
}

/// Returns whether a number equals the recorded one exactly: floats were recorded with nine digits.
fn is_same(found: f64, expect: &Json) -> bool {
    let digits = expect.as_str().map_or(0, |text| {
        let mantissa = text.split('e').next().unwrap_or_default();
        let digits = mantissa.trim_start_matches(['-', '0', '.']);
        digits.chars().filter(char::is_ascii_digit).count()
    });
    let expect = number(expect);
    if digits <= SINGLE { found as f32 == expect as f32 } else { found == expect }
}

fn text(value: &Json) -> &str {
    value.as_str().expect("text")
}

fn list(value: &Json) -> &[Json] {
    value.as_array().expect("a list")
}

fn thread(number: u64) -> ThreadId {
    ThreadId::new(i32::try_from(number).expect("small")).expect("a thread")
}

/// Hardware that only records the written values.
#[derive(Clone, Debug, Default)]
struct Nothing {
    writes: Vec<(usize, u16)>,
}

impl ExternalHardware for Nothing {
    fn read(&mut self, _: usize, _: bool, _: u64) -> Option<u16> {
        None
    }

    fn write(&mut self, register: usize, _: bool, value: u16, _: u64) {
        self.writes.push((register, value));
    }

    fn tick(&mut self, _: &mut TimerMatch<'_>) {}
}

/// A board with the released firmware, and the symbols against which programs are linked.
#[derive(Clone)]
struct Released {
    board: BootedBoard<Nothing>,
    symbols: Arc<Symbols>,
}

/// A board that has just booted firmware 4.34, without hardware around it.
fn released() -> Option<Released> {
    static BOARD: OnceLock<Option<Mutex<Released>>> = OnceLock::new();
    booted(&BOARD, "CC67_FIRMWARE")
}

/// The board that has booted the file named by an environment variable; it is booted only once.
fn booted(board: &OnceLock<Option<Mutex<Released>>>, variable: &str) -> Option<Released> {
    let boot = || {
        let Some(path) = env::var_os(variable) else {
            println!("not run: {variable} names no firmware file");
            return None;
        };
        let bytes = fs::read(path).unwrap_or_else(|error| panic!("{variable}: {error}"));
        let file = FirmwareFile::read(&bytes).unwrap_or_else(|error| panic!("{error}"));
        let board = BootedBoard::booted(Arc::new(file)).unwrap_or_else(|crash| panic!("{crash}"));
        let board = board.connect(Some(Nothing::default()));
        let symbols = Arc::new(Symbols::read(&bytes).unwrap_or_else(|error| panic!("{error}")));
        let mut released = Released { board, symbols };
        released.ticks(10);
        Some(Mutex::new(released))
    };
    let board = board.get_or_init(boot).as_ref()?;
    Some(board.lock().expect("no test holds it while it fails").clone())
}

/// The address of a field of an axis, and its type, with the name in the recordings: `P`, `iir0__A1`, `iir0.d0`.
fn field(axis: u8, name: &str) -> (u32, CType) {
    let base = u32::from(axis) * Chan::STRUCTURE.size;
    let parts: Vec<&str> = name.split("__").flat_map(|part| part.split('.')).collect();
    if let [filter, coefficient] = parts[..] {
        let number = filter.trim_start_matches("iir").parse().expect("a filter");
        let field = Iir::STRUCTURE.fields.iter().find(|field| field.name == coefficient).expect(name);
        return (base + Chan::IIR.element(number).offset() + field.offset, field.ty);
    }
    let field = Chan::STRUCTURE.fields.iter().find(|field| field.name == name).expect(name);
    (base + field.offset, field.ty)
}

impl Released {
    fn address(&self, name: &str) -> GuestAddr {
        self.board.file().address(name).unwrap_or_else(|| panic!("the firmware has {name}"))
    }

    /// Memory, data only.
    fn memory(&mut self) -> &mut GuestMemory {
        self.board.external_and_memory().1
    }

    fn peek_axis(&self, axis: u8, name: &str) -> f64 {
        let (offset, ty) = field(axis, name);
        let (at, memory) = (self.address("chan").offset(offset), self.board.memory());
        match ty {
            CType::Float => f64::from(memory.peek::<f32>(at)),
            CType::Double => memory.peek(at),
            _ => f64::from(memory.peek::<i32>(at)),
        }
    }

    fn peek(&self, name: &str) -> f64 {
        self.peek_axis(0, name)
    }

    fn poke_axis(&mut self, axis: u8, name: &str, value: f64) {
        let (offset, ty) = field(axis, name);
        let at = self.address("chan").offset(offset);
        match ty {
            CType::Float => self.memory().poke(at, value as f32),
            CType::Double => self.memory().poke(at, value),
            _ => self.memory().poke(at, value as i32),
        }
    }

    fn poke(&mut self, name: &str, value: f64) {
        self.poke_axis(0, name, value);
    }

    /// Sets fields of axis 0.
    fn set(&mut self, fields: &Json) {
        for (name, value) in fields.as_object().expect("fields") {
            self.poke(name, number(value));
        }
    }

    fn int(&self, name: &str) -> i32 {
        self.board.memory().peek(self.address(name))
    }

    /// Returns whether a field of an axis equals the recorded value, to the last recorded digit.
    fn is(&self, axis: u8, name: &str, expect: &Json) -> bool {
        let found = self.peek_axis(axis, name);
        if expect.is_boolean() { (found != 0.0) == *expect } else { is_same(found, expect) }
    }

    /// Runs to the end of the next interrupt, with a margin of a few cycles.
    fn interrupt(&mut self) {
        self.reach_match();
        self.run(SHORTEST);
        while self.is_in_interrupt() {
            self.run(STEP);
        }
    }

    /// Runs through an interrupt and the slice after it, from one match of the timer to the next.
    fn next_match(&mut self) {
        self.run(1);
        self.reach_match();
    }

    /// Runs to the next match of the timer; the interrupt is not taken yet.
    fn reach_match(&mut self) {
        let next = self.board.next_tick();
        self.board.run_to(next).unwrap_or_else(|crash| panic!("{crash}"));
    }

    fn run(&mut self, cycles: u64) {
        self.board.run_to(self.board.cycle() + cycles).unwrap_or_else(|crash| panic!("{crash}"));
    }

    fn ticks(&mut self, count: u32) {
        (0..count).for_each(|_| self.run(TICK));
    }

    fn is_in_interrupt(&self) -> bool {
        let registers = self.board.registers();
        registers.iter().any(|(name, value)| name == "CSR" && value & 1 == 0)
    }

    /// Sends a line; returns the text sent by the firmware until the line is executed.
    fn command(&mut self, line: &str) -> String {
        self.board.take_bytes();
        self.board.send_line(line.as_bytes());
        self.ticks(ANSWER);
        self.said()
    }

    /// Sends a line to a board that may have crashed; returns the reply, or an empty text.
    fn tried(&mut self, line: &str) -> String {
        self.board.take_bytes();
        self.board.send_line(line.as_bytes());
        let end = self.board.cycle() + u64::from(ANSWER) * TICK;
        // A crashed board does not answer.
        if self.board.run_to(end).is_err() { String::new() } else { self.said() }
    }

    /// Takes the text sent since the last call.
    fn said(&mut self) -> String {
        let bytes: Vec<u8> = self.board.take_bytes().into_iter().map(|(_, byte)| byte).collect();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// Takes the register writes since the last call.
    fn writes(&mut self) -> Vec<(usize, u16)> {
        let (external, _) = self.board.external_and_memory();
        std::mem::take(&mut external.expect("it is connected").writes)
    }

    /// The image of a program for a thread.
    fn compiled(&self, thread: ThreadId, source: &str) -> Vec<u8> {
        let firmware = Firmware::File(Arc::clone(&self.symbols));
        let options = Options { target: Target::C67x, firmware, ..Options::default() };
        let source = format!("#include \"KMotionDef.h\"\n{source}");
        let mut compilation = compile(Path::new("program.c"), source.into(), &options, &pp::Disk);
        let linked = compilation.link(thread, &options);
        let linked = linked.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics()));
        image::write(&linked).expect("an image")
    }

    /// Copies an image to a thread's space.
    fn load_image(&mut self, thread: ThreadId, image: &[u8]) {
        self.board.load_program(thread, image).unwrap_or_else(|error| panic!("{error}"));
    }

    /// Compiles a program and copies it to a thread's space.
    fn load(&mut self, thread: ThreadId, source: &str) -> Program {
        let image = self.compiled(thread, source);
        self.load_image(thread, &image);
        Program(Image::read(&image).expect("it is one"))
    }

    /// Starts threads and runs until `persist.UserData[9]` is set, for at most this many ticks.
    fn run_threads(&mut self, threads: &[ThreadId], most: u32) {
        let started = self.board.execute_together(threads);
        started.unwrap_or_else(|crash| panic!("{crash}"));
        for _ in 0..most {
            if self.user_data(9) != 0 {
                return;
            }
            self.ticks(1);
        }
        panic!("the program does not end");
    }

    fn user_data(&self, index: usize) -> i32 {
        let offset = kmotiondef::structs::Persist::USER_DATA.element(index).offset();
        self.board.memory().peek(self.address("persist").offset(offset))
    }
}

/// A program, for the addresses of its variables.
struct Program(Image);

impl Program {
    fn variable(&self, name: &str) -> GuestAddr {
        let named = |symbol: &&Symbol| symbol.name.to_str().trim_start_matches('_') == name;
        GuestAddr::new(self.0.symbols.iter().find(named).unwrap_or_else(|| panic!("there is a {name}")).value)
    }
}

/// Fails with all differences.
fn report(wrong: &[String], count: usize) {
    println!("{} of {count} rows agree", count - wrong.len());
    assert!(wrong.is_empty(), "{} of {count} rows differ:\n{}", wrong.len(), wrong.join("\n"));
}
