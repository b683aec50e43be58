//! `cc67 console --serve`: clients on a socket, as the vendor's library talks to its server.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use harness::{Scratch, cc67};

/// A server and its folder; ended when it goes out of scope.
struct Server {
    child: Child,
    scratch: Scratch,
    /// What it says of where it listens.
    place: String,
}

impl Server {
    fn start(name: &str, address: &str, source: &str) -> Self {
        let scratch = Scratch::new(name);
        scratch.write("a.c", source);
        let mut child = Command::new(harness::command())
            .args(["console", "--fast", "--serve", address, "a.c"])
            .current_dir(scratch.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command under test starts");
        let mut line = String::new();
        let stderr = child.stderr.take().expect("it is piped");
        BufReader::new(stderr).read_line(&mut line).expect("it says where it listens");
        let place = line.trim_end().strip_prefix("cc67: a board is served on ").expect(&line).to_owned();
        Self { child, scratch, place }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A client of the server.
struct Client<S> {
    stream: S,
    /// Console lines that came before replies.
    console: Vec<String>,
}

impl<S: Read + Write> Client<S> {
    fn new(stream: S) -> Self {
        Self { stream, console: Vec::new() }
    }

    fn send(&mut self, bytes: &[u8]) {
        let length = u16::try_from(bytes.len()).expect("it is short").to_le_bytes();
        self.stream.write_all(&[&length[..], bytes].concat()).expect("the server reads");
    }

    /// Makes a call for the first board; its result, and what comes with it.
    fn call(&mut self, code: i32, arguments: &[u8]) -> (i32, Vec<u8>) {
        self.send(&[&code.to_le_bytes()[..], &[0; 4], arguments].concat());
        self.reply()
    }

    fn reply(&mut self) -> (i32, Vec<u8>) {
        loop {
            let mut length = [0; 2];
            self.stream.read_exact(&mut length).expect("a reply");
            let mut bytes = vec![0; usize::from(u16::from_le_bytes(length))];
            self.stream.read_exact(&mut bytes).expect("a whole reply");
            if bytes[0] == 0 {
                let result = i32::from_le_bytes(bytes[1..5].try_into().expect("four bytes"));
                return (result, bytes[5..].to_vec());
            }
            assert_eq!(bytes[0], 1, "a console line");
            self.console.push(String::from_utf8(bytes[1..].to_vec()).expect("text"));
            self.stream.write_all(&[0xAA]).expect("the server waits for it");
        }
    }

    /// A call with a text and an answer that is one.
    fn ask(&mut self, line: &str) -> String {
        let (result, text) = self.call(0, format!("{line}\0").as_bytes());
        assert_eq!(result, 0, "{line}");
        String::from_utf8(text).expect("text").trim_end_matches('\0').to_owned()
    }
}

const HELLO: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n  for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; }\n}\n";

const VERSION: &str = "KFLOP 4.34 Build 16:07:06 Aug 14 2018";

/// Numbers of calls.
const WRITE_LINE: i32 = 1;
const READ_LINE: i32 = 3;
const LOCK: i32 = 9;
const RELEASE: i32 = 12;
const SET_CONSOLE: i32 = 14;

#[test]
fn a_client_over_tcp_talks_to_the_board() {
    let server = Server::start("serve-tcp", "tcp:0", HELLO);
    let port: u16 = server.place.strip_prefix("tcp:").and_then(|port| port.parse().ok()).expect("a port");
    let mut client = Client::new(TcpStream::connect(("127.0.0.1", port)).expect("it listens"));
    assert_eq!(client.call(SET_CONSOLE, b""), (0, Vec::new()));
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.ask("CheckThread1"), "1");
    assert_eq!(client.console, ["hello\r\n\0"]);
    assert_eq!(client.call(WRITE_LINE, b"GetGatherHex 0 9\0").0, 0);
    let words = format!("{}\r\n\0", ["00000000"; 8].join(" "));
    assert_eq!(client.call(READ_LINE, &100_i32.to_le_bytes()), (0, words.into_bytes()));
    assert_eq!(client.call(READ_LINE, &100_i32.to_le_bytes()).0, 0);
    assert_eq!(client.call(READ_LINE, &100_i32.to_le_bytes()), (2, b"\0".to_vec()), "the time has passed");
    assert_eq!(client.call(2, b"Version\0").0, 0);
    assert_eq!(client.call(8, b"").0, 2, "Ready came");
    assert_eq!(client.call(7, b"").0, 2, "the generation of the firmware");
    let location = client.call(10, b"").0;
    client.send(&4_i32.to_le_bytes());
    assert_eq!(client.reply(), (0, [1_i32.to_le_bytes(), location.to_le_bytes()].concat()));
    // A board that is not there.
    client.send(&[&LOCK.to_le_bytes()[..], &(-1_i32).to_le_bytes(), b"\0"].concat());
    assert_eq!(client.reply().0, 2);
    // A call that does not exist ends the connection, and nothing else.
    client.send(&[&99_i32.to_le_bytes()[..], &[0; 4]].concat());
    assert_eq!(client.stream.read(&mut [0; 1]).ok(), Some(0));
    let mut other = Client::new(TcpStream::connect(("127.0.0.1", port)).expect("it still listens"));
    assert_eq!(other.ask("Version"), VERSION);
}

#[cfg(unix)]
#[test]
fn clients_over_a_socket_share_the_board_by_its_token() {
    use std::os::unix::net::UnixStream;

    let server = Server::start("serve-unix", "socket", HELLO);
    assert_eq!(server.place, "socket");
    let path = server.scratch.path().join("socket");
    let connect = || Client::new(UnixStream::connect(&path).expect("it listens"));
    let (mut first, mut second) = (connect(), connect());
    assert_eq!(first.call(LOCK, b"a test\0").0, 0);
    assert_eq!(second.call(LOCK, b"\0").0, 1);
    assert_eq!(first.ask("Version"), VERSION);
    assert_eq!(first.call(RELEASE, b"").0, 0);
    assert_eq!(second.call(LOCK, b"\0").0, 0);
    // A client that dies loses the token.
    drop(second);
    while first.call(LOCK, b"\0").0 != 0 {}
    assert_eq!(first.call(RELEASE, b"").0, 0);
    // Time passes in exchanges only, so this is the same every time.
    let count: i32 = first.ask("GetPersistDec 9").parse().expect("a number");
    assert!(count > 0, "{count}");
    drop(first);
    // The place of a server that was killed is taken over; that of one which serves is not.
    let again = Command::new(harness::command())
        .args(["console", "--serve", "socket"])
        .current_dir(server.scratch.path())
        .output()
        .expect("the command under test starts");
    assert_eq!(again.status.code(), Some(2));
    let message = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(message.contains("another server is already running"), "{message}");
}

#[test]
fn a_server_ends_after_the_time_that_it_was_given() {
    let scratch = Scratch::new("serve-end");
    scratch.write("a.c", HELLO);
    let output = cc67(&scratch, ["console", "--serve", "tcp:0", "--for", "0.05", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, ""));
    assert!(output.stderr.starts_with("cc67: a board is served on tcp:"), "{}", output.stderr);
    let wrong = cc67(&scratch, ["console", "--serve", "tcp:x"]);
    assert_eq!(wrong.code, 2);
    assert!(wrong.stderr.contains("`x` is not a port number"), "{}", wrong.stderr);
}
