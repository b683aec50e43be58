//! The numbers that `sscanf` reads from text.
//!
//! The board collects the characters that may belong to a number and converts them, even incomplete ones: a sign alone
//! is 0. Integers are computed in 40 bits. Floats are the integer of all digits times a power of ten from a table that
//! ends at 10^32 (gather-persist-console.md section 4.2).

/// The base of an integer's digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Base {
    /// `d`
    Decimal,
    /// `u`
    Unsigned,
    /// `o`
    Octal,
    /// `x`, `X`, `p`
    Hexadecimal,
    /// `i`: as the digits begin.
    Any,
}

/// Bits of the board's `long`.
const LONG_BITS: u32 = 40;

/// Reads an integer at the beginning of `text`: the 40 bits of its value, and its length in bytes.
pub(super) fn integer_value(text: &[u8], base: Base) -> (u64, usize) {
    let mut reader = Reader { text, at: 0 };
    let negative = reader.sign();
    let begin = reader.at;
    if matches!(base, Base::Hexadecimal | Base::Any) {
        reader.one_of(b"0");
        reader.one_of(b"xX");
        reader.take(u8::is_ascii_hexdigit);
    } else {
        reader.take(u8::is_ascii_digit);
    }
    let digits = &text[begin..reader.at];
    let (radix, digits) = match (base, digits) {
        (Base::Decimal | Base::Unsigned, _) => (10, digits),
        (Base::Octal, _) => (8, digits),
        (Base::Hexadecimal | Base::Any, [b'0', b'x' | b'X', behind @ ..]) => (16, behind),
        (Base::Hexadecimal, _) => (16, digits),
        (Base::Any, [b'0', ..]) => (8, digits),
        (Base::Any, _) => (10, digits),
    };
    let is_signed = matches!(base, Base::Decimal | Base::Any);
    (saturate_long(magnitude(digits, radix), negative, is_signed), reader.at)
}

/// The value of the digits up to the first that is none in this base.
pub(super) fn magnitude(digits: &[u8], radix: u32) -> u64 {
    digits
        .iter()
        .map_while(|&byte| char::from(byte).to_digit(radix))
        .fold(0_u64, |value, digit| value.saturating_mul(u64::from(radix)).saturating_add(u64::from(digit)))
}

/// The 40 bits of a value that stops at the limits of its type.
pub(super) fn saturate_long(magnitude: u64, negative: bool, is_signed: bool) -> u64 {
    let limit = 1_u64 << if is_signed { LONG_BITS - 1 } else { LONG_BITS };
    let magnitude = if is_signed && negative { magnitude.min(limit) } else { magnitude.min(limit - 1) };
    let value = if negative { magnitude.wrapping_neg() } else { magnitude };
    value & ((1 << LONG_BITS) - 1)
}

/// The powers of ten by the bits of the exponent, and the words after them in the board's memory.
const POWERS: [f64; 9] = [1e1, 1e2, 1e4, 1e8, 1e16, 1e32, 0.0, 1.0, 2.0];

/// The limit of decimal exponents of doubles: beyond it, the value is the largest double, or 0.
const EXPONENT_MAX: i64 = 308;

/// Reads a float at the beginning of `text`: its value, and its length in bytes.
///
/// An exponent letter without digits makes the value 0.
pub(crate) fn float_value(text: &[u8]) -> (f64, usize) {
    let mut reader = Reader { text, at: 0 };
    let negative = reader.sign();
    let whole = reader.take(u8::is_ascii_digit);
    reader.one_of(b".");
    let decimals =
        if reader.at > 0 && text[reader.at - 1] == b'.' { reader.take(u8::is_ascii_digit) } else { &[] };
    let mut exponent = 0_i64;
    let mut is_number = true;
    if reader.one_of(b"eE") {
        let is_small = reader.sign();
        let digits = reader.take(u8::is_ascii_digit);
        is_number = !digits.is_empty();
        let written = i64::try_from(magnitude(digits, 10)).unwrap_or(i64::MAX);
        exponent = if is_small { -written } else { written };
    }
    let digits = whole.iter().chain(decimals);
    let mantissa = digits.fold(0.0, |value: f64, digit| value * 10.0 + f64::from(digit - b'0'));
    let value =
        if is_number { scale_decimal(mantissa, exponent.saturating_sub(decimals.len() as i64)) } else { 0.0 };
    // Board quirk: a value that is too small is 0 without a sign.
    let negative = negative && exponent >= -EXPONENT_MAX;
    (if negative { -value } else { value }, reader.at)
}

/// A mantissa times ten to the power of `exponent`.
fn scale_decimal(mantissa: f64, exponent: i64) -> f64 {
    let is_small = exponent < 0;
    let exponent = exponent.unsigned_abs();
    if mantissa == 0.0 || exponent > EXPONENT_MAX.unsigned_abs() {
        return if mantissa == 0.0 || is_small { 0.0 } else { f64::MAX };
    }
    let powers = POWERS.iter().enumerate().filter(|(bit, _)| exponent >> bit & 1 == 1);
    powers.fold(mantissa, |value, (_, &power)| value * if is_small { reciprocal(power) } else { power })
}

/// One divided by a power of ten as the board's library does it: an estimate of eight bits, and three of Newton's
/// steps, which do not round correctly (c67-subset.md section 7).
fn reciprocal(power: f64) -> f64 {
    if power == 0.0 {
        // The processor's quotient by zero has all bits set.
        return f64::from_bits(i64::MAX.cast_unsigned());
    }
    const ESTIMATED: u64 = !0 << (f64::MANTISSA_DIGITS - 1 - 8);
    let estimate = f64::from_bits((1.0 / power).to_bits() & ESTIMATED);
    (0..3).fold(estimate, |value, _| value * (2.0 - power * value))
}

/// Takes bytes from the beginning of a text.
struct Reader<'t> {
    text: &'t [u8],
    at: usize,
}

impl<'t> Reader<'t> {
    /// Takes one byte if it is one of `bytes`.
    fn one_of(&mut self, bytes: &[u8]) -> bool {
        let is_one = self.text.get(self.at).is_some_and(|byte| bytes.contains(byte));
        self.at += usize::from(is_one);
        is_one
    }

    /// Takes one sign; returns whether it is a minus.
    fn sign(&mut self) -> bool {
        self.one_of(b"+-") && self.text[self.at - 1] == b'-'
    }

    /// Takes all following bytes that belong.
    fn take(&mut self, belongs: impl Fn(&u8) -> bool) -> &'t [u8] {
        let taken = self.text[self.at..].iter().take_while(|byte| belongs(byte)).count();
        let begin = self.at;
        self.at += taken;
        &self.text[begin..self.at]
    }
}
