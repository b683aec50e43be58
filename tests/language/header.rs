//! The headers in `kmotiondef/include` agree with the interface tables.
//!
//! A C program of static assertions is generated from the tables and compiled by cc67, so that names, types, values,
//! layouts and macros are compared as a program would see them.

use std::fmt::Write as _;
use std::path::Path;

use compiler::diag::Severity;
use compiler::firmware::Firmware;

use compiler::pp::Disk;
use harness::csv::{self, Row};
use kmotiondef::boards::TargetBoard;
use kmotiondef::structs::{STRUCTURES, StructureField};

/// The rows of a table for a board.
fn table(board: &TargetBoard, name: &str) -> Vec<Row> {
    let folder = match board.is_default() {
        true => "api".to_owned(),
        false => format!("boards/{}", board.name),
    };
    csv::read(&harness::root().join("tests/data").join(folder).join(name))
}

/// Every board with its expected number of rows.
fn boards(counts: [usize; 3]) -> impl Iterator<Item = (&'static TargetBoard, usize)> {
    let names = ["kflop-4.34", "kflop-5.3.2", "kogna-5.3.2"];
    names.map(|name| TargetBoard::named(name).expect(name)).into_iter().zip(counts)
}

/// Compiles and links the header, `checks` and a `main` with the given body; returns the errors.
///
/// The linker checks only the symbols that are reachable from `main`.
fn errors(board: &'static TargetBoard, checks: &str, body: &str) -> String {
    let text = format!("#include \"KMotionDef.h\"\n{checks}\nint main(void) {{ {body} }}\n");
    let options = compiler::Options { firmware: Firmware::Board(board), ..compiler::Options::default() };
    let mut compilation = compiler::compile(Path::new("checks.c"), text.into_bytes(), &options, &Disk);
    compilation.link(kmotiondef::ThreadId::new(1).expect("1 is a thread"), &options);
    let wrong = compilation.sink.diagnostics().iter().filter(|d| d.severity == Severity::Error);
    wrong
        .map(|diagnostic| format!("{}\n", compiler::render::short::render(diagnostic, &compilation.sources)))
        .collect()
}

#[track_caller]
fn assert_compiles(board: &'static TargetBoard, checks: &str) {
    let errors = errors(board, checks, "return 0;");
    assert!(errors.is_empty(), "{}: {errors}", board.name);
}

/// The C declaration of `name` as a pointer, for a type such as `int[8]` or `char * volatile`.
fn pointer_to(c_type: &str, dims: &str) -> String {
    let (element, own_dims) =
        c_type.split_once('[').map_or((c_type, String::new()), |(e, d)| (e, format!("[{d}")));
    let dims = format!("{own_dims}{dims}");
    if dims.is_empty() { format!("{element} *") } else { format!("{element} (*){dims}") }
}

#[test]
fn the_comparison_can_fail() {
    let board = TargetBoard::default_board();
    assert!(errors(board, "_Static_assert(sizeof(CHAN) == 433, \"size\");", "").contains("size"));
    assert!(
        errors(board, "_Static_assert(_Generic(&ReadBit, void (*)(int): 1, default: 0), \"ReadBit\");", "")
            .contains("ReadBit")
    );
}

#[test]
fn structures_have_the_sizes_and_offsets_of_the_board() {
    for (board, count) in boards([180, 198, 214]) {
        let mut checks = String::new();
        let rows = table(board, "structs.csv");
        assert_eq!(rows.len(), count, "{}", board.name);
        for row in rows {
            let (record, field, size) = (&row["struct"], &row["field"], &row["size"]);
            if field == "(struct)" {
                let align = &row["alignment"];
                let _ = writeln!(checks, "_Static_assert(sizeof({record}) == {size}, \"size of {record}\");");
                let _ = writeln!(
                    checks,
                    "_Static_assert(_Alignof({record}) == {align}, \"alignment of {record}\");"
                );
                continue;
            }
            let offset = &row["offset"];
            let member = format!("((({record} *)0)->{field})");
            let _ = writeln!(
                checks,
                "_Static_assert(__builtin_offsetof({record}, {field}) == {offset}, \"offset of {record}.{field}\");"
            );
            let _ =
                writeln!(checks, "_Static_assert(sizeof{member} == {size}, \"size of {record}.{field}\");");
            if row["c_type"] != "struct" && row["c_type"] != "union" {
                let pointer = pointer_to(&row["c_type"], &row["array_dims"]);
                let _ = writeln!(
                    checks,
                    "_Static_assert(_Generic(&{member}, {pointer}: 1, default: 0), \"type of {record}.{field}\");"
                );
            }
        }
        assert_compiles(board, &checks);
    }
}

