//! Gives everything its address.

use kmotiondef::map::ProgramSpaces;
use kmotiondef::{GuestAddr, ThreadId};

use super::error::{LinkError, LinkErrorKind, LinkWarning};
use super::names::Names;
use super::reach::ReachableParts;
use super::text::TextLayout;
use super::{LinkedSymbol, Section, SectionAddresses};
use crate::object::{Object, Symbol};

/// Sections start at multiples of this many bytes.
const SECTION_ALIGN: u32 = 32;
/// Number of symbols that are named when the program is too large.
const NAMED: usize = 5;

/// The addresses.
#[derive(Debug)]
pub(super) struct Placement {
    pub(super) data_address: GuestAddr,
    pub(super) data_size: u32,
    pub(super) bss_address: GuestAddr,
    pub(super) bss_size: u32,
    /// Addresses of the functions of each object; null for functions that are left out.
    functions: Vec<Vec<GuestAddr>>,
    /// Addresses of the initialised objects of each object; null for objects that are left out.
    pub(super) data: Vec<Vec<GuestAddr>>,
    /// Addresses of the uninitialised objects; null for objects that are left out.
    pub(super) bss: Vec<GuestAddr>,
    pub(super) symbols: Vec<LinkedSymbol>,
}

impl Placement {
    /// The address of a function, given by object and index.
    pub(super) fn function(&self, (object, index): (usize, u32)) -> GuestAddr {
        self.functions[object][index as usize]
    }
}

/// Places text at `base` and everything else after it.
pub(super) fn place(
    objects: &[Object],
    names: &Names<'_>,
    reached: &ReachableParts,
    layout: &TextLayout,
    base: GuestAddr,
    addresses: &SectionAddresses,
) -> Placement {
    let text_end = base.get().saturating_add(layout.words * layout.word_bytes);
    let data_address = addresses.data.unwrap_or_else(|| next_section_start(text_end));
    let mut placed = Placement {
        data_address,
        data_size: 0,
        bss_address: data_address,
        bss_size: 0,
        functions: objects.iter().map(|object| vec![GuestAddr::NULL; object.functions.len()]).collect(),
        data: objects.iter().map(|object| vec![GuestAddr::NULL; object.objects.len()]).collect(),
        bss: vec![GuestAddr::NULL; names.uninitialized.len()],
        symbols: Vec::new(),
    };
    for (object, index, word) in &layout.functions {
        let function = &objects[*object].functions[*index as usize];
        let address = base.offset(word * layout.word_bytes);
        placed.functions[*object][*index as usize] = address;
        let size = (function.words.end - function.words.start) * layout.word_bytes;
        let symbol = &objects[*object].symbols[function.symbol];
        placed.symbols.push(linked_symbol(symbol, address, size, Section::Text, layout, *object));
    }
    placed.data(objects, reached, layout);
    let bss_address = addresses
        .bss
        .unwrap_or_else(|| next_section_start(data_address.get().saturating_add(placed.data_size)));
    placed.bss(objects, names, reached, layout, bss_address);
    placed
}

/// The start of the section after one that ends at `end`.
fn next_section_start(end: u32) -> GuestAddr {
    GuestAddr::new(end.checked_next_multiple_of(SECTION_ALIGN).unwrap_or(u32::MAX))
}

impl Placement {
    fn data(&mut self, objects: &[Object], reached: &ReachableParts, layout: &TextLayout) {
        let mut at = self.data_address.get();
        for (index, object) in objects.iter().enumerate() {
            let needed = object.objects.iter().enumerate().filter(|(item, _)| reached.data[index][*item]);
            for (item, data) in needed {
                let symbol = &object.symbols[data.symbol];
                at = at.next_multiple_of(symbol.align.max(1));
                self.data[index][item] = GuestAddr::new(at);
                let size = data.bytes.end - data.bytes.start;
                let address = GuestAddr::new(at);
                self.symbols.push(linked_symbol(symbol, address, size, Section::Data, layout, index));
                at = at.saturating_add(size);
            }
        }
        self.data_size = at - self.data_address.get();
    }

    fn bss(
        &mut self,
        objects: &[Object],
        names: &Names<'_>,
        reached: &ReachableParts,
        layout: &TextLayout,
        start: GuestAddr,
    ) {
        let mut at = start.get();
        for (index, item) in names.uninitialized.iter().enumerate().filter(|(index, _)| reached.bss[*index]) {
            at = at.checked_next_multiple_of(item.align.max(1)).unwrap_or(u32::MAX);
            let address = GuestAddr::new(at);
            self.bss[index] = address;
            let symbol = &objects[item.object].symbols[item.symbol];
            self.symbols.push(linked_symbol(symbol, address, item.size, Section::Bss, layout, item.object));
            at = at.saturating_add(item.size);
        }
        self.bss_address = start;
        self.bss_size = at - start.get();
    }
}

fn linked_symbol(
    symbol: &Symbol,
    address: GuestAddr,
    size: u32,
    section: Section,
    layout: &TextLayout,
    object: usize,
) -> LinkedSymbol {
    LinkedSymbol {
        name: symbol.name.clone(),
        address,
        size,
        section,
        kind: symbol.kind,
        linkage: symbol.linkage,
        place: layout.place(object, symbol.place),
    }
}

/// Compares the program's end with the available space (specification, `dialect.md` section 7). A program whose text is
/// not in the space of the board's user programs is for another board.
pub(super) fn check_size(
    placed: &Placement,
    text: GuestAddr,
    spaces: ProgramSpaces,
) -> Result<Vec<LinkWarning>, Vec<LinkError>> {
    let ProgramSpaces { base, size, limit } = spaces;
    if !(base..limit).contains(&text.get()) {
        return Ok(Vec::new());
    }
    let end = placed.bss_address.get().saturating_add(placed.bss_size);
    if end > limit {
        let (excess, space) = (end - limit, limit - text.get());
        let kind = LinkErrorKind::TooLarge { excess, space, largest: largest_symbols(placed) };
        return Err(vec![LinkError::global(kind)]);
    }
    // The thread in whose space the text begins.
    let own = (text.get() - base) / size + 1;
    let own_end = base + own * size;
    if end <= own_end {
        return Ok(Vec::new());
    }
    // The memory after the space of the last thread belongs to no other thread.
    let last = ((end - 1 - base) / size + 1).min(u32::from(ThreadId::MAX));
    let entered: Vec<u8> = (own as u8 + 1..=last as u8).collect();
    if entered.is_empty() {
        return Ok(Vec::new());
    }
    let excess = end - own_end;
    Ok(vec![LinkWarning::EntersOtherThreads { excess, entered, largest: largest_symbols(placed) }])
}

/// The largest symbols, `name (bytes)`.
fn largest_symbols(placed: &Placement) -> Vec<String> {
    let mut symbols: Vec<&LinkedSymbol> = placed.symbols.iter().collect();
    symbols.sort_by_key(|symbol| std::cmp::Reverse(symbol.size));
    symbols.iter().take(NAMED).map(|symbol| format!("{} ({})", symbol.name, symbol.size)).collect()
}
