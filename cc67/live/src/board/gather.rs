//! A part of the gather buffer, for a plot.

use cc67_host::{Session, Target};
use kmotiondef::GuestAddr;
use kmotiondef::variables::GATHER_BUFFER;
use serde_json::{Value, json};

/// The maximum number of values at a time.
const NUMBERS: u32 = 10_000;

/// The type of the buffer's numbers.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Double,
    Float,
    Int,
}

/// The values of a kind, beginning with a given one, as a message; NaN and infinity are `null`.
pub(super) fn numbers<T: Target>(
    session: &Session<T>,
    from: u32,
    count: u32,
    kind: &str,
) -> Result<Value, String> {
    let (kind_of, bytes) = match kind {
        "double" => (Kind::Double, 8),
        "float" => (Kind::Float, 4),
        "int" => (Kind::Int, 4),
        _ => return Err(format!("`{kind}` is not double, float or int")),
    };
    let first = GuestAddr::new(session.peek_object(GATHER_BUFFER.address()));
    let number = |index: u32| {
        let place = first.offset(from.wrapping_add(index).wrapping_mul(bytes));
        match kind_of {
            Kind::Double => f64::from_bits(session.peek(place)),
            Kind::Float => f64::from(f32::from_bits(session.peek(place))),
            Kind::Int => f64::from(session.peek::<u32>(place).cast_signed()),
        }
    };
    let values: Vec<f64> = (0..count.min(NUMBERS)).map(number).collect();
    Ok(json!({ "kind": "gather", "from": from, "type": kind, "values": values }))
}
