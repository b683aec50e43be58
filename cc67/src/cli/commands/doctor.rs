//! `cc67 doctor`: the installed software on one screen, for bug reports.
//!
//! Each item is located in the way the command itself does it. Nothing is changed, and nothing is sent to a controller.

use std::env;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use boot::FirmwareFile;
use clap::Args;
use kmotiondef::limits::VERSION as FIRMWARE;

use super::{VERSION, examples, package};
use crate::cli::io::exit::Exit;
use crate::cli::io::{input, output};

/// Arguments of `cc67 doctor`.
#[derive(Debug, Args)]
pub(super) struct DoctorArguments {
    /// Also look at this firmware file
    #[arg(long, value_name = "FILE")]
    boot: Option<PathBuf>,
}

/// Prints all rows.
pub(super) fn doctor(arguments: &DoctorArguments) -> Result<Exit> {
    let mut text = version();
    row(&mut text, "examples", &format!("{} programs", examples::count()));
    row(&mut text, "firmware", &format!("{} (modelled)", FIRMWARE.trim_end()));
    if let Some(path) = &arguments.boot {
        row(&mut text, "", &firmware_file(path)?);
    }
    row(&mut text, "editors", &editors());
    row(&mut text, "Python", &python());
    for line in controllers(Path::new("/sys/bus/usb/devices"), Path::new("/dev/bus/usb")) {
        row(&mut text, "controller", &line);
    }
    output::print(&text)?;
    Ok(Exit::Success)
}

/// Returns the text of `cc67 --version --verbose`: the version, and the build options.
pub(super) fn version() -> String {
    let mut text = format!("cc67 {VERSION}\n");
    let file = env::current_exe().map_or_else(|error| error.to_string(), |path| path.display().to_string());
    row(&mut text, "command", &file);
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    row(&mut text, "built for", &format!("{} {}, {build}", env::consts::OS, env::consts::ARCH));
    let native = if cfg!(feature = "native") { "native" } else { "native (not built in)" };
    row(&mut text, "engines", &format!("bytecode, {native}, dsp"));
    row(&mut text, "live page", if cfg!(feature = "live") { "built in" } else { "not built in" });
    text
}

fn row(text: &mut String, name: &str, value: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{name:<12}{value}");
}

/// A firmware file with the version stated in it.
fn firmware_file(path: &Path) -> Result<String> {
    let file = FirmwareFile::read(&input::read(path)?).with_context(|| path.display().to_string())?;
    Ok(format!("{} (`--boot {}`)", file.version().trim_end(), path.display()))
}

/// The path of a command found in `PATH`.
fn find(name: &str) -> Option<PathBuf> {
    let folders = env::var_os("PATH")?;
    let names = [name.to_owned(), format!("{name}.exe"), format!("{name}.cmd")];
    env::split_paths(&folders)
        .flat_map(|folder| names.clone().map(|name| folder.join(name)))
        .find(|path| path.is_file())
}

/// The editors in `PATH`; for VS Code also whether it has the extension.
fn editors() -> String {
    const EDITORS: &[(&str, &str)] = &[
        ("VS Code", "code"),
        ("VSCodium", "codium"),
        ("Neovim", "nvim"),
        ("Emacs", "emacs"),
        ("Helix", "hx"),
    ];
    let found =
        EDITORS.iter().filter_map(|(name, command)| Some(format!("{name} ({})", find(command)?.display())));
    let mut found: Vec<_> = found.collect();
    found.extend(extension());
    if found.is_empty() { "none found in PATH".to_owned() } else { found.join(", ") }
}

/// The extension of cc67 in the folders of VS Code and its derivatives.
fn extension() -> Option<String> {
    let home = env::home_dir()?;
    let folders = [".vscode", ".vscode-server", ".vscode-oss"].map(|name| home.join(name).join("extensions"));
    let entries = folders.iter().filter_map(|folder| folder.read_dir().ok()).flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter_map(|name| Some(format!("extension {}", name.strip_prefix("cc67.cc67-")?))).max()
}

