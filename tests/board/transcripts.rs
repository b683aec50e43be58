//! A transcript for every script command: the input, the board's reply, and the effect.
//!
//! Transcripts are the files of `data/commands`; each section begins with a freshly booted board. Most replies agree
//! with those recorded from the released firmware, which the tests of `runtime` replay byte for byte; commands that
//! were not recorded (programs, flash, uploads of recorded samples, `ReadDiskData`) answer as the specification says.
//!
//! | line | meaning |
//! |---|---|
//! | `== NAME NAME` | begins a section: the commands that it covers |
//! | `> TEXT` | a line for the board, or a data line of the command in progress |
//! | `M> TEXT` | the same, an example of both of the manual's command references; `M1>`, `M2>` of only one |
//! | `program N: SOURCE` | loads a program into thread N |
//! | `wait SECONDS`, `drive BIT LEVEL` | lets board time pass; drives an input from outside |
//! | `? ITEM` | requests an effect: an item of `--trace-items`, `thread N`, or `hex`, `int`, `float`, `double`, `text` of a firmware variable |
//! | `# TEXT` | a remark |
//!
//! All other lines of the files are outputs: replies unchanged, console lines after `| `, remarks of the simulation
//! after `cc67: `, effects after `= `. `CC67_WRITE_TRANSCRIPTS=1` writes the present outputs, for review.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use compiler::{Options, image, pp};
use kmotiondef::variables::variable_named;
use kmotiondef::{Bit, GuestAddr, ThreadId, Ticks};
use runtime::commands::{COMMANDS, command_at};
use runtime::trace::Item;
use runtime::{Board, Config, Event, EventKind, Severity};

/// The number of ticks that a line and its reply take on the wire, as recorded.
const EXCHANGE: u64 = 28;
/// The length of a tick in seconds.
const TIMEBASE: f64 = 90e-6;
/// The number of lines from which a reply is shown by its first lines and a checksum of all.
const LONGEST: usize = 16;
/// The number of lines shown of such a reply.
const SHOWN: usize = 3;

/// Prompts, and the command references from which the examples after them are taken.
const PROMPTS: [(&str, &[usize]); 4] = [("> ", &[]), ("M> ", &[0, 1]), ("M1> ", &[0]), ("M2> ", &[1])];

/// The line after a prompt, and the references from which it is taken.
fn sent(line: &str) -> Option<(&str, &'static [usize])> {
    PROMPTS.iter().find_map(|(prompt, of)| line.strip_prefix(prompt).map(|text| (text, *of)))
}

/// Returns whether a line of a transcript is an input; all others are outputs.
fn is_input(line: &str) -> bool {
    let begins = ["== ", "#", "program ", "wait ", "drive ", "? "];
    line.is_empty() || sent(line).is_some() || begins.iter().any(|begin| line.starts_with(begin))
}

/// Plays the lines of a section.
struct Player {
    board: Board,
    out: String,
}

impl Player {
    fn new() -> Self {
        let mut board = Board::new(Config::default());
        board.hear_uart();
        Self { board, out: String::new() }
    }

