//! The rest of the C library: heap, numbers in text, random numbers, ending.

use kmotiondef::GuestAddr;
use kmotiondef::firmware::Function;
use vm::firmware::{Caller, Outcome};
use vm::trap::TrapKind;

use super::costs::{self, IntegerReading};
use super::not_modelled;
use super::parts::Parts;
use super::string::LONGEST;
use crate::out::Message;
use crate::text::{Digits, Precision, digits, float_prefix, integer_prefix, magnitude, place_of_point};

pub(crate) fn malloc(parts: &mut Parts, caller: &mut Caller<'_>, size: u32) -> GuestAddr {
    parts.calls.heap.allocate(size).map_or(GuestAddr::NULL, |block| caller.memory.place_of(block))
}

pub(crate) fn calloc(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    count: u32,
    size: u32,
) -> Result<GuestAddr, TrapKind> {
    let Some((bytes, block)) =
        count.checked_mul(size).and_then(|bytes| Some((bytes, parts.calls.heap.allocate(bytes)?)))
    else {
        return Ok(GuestAddr::NULL);
    };
    caller.memory.fill(block, 0, bytes)?;
    costs::spend(caller, 24 + i64::from(bytes) * 3 / 4);
    Ok(block)
}

pub(crate) fn memalign(parts: &mut Parts, _: &mut Caller<'_>, alignment: u32, size: u32) -> GuestAddr {
    if alignment.is_power_of_two() {
        parts.calls.heap.take_aligned(size, alignment).unwrap_or_default()
    } else {
        GuestAddr::NULL
    }
}

pub(crate) fn realloc(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    block: GuestAddr,
    size: u32,
) -> Result<GuestAddr, TrapKind> {
    if size == 0 {
        parts.calls.heap.free(block);
        return Ok(GuestAddr::NULL);
    }
    if parts.calls.heap.resize(block, size) {
        return Ok(block);
    }
    let Some(new) = parts.calls.heap.allocate(size) else {
        return Ok(GuestAddr::NULL);
    };
    if let Some(old_size) = parts.calls.heap.size(block) {
        caller.memory.copy(new, block, old_size.min(size))?;
        parts.calls.heap.free(block);
    }
    Ok(new)
}

pub(crate) fn free(parts: &mut Parts, caller: &mut Caller<'_>, block: GuestAddr) {
    if !block.is_null() && !parts.calls.heap.free(block) {
        parts.out.diagnose(caller, Message::NotAllocated { block });
    }
}

pub(crate) fn rand(parts: &mut Parts, _: &mut Caller<'_>) -> i32 {
    parts.calls.random()
}

pub(crate) fn srand(parts: &mut Parts, _: &mut Caller<'_>, seed: u32) {
    parts.calls.seed = seed;
}

/// Bytes of white space in front of a number.
fn leading_blanks(text: &[u8]) -> usize {
    text.iter().take_while(|byte| byte.is_ascii_whitespace()).count()
}

/// An integer in text, and where it ends.
fn integer(
    caller: &mut Caller<'_>,
    string: GuestAddr,
    base: u32,
    reading: IntegerReading,
) -> Result<(i64, GuestAddr), TrapKind> {
    let text = caller.memory.read_c_string(string, LONGEST)?;
    let start = leading_blanks(&text);
    let (value, used) = integer_prefix(&text[start..], base);
    costs::spend(caller, costs::of_integer(reading, start, &text[start..start + used]));
    let end = if used == 0 { 0 } else { start + used };
    Ok((value, string.offset(end as u32)))
}

/// A double in text, and where it ends.
fn float(caller: &mut Caller<'_>, string: GuestAddr) -> Result<(f64, GuestAddr), TrapKind> {
    let text = caller.memory.read_c_string(string, LONGEST)?;
    let start = leading_blanks(&text);
    let (value, used) = float_prefix(&text[start..]);
    costs::spend(caller, costs::of_double(&text[start..start + used]));
    let end = if used == 0 { 0 } else { start + used };
    Ok((value, string.offset(end as u32)))
}

/// Stores the end of a number at the address given by the program.
fn store_end(caller: &mut Caller<'_>, place: GuestAddr, end: GuestAddr) -> Result<(), TrapKind> {
    if place.is_null() { Ok(()) } else { caller.memory.store(place, end.get()) }
}

