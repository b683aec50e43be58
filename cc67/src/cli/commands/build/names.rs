//! Names of the files that `cc67 build` writes, as in the vendor's tools.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use kmotiondef::ThreadId;

use super::has_extension;

/// The image of a source for a thread: `prog.c` becomes `prog(1).out`. Only `.c`, `.txt` and
/// `.cpp` are removed (`coff.md` section 9.4 of the specification).
pub(super) fn image(source: &Path, thread: ThreadId) -> PathBuf {
    let stem = if has_extension(source, &["c", "txt", "cpp", "o", "obj"]) {
        source.file_stem()
    } else {
        source.file_name()
    };
    let mut name = stem.unwrap_or_default().to_owned();
    name.push(format!("({thread}).out"));
    source.with_file_name(name)
}

/// The object file of a source: `prog.c` becomes `prog.o`.
pub(super) fn object(source: &Path) -> PathBuf {
    source.with_extension("o")
}

/// A file next to an image: `prog(1).out` becomes `prog(1).map`.
pub(super) fn sibling_file(image: &Path, extension: &str) -> PathBuf {
    if has_extension(image, &["out"]) {
        return image.with_extension(extension);
    }
    let mut name = OsString::from(image);
    name.push(format!(".{extension}"));
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_named_as_the_vendors_library_names_them() {
        for (source, thread, expect) in [
            ("dir/Prog.c", 2, "dir/Prog(2).out"),
            ("Prog.C", 1, "Prog(1).out"),
            ("Prog.ngc", 2, "Prog.ngc(2).out"),
            ("Prog", 7, "Prog(7).out"),
            ("a.b.txt", 3, "a.b(3).out"),
            ("lib.o", 1, "lib(1).out"),
        ] {
            let thread = ThreadId::new(thread).expect("1 to 7");
            assert_eq!(image(Path::new(source), thread), Path::new(expect));
        }
    }

    #[test]
    fn other_files_are_placed_next_to_the_image() {
        assert_eq!(sibling_file(Path::new("d/p(1).out"), "map"), Path::new("d/p(1).map"));
        assert_eq!(sibling_file(Path::new("d/image"), "map"), Path::new("d/image.map"));
        assert_eq!(object(Path::new("d/p.c")), Path::new("d/p.o"));
    }
}
