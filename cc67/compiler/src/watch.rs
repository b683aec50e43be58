//! Watched expressions: C expressions of the program, evaluated while it runs.
//!
//! An expression is compiled as the result of a function after the program's own text, so every name, type and macro of
//! the program has its meaning there. The board does not execute it; it is computed from the board's memory, so a run
//! is the same with and without it. For the same reason it only reads.

mod node;

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::Path;

use kmotiondef::GuestAddr;
use kmotiondef::modes::GatherType;

use crate::diag::{Diagnostic, Lint, Severity};
use crate::driver::{CompileContext, CompileRequest, FrontEndOutput, Options, on_large_stack};
use crate::firmware::{FirmwareKind, FirmwareSymbols};
use crate::lints;
use crate::pp::{Disk, Files};
use crate::sema::constants::{self, Constant};
use crate::ty::{BitRange, TypeId, Types};
use crate::typed::{
    Call, Callee, ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, StmtKind, SymbolId, Unit,
};

use self::node::{Builder, Node, Place};

/// The name of the function around an expression.
const FUNCTION: &str = "__cc67_watch";

/// Most operators and operands of an expression, those of its macros included.
const MOST: usize = 1000;

/// The computation of a function.
type Operation = fn(f64) -> f64;

/// Functions that an expression may call.
const FUNCTIONS: &[(&str, Operation)] = &[
    ("fabs", libm::fabs),
    ("sqrt", libm::sqrt),
    ("floor", libm::floor),
    ("ceil", libm::ceil),
    ("sin", libm::sin),
    ("cos", libm::cos),
];

/// The program that an expression is evaluated in.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    /// The file of the program, beside which its includes are looked for.
    pub path: &'a Path,
    /// The text of the program.
    pub text: &'a [u8],
    /// The addresses of the program's variables.
    pub symbols: &'a BTreeMap<String, GuestAddr>,
    /// The options that the program is compiled with.
    pub options: &'a Options,
    /// The program's includes.
    pub files: &'a (dyn Files + Sync),
}

/// The state that expressions are evaluated on.
pub trait ItemReader {
    /// The eight bytes from an address on; 0 outside the memory.
    fn bytes(&self, address: GuestAddr) -> [u8; 8];

    /// The item of this place in the list that the expression was compiled with.
    fn item(&self, index: usize) -> f64;

    /// The location of a local of a call in progress; `None` if it is optimised out.
    fn local(&self, local: LocalId) -> Option<Local> {
        let _ = local;
        None
    }

    /// The slot of the result of a call, if it is known.
    fn result(&self, call: CallRequest) -> Option<u64> {
        let _ = call;
        None
    }
}

/// A call of a function that an expression makes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallRequest {
    /// Its place in the expression.
    pub(crate) id: ExprId,
    /// The function.
    pub function: GuestAddr,
    /// The arguments, each as the slot of a register.
    pub arguments: Vec<u64>,
}

/// The location of a local of a call in progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Local {
    /// In memory.
    Memory(GuestAddr),
    /// In a register, which holds these bits.
    Slot(u64),
}

/// An expression that can be computed.
#[derive(Debug)]
pub struct Expression {
    function: Function,
    value: ExprId,
    /// The computation of the value.
    root: Node,
    /// The place that the value is read from, if it is one.
    place: Option<Place>,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Meaning {
    Variable(GuestAddr),
    Item(usize),
    Function(Operation),
    /// A function that the board executes.
    Code(GuestAddr),
}

/// The calls that an expression may make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AllowedCalls {
    /// Only those of functions that are computed without the board.
    #[default]
    Computed,
    /// Also those of functions of the program and of the firmware.
    Executed,
}

/// Compiles an expression. `items` are further names in it, of type `double`.
///
/// # Errors
/// What is wrong with it, in one line.
pub fn compile(scope: Scope<'_>, expression: &str, items: &[&str]) -> Result<Expression, String> {
    on_large_stack(|| compile_here(scope, expression, items)).map_err(|error| error.message)?
}

