//! Strings, blocks of memory and characters, as in standard C.
//!
//! Each function reads the bytes that C requires, and traps at unmapped memory. Copies cost a cycle for each byte, in
//! addition to the cost of the call.

use kmotiondef::firmware::Function;
use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::parts::Parts;

/// The length of the longest string that is read: all of SDRAM.
pub(super) const LONGEST: u32 = 0x100_0000;

type Text = Result<Vec<u8>, TrapKind>;
type AddressResult = Result<GuestAddr, TrapKind>;

/// The string at an address, without its terminator; its length is charged.
pub(crate) fn text(caller: &mut Caller<'_>, address: GuestAddr) -> Text {
    let text = caller.memory.read_c_string(address, LONGEST)?;
    caller.spend(Cycles::new(text.len() as i64));
    Ok(text)
}

/// At most `limit` characters of a string.
fn text_up_to(caller: &mut Caller<'_>, address: GuestAddr, limit: u32) -> Text {
    let text = caller.memory.read_c_string(address, limit)?;
    caller.spend(Cycles::new(text.len() as i64));
    Ok(text)
}

/// A block of memory.
fn block(caller: &mut Caller<'_>, address: GuestAddr, length: u32) -> Text {
    caller.spend(Cycles::new(i64::from(length)));
    Ok(caller.memory.read_bytes(address, length)?.to_vec())
}

/// Writes a string and its terminator.
fn write_text(caller: &mut Caller<'_>, address: GuestAddr, mut text: Vec<u8>) -> Result<(), TrapKind> {
    text.push(0);
    caller.memory.write_bytes(address, &text)
}

/// The address for an index that was found, or null.
fn address_or_null(start: GuestAddr, index: Option<usize>) -> GuestAddr {
    index.map_or(GuestAddr::NULL, |index| start.offset(index as u32))
}

/// The result of a comparison of two byte strings as in the firmware: a sign, or the difference of the first bytes that
/// differ, where the end of a string counts as 0.
fn order(parts: &Parts, a: &[u8], b: &[u8]) -> i32 {
    if !parts.level.behaviour().compares_by_difference {
        return a.cmp(b) as i32;
    }
    let at = (0..a.len().max(b.len())).find(|&at| a.get(at) != b.get(at));
    let byte = |text: &[u8], at: usize| i32::from(text.get(at).copied().unwrap_or(0));
    at.map_or(0, |at| byte(a, at) - byte(b, at))
}

/// Returns the cost of `memcpy` in addition to its 32 cycles (costs.md section 4).
fn copy_cost(length: u32, is_alike: bool) -> Cycles {
    let length = i64::from(length);
    Cycles::new(match (length, is_alike) {
        (..8, _) => 0,
        (8..32, true) => 56 * (length / 8),
        (_, true) => length * 7 / 4 - 6,
        (_, false) => 7 * length,
    })
}

pub(crate) fn memcpy(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
    length: u32,
) -> AddressResult {
    let is_alike = (to.get() ^ from.get()).is_multiple_of(4);
    caller.spend(copy_cost(length, is_alike));
    caller.memory.copy(to, from, length)?;
    Ok(to)
}

pub(crate) fn memmove(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
    length: u32,
) -> AddressResult {
    memcpy(parts, caller, to, from, length)
}

pub(crate) fn memset(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    byte: i32,
    length: u32,
) -> AddressResult {
    let length_cost = if length < 8 { 0 } else { 3 + i64::from(length) * 113 / 100 };
    caller.spend(Cycles::new(length_cost));
    caller.memory.fill(to, byte as u8, length)?;
    Ok(to)
}

pub(crate) fn memccpy(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
    byte: i32,
    length: i32,
) -> AddressResult {
    for index in 0..u32::try_from(length).unwrap_or(0) {
        let copied: u8 = caller.memory.load(from.offset(index))?;
        caller.memory.store(to.offset(index), copied)?;
        if copied == byte as u8 {
            return Ok(to.offset(index + 1));
        }
    }
    Ok(GuestAddr::NULL)
}

