//! Properties of the driver: the library compiles, and omitting unused declarations has no visible effect.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, Origin};

use super::*;
use crate::ast;
use crate::diag::Lint;
use crate::object::Definition;
use crate::pp::{Disk, Token};
use crate::source::Place;

#[test]
fn every_library_member_compiles_without_unexpected_warnings() {
    for member in library::members() {
        let compilation = compile_library(&member, Target::Sim, Timing::default());
        let mut said = compilation.diagnostics();
        // The names are deliberately those of the firmware, and so is the test for NaN.
        let on_purpose =
            [Lint::Portability, Lint::SelfComparison, Lint::Redeclared, Lint::Vendor, Lint::VendorParameter]
                .map(Some);
        said.retain(|diagnostic| !on_purpose.contains(&diagnostic.lint));
        assert!(said.is_empty(), "{}: {said:?}", member.names);
        let object = compilation.object.expect("no errors");
        for name in member.names() {
            let is_defined =
                |symbol: &object::Symbol| symbol.name == name && symbol.definition != Definition::None;
            assert!(object.symbols.values().any(is_defined), "{name}");
        }
    }
}

#[test]
fn functions_missing_from_firmware_4_34_are_in_the_library() {
    let defined: Vec<_> = library::members().flat_map(|member| member.names()).collect();
    for function in FIRMWARE_FUNCTIONS.iter().filter(|function| function.origin == Origin::Library) {
        assert!(defined.contains(&function.name), "a board has no `{}`", function.name);
    }
}

/// The beginning of a program that includes the board's headers.
const INCLUDE: &str = "#include \"KMotionDef.h\"\n";

/// The tokens of a program, with their sources.
fn tokens(text: &str, headers: Headers) -> (Vec<Token>, HeadersRead, SourceMap, Names, Sink) {
    let (mut sources, mut names, mut sink) = (SourceMap::new(), Names::new(), Sink::new());
    let main = sources.add_file("main.c", None, text.as_bytes().to_vec(), None);
    let (options, files) = (Options::default().preprocessor, library::NoFiles);
    let (tokens, read) =
        pp::preprocess_as(headers, main, &options, &files, &mut sources, &mut names, &mut sink);
    (tokens, read, sources, names, sink)
}

/// The names in the headers of the board, without duplicates.
fn header_names() -> BTreeSet<String> {
    let texts = kmotiondef::headers::EMBEDDED.iter().map(|(_, text)| String::from_utf8_lossy(text));
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words = |text: &str| text.split(|c| !is_name(c)).map(str::to_owned).collect::<Vec<_>>();
    texts
        .flat_map(|text| words(&text))
        .filter(|word| word.starts_with(|c: char| !c.is_ascii_digit()))
        .collect()
}

