//! The text of values, as gdb writes it.

use kmotiondef::GuestAddr;

use super::value::{DebugValue, DisplayContext};
use crate::ast::RecordKind;
use crate::sema::constants::Constant;
use crate::ty::{QualifiedType, RecordId, Type, TypeId};
use crate::watch;

/// Most elements of an array, and most characters of a string, that are shown.
const ELEMENTS: u32 = 200;

/// More equal elements or characters in a row are shown as one, with their number.
const REPEATS: usize = 10;

/// The depth to which structures are shown.
const DEPTH: u32 = 20;

/// The number of digits of a `double` and of a `float` that distinguish it from every other.
const DOUBLE_DIGITS: usize = 17;
const FLOAT_DIGITS: usize = 9;

/// The form of numbers, as in `print/x`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    /// `x`: hexadecimal.
    Hexadecimal,
    /// `z`: hexadecimal with leading zeros.
    Padded,
    /// `d`: decimal with a sign.
    Decimal,
    /// `u`: decimal without a sign.
    Unsigned,
    /// `o`: octal.
    Octal,
    /// `t`: binary.
    Binary,
    /// `a`: an address, with the name of what is there.
    Address,
    /// `c`: a character.
    Character,
    /// `f`: a floating-point number.
    Float,
    /// `s`: as without a format.
    Plain,
}

impl NumberFormat {
    /// The format of a letter.
    #[must_use]
    pub const fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'x' => Self::Hexadecimal,
            'z' => Self::Padded,
            'd' => Self::Decimal,
            'u' => Self::Unsigned,
            'o' => Self::Octal,
            't' => Self::Binary,
            'a' => Self::Address,
            'c' => Self::Character,
            'f' => Self::Float,
            's' => Self::Plain,
            _ => return None,
        })
    }

    /// The text of an integer with a size in bytes; `symbol` names the object at an address.
    #[must_use]
    pub fn text(self, bits: u64, size: u32, symbol: &dyn Fn(GuestAddr) -> Option<String>) -> String {
        let width = size.clamp(1, 8) * 8;
        let bits = bits << (64 - width) >> (64 - width);
        let signed = bits.cast_signed() << (64 - width) >> (64 - width);
        match self {
            Self::Hexadecimal => format!("{bits:#x}"),
            Self::Padded => format!("{bits:#0digits$x}", digits = width as usize / 4 + 2),
            Self::Decimal | Self::Plain => signed.to_string(),
            Self::Unsigned => bits.to_string(),
            Self::Octal if bits == 0 => "0".to_owned(),
            Self::Octal => format!("0{bits:o}"),
            Self::Binary => format!("{bits:b}"),
            Self::Address => {
                let name = symbol(GuestAddr::new(bits as u32));
                format!("{bits:#x}{}", name.map_or_else(String::new, |name| format!(" <{name}>")))
            }
            Self::Character => character(i64::from(bits as i8), bits as u8),
            Self::Float if width == 64 => format_general(f64::from_bits(bits), DOUBLE_DIGITS),
            Self::Float if width == 32 => float(f32::from_bits(bits as u32)),
            Self::Float => signed.to_string(),
        }
    }
}

