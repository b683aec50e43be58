//! The library for C programs: its header matches its sources, and a C program uses it to control a board.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use cbindgen::{Builder, Config, DocumentationStyle, EnumConfig, ExportConfig, Language, RenameRule, Style};
use harness::{Scratch, command, root, run_in};

/// The text of the header before its declarations.
const HEAD: &str = "\
/* A KFLOP board, simulated or connected, as a library: the operations of the host interface under their names.

   Times are board time, which passes only in calls: an exchange takes as long as on the wire, cc67_run_for and
   cc67_run_until let more of it pass. So a test of a program of the PC does the same every time. The time of a connected
   controller passes by itself, and these calls wait.

       cc host.c -I cc67/capi/include -L target/release -lcc67board

   Texts are UTF-8 and end with a 0. Those that come back are cut to the size of the buffer and always ended. A call
   with a null pointer, or with another wrong argument, answers CC67_RESULT_ARGUMENT, -1 or null and does nothing.

   Made from the sources in cc67/capi/src; do not edit it. */
";

/// The header generated from the sources.
fn header() -> String {
    let config = Config {
        language: Language::C,
        header: Some(HEAD.trim_end().to_owned()),
        include_guard: Some("CC67BOARD_H".to_owned()),
        no_includes: true,
        sys_includes: ["stddef.h", "stdint.h"].map(str::to_owned).to_vec(),
        cpp_compat: true,
        style: Style::Tag,
        documentation_style: DocumentationStyle::C,
        line_length: 110,
        export: ExportConfig {
            rename: [
                ("Client", "cc67_client"),
                ("Outcome", "cc67_result"),
                ("LineCallback", "cc67_line_callback"),
                ("EndCallback", "cc67_end_callback"),
            ]
            .map(|(from, to)| (from.to_owned(), to.to_owned()))
            .into(),
            ..ExportConfig::default()
        },
        enumeration: EnumConfig {
            rename_variants: RenameRule::QualifiedScreamingSnakeCase,
            ..EnumConfig::default()
        },
        ..Config::default()
    };
    // The modules of the library are found from its root.
    let builder = Builder::new().with_config(config).with_src(root().join("cc67/capi/src/lib.rs"));
    let mut text = Vec::new();
    builder.generate().expect("the sources can be read").write(&mut text);
    String::from_utf8(text).expect("it is text").replace("\n # Safety\n", "\n Requires:\n")
}

#[test]
fn the_header_matches_the_sources() {
    let path = root().join("cc67/capi/include/cc67board.h");
    let found = header();
    if std::env::var_os("CC67_WRITE_HEADER").is_some() {
        fs::write(&path, &found).expect("the header is writable");
    }
    let expect = fs::read_to_string(&path).expect("the header is there");
    assert!(found == expect, "run this test with CC67_WRITE_HEADER=1 to rewrite the header:\n{found}");
}

/// The library that was built for these tests, in their folder.
fn library() -> PathBuf {
    let own = std::env::current_exe().expect("a test knows where it lies");
    own.with_file_name(format!("{DLL_PREFIX}cc67board{DLL_SUFFIX}"))
}

/// Returns whether there is a C compiler.
fn has_compiler() -> bool {
    let is_there = !cfg!(windows) && Command::new("cc").arg("--version").output().is_ok();
    if !is_there {
        println!("there is no C compiler: not tested");
    }
    is_there
}

#[test]
fn the_program_of_the_book_compiles() {
    let page = fs::read_to_string(root().join("cc67/book/src/embedding.md")).expect("the chapter is there");
    let program = page.split("```c host\n").nth(1).and_then(|rest| rest.split("```").next());
    if has_compiler() {
        let scratch = Scratch::new("c-book");
        scratch.write("host.c", program.expect("the chapter has the program"));
        let include = root().join("cc67/capi/include");
        let arguments = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I"].map(OsStr::new);
        let output = run_in(
            "cc",
            scratch.path(),
            arguments.into_iter().chain([include.as_os_str(), "host.c".as_ref()]),
        );
        assert_eq!(output.code, 0, "{}", output.stderr);
    }
}

/// Compiles a C program from the test inputs with the library; returns the executable.
fn host_program(scratch: &Scratch, source: &str) -> PathBuf {
    let library = library();
    let folder = library.parent().expect("a file has a folder");
    let program = scratch.path().join("host");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(&program)
        .arg(root().join("tests/board/inputs").join(source))
        .arg("-I")
        .arg(root().join("cc67/capi/include"))
        .arg(&library)
        .arg(format!("-Wl,-rpath,{}", folder.display()))
        .output()
        .expect("the C compiler starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    program
}

#[test]
fn a_c_program_drives_a_board() {
    // This use of the crate makes Cargo build the library for these tests.
    assert_eq!(cc67board::Outcome::Ok as i32, 0);
    if !has_compiler() {
        return;
    }
    let scratch = Scratch::new("c-interface");
    scratch.write("good.c", "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"counting\\n\");\n  for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; }\n}\n");
    scratch.write("bad.c", "main()\n{\n  retrun 1;\n}\n");
    let program = host_program(&scratch, "host.c");
    let arguments = ["good.c", "bad.c"].map(|name| scratch.path().join(name));
    let output = run_in(program.to_str().expect("a name"), scratch.path(), arguments);
    let expect = "console: counting\nbad.c:3: expected `;` after `retrun` (or is an operator missing, such as `*`?)\nKFLOP 4.34 Build 16:07:06 Aug 14 2018\n\
                  remark: command: Move: axis 0 is disabled, so nothing moves\nagain: ONE\nagain: TWO\ndone\n---- exit 0\n";
    assert_eq!(output.render(), expect);
}

#[cfg(feature = "usb")]
#[test]
fn a_c_program_drives_a_controller_at_a_link() {
    if !has_compiler() {
        return;
    }
    let scratch = Scratch::new("c-controller");
    scratch.write("count.c", "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"counting\\n\");\n  for (;;) { Delay_sec(0.001); persist.UserData[9]++; }\n}\n");
    let program = host_program(&scratch, "controller.c");
    let mut server = Command::new(command());
    server.args(["serve", "--listen", "tcp-raw:0"]).current_dir(scratch.path());
    let mut server = server.stderr(Stdio::piped()).spawn().expect("the command under test starts");
    let mut line = String::new();
    let mut output = BufReader::new(server.stderr.take().expect("it is piped"));
    output.read_line(&mut line).expect("it is text");
    let place = line.trim_end().strip_prefix("cc67: a board is served on ").expect("it says where");
    let output = run_in(program.to_str().expect("a name"), scratch.path(), [place, "count.c"]);
    // An error means that the server has already ended.
    let _ = server.kill();
    let _ = server.wait();
    let expect = "no address: `lpt1` is not a board\nnobody there: connection refused\nKFLOP 4.34 Build 16:07:06 Aug 14 2018\n\
                  console: counting\nloaded, started, stopped\n---- exit 0\n";
    assert_eq!(output.render(), expect);
}
