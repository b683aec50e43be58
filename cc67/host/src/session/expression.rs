//! Expressions with the names of the programs: C, read from the board's memory and written to it.
//!
//! `axis0` is the set of all variables of an axis, `bit46` and similar names are items of the board; everything else is
//! C with the declarations of the loaded programs. `2:count` is the `count` of the program in thread 2. Reading an
//! expression changes nothing and takes no time.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use crate::target::Target;
use compiler::Options;
use compiler::files;
use compiler::inspect::{EntryKind, Inspection};
use compiler::object::{SymbolKind, kind_of};
use compiler::pp::Disk;
use compiler::watch::{self, Expression, ItemReader, Scope};
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{AxisId, GuestAddr, ThreadId};
use runtime::trace::{Formula, Item, Quantity, RecordedCell, UnknownItem, View};

use super::{Input, Session, UserProgram};

/// The end of the compiler's message on an unknown name if no other is similar.
const NOT_DECLARED: &str = "is not declared";

/// The addition to that message: the names that need no declaration.
const KNOWN: &str = ", nor is it an item of the board, such as axis0, bit46, persist.5, adc0";

/// The maximum number of characters of an expression.
const MOST: usize = 500;

/// The reason for which something cannot be watched.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WatchError {
    /// There is no item with this number.
    #[error(transparent)]
    Item(#[from] UnknownItem),
    /// Nothing is between two commas.
    #[error("an expression is missing, such as axis0,bit46,persist.5")]
    Missing,
    /// The text exceeds the length limit.
    #[error("an expression can have at most {MOST} characters")]
    TooLong,
    /// The compiler rejects it.
    #[error("`{expression}`: {message}")]
    Wrong {
        /// The expression.
        expression: String,
        /// The message.
        message: String,
    },
    /// It has a value, but is not a place where another value can be stored.
    #[error("`{0}` is not a variable, so nothing can be stored in it")]
    NoPlace(String),
}

/// Something whose value can be read: an item of the board, or an expression with the declarations of a program.
///
/// It belongs to the programs that were loaded when it was [created](Session::watch): after another program is loaded,
/// it still reads the same addresses.
#[derive(Clone, Debug)]
pub struct Watch(WatchKind);

#[derive(Clone, Debug)]
enum WatchKind {
    Item(Item),
    Compiled(String, Arc<CompiledExpression>),
}

impl Watch {
    /// The least and the greatest value of the integer that is stored here; `None` for other types.
    #[must_use]
    pub fn limits(&self) -> Option<(f64, f64)> {
        match &self.0 {
            WatchKind::Item(_) => None,
            WatchKind::Compiled(_, compiled) => compiled.expression.limits(),
        }
    }

    /// The present value on a board.
    pub(super) fn value<T: Target>(&self, target: &T) -> f64 {
        match &self.0 {
            WatchKind::Item(item) => target.value(*item),
            WatchKind::Compiled(_, compiled) => {
                let reader = TargetContext { target, items: &compiled.items, has_failed: Cell::new(false) };
                let value = compiled.expression.value(&reader);
                if reader.has_failed.get() { f64::NAN } else { value }
            }
        }
    }

    /// The watched value in the form that the recorder of a running board takes.
    pub(super) fn into_quantity(self) -> Quantity {
        match self.0 {
            WatchKind::Item(item) => item.into(),
            WatchKind::Compiled(text, compiled) => Quantity::Formula(text, compiled),
        }
    }
}

impl fmt::Display for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            WatchKind::Item(item) => item.fmt(f),
            WatchKind::Compiled(text, _) => f.write_str(text),
        }
    }
}

impl<T: Target> Session<T> {
    /// Prepares an item or an expression whose value is read, once or repeatedly.
    ///
    /// # Errors
    /// The item or expression is not valid.
    pub fn watch(&self, text: &str) -> Result<Watch, WatchError> {
        watch(text, &self.programs, &self.options)
    }