pub(crate) fn atoi(_: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr) -> Result<i32, TrapKind> {
    Ok(integer(caller, string, 10, IntegerReading::Plain)?.0 as i32)
}

pub(crate) fn atol(parts: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr) -> Result<i32, TrapKind> {
    atoi(parts, caller, string)
}

pub(crate) fn atof(_: &mut Parts, caller: &mut Caller<'_>, string: GuestAddr) -> Result<f64, TrapKind> {
    Ok(float(caller, string)?.0)
}

pub(crate) fn strtol(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    end: GuestAddr,
    base: i32,
) -> Result<i32, TrapKind> {
    Ok(in_base(caller, string, end, base, IntegerReading::Signed)? as i32)
}

/// An integer in a base that the program gives; its end is stored.
fn in_base(
    caller: &mut Caller<'_>,
    string: GuestAddr,
    end: GuestAddr,
    base: i32,
    reading: IntegerReading,
) -> Result<i64, TrapKind> {
    let base = u32::try_from(base).ok().filter(|&base| base == 0 || (2..=36).contains(&base));
    let Some(base) = base else {
        store_end(caller, end, string)?;
        return Ok(0);
    };
    let (value, stopped) = integer(caller, string, base, reading)?;
    let text = caller.memory.read_c_string(string, LONGEST)?;
    let (is_negative, magnitude) = magnitude(&text[leading_blanks(&text)..], base);
    // A `long` of the board's library has 40 bits, of which a program gets the lower 32.
    let most = match reading {
        IntegerReading::Unsigned => (1 << 40) - 1,
        IntegerReading::Plain | IntegerReading::Signed => (1 << 39) - 1,
    };
    if magnitude > most {
        store_end(caller, end, string)?;
        return Ok(match reading {
            IntegerReading::Plain | IntegerReading::Signed if is_negative => 0,
            _ => -1,
        });
    }
    store_end(caller, end, stopped)?;
    Ok(value)
}

pub(crate) fn strtoul(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    end: GuestAddr,
    base: i32,
) -> Result<u32, TrapKind> {
    Ok(in_base(caller, string, end, base, IntegerReading::Unsigned)? as u32)
}

pub(crate) fn strtod(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    end: GuestAddr,
) -> Result<f64, TrapKind> {
    let (value, stopped) = float(caller, string)?;
    store_end(caller, end, stopped)?;
    Ok(value)
}

pub(crate) fn strtold(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    end: GuestAddr,
) -> Result<f64, TrapKind> {
    strtod(parts, caller, string, end)
}

/// Decimal text of an integer; returns its length.
pub(crate) fn ltoa(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    value: i32,
    buffer: GuestAddr,
) -> Result<i32, TrapKind> {
    let text = format!("{value}\0");
    caller.memory.write_bytes(buffer, text.as_bytes())?;
    Ok(text.len() as i32 - 1)
}

/// The buffers of `ecvt` and `fcvt`; a text begins at the second byte, or at the first if rounding has made it longer.
const ECVT: GuestAddr = GuestAddr::new(0x1001_AAAC);
const FCVT: GuestAddr = GuestAddr::new(0x1001_A430);
/// The number of digits that fit there: the board stores further digits beyond, which are lost here.
const MOST_DIGITS: usize = 380;

/// A number as digits, and where its point is.
struct NumberDigits {
    text: Vec<u8>,
    point: i32,
    /// It has become longer by rounding.
    has_grown: bool,
}

pub(crate) fn ecvt(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    value: f64,
    count: i32,
    point: GuestAddr,
    sign: GuestAddr,
) -> Result<GuestAddr, TrapKind> {
    let magnitude = value.abs();
    let converted = if magnitude < f64::MIN_POSITIVE {
        NumberDigits { text: vec![0; count.max(0) as usize], point: 1, has_grown: false }
    } else {
        let place = place_of_point(magnitude);
        // Without a count, the digits before the point remain unchanged.
        let rounded = usize::try_from(count).map(|count| digits(magnitude, Precision::Significant(count)));
        let Digits { digits: mut text, point, .. } = rounded.unwrap_or_else(|_| {
            let all = digits(magnitude, Precision::Significant(MOST_DIGITS));
            Digits { digits: all.digits[..(place.max(0) as usize).min(all.digits.len())].to_vec(), ..all }
        });
        text.truncate(usize::try_from(count).unwrap_or(MOST_DIGITS));
        NumberDigits { text, point, has_grown: point > place }
    };
    store_digits(caller, ECVT, value, &converted, [point, sign])
}

