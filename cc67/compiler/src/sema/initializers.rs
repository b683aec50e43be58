//! Initialisers: assigns each value to a part of an object.
//!
//! A list, nested or not, designated or not, is flattened into [`Leaf`]s: offset, type, value. A stack of levels gives
//! the position of the next value; braces start a new stack, and a value that does not initialise an aggregate as a
//! whole opens a level for it. Leaves become bytes of static objects, or stores to locals.

use super::Sema;
use super::conversions::AssignmentTarget;
use super::literals::string_bytes;
use super::operands::Operand;
use super::places::TypedPlace;
use crate::ast::{
    Expression, ExpressionKind, Initializer, InitializerItem, RecordKind, StringLiteral, TypeName,
};
use crate::diag::{Diagnostic, Lint};
use crate::lints::vendor;
use crate::source::Span;
use crate::ty::{BitRange, QualifiedType, RecordId, Type, TypeId, Types};
use crate::typed::{ExprId, ExprKind, LocalId, PlaceId, PlaceKind, StaticData};

/// More values than one object can take: the board has no room for them.
pub const MAX_VALUES: usize = 1 << 20;

/// A value and the part of the object that it initialises.
#[derive(Debug)]
pub(super) struct Leaf {
    /// Byte offset in the object.
    pub(super) offset: u32,
    /// Type of the part.
    pub(super) ty: TypeId,
    /// Bit-field.
    pub(super) bits: Option<BitRange>,
    /// The value.
    pub(super) value: LeafValue,
    /// The range of the value in the source.
    pub(super) span: Span,
}

/// The value of a [`Leaf`].
#[derive(Debug)]
pub(super) enum LeafValue {
    /// A scalar of the part's type.
    Scalar(ExprId),
    /// A whole structure.
    Record(PlaceId),
    /// All bytes of a character array.
    Text(Vec<u8>),
}

/// A part of the object that a value can initialise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) ty: QualifiedType,
    offset: u32,
    bits: Option<BitRange>,
}

/// The shape of an aggregate.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    Array { element: QualifiedType, length: Option<u32>, size: u32 },
    Record { record: RecordId, kind: RecordKind },
}

/// An aggregate that is being filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct AggregateLevel {
    pub(super) slot: Slot,
    pub(super) shape: Shape,
    /// Number of the next element or member.
    pub(super) next: u32,
}

/// The part of an aggregate that a list has initialised so far.
struct InitializedRange {
    /// The number of its first leaf.
    first: usize,
    /// Number of leaves that `end` covers.
    seen: usize,
    /// The last byte, plus one, at which a value begins.
    end: u32,
}

impl AggregateLevel {
    pub(super) fn advance(&mut self) {
        self.next = match self.shape {
            // Only one member of a union is initialised.
            Shape::Record { kind: RecordKind::Union, .. } => u32::MAX,
            _ => self.next.saturating_add(1),
        };
    }
}

