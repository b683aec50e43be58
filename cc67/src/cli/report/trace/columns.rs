//! Columns of a trace: the requested items, or else those of axes that have been enabled.
//!
//! A picture of an axis whose position nobody measures shows where its load is; for that the loads are recorded as well.

use kmotiondef::Axes;
use kmotiondef::boards::boards;
use runtime::trace::{Item, Quantity, TraceRequest};

/// The quantities of a trace, each with its place in a sample.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    quantities: Vec<Quantity>,
    /// True if these are the items of all axes, of which only the enabled ones are shown, with their loads in pictures.
    is_default: bool,
    /// Axes that were enabled at some time.
    enabled: u16,
}

impl Columns {
    /// Returns the items that are recorded for pictures by default.
    pub(super) fn of_pictures(axes: Axes) -> Vec<Item> {
        [Item::of_axes(axes), Item::of_loads(axes)].concat()
    }

    /// Nothing is enabled yet.
    pub(super) fn new(request: &TraceRequest) -> Self {
        let items: Vec<_> = request.quantities.iter().filter_map(Quantity::item).collect();
        let is_default = boards()
            .any(|board| items == Item::of_axes(board.axes) || items == Self::of_pictures(board.axes));
        Self { quantities: request.quantities.clone(), is_default, enabled: 0 }
    }

    /// Takes up which axes are enabled now.
    pub(super) fn note(&mut self, enabled: u16) {
        self.enabled |= enabled;
    }

    /// All of them, shown or not.
    pub(super) fn all(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Those to show in tables and dumps, and where each is in a sample.
    pub(super) fn shown(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        self.of_enabled().filter(|(_, quantity)| !self.is_default || !is_load(quantity))
    }

    /// Those to show in a picture: of the axes `is_measured` where they are, of the others where their loads are.
    pub(super) fn pictured(&self, is_measured: impl Fn(usize) -> bool) -> Vec<(usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| match quantity.item() {
            Some(item) if item.kind() == "pos" => is_measured(item.index()),
            Some(item) if item.kind() == LOAD => !is_measured(item.index()),
            _ => true,
        };
        self.of_enabled().filter(|(_, quantity)| !self.is_default || is_shown(quantity)).collect()
    }

    /// Those of axes that were enabled, or what was requested.
    fn of_enabled(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| {
            let of_axis = |item: Item| item.axis().or((item.kind() == LOAD).then_some(item.index()));
            let axis = quantity.item().and_then(of_axis);
            !self.is_default || axis.is_none_or(|axis| self.enabled >> axis & 1 != 0)
        };
        self.quantities.iter().enumerate().filter(move |(_, quantity)| is_shown(quantity))
    }
}

/// The kind of item that is the place of a load.
const LOAD: &str = "load";

fn is_load(quantity: &Quantity) -> bool {
    quantity.item().is_some_and(|item| item.kind() == LOAD)
}
