//! What a trace shows: what was asked for, or else the items of axes that have been enabled.

use runtime::trace::{Item, Quantity, TraceRequest};

/// The quantities of a trace, each with its place in a sample.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    quantities: Vec<Quantity>,
    /// Whether these are the items of all axes, of which only the enabled ones are shown.
    is_default: bool,
    /// Axes that were enabled at some time.
    enabled: u8,
}

impl Columns {
    /// Nothing is enabled yet.
    pub(super) fn new(request: &TraceRequest) -> Self {
        let items: Vec<_> = request.quantities.iter().filter_map(Quantity::item).collect();
        let is_default = items == Item::of_axes();
        Self { quantities: request.quantities.clone(), is_default, enabled: 0 }
    }

    /// Takes up which axes are enabled now.
    pub(super) fn note(&mut self, enabled: u8) {
        self.enabled |= enabled;
    }

    /// All of them, shown or not.
    pub(super) fn all(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Those to show, and where each is in a sample.
    pub(super) fn shown(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| {
            let axis = quantity.item().and_then(Item::axis);
            !self.is_default || axis.is_none_or(|axis| self.enabled >> axis & 1 != 0)
        };
        self.quantities.iter().enumerate().filter(move |(_, quantity)| is_shown(quantity))
    }
}
