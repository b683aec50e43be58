//! Properties that must hold for all bytes: shared by the fuzz targets, by the random inputs of every test run, and by
//! the replay of earlier failures.
//!
//! A target converts bytes to an input and panics if the input does harm: a crash, engines that differ, an empty
//! message. The caller detects runs that take too long or too much memory.

use std::path::Path;
use std::sync::LazyLock;

use coff::Image;
use compiler::firmware::FirmwareFile;
use compiler::inspect::Inspection;
use compiler::object::Object;
use compiler::passes::Level;
use compiler::pp::MemoryFiles;
use compiler::{Options, image};
use kmotiondef::timing::Timing;
use kmotiondef::{ThreadId, Ticks};
use runtime::commands::COMMANDS;
use runtime::loader::{LoadError, prepare};
use runtime::stimulus::Stimulus;
use runtime::{Board, Config, Event, EventKind, MachineFile, ModelledBoard, RunEnd};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::machine::Config as MachineConfig;

use crate::choices::Choices;
use crate::{kinds, vendor, views};

/// A kind of input.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name: that of the fuzz target, and of the folder with inputs that once failed.
    pub name: &'static str,
    /// Tries the input for some bytes.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target { name: "source", run: source },
    Target { name: "tokens", run: tokens },
    Target { name: "image", run: changed_file },
    Target { name: "execution", run: changed_program },
    Target { name: "processor", run: changed_code },
    Target { name: "translated", run: translated_code },
    Target { name: "program", run: program },
    Target { name: "machine_file", run: machine_file },
    Target { name: "stimulus", run: stimulus },
    Target { name: "commands", run: commands },
    Target { name: "format", run: format },
    Target { name: "world", run: world },
    Target { name: "debug_adapter", run: views::debug_adapter },
    Target { name: "page", run: views::page },
    Target { name: "wire", run: views::wire },
];

/// The board time for an arbitrary program.
const SHORT: Ticks = Ticks::new(40);
/// The board time for a program that is tried very often.
const FEW: Ticks = Ticks::new(3);

fn thread_1() -> ThreadId {
    ThreadId::new(1).expect("1 is a thread")
}

/// The observations of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// The events, with board times.
    pub events: Vec<Event>,
    /// The reason why it ended.
    pub end: RunEnd,
}

/// Runs an image in thread 1 up to a board time.
///
/// # Errors
/// The image cannot be loaded.
///
/// # Panics
/// A loaded program cannot be started.
pub fn execute<E: Engine>(image: &[u8], limit: Ticks, config: Config) -> Result<(Seen, Board<E>), LoadError> {
    let mut board = Board::<E>::new(config);
    board.load(thread_1(), image)?;
    board.start(thread_1()).expect("it was loaded");
    let mut events = Vec::new();
    let end = board.run(limit, &mut |event| events.push(event));
    Ok((Seen { events, end }, board))
}

/// Runs an image on every available engine; neither the observations nor memory may depend on the engine.
///
/// # Errors
/// The image cannot be loaded.
///
/// # Panics
/// The engines differ.
pub fn execute_everywhere(image: &[u8], limit: Ticks) -> Result<Seen, LoadError> {
    let (seen, board) = execute::<BytecodeEngine>(image, limit, counting())?;
    #[cfg(feature = "native")]
    {
        let native = execute::<vm::native::NativeEngine>(image, limit, counting());
        let (others, other) = native.expect("what one engine takes, all take");
        assert_eq!(others, seen, "the engines differ");
        assert!(other.memory() == board.memory(), "the engines leave different memory");
    }
    #[cfg(not(feature = "native"))]
    drop(board);
    Ok(seen)
}

/// A configuration whose time counts the executed code, not the duration of the vendor's code: an engine that counts
/// wrongly is detected at once.
pub(crate) fn counting() -> Config {
    Config { timing: Timing::Fast, ..Config::default() }
}

/// Compiles and links; `None` after errors.
fn build(text: &[u8], level: Level) -> Option<Vec<u8>> {
    build_for(Options::default().target, text, level)
}

