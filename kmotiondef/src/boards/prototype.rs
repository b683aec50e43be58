//! C declarations of the files of facts as types.

use crate::ctype::CType;
use crate::firmware::FirmwareFunction;

/// The type of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionType {
    /// The type of its result.
    pub result: CType,
    /// The types of its parameters.
    pub params: Vec<CType>,
    /// True if more arguments may follow.
    pub is_variadic: bool,
}

impl FunctionType {
    /// Returns the type of a row of the table.
    #[must_use]
    pub fn of_row(row: &FirmwareFunction) -> Self {
        let params = row.params.iter().map(|param| param.ty).collect();
        Self { result: row.result, params, is_variadic: row.is_variadic }
    }

    /// Parses the type of a prototype; `None` if it contains a type that is not in [`CType`].
    pub(super) fn parse(prototype: &'static str) -> Option<Self> {
        let (head, params) = prototype.split_once('(')?;
        let params = params.strip_suffix(')')?;
        let is_variadic = params.ends_with("...");
        let params = params.split(',').map(str::trim).filter(|param| !matches!(*param, "..." | "void" | ""));
        Some(Self {
            result: of_declaration(head)?,
            params: params.map(of_declaration).collect::<Option<_>>()?,
            is_variadic,
        })
    }
}

/// The declared name: the last word before parameters or dimensions.
pub(super) fn name(declaration: &'static str) -> &'static str {
    let head = declaration.split(['(', '[']).next().unwrap_or_default();
    head.rsplit(|c: char| c != '_' && !c.is_ascii_alphanumeric()).next().unwrap_or_default()
}

/// The type in a declaration such as `const char *text`, without arrays and functions.
fn of_declaration(declaration: &'static str) -> Option<CType> {
    let stars = declaration.matches('*').count();
    let head = declaration.split('*').next()?.trim();
    let mut words: Vec<&'static str> = head.split_whitespace().collect();
    if stars == 0 {
        // The last word is the name.
        words.pop().filter(|_| !words.is_empty())?;
    }
    let is = |qualifier: &str| words.contains(&qualifier);
    let (is_const, is_volatile) = (is("const"), is("volatile"));
    words.retain(|word| !matches!(*word, "const" | "volatile"));
    let mut ty = match words.join(" ").as_str() {
        "void" => CType::Void,
        "char" => CType::Char,
        "signed char" => CType::SignedChar,
        "unsigned char" => CType::UnsignedChar,
        "short" | "short int" => CType::Short,
        "unsigned short" | "unsigned short int" => CType::UnsignedShort,
        "int" => CType::Int,
        "unsigned" | "unsigned int" => CType::UnsignedInt,
        "long" => CType::Long,
        "unsigned long" => CType::UnsignedLong,
        "float" => CType::Float,
        "double" => CType::Double,
        _ => match words.as_slice() {
            [name] => CType::Named(name),
            _ => return None,
        },
    };
    if is_volatile {
        ty = CType::Volatile(Box::leak(Box::new(ty)));
    }
    if is_const {
        ty = CType::Const(Box::leak(Box::new(ty)));
    }
    // The types in the tables are constants; the types of the few boards that are read are never freed.
    Some((0..stars).fold(ty, |ty, _| CType::Pointer(Box::leak(Box::new(ty)))))
}
