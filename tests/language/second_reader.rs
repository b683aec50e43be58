//! `lang-c`, an independent parser, reads the same programs: for every program that it accepts, it must return the same
//! declarations, expressions and statements as our parser, which is used for its speed and because it reports several
//! errors.
//!
//! Both read the same tokens, produced by our lexer; the trees are compared in their printed form, item by item.
//! `lang-c` reads standard C, so an implicit `int` is made explicit for it.

mod print;

use std::collections::BTreeMap;
use std::path::Path;
use std::{fs, thread};

use compiler::ast::{Item, Specifiers, TranslationUnit};
use compiler::diag::Sink;
use compiler::names::Names;
use compiler::pp::{Token, TokenKind, token_text};
use compiler::source::{SourceMap, Span};
use compiler::{Options, parse, pp};
use harness::files;
use lang_c::driver::{Config, Flavor, parse_preprocessed};

/// Programs whose trees differ, each with the reason.
const DIFFERENCES: &[(&str, &str)] = &[
    (
        "tests/filetests/dialect/1.1/constant-forms.c",
        "our form shows the value of a hexadecimal float, `lang-c` keeps its text",
    ),
    ("tests/filetests/dialect/1.1/pointers.c", "in a cast, `lang-c` does not tell `()` from `(void)`"),
];

/// Programs that `lang-c` cannot read, each with the reason; it must accept all others.
const NOT_READ: &[(&str, &str)] = &[
    ("tests/filetests/diagnostics/path_that_looks_like_unicode.c", "an unknown escape"),
    ("tests/filetests/diagnostics/windows_path_in_string.c", "an unknown escape"),
    ("tests/filetests/dialect/2.1/unknown-escape.c", "an unknown escape"),
    ("tests/filetests/diagnostics/label_address_outside.c", "the address of a label"),
    ("tests/filetests/dialect/1.2/packing-is-ignored.c", "an attribute after the members"),
    ("tests/filetests/dialect/2.1/backslash-newline.c", "a line break in a string"),
    ("tests/filetests/dialect/2.1/escapes.c", "`\\e`"),
    ("tests/filetests/dialect/2.1/integer-with-f.c", "`2000f`"),
    ("tests/filetests/dialect/2.1/string-over-lines.c", "a line break in a string"),
    ("tests/filetests/dialect/2.2/declaration-after-label.c", "a declaration after a label"),
    ("tests/filetests/dialect/2.2/ignored-words.c", "attributes of declarations"),
    ("tests/filetests/dialect/2.2/implicit-int-globals.c", "a parameter without a type"),
    ("tests/filetests/dialect/2.2/implicit-int-locals.c", "locals without a type"),
    ("tests/filetests/dialect/2.4/conditional-and-comma.c", "`a ?: b`"),
    ("tests/filetests/dialect/2.4/not-a-place.c", "an assignment to a sum"),
    ("tests/filetests/dialect/2.5/switch.c", "a label at the end of a block"),
    ("tests/filetests/dialect/2.6/odd-forms.c", "the address of a label"),
    ("tests/filetests/habits/implicit_int_everywhere.c", "locals without a type"),
    ("tests/filetests/language/addresses_of_labels.c", "the address of a label"),
    ("tests/filetests/language/alignment.c", "an attribute after the members"),
    ("tests/filetests/language/attributes_in_declarators.c", "attributes inside of declarators"),
    ("tests/filetests/language/goto_where_no_label_is.c", "the address of a label"),
    ("tests/filetests/language/unicode_text.c", "text of other widths with escapes"),
    ("tests/filetests/lints/waiting_is_silent.c", "locals without a type"),
];

/// The declarations that are built into our parser; their line is left out.
const PRELUDE: &str = "typedef char *va_list; ";

/// The stack size for trees of any depth.
const STACK: usize = 256 << 20;

/// The result of reading a program with both parsers.
#[derive(Debug, PartialEq)]
enum Reading {
    /// Our parser finds errors: nothing is compared.
    Wrong,
    /// `lang-c` rejects it: the text from the position of its error.
    Refused(String),
    /// The first item that differs, as printed by ours and by `lang-c`.
    Differs(String, String),
    /// The number of items, all of which are the same.
    Same(usize),
}

/// Returns whether an `int` is implicit in the specifiers.
fn leaves_int_out(specifiers: &Specifiers) -> bool {
    specifiers.ty.is_none()
}

/// The positions of implicit `int`s: before these declarators.
fn left_out(unit: &TranslationUnit) -> Vec<Span> {
    let mut found = Vec::new();
    for item in &unit.items {
        match item {
            Item::Function(function) if leaves_int_out(&function.specifiers) => {
                found.push(function.declarator.span);
            }
            Item::Declaration(declaration) if leaves_int_out(&declaration.specifiers) => {
                found.extend(declaration.declarators.first().map(|first| first.declarator.span));
            }
            Item::Function(_) | Item::Declaration(_) | Item::StaticAssert(_) => {}
        }
    }
    found
}

