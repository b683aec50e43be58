//! `--home DIR`: the folder in which the vendor's library expects its compiler, its server and the files of the
//! firmware.
//!
//! Compiler and server are links to this command, or copies on Windows; the command acts according to the name by which
//! it is called. The library starts the server if it finds none; the server then uses the arguments of the last `cc67
//! serve --home`.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use compiler::firmware;
use kmotiondef::boards::TargetBoard;
use kmotiondef::headers::EMBEDDED;

use crate::cli::io::output;
use crate::cli::io::terminal;

/// The name under which the library expects its server.
const SERVER: &str = "KMotionServer";
/// The name under which the library expects its compiler.
const COMPILER: &str = if cfg!(windows) { "TCC67" } else { "tcc67" };
/// The folder of both: on Windows that of the application and of the library, which searches no other folder.
const BINARIES: &str = if cfg!(windows) { r"KMotion\Release" } else { "bin" };
/// The folders with the firmware's files, and the name of the firmware file in each.
const FIRMWARE: [(&str, &str); 2] = [("DSP_KFLOP", "DSPKFLOP.out"), ("DSP_KMotion", "DSPKMotion.out")];
/// The variables of the G-code interpreter that are stored between runs: home positions, the offset of G92, the
/// coordinate system in use, and the origins of nine (NIST RS274NGC, section 3.2.1).
const VARIABLES: &str = "Data/emc.var";
/// Options that are only for creating the folder, and not for the server in it.
const OURS: [&str; 2] = ["--home", "--mcodes"];
/// The folder of the programs started by M codes.
const PROGRAMS: &str = "MCodes";
/// The file with the last command line of the server: its working folder, and its words, one per line.
const OPTIONS: &str = "serve.options";
/// The file with the output of a server started by the library: on Windows nobody reads its output, and a full pipe
/// would block it.
const SAID: &str = "server.log";
/// The explanation of the folder.
const EXPLANATION: &str = "README.txt";

/// Creates the missing parts of the folder.
///
/// `programs` is the folder of the programs started by M codes.
pub(super) fn make(folder: &Path, programs: Option<&Path>) -> Result<PathBuf> {
    let folder = std::path::absolute(folder).context("--home")?;
    for part in [BINARIES, "Data", FIRMWARE[0].0, FIRMWARE[1].0] {
        let part = folder.join(part);
        fs::create_dir_all(&part).with_context(|| format!("cannot make the folder {}", part.display()))?;
    }
    let command = std::env::current_exe().context("cannot find the file of this command")?;
    for name in [COMPILER, SERVER] {
        link(&command, &folder.join(BINARIES).join(name))?;
    }
    let image = firmware::export(TargetBoard::default_board())?;
    for (place, name) in FIRMWARE {
        let place = folder.join(place);
        supply(&place.join(name), &image)?;
        for (header, text) in EMBEDDED {
            supply(&place.join(header), text)?;
        }
    }
    supply(&folder.join(VARIABLES), variables().as_bytes())?;
    supply(&folder.join(EXPLANATION), explanation().as_bytes())?;
    if let Some(programs) = programs {
        let absolute = fs::canonicalize(programs).map_err(|error| {
            anyhow::anyhow!("`--mcodes {}`: {}", programs.display(), compiler::files::reason(&error))
        })?;
        ensure!(absolute.is_dir(), "`--mcodes {}`: it is not a folder", programs.display());
        link_folder(&absolute, &folder.join(PROGRAMS))?;
    }
    Ok(folder)
}

/// Returns the shell commands that make a program use the folder.
pub(super) fn lines(folder: &Path) -> String {
    if cfg!(windows) {
        let binaries = folder.join(BINARIES);
        let binaries = binaries.display();
        return format!(
            "copy FOLDER_OF_THE_LIBRARY\\*.dll \"{binaries}\"\ncopy YOUR_PROGRAM.exe \"{binaries}\"\n\"{binaries}\\YOUR_PROGRAM.exe\"\n"
        );
    }
    let folder = folder.display();
    format!("export KMOTIONX_HOME='{folder}'\nexport LD_LIBRARY_PATH=FOLDER_OF_THE_LIBRARY\n./YOUR_PROGRAM\n")
}

/// The text that explains the folder to users who find it later.
fn explanation() -> String {
    let (library, place) = if cfg!(windows) {
        ("KMotion library", "Put your application and the DLLs of the library beside them.")
    } else {
        ("KMotionX library", "Have KMOTIONX_HOME name this folder.")
    };
    let end = if cfg!(windows) { "\r\n" } else { "\n" };
    [
        format!("This folder was made by `cc67 serve --home` for programs that use the {library}."),
        String::new(),
        format!(
            "{BINARIES}: {SERVER} and {COMPILER} are cc67 under the names that the library starts. {place}"
        ),
        "DSP_KFLOP, DSP_KMotion: headers, and a firmware file to link programs with.".to_owned(),
        "Data: the variables of the G-code interpreter.".to_owned(),
        format!("{OPTIONS}: what {SERVER} serves, the options of the last `cc67 serve --home`."),
        String::new(),
        "No real controller is reached from here. Delete the folder when you no longer need it.".to_owned(),
    ]
    .map(|line| line + end)
    .concat()
}

