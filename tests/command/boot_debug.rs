//! `cc67 debug --boot`: programs on the user's own firmware file, stopped and taken back.
//!
//! Programs run on the file that `CC67_FIRMWARE` names; without one, the test says so.

use std::env;

use harness::{Output, Scratch, cc67, cc67_with_input};

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
int total, calls;
int twice(int n)
{
    int i, sum = 0;
    for (i = 0; i < n; ++i)
        sum += 2;
    return sum;
}
void count(void)
{
    ++calls;
}
main()
{
    int k;
    for (k = 1; k < 4; k++)
    {
        total += twice(k);
        printf(\"%d\\n\", total);
    }
    UserCallBack = count;
    Delay_sec(0.01);
    UserCallBack = 0;
    persist.UserData[5] = total;
}
";

/// Returns the output of the commands, if there is a firmware file.
fn session(name: &str, commands: &str) -> Option<Output> {
    let Some(file) = env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return None;
    };
    let file = file.to_str().expect("a name of text");
    let scratch = Scratch::new(&format!("boot-debug-{name}"));
    scratch.write("twice.c", PROGRAM);
    scratch.write("commands", commands);
    Some(cc67(&scratch, ["debug", "--boot", file, "-O0", "--batch", "commands", "twice.c"]))
}

/// The printed lines, without board times.
fn lines(output: &Output) -> Vec<String> {
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{output:?}");
    let without_time = |line: &str| match line.rsplit_once(", 0.") {
        Some((before, time)) if time.ends_with(" s]") => format!("{before}]"),
        _ => line.to_owned(),
    };
    output.stdout.lines().map(|line| without_addresses(&without_time(line))).collect()
}

/// A line with a word in place of the addresses of the program.
fn without_addresses(line: &str) -> String {
    let mut parts = line.split("0x800");
    let first = parts.next().unwrap_or_default().to_owned();
    parts
        .fold(first, |text, part| text + "ADDRESS" + part.trim_start_matches(|c: char| c.is_ascii_hexdigit()))
}

#[test]
fn programs_on_the_real_firmware_stop_at_breakpoints() {
    let commands = "\
break twice
break 25 if total == 12
continue
backtrace
finish
continue
print total
info breakpoints
delete 1
continue
print persist.5
print calls > 100
continue
print persist.5
";
    let Some(output) = session("breaks", commands) else { return };
    let lines = lines(&output);
    let expect = [
        "Breakpoint 1 at ADDRESS: file twice.c, line 5.",
        "Breakpoint 2 at ADDRESS: file twice.c, line 25.",
        "Continuing.",
        "",
        "Breakpoint 1, twice () at twice.c:5 [thread 1]",
        "5\t    int i, sum = 0;",
        "#0  twice () at twice.c:5",
        "#1  ADDRESS in main () at twice.c:19",
    ];
    assert_eq!(lines[..expect.len()], expect, "{lines:#?}");
    let text = lines.join("\n");
    for part in [
        "main () at twice.c:19 [thread 1]",
        "Breakpoint 1, twice () at twice.c:5 [thread 1]\n5\t    int i, sum = 0;\n$1 = 2",
        "1       breakpoint     keep y   ADDRESS in twice at twice.c:5\n\tbreakpoint already hit 2 times\n\
         2       breakpoint     keep y   ADDRESS in main at twice.c:25",
        "2\n6\n12\n\nBreakpoint 2, main () at twice.c:25 [thread 1]",
        "$2 = 0\n$3 = 1\nContinuing.\n[All threads have ended]\n$4 = 12",
    ] {
        assert!(text.contains(part), "{part}\nis not in\n{text}");
    }
}

#[test]
fn lines_step_forwards_and_backwards_on_the_real_firmware() {
    let commands = "\
tbreak 19
continue
next
reverse-next
print total
tbreak twice
continue
step
finish
stepi
stepi 3
disassemble
";
    let Some(output) = session("steps", commands) else { return };
    let text = lines(&output).join("\n");
    let parts = [
        "main () at twice.c:19 [thread 1]",
        "main () at twice.c:20 [thread 1]",
        "main () at twice.c:19 [thread 1]",
        "$1 = 0",
        "Temporary breakpoint 2, twice () at twice.c:5 [thread 1]",
        "twice () at twice.c:6 [thread 1]",
        "main () at twice.c:19 [thread 1]",
        "=> ADDRESS <",
    ];
    let mut rest = text.as_str();
    for part in parts {
        rest =
            rest.split_once(part).unwrap_or_else(|| panic!("{part}\nis not where it should be in\n{text}")).1;
    }
}

#[test]
fn going_back_on_the_real_firmware_is_exact() {
    let commands = "\
break 25
continue
info registers
print calls
goto 0.005
print calls
reverse-continue
continue
info registers
print calls
";
    let Some(output) = session("past", commands) else { return };
    let text = lines(&output).join("\n");
    let pictures: Vec<_> = text.split("\nA0=").skip(1).collect();
    let [first, second] = pictures.as_slice() else { panic!("{text}") };
    let registers = |part: &str| -> String {
        part.lines().take_while(|line| !line.starts_with('$')).map(|line| format!("{line}\n")).collect()
    };
    assert_eq!(registers(first), registers(second), "the same instant, reached again");
    let values = text.lines().filter(|line| line.starts_with('$'));
    let counts: Vec<i32> = values.filter_map(|line| line.split_once(" = ")?.1.parse().ok()).collect();
    assert_eq!(counts.len(), 3, "{text}");
    assert_eq!(counts[0], counts[2]);
    assert!(counts[1] < counts[0], "{text}");
    assert!(text.contains("No more reverse-execution history."), "{text}");
}

#[test]
fn threads_that_wait_in_the_real_firmware_are_shown_there() {
    let commands = "goto 0.005\ninfo threads\nbreak count\ncontinue\nbacktrace\nset var total = 100\ndelete\ncontinue\nprint persist.5\n";
    let Some(output) = session("threads", commands) else { return };
    let text = lines(&output).join("\n");
    for part in [
        "* 1    running     Delay_sec () of the firmware from main () at twice.c:23",
        "Breakpoint 1, count () at twice.c:12 [call-back]",
        "$1 = 100",
    ] {
        assert!(text.contains(part), "{part}\nis not in\n{text}");
    }
}

#[test]
fn what_the_real_firmware_cannot_is_refused_by_name() {
    let Some(file) = env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return;
    };
    let file = file.to_str().expect("a name of text");
    let scratch = Scratch::new("boot-debug-refused");
    scratch.write("twice.c", PROGRAM);
    let commands = "print twice(3)\nawatch total\nprint total\n";
    let output = cc67_with_input(&scratch, ["debug", "--boot", file, "-O0", "twice.c"], commands);
    let expect = "\
the firmware file cannot call functions of a program from an expression
the firmware file cannot stop where a variable is read
$1 = 0
";
    assert!(output.stdout.ends_with(expect), "{output:?}");
}
