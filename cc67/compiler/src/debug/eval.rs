//! Expressions at the position of a program: C, with the locals of the function.
//!
//! An expression is compiled as a statement at the end of the innermost block around a line, so that every name in it
//! means what it means there. It is computed from the board's memory and the registers of a call; it only reads.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use kmotiondef::GuestAddr;

use super::scope;
use super::value::{Data, DebugValue, DisplayContext};
use super::{LocalModel, Model};
use crate::diag::Severity;
use crate::driver::{CompileContext, CompileRequest, FrontEndOutput, on_large_stack};
use crate::inspect::EntryKind;
use crate::names::Names;
use crate::pp::Disk;
use crate::sema::constants::{self, Constant};
use crate::source::SourceMap;
use crate::ty::{Type, TypeId, Types};
use crate::typed::{ExprId, ExprKind, LocalId, PlaceKind, StmtKind, Unit};
use crate::watch::{self, AllowedCalls, CallRequest, Expression};

/// The location of a local of a call in progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalPlace {
    /// In memory.
    Memory(GuestAddr),
    /// In a register, which holds these bits.
    Slot(u64),
}

/// The state that expressions and values are read from.
pub trait DebugReader {
    /// The eight bytes from an address on; 0 outside the memory.
    fn bytes(&self, address: GuestAddr) -> [u8; 8];

    /// Reports whether there is memory at an address.
    fn is_mapped(&self, address: GuestAddr) -> bool {
        let _ = address;
        true
    }

    /// The eight bytes from an address on; `None` without memory there.
    fn word(&self, address: GuestAddr) -> Option<[u8; 8]> {
        let bytes = self.bytes(address);
        // Only where there is no memory nothing but zeros is read.
        (bytes != [0; 8] || self.is_mapped(address)).then_some(bytes)
    }

    /// The item of this place in the list that the expression was compiled with.
    fn item(&self, index: usize) -> f64;

    /// The location of a local; `None` if it is optimised out.
    fn local(&self, local: &LocalModel) -> Option<LocalPlace>;

    /// The name of what is at an address, with the distance from its beginning.
    fn symbol(&self, address: GuestAddr) -> Option<String> {
        let _ = address;
        None
    }
}

/// A line of a function, for the names that mean something there.
#[derive(Clone, Copy, Debug)]
pub struct CodeScope<'a> {
    /// The function.
    pub function: &'a str,
    /// The line.
    pub line: u32,
    /// The function's locals: those of its own code, or of an inlined call of it.
    pub locals: &'a [LocalModel],
}

/// An expression that was compiled for a place in a program.
#[derive(Debug)]
pub struct Probe {
    unit: Unit,
    names: Names,
    expression: Expression,
    value: ExprId,
    /// The value is the address of what was requested.
    is_address: bool,
    locals: BTreeMap<LocalId, LocalModel>,
    has_locals: bool,
}

/// The calls of functions that the board executes for an expression: their results as far as they are known, and the call
/// whose result is needed next.
#[derive(Debug, Default)]
pub struct CallResults {
    known: BTreeMap<ExprId, u64>,
    next: RefCell<Option<CallRequest>>,
}

impl CallResults {
    /// Takes the call whose result a value needs, if there is one.
    pub fn take_next(&mut self) -> Option<CallRequest> {
        self.next.take()
    }

    /// Notes the result of a call, as the slot of a register.
    pub fn record(&mut self, call: &CallRequest, slot: u64) {
        self.known.insert(call.id, slot);
    }
}

/// The names that an expression may use.
struct ProbeNames<'a> {
    place: Option<CodeScope<'a>>,
    items: &'a [&'a str],
    calls: AllowedCalls,
}

/// An expression in the text of a program.
struct InsertedExpression<'a> {
    range: std::ops::Range<u32>,
    /// The function around it, and its locals.
    function: &'a str,
    locals: &'a [LocalModel],
    is_address: bool,
}

/// The reason why there is no probe.
enum ProbeError {
    /// The text is not an expression.
    Invalid(String),
    /// It is one, but what it names cannot be read.
    Unreadable(String),
}

fn not_an_expression() -> ProbeError {
    ProbeError::Invalid("not an expression".to_owned())
}

/// The text inserted before and after an expression.
const BEFORE: &str = "\n;{ ";
const BEHIND: &str = "\n; }\n";

