//! The modelled board with firmware 5.3.2, compared with the recorded behaviour of the released firmware:
//! `data/vectors/fw5.jsonl`.
//!
//! `released/firmware_5` compares the same rows with the firmware itself. The texts of `fw5-text.jsonl` are compared in
//! the tests of the formatter.

mod moves;
mod programs;
mod sessions;

use std::path::Path;

use coff::Image;
use compiler::firmware::Firmware;
use compiler::{Options, compile, image, pp};
use kmotiondef::boards::TargetBoard;
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::timing::Timing;
use kmotiondef::variables::{CHAN, PERSIST};
use kmotiondef::{CType, GuestAddr, ThreadId};
use runtime::{Board, Config, EventKind, ModelledBoard};
use serde_json::Value as Json;

/// The number of ticks after which a line has been executed and answered.
const ANSWER: u32 = 40;

/// The board of the rows.
fn target() -> &'static TargetBoard {
    TargetBoard::named("kflop-5.3.2").expect("it is known")
}

/// The rows of some kinds, with their numbers.
fn rows(kinds: &[&str]) -> Vec<(usize, Json)> {
    let path = harness::root().join("tests/data/vectors/fw5.jsonl");
    let lines = std::fs::read_to_string(path).expect("the measurements are there");
    let rows = lines.lines().map(|line| serde_json::from_str::<Json>(line).expect("each line is JSON"));
    rows.enumerate().filter(|(_, row)| kinds.contains(&text(&row["kind"]))).collect()
}

fn text(value: &Json) -> &str {
    value.as_str().expect("text")
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| if value == "nan" { f64::NAN } else { panic!("{value} is a number") })
}

fn list(value: &Json) -> &[Json] {
    value.as_array().expect("a list")
}

fn thread(number: i32) -> ThreadId {
    ThreadId::new(number).expect("a thread")
}

/// Compares rows, each on a new board; fails with all differences.
fn compare(kinds: &[&str], differences: impl Fn(&Json) -> Vec<String>) {
    let (rows, mut wrong) = (rows(kinds), Vec::new());
    for (index, row) in &rows {
        let found = differences(row);
        if !found.is_empty() {
            wrong.push(format!("row {index} ({}): {}", row["name"], found.join("\n ")));
        }
    }
    assert!(wrong.is_empty(), "{} of {} rows:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

/// A program, for the addresses of its variables.
struct Program(Image);

impl Program {
    fn variable(&self, name: &str) -> GuestAddr {
        let mut symbols = self.0.symbols.iter();
        let symbol = symbols.find(|symbol| symbol.name.to_str().trim_start_matches('_') == name);
        GuestAddr::new(symbol.unwrap_or_else(|| panic!("there is a {name}")).value)
    }
}

/// A board under test.
struct Model {
    board: Board,
    said: String,
}

impl Model {
    fn new() -> Self {
        let board = ModelledBoard::of(target()).expect("it is modelled");
        let board = Board::new(Config { board, timing: Timing::VENDOR, ..Config::default() });
        let mut model = Self { board, said: String::new() };
        model.ticks(10);
        model
    }

    fn ticks(&mut self, count: u32) {
        for _ in 0..count {
            let said = &mut self.said;
            self.board.advance(self.board.tick().next(), &mut |event| match event.kind {
                EventKind::ConsoleLine(line) => {
                    said.push_str(&format!("\u{1b}{}\r\n", String::from_utf8_lossy(&line)));
                }
                EventKind::Reply(line) => said.push_str(&format!("{}\r\n", String::from_utf8_lossy(&line))),
                _ => {}
            });
        }
    }

    /// Sends a line; returns the reply.
    fn command(&mut self, line: &str) -> String {
        self.said.clear();
        self.board.receive(format!("\u{1b}\u{1}{line}\r").as_bytes());
        self.ticks(ANSWER);
        std::mem::take(&mut self.said)
    }

    fn load(&mut self, thread: ThreadId, source: &str) -> Program {
        let firmware = Firmware::Board(target());
        let options = Options { firmware, timing: Timing::VENDOR, ..Options::default() };
        let source = format!("#include \"KMotionDef.h\"\n{source}");
        let mut compilation = compile(Path::new("program.c"), source.into(), &options, &pp::Disk);
        let linked = compilation.link(thread, &options);
        let linked = linked.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics()));
        let bytes = image::write(&linked).expect("an image");
        self.board.load(thread, &bytes).unwrap_or_else(|error| panic!("{error}"));
        Program(Image::read(&bytes).expect("it is one"))
    }

    fn int(&self, address: GuestAddr) -> i32 {
        self.board.memory().peek(address)
    }

    fn double(&self, address: GuestAddr) -> f64 {
        self.board.memory().peek(address)
    }

    fn user_data(&self, index: usize) -> i32 {
        let memory = self.board.memory();
        memory.peek(memory.place_of(PERSIST.field(Persist::USER_DATA).element(index).address()))
    }

    /// The address of a field of axis 0, and its type.
    fn field(&self, name: &str) -> (GuestAddr, CType) {
        let field = Chan::STRUCTURE.fields.iter().find(|field| field.name == name).expect(name);
        (self.board.memory().place_of(CHAN.address().offset(field.offset)), field.ty)
    }

    fn peek(&self, name: &str) -> f64 {
        let ((at, ty), memory) = (self.field(name), self.board.memory());
        match ty {
            CType::Float => f64::from(memory.peek::<f32>(at)),
            CType::Double => memory.peek(at),
            _ => f64::from(memory.peek::<i32>(at)),
        }
    }

    fn poke(&mut self, name: &str, value: f64) {
        let ((at, ty), memory) = (self.field(name), self.board.memory_mut());
        match ty {
            CType::Float => memory.poke(at, value as f32),
            CType::Double => memory.poke(at, value),
            _ => memory.poke(at, value as i32),
        }
    }
}
