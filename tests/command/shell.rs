//! Completions and manual pages: there is one for all that the command can do.

use std::fs;

use harness::{Scratch, cc67};

#[test]
fn every_shell_has_completions() {
    let scratch = Scratch::new("completions");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = cc67(&scratch, ["completions", shell]);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{shell}");
        for word in ["inspect", "no-shortcuts"] {
            assert!(output.stdout.contains(word), "{shell} does not know {word}");
        }
    }
}

#[test]
fn every_subcommand_has_a_manual_page() {
    let scratch = Scratch::new("man");
    let output = cc67(&scratch, ["man", "pages"]);
    assert_eq!(output.render(), "---- exit 0\n");
    for (page, text) in [
        ("cc67.1", "cc67\\-run(1)"),
        ("cc67-run.1", "\\-\\-profile"),
        ("cc67-test.1", "\\-\\-bless"),
        ("cc67-build.1", "\\-\\-map"),
    ] {
        let found = fs::read_to_string(scratch.path().join("pages").join(page)).expect(page);
        assert!(found.contains(text), "{page} does not say {text}");
    }
}