impl Model {
    /// Compiles an expression at a line of a function; without one, outside all functions. `items` are further names
    /// in it, of type `double`; `calls` lists the functions that it may call.
    ///
    /// # Errors
    /// What is wrong with it, in one line.
    pub fn probe(
        &self,
        place: Option<CodeScope<'_>>,
        expression: &str,
        items: &[&str],
        calls: AllowedCalls,
    ) -> Result<Probe, String> {
        let line = place.map_or(1, |place| place.line);
        let expression = &with_line(expression, line);
        let names = ProbeNames { place, items, calls };
        on_large_stack(|| {
            match self.probe_as(&names, &format!("&(\n{expression}\n)"), true) {
                // It may be a value without an address.
                Err(ProbeError::Invalid(_)) => self.probe_as(&names, &format!("(\n{expression}\n)"), false),
                whole => whole,
            }
        })
        .map_err(|error| error.message)?
        .map_err(|(ProbeError::Invalid(text) | ProbeError::Unreadable(text))| text)
    }

    fn probe_as(
        &self,
        probe_names: &ProbeNames<'_>,
        expression: &str,
        is_address: bool,
    ) -> Result<Probe, ProbeError> {
        let ProbeNames { place, items, calls } = *probe_names;
        let mut items_text: String = items.iter().map(|item| format!("extern double {item}; ")).collect();
        if calls == AllowedCalls::Executed {
            items_text += &self.declarations(place.map_or(u32::MAX, |place| place.line), expression);
        }
        let inserted = format!("{BEFORE}{items_text}{expression}{BEHIND}");
        let mut text = self.text.clone();
        let inside = place.and_then(|place| Some((self.place_in(place.function, place.line)?, place)));
        let (from, until, name, locals) = match inside {
            Some((at, place)) => {
                text.splice(at..at, inserted.bytes());
                (at, at + inserted.len(), place.function, place.locals)
            }
            None => {
                let name = "__cc67_probe";
                let from = text.len();
                text.extend(format!("\nvoid {name}(void) {{{inserted}}}\n").bytes());
                (from, text.len(), name, [].as_slice())
            }
        };
        let inserted =
            InsertedExpression { range: from as u32..until as u32, function: name, locals, is_address };
        self.compile(text, &inserted, probe_names)
    }

    /// The declarations of the functions that an expression calls and that the program defines only after a line.
    fn declarations(&self, line: u32, expression: &str) -> String {
        let later = self.functions.iter().filter(|function| function.lines.start > line);
        let called = later.filter(|function| calls_by_name(expression, &function.name));
        let types = &self.unit.types;
        let declaration = |function: &super::FunctionModel| {
            let symbol = self.unit.symbols.values().find(|symbol| symbol.name == function.name)?;
            Some(types.spell_declaration(&self.names, symbol.ty, &function.name) + "; ")
        };
        called.filter_map(declaration).collect()
    }

    /// The position in the text at which to insert an expression that is evaluated in a line of a function.
    fn place_in(&self, function: &str, line: u32) -> Option<usize> {
        let function = self.functions.iter().find(|known| known.name == function)?;
        let head = scope::begin_of_line(&self.text, function.lines.start);
        let body = scope::begin_of_body(&self.text, head)?;
        let from = scope::begin_of_line(&self.text, line).max(body);
        scope::end_of_block(&self.text, from)
    }

