//! Calls of the vendor's server, one by one: host-protocol.md section 9.

use std::time::{Duration, Instant};

use super::client::{
    CHECK_FOR_READY, DISCONNECT, FAILED, LOCATION, LOCK_RECOVERY, SERVICE_CONSOLE, SET_CONSOLE, WRITE_LINE,
    WRITE_LINE_WITH_ECHO,
};
use super::{HELLO, Server, VERSION};

/// Prints lines with their numbers, and says in an element of UserData when it is done.
fn counter(lines: u32) -> String {
    format!(
        "#include \"KMotionDef.h\"\nmain()\n{{\n  int i;\n  for (i = 0; i < {lines}; i++) printf(\"line %d\\n\", i);\n  \
         persist.UserData[9] = 1;\n}}\n"
    )
}

/// Prints without end, and says in an element of UserData how far it is.
const ENDLESS: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n  for (i = 0; ; i++) { printf(\"line %d\\n\", i); persist.UserData[9] = i; }\n}\n";

/// Lines that the server keeps for the console (`cc67 --explain limits`).
const LINES_KEPT: usize = 10_000;

#[test]
fn without_a_console_a_program_continues_and_its_lines_are_discarded() {
    let server = Server::fast("serve-unheard", &counter(2000));
    let mut client = server.client();
    while client.ask("GetPersistDec 9") != "1" {}
    while client.ask("CheckThread1") != "0" {}
    // What is in the board's queue still.
    for _ in 0..20 {
        assert_eq!(client.ask("Version"), VERSION);
    }
    // Whoever reads takes the lines off the link, whether there is a console or not.
    assert_eq!(client.call(SET_CONSOLE, b"").0, 0);
    client.write_line("Echo new");
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.console, ["NEW"]);
}

#[test]
fn a_registered_console_gets_every_line_in_order() {
    let count: u32 = if harness::is_long() { 100_000 } else { 3000 };
    let server = Server::fast("serve-heard", &counter(count));
    let mut client = server.client();
    assert_eq!(client.call(SET_CONSOLE, b"").0, 0);
    while client.console.len() < count as usize {
        assert_eq!(client.ask("Version"), VERSION);
        assert_eq!(client.call(SERVICE_CONSOLE, b"").0, 0);
    }
    for (number, line) in client.console.iter().enumerate() {
        assert_eq!(*line, format!("line {number}"));
    }
}

#[test]
fn the_last_registered_client_gets_at_most_ten_lines_before_a_reply() {
    let server = Server::fast("serve-console", HELLO);
    let (mut first, mut second) = (server.client(), server.client());
    assert_eq!(first.call(SET_CONSOLE, b"").0, 0);
    assert_eq!(second.call(SET_CONSOLE, b"").0, 0);
    for number in 0..12 {
        first.write_line(&format!("Echo {number}"));
    }
    assert_eq!(first.ask("Version"), VERSION);
    assert_eq!(first.console, [""; 0]);
    assert_eq!(second.lock(), 0);
    assert_eq!(second.console.len(), 10);
    second.release();
    assert_eq!(second.console.len(), 13, "the program said hello");
    // Reading the console takes at most one line off the link, if nobody has the token.
    for text in ["a", "b"] {
        second.write_line(&format!("Echo {text}"));
    }
    assert_eq!(second.lock(), 0);
    assert_eq!(second.call(SERVICE_CONSOLE, b"").0, 0);
    assert_eq!(second.console.len(), 13);
    second.release();
    assert_eq!(second.call(SERVICE_CONSOLE, b"").0, 0);
    assert_eq!(second.console[13..], ["A"]);
    assert_eq!(second.call(SERVICE_CONSOLE, b"").0, 0);
    assert_eq!(second.console[13..], ["A", "B"]);
}

#[test]
fn a_closed_link_is_reopened_by_the_next_line() {
    let server = Server::fast("serve-disconnect", HELLO);
    let (mut client, mut other) = (server.client(), server.client());
    assert!(client.call(LOCATION, b"").0 > 0);
    // A command that waits for its data lines, and an answer that nobody has read, are dropped with the link.
    client.write_line("SetGatherHex 0 8");
    assert_eq!(client.call(DISCONNECT, b""), (0, Vec::new()));
    for each in [&mut client, &mut other] {
        assert_eq!(each.call(LOCATION, b"").0, -1, "the state is the server's");
    }
    assert_eq!(client.call(WRITE_LINE, b"SetPersistDec 7 5\0").0, 0);
    assert!(other.call(LOCATION, b"").0 > 0);
    assert_eq!(client.ask("GetPersistDec 7"), "5");
    assert_eq!(client.errors, [""; 0]);

    // A failure is reported once, until something has been received again.
    assert_eq!(client.call(FAILED, b""), (0, Vec::new()));
    assert_eq!(client.errors, ["Read Failed - Auto Disconnect"]);
    assert_eq!(client.call(LOCATION, b"").0, -1);
    assert_eq!(client.call(FAILED, b"").0, 0);
    assert_eq!(client.errors.len(), 1);
    assert_eq!(client.lock(), 0, "it connects");
    client.release();
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.call(FAILED, b"").0, 0);
    assert_eq!(client.errors.len(), 2);
}

