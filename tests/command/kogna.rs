//! A Kogna at the other end of a link: a stand-in that answers as kogna.md has it, from the description alone.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

use harness::{Output, Scratch, cc67};

/// The enabled axis.
const AXIS: usize = 12;

/// Words of the status record, and the number of that with the enabled axes.
const STATUS_WORDS: usize = 174;
const ENABLES: usize = 126;

/// A board with one enabled axis; the lines that it receives arrive at the other end.
fn board() -> (SocketAddr, Receiver<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("its address");
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        while let Ok((stream, _)) = listener.accept() {
            serve(stream, &sender);
        }
    });
    (address, lines)
}

/// Answers until the PC is gone.
fn serve(mut stream: TcpStream, lines: &Sender<String>) {
    let (mut line, mut byte) = (Vec::new(), [0]);
    while let Ok(1) = stream.read(&mut byte) {
        let answer = match byte {
            [3] => {
                line.clear();
                "\x1bC\r\n".to_owned()
            }
            [b'\r'] => {
                let text = String::from_utf8_lossy(&std::mem::take(&mut line)).to_ascii_uppercase();
                let text = text.trim_start_matches(['\x1b', '\x01']);
                let _ = lines.send(text.to_owned());
                text.split(';').map(reply).collect()
            }
            [byte] => {
                line.push(byte);
                continue;
            }
        };
        if stream.write_all(answer.as_bytes()).is_err() {
            return;
        }
    }
}

fn reply(command: &str) -> String {
    match command {
        "VERSION" => "KOGNA 5.3.2 Build 18:10:31 Jan 31 2024\r\n".to_owned(),
        "GETSTATUS" => {
            let mut words = vec![0_u32; STATUS_WORDS];
            (words[0], words[ENABLES]) = (309 << 16 | STATUS_WORDS as u32, 1 << AXIS);
            let words: Vec<_> = words.iter().map(|word| format!("{word:08X}")).collect();
            words.chunks(16).map(|line| line.join(" ") + "\r\n").collect()
        }
        command if command.starts_with("CHECKTHREAD") => "0\r\n".to_owned(),
        command => command.strip_prefix("ECHO ").map(|text| format!("\x1b{text}\r\n")).unwrap_or_default(),
    }
}

fn on(scratch: &Scratch, words: &[&str], address: SocketAddr, more: &[&str]) -> Output {
    let place = format!("tcp:{address}");
    cc67(scratch, [words, &["--yes", "--on", &place], more].concat())
}

#[test]
fn flash_of_a_kogna_is_not_written_while_one_of_its_upper_axes_is_enabled() {
    let scratch = Scratch::new("kogna-flash");
    let (address, _) = board();
    let output = on(&scratch, &["flash"], address, &[]);
    let expect = "flash is not written: enabled axes (12) are enabled at power-up; end that first: \
                  `cc67 console --on tcp:";
    assert!(output.stderr.contains(expect), "{}", output.stderr);
    assert!(output.stderr.contains("then DisableAxis12"), "{}", output.stderr);
    assert_eq!(output.code, 2, "{output:?}");
}

#[test]
fn a_program_is_loaded_where_a_kogna_has_its_programs() {
    let scratch = Scratch::new("kogna-load");
    scratch.write("a.c", "main() { SetBit(46); }\n");
    let (address, lines) = board();
    let output = on(&scratch, &["run"], address, &["2:a.c"]);
    let lines: Vec<String> = lines.try_iter().collect();
    assert!(lines.iter().any(|line| line.starts_with("LOADDATA C00C0000 ")), "{lines:?} {output:?}");
    assert!(lines.iter().any(|line| line.starts_with("ENTRYPOINT2 C00C")), "{lines:?} {output:?}");
}