/// Compiles and links for a target; `None` after errors.
fn build_for(target: compiler::target::Target, text: &[u8], level: Level) -> Option<Vec<u8>> {
    let options = Options { target, level, ..Options::default() };
    let files = MemoryFiles::new();
    let mut compilation = compiler::compile(Path::new("input.c"), text.to_vec(), &options, &files);
    let linked = compilation.link(thread_1(), &options);
    for diagnostic in compilation.diagnostics() {
        assert!(!diagnostic.message.is_empty());
    }
    linked.and_then(|linked| image::write(&linked).ok())
}

/// Compiles any text; an accepted program must do the same on every engine.
pub fn source(bytes: &[u8]) {
    for level in [Level::Full, Level::None] {
        if let Some(image) = build(bytes, level) {
            let _ = execute_everywhere(&image, SHORT);
        }
    }
}

/// Fragments of C from which programs can be assembled.
const PIECES: &[&str] = &[
    "int ",
    "char ",
    "double ",
    "float ",
    "void ",
    "unsigned ",
    "long long ",
    "struct s ",
    "union u ",
    "enum ",
    "static ",
    "volatile ",
    "typedef ",
    "const ",
    "sizeof ",
    "{",
    "}",
    "{",
    "}",
    "(",
    ")",
    "(",
    ")",
    "[",
    "]",
    ";",
    ";",
    ";",
    ",",
    "=",
    "==",
    "+",
    "-",
    "*",
    "/",
    "%",
    "&",
    "|",
    "^",
    "<<",
    ">>",
    "&&",
    "||",
    "!",
    "~",
    "?",
    ":",
    "->",
    ".",
    "++",
    "--",
    "+=",
    "if(",
    "else ",
    "for(;;)",
    "for(x=0;x<9;x++)",
    "while(",
    "do ",
    "switch(x){",
    "case 1:",
    "default:",
    "break;",
    "continue;",
    "return ",
    "goto l;",
    "l:",
    "x",
    "y",
    "a",
    "p",
    "f",
    "f(",
    "main()",
    "main(){",
    "int x;",
    "int y=3;",
    "double d;",
    "int a[4];",
    "int *p;",
    "struct s{int m;char n[3];};",
    "int f(int x){",
    "0",
    "1",
    "2",
    "-1",
    "0x7fffffff",
    "1.5",
    "1e300",
    "2.5f",
    "'c'",
    "\"a%d\"",
    "printf(",
    "persist.UserData[",
    "chan[0].",
    "ch0->",
    "Delay_sec(",
    "SetBit(",
    "M(",
    "M",
    "N",
    "##",
    "#",
    "...",
    "\n",
    "\r\n",
    "\\\n",
    " ",
    "/*",
    "*/",
    "//",
    "\n#define M(x) x+x\n",
    "\n#define N M(N)\n",
    "\n#include \"KMotionDef.h\"\n",
    "\n#if 1\n",
    "\n#if M(1)\n",
    "\n#else\n",
    "\n#endif\n",
    "\n#undef M\n",
    "\u{e9}",
    "@",
    "`",
];

/// Compiles text made of fragments of C, which gets further than arbitrary text.
pub fn tokens(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    let mut text = String::new();
    while !choices.is_empty() {
        text.push_str(choices.pick(PIECES));
    }
    source(text.as_bytes());
}

/// An image and an object of a small program, an image of the vendor's compiler, a piece of firmware.
///
/// # Panics
/// The compiler does not compile it.
#[must_use]
pub fn valid_files() -> Vec<Vec<u8>> {
    let text = b"#include \"KMotionDef.h\"\nint table[3] = { 1, 2, 3 };\nstatic int n;\nint f(int x) { return x + table[1]; }\n\
                 main() { n = f(2); printf(\"%d %f\\n\", n, 1.5); }\n";
    let (options, files) = (Options::default(), MemoryFiles::new());
    let mut compilation = compiler::compile(Path::new("a.c"), text.to_vec(), &options, &files);
    let object = compilation.object.as_ref().expect("it compiles").write().expect("it fits");
    let linked = compilation.link(thread_1(), &options).expect("it links");
    let firmware =
        compiler::firmware::export(kmotiondef::boards::TargetBoard::default_board()).expect("it fits");
    vec![image::write(&linked).expect("it fits"), object, vendor::image(), firmware]
}

