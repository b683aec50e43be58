//! `--watch`: what is recorded, from a list of items, variables and expressions.
//!
//! `axis0` stands for all that belongs to an axis, `bit46` and its kin are items of the board; everything else is C in the
//! words of the programs that are run. `2:count` is the `count` of the program in thread 2.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Result, bail};
use kmotiondef::{GuestAddr, ThreadId};
use runtime::trace::{Formula, Item, Quantity, View};

use compiler::Options;
use compiler::inspect::{Inspection, Kind};
use compiler::object::SymbolKind;
use compiler::object::kind_of;
use compiler::pp::Disk;
use compiler::watch::{self, Expression, Reader, Scope};

/// How the compiler's message on an unknown name ends if no other is near.
const NOT_DECLARED: &str = "is not declared";

/// What is known without a declaration.
const KNOWN: &str = ", nor is it an item of the board, such as axis0, bit46, persist.5, adc0";

/// Most characters of an expression.
const MOST: usize = 500;

/// A program whose variables can be watched.
#[derive(Debug)]
pub(in crate::cli) struct Watched<'a> {
    /// Its thread.
    pub(in crate::cli) thread: ThreadId,
    /// Its source, or the image itself.
    pub(in crate::cli) path: &'a Path,
    /// Whether that is an image.
    pub(in crate::cli) is_image: bool,
    /// Its image.
    pub(in crate::cli) image: &'a [u8],
}

