//! The typed tree: every expression has a type, every conversion is explicit.
//!
//! Implicit rules of C are explicit here: arrays have become pointers, operands have their common type, compound
//! assignments name the type of the computation, pointer steps are in bytes, initialisers are bytes or stores. Lowering
//! needs no knowledge of C's rules.
//!
//! Values and places are different things: an expression computes a value, a [`Place`] names
//! storage. A value of structure type exists only as the source of a copy, see
//! [`ExprKind::Copy`].
//!
//! Left to right is the order of evaluation everywhere.

use cranelift_entity::PrimaryMap;
use kmotiondef::firmware::Function as FirmwareCall;

use crate::index::index;
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::{BitRange, FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types};

index! {
    /// A name with linkage, or an anonymous static object.
    SymbolId, "symbol";
    /// An expression of a function.
    ExprId, "expr";
    /// A place of a function.
    PlaceId, "place";
    /// A local variable, parameter or temporary of a function.
    LocalId, "local";
    /// A label of a function that `goto` can reach.
    LabelId, "label";
}

/// A translation unit.
#[derive(Debug)]
pub struct Unit {
    /// The types that the tree refers to.
    pub types: Types,
    /// Everything that has an address at link time.
    pub symbols: PrimaryMap<SymbolId, Symbol>,
    /// The functions defined here, in the order of their definitions.
    pub functions: Vec<Function>,
    /// The functions that divide, if the firmware's do and not the operators of the machine.
    pub divisions: Option<Divisions>,
}

/// The functions of the firmware that divide floating numbers.
#[derive(Clone, Copy, Debug)]
pub struct Divisions {
    /// That of `float`.
    pub single: SymbolId,
    /// That of `double`.
    pub double: SymbolId,
}

impl Unit {
    /// Makes floating-point divisions use the firmware's functions from now on.
    pub fn divide_by_firmware(&mut self) {
        let Some(span) = self.functions.first().map(|function| function.span) else { return };
        let single = self.division(FirmwareCall::_divf, Types::FLOAT, span);
        let double = self.division(FirmwareCall::_divd, Types::DOUBLE, span);
        self.divisions = Some(Divisions { single, double });
    }

    /// The symbol of a function that divides numbers of a type, new if the program does not declare it.
    fn division(&mut self, function: FirmwareCall, number: TypeId, span: Span) -> SymbolId {
        let name = function.name();
        let mut symbols = self.symbols.iter();
        let declared = symbols.find(|(_, symbol)| symbol.name == name && symbol.linkage == Linkage::External);
        if let Some((declared, _)) = declared {
            return declared;
        }
        let types = vec![QualifiedType::plain(number); 2];
        let parameters = ParameterTypes::Prototype { types, is_variadic: false };
        let ty = self.types.intern(Type::Function(FunctionType { result: number, parameters }));
        self.symbols.push(Symbol {
            name: name.to_owned(),
            linkage: Linkage::External,
            ty,
            align: 1,
            definition: Definition::None,
            span,
            used_at: None,
        })
    }

    /// Reports whether a function of this name is defined here.
    #[must_use]
    pub fn defines(&self, name: &str) -> bool {
        self.functions.iter().any(|function| self.symbols[function.symbol].name == name)
    }
}

/// A function or object with an address at link time.
#[derive(Debug)]
pub struct Symbol {
    /// The name; for anonymous objects one that no program can spell (`L.3`).
    pub name: String,
    /// Its linkage: internal or external.
    pub linkage: Linkage,
    /// The type.
    pub ty: TypeId,
    /// Alignment that a declaration requests; the type may need more.
    pub align: u32,
    /// Its definition.
    pub definition: Definition,
    /// The defining declaration, otherwise the first one.
    pub span: Span,
    /// The first use that needs the address, for link errors.
    pub used_at: Option<Span>,
}

impl Symbol {
    /// Reports whether it is an object without a name, such as a string literal.
    #[must_use]
    pub fn is_anonymous(&self) -> bool {
        self.name.starts_with("L.")
    }
}

/// Linkage of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linkage {
    /// Seen by other units.
    External,
    /// `static`, or anonymous.
    Internal,
}

