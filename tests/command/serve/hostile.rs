//! Clients that do not keep to the protocol: they harm themselves alone.

use std::io::{Read, Write};

use harness::promptness::{answers_at_once, timed};

use super::client::{Client, DISCONNECT, LOCK, SET_CONSOLE, Usual, WRITE_LINE_READ_LINE};
use super::{HELLO, Server, VERSION};

#[test]
fn partial_messages_and_impossible_lengths_do_not_block_others() {
    let server = Server::fast("serve-hostile", HELLO);
    let mut held = Vec::new();
    for bytes in [
        &b"\x10"[..],
        b"\x10\0\0\0",
        // A length of 4 GiB, if it had four bytes; and the longest of two.
        b"\xFF\xFF\xFF\xFF",
        b"\xFF\xFF",
        b"\x01\x10",
        b"\0\0",
        b"\x03\0\x09\0\0",
        b"\x08\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF",
        b"\x09\0\0\0\0",
    ] {
        let mut client = server.client();
        client.stream.write_all(bytes).expect("it is sent");
        held.push(client);
    }
    assert_eq!(server.client().ask("Version"), VERSION);
    drop(held);
    assert_eq!(server.client().ask("Version"), VERSION);
}

#[test]
fn a_client_that_reads_nothing_blocks_only_itself() {
    let server = Server::fast("serve-deaf", HELLO);
    let mut deaf = server.client();
    assert_eq!(deaf.call(SET_CONSOLE, b"").0, 0);
    // Console lines that are not acknowledged, and requests that nobody reads the answers of.
    let length = if Usual::is_over_pipe() { &[] } else { &[23, 0][..] };
    let request = [length, &WRITE_LINE_READ_LINE.to_le_bytes(), &[0; 4], b"Echo x;Version\0"].concat();
    for _ in 0..100 {
        // The server may have ended the connection.
        let _ = deaf.stream.write_all(&request);
    }
    let mut other = server.client();
    for _ in 0..20 {
        assert_eq!(other.ask("Version"), VERSION);
    }
    // The console is free again when it is gone.
    drop(deaf);
    assert_eq!(other.call(SET_CONSOLE, b"").0, 0);
    other.write_line("Echo here");
    while !other.console.contains(&"HERE".to_owned()) {
        assert_eq!(other.ask("Version"), VERSION);
    }
}

#[test]
fn ten_simultaneous_clients_each_get_their_own_answers() {
    let server = Server::fast("serve-ten", HELLO);
    let clients: Vec<_> = (0..10).map(|number| (number, server.client())).collect();
    let work = |(number, mut client): (i32, Client<Usual>)| {
        for round in 0..20 {
            while client.lock() != 0 {}
            client.write_line(&format!("SetPersistDec {} {}", 20 + number, 1000 * number + round));
            let answer = client.ask(&format!("GetPersistDec {}", 20 + number));
            client.release();
            assert_eq!(answer, (1000 * number + round).to_string());
        }
    };
    std::thread::scope(|scope| {
        for each in clients {
            scope.spawn(move || work(each));
        }
    });
}

#[test]
fn a_client_of_another_protocol_gets_a_text_answer() {
    if Usual::is_over_pipe() {
        println!("not run: a pipe tells messages apart by itself");
        return;
    }
    let server = Server::fast("serve-words", HELLO);
    for text in ["GET / HTTP/1.1\r\n\r\n", "\r\n", "Version\r\n"] {
        let mut client = server.client();
        client.stream.write_all(text.as_bytes()).expect("it is sent");
        let mut answer = String::new();
        client.stream.read_to_string(&mut answer).expect("the server ends the connection");
        assert!(answer.starts_with("cc67: a board is served here to programs"), "{answer}");
        assert_eq!(answer.lines().count(), 1, "{answer}");
    }
    // The library of version 4.32 sends no length.
    let mut old = server.client();
    old.stream.write_all(&[9, 0, 0, 0, 0, 0, 0, 0]).expect("it is sent");
    assert!(old.is_closed());
    server.says("its library is that of KMotion 4.32");
    // That of 4.34 begins the same except for two bytes.
    let mut client = server.client();
    client.send(&[&LOCK.to_le_bytes()[..], &[0; 4], b"\0"].concat());
    assert_eq!(client.reply().0, 0);
}

#[test]
fn any_bytes_in_a_line_go_to_the_board_as_they_are() {
    let server = Server::fast("serve-bytes", HELLO);
    let mut client = server.client();
    let (result, _) = client.call(WRITE_LINE_READ_LINE, b"Version;\xFF\xFE\0");
    assert_eq!(result, 0);
    let long = [b'x'; 4000];
    assert_eq!(client.call(1, &[&long[..], b"\0"].concat()).0, 0);
    // What is beyond the longest line is a line of its own, which is echoed; it goes with the link.
    assert_eq!(client.call(DISCONNECT, b"").0, 0);
    assert_eq!(client.ask("Version"), VERSION);
}

/// A thousand clients that connect and say nothing.
const IDLE: usize = 1000;

#[test]
fn a_thousand_silent_clients_keep_no_new_one_out() {
    if Usual::is_over_pipe() {
        println!("not run: the system closes a pipe only for the thread that reads from it");
        return;
    }
    for start in ["serve", "console"] {
        answers_at_once(start, || {
            let server = match start {
                "serve" => Server::fast("serve-idle", HELLO),
                _ => Server::start("console-idle", &["console", "--serve", "tcp:0", "a.c"], HELLO, 1),
            };
            let mut spoken = server.client();
            assert_eq!(spoken.ask("Version"), VERSION);
            let idle: Vec<_> = (0..IDLE).map(|_| server.client()).collect();
            let time = timed(|| assert_eq!(server.client().ask("Version"), VERSION));
            // One that has spoken is not closed for those that have not.
            assert_eq!(spoken.ask("Version"), VERSION);
            drop(idle);
            time
        });
    }
}
