//! A scripted board at the other end of a link.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use cc67_wire::{BoardLink, LoadImage};
use kmotiondef::ThreadId;

/// The reply to `Version`.
pub(crate) const VERSION: &str = "KFLOP 4.34 Build 16:07:06 Aug 14 2018";

/// The reply of a Kogna.
pub(crate) const KOGNA_VERSION: &str = "KOGNA 5.3.2 Build 18:10:31 Jan 31 2024";

/// A fault of the board or the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Fault {
    #[default]
    None,
    /// Bytes left over from an earlier user.
    Garbage,
    /// Everything is sent byte by byte.
    SingleBytes,
    /// It never answers.
    Silent,
    /// The first abort byte is not answered.
    SilentOnce,
    /// A program prints between any two lines received.
    Flood,
    /// The cable is unplugged after this many data lines.
    Unplug(usize),
    /// The board restarts after this many data lines.
    Reset(usize),
    /// A command of another client arrives after this many data lines.
    Foreign(usize),
    /// Lines of replies to another client come before each reply.
    Replies,
    /// One command is not answered, as if its line was lost.
    LosesLine,
    /// A killed thread continues.
    Unstoppable,
    /// The board is a Kogna: its answer to the abort byte is a complete line.
    Kogna,
}

/// The written parts of the board's memory, and the commands that it executed.
#[derive(Debug, Default)]
pub(crate) struct State {
    pub(crate) memory: BTreeMap<u32, u8>,
    pub(crate) commands: Vec<String>,
    /// The number of received bytes.
    pub(crate) received: usize,
    pub(crate) fault: Fault,
}

/// Creates a board, and a link to it.
pub(crate) fn board(fault: Fault) -> (BoardLink, Arc<Mutex<State>>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let pc = TcpStream::connect(listener.local_addr().expect("its address")).expect("a connection");
    let (board, _) = listener.accept().expect("a connection");
    for stream in [&pc, &board] {
        stream.set_nodelay(true).expect("no delay");
        stream.set_read_timeout(Some(Duration::from_millis(20))).expect("a time-out");
    }
    let state = Arc::new(Mutex::new(State { fault, ..State::default() }));
    let shared = Arc::clone(&state);
    thread::spawn(move || Board { stream: board, state: shared, block: None, lines: 0 }.serve());
    let reader = pc.try_clone().expect("a second handle");
    (BoardLink::new("fake", reader, pc), state)
}

struct Board {
    stream: TcpStream,
    state: Arc<Mutex<State>>,
    /// The address and the number of bytes still expected in a download.
    block: Option<(u32, usize)>,
    /// The number of data lines so far.
    lines: usize,
}

impl Board {
    fn fault(&self) -> Fault {
        self.state.lock().expect("the state").fault
    }

    fn heal(&self) {
        self.state.lock().expect("the state").fault = Fault::None;
    }

    fn say(&mut self, text: &str) {
        if self.fault() == Fault::SingleBytes {
            for byte in text.bytes() {
                let _ = self.stream.write_all(&[byte]);
                thread::sleep(Duration::from_micros(200));
            }
        } else {
            // An error means that the PC has disconnected.
            let _ = self.stream.write_all(text.as_bytes());
        }
    }