    fn compile(
        &self,
        text: Vec<u8>,
        inserted: &InsertedExpression<'_>,
        probe_names: &ProbeNames<'_>,
    ) -> Result<Probe, ProbeError> {
        let InsertedExpression { range: inserted, function: name, locals, is_address } = inserted;
        let (is_address, items) = (*is_address, probe_names.items);
        let mut context = CompileContext::default();
        let request = CompileRequest { path: &self.path, options: &self.options, files: &Disk };
        let FrontEndOutput { main, mut unit } = request.run_front_end(text, &mut context);
        let CompileContext { sources, names, sink } = context;
        let error = sink.diagnostics().iter().find(|diagnostic| diagnostic.severity == Severity::Error);
        if let Some(error) = error {
            return Err(ProbeError::Invalid(watch::in_one_line(error)));
        }
        let start = sources.file(main).start;
        let range = start + inserted.start..start + inserted.end;
        let index = unit.functions.iter().position(|function| unit.symbols[function.symbol].name == *name);
        let index = index.ok_or_else(not_an_expression)?;
        let function = &unit.functions[index];
        let mut found = None;
        function.each_stmt(&mut |stmt| {
            if let StmtKind::Expr(id) = stmt.kind
                && range.contains(&sources.call_site(stmt.span).lo)
            {
                found.get_or_insert(id);
            }
        });
        let mut value = found.ok_or_else(not_an_expression)?;
        while let ExprKind::Convert(inner) = function.exprs[value].kind {
            if function.exprs[value].ty != Types::VOID {
                break;
            }
            value = inner;
        }
        let locals = locals_of(locals, function, &sources, start);
        let functions = self.addresses(EntryKind::Function);
        let mut symbols = self.addresses(EntryKind::Object);
        symbols.extend(functions.clone());
        let code = (probe_names.calls == AllowedCalls::Executed).then_some(functions);
        let named = watch::meanings(&unit, index, value, &symbols, code.as_ref(), &self.options, items)
            .map_err(ProbeError::Unreadable)?;
        let function = &unit.functions[index];
        if is_address
            && let ExprKind::Address(place) = function.exprs[value].kind
            && let PlaceKind::Symbol(symbol, _) = function.places[place].kind
            && matches!(named.meanings.get(&symbol), Some(watch::Meaning::Item(_)))
        {
            return Err(ProbeError::Invalid("an item of the board has no address".to_owned()));
        }
        let function = unit.functions.swap_remove(index);
        let expression = Expression::new(function, value, &named.meanings);
        Ok(Probe { unit, names, expression, value, is_address, locals, has_locals: named.has_locals })
    }

    /// The addresses of the entries of a kind in the image, by their names.
    fn addresses(&self, kind: EntryKind) -> BTreeMap<String, GuestAddr> {
        let entries = self.image.symbols.iter().filter(|entry| entry.kind == kind);
        entries.map(|entry| (entry.name.clone(), GuestAddr::new(entry.address))).collect()
    }

    /// The value of a local, if it has one at present.
    #[must_use]
    pub fn local<'a>(
        &'a self,
        local: &LocalModel,
        reader: &'a dyn DebugReader,
    ) -> Option<(DebugValue, DisplayContext<'a>)> {
        let place = reader.local(local)?;
        let shown = DisplayContext { types: &self.unit.types, names: &self.names, reader };
        Some((DebugValue::of(local.type_id, place), shown))
    }

    /// The result of a function, as the slot of a register; `None` for `void` and what no register holds.
    #[must_use]
    pub fn result<'a>(
        &'a self,
        function: &str,
        slot: u64,
        reader: &'a dyn DebugReader,
    ) -> Option<(DebugValue, DisplayContext<'a>)> {
        let symbol = self.unit.symbols.values().find(|symbol| symbol.name == function)?;
        let Type::Function(function) = self.unit.types.get(symbol.ty) else { return None };
        if matches!(self.unit.types.get(function.result), Type::Void | Type::Record(_)) {
            return None;
        }
        let shown = DisplayContext { types: &self.unit.types, names: &self.names, reader };
        Some((DebugValue { ty: function.result, data: Data::Slot(slot) }, shown))
    }

    /// The value of a variable outside functions.
    #[must_use]
    pub fn global<'a>(
        &'a self,
        name: &str,
        address: u32,
        reader: &'a dyn DebugReader,
    ) -> Option<(DebugValue, DisplayContext<'a>)> {
        let symbol = self.unit.symbols.values().find(|symbol| symbol.name == name)?;
        let shown = DisplayContext { types: &self.unit.types, names: &self.names, reader };
        Some((DebugValue { ty: symbol.ty, data: Data::Memory(GuestAddr::new(address)) }, shown))
    }
}

/// The locals of the compilation with an expression as those of the program.
fn locals_of(
    known: &[LocalModel],
    function: &crate::typed::Function,
    sources: &SourceMap,
    start: u32,
) -> BTreeMap<LocalId, LocalModel> {
    let mut locals = BTreeMap::new();
    for (id, local) in &function.locals {
        let declared = sources.call_site(local.span).lo.wrapping_sub(start);
        let same = known.iter().find(|known| known.name == local.name && known.declared == declared);
        if let Some(same) = same {
            locals.insert(id, same.clone());
        }
    }
    locals
}

