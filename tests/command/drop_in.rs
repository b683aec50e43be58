//! `cc67` in place of the vendor's compiler: its command lines, messages and images.

use std::fs;
use std::path::PathBuf;

use coff::{
    BaseType, Container, Contents, FileFlags, Image, Name, Section, SectionFlags, SectionNumber,
    StorageClass, Symbol, SymbolType, Target,
};
use harness::{Output, Scratch, cc67, run_in};
use kmotiondef::GuestAddr;
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::limits::VERSION;
use kmotiondef::variables::FIRMWARE_VARIABLES;

const BLINK: &str = "#include \"KMotionDef.h\"\nint count = 3;\nint total;\nmain()\n{\n  \
    total = count;\n  ReadBit(46);\n  printf(\"total %d\\n\", total);\n}\n";

/// A firmware file with the symbols of the board but those named.
fn firmware(without: &[&str]) -> Vec<u8> {
    let functions = FIRMWARE_FUNCTIONS.iter().map(|function| (function.name, function.address));
    let variables = FIRMWARE_VARIABLES.iter().map(|variable| (variable.name, variable.address));
    let symbol = |(name, address): (&str, GuestAddr)| Symbol {
        name: Name::from(format!("_{name}").as_str()),
        value: address.get(),
        section: SectionNumber::ABSOLUTE,
        ty: SymbolType::new(BaseType::INT),
        class: StorageClass::EXTERNAL,
        aux: Vec::new(),
    };
    let kept = functions.chain(variables).filter(|(name, _)| !without.contains(name));
    let image = Image {
        container: Container::Coff,
        target: Target::C6000,
        timestamp: 0,
        flags: FileFlags::LINKED,
        program: None,
        sections: vec![version()],
        symbols: kept.map(symbol).chain([symbol(("VersionAndBuildTime", VERSION_AT))]).collect(),
    };
    image.write().expect("the image has a few hundred symbols")
}

/// The address of the firmware's version.
const VERSION_AT: GuestAddr = GuestAddr::new(0x1001_B958);

/// The section that holds nothing but the version.
fn version() -> Section {
    Section {
        name: Name::from(".const"),
        physical: VERSION_AT.get(),
        address: VERSION_AT.get(),
        flags: SectionFlags::DATA,
        page: 0,
        contents: Contents::Data(format!("{}\n\0", VERSION.trim_end()).into_bytes()),
        relocations: Vec::new(),
        lines: Vec::new(),
    }
}

/// A folder with a program and the vendor's directory.
fn folder(name: &str, source: &str) -> Scratch {
    let scratch = Scratch::new(&format!("drop-in-{name}"));
    scratch.write("prog.c", source).write("DSP dir/DSPKFLOP.out", firmware(&[]));
    scratch
}

/// The arguments of the PC software, for thread 1.
const CALL: &[&str] = &[
    "-text",
    "80050000",
    "-g",
    "-nostdinc",
    "-I",
    "DSP dir",
    "-I",
    ".",
    "-o",
    "prog(1).out",
    "prog.c",
    "DSP dir/DSPKFLOP.out",
];

fn call(scratch: &Scratch, arguments: &[&str]) -> Output {
    cc67(scratch, arguments)
}

/// Calls the command by another name.
fn call_as(name: &str, scratch: &Scratch, arguments: &[&str]) -> Output {
    let other: PathBuf = scratch.path().join(name);
    if !other.exists() {
        harness::place_command(&other);
    }
    run_in(&other.to_string_lossy(), scratch.path(), arguments)
}

fn read(scratch: &Scratch, name: &str) -> Image {
    let bytes = fs::read(scratch.path().join(name)).expect("the image was written");
    Image::read(&bytes).expect("what was written is an image")
}

/// The value of a symbol.
fn value(image: &Image, name: &str) -> u32 {
    image.symbol(name).unwrap_or_else(|| panic!("no symbol `{name}`")).value
}

const SILENCE: Output = Output { code: 0, stdout: String::new(), stderr: String::new() };

