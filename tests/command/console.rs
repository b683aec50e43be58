//! `cc67 console` as scripts meet it, and lines that nobody would type.

use harness::{Output, Scratch, cc67_with_input};
use kmotiondef::Ticks;
use proptest::prelude::*;
use proptest::test_runner::{Config as Cases, TestRunner};
use runtime::commands::{Argument, COMMANDS};
use runtime::{Board, Config, EventKind};

/// Runs a script in a folder with these files.
fn console(name: &str, files: &[(&str, &str)], arguments: &[&str], script: &str) -> Output {
    let scratch = Scratch::new(name);
    for (file, text) in files {
        scratch.write(file, text);
    }
    let mut all = vec!["console"];
    all.extend_from_slice(arguments);
    cc67_with_input(&scratch, all, script)
}

fn check(name: &str, files: &[(&str, &str)], arguments: &[&str], script: &str, expect: &str) {
    let output = console(name, files, arguments, script);
    assert_eq!(output.render(), expect, "{script}");
}

const HELLO: (&str, &str) = (
    "hello.c",
    "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello %d\\n\", persist.UserData[5]++);\n}\n",
);

#[test]
fn a_script_loads_programs_and_talks_to_the_board() {
    let script = "Version\n# a comment\n\nSetPersistDec 5 7\nload 2:hello.c\nExecute2\nExecute 2;CheckThread2\n\
                  wait 0.01\nGetPersistDec 5\nCheckThread2;bogus;Version\n";
    let expect = "KFLOP 4.34 Build 16:07:06 Aug 14 2018\nhello 7\n1\nhello 8\n9\n0\nBOGUS\n^\nerror, invalid command\n---- exit 0\n";
    check("console-load", &[HELLO], &[], script, expect);
}

#[test]
fn programs_on_the_command_line_run_to_their_end_after_the_script() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  Delay_sec(3);\n  printf(\"done\\n\");\n}\n";
    let expect = "1\ndone\n---- exit 0\n";
    check("console-end", &[("slow.c", source)], &["slow.c"], "CheckThread1\n", expect);
}

#[test]
fn a_download_written_as_commands_runs() {
    let scratch = Scratch::new("console-download");
    scratch.write(HELLO.0, HELLO.1);
    let arguments = ["build", "hello.c", "--thread", "3", "--download-script", "-o", "hello.kfs"];
    let output = cc67_with_input(&scratch, arguments, "");
    assert_eq!(output.code, 0, "{output:?}");
    let script = std::fs::read_dir(scratch.path())
        .expect("the folder is there")
        .filter_map(|entry| std::fs::read_to_string(entry.expect("an entry").path()).ok())
        .find(|text| text.starts_with("Kill"))
        .expect("the download is written");
    let script = format!("{script}Execute3\nwait 0.01\nExecute3\n");
    let output = cc67_with_input(&scratch, ["console"], &script);
    assert_eq!(output.render(), "hello 0\nhello 1\n---- exit 0\n");
}

#[test]
fn a_download_that_is_not_a_program_stops_its_thread() {
    let script =
        "LoadData 80050000 4\n1 2 3 4\nEntryPoint1 80050000\nExecute1\nwait 0.01\nCheckThread1\nVersion\n";
    let output = console("console-junk", &[], &[], script);
    assert_eq!(output.stdout, "0\nKFLOP 4.34 Build 16:07:06 Aug 14 2018\n");
    // Whatever is not bytecode is code of the processor, which runs on over the empty rest of its memory.
    assert!(output.stderr.contains("thread 1 stopped"), "{}", output.stderr);
}

#[test]
fn mistakes_in_console_words_and_sources_do_not_end_the_session() {
    let script = "wait x\nload nosuch.c\nrun bad.c\nkill all but 9\nEcho on\n";
    let output = console("console-mistakes", &[("bad.c", "main() { retrun 1; }\n")], &[], script);
    assert_eq!((output.code, output.stdout.as_str()), (0, "ON\n"), "{output:?}");
    for message in ["`x` is not a number of seconds", "cannot read nosuch.c", "error", "`9`: no such thread"]
    {
        assert!(output.stderr.contains(message), "{message}: {}", output.stderr);
    }
}

