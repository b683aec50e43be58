//! A copy of the vendor's headers in the program's folder that belongs to another firmware.
//!
//! The header determines the offsets of the fields of `CHAN` and similar structures (`dialect.md` 1.2); with another
//! version of it, a program silently accesses the wrong fields.

use kmotiondef::boards::{StructureLayout, TargetBoard, boards};

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::SourceFile;

/// The headers that the compiler has itself.
const HEADERS: [&str; 2] = ["KMotionDef.h", "PC-DSP.h"];

/// The macro that names a header's version.
const VERSION_MACRO: &str = "KMOTION_VER";

/// Reports the first header from disk if its version or its structures are not the firmware's.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let files = program.sources.files().map(|(_, file)| file);
    let local: Vec<_> = files.filter(|file| is_header(file)).collect();
    let Some((name, span)) = local.first().and_then(|file| Some((&file.name, file.included_at?))) else {
        return;
    };
    let board = program.firmware.board();
    let stated = local.iter().find_map(|file| version_in(&file.text));
    let version = stated.filter(|stated| *stated != board.number());
    let owner = version.as_deref().and_then(|version| owner(&local, version));
    let mut notes: Vec<_> = version.map(|version| format!("its version is {version}")).into_iter().collect();
    notes.extend(board.structures().iter().filter_map(|structure| difference(program, structure)));
    if notes.is_empty() {
        return;
    }
    let message = format!("`{name}` is not the header of firmware {}", board.number());
    let mut diagnostic = Diagnostic::warning(Lint::HeaderMismatch, span, message);
    diagnostic = match board.is_default() {
        true => diagnostic.at("the simulated board has that firmware"),
        false => diagnostic.at(format!("the program is built for {}", board.title())),
    };
    diagnostic = match owner {
        Some(owner) => diagnostic.help(format!(
            "it belongs to {}: build for that with `--board {}`, or remove the copy: the compiler has the header itself",
            owner.title(),
            owner.name
        )),
        None => diagnostic.help("remove the copy: the compiler has the header itself"),
    };
    diagnostic.notes = notes;
    sink.report(diagnostic);
}

/// The board whose header has this version.
fn owner(headers: &[&SourceFile], version: &str) -> Option<&'static TargetBoard> {
    let is_of = |board: &&TargetBoard| {
        let define = format!("#define BOARD \"{}\"", board.kind());
        headers.iter().any(|file| String::from_utf8_lossy(&file.text).contains(&define))
    };
    let mut boards = boards().filter(|board| board.number() == version);
    let first = boards.clone().next();
    boards.find(is_of).or(first)
}

fn is_header(file: &SourceFile) -> bool {
    let name = file.path.as_ref().and_then(|path| path.file_name()).unwrap_or_default();
    HEADERS.iter().any(|header| name.eq_ignore_ascii_case(header))
}

/// The value of the version macro in a header's text.
fn version_in(text: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(text);
    text.lines().find_map(|line| {
        let (_, value) = line.trim_start().strip_prefix('#')?.split_once(VERSION_MACRO)?;
        let (_, value) = value.split_once('"')?;
        value.split('"').next()?.split_whitespace().next().map(str::to_owned)
    })
}

/// The first difference of the program's structure of this name, if it has one.
fn difference(program: &AnalysedProgram<'_>, structure: &StructureLayout) -> Option<String> {
    let types = &program.unit.types;
    let (record, layout) = types.records().find_map(|(id, record)| {
        let name = record.name.filter(|name| program.names.get(*name) == structure.name);
        name.and(record.layout.as_ref()).map(|layout| (id, layout))
    })?;
    for field in &structure.fields {
        let found = layout
            .members
            .iter()
            .find(|member| member.name.is_some_and(|name| program.names.get(name) == field.name))
            .and_then(|member| types.find_member(record, member.name?));
        match found {
            Some(member) if member.offset == field.offset => {}
            Some(member) => {
                return Some(format!(
                    "`{}.{}` is at byte {} there and at {} in the firmware",
                    structure.name, field.name, member.offset, field.offset
                ));
            }
            None => return Some(format!("`{}` has no `{}` there", structure.name, field.name)),
        }
    }
    (layout.size != structure.size).then(|| {
        format!("`{}` has {} bytes there and {} in the firmware", structure.name, layout.size, structure.size)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_the_define() {
        for (text, expect) in [
            ("#define KMOTION_VER  \"4.34\" // release", Some("4.34")),
            ("int a;\r\n # define KMOTION_VER \"5.1.0 beta\"\r\n", Some("5.1.0")),
            ("// KMOTION_VER \"1\"\n", None),
        ] {
            assert_eq!(version_in(text.as_bytes()).as_deref(), expect, "{text}");
        }
    }
}
