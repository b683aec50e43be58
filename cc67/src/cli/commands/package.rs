//! `cc67 sweep` and `cc67 study`: functions of the Python package under the names of this command.
//!
//! A command installed with the package has both together. This module looks for Python, and for the package in it.

use std::env;
use std::ffi::OsString;
use std::process::Command;

use anyhow::{Result, bail};
use clap::Args;

use crate::cli::io::exit::Exit;

/// Arguments that go to the package as they are.
#[derive(Debug, Args)]
pub(super) struct PackageArguments {
    /// Arguments for the package; `python3 -m cc67 sweep --help` and `… study --help` list them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true, value_name = "ARGUMENT")]
    arguments: Vec<OsString>,
}

/// The names under which Python may be installed.
pub(super) fn pythons() -> Vec<OsString> {
    let own = env::var_os("CC67_PYTHON");
    own.map_or_else(|| vec!["python3".into(), "python".into()], |own| vec![own])
}

/// Runs a function of the package.
pub(super) fn run(name: &str, arguments: &PackageArguments) -> Result<Exit> {
    for python in pythons() {
        let has_package = Command::new(&python).args(["-c", "import cc67"]).output();
        if !has_package.is_ok_and(|output| output.status.success()) {
            continue;
        }
        let status = Command::new(&python).args(["-m", "cc67", name]).args(&arguments.arguments).status()?;
        return Ok(match status.code() {
            Some(0) => Exit::Success,
            Some(1) => Exit::Failure,
            _ => Exit::WrongInput,
        });
    }
    bail!(
        "`cc67 {name}` is in the Python package, which is not installed for `python3`: `pip install ./cc67/python` in a \
         copy of the repository installs it; CC67_PYTHON names another Python"
    )
}