#[test]
fn all_threads_but_one_can_be_stopped() {
    let endless = "#include \"KMotionDef.h\"\nmain()\n{\n  for (;;) WaitNextTimeSlice();\n}\n";
    let script = "CheckThread1;CheckThread2;CheckThread3\nkill all but 2\nCheckThread1;CheckThread2;CheckThread3\nkill all\nCheckThread2\n";
    let expect = "1\n1\n1\n0\n1\n0\n0\n---- exit 0\n";
    check("console-kill", &[("a.c", endless)], &["a.c", "a.c", "a.c"], script, expect);
}

#[test]
fn a_trap_sets_the_exit_code() {
    let trap = "main()\n{\n  *(int *)0 = 1;\n}\n";
    assert_eq!(console("console-trap", &[("a.c", trap)], &["a.c"], "Version\n").code, 3);
}

/// Numbers as people and line noise write them; no large ones, whose replies would take long.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        (-10..3000_i32).prop_map(|number| number.to_string()),
        (0..10_000_u32).prop_map(|number| format!("{number:X}")),
        any::<f64>().prop_map(|number| format!("{number:e}")),
        "[-+.eE0-9xX]{0,6}",
        Just("80050000".to_owned()),
    ]
}

/// A line: noise, or a command with what may follow it.
fn line() -> impl Strategy<Value = Vec<u8>> {
    let separator = prop_oneof![Just(" "), Just("="), Just(" = "), Just(""), Just(","), Just(";")];
    let arguments = prop::collection::vec((separator, number()), 0..24);
    let command = (0..COMMANDS.len(), arguments).prop_map(|(index, arguments)| {
        let arguments = arguments.into_iter().map(|(separator, number)| format!("{separator}{number}"));
        format!("{}{}", COMMANDS[index].name, arguments.collect::<String>()).into_bytes()
    });
    let fitting = (0..COMMANDS.len(), prop::collection::vec(0..100_i32, 24)).prop_map(|(index, numbers)| {
        let mut text = COMMANDS[index].name.to_owned();
        for (argument, number) in COMMANDS[index].arguments.iter().zip(numbers) {
            text += &match argument {
                Argument::Integer(lo, hi) => {
                    format!(" {}", (*lo).max(0) + number % (hi.min(&300) - (*lo).max(0) + 1))
                }
                Argument::Equals | Argument::OptionalEquals | Argument::Assign => "=".to_owned(),
                Argument::End => String::new(),
                _ => format!(" {number}"),
            };
        }
        text.into_bytes()
    });
    prop_oneof![
        2 => command,
        3 => fitting,
        1 => prop::collection::vec(any::<u8>(), 0..300),
    ]
}

/// Sends bytes and returns the last line of a reply within some ticks.
fn answer(board: &mut Board, bytes: &[u8]) -> Option<Vec<u8>> {
    board.receive(bytes);
    let mut last = None;
    let mut ticks = 0;
    while board.is_receiving() && ticks < 10_000 {
        let limit = Ticks::new(board.tick().get() + 2);
        board.run_until(limit, &mut |event| {
            if let EventKind::Reply(line) = event.kind {
                last = Some(line);
            }
            false
        });
        ticks += 2;
    }
    last
}