fn compile_here(scope: Scope<'_>, expression: &str, items: &[&str]) -> Result<Expression, String> {
    let mut context = CompileContext::default();
    let mut text = scope.text.to_vec();
    for item in items {
        text.extend(format!("\nextern double {item};").bytes());
    }
    let before = text.len() as u32;
    text.extend(format!("\ndouble {FUNCTION}(void) {{ return (\n{expression}\n); }}\n").bytes());
    let request = CompileRequest { path: scope.path, options: scope.options, files: scope.files };
    let FrontEndOutput { main, mut unit } = request.run_front_end(text, &mut context);
    let CompileContext { sources, names, mut sink } = context;
    let error = sink.diagnostics().iter().find(|diagnostic| diagnostic.severity == Severity::Error);
    if let Some(error) = error {
        return Err(in_one_line(error));
    }
    // What is doubtful in the program was reported when it was compiled; in an expression it is a mistake.
    let (start, known) = (sources.file(main).start + before, sink.diagnostics().len());
    lints::check(&unit, &names, &sources, scope.options.lint_context(), &mut sink);
    let is_here = |diagnostic: &&Diagnostic| {
        // The board's lack of `fabs` matters to no expression, and the value of each one becomes a `double`.
        let matters = !matches!(diagnostic.lint, Some(Lint::Portability | Lint::IntegerDivision));
        matters && diagnostic.span.is_some_and(|span| span.lo >= start)
    };
    let doubt = sink.diagnostics().iter().skip(known).find(is_here).map(in_one_line);
    let is_ours = |function: &Function| unit.symbols[function.symbol].name == FUNCTION;
    let function = unit.functions.iter().position(is_ours).map(|index| unit.functions.swap_remove(index));
    let Some(function) = function else { return Err("not an expression".to_owned()) };
    let [statement] = function.body.as_slice() else { return Err("not an expression".to_owned()) };
    let StmtKind::Return(Some(value)) = statement.kind else { return Err("it has no value".to_owned()) };
    let mut check = Check {
        unit: &unit,
        scope,
        items,
        function: &function,
        meanings: BTreeMap::new(),
        count: 0,
        code: None,
        locals: false,
        has_locals: false,
    };
    check.expr(value)?;
    let meanings = check.meanings;
    match doubt {
        Some(doubt) => Err(doubt),
        None => Ok(Expression::new(function, value, &meanings)),
    }
}

pub(crate) fn in_one_line(diagnostic: &Diagnostic) -> String {
    let more = [Some(&diagnostic.at).filter(|text| !text.is_empty()), diagnostic.help.as_ref()];
    let more = more.into_iter().flatten().filter(|text| !diagnostic.message.contains(text.as_str()));
    more.fold(diagnostic.message.clone(), |line, text| line + "; " + text)
}

/// Finds out whether an expression only reads, and what.
struct Check<'a> {
    unit: &'a Unit,
    scope: Scope<'a>,
    items: &'a [&'a str],
    function: &'a Function,
    meanings: BTreeMap<SymbolId, Meaning>,
    count: usize,
    /// The functions of the program, if it may call them and those of the firmware.
    code: Option<&'a BTreeMap<String, GuestAddr>>,
    /// True if it may name locals.
    locals: bool,
    /// True if it names one.
    has_locals: bool,
}

/// The names in an expression.
pub(crate) struct Named {
    /// The meanings of its names outside the function.
    pub(crate) meanings: BTreeMap<SymbolId, Meaning>,
    /// True if it names locals of the function.
    pub(crate) has_locals: bool,
}

/// Resolves the names in an expression of a function; it may name the function's locals.
pub(crate) fn meanings(
    unit: &Unit,
    function: usize,
    value: ExprId,
    symbols: &BTreeMap<String, GuestAddr>,
    code: Option<&BTreeMap<String, GuestAddr>>,
    options: &Options,
    items: &[&str],
) -> Result<Named, String> {
    let scope = Scope { path: Path::new(""), text: &[], symbols, options, files: &Disk };
    let function = unit.functions.get(function).ok_or("not an expression")?;
    let meanings = BTreeMap::new();
    let mut check =
        Check { unit, scope, items, function, meanings, count: 0, code, locals: true, has_locals: false };
    check.expr(value)?;
    Ok(Named { meanings: check.meanings, has_locals: check.has_locals })
}