/// An expression in which `__LINE__` is the line of the place where it is evaluated.
fn with_line(expression: &str, line: u32) -> String {
    let mut whole = String::new();
    let mut rest = expression;
    while let Some(at) = rest.find("__LINE__") {
        let (before, after) = (&rest[..at], &rest[at + "__LINE__".len()..]);
        let is_part = |letter: Option<char>| letter.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_');
        whole.push_str(before);
        let is_word = !is_part(before.chars().next_back()) && !is_part(after.chars().next());
        if is_word {
            whole.push_str(&line.to_string());
        } else {
            whole.push_str("__LINE__");
        }
        rest = after;
    }
    whole + rest
}

/// Reports whether an expression has a call of a function by its name.
fn calls_by_name(expression: &str, name: &str) -> bool {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    expression.match_indices(name).any(|(at, _)| {
        let before = expression[..at].chars().next_back();
        let after = expression[at + name.len()..].trim_start();
        !before.is_some_and(is_part) && after.starts_with('(')
    })
}

/// The message on a place where there is no memory.
fn no_memory(address: GuestAddr) -> String {
    format!("Cannot access memory at address {:#x}", address.get())
}

/// A reader as an expression wants it.
struct ProbeReader<'a, R: ?Sized> {
    reader: &'a R,
    locals: &'a BTreeMap<LocalId, LocalModel>,
    results: Option<&'a CallResults>,
    /// The last address read at which there is no memory.
    unmapped: Cell<Option<GuestAddr>>,
}

impl<R: DebugReader + ?Sized> watch::ItemReader for ProbeReader<'_, R> {
    #[inline]
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        self.reader.word(address).unwrap_or_else(|| {
            self.unmapped.set(Some(address));
            [0; 8]
        })
    }

    fn item(&self, index: usize) -> f64 {
        self.reader.item(index)
    }

    fn local(&self, local: LocalId) -> Option<watch::Local> {
        Some(match self.reader.local(self.locals.get(&local)?)? {
            LocalPlace::Memory(address) => watch::Local::Memory(address),
            LocalPlace::Slot(bits) => watch::Local::Slot(bits),
        })
    }

    fn result(&self, call: CallRequest) -> Option<u64> {
        let results = self.results?;
        let known = results.known.get(&call.id).copied();
        if known.is_none() {
            results.next.borrow_mut().get_or_insert(call);
        }
        known
    }
}

impl Probe {
    /// The present value.
    ///
    /// # Errors
    /// That a local is optimised out, that an integer is divided by 0, or that there is no memory where a pointer points.
    pub fn value(&self, reader: &dyn DebugReader) -> Result<DebugValue, String> {
        self.value_with(reader, &CallResults::default())
    }

    /// The present value with the results of calls. There is none if one is needed that is not known: the call is then in
    /// `results`.
    ///
    /// # Errors
    /// As [`value`](Self::value).
    pub fn value_with(&self, reader: &dyn DebugReader, results: &CallResults) -> Result<DebugValue, String> {
        let inner =
            ProbeReader { reader, locals: &self.locals, results: Some(results), unmapped: Cell::new(None) };
        let value = self.value_in(&inner)?;
        let unmapped = inner.unmapped.get();
        let place = value.address().filter(|address| !reader.is_mapped(*address));
        unmapped.or(place).map_or(Ok(value), |address| Err(no_memory(address)))
    }

    /// Returns whether the expression has a value at present that is not 0.
    pub fn is_true<R: DebugReader>(&self, reader: &R) -> bool {
        if self.is_address {
            let number =
                self.value(reader).ok().and_then(|value| self.display_context(reader).number(&value));
            return number.is_some_and(|number| number != 0.0);
        }
        let inner = ProbeReader { reader, locals: &self.locals, results: None, unmapped: Cell::new(None) };
        let truth = self.expression.truth(&inner);
        inner.unmapped.get().is_none() && truth == Some(true)
    }

