//! The PC's side of disk files: requests that come among the console lines, and the answers to them.
//!
//! The board has no disk. `fopen` and similar functions send a console line whose first character is a code; the PC
//! executes it, and answers a read with a line of the file, which the board puts into `read_disk_buffer`. The PC has
//! one file open for writing and one for reading. Source: host-protocol.md section 6.

use std::collections::VecDeque;

use kmotiondef::Cycles;
use kmotiondef::variables::{READ_DISK_BUFFER, READ_DISK_BUFFER_STATUS};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use crate::out::{Message, Out};
use crate::pc::files::{FileError, HostFiles};
use crate::views::TypedAccess;

/// From a request to its answer: 20 ms, unless a machine file sets another.
const LATENCY: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 50);
/// Longest line the PC delivers.
const LINE_LIMIT: usize = 1024;

/// States of the board's line buffer.
pub(crate) const ASKED: i32 = 0;
pub(crate) const ARRIVED: i32 = 1;
pub(crate) const FAILED: i32 = 2;
pub(crate) const NO_MORE: i32 = 3;

/// A request of a program to the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DiskRequest {
    /// Open for writing, and truncate.
    Create = 1,
    /// Write a line.
    Write = 2,
    /// Close the file open for writing.
    CloseWriting = 3,
    /// Open for reading; the answer is the first line.
    Open = 4,
    /// The next line.
    NextLine = 5,
    /// Close the file open for reading.
    CloseReading = 6,
    /// Open for appending.
    Append = 7,
}

impl DiskRequest {
    const ALL: [Self; 7] = [
        Self::Create,
        Self::Write,
        Self::CloseWriting,
        Self::Open,
        Self::NextLine,
        Self::CloseReading,
        Self::Append,
    ];

    /// The request in a console line, and the text after its code.
    fn read(line: &[u8]) -> Option<(Self, &[u8])> {
        let (code, text) = line.split_first()?;
        Self::of_code(*code).map(|request| (request, text))
    }

    /// The request with a code.
    fn of_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|request| request.code() == code)
    }

    /// The character with which it is sent.
    pub(crate) const fn code(self) -> u8 {
        self as u8
    }
}

/// The PC's answer to a request that reads a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileAnswer {
    /// A line of the file, without its end.
    Line(Vec<u8>),
    /// The end of the file.
    End,
    /// The file cannot be read, or none is open.
    Failure,
}

/// A request for a file that was served.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServedFile {
    /// The answer to the board; `None` for a request that has none.
    pub answer: Option<FileAnswer>,
    /// The reason why it could not be done, in a sentence.
    pub remark: Option<String>,
}

/// The files of a PC for a board that is not simulated.
///
/// Requests are those of `fopen`, `fprintf`, `fgets` and `fclose` in programs. Source: host-protocol.md section 6.
#[derive(Clone, Debug)]
pub struct FileServer(Disk);

impl FileServer {
    /// Serves the files of a folder or of memory.
    #[must_use]
    pub fn new(files: Box<dyn HostFiles>) -> Self {
        Self(Disk::new(files))
    }

    /// Executes a request with a code from 1 to 7.
    pub fn serve(&mut self, code: u8, text: &[u8]) -> ServedFile {
        let Some(request) = DiskRequest::of_code(code) else {
            return ServedFile { answer: None, remark: Some(format!("unknown request {code} for a file")) };
        };
        let text = String::from_utf8_lossy(text);
        let remark = self.0.serve(request, &text, Cycles::new(0)).map(|message| message.to_string());
        ServedFile { answer: self.0.answers.pop_front().map(|(_, answer)| answer), remark }
    }
}

/// The disk, and its open files.
#[derive(Clone, Debug)]
pub(crate) struct Disk {
    files: Box<dyn HostFiles>,
    /// The rest of the file that is being read.
    reading: Option<TextLines>,
    writing: Option<String>,
    /// From a request to its answer.
    pub(crate) latency: Cycles,
    /// Answers in transit, with their arrival times.
    answers: VecDeque<(Cycles, FileAnswer)>,
}

impl Disk {
    /// Nothing is open.
    pub(crate) fn new(files: Box<dyn HostFiles>) -> Self {
        Self { files, reading: None, writing: None, latency: LATENCY, answers: VecDeque::new() }
    }

    /// Drops all answers, because the board restarts.
    pub(crate) fn forget_answers(&mut self) {
        self.answers.clear();
    }

    /// For how many ticks from `now` no answer arrives.
    pub(crate) fn quiet_ticks(&self, now: Cycles) -> u64 {
        self.answers.front().map_or(u64::MAX, |(due, _)| {
            let ticks = (*due - now).get() / Cycles::PER_TICK.get();
            u64::try_from(ticks - 1).unwrap_or(0)
        })
    }

