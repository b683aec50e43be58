//! Every warning has a page, and the programs of the page behave as the page says.
//!
//! A page is `cc67/compiler/src/lints/pages/<name>.md`. A block of C marked `fires` is a program in which this lint,
//! and no other, is reported when it is enabled; a block marked `clean` is one that compiles and links without
//! messages. A block marked with a file name is an additional file for all of them.

use std::collections::BTreeSet;
use std::path::Path;

use compiler::diag::levels::Levels;
use compiler::diag::{Lint, Severity};
use compiler::pp::MemoryFiles;
use compiler::render::short;
use kmotiondef::ThreadId;

/// A block of C: its mark and its text.
struct Block {
    mark: String,
    text: String,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(mark) = line.strip_prefix("```c ") {
            let text =
                lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
            blocks.push(Block { mark: mark.to_owned(), text });
        }
    }
    blocks
}

/// The messages about a program, one finding per line, and the names of their lints.
fn compile(lint: Lint, text: &str, page: &[Block]) -> (Vec<String>, BTreeSet<&'static str>) {
    let mut files = MemoryFiles::new();
    for file in page.iter().filter(|block| block.mark.contains('.')) {
        files = files.with(&file.mark, file.text.as_bytes());
    }
    let mut levels = Levels::default();
    levels.set(lint.name()).expect("the lint has a switch");
    let options = compiler::Options::default();
    let mut compilation = compiler::compile(Path::new("page.c"), text.as_bytes().to_vec(), &options, &files);
    let thread = ThreadId::new(1).expect("1 is a thread");
    assert!(
        compilation.link(thread, &options).is_some() || compilation.sink.has_errors(),
        "no program and no error"
    );
    let shown: Vec<_> =
        compilation.diagnostics().into_iter().filter_map(|found| levels.apply(found)).collect();
    let names = shown
        .iter()
        .map(|found| match (found.severity, found.lint) {
            (Severity::Error, _) => "error",
            (_, lint) => lint.map_or("no lint", Lint::name),
        })
        .collect();
    (shown.iter().map(|found| short::render(found, &compilation.sources)).collect(), names)
}

#[test]
fn the_programs_of_every_page_do_what_it_says() {
    let mut wrong = Vec::new();
    for lint in Lint::ALL.iter().copied() {
        let blocks = blocks(lint.page());
        for kind in ["fires", "clean"] {
            let mut count = 0;
            for block in blocks.iter().filter(|block| block.mark == kind) {
                count += 1;
                let (said, names) = compile(lint, &block.text, &blocks);
                let expected: BTreeSet<_> = (kind == "fires").then_some(lint.name()).into_iter().collect();
                if names != expected {
                    wrong.push(format!("{} ({kind} {count}): {said:#?}", lint.name()));
                }
            }
            if count == 0 {
                wrong.push(format!("{}: no program `{kind}`", lint.name()));
            }
        }
    }
    assert!(wrong.is_empty(), "{} programs are not what their page says:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_page_belongs_to_a_lint_and_has_its_name() {
    let folder = harness::root().join("cc67/compiler/src/lints/pages");
    for file in harness::files(&folder, "md") {
        let name = file.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        assert!(Lint::from_name(&name).is_ok(), "{} is the page of no lint", file.display());
    }
    for lint in Lint::ALL {
        let head = format!("# {}\n\n", lint.name());
        assert!(lint.page().starts_with(&head), "the page of {} does not begin with {head}", lint.name());
    }
}
