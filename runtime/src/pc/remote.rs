//! The PC's answers to a board that is not simulated: the same requests and answers, through commands.
//!
//! The data that a request reads are fetched into a copy of the board's memory, the answer is computed there, and the
//! changes are stored on the board; the element for which the program waits comes last.

use std::ops::Range;

use kmotiondef::limits::{N_USER_DATA_VARS, PC_COMM_PERSIST};
use kmotiondef::structs::Persist;
use kmotiondef::variables::{CS0_LAST_FRO, CS0_LAST_RAPID_FRO, GATHER_BUFFER, PERSIST};
use kmotiondef::{Cycles, GuestAddr, ThreadId, Ticks};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;
use vm::thread::Threads;

use super::OpenBox;
use super::answers::{AnswerError, Answers};
use super::host::{self, Host, STRING_WORDS};
use super::requests::{self, Direction, PcAction};
use crate::out::{EventKind, Out};
use crate::views::TypedAccess;

/// Words of the gather buffer.
const GATHER_WORDS: u32 = 2_000_000;

/// The place of the gather buffer in the copy.
const STRINGS: GuestAddr = GuestAddr::new(0x8010_0000);

/// A board whose `UserData` and gather buffer are read and written through commands.
pub trait RemoteBoard {
    /// The failure of a command.
    type Error;

    /// Reads elements of `persist.UserData`.
    ///
    /// # Errors
    /// The board does not answer.
    fn user_data(&mut self, first: usize, count: usize) -> Result<Vec<u32>, Self::Error>;

    /// Stores an element of `persist.UserData`.
    ///
    /// # Errors
    /// The board does not answer.
    fn set_user_data(&mut self, index: usize, word: u32) -> Result<(), Self::Error>;

    /// Reads words of the gather buffer.
    ///
    /// # Errors
    /// The board does not answer.
    fn gather(&mut self, offset: u32, count: u32) -> Result<Vec<u32>, Self::Error>;

    /// Stores words in the gather buffer.
    ///
    /// # Errors
    /// The board does not answer.
    fn set_gather(&mut self, offset: u32, words: &[u32]) -> Result<(), Self::Error>;

    /// Executes a command without a reply.
    ///
    /// # Errors
    /// The board refuses it or does not answer.
    fn command(&mut self, line: &str) -> Result<(), Self::Error>;
}

/// The copy before a request is answered.
struct StateBeforeRequest {
    user_data: Vec<u32>,
    /// The elements that the request names.
    named: Range<usize>,
    /// The feed and the rapid override.
    overrides: [f32; 2],
}

/// The answers of a PC to programs on a remote board.
#[derive(Debug)]
pub struct RequestServer {
    host: Host,
    memory: GuestMemory,
    threads: Threads,
    /// The request that gets no answer and was reported.
    silent: i32,
}

impl RequestServer {
    /// A PC with these answers; without any it answers as the simulated PC does.
    #[must_use]
    pub fn new(answers: Option<Answers>) -> Self {
        let mut memory = GuestMemory::new();
        memory.set(GATHER_BUFFER, STRINGS);
        memory.set(CS0_LAST_FRO, 1.0);
        memory.set(CS0_LAST_RAPID_FRO, 1.0);
        let mut host = Host::default();
        host.answer_with(answers.unwrap_or_default());
        Self { host, memory, threads: Threads::new(), silent: 0 }
    }

    /// Leaves message and input boxes open until they are [answered](Self::answer), where no answer was set in advance.
    pub fn leave_boxes_open(&mut self) {
        self.host.leave_boxes_open();
    }

    /// Returns the box that waits for a person.
    #[must_use]
    pub fn open_box(&self) -> Option<OpenBox> {
        self.host.open_box(&self.memory)
    }

    /// Gives the next answer, such as `msgbox=ok`.
    ///
    /// # Errors
    /// The answer is wrong.
    pub fn answer(&mut self, setting: &str) -> Result<(), AnswerError> {
        self.host.answer_next(setting)
    }