    fn value_in(&self, inner: &ProbeReader<'_, dyn DebugReader + '_>) -> Result<DebugValue, String> {
        let reader = inner.reader;
        let function = self.expression.function();
        let ty = function.exprs[self.value].ty;
        if !self.is_address {
            let constant = self.expression.constant(inner).ok_or_else(|| self.failure_reason(reader))?;
            return Ok(DebugValue { ty, data: Data::Constant(constant) });
        }
        let pointee = match self.unit.types.get(ty) {
            Type::Pointer(to) => to.ty,
            _ => ty,
        };
        if let ExprKind::Address(place) = function.exprs[self.value].kind
            && let PlaceKind::Local(local, 0) = function.places[place].kind
        {
            let local = self.locals.get(&local).ok_or_else(|| self.failure_reason(reader))?;
            return Ok(DebugValue::of(
                pointee,
                reader.local(local).ok_or_else(|| optimised_out(&local.name))?,
            ));
        }
        match self.expression.constant(inner) {
            Some(Constant::Int(address)) => {
                Ok(DebugValue { ty: pointee, data: Data::Memory(GuestAddr::new(address as u32)) })
            }
            _ => Err(self.failure_reason(reader)),
        }
    }

    /// The type of the expression, without its value.
    #[must_use]
    pub fn type_only(&self) -> DebugValue {
        let ty = self.expression.function().exprs[self.value].ty;
        let ty = match self.unit.types.get(ty) {
            Type::Pointer(to) if self.is_address => to.ty,
            _ => ty,
        };
        DebugValue { ty, data: Data::Constant(Constant::Int(0)) }
    }

    /// Reports whether the expression names locals of its call.
    #[must_use]
    pub const fn has_locals(&self) -> bool {
        self.has_locals
    }

    /// The local that the expression names, for another value of it.
    #[must_use]
    pub fn as_local(&self) -> Option<&LocalModel> {
        let function = self.expression.function();
        let ExprKind::Address(place) = function.exprs[self.value].kind else { return None };
        match function.places[place].kind {
            PlaceKind::Local(local, 0) if self.is_address => self.locals.get(&local),
            _ => None,
        }
    }

    /// Types and names, to show the value.
    #[must_use]
    pub fn display_context<'a>(&'a self, reader: &'a dyn DebugReader) -> DisplayContext<'a> {
        DisplayContext { types: &self.unit.types, names: &self.names, reader }
    }

    /// A number as memory would hold it in this place; `None` for a structure or an array.
    #[must_use]
    pub fn bytes_of(&self, place: &DebugValue, number: f64, reader: &dyn DebugReader) -> Option<Vec<u8>> {
        let shown = self.display_context(reader);
        shown.constant(place)?;
        if let Data::Field(..) = place.data {
            return None;
        }
        Some(encode(place.ty, number))
    }

    fn failure_reason(&self, reader: &dyn DebugReader) -> String {
        let missing =
            self.locals.values().find(|local| self.names_local(local) && reader.local(local).is_none());
        if let Some(local) = missing {
            return optimised_out(&local.name);
        }
        let function = self.expression.function();
        let unknown = function.places.values().find_map(|place| match place.kind {
            PlaceKind::Local(id, _) if !self.locals.contains_key(&id) => Some(&function.locals[id].name),
            _ => None,
        });
        unknown.map_or_else(
            || "Division by zero".to_owned(),
            |name| format!("where the local `{name}` is in this code is not noted; variables outside functions have values"),
        )
    }

    /// Reports whether the expression mentions a local.
    fn names_local(&self, local: &LocalModel) -> bool {
        let function = self.expression.function();
        function.places.values().any(|place| match place.kind {
            PlaceKind::Local(id, _) => {
                self.locals.get(&id).is_some_and(|known| known.declared == local.declared)
            }
            _ => false,
        })
    }
}

fn optimised_out(name: &str) -> String {
    format!("`{name}` is optimised out here; with -O0 it is there")
}

/// A number as memory holds it.
fn encode(ty: TypeId, number: f64) -> Vec<u8> {
    match constants::convert(Constant::Float(number), Types::DOUBLE, ty) {
        Constant::Int(value) => value.to_le_bytes().into_iter().take(watch::size_of(ty)).collect(),
        Constant::Float(value) if ty == Types::FLOAT => (value as f32).to_le_bytes().into(),
        Constant::Float(value) => value.to_le_bytes().into(),
    }
}
