//! Functions of the C library that are C themselves, because they call functions of the program.
//!
//! The firmware cannot call back into a program, so these become a part of it: the linker asks
//! for those that a program uses and does not define. They are compiled like any other source,
//! cost what their instructions cost and can be preempted.

use std::io;
use std::path::Path;

use crate::driver::{Options, compile_here};
use crate::object::{Definition, Object};
use crate::pp::Files;
use crate::typed::Linkage;

/// A file of the library and the functions in it.
struct Member {
    names: &'static [&'static str],
    file: &'static str,
    text: &'static str,
}

const MEMBERS: &[Member] = &[
    Member { names: &["qsort"], file: "qsort.c", text: include_str!("library/qsort.c") },
    Member { names: &["bsearch"], file: "bsearch.c", text: include_str!("library/bsearch.c") },
    Member { names: &["atexit", "exit"], file: "atexit.c", text: include_str!("library/atexit.c") },
];

/// The library needs no other files.
struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn list(&self, _: &Path) -> io::Result<Vec<String>> {
        Err(io::ErrorKind::NotFound.into())
    }
}

/// The members that `objects` use and do not define, compiled. The first name of a member asks for it.
pub(crate) fn members_for(objects: &[Object]) -> Vec<Object> {
    MEMBERS.iter().filter(|member| is_wanted(objects, member)).filter_map(compiled).collect()
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

fn compiled(member: &Member) -> Option<Object> {
    let text = member.text.as_bytes().to_vec();
    compile_here(Path::new(member.file), text, &Options::default(), &NoFiles).object
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lints::Lint;

    #[test]
    fn every_member_compiles_without_a_word() {
        for member in MEMBERS {
            let text = member.text.as_bytes().to_vec();
            let compilation = compile_here(Path::new(member.file), text, &Options::default(), &NoFiles);
            let mut said = compilation.diagnostics();
            // The names are the firmware's on purpose.
            said.retain(|diagnostic| diagnostic.lint != Some(Lint::Portability));
            assert!(said.is_empty(), "{}: {said:?}", member.file);
            let object = compilation.object.expect("no errors");
            for name in member.names {
                let is_defined = |symbol: &crate::object::Symbol| {
                    symbol.name == *name && matches!(symbol.definition, Definition::Function(_))
                };
                assert!(object.symbols.values().any(is_defined), "{name}");
            }
        }
    }
}
