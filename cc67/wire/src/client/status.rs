//! The status record, `MAIN_STATUS`, in the layout of the board's firmware. Source: host-protocol.md section 5; the
//! structure of each board's header.

use std::sync::LazyLock;

use kmotiondef::boards::{StructureLayout, boards};
use kmotiondef::structs::MainStatus;
use kmotiondef::{AxisId, Bit, ThreadId};

/// The number of words per line.
const WORDS_PER_LINE: usize = 16;
/// The number of bits in `BitsState`.
const PINS: usize = 64;
/// The first input and the first output of a Kanalog, and the number of each.
const KANALOG: [(u16, u16, Word); 2] = [(128, 16, Word::KanalogInputs), (144, 24, Word::KanalogOutputs)];
/// The first of the extended virtual bits in the record.
const VIRTUAL_EX: u16 = 1024;

macro_rules! fields {
    ($($variant:ident = $name:literal),* $(,)?) => {
        /// The fields that are read.
        #[derive(Clone, Copy, Debug)]
        enum Word {
            $($variant),*
        }

        /// The names of the fields in the structure, in the order of [`Word`].
        const FIELDS: &[&str] = &[$($name),*];
    };
}

fields! {
    Adc = "ADC",
    Dac = "DAC",
    Position = "Position",
    Dest = "Dest",
    InputModes = "InputModes",
    OutputModes = "OutputModes",
    Enables = "Enables",
    AxisDone = "AxisDone",
    BitsDirection = "BitsDirection",
    BitsState = "BitsState",
    KanalogInputs = "KanalogBitsStateInputs",
    KanalogOutputs = "KanalogBitsStateOutputs",
    RunOnStartUp = "RunOnStartUp",
    ThreadActive = "ThreadActive",
    StopImmediateState = "StopImmediateState",
    TimeStamp = "TimeStamp",
    PcComm = "PC_comm",
    VirtualBits = "VirtualBits",
    VirtualBitsEx0 = "VirtualBitsEx0",
}

/// The positions of the fields in the record of one firmware, in words.
#[derive(Debug, PartialEq, Eq)]
struct RecordLayout {
    words: usize,
    places: Vec<usize>,
}

impl RecordLayout {
    fn of_structure(structure: &StructureLayout) -> Self {
        let place = |name: &str| {
            let field = structure.fields.iter().find(|field| field.name == name);
            field.map_or(usize::MAX, |field| field.offset as usize / 4)
        };
        Self { words: structure.size as usize / 4, places: FIELDS.iter().map(|name| place(name)).collect() }
    }

    const fn lines(&self) -> usize {
        self.words.div_ceil(WORDS_PER_LINE)
    }
}

/// The records of all boards, without duplicates.
static LAYOUTS: LazyLock<Vec<RecordLayout>> = LazyLock::new(|| {
    let mut layouts: Vec<RecordLayout> = Vec::new();
    for board in boards() {
        let structures = board.structures();
        let record = structures.iter().find(|structure| structure.name == MainStatus::STRUCTURE.name);
        if let Some(layout) = record.map(RecordLayout::of_structure)
            && !layouts.contains(&layout)
        {
            layouts.push(layout);
        }
    }
    layouts
});

/// The state of the board at one time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Status {
    words: Vec<u32>,
    layout: &'static RecordLayout,
}

impl Status {
    /// Parses the last lines of a reply, in the layout with the length stated in the record; also returns the number of
    /// lines before it.
    pub(super) fn read(lines: &[String]) -> Option<(Self, usize)> {
        LAYOUTS.iter().find_map(|layout| {
            let before = lines.len().checked_sub(layout.lines())?;
            let record = lines.get(before..)?;
            let words = record.iter().flat_map(|line| line.split_ascii_whitespace());
            let words: Vec<u32> =
                words.map(|word| u32::from_str_radix(word, 16).ok()).collect::<Option<_>>()?;
            let stated = words.first().map(|first| *first as usize & 0xFFFF);
            let is_whole = words.len() == layout.words && stated == Some(layout.words);
            is_whole.then_some((Self { words, layout }, before))
        })
    }

    /// A word of a field.
    fn get(&self, field: Word, index: usize) -> u32 {
        let place = self.layout.places.get(field as usize).copied().unwrap_or(usize::MAX);
        self.words.get(place.saturating_add(index)).copied().unwrap_or(0)
    }

    fn double(&self, field: Word, index: usize) -> f64 {
        let word = |half| u64::from(self.get(field, 2 * index + half));
        f64::from_bits(word(0) | word(1) << 32)
    }

    /// The measured position of an axis, in counts.
    #[must_use]
    pub fn position(&self, axis: AxisId) -> f64 {
        self.double(Word::Position, axis.index())
    }

    /// The commanded position of an axis, in counts.
    #[must_use]
    pub fn dest(&self, axis: AxisId) -> f64 {
        self.double(Word::Dest, axis.index())
    }

    /// Returns whether an axis is enabled.
    #[must_use]
    pub fn is_enabled(&self, axis: AxisId) -> bool {
        self.get(Word::Enables, 0) >> axis.get() & 1 == 1
    }

    /// Returns whether the motion of an axis is complete.
    #[must_use]
    pub fn is_done(&self, axis: AxisId) -> bool {
        self.get(Word::AxisDone, 0) >> axis.get() & 1 == 1
    }

    /// The input mode of an axis.
    #[must_use]
    pub fn input_mode(&self, axis: AxisId) -> u8 {
        self.mode(Word::InputModes, axis)
    }

