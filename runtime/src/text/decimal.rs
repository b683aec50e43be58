//! Decimal digits of a double, as the board's library finds them.
//!
//! The board does not round correctly: it brings large values into the range of an `int` by multiplying by 0.1, takes
//! the integer part exactly, and computes every further digit by multiplying the fraction by ten in double arithmetic;
//! the digit after the last needed one decides the rounding, halves going up. `%e` multiplies until a single digit is
//! before the point. So 0.35 rounds to 0.4 and 2.675 to 2.67, `%f` of 123456789012345678 ends in
//! 719.337463, and `%.16e` of 4462 is 4.4620000000000006e+03, as measured (gather-persist-console.md section 4.1). The
//! same steps here yield the same text.

/// Decimal digits and the position of the point among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Digits {
    /// Digits as values 0 to 9; the first is not 0 unless the value is.
    pub(crate) digits: Vec<u8>,
    /// The number of digits before the decimal point; negative for zeros after it.
    pub(crate) point: i32,
    /// The steps that computed them.
    pub(crate) steps: Steps,
}

/// The steps in which the board finds digits: a conversion costs by their number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Steps {
    /// Multiplications by a tenth.
    pub(crate) scaled: u32,
    /// Digits of the integer part.
    pub(crate) whole: u32,
    /// Bits of the integer part and of its quotients by ten: the board divides bit by bit.
    pub(crate) divided: u32,
    /// Multiplications by ten in front of the first digit.
    pub(crate) zeros: u32,
    /// Nines through which rounding carries.
    pub(crate) carried: u32,
    /// True if the last digit is rounded up.
    pub(crate) is_raised: bool,
}

/// The digits that are needed, by the board's two algorithms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    /// This many digits from the first that is not 0, as `%g` finds them.
    Significant(usize),
    /// This many digits after the decimal point, as `%f` finds them.
    Decimals(usize),
    /// This many digits from the first that is not 0, as `%e` finds them.
    Scientific(usize),
}

/// Above this, the largest `int`, a value is scaled down first.
const WHOLE_MAX: f64 = 2_147_483_647.0;

/// Half of the value of a number that is not finite: 2 to the power of 1023.
const HALF_OF_INFINITE: f64 = f64::from_bits(0x7FE0_0000_0000_0000);

/// Computes the digits of a magnitude, rounded at the last digit given by `keep`.
///
/// Zero has no digits, and neither has a denormal value, which the processor treats as zero. Values that are not finite
/// count as 2 to the power of 1024.
pub(crate) fn digits(magnitude: f64, keep: Precision) -> Digits {
    if magnitude < f64::MIN_POSITIVE {
        return Digits { digits: Vec::new(), point: 0, steps: Steps::default() };
    }
    let LeadingDigits { mut digits, fraction, point, steps } = match keep {
        Precision::Significant(_) | Precision::Decimals(_) => split(magnitude),
        Precision::Scientific(_) => split_scientific(magnitude),
    };
    let wanted = match keep {
        Precision::Significant(count) | Precision::Scientific(count) => count as i64,
        Precision::Decimals(count) => count as i64 + i64::from(point),
    };
    let Ok(wanted) = usize::try_from(wanted) else {
        return Digits { digits: Vec::new(), point: 0, steps };
    };
    extend(&mut digits, fraction, wanted + 1);
    round_at(digits, point, wanted, steps)
}

/// A magnitude with its first digits.
struct LeadingDigits {
    digits: Vec<u8>,
    /// The rest after the first digits.
    fraction: f64,
    point: i32,
    steps: Steps,
}

/// Digits of a normal magnitude before its decimal point, without rounding; negative for zeros after it.
pub(crate) fn place_of_point(magnitude: f64) -> i32 {
    split(magnitude).point
}

/// The value after the first steps of scaling down, and the number of decimal places by which it was moved.
fn scale_down(magnitude: f64) -> (f64, i32) {
    // 2^1024 is not a double, but a tenth of it is: 2^1023 times twice 0.1.
    if magnitude.is_finite() { (magnitude, 0) } else { (HALF_OF_INFINITE * 0.2, 1) }
}

/// Splits off the digits of the integer part, if it is not 0.
fn split(magnitude: f64) -> LeadingDigits {
    let (mut value, mut point) = scale_down(magnitude);
    while value > WHOLE_MAX {
        value *= 0.1;
        point += 1;
    }
    let mut steps = Steps { scaled: point.unsigned_abs(), ..Steps::default() };
    let whole = libm::trunc(value);
    let mut fraction = value - whole;
    let mut digits = Vec::new();
    if whole > 0.0 {
        digits.extend(format!("{whole:.0}").bytes().map(|digit| digit - b'0'));
        point += digits.len() as i32;
        steps.whole = digits.len() as u32;
        steps.divided = divided_bits(whole as u32);
    } else {
        while fraction * 10.0 < 1.0 {
            fraction *= 10.0;
            point -= 1;
            steps.zeros += 1;
        }
    }
    LeadingDigits { digits, fraction, point, steps }
}

/// Bits of a number and of its quotients by ten.
fn divided_bits(number: u32) -> u32 {
    let quotients = std::iter::successors(Some(number), |rest| Some(rest / 10));
    quotients.take_while(|rest| *rest > 0).map(|rest| rest.ilog2() + 1).sum()
}

