//! From C to machine words, executed on the processor's own engine with a minimal firmware.

mod firmware;
mod kernels;
mod language;
mod machine;
mod programs;

use std::path::Path;

use kmotiondef::ThreadId;

use crate::link::LinkedProgram;
use crate::passes::Level;
use crate::pp;
use crate::target::Target;
use crate::{Options, compile};

struct NoFiles;

impl pp::Files for NoFiles {
    fn read(&self, _: &Path) -> std::io::Result<Vec<u8>> {
        Err(std::io::ErrorKind::NotFound.into())
    }

    fn list(&self, _: &Path) -> std::io::Result<Vec<String>> {
        Err(std::io::ErrorKind::NotFound.into())
    }
}

/// Compiles and links for thread 1.
fn build(source: &str, level: Level) -> LinkedProgram {
    let options = Options { target: Target::C67x, level, ..Options::default() };
    let mut compilation = compile(Path::new("test.c"), source.as_bytes().to_vec(), &options, &NoFiles);
    let linked = compilation.link(ThreadId::new(1).expect("thread 1"), &options);
    linked.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics()))
}
