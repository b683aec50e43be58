//! Several boards of one server.

use harness::promptness::{answers_at_once, timed};
use harness::{Scratch, cc67};

use super::client::{self, Client, Link, SET_CONSOLE};
use super::{Server, VERSION};

/// A call for a board by its number or location.
fn call<S: Link>(client: &mut Client<S>, code: i32, board: i32, arguments: &[u8]) -> (i32, Vec<u8>) {
    client.send(&[&code.to_le_bytes()[..], &board.to_le_bytes(), arguments].concat());
    client.reply()
}

/// The answer of a board to a line.
fn ask<S: Link>(client: &mut Client<S>, board: i32, line: &str) -> String {
    let (result, text) =
        call(client, client::WRITE_LINE_READ_LINE, board, &[line.as_bytes(), b"\0"].concat());
    assert_eq!(result, 0, "{line}");
    String::from_utf8_lossy(&text).trim_end_matches('\0').to_owned()
}

#[test]
fn each_board_has_its_machine_its_token_and_its_console() {
    let scratch = Scratch::new("serve-boards");
    for (name, bit) in [("mill", 48), ("lathe", 49)] {
        scratch.write(&format!("{name}.toml"), format!("[[event]]\nat = 0.0\nset_bit = {{ {bit} = 1 }}\n"));
    }
    let mut command = std::process::Command::new(harness::command());
    let boards = ["--board", "mill=mill.toml", "--board=lathe=lathe.toml"];
    command.args(["serve", "--pace", "fast", "--listen", &client::Usual::address("tcp:0")]).args(boards);
    command.current_dir(scratch.path());
    let server = Server::spawn_after(command, scratch, 2, 1);
    let (mut first, mut second) = (server.client(), server.client());

    // The list, and who is meant.
    first.send(&4_i32.to_le_bytes());
    assert_eq!(first.reply(), (0, [2_i32, 1, 2].map(i32::to_le_bytes).concat()));
    for (board, location) in [(0, 1), (1, 1), (-1, 2), (2, 2)] {
        assert_eq!(call(&mut first, client::LOCATION, board, b"").0, location, "{board}");
        assert_eq!(ask(&mut first, board, "Version"), VERSION);
    }
    assert_eq!(call(&mut first, client::LOCK, -2, b"\0").0, 2, "there are two");

    // A board is changed, the other is not.
    assert_eq!(call(&mut first, client::WRITE_LINE, -1, b"SetPersistDec 9 77\0").0, 0);
    assert_eq!(ask(&mut second, 0, "GetPersistDec 9"), "0");
    assert_eq!(ask(&mut second, 2, "GetPersistDec 9"), "77");

    // A token each.
    assert_eq!(call(&mut first, client::LOCK, 0, b"\0").0, 0);
    assert_eq!(call(&mut second, client::LOCK, 0, b"\0").0, 1);
    assert_eq!(call(&mut second, client::LOCK, -1, b"\0").0, 0);

    // A console each, and a machine each.
    assert_eq!(call(&mut first, SET_CONSOLE, 0, b"").0, 0);
    assert_eq!(call(&mut second, SET_CONSOLE, -1, b"").0, 0);
    for (client, board, text, bits) in [(&mut first, 0, "one", "1 0"), (&mut second, -1, "two", "0 1")] {
        assert_eq!(call(client, client::WRITE_LINE, board, format!("Echo {text}\0").as_bytes()).0, 0);
        assert_eq!(ask(client, board, "Version"), VERSION);
        assert_eq!(client.console, [text.to_uppercase()]);
        let levels = format!("{} {}", ask(client, board, "ReadBit48"), ask(client, board, "ReadBit49"));
        assert_eq!(levels, bits);
    }
}

#[test]
fn a_thousand_silent_clients_keep_no_new_one_from_either_board() {
    if client::Usual::is_over_pipe() {
        println!("not run: the system closes a pipe only for the thread that reads from it");
        return;
    }
    answers_at_once("serve with two boards", || {
        let scratch = Scratch::new("serve-boards-idle");
        scratch.write("m.toml", "");
        let mut command = std::process::Command::new(harness::command());
        command.args([
            "serve", "--pace", "fast", "--listen", "tcp:0", "--board", "a=m.toml", "--board", "b=m.toml",
        ]);
        command.current_dir(scratch.path());
        let server = Server::spawn_after(command, scratch, 2, 1);
        let idle: Vec<_> = (0..1000).map(|_| server.client()).collect();
        let times =
            [1, 2].map(|board| timed(|| assert_eq!(ask(&mut server.client(), board, "Version"), VERSION)));
        drop(idle);
        times[0].max(times[1])
    });
}

#[test]
fn options_of_one_board_and_wrong_boards_are_refused_by_name() {
    let scratch = Scratch::new("serve-boards-refused");
    scratch.write("m.toml", "");
    let two = ["--board", "a=m.toml", "--board", "b=m.toml"];
    for (more, expect) in [
        (&["--listen", "pty"][..], "is of one board"),
        (&["--log", "log.txt"], "`--log` is of one board"),
        (&["--flash", "f.bin"], "`--flash` is of one board"),
        (&["--board", "a=m.toml"], "two boards are called a"),
        (&["--board", "c=none.toml"], "board c: "),
        (&["--board", "=m.toml"], "expected NAME=MACHINE.toml"),
    ] {
        let output = cc67(&scratch, [&["serve", "--for", "0.1"], &two[..], more].concat());
        assert_eq!(output.code, 2, "{output:?}");
        assert!(output.stderr.contains(expect), "{expect}: {output:?}");
    }
}