impl Check<'_> {
    fn expr(&mut self, id: ExprId) -> Result<(), String> {
        self.count += 1;
        if self.count > MOST {
            return Err(format!("it has more than {MOST} operators and operands"));
        }
        let function = self.function;
        match &function.exprs[id].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => Ok(()),
            ExprKind::Load(place) | ExprKind::Address(place) => self.place(*place),
            ExprKind::Unary(_, a) | ExprKind::Convert(a) => self.expr(*a),
            ExprKind::Binary(_, a, b)
            | ExprKind::Compare(_, a, b)
            | ExprKind::And(a, b)
            | ExprKind::Or(a, b)
            | ExprKind::Comma(a, b) => self.expr(*a).and_then(|()| self.expr(*b)),
            ExprKind::Conditional(a, b, c) => [a, b, c].into_iter().try_for_each(|id| self.expr(*id)),
            ExprKind::Call(call) => self.call(call),
            ExprKind::Assign(..)
            | ExprKind::Update(_)
            | ExprKind::Copy { .. }
            | ExprKind::Clear(_)
            | ExprKind::VaArg(_)
            | ExprKind::Statements(..) => {
                Err("it changes something; an expression that is watched only reads".to_owned())
            }
        }
    }

    fn place(&mut self, id: PlaceId) -> Result<(), String> {
        match self.function.places[id].kind {
            PlaceKind::Local(..) if self.locals => {
                self.has_locals = true;
                Ok(())
            }
            PlaceKind::Local(..) => Err("it declares variables".to_owned()),
            PlaceKind::Symbol(symbol, offset) => {
                let entry = &self.unit.symbols[symbol];
                let size = self.unit.types.size_of(entry.ty);
                if size.is_some_and(|size| offset < 0 || offset.unsigned_abs() >= size) {
                    return Err(format!("it reads beyond the end of `{}`", entry.name));
                }
                self.symbol(symbol)
            }
            PlaceKind::Pointer(pointer, _) => self.expr(pointer),
            PlaceKind::Bits(unit, _) => self.place(unit),
        }
    }

    /// Resolves a variable.
    fn symbol(&mut self, id: SymbolId) -> Result<(), String> {
        let name = self.unit.symbols[id].name.as_str();
        let item = self.items.iter().position(|item| *item == name).map(Meaning::Item);
        let program = || self.scope.symbols.get(name).copied().map(Meaning::Variable);
        let firmware = || self.scope.options.firmware.find(name);
        let firmware = || firmware().filter(|symbol| symbol.kind == FirmwareKind::Variable);
        let meaning = item
            .or_else(program)
            .or_else(|| Some(Meaning::Variable(firmware()?.address)))
            .ok_or_else(|| format!("`{name}` is not in the linked program, as nothing uses it"))?;
        self.meanings.insert(id, meaning);
        Ok(())
    }

    fn call(&mut self, call: &Call) -> Result<(), String> {
        let known = || FUNCTIONS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        if let (Callee::Symbol(id), [argument]) = (call.callee, call.arguments.as_slice()) {
            let name = &self.unit.symbols[id].name;
            if let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| known == name) {
                self.meanings.insert(id, Meaning::Function(*function));
                return self.expr(*argument);
            }
        }
        match (self.code, call.callee) {
            (Some(code), Callee::Symbol(id)) => self.executed_call(code, id, call),
            (Some(_), Callee::Pointer(_)) => {
                Err("a function that is called from an expression is called by its name".to_owned())
            }
            (None, _) => {
                Err(format!("an expression can call only {}; `bit46` is the level of a bit", known()))
            }
        }
    }

    /// Resolves the call of a function that the board executes.
    fn executed_call(
        &mut self,
        code: &BTreeMap<String, GuestAddr>,
        id: SymbolId,
        call: &Call,
    ) -> Result<(), String> {
        let name = self.unit.symbols[id].name.as_str();
        if call.variable.is_some() {
            return Err(format!(
                "`{name}` takes a variable number of arguments: an expression cannot call it"
            ));
        }
        let firmware = || self.scope.options.firmware.find(name);
        let firmware = || firmware().filter(|symbol| matches!(symbol.kind, FirmwareKind::Function(_)));
        let address = code.get(name).copied().or_else(|| Some(firmware()?.address));
        let is_defined = self.unit.functions.iter().any(|function| function.symbol == id);
        let address = address.ok_or_else(|| {
            if is_defined {
                format!("`{name}` has no code of its own here: its calls are inlined, or it is not used; with -O0 it has some")
            } else {
                format!("there is no function `{name}`")
            }
        })?;
        self.meanings.insert(id, Meaning::Code(address));
        call.arguments.iter().try_for_each(|argument| self.expr(*argument))
    }
}