/// Python, and the installed package.
fn python() -> String {
    const PROGRAM: &str = "import sys\ntry:\n import cc67\n has = 'package cc67 ' + cc67.__version__\nexcept (ImportError, AttributeError):\n has = 'without \
                           the package cc67'\nprint('.'.join(map(str, sys.version_info[:3])) + ', ' + has)";
    for python in package::pythons() {
        if let Ok(output) = Command::new(&python).args(["-c", PROGRAM]).output()
            && output.status.success()
        {
            let said = String::from_utf8_lossy(&output.stdout);
            return format!("{} {}", python.to_string_lossy(), said.trim());
        }
    }
    "not found".to_owned()
}

/// The controllers at the USB ports of a Linux system, and whether this user has access to each.
fn controllers(devices: &Path, nodes: &Path) -> Vec<String> {
    if !cfg!(target_os = "linux") {
        return vec!["USB ports are not looked at on this system".to_owned()];
    }
    let Ok(entries) = devices.read_dir() else { return vec!["no USB here".to_owned()] };
    let mut found: Vec<_> = entries.flatten().filter_map(|entry| controller(&entry.path(), nodes)).collect();
    found.sort();
    if found.is_empty() {
        found.push("none connected by USB".to_owned());
    }
    found
}

/// A device, if it is a KFLOP (0403:f231) or its predecessor KMotion (0403:f230).
fn controller(device: &Path, nodes: &Path) -> Option<String> {
    let value = |name: &str| Some(std::fs::read_to_string(device.join(name)).ok()?.trim().to_owned());
    let kind = match (value("idVendor")?.as_str(), value("idProduct")?.as_str()) {
        ("0403", "f231") => "KFLOP",
        ("0403", "f230") => "KMotion",
        _ => return None,
    };
    let node = nodes.join(format!("{:0>3}/{:0>3}", value("busnum")?, value("devnum")?));
    let rights = if may_use(&node) {
        "may be used"
    } else {
        "no permission: a udev rule SUBSYSTEM==\"usb\", ATTRS{idVendor}==\"0403\", MODE=\"0666\" gives it"
    };
    Some(format!("{kind} at {}: {rights}", node.display()))
}

#[cfg(unix)]
fn may_use(node: &Path) -> bool {
    use rustix::fs::{Access, access};

    access(node, Access::READ_OK | Access::WRITE_OK).is_ok()
}

#[cfg(not(unix))]
fn may_use(_: &Path) -> bool {
    false
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_controller_is_found_with_the_rights_of_its_node() {
        let folder = env::temp_dir().join(format!("cc67-doctor-{}", std::process::id()));
        let (devices, nodes) = (folder.join("devices"), folder.join("nodes"));
        for (name, vendor, product) in [("1-1", "0403", "f231"), ("1-2", "046d", "c31c")] {
            fs::create_dir_all(devices.join(name)).expect("folders can be made");
            for (file, text) in
                [("idVendor", vendor), ("idProduct", product), ("busnum", "1"), ("devnum", "7")]
            {
                fs::write(devices.join(name).join(file), format!("{text}\n")).expect("files can be written");
            }
        }
        let node = nodes.join("001/007");
        let found = controllers(&devices, &nodes);
        assert!(
            matches!(&found[..], [one] if one.contains("KFLOP") && one.contains("no permission")),
            "{found:?}"
        );
        fs::create_dir_all(nodes.join("001")).expect("folders can be made");
        fs::write(&node, "").expect("files can be written");
        assert_eq!(controllers(&devices, &nodes), [format!("KFLOP at {}: may be used", node.display())]);
        fs::remove_dir_all(devices.join("1-1")).expect("folders can be removed");
        assert_eq!(controllers(&devices, &nodes), ["none connected by USB"]);
        fs::remove_dir_all(&folder).expect("folders can be removed");
    }
}