/// The definition of a symbol in this unit.
#[derive(Debug)]
pub enum Definition {
    /// Declared only: it is defined by another unit, the firmware or the library.
    None,
    /// A function of this unit; its body is in [`Unit::functions`].
    Function,
    /// An object without initialiser: `.bss`, merged with tentative definitions elsewhere.
    Tentative,
    /// An object with an initialiser: `.data`.
    Data(StaticData),
}

/// The bytes of an initialised object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StaticData {
    /// As many bytes as the object has; more than its type's size if a flexible array is initialised.
    pub bytes: Vec<u8>,
    /// Addresses that the linker adds into 32-bit words, ascending by offset.
    pub addresses: Vec<AddressWord>,
}

/// A word that holds the address of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AddressWord {
    /// Offset in the object.
    pub offset: u32,
    /// The symbol whose address is stored.
    pub symbol: SymbolId,
    /// Bytes to add to it.
    pub addend: i32,
}

/// Parameters that the source does not write.
#[derive(Clone, Copy, Debug, Default)]
pub struct HiddenParameters {
    /// For a variadic function, the last parameter: address of the variable arguments.
    pub variable_arguments: Option<LocalId>,
    /// For a structure result, the first parameter: where to store it.
    pub result_pointer: Option<LocalId>,
}

/// A function with a body.
#[derive(Debug)]
pub struct Function {
    /// Its symbol.
    pub symbol: SymbolId,
    /// Its type. A function of type `void` that returns a value somewhere has the result `int` here.
    pub ty: FunctionType,
    /// Parameters in order. A structure parameter's local holds the caller's copy; see [`Local::by_pointer`].
    pub parameters: Vec<LocalId>,
    /// The parameters that are passed in addition to the declared ones.
    pub hidden: HiddenParameters,
    /// Parameters, variables and temporaries.
    pub locals: PrimaryMap<LocalId, Local>,
    /// Expressions.
    pub exprs: PrimaryMap<ExprId, Expr>,
    /// Places.
    pub places: PrimaryMap<PlaceId, Place>,
    /// Labels, by their number.
    pub labels: PrimaryMap<LabelId, Label>,
    /// The body.
    pub body: Vec<Stmt>,
    /// The function's name in its definition.
    pub span: Span,
    /// The closing brace, where a function that falls off its end returns 0.
    pub end: Span,
    /// True if an error was reported in it: parts of the body are missing.
    pub has_errors: bool,
}

impl Function {
    /// All calls, including those in operands that are not evaluated.
    pub fn calls(&self) -> impl Iterator<Item = (&Expr, &Call)> {
        self.exprs.values().filter_map(|expr| match &expr.kind {
            ExprKind::Call(call) => Some((expr, call)),
            _ => None,
        })
    }

    /// Returns an expression without the conversions of its value.
    #[must_use]
    pub fn unconverted(&self, mut expr: ExprId) -> ExprId {
        while let ExprKind::Convert(inner) = self.exprs[expr].kind {
            expr = inner;
        }
        expr
    }

    /// Visits every statement of the body, outer ones first, except those in statement expressions.
    pub fn each_stmt<'f>(&'f self, visit: &mut dyn FnMut(&'f Stmt)) {
        fn visit_stmts<'f>(stmts: &'f [Stmt], visit: &mut dyn FnMut(&'f Stmt)) {
            for stmt in stmts {
                visit(stmt);
                stmt.lists().for_each(|inner| visit_stmts(inner, visit));
            }
        }
        visit_stmts(&self.body, visit);
    }

    /// Visits every list of statements of the body, outer ones first, except those in statement expressions.
    pub fn each_list<'f>(&'f self, visit: &mut dyn FnMut(&'f [Stmt])) {
        fn visit_lists<'f>(stmts: &'f [Stmt], visit: &mut dyn FnMut(&'f [Stmt])) {
            visit(stmts);
            stmts.iter().flat_map(Stmt::lists).for_each(|inner| visit_lists(inner, visit));
        }
        visit_lists(&self.body, visit);
    }
}

