//! Executables of `cc67 build --emit native`: the object file is what its format says, its machine code is what runs,
//! and what a program prints, when, and how it ends is as on the bytecode engine.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::process::Command;

use goblin::Object;
use goblin::elf::Elf;
use goblin::elf::sym::{STB_GLOBAL, STB_LOCAL, STT_FUNC};
use harness::{Output, Scratch, cc67, root, run_in};

/// The command.
/// Whether `cc` is there to link with.
fn has_linker() -> bool {
    // Naming it keeps the library among what is built for these tests.
    assert_eq!(cc67board::Outcome::Ok as i32, 0);
    let is_there = cfg!(unix) && Command::new("cc").arg("--version").output().is_ok();
    if !is_there {
        println!("there is no `cc`: not tested");
    }
    is_there
}

fn build(folder: &Path, arguments: &[&str]) -> Output {
    cc67(folder, ["build", "--target", "sim", "--emit", "native"].iter().chain(arguments))
}

/// Runs an image on the bytecode engine and as an executable of its own, with the same options.
#[track_caller]
fn check(name: &str, source: &str, options: &[&str]) -> Output {
    let scratch = Scratch::new(&format!("stand-alone-{name}"));
    scratch.write("prog.c", source);
    let made = build(scratch.path(), &["prog.c"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    // The executable holds the image, which knows lines and no columns.
    let image = cc67(&scratch, ["build", "--target", "sim", "-o", "prog.out", "prog.c"]);
    assert_eq!(image.code, 0, "{}", image.stderr);
    let expect = cc67(
        &scratch,
        ["run", "--time", "--no-sidecar", "--engine", "bytecode"].iter().chain(options).chain(&["prog.out"]),
    );
    let program = scratch.path().join("prog");
    let program = program.to_str().expect("a name");
    let found = run_in(program, scratch.path(), ["--time"].iter().chain(options));
    assert_eq!(found.render(), expect.render());
    let left: Vec<_> = fs::read_dir(scratch.path()).expect("the folder is there").collect();
    assert_eq!(left.len(), 3, "{left:?}");
    found
}

#[test]
fn a_stand_alone_program_does_the_same_at_the_same_board_time() {
    if !has_linker() {
        return;
    }
    let source = "#include \"KMotionDef.h\"
int square(int x) { return x * x; }
int twice(int x) { return 2 * x; }
int (*steps[2])(int) = { square, twice };
main()
{
    double sum = 0;
    int i;
    for (i = 0; i < 20000; i++) sum += sqrt(i) * sin(i) + pow(1.5, i % 7);
    printf(\"%d %d %.9f\\n\", steps[0](7), steps[1](7), sum);
    SetBit(46);
    Delay_sec(0.25);
    persist.UserData[3] = ReadBit(46);
    printf(\"%d %.3f\\n\", persist.UserData[3], Time_sec());
}
";
    let found = check("computes", source, &[]);
    assert!(found.stdout.contains(" 49 14 "), "{}", found.stdout);
}

#[test]
fn a_trap_names_the_line_and_sets_the_exit_code() {
    if !has_linker() {
        return;
    }
    let source = "int depth(int n) { return n ? depth(n - 1) : *(int *)n; }
main()
{
    return depth(5);
}
";
    assert_eq!(check("traps", source, &[]).code, 3);
}

#[test]
fn a_stand_alone_program_has_the_options_of_run() {
    if !has_linker() {
        return;
    }
    let source = "#include \"KMotionDef.h\"
main() { for (;;) { WaitNextTimeSlice(); persist.UserData[0]++; if (persist.UserData[0] == 100) printf(\"100\\n\"); } }
";
    assert_eq!(check("endless", source, &["--for", "0.5", "--set", "persist.0=10"]).code, 0);
}

#[test]
fn an_executable_is_small_and_interprets_the_other_programs() {
    if !has_linker() {
        return;
    }
    let scratch = Scratch::new("stand-alone-small");
    scratch.write("prog.c", "#include \"KMotionDef.h\"\nmain() { Delay_sec(0.01); printf(\"one\\n\"); }\n");
    scratch.write("other.c", "#include \"KMotionDef.h\"\nmain() { printf(\"two\\n\"); }\n");
    let made = build(scratch.path(), &["prog.c"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let program = scratch.path().join("prog");
    let size = fs::metadata(&program).expect("it is there").len();
    println!("{size} bytes");
    // What tests are built with is not optimised.
    let most = if cfg!(debug_assertions) { 100_000_000 } else { 10_000_000 };
    assert!(size <= most, "{size} bytes");
    let both = run_in(program.to_str().expect("a name"), scratch.path(), ["2:other.c"]);
    assert_eq!((both.code, both.stdout.as_str()), (0, "two\none\n"), "{}", both.stderr);
}

#[test]
fn example_programs_do_the_same_stand_alone() {
    if !has_linker() {
        return;
    }
    for name in ["start/hello.c", "persist/mcode.c"] {
        let source = fs::read_to_string(root().join("c-programs").join(name)).expect("the program is there");
        check(&name.replace('/', "-"), &source, &["--for", "2"]);
    }
}

#[test]
fn wrong_options_are_reported_as_by_any_command() {
    if !has_linker() {
        return;
    }
    let scratch = Scratch::new("stand-alone-usage");
    scratch.write("prog.c", "main() { }\n");
    assert_eq!(build(scratch.path(), &["prog.c"]).code, 0);
    let program = scratch.path().join("prog");
    let found = run_in(program.to_str().expect("a name"), scratch.path(), ["--machine", "none.toml"]);
    assert_eq!(
        (found.code, found.stderr.as_str()),
        (2, "cc67: cannot read none.toml: No such file or directory\n")
    );
}

/// The object file of a program.
fn object(scratch: &Scratch, source: &str) -> Vec<u8> {
    scratch.write("prog.c", source);
    let made = build(scratch.path(), &["prog.c", "-o", "prog.o"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    fs::read(scratch.path().join("prog.o")).expect("it was written")
}

/// Where the machine code is in an ELF file.
fn text_of(elf: &Elf<'_>) -> Range<usize> {
    let named =
        |name: &str| elf.section_headers.iter().find(|s| elf.shdr_strtab.get_at(s.sh_name) == Some(name));
    named(".text").and_then(|section| section.file_range()).expect("there is a .text")
}

#[test]
fn the_object_has_every_function_and_needs_only_the_library() {
    let scratch = Scratch::new("stand-alone-object");
    let bytes = object(
        &scratch,
        "static int half(int x) { return x / 2; }\nint (*h)(int) = half;\nmain() { return h(4); }\n",
    );
    let Object::Elf(elf) = Object::parse(&bytes).expect("an object file") else {
        println!("not an ELF host: its object was written, and is not looked into");
        return;
    };
    assert_eq!(elf.header.e_type, goblin::elf::header::ET_REL);
    let symbol = |name: &str| elf.syms.iter().find(|symbol| elf.strtab.get_at(symbol.st_name) == Some(name));
    for name in ["guest.main", "guest.half"] {
        let found = symbol(name).unwrap_or_else(|| panic!("no {name}"));
        assert_eq!((found.st_bind(), found.st_type()), (STB_LOCAL, STT_FUNC), "{name}");
        assert!(found.st_size > 0, "{name}");
    }
    let main = symbol("main").expect("an executable begins there");
    assert_eq!((main.st_bind(), main.st_type()), (STB_GLOBAL, STT_FUNC));
    let missing =
        elf.syms.iter().filter(|symbol| symbol.is_import() || (symbol.st_shndx == 0 && symbol.st_name != 0));
    let missing: Vec<_> = missing.filter_map(|symbol| elf.strtab.get_at(symbol.st_name)).collect();
    assert_eq!(missing, [vm::native::START]);
    assert!(!text_of(&elf).is_empty());
}

/// The machine code of the object is what runs, not a translation of the image: a number that is changed there alone is
/// the one that is printed.
#[test]
#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
fn the_executable_runs_the_code_of_the_object() {
    if !has_linker() {
        return;
    }
    let scratch = Scratch::new("stand-alone-changed");
    let mut bytes = object(&scratch, "main() { printf(\"%d\\n\", 0x12345678); }\n");
    let text = match Object::parse(&bytes).expect("an object file") {
        Object::Elf(elf) => text_of(&elf),
        _ => unreachable!("Linux has ELF files"),
    };
    let number = 0x1234_5678_u32.to_le_bytes();
    let code = &mut bytes[text];
    // Once as the argument; slow ways may hold it again.
    let places: Vec<_> = (0..code.len() - 4).filter(|at| code[*at..*at + 4] == number).collect();
    assert!(!places.is_empty(), "the number is in the code");
    for at in places {
        code[at..at + 4].copy_from_slice(&42_u32.to_le_bytes());
    }
    scratch.write("changed.o", &bytes);
    let own = std::env::current_exe().expect("a test knows where it lies");
    let library = own.with_file_name("libcc67board.a");
    let library = library.to_str().expect("a name");
    let linked =
        run_in("cc", scratch.path(), ["-o", "changed", "changed.o", library, "-lpthread", "-ldl", "-lm"]);
    assert_eq!(linked.code, 0, "{}", linked.stderr);
    let program = scratch.path().join("changed");
    let found = run_in(program.to_str().expect("a name"), scratch.path(), ["--for", "1"]);
    assert_eq!(found.render(), "42\n---- exit 0\n");
}
