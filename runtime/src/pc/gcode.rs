//! Assignments to #variables in a line of G code: `#100 = [#100 + 1]`.
//!
//! An expression is a number, a variable (`#5`, `##5`, `#[5+1]`), a sign, a function of a bracket, or a bracket of
//! operators. As in the interpreter that the manual describes (RS274NGC), `**` binds closest, then `*`, `/` and `MOD`,
//! then `+` and `-`, then comparisons, then `AND`, `OR` and `XOR`; operators of one level associate from left to right,
//! angles are in degrees, and all assignments of a line happen after all values were computed.

use std::collections::BTreeMap;

/// The part of a line that the PC cannot execute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnsupportedText(pub(super) String);

/// The maximum nesting of brackets.
const DEEPEST: usize = 50;

/// The assignments of a line, in order; none if one of them is not understood.
pub(super) fn assignments(
    line: &str,
    variables: &BTreeMap<i32, f64>,
) -> Result<Vec<(i32, f64)>, UnsupportedText> {
    let text: String = without_comments(line).to_ascii_lowercase().split_whitespace().collect();
    if !text.contains('#') || !text.contains('=') {
        return Ok(Vec::new());
    }
    let mut reader = GcodeReader { rest: &text, variables, depth: 0 };
    let mut found = Vec::new();
    while !reader.rest.is_empty() {
        if !reader.take("#") {
            reader.skip_word()?;
            continue;
        }
        let variable = reader.primary()?;
        // A parameter that a word takes, such as X#5, is no assignment.
        if reader.take("=") {
            found.push((number_of(variable)?, reader.value()?));
        }
    }
    Ok(found)
}

/// The line without comments in parentheses or after a semicolon.
fn without_comments(line: &str) -> String {
    let mut depth = 0_u32;
    let line = line.split(';').next().unwrap_or_default();
    line.chars()
        .filter(|character| {
            depth += u32::from(*character == '(');
            let is_code = depth == 0;
            depth -= u32::from(*character == ')' && depth > 0);
            is_code
        })
        .collect()
}

fn unknown<T>(what: impl Into<String>) -> Result<T, UnsupportedText> {
    Err(UnsupportedText(what.into()))
}

/// The variable that a value names.
fn number_of(value: f64) -> Result<i32, UnsupportedText> {
    let number = libm::round(value);
    if (value - number).abs() > 0.0001 || !(1.0..=5400.0).contains(&number) {
        return unknown(format!("there is no variable #{value}"));
    }
    Ok(number as i32)
}

/// Operators by how close they bind, the closest last.
const OPERATORS: &[&[&str]] =
    &[&["and", "xor", "or"], &["eq", "ne", "ge", "gt", "le", "lt"], &["+", "-"], &["*", "/", "mod"], &["**"]];

/// Reads a line without spaces, in lower case.
struct GcodeReader<'a> {
    rest: &'a str,
    variables: &'a BTreeMap<i32, f64>,
    depth: usize,
}

impl<'a> GcodeReader<'a> {
    fn take(&mut self, text: &str) -> bool {
        let rest = self.rest.strip_prefix(text);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// A word of G code: a letter and its value.
    fn skip_word(&mut self) -> Result<(), UnsupportedText> {
        let letter = self.rest.chars().next().unwrap_or_default();
        self.rest = self.rest.get(letter.len_utf8()..).unwrap_or_default();
        if letter.is_ascii_alphabetic() && !self.rest.is_empty() { self.value().map(drop) } else { Ok(()) }
    }

    /// A value as a word or an assignment has it: no operator outside brackets.
    fn value(&mut self) -> Result<f64, UnsupportedText> {
        if self.take("-") {
            return Ok(-self.value()?);
        }
        if self.take("+") {
            return self.value();
        }
        self.primary()
    }

    fn primary(&mut self) -> Result<f64, UnsupportedText> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return unknown("too many brackets");
        }
        let value = if self.take("#") {
            let variable = number_of(self.primary()?)?;
            self.variables.get(&variable).copied().unwrap_or(0.0)
        } else if self.take("[") {
            self.bracket()?
        } else if self.rest.starts_with(|first: char| first.is_ascii_alphabetic()) {
            self.function()?
        } else {
            self.number()?
        };
        self.depth -= 1;
        Ok(value)
    }

    /// Reads the expression in a bracket, with its end.
    fn bracket(&mut self) -> Result<f64, UnsupportedText> {
        let value = self.operation(0)?;
        if self.take("]") { Ok(value) } else { unknown("a bracket is not closed") }
    }

    fn operation(&mut self, level: usize) -> Result<f64, UnsupportedText> {
        let Some(operators) = OPERATORS.get(level) else { return self.signed() };
        let mut left = self.operation(level + 1)?;
        loop {
            // `**` is not a `*`.
            let is_power = self.rest.starts_with("**");
            let found =
                operators.iter().find(|sign| self.rest.starts_with(**sign) && (**sign == "**" || !is_power));
            let Some(sign) = found else { return Ok(left) };
            self.take(sign);
            let right = self.operation(level + 1)?;
            left = operate(sign, left, right)?;
        }
    }

    fn signed(&mut self) -> Result<f64, UnsupportedText> {
        if self.take("-") {
            Ok(-self.signed()?)
        } else if self.take("+") {
            self.signed()
        } else {
            self.primary()
        }
    }

    fn number(&mut self) -> Result<f64, UnsupportedText> {
        let end = self
            .rest
            .char_indices()
            .find(|(index, c)| !(c.is_ascii_digit() || *c == '.' || (*index == 0 && matches!(c, '-' | '+'))));
        let (number, rest) = self.rest.split_at(end.map_or(self.rest.len(), |(index, _)| index));
        match number.parse() {
            Ok(value) => {
                self.rest = rest;
                Ok(value)
            }
            Err(_) if self.rest.is_empty() => unknown("a value is missing"),
            Err(_) => unknown(format!("`{}` is not a value", self.rest)),
        }
    }

    fn function(&mut self) -> Result<f64, UnsupportedText> {
        let end =
            self.rest.find(|character: char| !character.is_ascii_alphabetic()).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        if !self.take("[") {
            return unknown(format!("`{name}` is not a value"));
        }
        let value = self.bracket()?;
        let degrees = 180.0 / std::f64::consts::PI;
        let result = match name {
            "abs" => value.abs(),
            "acos" => libm::acos(value) * degrees,
            "asin" => libm::asin(value) * degrees,
            "atan" => {
                if !self.take("/") || !self.take("[") {
                    return unknown("`atan[…]` needs `/[…]`");
                }
                libm::atan2(value, self.bracket()?) * degrees
            }
            "cos" => libm::cos(value / degrees),
            "exp" => libm::exp(value),
            "fix" => libm::floor(value),
            "fup" => libm::ceil(value),
            "ln" => libm::log(value),
            "round" => libm::round(value),
            "sin" => libm::sin(value / degrees),
            "sqrt" => libm::sqrt(value),
            "tan" => libm::tan(value / degrees),
            _ => return unknown(format!("there is no function `{name}`")),
        };
        if result.is_finite() { Ok(result) } else { unknown(format!("`{name}[{value}]` has no value")) }
    }
}