pub(crate) fn memcmp(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    a: GuestAddr,
    b: GuestAddr,
    length: u32,
) -> Result<i32, TrapKind> {
    Ok(order(parts, &block(caller, a, length)?, &block(caller, b, length)?))
}

pub(crate) fn memchr(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    start: GuestAddr,
    byte: i32,
    length: u32,
) -> AddressResult {
    let block = block(caller, start, length)?;
    Ok(address_or_null(start, block.iter().position(|&found| found == byte as u8)))
}

pub(crate) fn strlen(_: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr) -> Result<u32, TrapKind> {
    let length = text(caller, string)?.len();
    caller.spend(Cycles::new(10 * length as i64));
    Ok(length as u32)
}

pub(crate) fn strcpy(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
) -> AddressResult {
    let text = text(caller, from)?;
    parts.check_room(caller, Function::strcpy, to, text.len() + 1);
    write_text(caller, to, text)?;
    Ok(to)
}

pub(crate) fn strncpy(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
    limit: u32,
) -> AddressResult {
    let mut text = text_up_to(caller, from, limit)?;
    let copied = text.len() as u32;
    text.truncate(limit as usize);
    caller.memory.write_bytes(to, &text)?;
    caller.memory.fill(to.offset(copied), 0, limit - copied)?;
    Ok(to)
}

pub(crate) fn strcat(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
) -> AddressResult {
    let (end, text) = (text(caller, to)?.len() as u32, text(caller, from)?);
    parts.check_room(caller, Function::strcat, to, end as usize + text.len() + 1);
    write_text(caller, to.offset(end), text)?;
    Ok(to)
}

pub(crate) fn strncat(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    from: GuestAddr,
    limit: u32,
) -> AddressResult {
    let end = text(caller, to)?.len() as u32;
    let text = text_up_to(caller, from, limit)?;
    write_text(caller, to.offset(end), text)?;
    Ok(to)
}

pub(crate) fn strcmp(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    a: GuestAddr,
    b: GuestAddr,
) -> Result<i32, TrapKind> {
    Ok(order(parts, &text(caller, a)?, &text(caller, b)?))
}

pub(crate) fn strncmp(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    a: GuestAddr,
    b: GuestAddr,
    limit: u32,
) -> Result<i32, TrapKind> {
    Ok(order(parts, &text_up_to(caller, a, limit)?, &text_up_to(caller, b, limit)?))
}

pub(crate) fn strchr(_: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr, byte: i32) -> AddressResult {
    let mut text = text(caller, string)?;
    text.push(0);
    Ok(address_or_null(string, text.iter().position(|&found| found == byte as u8)))
}

pub(crate) fn strrchr(_: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr, byte: i32) -> AddressResult {
    let mut text = text(caller, string)?;
    text.push(0);
    Ok(address_or_null(string, text.iter().rposition(|&found| found == byte as u8)))
}

pub(crate) fn strstr(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    wanted: GuestAddr,
) -> AddressResult {
    let (string_text, wanted) = (text(caller, string)?, text(caller, wanted)?);
    if wanted.is_empty() {
        return Ok(string);
    }
    let place = string_text.windows(wanted.len()).position(|window| window == wanted);
    caller.spend(Cycles::new(31 * place.unwrap_or(string_text.len()) as i64));
    Ok(address_or_null(string, place))
}

pub(crate) fn strspn(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    set: GuestAddr,
) -> Result<u32, TrapKind> {
    let (text, set) = (text(caller, string)?, text(caller, set)?);
    Ok(text.iter().take_while(|byte| set.contains(byte)).count() as u32)
}

pub(crate) fn strcspn(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    set: GuestAddr,
) -> Result<u32, TrapKind> {
    let (text, set) = (text(caller, string)?, text(caller, set)?);
    Ok(text.iter().take_while(|byte| !set.contains(byte)).count() as u32)
}

pub(crate) fn strpbrk(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    set: GuestAddr,
) -> AddressResult {
    let (text, set) = (text(caller, string)?, text(caller, set)?);
    Ok(address_or_null(string, text.iter().position(|byte| set.contains(byte))))
}