/// The call fails with exactly this text and writes nothing.
fn check_message(name: &str, source: &str, arguments: &[&str], expect: &str) {
    let scratch = folder(name, source);
    let output = call(&scratch, arguments);
    assert_eq!((output.code, output.stdout.as_str()), (1, ""), "{output:?}");
    assert_eq!(output.stderr, expect, "{arguments:?}");
    assert!(!scratch.path().join("prog(1).out").exists(), "something was written");
}

#[test]
fn the_call_of_the_pc_software_writes_an_image_and_prints_nothing() {
    let scratch = folder("call", BLINK);
    assert_eq!(call(&scratch, CALL), SILENCE);
    let image = read(&scratch, "prog(1).out");
    let program = image.program.expect("the image has an entry point");
    assert_eq!((program.entry, program.text_start), (value(&image, "main"), 0x8005_0000));
    assert_eq!(value(&image, "__start_.text"), 0x8005_0000);
    let sizes = ["text", "data", "bss"].map(|section| {
        value(&image, &format!("__stop_.{section}")) - value(&image, &format!("__start_.{section}"))
    });
    assert_eq!(sizes, [program.text_size, program.data_size, program.bss_size]);
    assert!(image.sections.iter().any(|section| !section.lines.is_empty()), "no line numbers");
    let printf = FIRMWARE_FUNCTIONS.iter().find(|function| function.name == "printf").expect("it exists");
    assert_eq!(value(&image, "printf"), printf.address.get());
    let mut left: Vec<_> = fs::read_dir(scratch.path())
        .expect("the folder is readable")
        .map(|entry| entry.expect("the entry is readable").file_name().into_string().expect("it is UTF-8"))
        .collect();
    left.sort();
    assert_eq!(left, ["DSP dir", "prog(1).out", "prog.c"], "temporary files are left");
}

#[test]
fn the_image_runs() {
    let scratch = folder("runs", BLINK);
    assert_eq!(call(&scratch, CALL), SILENCE);
    let output = call(&scratch, &["run", "prog(1).out"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "total 3\n"), "{output:?}");
}

#[test]
fn the_name_of_the_vendors_compiler_selects_its_command_line() {
    for name in ["tcc67", "TCC67.exe"] {
        let scratch = folder(&format!("name-{name}"), BLINK);
        let arguments = ["-o", "prog(2).out", "-Wl,-Ttext,80060000", "prog.c", "DSP dir\\DSPKFLOP.out"];
        assert_eq!(call_as(name, &scratch, &arguments), SILENCE);
        let image = read(&scratch, "prog(2).out");
        assert_eq!(image.program.expect("it has an entry point").text_start, 0x8006_0000);
        assert!(image.symbols.is_empty(), "symbols without `-g`");
        let help = call_as(name, &scratch, &[]);
        assert_eq!((help.code, help.stderr.as_str()), (1, ""));
        assert!(help.stdout.starts_with("usage: tcc67"), "{help:?}");
    }
}

#[test]
fn the_call_of_newer_versions_works_too() {
    let scratch = folder("newer", BLINK);
    let arguments = [
        "-Wl,-Ttext,80070000",
        "-Wl,--oformat,coff",
        "-static",
        "-nostdinc",
        "-nostdlib",
        "-O2",
        "-DMILLS=3",
        "-I.",
        "-o",
        "prog(3).out",
        "prog.c",
        "DSP dir/DSPKFLOP.out",
    ];
    assert_eq!(call(&scratch, &arguments), SILENCE);
    assert_eq!(read(&scratch, "prog(3).out").program.expect("it has an entry point").text_start, 0x8007_0000);
}