/// Passes bytes to all readers of files; returns whether they are an image that loads.
///
/// # Panics
/// A rejection has no reason, or readers disagree.
#[must_use]
pub fn read_file(bytes: &[u8]) -> bool {
    let read = Image::read(bytes);
    match &read {
        Ok(image) => {
            if image.symbols.len() < 100 {
                let inspection = Inspection::new(image.clone());
                let _ =
                    (inspection.headers(), inspection.line_table(), inspection.calls(), inspection.stack());
            }
        }
        Err(error) => assert!(error.to_string().contains("(at offset 0x"), "{error}"),
    }
    let _ = FirmwareFile::read(bytes);
    if let Ok(object) = Object::read(bytes) {
        let options = compiler::link::Options {
            thread: thread_1(),
            firmware: &compiler::firmware::BuiltIn,
            gc: false,
            addresses: compiler::link::SectionAddresses::default(),
        };
        // Code that links need not be a program that the machine accepts.
        let _ = compiler::link::link(std::slice::from_ref(&object), &options);
    }
    let prepared = prepare(bytes, thread_1(), &ModelledBoard::default(), |_| false);
    match &prepared {
        Ok(_) => assert!(read.is_ok()),
        Err(LoadError::NotAnImage(error)) => assert_eq!(Err(error), read.as_ref()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    prepared.is_ok()
}

/// Writes bytes to positions in `file`, most of them in its headers.
fn change(file: &mut [u8], choices: &mut Choices<'_>) {
    while !choices.is_empty() {
        let range = if choices.byte().is_multiple_of(3) { file.len() } else { file.len().min(200) };
        let (at, value) = (choices.below(range), choices.byte());
        file[at] = value;
    }
}

/// Passes a file with a few changes, or arbitrary bytes, to all readers.
pub fn changed_file(bytes: &[u8]) {
    static FILES: LazyLock<Vec<Vec<u8>>> = LazyLock::new(valid_files);
    let _ = read_file(bytes);
    let mut choices = Choices::new(bytes);
    let mut file = FILES[choices.below(FILES.len())].clone();
    change(&mut file, &mut choices);
    let _ = read_file(&file);
}

/// Loops, calls, memory, floating point and printing: a program with many features that can be broken.
pub const VICTIM: &str = r#"#include "KMotionDef.h"
int table[16];
double sum;
int mix(int a, int b) { return a * 31 + (b ^ table[a & 15]); }
main()
{
    int i, n = 1;

    for (i = 0; i < 40; i++)
    {
        n = mix(n, i);
        table[i & 15] = n;
        sum += n * 0.5;
        switch (n & 3)
        {
            case 0: n++; break;
            case 1: n ^= 5; break;
            default: n -= i;
        }
    }
    printf("%d %g\n", n, sum);
}
"#;

/// The image of [`VICTIM`].
///
/// # Panics
/// It does not compile.
#[must_use]
pub fn victim() -> Vec<u8> {
    build(VICTIM.as_bytes(), Level::Full).expect("it is a program")
}

/// A program whose image was changed in some bits: it is rejected, or does the same on every engine.
pub fn changed_program(bytes: &[u8]) {
    static IMAGE: LazyLock<Vec<u8>> = LazyLock::new(victim);
    let mut image = IMAGE.clone();
    let mut choices = Choices::new(bytes);
    while !choices.is_empty() {
        let at = choices.below(image.len());
        image[at] ^= 1 << (choices.byte() & 7);
    }
    let _ = execute_everywhere(&image, SHORT);
}

/// The image of [`VICTIM`] for the processor, with this number of iterations of its loop.
fn victim_code(turns: u32) -> Vec<u8> {
    let text = VICTIM.replace("i < 40", &format!("i < {turns}"));
    build_for(compiler::target::Target::C67x, text.as_bytes(), Level::Full).expect("it is a program")
}

/// The image with a few bits changed: most changes end a program early.
fn with_changed_bits(image: &[u8], bytes: &[u8]) -> Vec<u8> {
    let mut image = image.to_vec();
    let mut choices = Choices::new(bytes);
    for _ in 0..choices.byte() % 4 {
        let at = choices.below(image.len());
        image[at] ^= 1 << (choices.byte() & 7);
    }
    image
}

/// A program for the processor whose image was changed in some bits: it is rejected, or interpreted, with the same
/// result with and without shortcuts.
///
/// A fuzzer tries very many of them, so each has few cycles, and memory is not compared as a whole.
pub fn changed_code(bytes: &[u8]) {
    static IMAGE: LazyLock<Vec<u8>> = LazyLock::new(|| victim_code(40));
    let image = with_changed_bits(&IMAGE, bytes);
    let [with, without] = [true, false].map(|shortcuts| {
        let machine = MachineConfig { shortcuts, ..MachineConfig::default() };
        let run = execute::<BytecodeEngine>(&image, FEW, Config { machine, ..counting() });
        run.map(|(seen, _)| seen).ok()
    });
    assert_eq!(with, without, "shortcuts change what is seen");
}

/// A longer program for the processor whose image was changed in some bits: it is rejected, or does the same
/// interpreted and translated.
pub fn translated_code(bytes: &[u8]) {
    static IMAGE: LazyLock<Vec<u8>> = LazyLock::new(|| victim_code(2000));
    let _ = execute_everywhere(&with_changed_bits(&IMAGE, bytes), SHORT);
}

/// A generated program with defined behaviour, optimised and not, on every engine.
pub fn program(bytes: &[u8]) {
    let mut seed = [0; 8];
    let len = bytes.len().min(8);
    seed[..len].copy_from_slice(&bytes[..len]);
    let text = kinds::of_any_kind(u64::from_le_bytes(seed), "", "");
    let lines = |level| {
        let image = build(text.as_bytes(), level).expect("generated programs have no errors");
        let seen = execute_everywhere(&image, Ticks::new(100_000)).expect("it loads");
        let lines = seen.events.into_iter().filter_map(|event| match event.kind {
            EventKind::ConsoleLine(line) => Some(line),
            _ => None,
        });
        lines.collect::<Vec<_>>()
    };
    assert_eq!(lines(Level::Full), lines(Level::None), "optimised and not");
}

/// The program with which worlds are tried: it moves an axis and reads inputs.
fn mover() -> Vec<u8> {
    let text = b"#include \"KMotionDef.h\"\nmain() { EnableAxis(0); MoveRel(0, 100); while (!CheckDone(0)) persist.UserData[0] += ReadBit(46) + ADC(0); }\n";
    build(text, Level::Full).expect("it is a program")
}

static MOVER: LazyLock<Vec<u8>> = LazyLock::new(mover);

/// Any machine file: it is rejected with a message, or a board runs with it.
pub fn machine_file(bytes: &[u8]) {
    let lines = assemble(bytes, MACHINE_PIECES);
    match MachineFile::parse(&lines) {
        Ok(machine_file) => {
            let config = Config { machine_file, ..Config::default() };
            let _ = execute::<BytecodeEngine>(&MOVER, SHORT, config);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

const MACHINE_PIECES: &[&str] = &[
    "[axis.0]\n",
    "[axis.1]\n",
    "[axis.7]\n",
    "[board]\n",
    "[cpu]\n",
    "[uart]\n",
    "[host]\n",
    "[bits]\n",
    "[adc]\n",
    "motor",
    "follow",
    "step",
    "brushless",
    "encoder",
    "counts",
    "inertia",
    "friction",
    "home",
    "limit",
    "probe",
    "bit",
    "at",
    "=",
    "=",
    "=",
    "\n",
    "\n",
    "0",
    "1",
    "-1",
    "46",
    "136",
    "1e9",
    "-1e300",
    "nan",
    "inf",
    "1.5",
    "true",
    "false",
    "\"follow\"",
    "\"dc\"",
    "\"bit\"",
    "[",
    "]",
    "{",
    "}",
    ",",
    ".",
    "plant",
    "scale",
    "kind",
    "position",
    "kanalog",
    "konnect",
    "snapamp",
    "kstep",
    "\"\"",
    "#",
    "\u{e9}",
];

/// Any stimulus: it is rejected with a message, or a board runs with it.
pub fn stimulus(bytes: &[u8]) {
    match Stimulus::parse(&assemble(bytes, STIMULUS_PIECES), "input.stim") {
        Ok(stimulus) => {
            let mut board = Board::<BytecodeEngine>::new(Config::default());
            board.load(thread_1(), &MOVER).expect("it is a program");
            board.play(stimulus);
            board.start(thread_1()).expect("it was loaded");
            board.run(SHORT, &mut |_| {});
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// A machine file and a stimulus together, from the example programs and with some words changed: rejected with a
/// message, or a board runs with both.
pub fn world(bytes: &[u8]) {
    static MACHINES: LazyLock<Vec<String>> = LazyLock::new(|| examples("toml"));
    static STIMULI: LazyLock<Vec<String>> = LazyLock::new(|| examples("stim"));
    let mut choices = Choices::new(bytes);
    let (machine, inputs) = (choices.below(MACHINES.len()), choices.below(STIMULI.len()));
    let (mut machine, mut inputs) = (MACHINES[machine].clone(), STIMULI[inputs].clone());
    while !choices.is_empty() {
        if choices.byte().is_multiple_of(2) {
            machine = with_changed_word(&machine, MACHINE_PIECES, &mut choices);
        } else {
            inputs = with_changed_word(&inputs, STIMULUS_PIECES, &mut choices);
        }
    }
    let (file, stimulus) = (MachineFile::parse(&machine), Stimulus::parse(&inputs, "input.stim"));
    let reasons =
        [file.as_ref().err().map(ToString::to_string), stimulus.as_ref().err().map(ToString::to_string)];
    assert!(reasons.iter().flatten().all(|reason| !reason.is_empty()));
    let mut board =
        Board::<BytecodeEngine>::new(Config { machine_file: file.unwrap_or_default(), ..Config::default() });
    board.load(thread_1(), &MOVER).expect("it is a program");
    if let Ok(stimulus) = stimulus {
        board.play(stimulus);
    }
    board.start(thread_1()).expect("it was loaded");
    board.run(SHORT, &mut |_| {});
}

/// The texts of the example programs' files with an extension.
fn examples(extension: &str) -> Vec<String> {
    let files = crate::files(&crate::root().join("c-programs"), extension);
    files.iter().map(|path| std::fs::read_to_string(path).expect("it is text")).collect()
}

/// A text with one word replaced by a piece.
fn with_changed_word(text: &str, pieces: &[&str], choices: &mut Choices<'_>) -> String {
    let words: Vec<&str> = text.split_inclusive([' ', '\n', '=', ',']).collect();
    let at = choices.below(words.len().clamp(1, 65_536));
    let piece = choices.pick(pieces);
    let changed = words.iter().enumerate().map(|(index, word)| if index == at { piece } else { word });
    changed.collect()
}

const STIMULUS_PIECES: &[&str] = &[
    "at ", "when ", "after ", "every ", "t=", "0.001", "1ms", "2us", "1.5s", "-1", "0", "1", "46", "136",
    "2000", "set ", "clear ", "pulse ", "toggle ", "bit ", "bit", "=", " = ", "adc ", "sine ", "ramp ",
    "noise ", "axis ", "push ", "for ", "rises ", "falls ", "expect ", "uart ", "\"text\"", "encoder ",
    "persist.", "run.", "host", "stop", "\n", "\n", "\n", ",", ";", "(", ")", "1e300", "nan", "#", "\u{e9}",
];

/// A text from bytes: most bytes select a piece, every eighth is taken literally.
fn assemble(bytes: &[u8], pieces: &[&str]) -> String {
    let mut choices = Choices::new(bytes);
    let mut text = String::new();
    while !choices.is_empty() {
        match choices.byte() {
            0..=31 => text.push(char::from(choices.byte())),
            _ => text.push_str(choices.pick(pieces)),
        }
    }
    text
}

/// Lines from the PC: after any lines, the next valid command is answered.
pub fn commands(bytes: &[u8]) {
    let mut board = Board::<BytecodeEngine>::new(Config::default());
    let names = COMMANDS.iter().map(|command| command.name);
    let pieces: Vec<&str> =
        names.chain(ARGUMENT_PIECES.iter().copied().cycle().take(2 * COMMANDS.len())).collect();
    let text = assemble(bytes, &pieces);
    for line in text.split('\n') {
        let mut has_stopped = false;
        board.receive(&[b"\x1b\x01", line.as_bytes(), b"\r"].concat());
        let limit = Ticks::new(board.tick().get() + SHORT.get());
        board.run_until(limit, &mut |event| {
            has_stopped |=
                matches!(&event.kind, EventKind::Remark(remark) if remark.message.code() == "firmware-stops");
            false
        });
        // Input that stops the released firmware also stops this one: such a board is switched off and on.
        if has_stopped {
            board = Board::new(Config::default());
        }
    }
    // A command may wait for data lines, and replies may go to the UART: both states are left first.
    answer(&mut board, b"\x03\x1b\x01USB\r");
    assert!(answer(&mut board, b"\x1b\x01Version\r").is_some_and(|line| line.starts_with(b"KFLOP 4.34")));
}

/// Fragments of command arguments.
const ARGUMENT_PIECES: &[&str] = &[
    "0", "1", "7", "8", "-1", "99", "1e9", "0.5", "nan", "FFFFFFFF", "80050000", " ", " ", " ", "=", "=",
    ";", "\n", "\n", "\n",
];

/// The next reply of the board, if one comes within a second of board time.
fn answer(board: &mut Board<BytecodeEngine>, line: &[u8]) -> Option<Vec<u8>> {
    board.receive(line);
    let mut last = None;
    let mut patience = 5_000;
    while board.is_receiving() && patience > 0 {
        let limit = Ticks::new(board.tick().get() + 2);
        board.run_until(limit, &mut |event| {
            if let EventKind::Reply(line) = event.kind {
                last = Some(line);
            }
            false
        });
        patience -= 1;
    }
    last
}

const FORMAT_PIECES: &[&str] = &[
    "%",
    "%",
    "%",
    "%d",
    "%i",
    "%u",
    "%x",
    "%f",
    "%g",
    "%e",
    "%s",
    "%c",
    "%p",
    "%n",
    "%[a-f]",
    "%[^]x]",
    "%*d",
    "l",
    "ll",
    "h",
    "-",
    "+",
    "#",
    "0",
    " ",
    "*",
    ".",
    "1",
    "5",
    "20",
    "99999999999",
    "f",
    "g",
    "e",
    "a",
    "d",
    "x",
    "s",
    "c",
    "%%",
    "12",
    "3.5",
    "text",
    "\\n",
];

/// Any format for `printf` and `sscanf`, on every engine.
pub fn format(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    let mut take = |count: usize| {
        let mut text = String::new();
        while !choices.is_empty() && text.len() < count {
            text.push_str(choices.pick(FORMAT_PIECES));
        }
        text
    };
    let (print, scan, input) = (take(40), take(40), take(60));
    let text = format!(
        "#include \"KMotionDef.h\"\nint a[8]; double d[8]; char s[400];\nmain()\n{{\n  char *format = \"{print}\";\n  \
         printf(format, 7, 2.5, s, 1e300, -3, d, 0x12345678, 1.0, 2, 3, 4, 5);\n  printf(\"\\n%d\\n\", \
         sscanf(\"{input}\", \"{scan}\", a, d, s, a + 2, d + 2, s + 100, a + 4, d + 4));\n  printf(\"%d %d %g %s\\n\", a[0], a[2], d[0], \
         s);\n}}\n"
    );
    let image = build(text.as_bytes(), Level::Full).expect("its formats are strings like others");
    execute_everywhere(&image, Ticks::new(2000)).expect("it loads");
}
