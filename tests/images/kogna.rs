//! Images for Kogna: both formats that its loader accepts, and code that its processor executes.

use std::fs;

use coff::{Container, Image};
use compiler::firmware::Firmware;
use compiler::passes::Level;
use compiler::pp::Disk;
use compiler::target::Target;
use compiler::{Options, image};
use goblin::elf::Elf;
use goblin::elf::header::{EM_TI_C6000, ET_EXEC};
use goblin::elf::section_header::{SHF_ALLOC, SHT_NOBITS, SHT_PROGBITS};
use harness::{Scratch, cc67, files, root};
use kmotiondef::ThreadId;
use kmotiondef::boards::TargetBoard;

const PROGRAM: &str = "#include \"KMotionDef.h\"
int table[4] = { 1, 2, 3, 4 }, zeros[100];
static int half(int n) { return n / table[1]; }
main() { ch8->Dest = half(zeros[7]); SetBit(250); printf(\"%d %f\\n\", half(9), sin(0.5)); }
";

/// The note about properties that were never compared.
const NOTE: &str = "cc67: kogna-5.3.2 is known from its header, manual and firmware file, and was never compared with a board\n";

#[track_caller]
fn succeed(scratch: &Scratch, arguments: &[&str]) -> String {
    let output = cc67(scratch, arguments);
    let is_kogna = arguments.contains(&"kogna-5.3.2") || arguments.contains(&"DSPKOGNA.out");
    let expect = if arguments[0] == "build" && is_kogna { NOTE } else { "" };
    assert_eq!((output.code, output.stderr.as_str()), (0, expect), "{arguments:?}: {output:?}");
    output.stdout
}

fn kogna() -> &'static TargetBoard {
    TargetBoard::named("kogna-5.3.2").expect("the board is known")
}

#[test]
fn an_elf_image_has_what_the_loader_of_the_board_reads() {
    let scratch = Scratch::new("kogna-elf");
    scratch.write("a.c", PROGRAM);
    succeed(&scratch, &["build", "--board", "kogna-5.3.2", "-t", "2", "--form", "elf", "a.c"]);
    let bytes = fs::read(scratch.path().join("a(2).out")).expect("it was written");
    let elf = Elf::parse(&bytes).expect("another reader reads it");
    assert_eq!((elf.header.e_machine, elf.header.e_type, elf.is_64), (EM_TI_C6000, ET_EXEC, false));
    assert_eq!(elf.entry, 0xC00C_0000, "`main` is the first function of thread 2");
    let loaded: Vec<_> = elf
        .section_headers
        .iter()
        .filter(|header| u64::from(SHF_ALLOC) & header.sh_flags != 0)
        .map(|header| (&elf.shdr_strtab[header.sh_name], header.sh_type, header.sh_addr, header.sh_size))
        .collect();
    // The loader accepts only PROGBITS and clears nothing.
    assert!(elf.section_headers.iter().all(|header| header.sh_type != SHT_NOBITS));
    let names: Vec<_> = loaded.iter().map(|(name, ..)| *name).collect();
    assert_eq!(names, [".text", ".data", ".bss"]);
    assert!(loaded.iter().all(|(_, kind, address, _)| *kind == SHT_PROGBITS && *address >= 0xC00C_0000));
    assert_eq!(loaded[2].3, 400, "the zeros of `zeros`");
    let symbol = |name: &str| {
        let found = elf.syms.iter().find(|symbol| elf.strtab.get_at(symbol.st_name) == Some(name));
        found.map(|symbol| (symbol.st_value, symbol.is_function()))
    };
    let printf = kogna().function("printf").expect("it has one").address.get();
    assert_eq!(symbol("printf"), Some((u64::from(printf), true)));
    assert_eq!(symbol("main"), Some((0xC00C_0000, true)));
}

#[test]
fn both_forms_load_the_same_bytes() {
    let scratch = Scratch::new("kogna-forms");
    scratch.write("a.c", PROGRAM);
    let build = |form: &str| {
        let name = format!("{form}.out");
        let arguments =
            ["build", "--board", "kogna-5.3.2", "--download-script", "--form", form, "-o", &name, "a.c"];
        succeed(&scratch, &arguments);
        fs::read_to_string(scratch.path().join(format!("{form}.kmd"))).expect("it was written")
    };
    assert_eq!(build("coff"), build("elf"));
    let shown = |name: &str| succeed(&scratch, &["inspect", "-d=main", name]);
    let code = |name: &str| {
        let text = shown(name);
        text.lines().filter(|line| line.starts_with("c008")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(code("elf.out").len() > 20);
    let without_lines = |line: &String| !line.contains("a.c:");
    let coff: Vec<_> = code("coff.out").into_iter().filter(without_lines).collect();
    assert_eq!(code("elf.out"), coff);
    insta::assert_snapshot!(succeed(&scratch, &["inspect", "elf.out"]));
}

#[test]
fn elf_images_are_of_boards_that_load_them() {
    let scratch = Scratch::new("kogna-only");
    scratch.write("a.c", "main() {}\n");
    let refused = |arguments: &[&str]| {
        let output = cc67(&scratch, [&["build", "--form", "elf", "a.c"], arguments].concat());
        assert_eq!(output.code, 2);
        output.stderr
    };
    assert_eq!(refused(&[]), "cc67: `--form elf`: kflop-4.34 loads COFF images alone\n");
    let bytecode = refused(&["--board", "kogna-5.3.2", "--target", "sim"]);
    assert!(bytecode.contains("`--form elf` needs the controller's code"), "{bytecode}");
}

#[test]
fn a_simulated_kflop_refuses_an_image_for_kogna_by_name() {
    let scratch = Scratch::new("kogna-refused");
    scratch.write("a.c", "main() {}\n");
    for form in ["coff", "elf"] {
        succeed(&scratch, &["build", "--board", "kogna-5.3.2", "--form", form, "a.c"]);
        for board in ["kflop-4.34", "kflop-5.3.2"] {
            let output = cc67(&scratch, ["run", "--board", board, "a(1).out"]);
            assert_eq!(output.code, 2);
            let expect = "linked for KOGNA firmware 5.3.2; the board runs KFLOP ";
            assert!(output.stderr.contains(expect), "{form}: {}", output.stderr);
        }
    }
}

#[test]
fn the_firmware_file_of_kogna_is_elf_and_links_as_the_table_does() {
    let scratch = Scratch::new("kogna-firmware");
    scratch.write("a.c", PROGRAM);
    succeed(&scratch, &["firmware", "export", "--board", "kogna-5.3.2", "DSPKOGNA.out"]);
    let shown = succeed(&scratch, &["inspect", "--headers", "DSPKOGNA.out"]);
    assert!(shown.starts_with("ELF, target C6000"), "{shown}");
    succeed(&scratch, &["build", "--firmware", "DSPKOGNA.out", "-o", "file.out", "a.c"]);
    succeed(&scratch, &["build", "--board", "kogna-5.3.2", "-o", "table.out", "a.c"]);
    let bytes = |name: &str| fs::read(scratch.path().join(name)).expect("it was written");
    assert_eq!(bytes("file.out"), bytes("table.out"));
}

/// Uses the released file if `CC67_FIRMWARE_KOGNA` names one.
#[test]
fn the_released_firmware_of_kogna_links_as_the_table_does() {
    let Some(path) = std::env::var_os("CC67_FIRMWARE_KOGNA") else {
        println!("not run: CC67_FIRMWARE_KOGNA names no firmware file of Kogna");
        return;
    };
    let bytes = fs::read(path).expect("CC67_FIRMWARE_KOGNA names a file");
    let file = compiler::firmware::FirmwareFile::read(&bytes).expect("it is a firmware file");
    assert_eq!(file.board(), Some(kogna()));
    let symbols: Vec<_> = file.symbols().collect();
    assert_eq!(symbols.len(), 1331);
    let mut known = kogna().symbols();
    known.sort_unstable();
    assert_eq!(symbols, known);
}

/// A fetch packet whose last word begins with the bits 1110 contains compact instructions on a C674x, and a program
/// space whose first word is 0 contains no program for its firmware.
#[test]
fn programs_have_no_word_that_the_processor_of_kogna_takes_for_something_else() {
    let options = |level| Options {
        firmware: Firmware::Board(kogna()),
        target: Target::C67x,
        level,
        ..Options::default()
    };
    let mut programs = 0;
    for path in files(&root().join("c-programs"), "c") {
        for level in [Level::None, Level::Full, Level::Fast] {
            let options = options(level);
            let text = fs::read(&path).expect("programs are readable");
            let mut compilation = compiler::compile(&path, text, &options, &Disk);
            let thread = ThreadId::new(1).expect("1 is a thread");
            let Some(linked) = compilation.link(thread, &options) else { continue };
            let bytes = image::write_as(Container::Elf, &linked).expect("it fits");
            let image = Image::read(&bytes).expect("it is one");
            let words = image.section(".text").expect("it has code").data().as_chunks::<4>().0.to_vec();
            let word = |index: usize| u32::from_le_bytes(words[index]);
            assert_ne!(word(0), 0, "{}", path.display());
            for last in (7..words.len()).step_by(8) {
                assert_ne!(word(last) >> 28, 0b1110, "{}: word {last}", path.display());
            }
            programs += 1;
        }
    }
    assert!(programs >= 120, "{programs}");
}

#[test]
fn cycles_of_an_image_are_those_of_its_board() {
    let scratch = Scratch::new("kogna-cycles");
    scratch.write("a.c", PROGRAM);
    let shown = |board: &str| {
        succeed(&scratch, &["build", "--board", board, "a.c"]);
        succeed(&scratch, &["cycles", "a(1).out"]).lines().next().map(str::to_owned)
    };
    let expect = "cycles at 456 MHz; share of the 41040 between two interrupts (90 µs)";
    assert_eq!(shown("kogna-5.3.2").as_deref(), Some(expect));
    scratch.write("a.c", "main() {}\n");
    let expect = "cycles at 200 MHz; share of the 18000 between two interrupts (90 µs)";
    assert_eq!(shown("kflop-5.3.2").as_deref(), Some(expect));
}

#[test]
fn a_program_that_moves_to_kogna_is_told_what_it_meets() {
    let scratch = Scratch::new("kogna-diff");
    scratch.write(
        "a.c",
        "main() { ProgramFlash(1, 2, \"a\", \"b\"); chan[0].Dest = N_CHANNELS; SetBit(46); }\n",
    );
    let output = cc67(&scratch, ["diff", "--boards", "kflop-5.3.2", "kogna-5.3.2", "a.c"]);
    assert_eq!(output.code, 1);
    let lines: Vec<_> = output.stdout.lines().map(|line| line.split_whitespace().next()).collect();
    assert_eq!(lines, [Some("N_CHANNELS"), Some("ProgramFlash"), Some("chan")], "{}", output.stdout);
}