/// A memory that cannot be read.
#[derive(Default)]
struct NoMemory {
    was_read: Cell<bool>,
}

impl ItemReader for NoMemory {
    fn bytes(&self, _: GuestAddr) -> [u8; 8] {
        self.was_read.set(true);
        [0; 8]
    }

    fn item(&self, _: usize) -> f64 {
        self.was_read.set(true);
        0.0
    }
}

impl Expression {
    /// The value of a function's expression; its names refer to these.
    pub(crate) fn new(function: Function, value: ExprId, meanings: &BTreeMap<SymbolId, Meaning>) -> Self {
        let builder = Builder { function: &function, meanings };
        let root = builder.node(value);
        let place = stored_place(&function, value).map(|place| match function.places[place].kind {
            PlaceKind::Bits(unit, _) => builder.place(unit),
            PlaceKind::Symbol(..) | PlaceKind::Pointer(..) | PlaceKind::Local(..) => builder.place(place),
        });
        Self { function, value, root, place }
    }

    /// The function around it.
    pub(crate) const fn function(&self) -> &Function {
        &self.function
    }

    /// The value now; `None` where it divides an integer by 0 or reads what has no value.
    pub(crate) fn constant<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<Constant> {
        self.root.value(reader)
    }

    /// Returns whether the value now is not 0; `None` as for [`constant`](Self::constant).
    pub(crate) fn truth<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<bool> {
        self.root.truth(reader)
    }

    /// The value now; not a number where it divides an integer by 0.
    #[must_use]
    pub fn value(&self, reader: &dyn ItemReader) -> f64 {
        match self.constant(reader) {
            Some(Constant::Float(value)) => value,
            Some(Constant::Int(value)) => value as f64,
            None => f64::NAN,
        }
    }

    /// The address and the bytes with which a value is stored in it; `None` unless it is a place in memory. The value
    /// is converted to the place's type as by an assignment.
    #[must_use]
    pub fn store(&self, value: f64, reader: &dyn ItemReader) -> Option<(GuestAddr, Vec<u8>)> {
        let place = self.stored_place()?;
        let ty = self.function.places[place].ty;
        let address = self.place.as_ref()?.address(reader)?;
        let PlaceKind::Bits(unit, range) = self.function.places[place].kind else {
            return Some((address, bytes_of(value, ty)));
        };
        let mask = ((1_u64 << range.width) - 1) << range.shift;
        let word = u64::from_le_bytes(reader.bytes(address));
        let word = word & !mask | (value as i64).cast_unsigned() << range.shift & mask;
        let size = size_of(self.function.places[unit].ty);
        Some((address, word.to_le_bytes().into_iter().take(size).collect()))
    }

    /// The variable that it is, an `int`, `float` or `double` whose address does not depend on memory, as the board's data
    /// recorder knows it; `None` of anything else.
    #[must_use]
    pub fn recorded(&self) -> Option<(GuestAddr, GatherType)> {
        let place = self.stored_place()?;
        let kind = match self.function.places[place].ty {
            Types::DOUBLE => GatherType::Double,
            Types::FLOAT => GatherType::Float,
            Types::INT => GatherType::Int,
            _ => return None,
        };
        let memory = NoMemory::default();
        let address = self.place.as_ref()?.address(&memory)?;
        (!memory.was_read.get()).then_some((address, kind))
    }

    /// Reports whether a value can be stored in it, by its form.
    #[must_use]
    pub const fn is_place(&self) -> bool {
        matches!(self.place, Some(Place::Fixed(_) | Place::Pointed(..) | Place::Local(..)))
    }

    /// The least and the greatest value of the integer that is stored in it; `None` of anything else.
    #[must_use]
    pub fn limits(&self) -> Option<(f64, f64)> {
        let place = &self.function.places[self.stored_place()?];
        if place.ty == Types::BOOL || place.ty.is_floating() {
            return None;
        }
        let width = match place.kind {
            PlaceKind::Bits(_, range) => u32::from(range.width),
            PlaceKind::Symbol(..) | PlaceKind::Local(..) | PlaceKind::Pointer(..) => {
                8 * size_of(place.ty) as u32
            }
        };
        let is_signed =
            place.ty != Types::UNSIGNED_LONG_LONG && constants::truncate_to_type(-1, place.ty) < 0;
        let span = libm::ldexp(1.0, width.cast_signed());
        Some(if is_signed { (-span / 2.0, span / 2.0 - 1.0) } else { (0.0, span - 1.0) })
    }