impl DisplayContext<'_> {
    /// The value in one line.
    #[must_use]
    pub fn text(&self, value: &DebugValue) -> String {
        self.text_at(value, None, 0)
    }

    /// The value in one line, its numbers in a format.
    #[must_use]
    pub fn text_in(&self, value: &DebugValue, format: Option<NumberFormat>) -> String {
        self.text_at(value, format.filter(|format| *format != NumberFormat::Plain), 0)
    }

    /// The type shown before a top-level pointer.
    #[must_use]
    pub fn cast(&self, value: &DebugValue) -> String {
        match self.types.get(value.ty) {
            Type::Pointer(to) if !self.is_character(to.ty) => format!("({}) ", self.type_of(value)),
            _ => String::new(),
        }
    }

    /// The declaration of an object with the type of a value, in C syntax, without spaces around `inner`.
    #[must_use]
    pub fn declared(&self, value: &DebugValue, inner: &str) -> String {
        self.types.spell_declaration(self.names, value.ty, inner)
    }

    /// The C expression for the present value; `None` for a value that C cannot express.
    #[must_use]
    pub fn literal(&self, value: &DebugValue) -> Option<String> {
        let ty = self.type_of(value);
        if let Some(address) = value.address().filter(|_| self.constant(value).is_none()) {
            let is_object = matches!(self.types.get(value.ty), Type::Array(..) | Type::Record(_));
            let pointer = self.declared(value, "(*)");
            return (is_object && !ty.contains("unnamed"))
                .then(|| format!("(*({pointer}){:#x})", address.get()));
        }
        match self.constant(value)? {
            Constant::Int(number) if matches!(self.types.get(value.ty), Type::Pointer(_)) => {
                Some(format!("(({ty}){:#x})", number as u32))
            }
            Constant::Int(number) => Some(format!("(({ty}){number})")),
            Constant::Float(number) => number.is_finite().then(|| format!("(({ty}){number:?})")),
        }
    }

    /// The type with the members of its structure, as `ptype` shows it.
    #[must_use]
    pub fn whole_type(&self, value: &DebugValue) -> String {
        let mut innermost = value.ty;
        while let Type::Pointer(inner) | Type::Array(inner, _) = self.types.get(innermost) {
            innermost = inner.ty;
        }
        let spelled = self.type_of(value);
        let Type::Record(record) = self.types.get(innermost) else { return spelled };
        let name = self.types.spell(self.names, innermost);
        spelled.replacen(&name, &self.members(*record, 0), 1)
    }

    fn members(&self, id: RecordId, indent: usize) -> String {
        let record = self.types.record(id);
        let keyword = match record.kind {
            RecordKind::Struct => "struct",
            RecordKind::Union => "union",
        };
        let tag = record.name.filter(|_| record.is_tagged);
        let head = tag.map_or_else(|| keyword.to_owned(), |tag| format!("{keyword} {}", self.names.get(tag)));
        let Some(layout) = &record.layout else { return format!("{head} {{\n    <incomplete type>\n}}") };
        let blank = " ".repeat(4 * indent);
        let lines = layout.members.iter().map(|member| {
            let name = member.name.map_or("", |name| self.names.get(name));
            let width = member.bits.map_or_else(String::new, |bits| format!(" : {}", bits.width));
            let declared = match self.types.get(member.ty.ty) {
                Type::Record(inner) if self.types.record(*inner).name.is_none() => {
                    format!("{} {name}", self.members(*inner, indent + 1))
                }
                _ => self.types.spell_declaration(self.names, member.ty.ty, name),
            };
            format!("{blank}    {declared}{width};\n")
        });
        format!("{head} {{\n{}{blank}}}", lines.collect::<String>())
    }

    fn is_character(&self, ty: TypeId) -> bool {
        matches!(self.types.get(ty), Type::Char | Type::SignedChar | Type::UnsignedChar)
    }

    fn text_at(&self, value: &DebugValue, format: Option<NumberFormat>, depth: u32) -> String {
        if let Some(address) = value.address().filter(|address| !self.reader.is_mapped(*address)) {
            return super::value::unreadable_text(address);
        }
        match self.types.get(value.ty) {
            Type::Void => "void".to_owned(),
            Type::Function(_) => {
                let address = value.address().map_or(0, GuestAddr::get);
                format!("{{{}}} {address:#x}{}", self.type_of(value), self.symbol(address))
            }
            Type::Array(element, length) => self.array(value, *element, length.unwrap_or(0), format, depth),
            Type::Record(_) if depth == DEPTH => "{...}".to_owned(),
            Type::Record(_) => {
                let children = self.children(value, "", 0, u32::MAX);
                let parts: Vec<_> = (children.iter())
                    .map(|child| {
                        let text = self.text_at(&child.value, format, depth + 1);
                        if child.name.is_empty() { text } else { format!("{} = {text}", child.name) }
                    })
                    .collect();
                format!("{{{}}}", parts.join(", "))
            }
            Type::Pointer(to) if format.is_none() => self.pointer(value, to.ty),
            ty => self.scalar(ty, value, format),
        }
    }

    fn symbol(&self, address: u32) -> String {
        let name = self.reader.symbol(GuestAddr::new(address));
        name.map_or_else(String::new, |name| format!(" <{name}>"))
    }

    fn array(
        &self,
        value: &DebugValue,
        element: QualifiedType,
        length: u32,
        format: Option<NumberFormat>,
        depth: u32,
    ) -> String {
        if let Some(address) = value.address()
            && self.is_character(element.ty)
            && format.is_none()
        {
            return self.characters(address, length);
        }
        if depth == DEPTH {
            return "{...}".to_owned();
        }
        let text = |index: u32| {
            let element = self.element(value, element, index);
            element.map(|element| self.text_at(&element, format, depth + 1))
        };
        let (mut parts, mut shown, mut index) = (Vec::new(), 0, 0);
        while index < length && shown < ELEMENTS {
            let Some(first) = text(index) else { break };
            let count =
                1 + (index + 1..length).take_while(|next| text(*next).as_ref() == Some(&first)).count();
            if count > REPEATS {
                parts.push(format!("{first} <repeats {count} times>"));
                index += count as u32;
                shown += REPEATS as u32;
            } else {
                parts.push(first);
                index += 1;
                shown += 1;
            }
        }
        format!("{{{}{}}}", parts.join(", "), if index < length { "..." } else { "" })
    }

    fn pointer(&self, value: &DebugValue, to: TypeId) -> String {
        let Some(Constant::Int(address)) = self.constant(value) else { return "?".to_owned() };
        let address = address as u32;
        let text = format!("{address:#x}{}", self.symbol(address));
        if !self.is_character(to) || address == 0 {
            return text;
        }
        let address = GuestAddr::new(address);
        if !self.reader.is_mapped(address) {
            return format!("{text} {}", super::value::unreadable_text(address));
        }
        let byte = |offset: u32| self.reader.bytes(address.offset(offset))[0];
        let length = (0..ELEMENTS).take_while(|offset| byte(*offset) != 0).count() as u32;
        let bytes: Vec<u8> = (0..length).map(byte).collect();
        format!("{text} {}{}", string(&bytes), if length == ELEMENTS { "..." } else { "" })
    }

    /// An array of characters; a terminating 0 at its end is not shown.
    fn characters(&self, address: GuestAddr, length: u32) -> String {
        let byte = |offset: u32| self.reader.bytes(address.offset(offset))[0];
        let mut bytes: Vec<u8> = (0..length.min(ELEMENTS)).map(byte).collect();
        if length > ELEMENTS {
            return string(&bytes) + "...";
        }
        if bytes.last() == Some(&0) {
            bytes.pop();
        }
        string(&bytes)
    }

    fn scalar(&self, ty: &Type, value: &DebugValue, format: Option<NumberFormat>) -> String {
        let Some(constant) = self.constant(value) else { return "?".to_owned() };
        if let Some(format) = format {
            let size = watch::size_of(value.ty) as u32;
            let bits = match constant {
                Constant::Int(number) => number.cast_unsigned(),
                Constant::Float(number) if size == 4 => (number as f32).to_bits().into(),
                Constant::Float(number) => number.to_bits(),
            };
            return format.text(bits, size, &|address| self.reader.symbol(address));
        }
        match (constant, ty) {
            (Constant::Int(number), Type::Char | Type::SignedChar | Type::UnsignedChar) => {
                character(number, number as u8)
            }
            (Constant::Int(number), Type::Bool) => (number != 0).to_string(),
            (Constant::Int(number), Type::UnsignedLongLong) => number.cast_unsigned().to_string(),
            (Constant::Int(number), _) => number.to_string(),
            (Constant::Float(number), Type::Float) => float(number as f32),
            (Constant::Float(number), _) => format_general(number, DOUBLE_DIGITS),
        }
    }
}

