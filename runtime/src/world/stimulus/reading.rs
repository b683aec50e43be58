//! Other readings of an element of `persist.UserData`: an integer, a `float`, or half of a `double`.
//!
//! An expectation compares the element in the form of its number. If it is not met, but would be in another form, the
//! number was probably written in the wrong one.

use kmotiondef::limits::N_USER_DATA_VARS;

use super::expectation::{Expectation, Predicate, Sense, Subject, UserDataFormat};
use super::relation::Relation;

/// Every form, with the prefix of its numbers in a statement and its name.
const FORMS: [(UserDataFormat, &str, &str); 3] = [
    (UserDataFormat::Whole, "", "integer"),
    (UserDataFormat::Single, "f:", "float"),
    (UserDataFormat::Double, "d:", "double"),
];

/// The hint after the message of an expectation that would be met in another form of its element.
pub(super) fn hint(expectation: &Expectation, value: impl Fn(&Subject) -> Option<f64>) -> Option<String> {
    let Predicate::Value { subject, relation, number, tolerance } = &expectation.predicate else {
        return None;
    };
    let (index, stored) = element(subject).filter(|_| expectation.sense == Sense::Is)?;
    let other_forms = FORMS.iter().filter(|(form, ..)| *form != stored && fits(*form, index, *relation));
    other_forms.into_iter().find_map(|(form, prefix, name)| {
        let value = value(&Subject::Persist(index, *form))?;
        let is_met = is_likely(*form, value) && relation.holds(value, *number, *tolerance);
        let statement = format!("persist {index} {} {prefix}{number}", relation.sign());
        is_met.then(|| format!(": it holds the {name} {value}, so write `{statement}`"))
    })
}

/// The element that a value is, and its form.
fn element(subject: &Subject) -> Option<(usize, UserDataFormat)> {
    match subject {
        Subject::Persist(index, stored) => Some((*index, *stored)),
        Subject::Item(item, _) if item.kind() == "persist" => Some((item.index(), UserDataFormat::Whole)),
        Subject::Item(..) | Subject::Expression(_) => None,
    }
}

/// Returns whether an element can have this form; two elements are a `double` by accident if only its size counts.
fn fits(form: UserDataFormat, index: usize, relation: Relation) -> bool {
    form != UserDataFormat::Double || (relation == Relation::Equal && index + 2 <= N_USER_DATA_VARS)
}

/// Returns whether a program has probably stored this value in this form.
fn is_likely(form: UserDataFormat, value: f64) -> bool {
    /// From here on an integer is also the bits of a `float` that is not denormal.
    const FIRST_FLOAT: f64 = 8_388_608.0;
    match form {
        UserDataFormat::Whole => value.abs() < FIRST_FLOAT,
        UserDataFormat::Single | UserDataFormat::Double => (1e-6..=1e9).contains(&value.abs()),
    }
}
