//! The text form of the IR: the printed text of a program is read back and prints the same, after every pass.

use std::fs;

use compiler::{passes, pp, stages};
use harness::files;

#[test]
fn the_ir_of_every_program_is_read_back_after_every_pass() {
    let mut read = 0;
    for folder in ["c-programs", "tests/filetests"] {
        for path in files(&harness::root().join(folder), "c") {
            let source = fs::read(&path).expect("the program is readable");
            // Programs with deliberate errors have no IR.
            let Ok(mut text) = stages::lower(&path, source, &pp::Disk) else { continue };
            let name = path.display();
            assert_eq!(stages::reprint(&text).as_ref(), Ok(&text), "{name}");
            for (pass, _) in passes::ALL {
                text =
                    stages::pass(pass, &text).unwrap_or_else(|error| panic!("{name} after {pass}: {error}"));
                assert_eq!(stages::reprint(&text).as_ref(), Ok(&text), "{name} after {pass}");
            }
            read += 1;
        }
    }
    assert!(read >= 400, "only {read} programs were read");
}