    /// Parses a list of names for a [recording](Self::record), separated by commas: `axis0` is all of an axis.
    ///
    /// # Errors
    /// One of the names is not valid.
    pub fn quantities(&self, list: &str) -> Result<Vec<Quantity>, WatchError> {
        quantities(list, &self.programs, &self.options)
    }

    /// The present value of a watch; NaN if it divides an integer by 0.
    #[must_use]
    pub fn value(&self, watch: &Watch) -> f64 {
        watch.value(&self.target)
    }

    /// The present value of an item or an expression.
    ///
    /// # Errors
    /// The item or expression is not valid.
    pub fn read(&self, text: &str) -> Result<f64, WatchError> {
        Ok(self.value(&self.watch(text)?))
    }

    /// Stores a value in a variable, field or element, or through a pointer, as an assignment in C would.
    ///
    /// # Errors
    /// The expression is not valid, or is not a place.
    pub fn write(&mut self, text: &str, value: f64) -> Result<(), WatchError> {
        let place = self.place(text)?;
        self.write_to(&place, value)
    }

    /// Prepares a variable, field, element or dereferenced pointer to be [written](Self::write_to), once or repeatedly.
    ///
    /// # Errors
    /// The expression is not valid, or is not a place.
    pub fn place(&self, text: &str) -> Result<Watch, WatchError> {
        let watch = self.watch(&with_user_data(text))?;
        match &watch.0 {
            WatchKind::Compiled(_, compiled) if compiled.expression.is_place() => Ok(watch),
            WatchKind::Compiled(..) | WatchKind::Item(_) => Err(WatchError::NoPlace(text.to_owned())),
        }
    }

    /// Stores a value in a [place](Self::place), as an assignment in C would.
    ///
    /// # Errors
    /// A pointer points outside memory.
    pub fn write_to(&mut self, place: &Watch, value: f64) -> Result<(), WatchError> {
        let no_place = || WatchError::NoPlace(place.to_string());
        let Watch(WatchKind::Compiled(text, compiled)) = place else { return Err(no_place()) };
        let reader =
            TargetContext { target: &self.target, items: &compiled.items, has_failed: Cell::new(false) };
        let (address, bytes) = compiled.expression.store(value, &reader).ok_or_else(no_place)?;
        self.target.write(address, &bytes).map_err(|_| no_place())?;
        let tick = self.tick();
        match (user_data_at(address), <[u8; 4]>::try_from(&bytes[..])) {
            (Some(index), Ok(word)) => self.recording.stored(tick, index, i32::from_le_bytes(word)),
            _ => self.recording.record_unsupported(tick, &format!("write {value} to {text}")),
        }
        self.note(Input::Store(address, bytes));
        Ok(())
    }

    /// Starts recording as requested; the records come as events. Only a target with
    /// [recordings](crate::Capability::Recordings) records.
    pub fn record(&mut self, request: runtime::trace::TraceRequest) {
        self.target.record(request);
    }
}

fn watch(text: &str, programs: &[UserProgram], options: &Options) -> Result<Watch, WatchError> {
    match Item::among(options.firmware.board().axes, text) {
        Ok(item) => Ok(Watch(WatchKind::Item(item))),
        // An item number that is too high is not the name of a variable.
        Err(error) if Item::is_kind(text.trim_end_matches(|c: char| c.is_ascii_digit())) => Err(error.into()),
        Err(_) => formula(text, programs, options),
    }
}

/// Parses a list of names for a recording with the declarations of these programs, separated by commas: `axis0` is all
/// of an axis.
///
/// # Errors
/// One of the names is not valid.
pub fn quantities(
    list: &str,
    programs: &[UserProgram],
    options: &Options,
) -> Result<Vec<Quantity>, WatchError> {
    let mut quantities = Vec::new();
    for name in expressions(list) {
        if let Some(number) = name.strip_prefix("axis").filter(|number| is_number(number)) {
            let axes = options.firmware.board().axes;
            let axis =
                Item::among(axes, &format!("dest{number}"))?.axis().and_then(|axis| AxisId::new(axis as i32));
            quantities.extend(axis.into_iter().flat_map(Item::of_axis).map(Quantity::from));
            continue;
        }
        quantities.push(watch(name, programs, options)?.into_quantity());
    }
    Ok(quantities)
}

