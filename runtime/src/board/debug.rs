//! Debug information of a loaded image: functions, source lines, objects.
//!
//! Traps and traces name places with it. An image without symbols has none, and every
//! answer is then `None`.

use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

/// A function and its source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionInfo {
    /// Its name.
    pub name: String,
    /// The source file of its definition.
    pub file: String,
    /// Its first address.
    pub start: u32,
    /// One past its last.
    pub end: u32,
}

/// A named object in data or bss.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjectInfo {
    /// Its name.
    pub name: String,
    /// Its first address.
    pub start: u32,
    /// Its size in bytes.
    pub size: u32,
}

/// A place in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourcePlace<'a> {
    /// The function.
    pub function: &'a str,
    /// Its file.
    pub file: &'a str,
    /// The line, if the image has it.
    pub line: Option<u32>,
    /// The column, counted from 1, if the compiler knows it.
    pub column: Option<u32>,
    /// The function that contains it, if that is another one, which has it in place of a call.
    pub around: Option<&'a str>,
}

/// Details about the code at an address that the compiler knows but no image contains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeDetail {
    /// The address.
    pub address: u32,
    /// The column in its line, counted from 1.
    pub column: u32,
    /// The function that the source belongs to, if it was inlined into another function.
    pub inlined: Option<Arc<str>>,
}

/// The debug data of one image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DebugInfo {
    functions: Vec<FunctionInfo>,
    lines: Vec<(u32, u32)>,
    objects: Vec<ObjectInfo>,
    /// By address; empty if the compiler knows no more than the image.
    details: Arc<[CodeDetail]>,
}

impl DebugInfo {
    /// Takes functions, (address, line) pairs and objects in any order.
    #[must_use]
    pub fn new(
        mut functions: Vec<FunctionInfo>,
        mut lines: Vec<(u32, u32)>,
        mut objects: Vec<ObjectInfo>,
    ) -> Self {
        functions.sort_by_key(|function| function.start);
        lines.sort_unstable();
        objects.sort_by_key(|object| object.start);
        Self { functions, lines, objects, details: Arc::default() }
    }

    /// Returns the facts with further details from the compiler, in ascending order of addresses.
    #[must_use]
    pub fn with_details(self, details: Arc<[CodeDetail]>) -> Self {
        debug_assert!(details.is_sorted_by_key(|detail| detail.address));
        Self { details, ..self }
    }

    /// Its named objects, by address.
    pub(crate) fn objects(&self) -> &[ObjectInfo] {
        &self.objects
    }

    /// The source of the code at `address`.
    #[must_use]
    pub fn place(&self, address: CodeAddr) -> Option<SourcePlace<'_>> {
        let address = address.get();
        let after = self.functions.partition_point(|function| function.start <= address);
        let function = self.functions.get(after.checked_sub(1)?).filter(|found| address < found.end)?;
        let after = self.lines.partition_point(|(start, _)| *start <= address);
        let line = after.checked_sub(1).and_then(|index| self.lines.get(index));
        let line = line.filter(|(start, _)| *start >= function.start).map(|(_, line)| *line);
        let after = self.details.partition_point(|detail| detail.address <= address);
        let detail = after.checked_sub(1).and_then(|index| self.details.get(index));
        let detail = detail.filter(|detail| detail.address >= function.start);
        let inlined = detail.and_then(|detail| detail.inlined.as_deref());
        let column = detail.map(|detail| detail.column).filter(|column| line.is_some() && *column > 0);
        let (name, around) = match inlined {
            Some(inlined) => (inlined, Some(function.name.as_str())),
            None => (function.name.as_str(), None),
        };
        Some(SourcePlace { function: name, file: &function.file, line, column, around })
    }

    /// The statement that contains an address but begins before it; `None` at the beginning of a line.
    #[must_use]
    pub fn statement_around(&self, address: CodeAddr) -> Option<SourcePlace<'_>> {
        let is_start = self.lines.binary_search_by_key(&address.get(), |(start, _)| *start).is_ok();
        self.place(address).filter(|place| place.line.is_some() && !is_start)
    }

    /// Describes a data address by the object at or just before it: "4 bytes past the end of `table`".
    #[must_use]
    pub fn describe(&self, address: GuestAddr) -> Option<String> {
        /// The greatest distance in bytes at which an address is described by an object.
        const NEAR: u32 = 256;
        let address = address.get();
        let after = self.objects.partition_point(|object| object.start <= address);
        let object = self.objects.get(after.checked_sub(1)?)?;
        let offset = address - object.start;
        let name = &object.name;
        if offset < object.size {
            return Some(match offset {
                0 => format!("`{name}`"),
                _ => format!("byte {offset} of `{name}`"),
            });
        }
        let past = offset - object.size;
        let plural = if past == 1 { "" } else { "s" };
        (past < NEAR).then(|| match past {
            0 => format!("right after `{name}`"),
            _ => format!("{past} byte{plural} past the end of `{name}`"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info() -> DebugInfo {
        let function =
            |name: &str, start, end| FunctionInfo { name: name.into(), file: "a.c".into(), start, end };
        DebugInfo::new(
            vec![function("main", 0x100, 0x140), function("f", 0x40, 0x80)],
            vec![(0x108, 7), (0x120, 9), (0x48, 2)],
            vec![ObjectInfo { name: "table".into(), start: 0x200, size: 8 }],
        )
    }

    #[test]
    fn code_belongs_to_the_line_that_begins_before_it() {
        let info = info();
        let line = |address| info.place(CodeAddr::new(address)?).map(|place| (place.function, place.line));
        assert_eq!(line(0x128), Some(("main", Some(9))));
        assert_eq!(line(0x100), Some(("main", None)));
        assert_eq!(line(0x90), None);
    }

    #[test]
    fn details_name_the_column_and_the_function_that_was_inlined() {
        let detail = |address, column, inlined: Option<&str>| CodeDetail {
            address,
            column,
            inlined: inlined.map(Arc::from),
        };
        let details = [detail(0x108, 5, None), detail(0x118, 12, Some("f"))];
        let info = info().with_details(Arc::new(details));
        let place = |address| {
            let place = info.place(CodeAddr::new(address)?)?;
            Some((place.function, place.column, place.around))
        };
        assert_eq!(place(0x110), Some(("main", Some(5), None)));
        assert_eq!(place(0x118), Some(("f", Some(12), Some("main"))));
        assert_eq!(place(0x48), Some(("f", None, None)));
    }

    #[test]
    fn data_addresses_are_described_by_their_neighbour() {
        let info = info();
        let describe = |address| info.describe(GuestAddr::new(address)).unwrap_or_default();
        assert_eq!(describe(0x204), "byte 4 of `table`");
        assert_eq!(describe(0x20c), "4 bytes past the end of `table`");
        assert_eq!(describe(0x400), "");
    }
}