    /// Executes a request; makes a remark if it cannot.
    fn serve(&mut self, request: DiskRequest, text: &str, now: Cycles) -> Option<Message> {
        match request {
            DiskRequest::Create | DiskRequest::Append => {
                let made = self.files.create(text, request == DiskRequest::Append);
                let before = std::mem::replace(&mut self.writing, made.is_ok().then(|| text.to_owned()));
                let name = text.to_owned();
                match made {
                    Err(error) => Some(Message::FileNotMade { name, error: error.to_string() }),
                    Ok(_) => before
                        .filter(|before| *before != name)
                        .map(|before| Message::FileReplaced { name, before }),
                }
            }
            DiskRequest::Write => self.write(text),
            DiskRequest::CloseWriting => {
                self.writing = None;
                None
            }
            DiskRequest::Open => {
                let is_late = !self.answers.is_empty();
                let opened = self.files.read(text);
                let error = opened.as_ref().err().cloned();
                self.reading = opened.ok().map(TextLines::new);
                self.answer(now);
                error
                    .map(|error| {
                        let place = self.files.place_of(text).filter(|_| error == FileError::Missing);
                        let error = place
                            .map_or_else(|| error.to_string(), |place| format!("there is no file {place}"));
                        Message::FileNotRead { name: text.to_owned(), error }
                    })
                    .or_else(|| is_late.then(|| Message::OldFileAnswer { name: text.to_owned() }))
            }
            DiskRequest::NextLine => {
                self.answer(now);
                None
            }
            DiskRequest::CloseReading => {
                self.reading = None;
                None
            }
        }
    }

    /// The file that is open for writing.
    pub(crate) fn written(&self) -> Option<&str> {
        self.writing.as_deref()
    }

    fn write(&mut self, text: &str) -> Option<Message> {
        let Some(name) = &self.writing else { return Some(Message::NoOpenFile {}) };
        let written = self.files.append(name, format!("{text}\n").as_bytes());
        written.err().map(|error| Message::FileNotWritten { name: name.clone(), error: error.to_string() })
    }

    /// Sends the next line, or reports the end of the file.
    fn answer(&mut self, now: Cycles) {
        let answer = match &mut self.reading {
            None => FileAnswer::Failure,
            Some(lines) => lines.next().map_or(FileAnswer::End, FileAnswer::Line),
        };
        self.answers.push_back((now + self.latency, answer));
    }

    /// The answer that has arrived by now.
    fn arrived_answer(&mut self, now: Cycles) -> Option<FileAnswer> {
        let is_due = self.answers.front().is_some_and(|(due, _)| *due <= now);
        if is_due { self.answers.pop_front().map(|(_, answer)| answer) } else { None }
    }

    /// Takes a console line if it is a request; returns whether it was.
    pub(crate) fn take(&mut self, out: &mut Out, line: &[u8], now: Cycles) -> bool {
        let Some((request, text)) = DiskRequest::read(line) else { return false };
        let text = String::from_utf8_lossy(text);
        if matches!(request, DiskRequest::Create | DiskRequest::Append) {
            out.forget_remarks(&["no-open-file"]);
        }
        if let Some(message) = self.serve(request, &text, now) {
            out.remark(now, message);
        }
        true
    }

    /// Puts an answer that has arrived into the board's line buffer; returns whether there was one.
    #[inline]
    pub(crate) fn slice(&mut self, context: &mut TickContext<'_>) -> bool {
        let Some(answer) = self.arrived_answer(context.now) else { return false };
        match answer {
            FileAnswer::Line(line) => deliver(context.memory, &line),
            FileAnswer::End => context.memory.set(READ_DISK_BUFFER_STATUS, NO_MORE),
            FileAnswer::Failure => context.memory.set(READ_DISK_BUFFER_STATUS, FAILED),
        }
        true
    }
}

fn deliver(memory: &mut GuestMemory, line: &[u8]) {
    let buffer = memory.locate(READ_DISK_BUFFER);
    for (index, byte) in (0..).zip(line.iter().chain(&[0])) {
        memory.poke(buffer.offset(index), *byte);
    }
    memory.set(READ_DISK_BUFFER_STATUS, ARRIVED);
}

/// The lines of a text without their ends; a last line without an end counts.
#[derive(Clone, Debug)]
struct TextLines {
    text: Vec<u8>,
    /// The offset of the next line.
    next: usize,
}

impl TextLines {
    fn new(text: Vec<u8>) -> Self {
        Self { text, next: 0 }
    }
}

impl Iterator for TextLines {
    type Item = Vec<u8>;

    fn next(&mut self) -> Option<Vec<u8>> {
        let rest = self.text.get(self.next..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == b'\n');
        let line = &rest[..length.unwrap_or(rest.len())];
        let shown = line.strip_suffix(b"\r").unwrap_or(line);
        let shown = shown[..shown.len().min(LINE_LIMIT)].to_vec();
        self.next += line.len() + 1;
        Some(shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_last_line_without_a_line_end_is_read() {
        let lines = |text: &[u8]| TextLines::new(text.to_vec()).collect::<Vec<_>>();
        assert_eq!(lines(b"a\r\n\r\nb"), [&b"a"[..], b"", b"b"]);
        assert_eq!(lines(b"a\n"), [b"a"]);
        assert_eq!(lines(b"\n"), [b""]);
        assert!(lines(b"").is_empty());
    }

    #[test]
    fn a_line_of_more_than_1024_characters_is_cut() {
        assert_eq!(TextLines::new(vec![b'x'; 2000]).collect::<Vec<_>>(), [vec![b'x'; 1024]]);
    }

    #[test]
    fn requests_differ_from_console_lines_in_their_first_character() {
        assert_eq!(DiskRequest::read(b"\x04a.txt"), Some((DiskRequest::Open, &b"a.txt"[..])));
        assert_eq!(DiskRequest::read(b"\x07"), Some((DiskRequest::Append, &b""[..])));
        for line in [&b"text"[..], b"", b"\x08", b"a\x02"] {
            assert_eq!(DiskRequest::read(line), None);
        }
    }
}