/// The element of `persist.UserData` at an address.
pub(super) fn user_data_at(address: GuestAddr) -> Option<usize> {
    let base = PERSIST.field(Persist::USER_DATA).address().get();
    let offset = usize::try_from(address.get().checked_sub(base)?).ok()?;
    Some(offset / 4).filter(|index| offset.is_multiple_of(4) && *index < N_USER_DATA_VARS)
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The expressions of a list separated by commas; commas within brackets belong to an expression.
///
/// ```
/// assert_eq!(cc67_host::session::expressions("dest0, max(a, b)"), ["dest0", "max(a, b)"]);
/// ```
#[must_use]
pub fn expressions(list: &str) -> Vec<&str> {
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

/// An expression with the declarations of the first program that can compile it, or of the program in the thread that
/// it names; without a program, with the declarations of the board's header.
fn formula(text: &str, programs: &[UserProgram], options: &Options) -> Result<Watch, WatchError> {
    if text.is_empty() {
        return Err(WatchError::Missing);
    }
    if text.len() > MOST {
        return Err(WatchError::TooLong);
    }
    let thread = text.split_once(':').and_then(|(number, _)| number.parse().ok()).and_then(ThreadId::new);
    let expression =
        if thread.is_some() { text.split_once(':').map_or(text, |(_, rest)| rest) } else { text };
    let expression = with_user_data(expression);
    let mut first_error = None;
    let mut words: Vec<_> = programs
        .iter()
        .filter(|program| thread.is_none_or(|thread| thread == program.thread))
        .map(Vocabulary::of_program)
        .collect();
    if words.is_empty() && thread.is_none() {
        words.push(Ok(Vocabulary::of_board()));
    }
    for words in words {
        match words.and_then(|words| words.compile(&expression, options)) {
            Ok(compiled) => return Ok(Watch(WatchKind::Compiled(text.to_owned(), Arc::new(compiled)))),
            Err(error) => {
                first_error.get_or_insert(error);
            }
        }
    }
    let error = first_error.unwrap_or_else(|| "there is no program in that thread".to_owned());
    // Without a similar name there is nothing else to report.
    let is_strange = error.ends_with(NOT_DECLARED);
    let message = error + if is_strange { KNOWN } else { "" };
    Err(WatchError::Wrong { expression: text.to_owned(), message })
}

/// Compiles an expression in a stimulus with the declarations of the stimulus's programs.
pub(super) fn for_stimulus(
    text: &str,
    programs: &[UserProgram],
    options: &Options,
) -> Result<Arc<dyn Formula>, String> {
    match formula(text, programs, options) {
        Ok(Watch(WatchKind::Compiled(_, compiled))) => Ok(compiled),
        Ok(Watch(WatchKind::Item(item))) => Ok(Arc::new(item)),
        Err(error) => Err(error.to_string()),
    }
}

/// An expression as the compiler reads it: `persist.5` is an element of `persist.UserData`.
#[must_use]
pub fn with_user_data(text: &str) -> String {
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

/// A compiled expression, with the items that it names.
#[derive(Debug)]
struct CompiledExpression {
    expression: Expression,
    items: Vec<Item>,
}

/// The names that expressions may use.
struct Vocabulary<'a> {
    /// The file whose folder is searched for includes.
    path: &'a Path,
    /// Declarations.
    text: Vec<u8>,
    /// The addresses of the variables.
    symbols: BTreeMap<String, GuestAddr>,
}

impl<'a> Vocabulary<'a> {
    /// The declarations of a program: its source, and the addresses of the variables from its image.
    fn of_program(program: &'a UserProgram) -> Result<Self, String> {
        let inspection = Inspection::read(&program.image).map_err(|error| error.to_string())?;
        let objects = inspection.symbols.iter().filter(|entry| entry.kind == EntryKind::Object);
        let symbols = objects.map(|entry| (entry.name.clone(), GuestAddr::new(entry.address))).collect();
        let path = program.path.as_path();
        let text = match program.is_image {
            true => declarations(&inspection).into_bytes(),
            false => files::read(path)
                .map_err(|error| format!("cannot read {}: {}", path.display(), files::reason(&error)))?,
        };
        Ok(Self { path, text, symbols })
    }

    /// The declarations of the board, for use without a program.
    fn of_board() -> Self {
        let text = b"#include \"KMotionDef.h\"\n".to_vec();
        Self { path: Path::new("board"), text, symbols: BTreeMap::new() }
    }

    fn compile(&self, text: &str, options: &Options) -> Result<CompiledExpression, String> {
        let symbols = &self.symbols;
        let scope = Scope { path: self.path, text: &self.text, symbols, options, files: &Disk };
        let first = match watch::compile(scope, text, &[]) {
            Ok(expression) => return Ok(CompiledExpression { expression, items: Vec::new() }),
            Err(error) => error,
        };
        // A name in the program takes precedence over an item; so items are tried second.
        let item = |name: &str| Item::among(options.firmware.board().axes, name).ok();
        let mut names: Vec<&str> =
            identifiers(text).filter(|word| !symbols.contains_key(*word) && item(word).is_some()).collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            return Err(first);
        }
        let expression = watch::compile(scope, text, &names)?;
        Ok(CompiledExpression { expression, items: names.into_iter().filter_map(item).collect() })
    }
}

/// The variables of an image whose types are recorded in it: not structures and pointers.
fn declarations(inspection: &Inspection) -> String {
    let mut text = "#include \"KMotionDef.h\"\n".to_owned();
    let objects = inspection.symbols.iter().filter(|entry| entry.kind == EntryKind::Object);
    for entry in objects.filter(|entry| identifiers(&entry.name).eq([entry.name.as_str()])) {
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

/// Returns the parts of a text that have the form of an identifier.
fn identifiers(text: &str) -> impl Iterator<Item = &str> {
    text.split(|character: char| !(character.is_ascii_alphanumeric() || character == '_'))
}

impl Formula for CompiledExpression {
    fn value(&self, view: &View<'_>) -> f64 {
        self.expression.value(&ViewContext { view, items: &self.items })
    }

    fn items(&self) -> &[Item] {
        &self.items
    }

    fn cell(&self) -> Option<RecordedCell> {
        self.expression.recorded().map(|(address, kind)| RecordedCell::new(address, kind))
    }
}

/// The eight bytes at an address, padded at the end of a region.
fn eight_bytes(memory: &vm::memory::GuestMemory, address: GuestAddr) -> [u8; 8] {
    std::array::from_fn(|offset| memory.peek::<u8>(address.offset(offset as u32)))
}

/// A target between two steps, as the environment of an expression.
struct TargetContext<'a, T> {
    target: &'a T,
    items: &'a [Item],
    /// The target did not answer.
    has_failed: Cell<bool>,
}

impl<T: Target> ItemReader for TargetContext<'_, T> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        let mut bytes = [0; 8];
        if self.target.read(address, &mut bytes).is_err() {
            self.has_failed.set(true);
        }
        bytes
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |item| self.target.value(*item))
    }
}

/// A recorded board, as the environment of an expression.
struct ViewContext<'a> {
    view: &'a View<'a>,
    items: &'a [Item],
}

impl ItemReader for ViewContext<'_> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        eight_bytes(self.view.memory, address)
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |item| self.view.item(*item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_inside_brackets_do_not_split_a_list() {
        assert_eq!(expressions("a, f(b, c) ,x[1,2]"), ["a", "f(b, c)", "x[1,2]"]);
    }

    #[test]
    fn elements_of_user_data_have_a_short_form() {
        assert_eq!(
            with_user_data("persist.5 + persist.UserData[6]"),
            "persist.UserData[5] + persist.UserData[6]"
        );
    }
}
