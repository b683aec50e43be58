//! The folder that the vendor's library reads.

use std::fs;
use std::process::Command;

use harness::{Scratch, cc67, run_in};

use super::{HELLO, Server, VERSION};

/// A folder with a home made in it, which serves `a.c`.
fn home(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("a.c", HELLO);
    let words = ["serve", "--home", "home", "--listen", "tcp:0", "--pace", "fast", "--for", "0", "a.c"];
    let output = cc67(&scratch, words);
    assert_eq!(output.code, 0, "{output:?}");
    let path = scratch.path().canonicalize().expect("it is there").join("home");
    let first = output.stdout.lines().next().expect("three lines");
    assert!(first.starts_with("export KMOTIONX_HOME='") && first.ends_with("home'"), "{first}, {path:?}");
    assert_eq!(output.stdout.lines().count(), 3);
    scratch
}

#[test]
fn the_home_folder_has_what_the_library_looks_for() {
    let scratch = home("serve-home");
    let home = scratch.path().join("home");
    for (folder, image) in [("DSP_KFLOP", "DSPKFLOP.out"), ("DSP_KMotion", "DSPKMotion.out")] {
        for name in [image, "KMotionDef.h", "PC-DSP.h"] {
            assert!(home.join(folder).join(name).is_file(), "{folder}/{name}");
        }
    }
    let image = fs::read(home.join("DSP_KFLOP/DSPKFLOP.out")).expect("it is there");
    assert!(image.windows(VERSION.len()).any(|part| part == VERSION.as_bytes()), "the date of 4.34");
    let variables = fs::read_to_string(home.join("Data/emc.var")).expect("it is there");
    assert!(variables.contains("5220\t1.000000\n"));
    // What a person has changed stays when the folder is made again.
    scratch.write("home/Data/emc.var", "5221\t1.5\n");
    scratch.write("home/DSP_KFLOP/KMotionDef.h", "// mine\n");
    let again = cc67(&scratch, ["serve", "--home", "home", "--listen", "tcp:0", "--for", "0"]);
    assert_eq!(again.code, 0, "{again:?}");
    assert_eq!(fs::read_to_string(home.join("Data/emc.var")).expect("it is there"), "5221\t1.5\n");
    assert_eq!(fs::read_to_string(home.join("DSP_KFLOP/KMotionDef.h")).expect("it is there"), "// mine\n");
}

#[test]
fn the_home_folder_links_to_the_compiler_and_the_server() {
    let scratch = home("serve-links");
    let program = scratch.path().join("home/bin/tcc67");
    let call = [
        "-text",
        "80060000",
        "-g",
        "-nostdinc",
        "-I",
        "home/DSP_KFLOP",
        "-o",
        "a(2).out",
        "a.c",
        "home/DSP_KFLOP/DSPKFLOP.out",
    ];
    let program = program.to_str().expect("a name in UTF-8");
    let compiled = run_in(program, scratch.path(), call);
    assert_eq!((compiled.code, compiled.stderr.as_str()), (0, ""));
    assert!(scratch.path().join("a(2).out").is_file());

    // The library starts the server silently, in any folder; it serves what was served last.
    let mut command = Command::new(scratch.path().join("home/bin/KMotionServer"));
    command.args(["--for", "1e9"]).current_dir("/");
    let mut server = Server::spawn(command, scratch, 1);
    let mut client = server.client();
    assert_eq!(client.ask("CheckThread1"), "1");
    drop(client);
    assert_eq!(server.ends().code(), Some(0), "the last client is gone");
}

#[test]
fn the_programs_of_m_codes_are_linked_into_the_home_folder() {
    let scratch = Scratch::new("serve-mcodes");
    scratch
        .write("mine/m3.c", "#include \"KMotionDef.h\"\n#include \"mine.h\"\nmain() { SetBit(SPINDLE); }\n");
    scratch.write("mine/mine.h", "#define SPINDLE 46\n");
    let words = ["serve", "--home", "home", "--mcodes", "mine", "--listen", "tcp:0", "--for", "0"];
    assert_eq!(cc67(&scratch, words).code, 0);
    let checked = cc67(&scratch, ["check", "home/MCodes/m3.c"]);
    assert_eq!((checked.code, checked.stderr.as_str()), (0, ""), "with the files that it includes");
    // One that is written later is there, and the server that the library starts needs no such option.
    scratch.write("mine/m5.c", "main() { }\n");
    assert!(scratch.path().join("home/MCodes/m5.c").is_file());
    let options = fs::read_to_string(scratch.path().join("home/serve.options")).expect("it is there");
    assert!(!options.contains("mine"), "{options}");
    let words = ["serve", "--home", "home", "--mcodes", "none", "--listen", "tcp:0", "--for", "0"];
    let wrong = cc67(&scratch, words);
    assert_eq!(wrong.code, 2);
    assert!(wrong.stderr.starts_with("cc67: `--mcodes none`: "), "{wrong:?}");
}

#[test]
fn a_home_folder_that_cannot_be_made_says_why_and_can_be_made_later() {
    let scratch = Scratch::new("serve-no-home");
    scratch.write("home/bin/tcc67", "#!/bin/sh\n");
    let words = ["serve", "--home", "home", "--listen", "tcp:0", "--for", "0"];
    let output = cc67(&scratch, words);
    assert_eq!(output.code, 2);
    assert!(output.stderr.contains("bin/tcc67 exists and is not a link"), "{output:?}");
    fs::remove_file(scratch.path().join("home/bin/tcc67")).expect("it is there");
    assert_eq!(cc67(&scratch, words).code, 0);
}