#[test]
fn a_header_declaration_is_read_where_its_name_is_used() {
    let (whole, read, sources, names, mut sink) = tokens(INCLUDE, Headers::Whole);
    assert_eq!(read, HeadersRead::Whole);
    let unit = parse::parse(&whole, &sources, &names, &mut sink);
    let mut count = 0;
    for item in &unit.items {
        let ast::Item::Declaration(declaration) = item else { panic!("headers only declare: {item:?}") };
        for declared in &declaration.declarators {
            let (name, span) = declared.declarator.name.expect("it has a name");
            let (spelling, place) = (names.get(name), sources.place(span));
            let (needed, read, found_in, ..) = tokens(&format!("{INCLUDE}{spelling}"), Headers::AsNeeded);
            assert_eq!(read, HeadersRead::Partly);
            let in_line = |place: Option<Place>| place.map(|place| (place.line, place.column));
            let is_it = |token: &Token| {
                in_line(found_in.place(token.span)) == in_line(place.clone())
                    && found_in.text(token.span) == spelling.as_bytes()
            };
            assert!(needed.iter().any(is_it), "`{spelling}` is declared and not read");
            assert!(needed.len() < whole.len() / 2, "`{spelling}` needs nearly everything");
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
}

#[test]
fn macros_are_the_same_when_read_only_where_they_are_used() {
    let predefined = include_str!("../pp/predefined.h").split_whitespace().filter(|word| word.contains('_'));
    let words: BTreeSet<_> = header_names().into_iter().chain(predefined.map(str::to_owned)).collect();
    let uses = |word: &String| format!("{word} ; {word} (1) ; {word} (1, 2) ;\n#ifdef {word}\nyes\n#endif\n");
    let text = words.iter().map(uses).collect::<String>();
    for text in [format!("{INCLUDE}{text}"), format!("{text}{INCLUDE}{text}")] {
        let [whole, needed] = [Headers::Whole, Headers::AsNeeded].map(|headers| {
            let (tokens, _, sources, _, sink) = tokens(&text, headers);
            let own = |token: &&Token| sources.call_site(token.span).lo < text.len() as u32;
            let own: Vec<_> = tokens.iter().filter(own).copied().collect();
            let text = String::from_utf8_lossy(&pp::print(&own, &sources)).into_owned();
            (text, sink.diagnostics().to_vec())
        });
        assert_eq!(whole.0, needed.0);
        assert_eq!(whole.1, needed.1);
    }
}

/// Every program below a folder of the repository.
fn programs(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
    let (mut folders, mut found) = (vec![root], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("it can be listed") {
            let path = entry.expect("it can be listed").path();
            match path.extension() {
                _ if path.is_dir() => folders.push(path),
                Some(suffix) if suffix == "c" => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// The object of a program, and the resulting image, as bytes.
fn bytes(compilation: Compilation, options: &Options) -> (Option<Vec<u8>>, Option<Vec<u8>>) {
    let object = compilation.object.as_ref().map(|object| object.write().expect("it is small"));
    let thread = ThreadId::new(3).expect("it is a thread");
    let linked = link_units(&mut [compilation], thread, options);
    (object, linked.map(|linked| crate::image::write(&linked).expect("it is small")))
}

#[test]
fn programs_compile_the_same_with_only_the_declarations_they_need() {
    let (mut same, mut again) = (0, 0);
    for path in ["c-programs", "tests/filetests"].into_iter().flat_map(programs) {
        let text = Arc::new(fs::read(&path).expect("it can be read"));
        for target in [Target::Sim, Target::C67x] {
            let options = Options { target, ..Options::default() };
            let request = CompileRequest { path: &path, options: &options, files: &Disk };
            let compile = |headers| compile_text(request, &text, headers);
            let (needed, is_final) = compile(Headers::AsNeeded);
            if !is_final {
                again += 1;
                continue;
            }
            let (whole, _) = compile(Headers::Whole);
            // Macros are numbered as they are read, so the numbers in spans may differ.
            let said = |compilation: &Compilation| {
                let key = |said: &Diagnostic| {
                    let at = said.span.map(|span| (span.lo, span.hi));
                    (said.lint, said.message.clone(), at, said.notes.clone(), said.help.clone())
                };
                compilation.diagnostics().into_iter().map(key).collect::<Vec<_>>()
            };
            assert_eq!(said(&whole), said(&needed), "{}", path.display());
            assert!(bytes(whole, &options) == bytes(needed, &options), "{}", path.display());
            same += 1;
        }
    }
    // Half of the tests in this repository are about errors in programs.
    assert!(same > 600, "{same} are the same, {again} were read again");
}

#[test]
fn headers_are_read_whole_where_a_partial_read_would_be_visible() {
    let read = |text: &str| {
        let (_, read, _, _, sink) = tokens(text, Headers::AsNeeded);
        let said: Vec<_> = sink.diagnostics().iter().map(|it| it.message.clone()).collect();
        (read, said)
    };
    for (text, expect) in [
        ("int a;\n", HeadersRead::Whole),
        ("#include \"KMotionDef.h\"\n#define X 0\n#define LED 3\n#undef TRUE\n", HeadersRead::Partly),
        ("#define LED 0\n#include \"KMotionDef.h\"\n#include \"PC-DSP.h\"\n", HeadersRead::Partly),
        ("#define N_CHANNELS 8\n#include \"KMotionDef.h\"\n", HeadersRead::Whole),
        ("#define Position 8\n#include \"KMotionDef.h\"\n", HeadersRead::Whole),
        ("#undef _SIZE_T\n#include \"KMotionDef.h\"\n", HeadersRead::Whole),
        ("#include \"PC-DSP.h\"\n#include \"KMotionDef.h\"\n", HeadersRead::Whole),
        ("#include \"KMotionDef.h\"\n#define Position 8\n", HeadersRead::Partly),
        ("#include \"KMotionDef.h\"\n#undef N_CHANNELS\n", HeadersRead::TooLittle),
        (
            "#include \"KMotionDef.h\"\n#pragma push_macro(\"N_DACS\")\n#pragma pop_macro(\"N_DACS\")\n",
            HeadersRead::TooLittle,
        ),
    ] {
        assert_eq!(read(text), (expect, Vec::new()), "{text}");
    }
    let text = format!(
        "#define Gain 1\n{INCLUDE}#define X(a) a\n#define int\n#undef FPGA\n#define FPGA 3\nTRIP_COEFF *p;\n"
    );
    let [whole, needed] = [Headers::Whole, Headers::AsNeeded].map(|headers| tokens(&text, headers));
    assert_eq!(needed.1, HeadersRead::Partly);
    let printed = |(tokens, _, sources, ..): &(Vec<Token>, HeadersRead, SourceMap, Names, Sink)| {
        String::from_utf8_lossy(&pp::print(tokens, sources)).into_owned()
    };
    for line in printed(&needed).lines() {
        assert!(printed(&whole).lines().any(|known| known == line), "{line}");
    }
    let own = pp::MemoryFiles::new().with("PC-DSP.h", "#define N_CHANNELS 2\n");
    let text = Arc::new(format!("{INCLUDE}int a[sizeof chan / sizeof *chan];\n").into_bytes());
    let options = Options::default();
    let request = CompileRequest { path: Path::new("main.c"), options: &options, files: &own };
    let compile = |headers| compile_text(request, &text, headers);
    let ((needed, is_final), (whole, _)) = (compile(Headers::AsNeeded), compile(Headers::Whole));
    assert!(is_final);
    assert_eq!(needed.diagnostics(), whole.diagnostics());
}