/// The tokens as text for the other parser.
fn text(tokens: &[Token], unit: &TranslationUnit, sources: &SourceMap) -> Option<String> {
    let left_out = left_out(unit);
    let mut text = PRELUDE.to_owned();
    for token in tokens.iter().filter(|token| token.kind != TokenKind::End) {
        if left_out.iter().any(|span| (span.lo, span.expansion) == (token.span.lo, token.span.expansion)) {
            text.push_str("int ");
        }
        match std::str::from_utf8(&token_text(*token, sources)).ok()? {
            "va_arg" => text.push_str("__builtin_va_arg"),
            word => text.push_str(word),
        }
        text.push(' ');
    }
    Some(text)
}

/// Our form, with implicit `int`s made explicit, and with the name of the type that is built into our parser.
fn completed(line: &str) -> String {
    line.replace("(typeof char *)", "va_list")
        .split(' ')
        .map(|word| if word == "?" { "int" } else { word })
        .collect::<Vec<_>>()
        .join(" ")
}

fn read(path: &Path) -> Reading {
    let (mut sources, mut names, mut sink) = (SourceMap::new(), Names::new(), Sink::new());
    let source = fs::read(path).expect("the program is readable");
    let main = sources.add_file(path.to_string_lossy(), Some(path), source, None);
    let options = Options::default().preprocessor;
    let tokens = pp::preprocess(main, &options, &pp::Disk, &mut sources, &mut names, &mut sink);
    let unit = parse::parse(&tokens, &sources, &names, &mut sink);
    let Some(text) = text(&tokens, &unit, &sources).filter(|_| !sink.has_errors()) else {
        return Reading::Wrong;
    };
    let config = Config { flavor: Flavor::GnuC11, ..Config::with_gcc() };
    let theirs = match parse_preprocessed(&config, text) {
        Ok(parsed) => parsed.unit,
        Err(error) => {
            let from = error.offset.saturating_sub(30);
            let start = (from..=error.offset).find(|at| error.source.is_char_boundary(*at)).unwrap_or(0);
            return Reading::Refused(error.source[start..].chars().take(60).collect());
        }
    };
    let (ours, theirs) = (parse::print::print(&unit, &names), print::print(&theirs));
    let mut same = 0;
    let named = |line: &str| line.replace("__builtin_va_list", "va_list");
    let (mut ours, mut theirs) = (ours.lines().map(completed), theirs.lines().skip(1).map(named));
    loop {
        match (ours.next(), theirs.next()) {
            (None, None) => return Reading::Same(same),
            (Some(a), Some(b)) if a == b => same += 1,
            (a, b) => return Reading::Differs(a.unwrap_or_default(), b.unwrap_or_default()),
        }
    }
}

#[test]
fn a_third_party_parser_gives_the_same_trees() {
    let mut paths = files(&harness::root().join("c-programs"), "c");
    paths.extend(files(&harness::root().join("tests/filetests"), "c"));
    let work = move || paths.into_iter().map(|path| (read(&path), path)).collect::<Vec<_>>();
    let handle = thread::Builder::new().stack_size(STACK).spawn(work).expect("a thread starts");
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut items, mut wrong) = (0, Vec::new());
    for (reading, path) in handle.join().expect("no parser panics") {
        let name = path.strip_prefix(harness::root()).expect("it lies there");
        let name = name.to_string_lossy().replace('\\', "/");
        let is_listed = |list: &[(&str, &str)]| list.iter().any(|(listed, _)| *listed == name);
        match reading {
            Reading::Wrong => *counts.entry("wrong").or_default() += 1,
            Reading::Same(count) => {
                *counts.entry("same").or_default() += 1;
                items += count;
                if is_listed(DIFFERENCES) || is_listed(NOT_READ) {
                    wrong.push(format!("{name} is read the same: take it out of the list"));
                }
            }
            Reading::Refused(_) if is_listed(NOT_READ) => *counts.entry("refused").or_default() += 1,
            Reading::Refused(at) => wrong.push(format!("{name} is not accepted: {at}")),
            Reading::Differs(..) if is_listed(DIFFERENCES) => *counts.entry("different").or_default() += 1,
            Reading::Differs(ours, theirs) => {
                wrong.push(format!("{name}\n  ours   {ours}\n  lang-c {theirs}"));
            }
        }
    }
    println!("{counts:?}, {items} items the same");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(counts.get("same").is_some_and(|same| *same >= 400), "{counts:?}");
}