/// A character with its number.
fn character(number: i64, byte: u8) -> String {
    format!("{number} '{}'", escape(byte, b'\''))
}

/// A character in quotation marks of a kind.
fn escape(byte: u8, quote: u8) -> String {
    match byte {
        7 => "\\a".to_owned(),
        8 => "\\b".to_owned(),
        b'\t' => "\\t".to_owned(),
        b'\n' => "\\n".to_owned(),
        11 => "\\v".to_owned(),
        12 => "\\f".to_owned(),
        b'\r' => "\\r".to_owned(),
        _ if byte == quote || byte == b'\\' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\{byte:03o}"),
    }
}

/// A string, in which more than some equal characters in a row are one with their number.
fn string(bytes: &[u8]) -> String {
    let (mut parts, mut run): (Vec<String>, String) = (Vec::new(), String::new());
    let mut rest = bytes;
    while let Some(&first) = rest.first() {
        let count = rest.iter().take_while(|byte| **byte == first).count();
        let shown = if count > REPEATS { count } else { 1 };
        rest = &rest[shown..];
        if shown > 1 {
            if !run.is_empty() {
                parts.push(format!("\"{}\"", std::mem::take(&mut run)));
            }
            parts.push(format!("'{}' <repeats {count} times>", escape(first, b'\'')));
        } else {
            run += &escape(first, b'"');
        }
    }
    if !run.is_empty() || parts.is_empty() {
        parts.push(format!("\"{run}\""));
    }
    parts.join(", ")
}

