//! The words before the bytecode of an image: code that the real processor may execute.
//!
//! A loader that ignores an image's target, as the vendor's does, would make the processor execute bytecode. So an
//! image's text begins with a return: a thread that is started there has ended before it reaches the bytecode, whose
//! first word follows. The entry point of such an image is the start of its text, for the processor as for the
//! simulated board, which reads the address of `main` in the next word.

use kmotiondef::GuestAddr;

use crate::op::WORD;

/// Bytes before the bytecode.
pub const BYTES: usize = 2 * WORD;

/// `B .S2 B3` and `NOP 5`: the return and its delay slots (`c67x.md` sections 2.2 and 3).
const RETURN: [u32; 2] = [0x000C_0362, 0x0000_8000];

/// The bytes before the bytecode of a program with this `main`.
#[must_use]
pub fn words(main: GuestAddr) -> [u8; BYTES] {
    let words = [RETURN[0], RETURN[1], main.get(), 0];
    let mut bytes = [0; BYTES];
    for (place, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
        *place = word.to_le_bytes();
    }
    bytes
}

/// The start of the bytecode in a text at `start`.
#[must_use]
pub const fn code_at(start: GuestAddr) -> GuestAddr {
    start.offset(BYTES as u32)
}

/// The address of `main` and the bytecode of a text that begins with these words.
#[must_use]
pub fn split(text: &[u8]) -> Option<(GuestAddr, &[u8])> {
    let (head, code) = text.split_first_chunk::<BYTES>()?;
    let [_, _, main, _] = *head.as_chunks().0 else { return None };
    let main = GuestAddr::new(u32::from_le_bytes(main));
    (words(main) == *head).then_some((main, code))
}

/// The bytecode of a text, with or without these words.
#[must_use]
pub fn strip(text: &[u8]) -> &[u8] {
    split(text).map_or(text, |(_, code)| code)
}

#[cfg(test)]
mod tests {
    use super::*;
    use c67x::assemble;

    #[test]
    fn the_processor_returns_at_once() {
        let words: Vec<u32> = ["B .S2 B3", "NOP 5"]
            .map(|line| assemble(line, 0).expect("it is an instruction").inst.encode(false))
            .to_vec();
        assert_eq!(words, RETURN);
    }

    #[test]
    fn a_text_is_split_as_it_was_put_together() {
        let main = GuestAddr::new(0x8005_0040);
        let text = [&words(main)[..], &[1, 2, 3]].concat();
        assert_eq!(split(&text), Some((main, &[1, 2, 3][..])));
        assert_eq!(strip(&text), [1, 2, 3]);
        assert_eq!(split(&text[1..]), None);
        assert_eq!(split(&text[..BYTES - 1]), None);
    }
}