/// Returns whether a line of a structure declares a field.
fn declares(line: &str, field: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default().trim_end();
    let names = code.strip_suffix(';').unwrap_or_default().split('[').next().unwrap_or_default();
    names.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next() == Some(field)
}

/// The line of a field, with its comment aligned to that of the previous line.
fn line_of(field: &StructureField, before: &str) -> String {
    let declaration = format!("    {};", field.ty.declare(field.name));
    let column = before.find("//").unwrap_or_default().max(declaration.len() + 1);
    let (first, rest) = field.doc.split_at(1);
    let doc = format!("{}{}", first.to_lowercase(), rest.trim_end_matches('.'));
    format!("{declaration:<column$}// {doc}")
}

/// The header with a line added for each field that has a row and no line.
fn completed(header: &str) -> String {
    let mut lines: Vec<String> = header.split('\n').map(str::to_owned).collect();
    for structure in STRUCTURES {
        let end = format!("}} {};", structure.name);
        let is_end = |line: &String| *line == end;
        // Otherwise it belongs to the other header.
        let Some(last) = lines.iter().position(is_end) else { continue };
        let mut at =
            lines[..last].iter().rposition(|line| line.starts_with("typedef struct")).expect("it begins");
        for field in structure.fields {
            let rest = lines[at + 1..].iter().take_while(|line| !is_end(line));
            if let Some(found) = rest.clone().position(|line| declares(line, field.name)) {
                at += 1 + found;
            } else {
                let comment = rest.take_while(|line| line.trim_start().starts_with("//")).count();
                let line = line_of(field, &lines[at]);
                at += 1 + comment;
                lines.insert(at, line);
            }
        }
    }
    lines.join("\n")
}

#[test]
fn every_field_is_declared_in_the_header() {
    for header in ["KMotionDef.h", "PC-DSP.h"] {
        let path = harness::root().join("kmotiondef/include").join(header);
        let read = || std::fs::read_to_string(&path).expect("the header is there");
        let expect = completed(&read());
        if std::env::var_os("CC67_WRITE_HEADER").is_some() {
            std::fs::write(&path, &expect).expect("the header is writable");
        }
        let found = read();
        let is_new = |line: &&str| !found.lines().any(|known| known == *line);
        let missing: Vec<_> = expect.lines().filter(is_new).collect();
        assert!(found == expect, "run this test with CC67_WRITE_HEADER=1 to write these lines: {missing:#?}");
    }
}

#[test]
fn a_missing_declaration_is_written_like_its_neighbours() {
    let path = harness::root().join("kmotiondef/include/KMotionDef.h");
    let header = std::fs::read_to_string(path).expect("the header is there");
    let line = header.lines().find(|line| declares(line, "FFVel")).expect("the field has its line");
    assert_eq!(completed(&header.replace(&format!("{line}\n"), "")), header);
}

#[test]
fn functions_have_the_signatures_of_the_board() {
    for (board, count) in boards([117, 165, 183]) {
        let mut checks = String::new();
        let rows: Vec<_> =
            table(board, "functions.csv").into_iter().filter(|row| row["header_declares"] == "yes").collect();
        assert_eq!(rows.len(), count, "{}", board.name);
        for row in rows {
            let (name, signature) = (&row["name"], &row["signature"]);
            // `int ReadBit(int bit)` becomes the type `int (*)(int bit)`.
            let pointer = signature.replacen(&format!("{name}("), "(*)(", 1);
            let _ = writeln!(
                checks,
                "_Static_assert(_Generic(&{name}, {pointer}: 1, default: 0), \"{signature}\");"
            );
        }
        assert_compiles(board, &checks);
    }
}

#[test]
fn variables_have_the_types_of_the_board() {
    for (board, count) in boards([83, 85, 112]) {
        let mut checks = String::new();
        let rows = table(board, "variables.csv");
        assert_eq!(rows.len(), count, "{}", board.name);
        for row in rows {
            let (name, size) = (&row["name"], &row["size_bytes"]);
            let pointer = pointer_to(&row["c_type"], "");
            let _ = writeln!(checks, "_Static_assert(sizeof {name} == {size}, \"size of {name}\");");
            let _ = writeln!(
                checks,
                "_Static_assert(_Generic(&{name}, {pointer}: 1, default: 0), \"type of {name}\");"
            );
        }
        assert_compiles(board, &checks);
    }
}