#[test]
fn sections_go_where_the_command_line_says() {
    let scratch = folder("sections", BLINK);
    let mut arguments = vec!["-data", "80052000", "-bss", "80053000"];
    arguments.extend_from_slice(CALL);
    assert_eq!(call(&scratch, &arguments), SILENCE);
    let image = read(&scratch, "prog(1).out");
    let addresses = [".text", ".data", ".bss"].map(|name| image.section(name).map(|section| section.address));
    assert_eq!(addresses, [Some(0x8005_0000), Some(0x8005_2000), Some(0x8005_3000)]);
    assert_eq!((value(&image, "count"), value(&image, "total")), (0x8005_2000, 0x8005_3000));
}

#[test]
fn without_an_output_file_programs_are_only_compiled() {
    let scratch = folder("compile", "helper() { return missing(); }\n");
    assert_eq!(call_as("tcc67", &scratch, &["prog.c"]).code, 1);
    scratch.write("prog.c", "helper() { return 1; }\n");
    assert_eq!(call_as("tcc67", &scratch, &["prog.c"]), SILENCE);
    assert_eq!(call_as("tcc67", &scratch, &["-c", "prog.c"]), SILENCE);
}

#[test]
fn warnings_alone_are_silent() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int x;\n  if (x = 1) ;\n}\n";
    assert_eq!(call(&folder("warnings", source), CALL), SILENCE);
}

#[test]
fn errors_have_file_and_line_and_come_before_warnings() {
    let source = "main()\n{\n  int x = 1;\n  if (x = 2) x = 3;\n  y = 5;\n}\n";
    let expect = "prog.c:5: `y` is not declared\n\
        prog.c:4: warning: an assignment is used as a condition (write `==` to compare, or a second pair of \
        parentheses if this is meant)\n";
    check_message("errors", source, CALL, expect);
}

#[test]
fn bugs_of_the_vendors_compiler_are_reported_after_an_error() {
    let source = "set(int *x) { *x = 1; }\nf(int a) { set(&a); }\nmain()\n{\n  y = 5;\n}\n";
    let output = call(&folder("faults", source), CALL);
    let found = "prog.c:5: `y` is not declared\nprog.c:2: warning: the vendor's compiler takes a wrong address for the parameter `a`";
    assert!(output.stderr.starts_with(found), "{}", output.stderr);
    let fine = source.replace("  y = 5;\n", "");
    assert_eq!(call(&folder("faults-alone", &fine), CALL), SILENCE);
}

#[test]
fn errors_in_included_files_name_the_including_file() {
    let scratch = folder("included", "\n#include \"sub/helper.c\"\nmain() { }\n");
    scratch.write("sub/helper.c", "int a\nint b;\n");
    let output = call(&scratch, CALL);
    let expect = "In file included from prog.c:2:\n./sub/helper.c:1: expected `;` after `int a`\n";
    assert_eq!(output.stderr.replace("./sub", "sub"), expect.replace("./sub", "sub"));
    assert_eq!(output.code, 1);
}

#[test]
fn link_errors_begin_with_the_message_of_the_vendors_linker() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  while (!Readbit(46)) ;\n}\n";
    let expect = "tcc: undefined symbol 'Readbit'\n\
        prog.c:4: undefined function `Readbit` (did you mean `ReadBit`?)\n";
    check_message("undefined", source, CALL, expect);
    let output = call(&folder("main", "helper() { return 1; }\n"), CALL);
    assert!(output.stderr.starts_with("tcc: main not defined\nprog.c: no `main`"), "{output:?}");
    assert_eq!(output.code, 1);
}

#[test]
fn names_missing_from_the_firmware_file_are_undefined() {
    let scratch = folder("lacks", BLINK);
    scratch.write("DSP dir/DSPKFLOP.out", firmware(&["ReadBit"])).write("prog(1).out", "the old one");
    let output = call(&scratch, CALL);
    assert!(output.stderr.starts_with("tcc: undefined symbol 'ReadBit'\nprog.c:7: "), "{output:?}");
    assert_eq!(output.code, 1);
    let old = fs::read(scratch.path().join("prog(1).out")).expect("it is still there");
    assert_eq!(old, b"the old one");
}