#[test]
fn the_board_still_answers_after_ten_thousand_random_lines() {
    let cases = Cases { cases: 100, ..Cases::default() };
    let result = TestRunner::new(cases).run(&prop::collection::vec(line(), 100), |lines| {
        let mut board = Board::new(Config::default());
        for line in lines {
            // What stops the released firmware stops this one too: such a board is switched off and on.
            let mut stopped = false;
            board.receive(&[b"\x1b\x01", &line[..], b"\r"].concat());
            let limit = Ticks::new(board.tick().get() + 40);
            board.run_until(limit, &mut |event| {
                stopped |=
                    matches!(&event.kind, EventKind::Remark(remark) if remark.message.code() == "firmware-stops");
                false
            });
            if stopped {
                board = Board::new(Config::default());
            }
            // A command may wait for data lines, and replies may go to the UART: both are left first.
            answer(&mut board, b"\x03\x1b\x01USB\r");
            let version = answer(&mut board, b"\x1b\x01Version\r");
            prop_assert_eq!(version.as_deref(), Some(&b"KFLOP 4.34 Build 16:07:06 Aug 14 2018"[..]));
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_flashed_board_boots_with_its_programs_and_keeps_what_was_flashed() {
    let scratch = Scratch::new("console-flash");
    let source = "#include \"KMotionDef.h\"\nint count = 5;\nmain()\n{\n  printf(\"count %d, data %d\\n\", count++, persist.UserData[7]);\n}\n";
    scratch.write("a.c", source);
    let arguments = ["console", "--flash", "board.flash"];
    let script = "run a.c\nwait 0.01\nSetPersistDec 7 77;Vel3=1234;EnableAxis3\nSetStartupThread1 1\nFlash\nwait 0.1\n\
                  SetPersistDec 7 1;Vel3=1\nReboot!\nwait 0.1\nVel3;Enabled3;GetPersistDec 7;CheckThread1\n";
    let output = cc67_with_input(&scratch, arguments, script);
    let expect = "count 5, data 0\nProgram Flash Image Complete\nVerify Complete\ncount 6, data 77\n1234.000000\n0\n77\n0\n---- exit 0\n";
    assert_eq!(output.render(), expect);
    // The next power-up: no PC says anything, no program is named.
    for _ in 0..2 {
        let output = cc67_with_input(&scratch, ["run", "--flash", "board.flash"], "");
        assert_eq!(output.render(), "count 6, data 77\n---- exit 0\n");
    }
    // A machine file may name the file too.
    scratch.write("machine.toml", "[board]\nflash = \"board.flash\"\n");
    let arguments = ["run", "--machine", "machine.toml", "2:a.c"];
    let output = cc67_with_input(&scratch, arguments, "");
    assert!(output.render().contains("count 6, data 77"), "{}", output.render());
}

/// A console with a file of the flash whose input stays open, under a shell script that starts it.
#[cfg(unix)]
fn flashing_console(scratch: &Scratch, script: &str) -> std::process::Child {
    use std::io::Write;
    use std::process::{Command, Stdio};

    let mut child = Command::new("sh")
        .args(["-c", script, "sh", harness::command(), "console", "--flash", "board.flash"])
        .current_dir(scratch.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a shell starts");
    let input = child.stdin.as_mut().expect("it is piped");
    input.write_all(b"SetPersistDec 7 77\nFlash\nwait 0.1\nGetPersistDec 7\n").expect("it reads");
    child
}

#[test]
#[cfg(unix)]
fn flash_that_the_console_acknowledged_is_in_the_file_whatever_ends_it() {
    use std::io::{BufRead, BufReader};
    use std::process::Command;

    for signal in ["INT", "TERM", "HUP", "KILL"] {
        let scratch = Scratch::new(&format!("console-flash-{signal}"));
        let mut child = flashing_console(&scratch, "exec \"$@\"");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let line = output.lines().map_while(Result::ok).find(|line| line == "Program Flash Image Complete");
        assert!(line.is_some(), "SIG{signal}: the board acknowledges");
        let killed = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(killed.is_ok_and(|status| status.success()));
        child.wait().expect("it ends");
        let output = cc67_with_input(&scratch, ["console", "--flash", "board.flash"], "GetPersistDec 7\n");
        assert_eq!(output.render(), "77\n---- exit 0\n", "after SIG{signal}");
    }
}

#[test]
#[cfg(unix)]
fn the_console_does_not_acknowledge_flash_that_a_full_disk_does_not_take() {
    let scratch = Scratch::new("console-full-flash");
    let child = flashing_console(&scratch, "trap '' XFSZ; ulimit -f 1; exec \"$@\"");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "77\n");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(errors.contains("the flash is not kept: cannot write board.flash"), "{errors}");
    assert!(!output.status.success() && !scratch.path().join("board.flash").exists());
}

#[test]
fn blocks_of_the_users_flash_outlive_the_run() {
    let scratch = Scratch::new("console-user-flash");
    let writer = "#include \"KMotionDef.h\"\ndouble table[2] = {1.5, -2.5};\nmain()\n{\n  SetFlashBank(FLASH_USER);\n  \
                  printf(\"%d\\n\", ProgramFlash((char *)table, 8, FLASH_USER, \"written\\n\"));\n}\n";
    let reader = "#include \"KMotionDef.h\"\nmain()\n{\n  double *table = (double *)FLASH_USER;\n  printf(\"%g %g\\n\", table[0], table[1]);\n}\n";
    scratch.write("write.c", writer).write("read.c", reader);
    let run = |file: &str| cc67_with_input(&scratch, ["run", "--flash", "board.flash", file], "").render();
    assert_eq!(run("write.c"), "written\n0\n---- exit 0\n");
    assert_eq!(run("read.c"), "1.5 -2.5\n---- exit 0\n");
    scratch.write("board.flash", "short");
    assert!(run("read.c").contains("board.flash is not a board's flash: it has 5 bytes, not 2097152"));
}

#[test]
fn answers_of_the_pc_are_scripted() {
    let source = "#include \"KMotionDef.h\"\n\
        int ask(int code)\n{\n  persist.UserData[100] = code;\n  while (persist.UserData[100] > 0) ;\n  return persist.UserData[100];\n}\n\
        main()\n{\n  char *p = (char *)gather_buffer;\n  char *s = \"Tool in place?\";\n  while ((*p++ = *s++)) ;\n\
        persist.UserData[101] = 0; persist.UserData[102] = 4; persist.UserData[103] = 0;\n  ask(15);\n  printf(\"pressed %d\\n\", persist.UserData[103]);\n\
        persist.UserData[101] = 0; persist.UserData[102] = 4;\n  ask(15);\n  printf(\"pressed %d\\n\", persist.UserData[103]);\n\
        persist.UserData[101] = 500; persist.UserData[102] = 1; persist.UserData[103] = 5;\n  ask(16);\n  printf(\"#500 = %g\\n\", ((double *)persist.UserData)[5]);\n\
        persist.UserData[101] = 3;\n  printf(\"M3: %d\\n\", ask(14));\n}\n";
    let host = "# the operator\nmsgbox = no\nvar.500 = 2.25\n";
    let files = [("a.c", source), ("pc.txt", host)];
    let arguments = ["--host", "pc.txt", "--answer", "msgbox=yes", "--answer", "request.14=-3", "a.c"];
    let output = console("console-answers", &files, &arguments, "");
    assert_eq!(output.stdout, "pressed 7\npressed 6\n#500 = 2.25\nM3: -3\n");
    let shown = "cc67: message box: Tool in place? (no, 7)\ncc67: message box: Tool in place? (yes, 6)\n\
                 cc67: get G-code variables from 500\ncc67: M code 3\ncc67: request 14 is answered -3\n";
    assert_eq!(output.stderr, shown);
    let output = console("console-answers-bad", &[("pc.txt", "\nmsgbox\n")], &["--host", "pc.txt"], "");
    assert_eq!((output.code, output.stderr.as_str()), (2, "cc67: pc.txt:2: `msgbox` is not `key=value`\n"));
}

#[test]
fn m_codes_pass_their_parameters() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"P = %f Q = %f R = %f\\n\", *(float *)&persist.UserData[0],\n    *(float *)&persist.UserData[1], *(float *)&persist.UserData[2]);\n}\n";
    let arguments = ["--mcode", "M110 P1.23 Q4.56 R-1:0", "a.c"];
    let expect = "P = 1.230000 Q = 4.560000 R = -1.000000\n---- exit 0\n";
    check("console-mcode", &[("a.c", source)], &arguments, "", expect);
}
