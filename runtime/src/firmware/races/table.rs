//! Cells by address: pages of RAM in which a number leads to the cell.

use std::ops::{Index, IndexMut};

use kmotiondef::map::{IRAM, Region, SDRAM};

use super::CONTEXTS;
use super::cells::{Cell, Use};

/// Bytes of a page.
const PAGE: u32 = 1 << 12;

/// The regions in which threads share memory, by address.
const REGIONS: [Region; 2] = [IRAM, SDRAM];

/// The numbers of a page's cells, by their offset; 0 for none.
type Page = Box<[u32; PAGE as usize]>;

/// The cells that were accessed.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    /// The pages of the first region, then those of the second; `None` for a page that was not needed yet.
    pages: Vec<Option<Page>>,
    /// The cells with their addresses, from number 1.
    cells: Vec<(u32, Cell)>,
}

/// The page of an address, and the offset there; `None` outside the regions.
fn place_of(address: u32) -> Option<(usize, usize)> {
    let mut first = 0;
    for region in REGIONS {
        let offset = address.wrapping_sub(region.base.get());
        if offset < region.size {
            return Some(((first + offset / PAGE) as usize, (offset % PAGE) as usize));
        }
        first += region.size / PAGE;
    }
    None
}

impl Cells {
    /// The cell at an address, if it was accessed.
    pub(super) fn get(&self, address: u32) -> Option<&Cell> {
        self.cells.get(self.number(address)?).map(|(_, cell)| cell)
    }

    /// The cell at an address, to be changed, if it was accessed.
    pub(super) fn get_mut(&mut self, address: u32) -> Option<&mut Cell> {
        let number = self.number(address)?;
        self.cells.get_mut(number).map(|(_, cell)| cell)
    }

    /// The cell at an address; `None` where threads share no memory.
    pub(super) fn cell_mut(&mut self, address: u32) -> Option<&mut Cell> {
        let (page, offset) = place_of(address)?;
        if self.pages.len() <= page {
            self.pages.resize(page + 1, None);
        }
        let page = self.pages[page].get_or_insert_with(|| Box::new([0; PAGE as usize]));
        if page[offset] == 0 {
            self.cells.push((address, Cell::default()));
            page[offset] = self.cells.len() as u32;
        }
        self.cells.get_mut(page[offset] as usize - 1).map(|(_, cell)| cell)
    }

    /// The place of a cell in the list.
    fn number(&self, address: u32) -> Option<usize> {
        let (page, offset) = place_of(address)?;
        (self.pages.get(page)?.as_ref()?[offset] as usize).checked_sub(1)
    }

    /// All cells by address.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, &Cell)> {
        let numbers = self.pages.iter().flatten().flat_map(|page| page.iter());
        let places = numbers.filter_map(|number| (*number as usize).checked_sub(1));
        places.filter_map(|place| self.cells.get(place)).map(|(address, cell)| (*address, cell))
    }
}

/// The accesses to a cell by context; most cells are accessed by one or two.
#[derive(Clone, Debug, Default)]
pub(super) struct Uses([Option<Box<Use>>; CONTEXTS]);

/// The accesses of a context without any.
static NONE: Use = Use::NONE;

impl Uses {
    /// The contexts that have made accesses, with their accesses.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Use)> {
        self.0.iter().enumerate().filter_map(|(context, used)| Some((context, &**used.as_ref()?)))
    }
}

impl Index<usize> for Uses {
    type Output = Use;

    fn index(&self, context: usize) -> &Use {
        self.0[context].as_deref().unwrap_or(&NONE)
    }
}

impl IndexMut<usize> for Uses {
    fn index_mut(&mut self, context: usize) -> &mut Use {
        self.0[context].get_or_insert_with(Box::default)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_by_address_and_listed_in_its_order() {
        let mut cells = Cells::default();
        let addresses = [0x8010_0004, 0x1001_6E00, 0x1001_6E01, 0x80FF_FFFC];
        for address in addresses {
            assert!(cells.get(address).is_none());
            cells.cell_mut(address).expect("it is RAM").uses[2].stores = address;
        }
        assert!(cells.cell_mut(0x9000_0000).is_none());
        for address in addresses {
            assert_eq!(cells.get(address).map(|cell| cell.uses[2].stores), Some(address));
        }
        let listed: Vec<u32> = cells.iter().map(|(address, _)| address).collect();
        assert_eq!(listed, [0x1001_6E00, 0x1001_6E01, 0x8010_0004, 0x80FF_FFFC]);
    }
}