/// A local object.
#[derive(Debug)]
pub struct Local {
    /// Its name; empty for a temporary.
    pub name: String,
    /// Its type.
    pub ty: TypeId,
    /// Alignment that its declaration requests; the type may need more.
    pub align: u32,
    /// True if it needs memory: its address is taken, it is an array or a structure, or it is volatile.
    pub in_memory: bool,
    /// True for a structure parameter: the incoming register holds the address of the caller's copy.
    pub by_pointer: bool,
    /// The range of its declaration.
    pub span: Span,
}

/// A label.
#[derive(Debug)]
pub struct Label {
    /// Its name.
    pub name: String,
    /// Its range in the source.
    pub span: Span,
    /// The number that is the value of `&&label` and by which [`StmtKind::GotoAddress`] finds it, counted from 1.
    pub address: Option<u32>,
}

/// A statement.
#[derive(Debug)]
pub struct Stmt {
    /// The kind of statement.
    pub kind: StmtKind,
    /// The source line that a trap inside it names.
    pub span: Span,
}

impl Stmt {
    /// The lists of statements in it.
    pub fn lists(&self) -> impl Iterator<Item = &[Stmt]> {
        let (first, second) = match &self.kind {
            StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => {
                (Some(body), None)
            }
            StmtKind::If { then, otherwise, .. } => (Some(then), Some(otherwise)),
            _ => (None, None),
        };
        first.into_iter().chain(second).map(Vec::as_slice)
    }
}

/// The kinds of statement.
#[derive(Debug)]
pub enum StmtKind {
    /// Evaluates and drops a value.
    Expr(ExprId),
    /// Statements one after another.
    Block(Vec<Stmt>),
    /// Branches on a zero or nonzero value of integer, pointer or floating type.
    If {
        /// The condition.
        condition: ExprId,
        /// Executed when it is not zero.
        then: Vec<Stmt>,
        /// Executed otherwise.
        otherwise: Vec<Stmt>,
    },
    /// Any loop: `while (condition) { body; step; }`, the first test left out for `do`.
    Loop {
        /// The condition, tested before or after each iteration; `None` is true.
        condition: Option<ExprId>,
        /// The time of the test.
        test: LoopTest,
        /// The body; `continue` skips the rest of it.
        body: Vec<Stmt>,
        /// Evaluated after the body.
        step: Option<ExprId>,
    },
    /// Chooses among the cases of the body.
    Switch {
        /// The value, of integer type.
        value: ExprId,
        /// The cases in the order of the body, each with the number its [`StmtKind::Case`] has.
        cases: Vec<Case>,
        /// True if the body has [`StmtKind::DefaultCase`].
        has_default: bool,
        /// The body.
        body: Vec<Stmt>,
    },
    /// The place of case number `n` of the innermost switch.
    Case(u32),
    /// The place for values without a case.
    DefaultCase,
    /// Leaves the innermost loop or switch.
    Break,
    /// Jumps to the end of the innermost loop's body.
    Continue,
    /// Returns. The value has the type of the function's result; a structure has been copied to the result pointer by
    /// an earlier statement.
    Return(Option<ExprId>),
    /// The place of a label.
    Label(LabelId),
    /// Jumps to a label.
    Goto(LabelId),
    /// Jumps to the label with this [`Label::address`].
    GotoAddress(ExprId),
}

/// The time at which a loop tests its condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopTest {
    /// `while`, `for`
    Before,
    /// `do … while`
    Behind,
}

/// A case of a switch: a range of values, equal ends for a single one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The first value, converted to the type of the switch.
    pub first: i64,
    /// The last value.
    pub last: i64,
}

impl Case {
    /// The first and the last value as numbers, in a switch of unsigned or signed type.
    #[must_use]
    pub fn values(self, is_unsigned: bool) -> (i128, i128) {
        let number = |value: i64| match is_unsigned {
            true => i128::from(value.cast_unsigned()),
            false => i128::from(value),
        };
        (number(self.first), number(self.last))
    }
}

/// An expression: a value of a scalar type, or an effect of type `void`.
#[derive(Debug)]
pub struct Expr {
    /// The kind of expression.
    pub kind: ExprKind,
    /// The type of the value.
    pub ty: TypeId,
    /// Its range in the source.
    pub span: Span,
}