    /// The output mode of an axis.
    #[must_use]
    pub fn output_mode(&self, axis: AxisId) -> u8 {
        self.mode(Word::OutputModes, axis)
    }

    fn mode(&self, field: Word, axis: AxisId) -> u8 {
        let word = self.get(field, axis.index() / 8);
        (word >> (4 * (axis.index() % 8)) & 0xF) as u8
    }

    /// The level of a bit, if it is in the record: 0 to 63, those of a Kanalog, 1024 to 1055.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> Option<bool> {
        let level = |word: u32, index: usize| word >> index & 1 == 1;
        if bit.index() < PINS {
            return Some(level(self.get(Word::BitsState, bit.index() / 32), bit.index() % 32));
        }
        let within = |first: u16, count: u16| (first..first + count).contains(&bit.get());
        if within(VIRTUAL_EX, 32) {
            return Some(level(self.get(Word::VirtualBitsEx0, 0), bit.index() % 32));
        }
        let (first, _, word) = KANALOG.into_iter().find(|(first, count, _)| within(*first, *count))?;
        Some(level(self.get(word, 0), usize::from(bit.get() - first)))
    }

    /// The directions of the bits 0 to 63, 32 per word; 1 is an output.
    #[must_use]
    pub fn directions(&self) -> [u32; 2] {
        [0, 1].map(|index| self.get(Word::BitsDirection, index))
    }

    /// `VirtualBits`, whose bit 0 is the board's bit 48, and so on to 63.
    #[must_use]
    pub fn virtual_bits(&self) -> u32 {
        self.get(Word::VirtualBits, 0)
    }

    /// An analog input, 0 to 23; inputs 0 to 7 are 0 at 0 V.
    #[must_use]
    pub fn adc(&self, channel: usize) -> i32 {
        if channel < 24 { self.get(Word::Adc, channel).cast_signed() } else { 0 }
    }

    /// An analog output, 0 to 7; 0 at 0 V.
    #[must_use]
    pub fn dac(&self, channel: usize) -> i32 {
        if channel < 8 { self.get(Word::Dac, channel).cast_signed() } else { 0 }
    }

    /// The threads that start at power-up, one bit each.
    #[must_use]
    pub fn run_on_start_up(&self) -> u32 {
        self.get(Word::RunOnStartUp, 0)
    }

    /// Returns whether a thread is active.
    #[must_use]
    pub fn is_active(&self, thread: ThreadId) -> bool {
        self.get(Word::ThreadActive, 0) >> thread.get() & 1 == 1
    }

    /// The time since power-up, in seconds.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.double(Word::TimeStamp, 0)
    }

    /// The state of a feedhold; 0 for none.
    #[must_use]
    pub fn stop_state(&self) -> u32 {
        self.get(Word::StopImmediateState, 0)
    }

    /// `persist.UserData[100 + index]`, for an index from 0 to 7.
    #[must_use]
    pub fn request(&self, index: usize) -> u32 {
        if index < 8 { self.get(Word::PcComm, index) } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of a record.
    fn lines(words: &[u32]) -> Vec<String> {
        let text =
            |words: &[u32]| words.iter().map(|word| format!("{word:08X}")).collect::<Vec<_>>().join(" ");
        words.chunks(WORDS_PER_LINE).map(text).collect()
    }

    /// Checks a record of a firmware: its first word, and the positions of Position 1, Enables, BitsState,
    /// ThreadActive, TimeStamp, PC_comm.
    fn check(head: u32, words: usize, places: [usize; 6]) {
        let mut record = vec![0_u32; words];
        let [position, enables, bits, threads, time, pc] = places;
        let [low, high] = [1.5_f64.to_bits() as u32, (1.5_f64.to_bits() >> 32) as u32];
        record[0] = head;
        record[position..position + 2].copy_from_slice(&[low, high]);
        record[time..time + 2].copy_from_slice(&[low, high]);
        (record[enables], record[bits + 1], record[threads], record[pc + 7]) = (0b10, 1 << 14, 0b101, 7);
        let mut lines = lines(&record);
        lines.insert(0, "a line of somebody else".to_owned());
        let (status, before) = Status::read(&lines).expect("the lines are good");
        let axis = |number| AxisId::new(number).expect("there are 8");
        let thread = |number| ThreadId::new(number).expect("there are 7");
        let bit = |number| Bit::new(number).expect("there are 2048");
        assert_eq!((status.position(axis(1)), status.time(), status.request(7), before), (1.5, 1.5, 7, 1));
        assert_eq!((status.is_enabled(axis(1)), status.is_enabled(axis(0))), (true, false));
        let levels = [46, 45, 64, 136, 1030].map(|number| status.bit(bit(number)));
        assert_eq!(levels, [Some(true), Some(false), None, Some(false), Some(false)]);
        assert_eq!((status.is_active(thread(2)), status.is_active(thread(1))), (true, false));
        assert_eq!(Status::read(&lines[..lines.len() - 1]), None);
    }

    #[test]
    fn fields_are_where_the_record_of_the_firmware_has_them() {
        check(0x0134_0074, 116, [52, 88, 92, 101, 104, 106]);
        check(0x0135_00AE, 174, [52, 126, 132, 159, 162, 164]);
    }

    #[test]
    fn every_record_has_every_field() {
        assert_eq!(LAYOUTS.iter().map(|layout| layout.words).collect::<Vec<_>>(), [116, 174]);
        for layout in LAYOUTS.iter() {
            assert!(layout.places.iter().all(|place| *place < layout.words), "{layout:?}");
        }
    }
}