    /// Answers the request in these elements of `persist.UserData`, 100 and the seven after it; returns the actions of
    /// the PC, as sentences.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn serve<B: RemoteBoard>(&mut self, board: &mut B, words: [u32; 8]) -> Result<Vec<String>, B::Error> {
        let [code, parameters @ ..] = words.map(u32::cast_signed);
        if code <= 0 {
            self.silent = 0;
            self.host.forget_request();
            self.memory.poke(element(PC_COMM_PERSIST), 0_u32);
            return Ok(Vec::new());
        }
        if self.host.is_silent(code) {
            let is_new = std::mem::replace(&mut self.silent, code) != code;
            return Ok(is_new.then(|| format!("request {code} gets no answer")).into_iter().collect());
        }
        self.fetch(board, code, &parameters)?;
        for (index, word) in (PC_COMM_PERSIST..).zip(words) {
            self.memory.poke(element(index), word);
        }
        if self.host.is_for_person(code) {
            return Ok(self.host.show_box(&self.memory, code).into_iter().collect());
        }
        let before = StateBeforeRequest {
            user_data: self.user_data(),
            named: self.named(code, &parameters),
            overrides: self.overrides(),
        };
        let mut out = Out::default();
        let mut context = TickContext {
            memory: &mut self.memory,
            threads: &mut self.threads,
            tick: Ticks::default(),
            now: Cycles::default(),
        };
        let result = host::answer(&mut self.host, &mut out, &mut context, code);
        self.store(board, code, &before)?;
        board.set_user_data(PC_COMM_PERSIST, result.cast_unsigned())?;
        self.memory.poke(element(PC_COMM_PERSIST), result);
        self.host.forget_request();
        let said = out.take_events().into_iter().filter_map(|event| match event.kind {
            EventKind::Host(text) => Some(text),
            _ => None,
        });
        Ok(said.collect())
    }

    /// The elements of `UserData` that a request refers to; none if they do not exist.
    fn named(&self, code: i32, parameters: &[i32; 7]) -> Range<usize> {
        let [first, second, third, ..] = *parameters;
        let answers = self.host.answers();
        let (start, count) = match requests::action(code) {
            Some(PcAction::Variables(_)) => (third.checked_mul(2), second.checked_mul(2)),
            Some(PcAction::Tool(..)) => (second.checked_mul(2), Some(2)),
            Some(PcAction::Cell) => (Some(first), Some(1)),
            Some(PcAction::Resolutions) => (Some(first), i32::try_from(answers.resolutions.len()).ok()),
            Some(PcAction::Settings) => (Some(first), i32::try_from(answers.setup.len()).ok()),
            Some(PcAction::Displays) => (first.checked_mul(2), i32::try_from(2 * answers.dros.len()).ok()),
            _ => return 0..0,
        };
        let index = |number: Option<i32>| number.and_then(|number| usize::try_from(number).ok());
        match (index(start), index(count)) {
            (Some(start), Some(count)) if start + count <= N_USER_DATA_VARS => start..start + count,
            _ => 0..0,
        }
    }

    /// Fetches the data that a request reads.
    fn fetch<B: RemoteBoard>(
        &mut self,
        board: &mut B,
        code: i32,
        parameters: &[i32; 7],
    ) -> Result<(), B::Error> {
        match requests::action(code) {
            Some(PcAction::MessageBox | PcAction::Mdi | PcAction::InputBox) => {
                let Ok(offset) = u32::try_from(parameters[0]) else { return Ok(()) };
                let count = STRING_WORDS.min(GATHER_WORDS.saturating_sub(offset));
                if count > 0 {
                    let words = board.gather(offset, count)?;
                    self.poke_gather(offset, &words);
                }
            }
            Some(
                PcAction::Variables(Direction::Set) | PcAction::Tool(_, Direction::Set) | PcAction::Cell,
            ) => {
                let range = self.named(code, parameters);
                let words = board.user_data(range.start, range.len())?;
                for (index, word) in range.zip(words) {
                    self.memory.poke(element(index), word);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Stores the changes made by the answer on the board.
    fn store<B: RemoteBoard>(
        &mut self,
        board: &mut B,
        code: i32,
        before: &StateBeforeRequest,
    ) -> Result<(), B::Error> {
        let is_read = matches!(
            requests::action(code),
            Some(PcAction::Variables(Direction::Set) | PcAction::Tool(_, Direction::Set))
        );
        for (index, (old, new)) in before.user_data.iter().zip(self.user_data()).enumerate() {
            // The present value on the board is unknown unless it was read.
            if *old != new || !is_read && before.named.contains(&index) {
                board.set_user_data(index, new)?;
            }
        }
        match requests::action(code) {
            Some(PcAction::EmergencyStop) => {
                for thread in ThreadId::all().skip(1) {
                    board.command(&format!("Kill{thread}"))?;
                }
            }
            Some(PcAction::Override(..)) => {
                let now = self.overrides();
                for (name, (old, new)) in
                    ["SetFRO", "SetRapidFRO"].iter().zip(before.overrides.iter().zip(now))
                {
                    if *old != new {
                        board.command(&format!("{name} {new}"))?;
                    }
                }
            }
            Some(PcAction::Cell) => {
                let variable = self.memory.peek::<u32>(element(PC_COMM_PERSIST + 1)) as usize;
                let offset =
                    if variable < N_USER_DATA_VARS { self.memory.peek(element(variable)) } else { 0 };
                let text: Vec<u32> = (0..STRING_WORDS).map(|word| self.peek_gather(offset, word)).collect();
                let length = text.iter().position(|word| word.to_le_bytes().contains(&0));
                board.set_gather(offset, &text[..length.map_or(text.len(), |last| last + 1)])?;
            }
            _ => {}
        }
        Ok(())
    }

    fn user_data(&self) -> Vec<u32> {
        (0..N_USER_DATA_VARS).map(|index| self.memory.peek(element(index))).collect()
    }

    fn overrides(&self) -> [f32; 2] {
        [self.memory.get(CS0_LAST_FRO), self.memory.get(CS0_LAST_RAPID_FRO)]
    }

    fn gather_address(&self, offset: u32, word: u32) -> GuestAddr {
        self.memory.get(GATHER_BUFFER).offset(offset.wrapping_add(word).wrapping_mul(4))
    }

    fn peek_gather(&self, offset: u32, word: u32) -> u32 {
        self.memory.peek(self.gather_address(offset, word))
    }

    fn poke_gather(&mut self, offset: u32, words: &[u32]) {
        for (word, value) in (0..).zip(words) {
            self.memory.poke(self.gather_address(offset, word), *value);
        }
    }
}

/// An element of `persist.UserData`.
fn element(index: usize) -> GuestAddr {
    PERSIST.field(Persist::USER_DATA).element(index).address()
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    /// A board that keeps the values that are stored.
    struct Words {
        data: [u32; N_USER_DATA_VARS],
        gather: Vec<u32>,
        commands: Vec<String>,
    }

    impl RemoteBoard for Words {
        type Error = Infallible;

        fn user_data(&mut self, first: usize, count: usize) -> Result<Vec<u32>, Infallible> {
            Ok(self.data[first..first + count].to_vec())
        }

        fn set_user_data(&mut self, index: usize, word: u32) -> Result<(), Infallible> {
            self.data[index] = word;
            Ok(())
        }

        fn gather(&mut self, offset: u32, count: u32) -> Result<Vec<u32>, Infallible> {
            Ok(self.gather[offset as usize..][..count as usize].to_vec())
        }

        fn set_gather(&mut self, offset: u32, words: &[u32]) -> Result<(), Infallible> {
            self.gather[offset as usize..][..words.len()].copy_from_slice(words);
            Ok(())
        }

        fn command(&mut self, line: &str) -> Result<(), Infallible> {
            self.commands.push(line.to_owned());
            Ok(())
        }
    }

    fn ask(server: &mut RequestServer, board: &mut Words, request: &[i32]) -> (i32, Vec<String>) {
        for (place, word) in board.data[PC_COMM_PERSIST..].iter_mut().zip(request) {
            *place = word.cast_unsigned();
        }
        let words = std::array::from_fn(|index| board.data[PC_COMM_PERSIST + index]);
        let Ok(said) = server.serve(board, words);
        (board.data[PC_COMM_PERSIST].cast_signed(), said)
    }

    fn board() -> (RequestServer, Words) {
        let data = [0; N_USER_DATA_VARS];
        (RequestServer::new(None), Words { data, gather: vec![0; 2000], commands: Vec::new() })
    }

    #[test]
    fn a_box_stays_open_until_somebody_answers_it() {
        let (mut server, mut board) = board();
        server.leave_boxes_open();
        board.gather[1000] = u32::from_le_bytes(*b"tool");
        board.gather[1001] = u32::from_le_bytes(*b" 3?\0");
        let asked = ask(&mut server, &mut board, &[15, 1000, 4]);
        assert_eq!(asked, (15, vec!["message box: tool 3?: waiting for an answer".to_owned()]));
        // It is shown once.
        assert_eq!(ask(&mut server, &mut board, &[15, 1000, 4]), (15, vec![]));
        let open = OpenBox::Message { text: "tool 3?".to_owned(), buttons: &["yes", "no"] };
        assert_eq!(server.open_box(), Some(open));
        server.answer("msgbox=no").expect("an answer");
        assert_eq!(server.open_box(), None);
        let (result, _) = ask(&mut server, &mut board, &[15, 1000, 4]);
        assert_eq!((result, board.data[PC_COMM_PERSIST + 3], server.open_box()), (0, 7, None));
    }

    #[test]
    fn a_message_box_is_shown_and_answered() {
        let (mut server, mut board) = board();
        board.gather[1000] = u32::from_le_bytes(*b"go o");
        board.gather[1001] = u32::from_le_bytes(*b"n?\0\0");
        assert_eq!(
            ask(&mut server, &mut board, &[15, 1000, 4]),
            (0, vec!["message box: go on? (yes, 6)".to_owned()])
        );
        assert_eq!(board.data[103], 6, "Yes");
    }

    #[test]
    fn variables_tools_cells_and_overrides_reach_the_pc_and_the_board() {
        let (mut server, mut board) = board();
        board.data[10] = 2.5_f64.to_bits() as u32;
        board.data[11] = (2.5_f64.to_bits() >> 32) as u32;
        assert_eq!(ask(&mut server, &mut board, &[17, 500, 1, 5]).0, 0);
        (board.data[10], board.data[11]) = (0, 0);
        assert_eq!(ask(&mut server, &mut board, &[16, 500, 1, 5]).0, 0);
        assert_eq!(
            (board.data[10], board.data[11]),
            (2.5_f64.to_bits() as u32, (2.5_f64.to_bits() >> 32) as u32)
        );
        board.data[30] = 1500;
        assert_eq!(ask(&mut server, &mut board, &[53, 30]).0, 0);
        assert_eq!(board.gather[1500].to_le_bytes(), *b"0\0\0\0");
        assert_eq!(ask(&mut server, &mut board, &[5, 0.5_f32.to_bits().cast_signed()]).0, 0);
        assert_eq!(ask(&mut server, &mut board, &[1]).0, 0);
        assert_eq!(board.commands, ["SetFRO 0.5", "Kill2", "Kill3", "Kill4", "Kill5", "Kill6", "Kill7"]);
    }
}