pub(crate) fn fcvt(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    value: f64,
    decimals: i32,
    point: GuestAddr,
    sign: GuestAddr,
) -> Result<GuestAddr, TrapKind> {
    let magnitude = value.abs();
    let converted = if magnitude < f64::MIN_POSITIVE {
        NumberDigits { text: vec![0; decimals.max(0) as usize + 1], point: 1, has_grown: false }
    } else {
        let place = place_of_point(magnitude);
        // Board quirk: a number that is too small is rounded by its first digit, and at most one digit is omitted.
        let wanted = i64::from(place) + i64::from(decimals.max(-1));
        let Digits { digits: text, point, .. } =
            digits(magnitude, Precision::Significant(wanted.max(0) as usize));
        NumberDigits { has_grown: point > place, text, point }
    };
    store_digits(caller, FCVT, value, &converted, [point, sign])
}

/// Stores digits in their buffer, their point and the sign; returns the place of the text.
fn store_digits(
    caller: &mut Caller<'_>,
    buffer: GuestAddr,
    value: f64,
    converted: &NumberDigits,
    [point, sign]: [GuestAddr; 2],
) -> Result<GuestAddr, TrapKind> {
    let kept = converted.text.iter().take(MOST_DIGITS).map(|digit| b'0' + digit);
    let text: Vec<u8> = kept.chain([0]).collect();
    let place = caller.memory.place_of(buffer).offset(u32::from(!converted.has_grown));
    caller.memory.write_bytes(place, &text)?;
    caller.memory.store(point, converted.point)?;
    caller.memory.store(sign, i32::from(value < 0.0))?;
    Ok(place)
}

pub(crate) fn atexit(_: &mut Parts, _: &mut Caller<'_>, _: GuestAddr) -> Result<i32, TrapKind> {
    not_modelled(Function::atexit)
}

/// Ends the calling thread.
pub(crate) fn exit(_: &mut Parts, _: &mut Caller<'_>, _: i32) -> Outcome<()> {
    Outcome::End
}

/// Ends the calling thread.
pub(crate) fn abort(_: &mut Parts, _: &mut Caller<'_>) -> Outcome<()> {
    Outcome::End
}

pub(crate) fn abs(_: &mut Parts, _: &mut Caller<'_>, x: i32) -> i32 {
    x.wrapping_abs()
}

pub(crate) fn labs(_: &mut Parts, _: &mut Caller<'_>, x: i32) -> i32 {
    x.wrapping_abs()
}

pub(crate) fn qsort(
    _: &mut Parts,
    _: &mut Caller<'_>,
    _: GuestAddr,
    _: u32,
    _: u32,
    _: GuestAddr,
) -> Result<(), TrapKind> {
    not_modelled(Function::qsort)
}

pub(crate) fn bsearch(
    _: &mut Parts,
    _: &mut Caller<'_>,
    _: GuestAddr,
    _: GuestAddr,
    _: u32,
    _: u32,
    _: GuestAddr,
) -> Result<GuestAddr, TrapKind> {
    not_modelled(Function::bsearch)
}

#[cfg(test)]
mod tests {
    use crate::testing::TestBench;

    #[test]
    fn number_parsing_stops_at_the_end_of_the_number() {
        let mut bench = TestBench::new();
        let (string, end) = (bench.put_text(0, b" 0x1fz"), bench.put_text(64, b"...."));
        assert_eq!(bench.call_i32("strtol", &[string, end, 16]), 31);
        assert_eq!(bench.memory.peek::<u32>(kmotiondef::GuestAddr::new(end as u32)), string as u32 + 5);
        assert_eq!(bench.call_i32("atoi", &[string]), 0);
    }

    #[test]
    fn a_block_keeps_its_bytes_when_it_grows() {
        let mut bench = TestBench::new();
        let block = bench.call_i32("malloc", &[8]) as u32;
        bench.memory.poke(kmotiondef::GuestAddr::new(block), 0x1234_5678_u32);
        let grown = bench.call_i32("realloc", &[u64::from(block), 100]) as u32;
        assert_eq!(bench.memory.peek::<u32>(kmotiondef::GuestAddr::new(grown)), 0x1234_5678);
    }
}
