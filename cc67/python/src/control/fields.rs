//! The fields of an axis by their names in C.

use cc67_host::{Session, Target};
use kmotiondef::ctype::CType;
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::structs::{Chan, StructureField};
use kmotiondef::variables::CHAN;

/// The value of a field of an axis; `None` for another name, or a field that is not one number.
pub(crate) fn field<T: Target>(session: &Session<T>, axis: usize, name: &str) -> Option<f64> {
    if axis >= N_CHANNELS {
        return None;
    }
    let field = number(name)?;
    let address = CHAN.element(axis).address().offset(field.offset);
    Some(match field.ty {
        CType::Double => session.peek::<f64>(address),
        CType::Float => session.peek::<f32>(address).into(),
        CType::Short => session.peek::<i16>(address).into(),
        CType::UnsignedShort => session.peek::<u16>(address).into(),
        CType::Char | CType::SignedChar => session.peek::<i8>(address).into(),
        CType::UnsignedChar => session.peek::<u8>(address).into(),
        CType::UnsignedInt | CType::UnsignedLong => session.peek::<u32>(address).into(),
        CType::Void | CType::Int | CType::Long | CType::Named(_) => session.peek::<i32>(address).into(),
        _ => return None,
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

/// The names of all fields that are numbers, with what each means.
pub(crate) fn field_names() -> Vec<(&'static str, &'static str)> {
    let fields = Chan::STRUCTURE.fields.iter().filter(|field| number(field.name).is_some());
    fields.map(|field| (field.name, field.doc)).collect()
}