/// What a list names.
pub(super) fn quantities(list: &str, programs: &[Watched<'_>], options: &Options) -> Result<Vec<Quantity>> {
    let mut quantities = Vec::new();
    for name in split(list) {
        if let Some(number) = name.strip_prefix("axis").filter(|number| is_number(number)) {
            for kind in ["dest", "pos", "out"] {
                quantities.push(Item::new(&format!("{kind}{number}"))?.into());
            }
            continue;
        }
        match Item::new(name) {
            Ok(item) => quantities.push(item.into()),
            // A number that is too high is not the name of a variable.
            Err(error) if Item::is_kind(name.trim_end_matches(|c: char| c.is_ascii_digit())) => {
                return Err(error.into());
            }
            Err(_) => quantities.push(formula(name, programs, options)?),
        }
    }
    Ok(quantities)
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The parts of a list; commas within brackets belong to an expression.
fn split(list: &str) -> Vec<&str> {
    let mut depth = 0_usize;
    let parts = list.split(|character| {
        match character {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        character == ',' && depth == 0
    });
    parts.map(str::trim).collect()
}

/// An expression in the words of the first program that understands it, or of the one in the thread that it names.
fn formula(text: &str, programs: &[Watched<'_>], options: &Options) -> Result<Quantity> {
    if text.is_empty() {
        bail!("`--watch` wants names between its commas, such as axis0,bit46,persist.5");
    }
    if text.len() > MOST {
        bail!("`--watch`: an expression may have {MOST} characters");
    }
    let thread = text.split_once(':').and_then(|(number, _)| number.parse().ok()).and_then(ThreadId::new);
    let expression =
        if thread.is_some() { text.split_once(':').map_or(text, |(_, rest)| rest) } else { text };
    let expression = with_user_data(expression);
    let mut first_error = None;
    for program in programs.iter().filter(|program| thread.is_none_or(|thread| thread == program.thread)) {
        match compile(&expression, program, options) {
            Ok(formula) => return Ok(Quantity::Formula(text.to_owned(), Arc::new(formula))),
            Err(error) => {
                first_error.get_or_insert(error);
            }
        }
    }
    let error = first_error.unwrap_or_else(|| "there is no program in that thread".to_owned());
    // With nothing near there is nothing else to say.
    let is_strange = error.ends_with(NOT_DECLARED);
    bail!("`--watch {text}`: {error}{}", if is_strange { KNOWN } else { "" })
}

/// `persist.5` is how `--set` calls an element.
fn with_user_data(text: &str) -> String {
    let mut parts = text.split("persist.");
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (index, rest) = part.split_at(digits);
        match index {
            "" => whole.push_str("persist."),
            _ => whole.push_str(&format!("persist.UserData[{index}]")),
        }
        whole.push_str(rest);
    }
    whole
}

/// An expression of the program, with the items that it names.
#[derive(Debug)]
struct Compiled {
    expression: Expression,
    items: Vec<Item>,
}

fn compile(text: &str, program: &Watched<'_>, options: &Options) -> Result<Compiled, String> {
    let image = coff::Image::read(program.image).map_err(|error| error.to_string())?;
    let inspection = Inspection::new(image);
    let objects = inspection.symbols.iter().filter(|entry| entry.kind == Kind::Object);
    let symbols: BTreeMap<_, _> =
        objects.map(|entry| (entry.name.clone(), GuestAddr::new(entry.address))).collect();
    let source = match program.is_image {
        true => declarations(&inspection).into_bytes(),
        false => crate::cli::run::read(program.path).map_err(|error| error.to_string())?,
    };
    let scope = Scope { path: program.path, text: &source, symbols: &symbols, options, files: &Disk };
    let first = match watch::compile(scope, text, &[]) {
        Ok(expression) => return Ok(Compiled { expression, items: Vec::new() }),
        Err(error) => error,
    };
    // A name of the program goes before that of an item; so items are tried second.
    let mut names: Vec<&str> =
        words(text).filter(|word| !symbols.contains_key(*word) && Item::new(word).is_ok()).collect();
    names.sort_unstable();
    names.dedup();
    if names.is_empty() {
        return Err(first);
    }
    let expression = watch::compile(scope, text, &names)?;
    Ok(Compiled { expression, items: names.into_iter().filter_map(|name| Item::new(name).ok()).collect() })
}

/// The variables of an image as far as it tells their types: of structures and pointers it does not.
fn declarations(inspection: &Inspection) -> String {
    let mut text = "#include \"KMotionDef.h\"\n".to_owned();
    let objects = inspection.symbols.iter().filter(|entry| entry.kind == Kind::Object);
    for entry in objects.filter(|entry| words(&entry.name).eq([entry.name.as_str()])) {
        let symbol =
            inspection.image.symbols.iter().find(|symbol| symbol.name.as_bytes() == entry.name.as_bytes());
        let (ty, size) = match symbol.map(|symbol| kind_of(symbol.ty)) {
            Some(SymbolKind::Char) => ("char", 1),
            Some(SymbolKind::Short) => ("short", 2),
            Some(SymbolKind::Float) => ("float", 4),
            Some(SymbolKind::Double) => ("double", 8),
            _ => ("int", 4),
        };
        let count = entry.size.unwrap_or(size) / size;
        let array = if count > 1 { format!("[{count}]") } else { String::new() };
        text.push_str(&format!("extern {ty} {}{array};\n", entry.name));
    }
    text
}

/// What looks like a name.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|character: char| !(character.is_ascii_alphanumeric() || character == '_'))
}

impl Formula for Compiled {
    fn value(&self, view: &View<'_>) -> f64 {
        self.expression.value(&Board { view, items: &self.items })
    }
}

/// The board as an expression reads it.
struct Board<'a> {
    view: &'a View<'a>,
    items: &'a [Item],
}

impl Reader for Board<'_> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        // What lies at the end of a region has no eight bytes.
        let byte = |offset| self.view.memory.peek::<u8>(address.offset(offset));
        std::array::from_fn(|offset| byte(offset as u32))
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |item| self.view.item(*item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_within_brackets_do_not_part_a_list() {
        assert_eq!(split("a, f(b, c) ,x[1,2]"), ["a", "f(b, c)", "x[1,2]"]);
    }

    #[test]
    fn elements_of_user_data_have_a_short_form() {
        assert_eq!(
            with_user_data("persist.5 + persist.UserData[6]"),
            "persist.UserData[5] + persist.UserData[6]"
        );
    }
}