/// With the first digit.
fn split_scientific(magnitude: f64) -> LeadingDigits {
    let (mut value, mut exponent) = scale_down(magnitude);
    while value >= 10.0 {
        value *= 0.1;
        exponent += 1;
    }
    let mut steps = Steps { scaled: exponent.unsigned_abs(), ..Steps::default() };
    while value < 1.0 {
        value *= 10.0;
        exponent -= 1;
        steps.zeros += 1;
    }
    let whole = libm::trunc(value);
    LeadingDigits { digits: vec![whole as u8], fraction: value - whole, point: exponent + 1, steps }
}

/// Appends digits of the fraction until there are `count`.
fn extend(digits: &mut Vec<u8>, mut fraction: f64, count: usize) {
    while digits.len() < count {
        fraction *= 10.0;
        let digit = libm::trunc(fraction);
        fraction -= digit;
        digits.push(digit as u8);
    }
}

/// Cuts to `wanted` digits; rounds up if the next digit is at least 5.
fn round_at(mut digits: Vec<u8>, mut point: i32, wanted: usize, mut steps: Steps) -> Digits {
    let up = digits.get(wanted).is_some_and(|&digit| digit >= 5);
    digits.truncate(wanted);
    if up {
        let nines = digits.iter().rev().take_while(|&&digit| digit == 9).count();
        (steps.is_raised, steps.carried) = (true, nines as u32);
        let changed = digits.len() - nines;
        digits[changed..].fill(0);
        if let Some(last) = changed.checked_sub(1) {
            digits[last] += 1;
        } else {
            digits.insert(0, 1);
            point += 1;
        }
    }
    Digits { digits, point, steps }
}

impl Digits {
    /// The exponent of the first digit, 0 for zero.
    pub(crate) fn exponent(&self) -> i32 {
        if self.digits.is_empty() { 0 } else { self.point - 1 }
    }

    /// Returns whether `%g` shows them with an exponent.
    pub(crate) fn is_scientific(&self, precision: usize) -> bool {
        self.exponent() < -4 || self.exponent() >= precision as i32
    }

    /// The number of digits that are 0 at the end.
    pub(crate) fn zeros_at_end(&self) -> usize {
        self.digits.iter().rev().take_while(|&&digit| digit == 0).count()
    }

    /// The digit at `place`, counted from the decimal point: 0 is the first after it, −1 the one before it.
    fn at(&self, place: i64) -> u8 {
        let index = place + i64::from(self.point);
        usize::try_from(index)
            .ok()
            .and_then(|index| self.digits.get(index))
            .map_or(b'0', |digit| b'0' + digit)
    }

    /// Text with `decimals` digits after the point, as `%f` has it.
    pub(crate) fn fixed(&self, decimals: usize, always_point: bool) -> Vec<u8> {
        let whole = i64::from(self.point.max(1));
        let mut text: Vec<u8> = (-whole..0).map(|place| self.at(place)).collect();
        if decimals > 0 || always_point {
            text.push(b'.');
        }
        text.extend((0..decimals as i64).map(|place| self.at(place)));
        text
    }

    /// Text with `decimals` digits after the point and an exponent, as `%e` has it; `letter` is `e` or `E`.
    pub(crate) fn scientific(&self, decimals: usize, always_point: bool, letter: u8) -> Vec<u8> {
        let mantissa = Self { digits: self.digits.clone(), point: 1, steps: self.steps };
        let mut text = mantissa.fixed(decimals, always_point);
        let exponent = if self.digits.is_empty() { 0 } else { self.point - 1 };
        push_exponent(&mut text, exponent, letter);
        text
    }
}

/// Appends an exponent with its sign and at least two digits.
fn push_exponent(text: &mut Vec<u8>, exponent: i32, letter: u8) {
    text.push(letter);
    text.push(if exponent < 0 { b'-' } else { b'+' });
    text.extend(format!("{:02}", exponent.unsigned_abs()).bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: f64, keep: Precision, expect: &str, point: i32) {
        let found = digits(value, keep);
        let text: String = found.digits.iter().map(|digit| char::from(b'0' + digit)).collect();
        assert_eq!((text.as_str(), found.point), (expect, point), "{value} {keep:?}");
    }

    #[test]
    fn halves_round_up_and_digits_come_from_the_fraction() {
        check(0.5, Precision::Decimals(0), "1", 1);
        check(2.5, Precision::Significant(1), "3", 1);
        check(0.35, Precision::Decimals(1), "4", 0);
        check(2.675, Precision::Decimals(2), "267", 1);
        check(99.96, Precision::Decimals(1), "1000", 3);
    }

    #[test]
    fn large_values_lose_digits_as_on_the_board() {
        check(9_007_199_254_740_992.0, Precision::Significant(19), "9007199254740996361", 16);
        check(4462.0, Precision::Scientific(17), "44620000000000006", 4);
        check(f64::INFINITY, Precision::Significant(6), "179769", 309);
    }

    #[test]
    fn small_values_have_zeros_after_the_point() {
        check(0.00012, Precision::Significant(2), "12", -3);
        check(4.9e-7, Precision::Decimals(6), "", -6);
        check(5.1e-7, Precision::Decimals(6), "1", -5);
        check(0.0004, Precision::Decimals(2), "", 0);
    }
}
