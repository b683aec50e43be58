//! Servers and clients that are killed, and a disk that is full: the next start works, and what was acknowledged is kept.

use std::fs;
use std::os::unix::net::UnixStream;
use std::process::Command;

use harness::{Scratch, cc67, run_in};

use super::client::{Client, LOCK, WRITE_LINE_READ_LINE};
use super::{HELLO, Server, VERSION};

/// A limit on the size of files that does not kill makes a disk full after the first kilobyte.
const FULL: &str = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";

/// A server that keeps its flash in a file, on a disk that is full or not.
fn with_flash(scratch: Scratch, is_full: bool) -> Server {
    let words = ["serve", "--pace", "fast", "--listen", "tcp:0", "--flash", "board.flash", "a.c"];
    let mut command = Command::new(if is_full { "sh" } else { harness::command() });
    if is_full {
        command.args(["-c", FULL, "sh", harness::command()]);
    }
    command.args(words).current_dir(scratch.path());
    Server::spawn(command, scratch, 1)
}

#[test]
fn flash_that_cannot_be_saved_is_not_acknowledged_and_the_old_is_kept() {
    let scratch = Scratch::new("serve-full-flash");
    scratch.write("a.c", HELLO);
    let flash = scratch.path().join("board.flash");
    let mut server = with_flash(scratch, false);
    let mut client = server.client();
    client.write_line("SetPersistDec 7 70");
    assert_eq!(client.ask("Flash"), "Program Flash Image Complete");
    let old = fs::read(&flash).expect("it was acknowledged");
    server.child.kill().expect("it runs");
    server.ends();

    let mut server = with_flash(server.take_folder(), true);
    let mut client = server.client();
    assert_eq!(client.ask("GetPersistDec 7"), "70", "the killed server has lost nothing");
    client.write_line("SetPersistDec 7 71");
    assert_eq!(client.try_ask("Flash"), Err(1), "no line says that it is complete");
    server.says("the flash is not kept: cannot write board.flash");
    assert!(fs::read(&flash).expect("it is still there") == old);
    assert_eq!(client.ask("Version"), VERSION, "the board continues");
    server.child.kill().expect("it runs");
    server.ends();

    let server = with_flash(server.take_folder(), false);
    assert_eq!(server.client().ask("GetPersistDec 7"), "70");
}

#[test]
fn flash_that_clients_were_told_of_survives_a_kill_at_any_moment() {
    let mut folder = Scratch::new("serve-kill-flash");
    folder.write("a.c", HELLO);
    let rounds: u64 = if harness::is_long() { 100 } else { 6 };
    let (mut least, mut told) = (0, 0);
    for round in 1..=rounds {
        let mut server = with_flash(folder, false);
        let mut client = server.client();
        let process = server.child.id().to_string();
        let killer = std::thread::spawn(move || {
            std::thread::sleep(std::time::Duration::from_millis(2 + round * 37 % 150));
            Command::new("kill").args(["-KILL", &process]).status().expect("a shell has it")
        });
        // The server ends in the middle of an exchange, which the client calls a failure.
        let saved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            for number in 1000 * round.. {
                client.write_line(&format!("SetPersistDec 7 {number}"));
                if client.ask("Flash") == "Program Flash Image Complete" {
                    (least, told) = (number, told + 1);
                }
            }
        }));
        assert!(saved.is_err() && killer.join().expect("it does not panic").success());
        server.ends();
        folder = server.take_folder();
        let output =
            harness::cc67_with_input(&folder, ["console", "--flash", "board.flash"], "GetPersistDec 7\n");
        let found: u64 = output.stdout.trim().parse().unwrap_or_else(|_| panic!("{output:?}"));
        assert!(found == least || found == least + 1 || found == 1000 * round, "{found} instead of {least}");
    }
    println!("{rounds} kills, {told} acknowledged");
    assert!(told > 0, "every kill came too early");
}

#[test]
fn a_home_folder_on_a_full_disk_is_completed_by_the_next_start() {
    let scratch = Scratch::new("serve-full-home");
    scratch.write("a.c", HELLO);
    let words = ["serve", "--home", "home", "--listen", "tcp:0", "--for", "0", "a.c"];
    let script = ["-c", FULL, "sh", harness::command()].into_iter().chain(words);
    let failed = run_in("sh", scratch.path(), script);
    assert_eq!(failed.code, 2, "{failed:?}");
    assert!(
        failed.stderr.starts_with("cc67: cannot write ") && failed.stderr.lines().count() == 1,
        "{failed:?}"
    );
    let good = cc67(&scratch, words);
    assert_eq!(good.code, 0, "{good:?}");
    let image = fs::read(scratch.path().join("home/DSP_KFLOP/DSPKFLOP.out")).expect("it is there");
    assert!(image.windows(VERSION.len()).any(|part| part == VERSION.as_bytes()), "it is whole");
    let options = fs::read_to_string(scratch.path().join("home/serve.options")).expect("it is there");
    assert!(options.ends_with("\n--listen\ntcp:0\n--for\n0\na.c\n"), "{options}");
}

#[test]
fn a_client_that_is_killed_leaves_the_board_to_the_others() {
    let server = Server::fast("serve-killed-client", HELLO);
    let mut other = server.client();
    for round in 0..5 {
        let mut killed = server.client();
        assert_eq!(killed.lock(), 0, "{round}");
        // In the middle of a command of several lines, of a question, and of a message.
        killed.write_line("SetGatherHex 0 8");
        killed.send(&[&WRITE_LINE_READ_LINE.to_le_bytes()[..], &[0; 4], b"Version\0"].concat());
        std::io::Write::write_all(&mut killed.stream, &[16, 0, 0]).expect("it is sent");
        drop(killed);
        while other.call(LOCK, b"\0").0 != 0 {}
        // As applications do after a failure: the link is reopened, and the command is gone with it.
        assert_eq!(other.call(super::client::DISCONNECT, b"").0, 0);
        assert_eq!(other.ask("Version"), VERSION);
        other.release();
    }
}

#[test]
fn a_killed_server_leaves_a_socket_that_the_next_one_takes() {
    let scratch = Scratch::new("serve-killed");
    scratch.write("a.c", HELLO);
    let words = ["serve", "--pace", "fast", "--listen", "socket", "--log", "log.txt", "a.c"];
    let mut server = Server::start_in(scratch, &words, 1);
    let connect = |server: &Server| UnixStream::connect(server.scratch.path().join("socket"));
    let mut client = Client::new(connect(&server).expect("it listens"));
    client.write_line("SetPersistDec 7 11");
    server.child.kill().expect("it runs");
    server.ends();
    assert!(client.is_closed());
    let log = fs::read_to_string(server.scratch.path().join("log.txt")).expect("it is written at once");
    assert!(log.contains("SETPERSISTDEC 7 11\n"), "{log}");
    let next = Server::start_in(server.take_folder(), &words, 1);
    let mut client = Client::new(connect(&next).expect("it listens again"));
    assert_eq!(client.ask("CheckThread1"), "1");
}