    fn play(&mut self, line: &str) {
        self.out += &format!("{line}\n");
        if let Some((text, _)) = sent(line) {
            return self.send(text);
        }
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "wait" => self.advance((rest.parse::<f64>().expect(line) / TIMEBASE).round() as u64),
            "drive" => {
                let (bit, level) = rest.split_once(' ').expect(line);
                self.board.drive_input(Bit::new(bit.parse().expect(line)).expect(line), level == "1");
            }
            "program" => self.load(rest),
            "?" => {
                let value = self.value(rest);
                self.out += format!("= {value}").trim_end();
                self.out.push('\n');
            }
            _ => {}
        }
    }

    /// Loads `N: SOURCE`.
    fn load(&mut self, text: &str) {
        let (thread, source) = text.split_once(": ").expect(text);
        let thread = ThreadId::new(thread.parse().expect(text)).expect(text);
        let source = format!("#include \"KMotionDef.h\"\n{source}\n").into_bytes();
        let options = Options::default();
        let mut compilation = compiler::compile(Path::new("program.c"), source, &options, &pp::Disk);
        let linked = compilation.link(thread, &options).expect(text);
        self.board.load(thread, &image::write(&linked).expect(text)).expect(text);
    }

    fn send(&mut self, line: &str) {
        let is_data = self.board.is_in_command();
        self.board.receive(format!("\x1b\x01{line}\r").as_bytes());
        let mut events = Vec::new();
        let begin = self.board.tick().get();
        while self.board.is_receiving() {
            let limit = self.board.tick().next();
            self.board.advance(limit, &mut |event| events.push(event));
        }
        if !is_data && !self.board.is_in_command() {
            let limit = Ticks::new(begin + EXCHANGE);
            self.board.run_until(limit, &mut |event| {
                events.push(event);
                false
            });
        }
        self.show(events);
    }

    fn advance(&mut self, ticks: u64) {
        let mut events = Vec::new();
        let limit = Ticks::new(self.board.tick().get() + ticks);
        self.board.run_until(limit, &mut |event| {
            events.push(event);
            false
        });
        self.show(events);
    }

    fn show(&mut self, events: Vec<Event>) {
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        let mut lines = Vec::new();
        let mut uart = Vec::new();
        for event in events {
            match event.kind {
                EventKind::Reply(line) => lines.push(text(line)),
                EventKind::ConsoleLine(line) => lines.push(format!("| {}", text(line)).trim_end().to_owned()),
                EventKind::UartSent(byte) => uart.push(byte),
                EventKind::Remark(remark) if remark.message.severity() > Severity::Detail => {
                    lines.push(format!("cc67: {remark}"));
                }
                EventKind::Host(text) => lines.push(format!("cc67: {text}")),
                EventKind::Trap(trap) => lines.push(format!("cc67: trap: {}", trap.kind)),
                _ => {}
            }
        }
        if !uart.is_empty() {
            lines.push(format!("uart {:?}", text(uart)));
        }
        if lines.len() > LONGEST {
            let sum = lines
                .iter()
                .flat_map(|line| line.bytes())
                .fold(0x811c_9dc5_u32, |sum, byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193));
            let rest = format!("… {} more lines; the FNV-1a sum of all is {sum:08x}", lines.len() - SHOWN);
            lines.truncate(SHOWN);
            lines.push(rest);
        }
        for line in lines {
            self.out += &format!("{line}\n");
        }
    }

    /// The value of an effect.
    fn value(&self, text: &str) -> String {
        if let Ok(item) = Item::new(text) {
            // Decimals beyond the sixth are compared by the tests of motion.
            return ((self.board.value(item) * 1e6).round() / 1e6).to_string();
        }
        let (kind, place) = text.split_once(' ').expect(text);
        if kind == "thread" {
            let thread = ThreadId::new(place.parse().expect(text)).expect(text);
            return if self.board.thread(thread).is_active() { "active" } else { "not active" }.to_owned();
        }
        let (name, offset) = place.split_once('+').unwrap_or((place, "0"));
        let base = variable_named(name).map(|variable| variable.address);
        let base = base.or_else(|| u32::from_str_radix(name, 16).ok().map(GuestAddr::new)).expect(text);
        let (memory, address) = (self.board.memory(), base.offset(offset.parse().expect(text)));
        match kind {
            "hex" => format!("{:X}", memory.peek::<u32>(address)),
            "int" => memory.peek::<i32>(address).to_string(),
            "float" => memory.peek::<f32>(address).to_string(),
            "double" => memory.peek::<f64>(address).to_string(),
            "text" => String::from_utf8_lossy(&memory.read_c_string(address, 200).expect(text)).into_owned(),
            _ => panic!("{text}"),
        }
    }
}

/// Replays the inputs of a transcript, and returns the resulting transcript.
fn replay(text: &str) -> String {
    let mut player = Player::new();
    for line in text.lines().filter(|line| is_input(line)) {
        if line.starts_with("== ") {
            player = Player { out: player.out, ..Player::new() };
        }
        player.play(line);
    }
    player.out
}

fn transcripts() -> Vec<(PathBuf, String)> {
    let files = harness::files(&harness::root().join("tests/data/commands"), "txt");
    files.into_iter().map(|path| (path.clone(), fs::read_to_string(path).expect("it is text"))).collect()
}

/// The first line that differs, with the expected one.
fn difference(path: &Path, found: &str, expect: &str) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut lines = (1..).zip(found.lines().chain([""]).zip(expect.lines().chain([""])));
    let (number, (found, expect)) = lines.find(|(_, (found, expect))| found != expect).unwrap_or_default();
    format!("{name}:{number}\n  found  {found}\n  expect {expect}")
}

#[test]
fn commands_answer_and_act_as_their_transcripts_say() {
    let writes = std::env::var_os("CC67_WRITE_TRANSCRIPTS").is_some();
    let mut wrong = Vec::new();
    for (path, expect) in transcripts() {
        let found = replay(&expect);
        if found == expect {
            continue;
        }
        wrong.push(difference(&path, &found, &expect));
        if writes {
            fs::write(&path, found).expect("transcripts are writable");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_command_has_a_transcript() {
    let (mut lines, mut examples, mut covered) = (0, [0, 0], BTreeSet::new());
    for (path, text) in transcripts() {
        for section in text.split("== ").skip(1) {
            let title = section.lines().next().unwrap_or_default();
            let sent: Vec<_> = section.lines().filter_map(sent).collect();
            lines += sent.len();
            sent.iter().for_each(|(_, of)| of.iter().for_each(|&reference| examples[reference] += 1));
            let parts = sent.iter().flat_map(|(line, _)| line.split(';')).filter_map(command_at);
            let used: BTreeSet<&str> = parts.map(|command| command.name).collect();
            for name in title.split_whitespace().take_while(|name| !name.starts_with('(')) {
                assert!(used.contains(name), "{}: section {title} does not send {name}", path.display());
                covered.insert(name.to_owned());
            }
        }
    }
    let [first, second] = examples;
    println!(
        "{} of {} commands have a transcript; {lines} lines, {first} and {second} of them examples of the manual's two references",
        covered.len(),
        COMMANDS.len()
    );
    let missing: Vec<_> =
        COMMANDS.iter().map(|command| command.name).filter(|name| !covered.contains(*name)).collect();
    assert!(missing.is_empty(), "commands without a transcript: {missing:?}");
}
