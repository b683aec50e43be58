//! The fields of an axis by their names in C.

use cc67_host::{HostError, Session, Target};
use kmotiondef::ctype::CType;
use kmotiondef::structs::{Chan, StructureField};
use kmotiondef::variables::chan;
use kmotiondef::{AxisId, GuestAddr};

/// The value of a field of an axis; `None` for another name, or a field that is not one number.
///
/// # Errors
/// The target does not tell it.
pub(crate) fn field<T: Target>(
    session: &Session<T>,
    axis: usize,
    name: &str,
) -> Result<Option<f64>, HostError> {
    let target = session.target();
    let axis = i32::try_from(axis).ok().and_then(|axis| target.axes().get(axis));
    let (Some(field), Some(axis)) = (number(name), axis) else { return Ok(None) };
    let address = target.place_of(chan(axis).address().offset(field.offset));
    let mut bytes = [0; 8];
    target.read(address, &mut bytes[..field.size as usize])?;
    let [first, second, third, fourth, ..] = bytes;
    let (half, word) = ([first, second], [first, second, third, fourth]);
    Ok(Some(match field.ty {
        CType::Double => f64::from_le_bytes(bytes),
        CType::Float => f32::from_le_bytes(word).into(),
        CType::Short => i16::from_le_bytes(half).into(),
        CType::UnsignedShort => u16::from_le_bytes(half).into(),
        CType::Char | CType::SignedChar => first.cast_signed().into(),
        CType::UnsignedChar => first.into(),
        CType::UnsignedInt | CType::UnsignedLong => u32::from_le_bytes(word).into(),
        CType::Void | CType::Int | CType::Long | CType::Named(_) => i32::from_le_bytes(word).into(),
        _ => return Ok(None),
    }))
}

/// The address of a field of an axis, and the bytes of a value in it; `None` for another name.
///
/// # Errors
/// The value does not fit in its type.
pub(crate) fn stored(axis: usize, name: &str, value: f64) -> Option<Result<(GuestAddr, Vec<u8>), String>> {
    let axis = AxisId::new(i32::try_from(axis).ok()?)?;
    let field = number(name)?;
    let address = chan(axis).address().offset(field.offset);
    let whole = value.trunc();
    let (limits, bytes) = match field.ty {
        CType::Double => return Some(Ok((address, value.to_le_bytes().into()))),
        CType::Float => return Some(Ok((address, (value as f32).to_le_bytes().into()))),
        CType::Short => (i16::MIN.into()..=i16::MAX.into(), (whole as i16).to_le_bytes().to_vec()),
        CType::UnsignedShort => (0.0..=u16::MAX.into(), (whole as u16).to_le_bytes().to_vec()),
        CType::Char | CType::SignedChar => {
            (i8::MIN.into()..=i8::MAX.into(), (whole as i8).to_le_bytes().to_vec())
        }
        CType::UnsignedChar => (0.0..=u8::MAX.into(), (whole as u8).to_le_bytes().to_vec()),
        CType::UnsignedInt | CType::UnsignedLong => {
            (0.0..=u32::MAX.into(), (whole as u32).to_le_bytes().to_vec())
        }
        _ => (i32::MIN.into()..=i32::MAX.into(), (whole as i32).to_le_bytes().to_vec()),
    };
    Some(match limits.contains(&whole) {
        true => Ok((address, bytes)),
        false => Err(format!("{value} does not fit in `{name}`: {} to {}", limits.start(), limits.end())),
    })
}

/// The field of that name, if it is a number.
fn number(name: &str) -> Option<&'static StructureField> {
    Chan::STRUCTURE.fields.iter().find(|field| field.name == name && size(field.ty) == Some(field.size))
}

/// The bytes of a type that is a number.
const fn size(ty: CType) -> Option<u32> {
    match ty {
        CType::Double => Some(8),
        CType::Float | CType::Int | CType::UnsignedInt | CType::Long | CType::UnsignedLong => Some(4),
        CType::Short | CType::UnsignedShort => Some(2),
        CType::Char | CType::SignedChar | CType::UnsignedChar => Some(1),
        _ => None,
    }
}

/// A field of an axis that is a number.
pub(crate) struct AxisField {
    /// The name in C.
    pub(crate) name: &'static str,
    /// The meaning.
    pub(crate) doc: &'static str,
    /// True if it is an integer.
    pub(crate) is_integer: bool,
}

/// All fields of an axis that are numbers.
pub(crate) fn fields() -> impl Iterator<Item = AxisField> {
    let fields = Chan::STRUCTURE.fields.iter().filter(|field| number(field.name).is_some());
    fields.map(|field| AxisField {
        name: field.name,
        doc: field.doc,
        is_integer: !matches!(field.ty, CType::Double | CType::Float),
    })
}
