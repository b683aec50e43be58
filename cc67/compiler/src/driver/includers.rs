//! Finds the programs in the same folder that include a file.
//!
//! Many KFLOP source files are not programs but parts of programs: functions for homing or for the spindle that
//! programs include as `.c` files. The message for such a file lists the programs that include it.

use std::path::Path;

use crate::pp::Files;

/// The files in the folder of `path` that have an `#include` of it, sorted.
pub(crate) fn includers(path: &Path, files: &dyn Files) -> Vec<String> {
    let Some(name) = path.file_name().map(|name| name.to_string_lossy().into_owned()) else {
        return Vec::new();
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut includers: Vec<_> = files
        .list(folder)
        .unwrap_or_default()
        .into_iter()
        .filter(|other| *other != name && is_source(other))
        .filter(|other| files.read(&folder.join(other)).is_ok_and(|text| includes(&text, &name)))
        .collect();
    includers.sort();
    includers
}

fn is_source(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("c"))
}

/// Reports whether a line of the text includes a file of this name from any folder.
fn includes(text: &[u8], name: &str) -> bool {
    String::from_utf8_lossy(text).lines().any(|line| {
        let directive = line.trim_start().strip_prefix('#').map(str::trim_start);
        let Some(rest) = directive.and_then(|directive| directive.strip_prefix("include")) else {
            return false;
        };
        let path = rest.trim_start().trim_start_matches(['"', '<']).split(['"', '>']).next();
        path.and_then(|path| path.rsplit(['/', '\\']).next())
            .is_some_and(|included| included.trim_end().eq_ignore_ascii_case(name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pp::MemoryFiles;

    #[test]
    fn includers_in_the_folder_are_found_however_they_spell_the_path() {
        let files = MemoryFiles::new()
            .with("p/helper.c", "int f;\n")
            .with("p/b.c", "#include \"..\\p\\Helper.c\" // functions\n")
            .with("p/a.c", "  # include \"helper.c\n")
            .with("p/other.c", "// #include \"helper.c\"\nint helper;\n")
            .with("p/notes.txt", "#include \"helper.c\"\n");
        assert_eq!(includers(Path::new("p/helper.c"), &files), ["a.c", "b.c"]);
    }
}