/// The kinds of expression.
#[derive(Debug)]
pub enum ExprKind {
    /// An integer or pointer constant, sign- or zero-extended from its type.
    Int(i64),
    /// A floating constant, exact in its type.
    Float(f64),
    /// The value stored in a place.
    Load(PlaceId),
    /// The address of a place.
    Address(PlaceId),
    /// Stores a value of the place's type; its own value is that of the place after the store.
    Assign(PlaceId, ExprId),
    /// `place = place op operand`, the place evaluated once, before the operand.
    Update(Update),
    /// Copies a structure, or a character array from its initialiser, `memmove`; of type `void`.
    Copy {
        /// The destination.
        to: PlaceId,
        /// The source.
        from: PlaceId,
    },
    /// Fills a local with zeros, before its partial initialiser; of type `void`.
    Clear(PlaceId),
    /// A unary operator on a value of the same type.
    Unary(UnaryOp, ExprId),
    /// A binary operator; operands and result have one type (shift counts are `int`).
    Binary(BinaryOp, ExprId, ExprId),
    /// A comparison of two values of one type; the result is `int` 0 or 1.
    Compare(CompareOp, ExprId, ExprId),
    /// `a && b` of values that are zero or not; `int` 0 or 1.
    And(ExprId, ExprId),
    /// `a || b`, in the same way.
    Or(ExprId, ExprId),
    /// `condition ? a : b`, both of the result's type or both `void`.
    Conditional(ExprId, ExprId, ExprId),
    /// Evaluates the first, then the second, and has the value of the second.
    Comma(ExprId, ExprId),
    /// Converts to the expression's type; to `void` drops the value.
    Convert(ExprId),
    /// Calls a function. Scalar arguments have the types of the parameters; a structure argument is the
    /// address of a temporary copy. For a structure result, argument 0 is the address of the temporary that
    /// receives it, and the call is of type `void`.
    Call(Call),
    /// `va_arg`: loads a value from the address in the `char *` of the list place, aligned to its size (4 or 8), and
    /// advances the `char *`.
    VaArg(PlaceId),
    /// The value of a local initialised by the statements: a GNU statement expression. The value, if any, is that of
    /// the last expression.
    Statements(Vec<Stmt>, Option<ExprId>),
}

/// `place = (type of place)((computed)place op operand)`
#[derive(Debug)]
pub struct Update {
    /// The place that is changed.
    pub place: PlaceId,
    /// The operator.
    pub op: BinaryOp,
    /// The other operand, of type `computed` (`int` for a shift). For pointers a byte count, as `int`.
    pub operand: ExprId,
    /// The type of the computation; for pointers, the place's own type.
    pub computed: TypeId,
    /// The value of the expression.
    pub result: UpdateResult,
}

/// The value of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdateResult {
    /// `++a`, `a += b`
    New,
    /// `a++`
    Old,
}

/// A call.
#[derive(Debug)]
pub struct Call {
    /// The function.
    pub callee: Callee,
    /// The type to which the arguments were converted; its parameters are never `Unspecified`.
    pub ty: FunctionType,
    /// All arguments passed in registers, including hidden ones but not variable ones.
    pub arguments: Vec<ExprId>,
    /// The variable part, promoted. Lowering stores it in the frame and passes its address last.
    pub variable: Option<Vec<ExprId>>,
}

/// The target of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Callee {
    /// A function by name.
    Symbol(SymbolId),
    /// A function by address.
    Pointer(ExprId),
}

/// Unary operators on numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-a`
    Negate,
    /// `~a`
    Complement,
    /// `a == 0`, of type `int` for any operand type
    Not,
}

/// Storage.
#[derive(Debug)]
pub struct Place {
    /// The storage.
    pub kind: PlaceKind,
    /// The type of what is stored.
    pub ty: TypeId,
    /// Its range in the source.
    pub span: Span,
}

/// The kinds of place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceKind {
    /// A local, or a part of one at a byte offset: always inside it, of any type if the local is in memory.
    Local(LocalId, u32),
    /// A symbol plus a byte offset.
    Symbol(SymbolId, i32),
    /// The target of a pointer, plus a byte offset.
    Pointer(ExprId, i32),
    /// A bit-field: the storage unit's place has the declared type.
    Bits(PlaceId, BitRange),
}