    fn stored_place(&self) -> Option<PlaceId> {
        stored_place(&self.function, self.value)
    }
}

/// The place that an expression is, below the conversion of what is read from it.
fn stored_place(function: &Function, value: ExprId) -> Option<PlaceId> {
    let kind = |id: ExprId| &function.exprs[id].kind;
    let read = match kind(value) {
        ExprKind::Convert(inner) => kind(*inner),
        other => other,
    };
    if let ExprKind::Load(place) = read { Some(*place) } else { None }
}

/// The value that the first of these bytes are in memory; pointers are unsigned.
pub(crate) fn read(ty: TypeId, bytes: [u8; 8]) -> Constant {
    let all = i64::from_le_bytes(bytes);
    match ty {
        Types::DOUBLE => Constant::Float(f64::from_le_bytes(bytes)),
        Types::FLOAT => Constant::Float(f32::from_bits(all as u32).into()),
        _ => Constant::Int(constants::truncate_to_type(all, ty)),
    }
}

/// A value as memory holds it; a value that is not a number is stored as 0.
fn bytes_of(value: f64, ty: TypeId) -> Vec<u8> {
    match ty {
        Types::DOUBLE => value.to_le_bytes().into(),
        Types::FLOAT => (value as f32).to_le_bytes().into(),
        Types::BOOL => vec![u8::from(value != 0.0)],
        _ => (value as i64).to_le_bytes().into_iter().take(size_of(ty)).collect(),
    }
}

/// A value as a register holds it.
fn slot_of(value: Constant, ty: TypeId) -> u64 {
    match value {
        Constant::Float(value) if ty == Types::FLOAT => (value as f32).to_bits().into(),
        Constant::Float(value) => value.to_bits(),
        Constant::Int(value) if size_of(ty) == 8 => value.cast_unsigned(),
        Constant::Int(value) => u64::from(value as u32),
    }
}

/// Bytes of a number or a pointer.
pub(crate) fn size_of(ty: TypeId) -> usize {
    match ty {
        Types::BOOL | Types::CHAR | Types::SIGNED_CHAR | Types::UNSIGNED_CHAR => 1,
        Types::SHORT | Types::UNSIGNED_SHORT => 2,
        Types::LONG_LONG | Types::UNSIGNED_LONG_LONG | Types::DOUBLE => 8,
        _ => 4,
    }
}

