//! C spelling of types, for messages.

use super::{FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types};
use crate::ast::RecordKind;
use crate::names::Names;

impl Types {
    /// A type as C spells it without a name: `int *`, `double (*)[3]`.
    #[must_use]
    pub fn spell(&self, names: &Names, ty: TypeId) -> String {
        self.declare(names, QualifiedType::plain(ty), String::new())
    }

    /// A declaration of `name` as C spells it: `int ReadBit(int)`.
    #[must_use]
    pub fn spell_declaration(&self, names: &Names, ty: TypeId, name: &str) -> String {
        self.declare(names, QualifiedType::plain(ty), name.to_owned())
    }

    /// Wraps the type around `inner`, from the name outwards.
    fn declare(&self, names: &Names, ty: QualifiedType, inner: String) -> String {
        match self.get(ty.ty) {
            Type::Pointer(to) => {
                let words = qualifiers(ty);
                let blank = if words.is_empty() || inner.is_empty() { "" } else { " " };
                let pointer = format!("*{words}{blank}{inner}");
                let is_derived = matches!(self.get(to.ty), Type::Array(..) | Type::Function(_));
                self.declare(names, *to, if is_derived { format!("({pointer})") } else { pointer })
            }
            Type::Array(element, length) => {
                let length = length.map_or_else(String::new, |length| length.to_string());
                self.declare(names, *element, format!("{inner}[{length}]"))
            }
            Type::Function(function) => {
                let parameters = self.parameters(names, function);
                self.declare(names, QualifiedType::plain(function.result), format!("{inner}({parameters})"))
            }
            _ => {
                let words = qualifiers(ty);
                let blank = if words.is_empty() { "" } else { " " };
                let word = self.word(names, ty.ty);
                let gap = if inner.is_empty() || inner.starts_with('[') { "" } else { " " };
                format!("{words}{blank}{word}{gap}{inner}")
            }
        }
    }

    fn parameters(&self, names: &Names, function: &FunctionType) -> String {
        match &function.parameters {
            ParameterTypes::Unspecified => String::new(),
            ParameterTypes::Prototype { types, is_variadic: false } if types.is_empty() => "void".to_owned(),
            ParameterTypes::Prototype { types, is_variadic } => {
                let mut spelled: Vec<_> =
                    types.iter().map(|ty| self.declare(names, *ty, String::new())).collect();
                if *is_variadic {
                    spelled.push("...".to_owned());
                }
                spelled.join(", ")
            }
        }
    }

    /// The words of a type that is not derived from another.
    fn word(&self, names: &Names, ty: TypeId) -> String {
        let word = match self.get(ty) {
            Type::Void | Type::Pointer(_) | Type::Array(..) | Type::Function(_) => "void",
            Type::Bool => "_Bool",
            Type::Char => "char",
            Type::SignedChar => "signed char",
            Type::UnsignedChar => "unsigned char",
            Type::Short => "short",
            Type::UnsignedShort => "unsigned short",
            Type::Int => "int",
            Type::Unsigned => "unsigned int",
            Type::LongLong => "long long",
            Type::UnsignedLongLong => "unsigned long long",
            Type::Float => "float",
            Type::Double => "double",
            Type::Record(record) => {
                let record = self.record(*record);
                let keyword = match record.kind {
                    RecordKind::Struct => "struct",
                    RecordKind::Union => "union",
                };
                return match record.name {
                    Some(name) if record.is_tagged => format!("{keyword} {}", names.get(name)),
                    Some(name) => names.get(name).to_owned(),
                    None => format!("unnamed {keyword}"),
                };
            }
        };
        word.to_owned()
    }
}

/// The qualifiers as words with blanks between them.
fn qualifiers(ty: QualifiedType) -> &'static str {
    match (ty.is_const, ty.is_volatile) {
        (false, false) => "",
        (true, false) => "const",
        (false, true) => "volatile",
        (true, true) => "const volatile",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_read_as_c() {
        let mut types = Types::new();
        let names = Names::new();
        let plain = QualifiedType::plain;
        let array = types.intern(Type::Array(plain(Types::DOUBLE), Some(3)));
        let to_array = types.pointer_to(array);
        let constant = QualifiedType { ty: Types::CHAR, is_const: true, is_volatile: false };
        let text = types.intern(Type::Pointer(constant));
        let parameters =
            ParameterTypes::Prototype { types: vec![plain(text), plain(to_array)], is_variadic: true };
        let function = types.intern(Type::Function(FunctionType { result: text, parameters }));
        let to_function = types.pointer_to(function);
        let table = types.intern(Type::Array(plain(to_function), Some(2)));
        let check = |ty, expect: &str| assert_eq!(types.spell(&names, ty), expect);
        check(array, "double[3]");
        check(to_array, "double (*)[3]");
        check(text, "const char *");
        check(to_function, "const char *(*)(const char *, double (*)[3], ...)");
        check(table, "const char *(*[2])(const char *, double (*)[3], ...)");
        assert_eq!(
            types.spell_declaration(&names, function, "f"),
            "const char *f(const char *, double (*)[3], ...)"
        );
    }
}