/// Stores the arguments for the server that the library starts.
pub(super) fn store_arguments(folder: &Path, words: impl Iterator<Item = OsString>) -> Result<()> {
    let here = std::env::current_dir().context("cannot find the present folder")?;
    let mut text = here.into_os_string();
    let mut skips = false;
    for word in words {
        let shown = word.to_string_lossy().into_owned();
        let is_ours = skips || OURS.iter().any(|name| is_option(&shown, name));
        skips = !skips && OURS.contains(&shown.as_str());
        if !is_ours {
            text.push("\n");
            text.push(word);
        }
    }
    text.push("\n");
    output::write(&folder.join(OPTIONS), text.as_encoded_bytes())
}

/// Returns whether a word is an option with this name, alone or with its value.
fn is_option(word: &str, name: &str) -> bool {
    word.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
}

/// The stored command line, if the command is called by the name of the vendor's server; otherwise `None`.
pub(in crate::cli::commands) fn called_as_server(arguments: &[OsString]) -> Option<Vec<OsString>> {
    let (program, given) = arguments.split_first()?;
    let program = Path::new(program);
    if !program.file_stem()?.eq_ignore_ascii_case(SERVER) {
        return None;
    }
    let mut words: Vec<OsString> = ["cc67", "serve", "--once"].map(OsString::from).into();
    // On Windows it is called by its name without a path.
    let file = if cfg!(windows) { std::env::current_exe().ok()? } else { program.to_owned() };
    let home = file.ancestors().nth(1 + Path::new(BINARIES).components().count());
    if let Some(text) = home.and_then(|home| fs::read_to_string(home.join(OPTIONS)).ok()) {
        if let Some(home) = home.filter(|_| cfg!(windows)) {
            // If the file cannot be written, the output is lost in any case.
            let _ = terminal::write_to(&home.join(SAID));
        }
        let mut lines = text.lines();
        // Paths in the words are relative to the folder in which they were typed.
        if lines.next().is_some_and(|folder| std::env::set_current_dir(folder).is_ok()) {
            words.extend(lines.map(OsString::from));
        }
    }
    words.extend(given.iter().cloned());
    Some(words)
}

/// Writes a file unless it exists; a user's file stays.
fn supply(path: &Path, bytes: &[u8]) -> Result<()> {
    if path.exists() { Ok(()) } else { output::write(path, bytes) }
}

/// Zeros for all variables, with the first coordinate system in use.
fn variables() -> String {
    let axes = |first: u32| first..first + 6;
    let sets = [5161, 5181, 5211].into_iter().chain((5221..=5381).step_by(20));
    let mut numbers: Vec<u32> = sets.flat_map(axes).collect();
    numbers.push(5220);
    numbers.sort_unstable();
    numbers.iter().map(|number| format!("{number}\t{:.6}\n", f64::from(u8::from(*number == 5220)))).collect()
}

/// Creates a link to a folder, so that a program is found there as soon as it is written, together with the files that
/// it includes.
#[cfg(unix)]
fn link_folder(folder: &Path, path: &Path) -> Result<()> {
    link(folder, path)
}

/// Copies the files of a folder, on systems where not all users may create links.
#[cfg(not(unix))]
fn link_folder(folder: &Path, path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(|error| output::cannot_write(path, &error))?;
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let from = entry?.path();
        let to = path.join(from.file_name().unwrap_or_default());
        if from.is_file() {
            fs::copy(&from, &to).map_err(|error| output::cannot_write(&to, &error))?;
        }
    }
    Ok(())
}

/// Creates a link to the command or to a folder; replaces an existing link, but no other file.
#[cfg(unix)]
fn link(command: &Path, path: &Path) -> Result<()> {
    if let Ok(known) = fs::symlink_metadata(path) {
        if !known.is_symlink() {
            bail!("{} exists and is not a link: remove it, or choose another folder", path.display());
        }
        fs::remove_file(path).map_err(|error| output::cannot_write(path, &error))?;
    }
    std::os::unix::fs::symlink(command, path).map_err(|error| output::cannot_write(path, &error))
}

#[cfg(not(unix))]
fn link(command: &Path, path: &Path) -> Result<()> {
    let path = path.with_extension("exe");
    if fs::symlink_metadata(&path).is_ok_and(|known| !known.is_file()) {
        bail!("{} exists and is not a file", path.display());
    }
    fs::copy(command, &path).map(drop).map_err(|error| output::cannot_write(&path, &error))
}

/// The words of this process after the name of the subcommand.
pub(super) fn own_words() -> impl Iterator<Item = OsString> {
    std::env::args_os().skip_while(|word| word != OsStr::new("serve")).skip(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_the_vendors_server_starts_a_server() {
        let words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        assert_eq!(called_as_server(&words("/nowhere/bin/KMotionServer")), Some(words("cc67 serve --once")));
        assert_eq!(called_as_server(&words("cc67 serve")), None);
    }

    #[test]
    fn all_interpreter_variables_are_listed_in_ascending_order() {
        let text = variables();
        assert_eq!(text.lines().count(), 3 * 6 + 1 + 9 * 6);
        assert!(text.starts_with("5161\t0.000000\n"));
        assert!(text.contains("5216\t0.000000\n5220\t1.000000\n5221\t0.000000\n"));
        assert!(text.ends_with("5386\t0.000000\n"));
    }
}
