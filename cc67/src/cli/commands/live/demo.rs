//! The demonstration: a machine that homes and mills, as files in a new folder, which can be edited while it runs.

use std::path::{Path, PathBuf};
use std::{env, fs, process};

use anyhow::{Context, Result};

/// The files, by name.
const FILES: [(&str, &str); 4] = [
    ("mill.c", include_str!("demo/mill.c")),
    ("panel.c", include_str!("demo/panel.c")),
    ("machine.h", include_str!("demo/machine.h")),
    ("mill.toml", include_str!("demo/mill.toml")),
];

/// Writes the files into a new folder, and prints its path.
pub(super) fn write() -> Result<PathBuf> {
    let folder = env::temp_dir().join(format!("cc67-demo-{}", process::id()));
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for (name, text) in FILES {
        fs::write(folder.join(name), text).with_context(|| format!("cannot write {name}"))?;
    }
    Ok(folder)
}

/// The arguments for showing it, after the name of the command.
pub(super) fn arguments(folder: &Path) -> Vec<String> {
    let file = |name: &str| folder.join(name).display().to_string();
    let watch = "dest0,dest1,dest2,bit140";
    [
        file("mill.c"),
        file("panel.c"),
        "--machine".to_owned(),
        file("mill.toml"),
        "--watch".to_owned(),
        watch.to_owned(),
    ]
    .to_vec()
}
