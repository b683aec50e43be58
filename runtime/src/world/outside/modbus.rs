//! A Modbus slave on the UART: it keeps registers, and answers requests to its address.
//!
//! Frames are those of Modbus RTU: address, function, data, a checksum with its low byte first. The slave supports the
//! functions 3 and 4 (read registers), 6 (write one) and 16 (write several); it answers other functions, and registers
//! that it does not have, with an exception. It does not answer frames with a wrong checksum or broadcasts to address
//! 0.

use std::collections::BTreeMap;

use kmotiondef::Cycles;

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;

/// Registers that one request may name.
const MOST: u16 = 125;

/// The pause after which the rest of a frame is no longer expected: 20 ms.
const GAP: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 50);

/// The reason of a refusal: an exception code of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    UnknownFunction = 1,
    NoSuchRegister = 2,
    WrongCount = 3,
}

/// A slave.
#[derive(Clone, Debug)]
pub(crate) struct Modbus {
    address: u8,
    registers: BTreeMap<u16, u16>,
    /// Time from a request to its answer.
    delay: Cycles,
    /// The part of a frame that has arrived.
    frame: Vec<u8>,
    /// The instant of its last character.
    last: Cycles,
}

impl Modbus {
    /// `address`, `registers` as `10:42,11:7`, `delay_s`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let address = settings.optional("address", "an address from 1 to 247", |text| {
            text.parse().ok().filter(|address| (1..=247).contains(address))
        })?;
        let registers = settings.optional("registers", "a list such as 10:42,11:7", registers)?;
        let delay = settings.positive("delay_s", 0.005)?;
        let delay = Cycles::new((delay * Cycles::PER_SECOND.get() as f64) as i64);
        let (address, registers) = (address.unwrap_or(1), registers.unwrap_or_default());
        Ok(Self { address, registers, delay, frame: Vec::new(), last: Cycles::default() })
    }

    /// The answer to a request without the checksum; an exception if it is refused.
    fn answer(&mut self, request: &[u8]) -> Vec<u8> {
        let function = request.get(1).copied().unwrap_or_default();
        let head = [self.address, function];
        match self.execute(function, request) {
            Ok(data) => [&head[..], &data].concat(),
            Err(refusal) => vec![self.address, function | 0x80, refusal as u8],
        }
    }

    fn execute(&mut self, function: u8, request: &[u8]) -> Result<Vec<u8>, Refusal> {
        let (first, value) = (word(request, 2), word(request, 4));
        match function {
            3 | 4 => {
                let values = self.present(first, value)?.into_iter().flat_map(u16::to_be_bytes);
                let values: Vec<_> = values.collect();
                Ok([&[values.len() as u8][..], &values].concat())
            }
            6 => {
                self.present(first, 1)?;
                self.registers.insert(first, value);
                Ok(request[2..6].to_vec())
            }
            16 => {
                self.present(first, value)?;
                if request.get(6).copied() != u8::try_from(2 * value).ok() {
                    return Err(Refusal::WrongCount);
                }
                for index in 0..value {
                    let value = word(request, 7 + 2 * usize::from(index));
                    self.registers.insert(first + index, value);
                }
                Ok(request[2..6].to_vec())
            }
            _ => Err(Refusal::UnknownFunction),
        }
    }

    /// The values of registers, if all of them exist.
    fn present(&self, first: u16, count: u16) -> Result<Vec<u16>, Refusal> {
        if !(1..=MOST).contains(&count) {
            return Err(Refusal::WrongCount);
        }
        let value = |index| self.registers.get(&first.checked_add(index)?).copied();
        (0..count).map(value).collect::<Option<_>>().ok_or(Refusal::NoSuchRegister)
    }
}