    fn serve(mut self) {
        if self.fault() == Fault::Garbage {
            self.say("3F 00\r\nhalf\x1bwhole line\r\n\x1bcut li");
        }
        let (mut line, mut buffer) = (Vec::new(), [0; 512]);
        loop {
            let count = match self.stream.read(&mut buffer) {
                Ok(0) => return,
                Ok(count) => count,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    if self.fault() == Fault::Flood {
                        self.say("\x1bfloods\r\n");
                    }
                    continue;
                }
                Err(_) => return,
            };
            self.state.lock().expect("the state").received += count;
            for byte in &buffer[..count] {
                match byte {
                    3 => {
                        line.clear();
                        self.block = None;
                        match self.fault() {
                            Fault::Silent => {}
                            Fault::SilentOnce => self.heal(),
                            Fault::Kogna => self.say("\x1bC\r\n"),
                            _ => self.say("\x1bC\r"),
                        }
                    }
                    b'\r' => {
                        let text = String::from_utf8_lossy(&std::mem::take(&mut line)).into_owned();
                        if self.fault() == Fault::Flood {
                            self.say("\x1bfloods\r\n");
                        }
                        if !self.line(text.trim_start_matches(['\x1b', '\x01'])) {
                            return;
                        }
                    }
                    byte => line.push(*byte),
                }
            }
        }
    }

    /// Processes a line; returns whether the cable is still plugged in.
    fn line(&mut self, text: &str) -> bool {
        let text = text.to_ascii_uppercase();
        if let Some((address, left)) = self.block {
            self.lines += 1;
            match self.fault() {
                Fault::Unplug(after) if self.lines > after => return false,
                Fault::Reset(after) if self.lines > after => {
                    self.heal();
                    self.block = None;
                    self.state.lock().expect("the state").memory.clear();
                    self.refuse(&text, 0, "error, invalid command");
                    return true;
                }
                Fault::Foreign(after) if self.lines > after => {
                    self.heal();
                    self.block = None;
                    self.refuse("CHECKDONE0", 7, "error, expecting value");
                    self.refuse(&text, 0, "error, invalid command");
                    return true;
                }
                _ => {}
            }
            let bytes: Vec<u8> =
                text.split(' ').map_while(|word| u8::from_str_radix(word, 16).ok()).take(left).collect();
            let mut state = self.state.lock().expect("the state");
            state.memory.extend((address..).zip(bytes.iter().copied()));
            let left = left - bytes.len();
            self.block = (left > 0).then_some((address + bytes.len() as u32, left));
            return true;
        }
        for part in text.split(';').filter(|part| !part.is_empty()) {
            if self.fault() == Fault::LosesLine && part.starts_with("READBIT") {
                self.heal();
                return true;
            }
            self.state.lock().expect("the state").commands.push(part.to_owned());
            if !self.command(part) {
                self.refuse(part, 0, "error, invalid command");
                break;
            }
        }
        true
    }

    fn refuse(&mut self, line: &str, column: usize, message: &str) {
        self.say(&format!("\x1b{line}\r\n\x1b{}^\r\n\x1b{message}\r\n", " ".repeat(column)));
    }

    fn command(&mut self, part: &str) -> bool {
        if self.fault() == Fault::Replies && part != "VERSION" {
            self.say("17\r\n");
        }
        if part == "VERSION" {
            let version = if self.fault() == Fault::Kogna { KOGNA_VERSION } else { VERSION };
            self.say(&format!("{version}\r\n"));
        } else if let Some(arguments) = part.strip_prefix("LOADDATA ") {
            let mut words = arguments.split(' ');
            let mut number = || u32::from_str_radix(words.next().unwrap_or_default(), 16).unwrap_or_default();
            self.block = Some((number(), number() as usize));
        } else if part.starts_with("CHECKTHREAD") {
            let is_active = self.fault() == Fault::Unstoppable;
            self.say(if is_active { "1\r\n" } else { "0\r\n" });
        } else if part.starts_with("READBIT") {
            self.say("1\r\n");
        } else if part == "GETSTATUS" {
            let mut words = vec![0; 116];
            words[0] = 0x0134_0074;
            for line in words.chunks(16) {
                let line: Vec<_> = line.iter().map(|word: &u32| format!("{word:08X}")).collect();
                self.say(&format!("{}\r\n", line.join(" ")));
            }
        } else if let Some(text) = part.strip_prefix("ECHO ") {
            self.say(&format!("\x1b{text}\r\n"));
        } else if part == "ASKFILE" {
            self.say("\x1b\x04in.txt\r\n");
        } else {
            return ["KILL", "ENTRYPOINT", "EXECUTE", "READDISKDATA"]
                .iter()
                .any(|name| part.starts_with(name));
        }
        true
    }
}

/// A program of a given size for thread 2.
pub(crate) fn program(size: usize) -> LoadImage {
    LoadImage {
        thread: ThreadId::new(2).expect("there are 7"),
        entry: 0x8006_0010,
        parts: vec![(0x8006_0000, (1..=251).cycle().take(size).collect()), (0x8006_8000, vec![7; 70])],
        firmware: Some(VERSION.into()),
    }
}
