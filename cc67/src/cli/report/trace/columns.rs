//! Columns of a trace: the requested items, or by default those of axes that have been enabled.
//!
//! A plot of an axis whose position is not measured shows the position of its load; so loads are recorded, too.

use kmotiondef::Axes;
use kmotiondef::boards::boards;
use runtime::trace::{Item, Quantity, TraceRequest};

/// The quantities of a trace, each with its index in a sample.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    quantities: Vec<Quantity>,
    /// True if these are the items of all axes, of which only the enabled ones are shown; plots also show their loads.
    is_default: bool,
    /// The axes that have been enabled at some time.
    enabled: u16,
}

impl Columns {
    /// Returns the items that are recorded for plots by default.
    pub(super) fn of_pictures(axes: Axes) -> Vec<Item> {
        [Item::of_axes(axes), Item::of_loads(axes)].concat()
    }

    /// Creates the columns; no axis has been enabled yet.
    pub(super) fn new(request: &TraceRequest) -> Self {
        let items: Vec<_> = request.quantities.iter().filter_map(Quantity::item).collect();
        let is_default = boards()
            .any(|board| items == Item::of_axes(board.axes) || items == Self::of_pictures(board.axes));
        Self { quantities: request.quantities.clone(), is_default, enabled: 0 }
    }

    /// Notes the presently enabled axes.
    pub(super) fn note(&mut self, enabled: u16) {
        self.enabled |= enabled;
    }

    /// All quantities, shown or not.
    pub(super) fn all(&self) -> &[Quantity] {
        &self.quantities
    }

    /// The quantities for tables and dumps, and the index of each in a sample.
    pub(super) fn table_columns(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        self.of_enabled().filter(|(_, quantity)| !self.is_default || !is_load(quantity))
    }

    /// The quantities for a plot: the positions of axes with `is_measured`, and the loads of the others.
    pub(super) fn plot_columns(&self, is_measured: impl Fn(usize) -> bool) -> Vec<(usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| match quantity.item() {
            Some(item) if item.kind() == "pos" => is_measured(item.index()),
            Some(item) if item.kind() == LOAD => !is_measured(item.index()),
            _ => true,
        };
        self.of_enabled().filter(|(_, quantity)| !self.is_default || is_shown(quantity)).collect()
    }

    /// The quantities of axes that have been enabled, or those that were requested.
    fn of_enabled(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| {
            let of_axis = |item: Item| item.axis().or((item.kind() == LOAD).then_some(item.index()));
            let axis = quantity.item().and_then(of_axis);
            !self.is_default || axis.is_none_or(|axis| self.enabled >> axis & 1 != 0)
        };
        self.quantities.iter().enumerate().filter(move |(_, quantity)| is_shown(quantity))
    }
}

/// The kind of item with the position of a load.
const LOAD: &str = "load";

fn is_load(quantity: &Quantity) -> bool {
    quantity.item().is_some_and(|item| item.kind() == LOAD)
}