#[test]
fn constants_have_the_values_of_the_board() {
    for (board, count) in boards([292, 336, 357]) {
        let mut checks = String::new();
        let mut compared = 0;
        for row in table(board, "constants.csv") {
            let (name, value) = (&row["name"], &row["value"]);
            if row["release"] != "4.34" && (board.is_default() || row["release"] != "5.3.2") {
                continue;
            }
            compared += 1;
            if row["expression"].starts_with("enumerator") {
                let _ = writeln!(checks, "_Static_assert({name} == {value}, \"{name}\");");
                continue;
            }
            let _ = writeln!(checks, "#ifndef {name}\n#error {name} is not defined\n#endif");
            match row["type"].as_str() {
                "none" => {}
                "char[]" => {
                    let _ =
                        writeln!(checks, "_Static_assert(sizeof {name} == {}, \"{name}\");", value.len() + 1);
                    let _ = writeln!(checks, "char text_{name}[] = {name};");
                }
                "float" => {
                    let _ = writeln!(
                        checks,
                        "_Static_assert({name} == {value}f || {name} == (float){value}, \"{name}\");"
                    );
                    let _ = writeln!(checks, "_Static_assert(sizeof({name}) == 4, \"{name} is a float\");");
                }
                "double" => {
                    let _ = writeln!(
                        checks,
                        "_Static_assert({name} == {value} && sizeof({name}) == 8, \"{name}\");"
                    );
                }
                _ => {
                    let _ = writeln!(checks, "_Static_assert((int)({name}) == (int)({value}), \"{name}\");");
                }
            }
        }
        assert_eq!(compared, count, "{}", board.name);
        assert_compiles(board, &checks.replace("(float)-", "(float) -"));
    }
}

#[test]
fn macros_are_all_defined() {
    for (board, count) in boards([22, 25, 42]) {
        let rows = table(board, "macros.csv");
        assert_eq!(rows.len(), count, "{}", board.name);
        let checks: String = rows
            .iter()
            .map(|row| format!("#ifndef {0}\n#error {0} is not defined\n#endif\n", row["name"]))
            .collect();
        assert_compiles(board, &checks);
    }
}

/// The text of a macro in the headers of a board, without blanks.
fn expansion(board: &TargetBoard, name: &str) -> Option<String> {
    let (_, rest) = board.headers().iter().find_map(|(_, text)| {
        let text = str::from_utf8(text).expect("headers are UTF-8");
        text.lines().find_map(|line| {
            let rest = line.strip_prefix("#define ")?.trim_start().strip_prefix(name)?;
            let code = rest.split("//").next()?;
            rest.starts_with(['(', ' ']).then_some((name, code.to_owned()))
        })
    })?;
    let body = match rest.strip_prefix('(').and_then(|rest| rest.split_once(')')) {
        Some((_, body)) => body,
        None => &rest,
    };
    Some(body.split_whitespace().collect())
}

#[test]
fn macros_expand_to_what_the_tables_have() {
    for (board, count) in boards([16, 19, 36]) {
        // The tables describe the macros for mode names in words.
        let rows = table(board, "macros.csv").into_iter();
        let rows: Vec<_> = rows.filter(|row| !row["expansion"].starts_with("string by")).collect();
        assert_eq!(rows.len(), count, "{}", board.name);
        for row in rows {
            let expect: String = row["expansion"].split_whitespace().collect();
            assert_eq!(expansion(board, &row["name"]), Some(expect), "{}: {}", board.name, row["name"]);
        }
    }
}

#[test]
fn every_function_links_except_the_one_the_board_lacks() {
    for (board, absent) in boards([1, 3, 4]) {
        let mut program = String::from("void *all[] = {\n");
        let rows = table(board, "functions.csv").into_iter().filter(|row| row["header_declares"] == "yes");
        let (there, lacking): (Vec<_>, Vec<_>) = rows.partition(|row| !row["address"].is_empty());
        for row in there {
            let _ = writeln!(program, "  (void *){},", row["name"]);
        }
        program.push_str("};\n");
        let missing = errors(board, &program, "return (int)all[0];");
        assert!(missing.is_empty(), "{}: {missing}", board.name);
        assert_eq!(lacking.len(), absent, "{}: {lacking:?}", board.name);
        let missing = errors(board, "", "WriteDAC(0, 1);");
        assert!(missing.contains("WriteDAC"), "{}: {missing}", board.name);
    }
}
