//! `cc67 debug` as editors use it: Microsoft's client for debug adapters, and the types of the protocol.
//!
//! Both are of npm; `.ci/node/install` puts them into `target/node`. Neovim has another client, nvim-dap, which
//! `.ci/nvim-dap` puts into `target/nvim-dap`. What is not there is not used, and the test says so. The extension for VS Code is
//! started by that editor's rules, with Node.js alone.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use harness::{Scratch, command, node_modules, place_command, root, run_in};

#[test]
fn an_editor_debugs_two_threads_forwards_and_backwards() {
    let Some(modules) = node_modules("@vscode/debugadapter-testsupport") else { return };
    let scratch = Scratch::new("editor");
    let here = root().join("tests/command/editor");
    for name in ["one.c", "two.c"] {
        fs::copy(here.join(name), scratch.path().join(name)).expect("files can be copied");
    }
    let folder = scratch.path().canonicalize().expect("it is there");
    let session = run_in(
        "node",
        &folder,
        [here.join("client.js").as_os_str(), command().as_ref(), folder.as_os_str(), modules.as_os_str()],
    );
    assert_eq!((session.code, session.stdout.as_str()), (0, ""), "{}", session.stderr);

    // Each message that was sent is what the protocol's types allow.
    let checked = run_in(
        "node",
        &folder,
        [here.join("protocol.js").as_os_str(), folder.as_os_str(), modules.as_os_str()],
    );
    assert_eq!(checked.code, 0, "{}{}", checked.stdout, checked.stderr);
    assert!(checked.stdout.ends_with(" messages, 0 errors\n"), "{}", checked.stdout);
}

/// A folder in which the command under test has its own name.
fn programs(scratch: &Scratch) -> PathBuf {
    let folder = scratch.path().join("programs");
    fs::create_dir(&folder).expect("folders can be made");
    let file = folder.join(format!("cc67{}", std::env::consts::EXE_SUFFIX));
    place_command(&file);
    folder
}

#[test]
fn f5_in_vs_code_starts_what_the_extension_says() {
    if Command::new("node").arg("--version").output().is_err() {
        println!("not run: there is no Node.js");
        return;
    }
    let scratch = Scratch::new("vscode");
    let folder = scratch.path().join("my machine");
    fs::create_dir(&folder).expect("folders can be made");
    let here = root().join("tests/command/editor");
    fs::copy(here.join("one.c"), folder.join("one.c")).expect("files can be copied");
    let folder = folder.canonicalize().expect("it is there");
    let extension = root().join("cc67/editors/vscode");
    let session =
        run_in("node", &folder, [here.join("vscode.js"), extension, folder.clone(), programs(&scratch)]);
    assert_eq!((session.code, session.stdout.as_str()), (0, ""), "{}", session.stderr);
}

#[test]
fn neovim_debugs_two_threads_forwards_and_backwards() {
    let plug_in = root().join("target/nvim-dap");
    let has_neovim = || Command::new("nvim").arg("--version").output().is_ok();
    if !plug_in.join("lua/dap.lua").is_file() || !has_neovim() {
        println!("not run: Neovim or nvim-dap is not there; `.ci/nvim-dap` fetches the plug-in");
        return;
    }
    let scratch = Scratch::new("neovim");
    let here = root().join("tests/command/editor");
    for name in ["one.c", "two.c"] {
        fs::copy(here.join(name), scratch.path().join(name)).expect("files can be copied");
    }
    let folder = scratch.path().canonicalize().expect("it is there");
    let mut neovim = Command::new("nvim");
    neovim.args(["--headless", "-u", "NONE", "-n", "--cmd"]);
    neovim.arg(format!("set rtp^={}", plug_in.display()));
    neovim.arg("-c").arg(format!("luafile {}", here.join("nvim.lua").display()));
    neovim.env("CC67_COMMAND", command()).env("CC67_FOLDER", &folder).current_dir(&folder);
    let session = neovim.output().expect("it starts");
    assert!(session.status.success(), "{}", String::from_utf8_lossy(&session.stderr));
}