fn float(number: f32) -> String {
    if number.is_nan() {
        let sign = if number.is_sign_negative() { "-" } else { "" };
        return format!("{sign}nan({:#x})", number.to_bits() & 0x7f_ffff);
    }
    format_general(number.into(), FLOAT_DIGITS)
}

/// A number as C's `%g` prints it with a number of digits.
fn format_general(number: f64, digits: usize) -> String {
    if number.is_nan() {
        let sign = if number.is_sign_negative() { "-" } else { "" };
        return format!("{sign}nan({:#x})", number.to_bits() & 0xf_ffff_ffff_ffff);
    }
    if number.is_infinite() {
        return number.to_string();
    }
    let scientific = format!("{number:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if exponent < -4 || exponent >= digits as i32 {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{}e{sign}{:02}", trimmed(mantissa), exponent.abs());
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    trimmed(&format!("{number:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_with_the_digits_that_tell_them_apart() {
        for (number, expect) in [
            (0.1, "0.10000000000000001"),
            (2.5, "2.5"),
            (1e20, "1e+20"),
            (1e300, "1.0000000000000001e+300"),
            (100_000.0, "100000"),
            (1_234_567.891, "1234567.8910000001"),
            (-0.0, "-0"),
            (0.00001, "1.0000000000000001e-05"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(format_general(number, DOUBLE_DIGITS), expect);
        }
        assert_eq!(float(0.1), "0.100000001");
    }

    #[test]
    fn strings_show_repeated_and_other_characters_as_gdb_does() {
        for (bytes, expect) in [
            (b"xxxxxxxxxx".as_slice(), "\"xxxxxxxxxx\""),
            (b"xxxxxxxxxxx", "'x' <repeats 11 times>"),
            (b"\x012\x1b\0\0", "\"\\0012\\033\\000\\000\""),
            (b"a\"\n\\", "\"a\\\"\\n\\\\\""),
            (b"", "\"\""),
            (b"ab\0\0\0\0\0\0\0\0\0\0\0c", "\"ab\", '\\000' <repeats 11 times>, \"c\""),
        ] {
            assert_eq!(string(bytes), expect);
        }
    }

    #[test]
    fn formats_are_those_of_gdb() {
        let text = |format, bits: i64, size| {
            NumberFormat::from_letter(format).map(|format| format.text(bits.cast_unsigned(), size, &|_| None))
        };
        for (format, bits, size, expect) in [
            ('x', -3, 2, "0xfffd"),
            ('z', 5, 4, "0x00000005"),
            ('d', 0xffff_ffff, 4, "-1"),
            ('u', -56, 1, "200"),
            ('o', 8, 4, "010"),
            ('o', 0, 4, "0"),
            ('t', 10, 4, "1010"),
            ('c', 321, 4, "65 'A'"),
            ('f', 3, 4, "4.20389539e-45"),
            ('a', 18, 4, "0x12"),
        ] {
            assert_eq!(text(format, bits, size).as_deref(), Some(expect), "{format}");
        }
        assert_eq!(text('q', 1, 4), None);
    }
}
