//! The functions of the C library that are written in C.
//!
//! A function that the firmware lacks becomes a part of the program: the linker adds the members that define names used
//! and not defined. They are compiled like any other source, cost their instructions and can be preempted.
//!
//! A file of the library consists of members. Each is a separate text that begins after a line `//@ name …`: the names
//! that request it, and after a `+` further names that it defines.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use memchr::memmem;

use crate::object::{Definition, Object, Symbol};
use crate::pp::Files;
use crate::typed::Linkage;

/// The files of the library.
const FILES: &[(&str, &str)] = &[
    ("string.c", include_str!("library/string.c")),
    ("ctype.c", include_str!("library/ctype.c")),
    ("stdlib.c", include_str!("library/stdlib.c")),
    ("math.c", include_str!("library/math.c")),
    ("math99.c", include_str!("library/math99.c")),
    ("stdio.c", include_str!("library/stdio.c")),
    ("qsort.c", include_str!("library/qsort.c")),
    ("bsearch.c", include_str!("library/bsearch.c")),
    ("atexit.c", include_str!("library/atexit.c")),
    ("quotient64.c", include_str!("library/quotient64.c")),
    ("quotient32.c", include_str!("library/quotient32.c")),
    ("division64.c", include_str!("library/division64.c")),
    ("fixed64.c", include_str!("library/fixed64.c")),
    ("shift64.c", include_str!("library/shift64.c")),
];

/// A part of the library that is included as a whole or not at all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member<'t> {
    /// The file it is in.
    pub(super) file: &'t str,
    /// The names that it defines, separated by blanks; a use of one after a `+` does not link the member.
    pub(super) names: &'t str,
    /// Its source.
    pub(super) text: &'t str,
}

impl<'t> Member<'t> {
    /// The names that it defines.
    pub(super) fn names(&self) -> impl Iterator<Item = &'t str> + use<'t> {
        self.names.split_whitespace().filter(|name| *name != "+")
    }

    /// The names that request it.
    fn requesting_names(&self) -> impl Iterator<Item = &'t str> + use<'t> {
        self.names.split_whitespace().take_while(|name| *name != "+")
    }
}

/// The start of the line before a member.
const MARK: &str = "//@ ";

/// Every member.
pub(super) fn members() -> impl Iterator<Item = Member<'static>> {
    FILES.iter().flat_map(|&(file, text)| {
        // Almost none of the text matches, so this search skips many bytes at a time.
        let starts = memmem::find_iter(text.as_bytes(), MARK).map(|at| at + MARK.len());
        let ends = memmem::find_iter(text.as_bytes(), MARK).skip(1).chain([text.len()]);
        let parts = starts.zip(ends).filter_map(|(start, end)| text.get(start..end));
        parts.filter_map(move |part| part.split_once('\n')).map(move |(names, text)| Member {
            file,
            names,
            text,
        })
    })
}

/// The library needs no other files.
pub(super) struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn list(&self, _: &Path) -> io::Result<Vec<String>> {
        Err(io::ErrorKind::NotFound.into())
    }
}

/// Adds the members whose names are used by `objects` and defined neither by them nor by the firmware, and the members
/// that these use in turn.
pub(super) fn add_needed(
    objects: &mut Vec<Object>,
    is_in_firmware: impl Fn(&str) -> bool,
    compile: impl Fn(&Member<'_>) -> Option<Object>,
) {
    let mut looked_at = 0;
    while looked_at < objects.len() {
        let needed = needed_by(objects.get(looked_at..).unwrap_or_default(), objects, &is_in_firmware);
        looked_at = objects.len();
        objects.extend(needed.iter().filter_map(&compile));
    }
}

/// The members used by some of the objects and defined by none.
fn needed_by(
    users: &[Object],
    all: &[Object],
    is_in_firmware: &dyn Fn(&str) -> bool,
) -> Vec<Member<'static>> {
    let used: BTreeSet<&str> = users.iter().flat_map(used_by).filter(|name| !is_in_firmware(name)).collect();
    if used.is_empty() {
        return Vec::new();
    }
    let symbols = all.iter().flat_map(|object| object.symbols.values());
    let defined: BTreeSet<&str> = symbols
        .filter(|symbol| symbol.linkage == Linkage::External && symbol.definition != Definition::None)
        .map(|symbol| symbol.name.as_str())
        .collect();
    let is_used = |member: &Member<'_>| member.requesting_names().any(|name| used.contains(name));
    members().filter(|member| is_used(member) && !member.names().any(|name| defined.contains(name))).collect()
}

/// Reports whether one of `objects` uses one of `names`, and none defines any.
pub(super) fn uses(objects: &[Object], names: &[&str]) -> bool {
    let defines = |object: &Object| {
        let is_external = |symbol: &&Symbol| symbol.linkage == Linkage::External;
        let symbols = object.symbols.values().filter(is_external);
        symbols
            .filter(|symbol| symbol.definition != Definition::None)
            .any(|symbol| names.contains(&symbol.name.as_str()))
    };
    objects.iter().flat_map(used_by).any(|name| names.contains(&name)) && !objects.iter().any(defines)
}

/// The names that an object leaves to others.
fn used_by(object: &Object) -> impl Iterator<Item = &str> {
    let text = object.relocations.iter().map(|relocation| relocation.symbol);
    let data = object.data_relocations.iter().map(|relocation| relocation.symbol);
    let symbols = text.chain(data).filter_map(|id| object.symbols.get(id));
    symbols.filter(|symbol| symbol.definition == Definition::None).map(|symbol| symbol.name.as_str())
}