#[test]
fn check_for_ready_gives_all_lines_to_the_console() {
    let server = Server::fast("serve-ready", "main() { }");
    let mut client = server.client();
    assert_eq!(client.call(SET_CONSOLE, b"").0, 0);
    let mut check = |line: &str, expect: i32, lines: &[&str]| {
        assert_eq!(client.call(WRITE_LINE_WITH_ECHO, format!("{line}\0").as_bytes()).0, 0);
        assert_eq!(client.call(CHECK_FOR_READY, b"").0, expect, "{line}");
        assert_eq!(std::mem::take(&mut client.console), lines, "{line}");
    };
    check("ReadBit48", 2, &["ReadBit48", "0", "KFLOP 4.34", "Ready"]);
    check("SetBit46;ReadBit46", 2, &["SetBit46;ReadBit46", "1", "KFLOP 4.34", "Ready"]);
    check("bogus", 3, &["bogus", "BOGUS", "^", "error, invalid command", "KFLOP 4.34", "Ready"]);
    check("Echo an ERROR", 3, &["Echo an ERROR", "AN ERROR", "KFLOP 4.34", "Ready"]);
    assert_eq!(client.call(CHECK_FOR_READY, b"").0, 0, "no data");
}

#[test]
fn the_token_belongs_to_the_board_and_any_client_can_release_it() {
    let server = Server::fast("serve-token", HELLO);
    let (mut first, mut second) = (server.client(), server.client());
    assert_eq!(first.lock(), 0);
    assert_eq!(first.lock(), 1, "also for the client that has it");
    server.says("client 1 asks for the token that it has itself");
    assert_eq!(second.lock(), 1);
    second.release();
    assert_eq!(first.lock(), 0, "any client frees it");
    second.release();
    second.release();
    assert_eq!(second.lock(), 0);
    assert_eq!(first.lock(), 1);
    // Recovery asks for it as well, once, and opens a link that was given up.
    assert_eq!(first.call(LOCK_RECOVERY, b"").0, 1);
    second.release();
    assert_eq!(first.call(DISCONNECT, b"").0, 0);
    assert_eq!(first.call(LOCK_RECOVERY, b"").0, 0);
    assert!(first.call(LOCATION, b"").0 > 0);
    assert_eq!(second.lock(), 1);
}

#[test]
fn a_program_waits_for_a_blocked_console_and_no_line_is_lost() {
    let server = Server::fast("serve-backlog", ENDLESS);
    let (mut console, mut other) = (server.client(), server.client());
    assert_eq!(console.call(SET_CONSOLE, b"").0, 0);
    let mut printed = || other.ask("GetPersistDec 9").parse::<usize>().expect("a number");
    // The lines that the server keeps, and then the queue of the board.
    while printed() < LINES_KEPT {}
    for _ in 0..300 {
        printed();
    }
    let stopped = printed();
    assert!((LINES_KEPT..LINES_KEPT + 600).contains(&stopped), "{stopped}");
    assert_eq!(printed(), stopped, "it waits");
    while console.console.len() < stopped + 1000 {
        assert_eq!(console.ask("Version"), VERSION);
    }
    for (number, line) in console.console.iter().enumerate() {
        assert_eq!(*line, format!("line {number}"));
    }
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a client's wait is measured on the clock")]
fn waiting_for_a_missing_line_times_out_on_the_wall_clock() {
    let server = Server::fast("serve-clock", HELLO);
    let (mut client, mut other) = (server.client(), server.client());
    let begin = Instant::now();
    assert_eq!(client.read_line(300), None);
    assert!(begin.elapsed() >= Duration::from_millis(300), "{:?}", begin.elapsed());
    // Others are served meanwhile, and what they ask for is the line that is waited for.
    client.send(&[&3_i32.to_le_bytes()[..], &[0; 4], &600_000_i32.to_le_bytes()].concat());
    other.write_line("Version");
    let (result, text) = client.reply();
    assert_eq!((result, text), (0, format!("{VERSION}\r\n\0").into_bytes()));
}

#[test]
fn a_line_without_an_answer_fails() {
    let server = Server::fast("serve-no-answer", HELLO);
    let mut client = server.client();
    assert_eq!(client.call(SET_CONSOLE, b"").0, 0);
    assert_eq!(client.try_ask("bogus"), Err(1));
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.console, ["hello", "BOGUS", "^", "error, invalid command"]);
}

#[test]
fn starting_a_thread_without_a_program_is_reported() {
    let server = Server::fast("serve-empty", HELLO);
    let mut client = server.client();
    client.write_line("Execute3");
    assert_eq!(client.ask("CheckThread3"), "0");
    server.says("Execute3: no program is loaded in thread 3, so nothing starts");
}

#[test]
fn a_board_that_cannot_keep_up_still_answers() {
    let arguments = ["serve", "--pace", "1000", "--listen", "tcp:0", "a.c"];
    let server = Server::start("serve-late", &arguments, ENDLESS, 1);
    let mut client = server.client();
    for _ in 0..50 {
        assert_eq!(client.ask("Version"), VERSION);
    }
}