#[test]
fn a_programs_own_definition_wins_over_the_firmwares() {
    let source = "#include \"KMotionDef.h\"\nint s = 5;\nfloor(int x) { return x + 1; }\n\
        main() { printf(\"%d\\n\", floor(s)); }\n";
    let scratch = folder("own", source);
    assert_eq!(call(&scratch, CALL), SILENCE);
    assert_eq!(call(&scratch, &["run", "prog(1).out"]).stdout, "6\n");
}

#[test]
fn wrong_calls_give_the_vendors_messages() {
    for (name, arguments, expect) in [
        ("option", &["-zzz", "prog.c"][..], "tcc: invalid option -- '-zzz'\n"),
        ("argument", &["prog.c", "-text"], "tcc: argument to '-text' is missing\n"),
        (
            "address",
            &["-text", "80050010", "prog.c"],
            "tcc: .text linker section must be aligned to fetch packet (32 byte boundary)\n",
        ),
        ("number", &["-text", "8005000G", "prog.c"], "tcc: Invalid text address option\n"),
        ("file", &["-text", "80050000", "nosuch.c"], "tcc: file 'nosuch.c' not found\n"),
        ("firmware", &["-text", "80050000", "prog.c", "no.out"], "tcc: file 'no.out' not found\n"),
        (
            "output",
            &["-text", "80050000", "-o", "no/prog.out", "prog.c", "DSP dir/DSPKFLOP.out"],
            "tcc: Unable to open output file 'no/prog.out'\n",
        ),
        (
            "other-board",
            &["-text", "80038000", "-o", "prog.out", "prog.c", "DSP dir/DSPKFLOP.out"],
            "tcc: address 80038000 is in no thread of a KFLOP: thread 1 begins at 80050000, each of the 7 has 10000 bytes; \
             the KMotion library takes a board that is in use by another client for the older KMotion: try again\n",
        ),
    ] {
        let all = [&["-nostdinc"], arguments].concat();
        check_message(name, BLINK, &all, expect);
    }
    let scratch = folder("text", BLINK);
    scratch.write("DSP dir/DSPKFLOP.out", BLINK);
    let output = call(&scratch, CALL);
    assert_eq!(output.code, 1);
    assert!(output.stderr.starts_with("tcc: 'DSP dir/DSPKFLOP.out': not a firmware file"), "{output:?}");
}

#[test]
fn the_firmware_of_another_board_is_refused() {
    let scratch = folder("other-firmware", BLINK);
    let other: Vec<u8> = {
        let bytes = firmware(&[]);
        let at = bytes.windows(5).position(|part| part == b"KFLOP").expect("it says what it is");
        [&bytes[..at], b"KOGNA", &bytes[at + 5..]].concat()
    };
    for (name, bytes, expect) in [
        ("DSPKMotion.out", firmware(&[]), "tcc: DSPKMotion.out is not the firmware of a KFLOP; "),
        ("DSPKFLOP.out", other, "tcc: 'other/DSPKFLOP.out' is the firmware of another board: KOGNA 4.34"),
    ] {
        scratch.write(&format!("other/{name}"), bytes);
        let file = format!("other/{name}");
        let output = call(&scratch, &["-text", "80050000", "-o", "prog.out", "prog.c", &file]);
        assert_eq!(output.code, 1);
        assert!(output.stderr.starts_with(expect), "{output:?}");
        assert!(!scratch.path().join("prog.out").exists());
    }
}

#[test]
fn a_thousand_errors_stay_below_the_capacity_of_the_pipe() {
    let mut source = String::from("main()\n{\n");
    for n in 0..1000 {
        source.push_str(&format!("  undeclared_variable_{n} = {n};\n"));
    }
    source.push_str("}\n");
    let output = call(&folder("thousand", &source), CALL);
    assert_eq!(output.code, 1);
    assert!(output.stderr.starts_with("prog.c:3: `undeclared_variable_0` is not declared\n"), "{output:?}");
    assert!(output.stderr.len() < 4000, "{} bytes", output.stderr.len());
}
