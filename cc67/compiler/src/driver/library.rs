//! Functions of the C library that are C themselves, because they call functions of the program.
//!
//! The firmware cannot call back into a program, so these become a part of it: the linker asks
//! for those that a program uses and does not define. They are compiled like any other source,
//! cost what their instructions cost and can be preempted.

use std::io;
use std::path::Path;

use crate::object::{Definition, Object};
use crate::pp::Files;
use crate::typed::Linkage;

/// A file of the library and the functions in it.
pub(super) struct Member {
    pub(super) names: &'static [&'static str],
    pub(super) file: &'static str,
    pub(super) text: &'static str,
}

pub(super) const MEMBERS: &[Member] = &[
    Member { names: &["qsort"], file: "qsort.c", text: include_str!("library/qsort.c") },
    Member { names: &["bsearch"], file: "bsearch.c", text: include_str!("library/bsearch.c") },
    Member { names: &["atexit", "exit"], file: "atexit.c", text: include_str!("library/atexit.c") },
];

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

/// The members that `objects` use and do not define. The first name of a member asks for it.
pub(super) fn needed_by(objects: &[Object]) -> impl Iterator<Item = &'static Member> + '_ {
    MEMBERS.iter().filter(|member| is_wanted(objects, member))
}

fn is_wanted(objects: &[Object], member: &Member) -> bool {
    let defines = |name: &&str| {
        objects.iter().flat_map(|object| object.symbols.values()).any(|symbol| {
            symbol.name == **name
                && symbol.linkage == Linkage::External
                && symbol.definition != Definition::None
        })
    };
    let uses = |name: &str| {
        objects.iter().any(|object| {
            let text = object.relocations.iter().map(|relocation| relocation.symbol);
            let data = object.data_relocations.iter().map(|relocation| relocation.symbol);
            text.chain(data).any(|id| object.symbols.get(id).is_some_and(|symbol| symbol.name == name))
        })
    };
    member.names.first().is_some_and(|name| uses(name)) && !member.names.iter().any(defines)
}