impl Sema<'_> {
    /// The initialiser of an object with a fixed address: its completed type and its bytes.
    pub(super) fn static_initializer(
        &mut self,
        ty: QualifiedType,
        initializer: &Initializer,
        span: Span,
    ) -> Option<(TypeId, StaticData)> {
        let (complete, leaves) = self.flatten(ty, initializer, span)?;
        let data = self.static_data(complete, &leaves, span)?;
        Some((complete, data))
    }

    /// The initialiser of a local: its completed type and the stores to make.
    pub(super) fn local_initializer(
        &mut self,
        local: LocalId,
        ty: QualifiedType,
        initializer: &Initializer,
        span: Span,
    ) -> Option<(TypeId, Vec<ExprId>)> {
        let (complete, leaves) = self.flatten(ty, initializer, span)?;
        self.complete_local(local, complete);
        let size = self.types.size_of(complete)?;
        if leaves.iter().any(|leaf| self.types.size_of(leaf.ty).is_some_and(|part| leaf.offset + part > size))
        {
            self.report(Diagnostic::error(
                span,
                "a flexible array can only be initialised in a static object",
            ));
            return None;
        }
        let whole = self.local_place(local, QualifiedType { ty: complete, ..ty }, span);
        Some((complete, self.stores(whole, &leaves, span)))
    }

    /// `(type) { … }`: an anonymous local, or a static object at file scope.
    pub(super) fn compound_literal(
        &mut self,
        name: &TypeName,
        items: &[InitializerItem],
        span: Span,
    ) -> Option<Operand> {
        let ty = self.type_name(name)?;
        let mut leaves = Vec::new();
        let complete = self.flatten_list(&mut leaves, ty, items, span)?;
        if !self.types.is_object(complete) {
            let message = format!("a compound literal cannot have the type `{}`", self.spell(complete));
            self.report(Diagnostic::error(span, message));
            return None;
        }
        let qualified = QualifiedType { ty: complete, ..ty };
        if self.body.name.is_empty() {
            let data = self.static_data(complete, &leaves, span)?;
            let symbol = self.symbols.anonymous(complete, data, span);
            return Some(Operand::Place(self.symbol_place(symbol, qualified, span)));
        }
        Some(self.anonymous_local(qualified, &leaves, span))
    }

    /// A value for `to` in a union that has such a member: the GNU cast to a union.
    pub(super) fn union_of(&mut self, value: ExprId, to: TypeId, span: Span) -> Option<Operand> {
        let record = self.types.record_of(to)?;
        let ty = self.body.ty(value);
        let is_union = self.types.record(record).kind == RecordKind::Union;
        let members = &self.types.record(record).layout.as_ref().filter(|_| is_union)?.members;
        let member = members.iter().find(|member| member.ty.ty == ty && member.bits.is_none())?;
        let leaf = Leaf { offset: member.offset, ty, bits: None, value: LeafValue::Scalar(value), span };
        (!self.body.name.is_empty()).then(|| self.anonymous_local(QualifiedType::plain(to), &[leaf], span))
    }

    /// A local without a name that is initialised at its use.
    fn anonymous_local(&mut self, qualified: QualifiedType, leaves: &[Leaf], span: Span) -> Operand {
        let complete = qualified.ty;
        let local = self.add_local(String::new(), qualified, span);
        let whole = self.local_place(local, qualified, span);
        let stores = self.stores(whole, leaves, span);
        let pointer_type = self.types.pointer_to(complete);
        let address = self.address(whole.place, pointer_type, span);
        let pointer =
            stores.into_iter().rev().fold(address, |pointer, store| self.body.comma(store, pointer, span));
        let place = self.body.place(PlaceKind::Pointer(pointer, 0), complete, span);
        Operand::Place(TypedPlace { place, ty: qualified, is_lvalue: true })
    }

    /// The stores that initialise a local.
    fn stores(&mut self, whole: TypedPlace, leaves: &[Leaf], span: Span) -> Vec<ExprId> {
        let mut stores = Vec::with_capacity(leaves.len() + 1);
        let size = self.types.size_of(whole.ty.ty).unwrap_or(0);
        if !self.covers(leaves, size) {
            stores.push(self.body.expr(ExprKind::Clear(whole.place), Types::VOID, span));
            let values: usize = leaves.iter().filter_map(|leaf| self.parts(leaf.ty)).sum();
            if self.parts(whole.ty.ty).is_none_or(|parts| values < parts) {
                self.report(vendor::partly_initialised(span));
            }
        }
        for leaf in leaves {
            let part = self.part(whole, leaf.offset, QualifiedType::plain(leaf.ty), leaf.span).place;
            let place = match leaf.bits {
                Some(bits) => self.body.place(PlaceKind::Bits(part, bits), leaf.ty, leaf.span),
                None => part,
            };
            stores.push(match &leaf.value {
                LeafValue::Scalar(value) => {
                    self.body.expr(ExprKind::Assign(place, *value), leaf.ty, leaf.span)
                }
                LeafValue::Record(from) => {
                    self.body.expr(ExprKind::Copy { to: place, from: *from }, Types::VOID, leaf.span)
                }
                LeafValue::Text(bytes) => {
                    let data = StaticData { bytes: bytes.clone(), addresses: Vec::new() };
                    let symbol = self.symbols.anonymous(leaf.ty, data, leaf.span);
                    let from = self.symbol_place(symbol, QualifiedType::plain(leaf.ty), leaf.span).place;
                    self.body.expr(ExprKind::Copy { to: place, from }, Types::VOID, leaf.span)
                }
            });
        }
        stores
    }

    /// Number of values that fill an object of this type; one initialises a union.
    fn parts(&self, ty: TypeId) -> Option<usize> {
        if let Some((element, length)) = self.types.array(ty) {
            return self.parts(element.ty)?.checked_mul(usize::try_from(length?).ok()?);
        }
        let Some(record) = self.types.record_of(ty).map(|record| self.types.record(record)) else {
            return Some(1);
        };
        let mut parts = record.layout.as_ref()?.members.iter().map(|member| self.parts(member.ty.ty));
        match record.kind {
            RecordKind::Union => Some(1),
            RecordKind::Struct => parts.try_fold(0_usize, |sum, parts| sum.checked_add(parts?)),
        }
    }

    /// Reports whether the leaves, in their order, leave no byte out.
    fn covers(&self, leaves: &[Leaf], size: u32) -> bool {
        let end = leaves.iter().try_fold(0, |end, leaf| {
            (leaf.offset == end && leaf.bits.is_none()).then_some(end + self.types.size_of(leaf.ty)?)
        });
        end == Some(size)
    }

    /// Flattens an initialiser; the returned type has its array length.
    fn flatten(
        &mut self,
        ty: QualifiedType,
        initializer: &Initializer,
        span: Span,
    ) -> Option<(TypeId, Vec<Leaf>)> {
        let mut leaves = Vec::new();
        let complete = match initializer {
            Initializer::List { items, span } => self.flatten_list(&mut leaves, ty, items, *span)?,
            Initializer::Expression(value) => {
                let slot = Slot { ty, offset: 0, bits: None };
                if let Some((ty, items)) = self.literal_for(ty, value)? {
                    return Some((
                        self.fill_list(&mut leaves, Slot { ty, ..slot }, items, value.span)?,
                        leaves,
                    ));
                }
                match text_of(value).filter(|text| self.takes_text(ty.ty, text)) {
                    Some(text) => self.fill_text(&mut leaves, slot, text, value.span),
                    None if self.types.array(ty.ty).is_some() => {
                        self.report(
                            Diagnostic::error(value.span, "an array needs a list in braces")
                                .help("write `{ … }`"),
                        );
                        return None;
                    }
                    None => {
                        let operand = self.operand(value)?;
                        self.fill_whole(&mut leaves, slot, operand, value.span)?;
                        ty.ty
                    }
                }
            }
        };
        if !self.types.is_object(complete) {
            let message = format!("an object cannot have the type `{}`", self.spell(complete));
            self.report(Diagnostic::error(span, message));
            return None;
        }
        Some((complete, leaves))
    }

    /// Flattens a list in braces for an object of type `ty`.
    fn flatten_list(
        &mut self,
        leaves: &mut Vec<Leaf>,
        ty: QualifiedType,
        items: &[InitializerItem],
        span: Span,
    ) -> Option<TypeId> {
        self.check_defined(ty.ty, span)?;
        self.fill_list(leaves, Slot { ty, offset: 0, bits: None }, items, span)
    }

    fn check_defined(&mut self, ty: TypeId, span: Span) -> Option<()> {
        let record = self.types.record_of(ty).filter(|record| self.types.record(*record).layout.is_none());
        if record.is_some() {
            let message = format!("an object cannot have the incomplete type `{}`", self.spell(ty));
            self.report(Diagnostic::error(span, message));
        }
        record.is_none().then_some(())
    }

    /// Initialises a part from a list in braces; an array without length gets the length that was reached.
    fn fill_list(
        &mut self,
        leaves: &mut Vec<Leaf>,
        slot: Slot,
        items: &[InitializerItem],
        span: Span,
    ) -> Option<TypeId> {
        if let [InitializerItem { designators, initializer: Initializer::Expression(value) }] = items
            && designators.is_empty()
            && let Some(text) = text_of(value).filter(|text| self.takes_text(slot.ty.ty, text))
        {
            return Some(self.fill_text(leaves, slot, text, value.span));
        }
        let Some(level) = self.aggregate_level(slot) else {
            return self.fill_scalar_list(leaves, slot, items, span);
        };
        let mut stack = vec![level];
        let mut reach = 0;
        let mut is_sound = true;
        let mut initialized = InitializedRange { first: leaves.len(), seen: leaves.len(), end: 0 };
        for item in items {
            is_sound &= self.fill_item(leaves, &mut stack, item, &mut initialized).is_some();
            reach = reach.max(stack.first().map_or(0, |level| level.next));
        }
        is_sound.then_some(())?;
        match level.shape {
            Shape::Array { element, length: None, .. } => {
                Some(self.types.intern(Type::Array(element, Some(reach))))
            }
            _ => Some(slot.ty.ty),
        }
    }

    /// `int a = { 5 };`
    fn fill_scalar_list(
        &mut self,
        leaves: &mut Vec<Leaf>,
        slot: Slot,
        items: &[InitializerItem],
        span: Span,
    ) -> Option<TypeId> {
        match items {
            [] => {
                let zero = self.zero_value(slot.ty.ty, span);
                let Slot { ty, offset, bits } = slot;
                leaves.push(Leaf { offset, ty: ty.ty, bits, value: LeafValue::Scalar(zero), span });
            }
            [InitializerItem { designators, initializer }] if designators.is_empty() => match initializer {
                Initializer::Expression(value) => {
                    let operand = self.operand(value)?;
                    self.fill_whole(leaves, slot, operand, value.span)?;
                }
                Initializer::List { items, span } => {
                    return self.fill_scalar_list(leaves, slot, items, *span);
                }
            },
            _ => {
                let message = format!("`{}` takes one value", self.spell(slot.ty.ty));
                self.report(Diagnostic::error(span, message));
                return None;
            }
        }
        Some(slot.ty.ty)
    }

    /// Fills in an item of a list; the value of a range is used several times.
    fn fill_item(
        &mut self,
        leaves: &mut Vec<Leaf>,
        stack: &mut Vec<AggregateLevel>,
        item: &InitializerItem,
        initialized: &mut InitializedRange,
    ) -> Option<()> {
        let mut times = 1;
        if !item.designators.is_empty() {
            stack.truncate(1);
            times = self.follow_designators(stack, &item.designators)?;
        }
        let depth = stack.len();
        let mut kept = None;
        for iteration in 0..times {
            self.check_leaves(leaves)?;
            match &item.initializer {
                Initializer::List { items, span } => {
                    let slot = self.next_slot(stack, *span)?;
                    if let Some(level) = stack.last_mut() {
                        level.advance();
                    }
                    self.replace(leaves, slot, initialized);
                    self.fill_list(leaves, slot, items, *span)?;
                }
                Initializer::Expression(value) => self.fill_expression(leaves, stack, value, initialized)?,
            }
            if times > 1 {
                stack.truncate(depth);
                kept = self.evaluate_once(leaves.last_mut(), kept, iteration == 0);
            }
        }
        Some(())
    }

    /// Drops earlier values of the list for parts of an aggregate, which another initialiser of the whole replaces (C17
    /// 6.7.9, 19).
    fn replace(&self, leaves: &mut Vec<Leaf>, slot: Slot, initialized: &mut InitializedRange) {
        for leaf in leaves.iter().skip(initialized.seen) {
            initialized.end = initialized.end.max(leaf.offset.saturating_add(1));
        }
        initialized.seen = leaves.len();
        if slot.offset >= initialized.end {
            return;
        }
        let end = slot.offset.saturating_add(self.types.size_of(slot.ty.ty).unwrap_or(0));
        let mut index = 0;
        leaves.retain(|leaf| {
            index += 1;
            index <= initialized.first || !(slot.offset..end).contains(&leaf.offset)
        });
        initialized.seen = leaves.len();
    }

    /// Evaluates the value of a range for its first part, and keeps it for the others.
    fn evaluate_once(
        &mut self,
        leaf: Option<&mut Leaf>,
        kept: Option<LocalId>,
        is_first: bool,
    ) -> Option<LocalId> {
        let Some(Leaf { value: LeafValue::Scalar(value), span, .. }) = leaf else { return kept };
        if is_first && !self.body.name.is_empty() && !self.body.is_repeatable(*value) {
            let local = self.body.temporary(self.body.ty(*value), false, *span);
            *value = self.body.store_local(local, *value, *span);
            return Some(local);
        }
        if let Some(local) = kept {
            *value = self.body.load_local(local, *span);
        }
        kept
    }

    /// Limits the number of values, as a range can request any number.
    fn check_leaves(&mut self, leaves: &[Leaf]) -> Option<()> {
        if leaves.len() < MAX_VALUES {
            return Some(());
        }
        let span = leaves.last().map(|leaf| leaf.span)?;
        self.report(Diagnostic::error(span, format!("more than {MAX_VALUES} values in one initialiser")));
        None
    }

    fn too_many(&mut self, ty: TypeId, span: Span) {
        let message = format!("too many initialisers for `{}`", self.spell(ty));
        self.report(Diagnostic::error(span, message));
    }

    /// Puts a value where the stack points, opening levels for aggregates that it does not fill as a whole.
    fn fill_expression(
        &mut self,
        leaves: &mut Vec<Leaf>,
        stack: &mut Vec<AggregateLevel>,
        value: &Expression,
        initialized: &mut InitializedRange,
    ) -> Option<()> {
        let text = text_of(value);
        let mut operand = None;
        loop {
            let slot = self.next_slot(stack, value.span)?;
            if let Some(level) = stack.last_mut() {
                level.advance();
            }
            if let Some(text) = text.filter(|text| self.takes_text(slot.ty.ty, text)) {
                self.fill_text(leaves, slot, text, value.span);
                return Some(());
            }
            let Some(level) = self.aggregate_level(slot) else {
                let operand = match operand {
                    Some(operand) => operand,
                    None => self.operand(value)?,
                };
                return self.fill_whole(leaves, slot, operand, value.span);
            };
            if let Some((ty, items)) = self.literal_for(slot.ty, value)? {
                self.replace(leaves, slot, initialized);
                return self.fill_list(leaves, Slot { ty, ..slot }, items, value.span).map(|_| ());
            }
            if text.is_none() && matches!(level.shape, Shape::Record { .. }) {
                let known = match operand {
                    Some(operand) => operand,
                    None => self.operand(value)?,
                };
                if self.is_record(known) && self.operand_type(known).ty == slot.ty.ty {
                    return self.fill_whole(leaves, slot, known, value.span);
                }
                operand = Some(known);
            }
            stack.push(level);
        }
    }

    /// The list of a compound literal that has the type of the aggregate it initialises: the object is filled from
    /// the list itself, so that a static one may have such an initialiser. `None` outside if that was diagnosed.
    fn literal_for<'e>(
        &mut self,
        ty: QualifiedType,
        value: &'e Expression,
    ) -> Option<Option<(QualifiedType, &'e [InitializerItem])>> {
        let ExpressionKind::CompoundLiteral(name, items) = &value.kind else { return Some(None) };
        if !self.types.is_aggregate(ty.ty) {
            return Some(None);
        }
        let named = self.type_name(name)?.ty;
        let of = match (self.types.array(ty.ty), self.types.array(named)) {
            (Some((own, None)), Some((element, _))) if own.ty == element.ty => Some(named),
            (Some((own, Some(length))), Some((element, count)))
                if own.ty == element.ty && count.is_none_or(|count| count <= length) =>
            {
                Some(ty.ty)
            }
            _ => (named == ty.ty).then_some(named),
        };
        Some(of.map(|of| (QualifiedType { ty: of, ..ty }, items.as_slice())))
    }

    /// A scalar or a whole structure.
    fn fill_whole(&mut self, leaves: &mut Vec<Leaf>, slot: Slot, operand: Operand, span: Span) -> Option<()> {
        let Slot { ty, offset, bits } = slot;
        let value = if self.types.record_of(ty.ty).is_some() {
            LeafValue::Record(self.record_source(operand, ty.ty, AssignmentTarget::Initializer, span)?)
        } else {
            let value = self.read(operand, span)?;
            LeafValue::Scalar(self.convert_as_assignment(
                value,
                ty.ty,
                AssignmentTarget::Initializer,
                span,
            )?)
        };
        leaves.push(Leaf { offset, ty: ty.ty, bits, value, span });
        Some(())
    }

    /// A string in a character array; the returned type has the array's length.
    fn fill_text(&mut self, leaves: &mut Vec<Leaf>, slot: Slot, text: &StringLiteral, span: Span) -> TypeId {
        let mut bytes = string_bytes(text);
        let (ty, size) = match (self.types.array(slot.ty.ty), self.types.size_of(slot.ty.ty)) {
            (Some(_), Some(size)) => (slot.ty.ty, size as usize),
            (Some((element, None)), None) => {
                let length = Some(text.elements.len() as u32 + 1);
                (self.types.intern(Type::Array(element, length)), bytes.len())
            }
            _ => (slot.ty.ty, bytes.len()),
        };
        let element_size = text.encoding.size();
        if bytes.len() > size + element_size {
            let excess = (bytes.len() - element_size - size) / element_size;
            let dropped = match excess {
                1 => "the last character is dropped".to_owned(),
                _ => format!("the last {excess} characters are dropped"),
            };
            self.report(
                Diagnostic::warning(Lint::LongString, span, "the string is longer than the array")
                    .at(dropped),
            );
        }
        bytes.resize(size, 0);
        leaves.push(Leaf { offset: slot.offset, ty, bits: None, value: LeafValue::Text(bytes), span });
        ty
    }

    /// Reports whether a string initialises a whole object of this type.
    fn takes_text(&self, ty: TypeId, text: &StringLiteral) -> bool {
        self.types.array(ty).is_some_and(|(element, _)| match text.encoding.size() {
            1 => element.ty.is_character(),
            2 => element.ty == Types::SHORT || element.ty == Types::UNSIGNED_SHORT,
            _ => element.ty == Types::INT || element.ty == Types::UNSIGNED,
        })
    }

    /// The level of an aggregate; `None` for scalars.
    pub(super) fn aggregate_level(&self, slot: Slot) -> Option<AggregateLevel> {
        let shape = match self.types.get(slot.ty.ty) {
            Type::Array(element, length) => {
                Shape::Array { element: *element, length: *length, size: self.types.size_of(element.ty)? }
            }
            Type::Record(record) => Shape::Record { record: *record, kind: self.types.record(*record).kind },
            _ => return None,
        };
        Some(AggregateLevel { slot, shape, next: 0 })
    }

    /// The part at a level's number.
    fn slot(&self, level: &AggregateLevel) -> Option<Slot> {
        match level.shape {
            Shape::Array { element, length, size } => {
                (length.is_none_or(|length| level.next < length)).then_some(())?;
                let offset = level.slot.offset.checked_add(level.next.checked_mul(size)?)?;
                Some(Slot { ty: element, offset, bits: None })
            }
            Shape::Record { record, .. } => {
                let member = self.types.record(record).layout.as_ref()?.members.get(level.next as usize)?;
                Some(Slot { ty: member.ty, offset: level.slot.offset + member.offset, bits: member.bits })
            }
        }
    }

    /// The part that the next value initialises; full levels are closed.
    pub(super) fn next_slot(&mut self, stack: &mut Vec<AggregateLevel>, span: Span) -> Option<Slot> {
        loop {
            let level = stack.last()?;
            if let Some(slot) = self.slot(level) {
                return Some(slot);
            }
            if stack.len() == 1 {
                let ty = level.slot.ty.ty;
                self.too_many(ty, span);
                return None;
            }
            stack.pop();
        }
    }
}

/// The string, if an expression is one.
fn text_of(expression: &Expression) -> Option<&StringLiteral> {
    match &expression.kind {
        ExpressionKind::String(literal) => Some(literal),
        _ => None,
    }
}