/// The next token; the position to continue from is shared by all threads of the board, as in the C library.
pub(crate) fn strtok(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    separators: GuestAddr,
) -> AddressResult {
    let start = if string.is_null() { parts.calls.token } else { string };
    if start.is_null() {
        return Ok(GuestAddr::NULL);
    }
    let (text, separators) = (text(caller, start)?, text(caller, separators)?);
    let Some(first) = text.iter().position(|byte| !separators.contains(byte)) else {
        parts.calls.token = GuestAddr::NULL;
        return Ok(GuestAddr::NULL);
    };
    let length = text[first..].iter().take_while(|byte| !separators.contains(byte)).count();
    let end = start.offset((first + length) as u32);
    parts.calls.token = if first + length == text.len() { GuestAddr::NULL } else { end.offset(1) };
    caller.memory.store(end, 0_u8)?;
    Ok(start.offset(first as u32))
}

macro_rules! characters {
    ($($(#[$doc:meta])+ $name:ident = $test:expr;)*) => {$(
        $(#[$doc])+
        pub(crate) fn $name(_: &mut Parts, _: &mut Caller<'_>, character: i32) -> i32 {
            let test: fn(&u8) -> bool = $test;
            u8::try_from(character).map_or(0, |byte| i32::from(test(&byte)))
        }
    )*};
}

characters! {
    /// White space, the vertical tab included.
    isspace = |byte| byte.is_ascii_whitespace() || *byte == 0x0b;
    /// Digits.
    isdigit = u8::is_ascii_digit;
    /// Letters.
    isalpha = u8::is_ascii_alphabetic;
    /// Letters and digits.
    isalnum = u8::is_ascii_alphanumeric;
    /// Upper-case letters.
    isupper = u8::is_ascii_uppercase;
    /// Lower-case letters.
    islower = u8::is_ascii_lowercase;
    /// Hexadecimal digits.
    isxdigit = u8::is_ascii_hexdigit;
    /// Printing characters that are neither space, letter nor digit.
    ispunct = u8::is_ascii_punctuation;
    /// Printing characters, the space among them.
    isprint = |byte| (0x20..0x7f).contains(byte);
    /// Control characters.
    iscntrl = u8::is_ascii_control;
    /// Printing characters without the space.
    isgraph = u8::is_ascii_graphic;
}

pub(crate) fn toupper(_: &mut Parts, _: &mut Caller<'_>, character: i32) -> i32 {
    u8::try_from(character).map_or(character, |byte| i32::from(byte.to_ascii_uppercase()))
}

pub(crate) fn tolower(_: &mut Parts, _: &mut Caller<'_>, character: i32) -> i32 {
    u8::try_from(character).map_or(character, |byte| i32::from(byte.to_ascii_lowercase()))
}

#[cfg(test)]
mod tests {
    use crate::testing::TestBench;

    #[test]
    fn tokens_follow_one_another() {
        let mut bench = TestBench::new();
        let (string, separators) = (bench.put_text(0, b",a,,bc,"), bench.put_text(64, b","));
        let mut tokens = Vec::new();
        let mut start = string;
        loop {
            let token = bench.call_i32("strtok", &[start, separators]) as u32;
            if token == 0 {
                break;
            }
            tokens.push(bench.text_at(token));
            start = 0;
        }
        assert_eq!(tokens, ["a", "bc"]);
    }

    #[test]
    fn strncpy_pads_with_zeros() {
        let mut bench = TestBench::new();
        let (to, from) = (bench.put_text(0, b"xxxxxx"), bench.put_text(64, b"ab"));
        bench.call_i32("strncpy", &[to, from, 4]);
        assert_eq!(bench.bytes_at(to as u32, 6), b"ab\0\0xx");
    }

    #[test]
    fn comparisons_have_a_sign() {
        let mut bench = TestBench::new();
        let (a, b) = (bench.put_text(0, b"abc"), bench.put_text(64, b"abd"));
        assert_eq!(bench.call_i32("strcmp", &[a, b]), -1);
        assert_eq!(bench.call_i32("strncmp", &[a, b, 2]), 0);
        assert_eq!(bench.call_i32("memcmp", &[b, a, 3]), 1);
    }
}