fn operate(sign: &str, left: f64, right: f64) -> Result<f64, UnsupportedText> {
    let truth = |is_so: bool| f64::from(u8::from(is_so));
    let result = match sign {
        "**" => libm::pow(left, right),
        "*" => left * right,
        "/" if right == 0.0 => return unknown("a division by 0"),
        "/" => left / right,
        "mod" if right == 0.0 => return unknown("a division by 0"),
        // The remainder is never negative.
        "mod" => {
            let rest = libm::fmod(left, right);
            if rest < 0.0 { rest + right.abs() } else { rest }
        }
        "+" => left + right,
        "-" => left - right,
        "eq" => truth(left == right),
        "ne" => truth(left != right),
        "ge" => truth(left >= right),
        "gt" => truth(left > right),
        "le" => truth(left <= right),
        "lt" => truth(left < right),
        "and" => truth(left != 0.0 && right != 0.0),
        "or" => truth(left != 0.0 || right != 0.0),
        _ => truth((left != 0.0) != (right != 0.0)),
    };
    if result.is_finite() { Ok(result) } else { unknown(format!("`{left} {sign} {right}` has no value")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> Result<Vec<(i32, f64)>, String> {
        let variables = BTreeMap::from([(5, 2.5), (6, 7.0), (7, 5.0)]);
        assignments(line, &variables).map_err(|UnsupportedText(text)| text)
    }

    #[test]
    fn expressions_evaluate_as_in_the_interpreter() {
        for (line, expect) in [
            ("#100 = 5", 5.0),
            ("#100=[#5+1]", 3.5),
            ("#100 = [#6 - #5 * 2]", 2.0),
            ("#100 = -#5", -2.5),
            ("#100 = ##7", 2.5),
            ("#100 = #[3+2]", 2.5),
            ("#100 = [2 ** 3 ** 2]", 64.0),
            ("#100 = [-7 MOD 3]", 2.0),
            ("#100 = [2 + 3 * 4 GT 13]", 1.0),
            ("#100 = [1 AND 0 OR 1]", 1.0),
            ("#100 = ROUND[2.5]", 3.0),
            ("#100 = FIX[-2.5]", -3.0),
            ("#100 = FUP[-2.5]", -2.0),
            ("#100 = SQRT[ABS[-16]]", 4.0),
            ("#100 = ATAN[1]/[-1]", 135.0),
            ("G1 X[#5*2] (note #9=1) #100 = 3 F5", 3.0),
        ] {
            assert_eq!(found(line), Ok(vec![(100, expect)]), "{line}");
        }
        assert!((found("#100 = SIN[30]").expect("a value")[0].1 - 0.5).abs() < 1e-12);
        // All values are computed first.
        assert_eq!(found("#5 = 1 #6 = #5"), Ok(vec![(5, 1.0), (6, 2.5)]));
        assert_eq!(found("G28 Z0"), Ok(Vec::new()));
    }

    #[test]
    fn invalid_expressions_change_nothing() {
        for (line, expect) in [
            ("#100 = 5 #101 = [1 + ", "a value is missing"),
            ("#100 = [1 + 2", "a bracket is not closed"),
            ("#100 = TWICE[2]", "there is no function `twice`"),
            ("#100 = [1 / 0]", "a division by 0"),
            ("#100 = SQRT[-1]", "`sqrt[-1]` has no value"),
            ("#0 = 1", "there is no variable #0"),
            ("#100 = x", "`x` is not a value"),
        ] {
            assert_eq!(found(line), Err(expect.to_owned()), "{line}");
        }
    }
}