/// A bit-field of a word of type `ty`.
pub(crate) fn bits(word: i64, range: BitRange, ty: TypeId) -> i64 {
    let above = 64 - u32::from(range.width);
    let raised = word << (above - u32::from(range.shift));
    match ty {
        Types::BOOL | Types::UNSIGNED | Types::UNSIGNED_CHAR | Types::UNSIGNED_SHORT => {
            (raised.cast_unsigned() >> above).cast_signed()
        }
        _ => raised >> above,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pp::Disk;

    const PROGRAM: &str = "\
#include \"KMotionDef.h\"
#define SPINDLE 2
int count;
double table[3];
struct { unsigned low : 3; int high : 4; } fields;
char *text;
main() { int local; }
";

    /// A memory in which every byte is the lowest of its address, and items that count from 100.
    struct Pattern;

    impl ItemReader for Pattern {
        fn bytes(&self, address: GuestAddr) -> [u8; 8] {
            match address.get() {
                0x8005_0000 => 7_i64.to_le_bytes(),
                0x8005_0010 => 2.5_f64.to_le_bytes(),
                0x8005_0020 => 0b110_1011_i64.to_le_bytes(),
                _ => [0; 8],
            }
        }

        fn item(&self, index: usize) -> f64 {
            100.0 + index as f64
        }
    }

    fn symbols() -> BTreeMap<String, GuestAddr> {
        let symbols = [("count", 0x8005_0000), ("table", 0x8005_0008), ("fields", 0x8005_0020)];
        symbols.into_iter().map(|(name, at)| (name.to_owned(), GuestAddr::new(at))).collect()
    }

    fn scope<'a>(symbols: &'a BTreeMap<String, GuestAddr>, options: &'a Options) -> Scope<'a> {
        Scope { path: Path::new("a.c"), text: PROGRAM.as_bytes(), symbols, options, files: &Disk }
    }

    fn check(expression: &str, expect: Result<f64, &str>) {
        let symbols = symbols();
        let value = compile(scope(&symbols, &Options::default()), expression, &["bit46"]);
        let value = value.map(|compiled| compiled.value(&Pattern));
        assert_eq!(value, expect.map_err(str::to_owned), "{expression}");
    }

    #[test]
    fn expressions_mean_the_same_as_in_the_program() {
        check("count", Ok(7.0));
        check("count / 2 + SPINDLE", Ok(5.0));
        check("count / 2.0", Ok(3.5));
        check("table[1] * 2 > 4 && !0", Ok(1.0));
        check("-count & 0xff", Ok(249.0));
        check("fields.low", Ok(3.0));
        check("fields.high", Ok(-3.0));
        check("bit46 ? fabs(-table[1]) : 0", Ok(2.5));
        check("chan[SPINDLE].Dest - chan[0].Position", Ok(0.0));
        check("*(int *)0x80050000", Ok(7.0));
    }

    #[test]
    fn a_stored_value_takes_the_type_of_its_place() {
        for (expression, value, expect) in [
            ("count", -2.9, Some((0x8005_0000, (-2_i32).to_le_bytes().to_vec()))),
            ("table[1]", 0.5, Some((0x8005_0010, 0.5_f64.to_le_bytes().to_vec()))),
            ("fields.high", 2.0, Some((0x8005_0020, vec![0b001_0011, 0, 0, 0]))),
            ("*(short *)0x80050000", 70000.0, Some((0x8005_0000, 4464_i16.to_le_bytes().to_vec()))),
            ("count + 1", 1.0, None),
            ("(int)table[0]", 1.0, None),
            ("bit46", 1.0, None),
            ("7", 1.0, None),
        ] {
            let symbols = symbols();
            let compiled = compile(scope(&symbols, &Options::default()), expression, &["bit46"]);
            let stored = compiled.expect(expression).store(value, &Pattern);
            assert_eq!(stored.map(|(at, bytes)| (at.get(), bytes)), expect, "{expression}");
        }
    }

    #[test]
    fn a_place_knows_the_limits_of_its_type() {
        for (expression, expect) in [
            ("count", Some(Some((-2_147_483_648.0, 2_147_483_647.0)))),
            ("table[1]", Some(None)),
            ("fields.low", Some(Some((0.0, 7.0)))),
            ("fields.high", Some(Some((-8.0, 7.0)))),
            ("*(unsigned short *)0x80050000", Some(Some((0.0, 65_535.0)))),
            ("count + 1", None),
            ("bit46", None),
        ] {
            let symbols = symbols();
            let compiled = compile(scope(&symbols, &Options::default()), expression, &["bit46"]);
            let compiled = compiled.expect(expression);
            assert_eq!(compiled.is_place().then(|| compiled.limits()), expect, "{expression}");
        }
    }

    #[test]
    fn errors_in_an_expression_are_explained() {
        check("conut", Err("`conut` is not declared; did you mean `count`?"));
        check("count = 5", Err("it changes something; an expression that is watched only reads"));
        check(
            "local",
            Err(
                "`local` is not declared; declare the variable before the functions that use it, outside them",
            ),
        );
        check("count +", Err("expected an expression, found `)`"));
        check("chan[0].Dst", Err("`CHAN` has no member `Dst`; did you mean `Dest`?"));
        check("", Err("expected an expression, found `)`"));
        check("chan[9].Dest", Err("it reads beyond the end of `chan`"));
        check("table[3]", Err("it reads beyond the end of `table`"));
        check("persist.UserData[200]", Err("it reads beyond the end of `persist`"));
        check(
            "Move(0, 1)",
            Err(
                "an expression can call only fabs, sqrt, floor, ceil, sin, cos; `bit46` is the level of a bit",
            ),
        );
        check("text[0]", Err("`text` is not in the linked program, as nothing uses it"));
    }
}