impl AttachedDevice for Modbus {
    fn sent(&mut self, byte: u8, at: Cycles, outside: &mut DeviceContext<'_>) {
        if at - self.last > GAP {
            self.frame.clear();
        }
        self.last = at;
        self.frame.push(byte);
        if self.frame.len() < length(&self.frame) {
            return;
        }
        let frame = std::mem::take(&mut self.frame);
        let Some((request, sum)) = frame.split_last_chunk::<2>().map(|(request, sum)| (request, *sum)) else {
            return;
        };
        if u16::from_le_bytes(sum) == checksum(request) && request[0] == self.address {
            let mut answer = self.answer(request);
            answer.extend(checksum(&answer).to_le_bytes());
            outside.uart.queue_bytes(&answer, at + self.delay);
        }
    }
}

/// `10:42,11:7`
fn registers(text: &str) -> Option<BTreeMap<u16, u16>> {
    let pair = |pair: &str| {
        let (number, value) = pair.split_once(':')?;
        Some((number.parse().ok()?, value.parse().ok()?))
    };
    text.split(',').map(pair).collect()
}

/// The length of a frame with its checksum, as far as its beginning determines it.
fn length(frame: &[u8]) -> usize {
    match frame.get(1) {
        Some(16 | 15) => 9 + usize::from(frame.get(6).copied().unwrap_or_default()),
        _ => 8,
    }
}

fn word(request: &[u8], at: usize) -> u16 {
    let byte = |at| request.get(at).copied().unwrap_or_default();
    u16::from_be_bytes([byte(at), byte(at + 1)])
}

/// CRC-16 of Modbus.
fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |sum, byte| {
        (0..8).fold(
            sum ^ u16::from(*byte),
            |sum: u16, _| if sum & 1 != 0 { sum >> 1 ^ 0xa001 } else { sum >> 1 },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::outside::testing::{Bench, us};

    /// The answer to a request, to which its checksum is added.
    fn asked(bench: &mut Bench, request: &[u8], at: i64) -> Vec<u8> {
        let sum = checksum(request).to_le_bytes();
        let bytes = [request, &sum].concat();
        for byte in bytes {
            bench.sent(byte, at);
        }
        let mut answer = Vec::new();
        for step in 1..400 {
            let now = us(at + 100 * step);
            if bench.uart.status(now) & 1 != 0 {
                answer.push(bench.uart.read(now));
            }
        }
        answer
    }

    fn bench() -> Bench {
        let mut bench = Bench::new("modbus address=1 registers=0:42,1:7 delay_s=0.001");
        bench.uart.set_divisor(8);
        bench.uart.status(us(0));
        bench
    }

    #[test]
    fn the_checksum_is_that_of_the_protocol() {
        assert_eq!(checksum(&[1, 3, 0, 0, 0, 1]).to_le_bytes(), [0x84, 0x0a]);
    }

    #[test]
    fn registers_are_read_and_written() {
        let mut bench = bench();
        assert_eq!(asked(&mut bench, &[1, 3, 0, 0, 0, 1], 100), [1, 3, 2, 0, 42, 0x39, 0x9b]);
        let written = asked(&mut bench, &[1, 16, 0, 0, 0, 2, 4, 1, 0, 2, 0], 100_000);
        assert_eq!(written[..6], [1, 16, 0, 0, 0, 2]);
        let read = asked(&mut bench, &[1, 4, 0, 0, 0, 2], 200_000);
        assert_eq!(read[..7], [1, 4, 4, 1, 0, 2, 0]);
        assert_eq!(asked(&mut bench, &[1, 6, 0, 1, 0, 9], 300_000)[..6], [1, 6, 0, 1, 0, 9]);
    }

    #[test]
    fn refusals_are_exceptions() {
        let mut bench = bench();
        assert_eq!(asked(&mut bench, &[1, 3, 0, 5, 0, 1], 100)[..3], [1, 0x83, 2]);
        assert_eq!(asked(&mut bench, &[1, 3, 0, 0, 0, 0], 100_000)[..3], [1, 0x83, 3]);
        assert_eq!(asked(&mut bench, &[1, 7, 0, 0, 0, 0], 200_000)[..3], [1, 0x87, 1]);
        assert!(asked(&mut bench, &[2, 3, 0, 0, 0, 1], 300_000).is_empty(), "another slave's");
    }
}
