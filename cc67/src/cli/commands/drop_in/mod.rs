//! The drop-in mode: `cc67` in place of the vendor's compiler.
//!
//! The controller's PC software starts its compiler with one source file, the firmware file and the address of a
//! thread, and reads the compiler's messages (specification, `dialect.md` section 4, `coff.md` section 8). If it is
//! called by the name `tcc67`, or with such a command line, `cc67` takes the same arguments and answers in the same
//! form: no output on success, otherwise `file:line: message` in less than 4000 bytes and exit code 1. The output is an
//! image for the controller's processor.
//!
//! A program may use only the names in the firmware file; other names are undefined symbols, even if the simulated
//! board has them.

mod arguments;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use kmotiondef::map::{PROGRAM_SIZE, program_base};
use kmotiondef::{GuestAddr, ThreadId};

use arguments::{CompileRequest, DEFAULT_TEXT, Invocation};

use crate::cli::io::exit::Exit;
use crate::cli::io::output;
use compiler::diag::levels::Levels;
use compiler::diag::{Diagnostic, Lint, Severity};
use compiler::firmware::{Firmware, FirmwareFile};
use compiler::link::SectionAddresses;
use compiler::passes::Level;
use compiler::pp::{self, Disk};
use compiler::render::vendor;
use compiler::{Compilation, Options, files, image};

/// The name by which programs call the vendor's compiler.
const NAME: &str = "tcc67";

/// Returns whether the arguments of a process, beginning with the program's name, are meant for the vendor's compiler.
pub(super) fn is_invoked(arguments: &[OsString]) -> bool {
    let Some((program, rest)) = arguments.split_first() else { return false };
    let stem = Path::new(program).file_stem().unwrap_or_default();
    // `cc67` itself begins with a subcommand, and has no options with these names.
    let is_vendors = |argument: &OsString| {
        let argument = argument.to_string_lossy();
        argument == "-text" || argument == "-nostdinc" || argument.starts_with("-Wl,-Ttext")
    };
    stem.eq_ignore_ascii_case(NAME)
        || rest.first().is_some_and(|first| first.to_string_lossy().starts_with('-'))
            && rest.iter().any(is_vendors)
}

/// Acts as the vendor's compiler would for the arguments of a process.
pub(super) fn main(arguments: &[OsString]) -> ExitCode {
    let rest = arguments.get(1..).unwrap_or_default();
    let result = match arguments::parse(rest) {
        Ok(Invocation::Compile(request)) => compile(&request),
        Ok(Invocation::Help) => {
            print(arguments::HELP);
            return Exit::Failure.into();
        }
        Ok(Invocation::SearchDirectories) => {
            let program = arguments.first().map(Path::new).and_then(Path::parent);
            print(&format!("install: {}/\n", program.unwrap_or(Path::new("")).display()));
            return Exit::Success.into();
        }
        Err(message) => Err(format!("tcc: {message}\n")),
    };
    match result {
        Ok(()) => Exit::Success,
        Err(text) => {
            // If stderr is closed, nobody can be informed.
            let _ = io::stderr().write_all(text.as_bytes());
            Exit::Failure
        }
    }
    .into()
}

fn print(text: &str) {
    // If stdout is closed, nobody can be informed.
    let _ = io::stdout().write_all(text.as_bytes());
}

/// Compiles, links and writes; the error contains all messages of the compiler.
fn compile(request: &CompileRequest) -> Result<(), String> {
    let text = files::read(&request.source)
        .map_err(|_| format!("tcc: file '{}' not found\n", request.source.display()))?;
    let firmware = request.firmware.as_deref().map(read_firmware).transpose()?;
    if request.output.is_some() {
        refuse_other_boards(request)?;
    }
    let options = options(request, firmware);
    let mut compilation = compiler::compile(&request.source, text, &options, &Disk);
    let Some(output) = &request.output else { return silent_without_errors(&compilation) };
    if request.firmware.is_none() {
        compilation.sink.report(Diagnostic::global_error(
            "no firmware file given: its name comes after the source file and ends in .out",
        ));
    }
    let linked = thread(request.text).and_then(|thread| compilation.link(thread, &options));
    silent_without_errors(&compilation)?;
    let source = request.source.display();
    let Some(linked) = linked else { return Err(format!("tcc: '{source}' cannot be linked\n")) };
    let image = if request.has_symbols { image::write(&linked) } else { image::write_stripped(&linked) };
    let image = image.map_err(|error| format!("tcc: '{source}': {error}\n"))?;
    output::write(output, &image)
        .map_err(|_| format!("tcc: Unable to open output file '{}'\n", output.display()))
}

/// The name of the firmware file of the older board.
const OTHER_FIRMWARE: &str = "DSPKMotion";
/// The reason why a program may be compiled for the older board by mistake (host-protocol.md section 9, item 7).
const MISTAKEN: &str =
    "the KMotion library takes a board that is in use by another client for the older KMotion: try again";

/// Rejects programs for the older board: they would be downloaded to an address at which no thread of this board
/// begins.
fn refuse_other_boards(request: &CompileRequest) -> Result<(), String> {
    let stem = request.firmware.as_deref().and_then(Path::file_stem).unwrap_or_default();
    if stem.eq_ignore_ascii_case(OTHER_FIRMWARE) {
        return Err(format!("tcc: {OTHER_FIRMWARE}.out is not the firmware of a KFLOP; {MISTAKEN}\n"));
    }
    let begin = ThreadId::all().next().map_or(0, |first| program_base(first).get());
    let is_inside = (begin..begin + PROGRAM_SIZE * u32::from(ThreadId::MAX)).contains(&request.text);
    if !is_inside && request.text != DEFAULT_TEXT {
        return Err(format!(
            "tcc: address {:x} is in no thread of a KFLOP: thread 1 begins at {begin:x}, each of the {} has {PROGRAM_SIZE:x} bytes; {MISTAKEN}\n",
            request.text,
            ThreadId::MAX,
        ));
    }
    Ok(())
}

/// The firmware's symbols.
fn read_firmware(path: &Path) -> Result<Firmware, String> {
    let bytes = files::read(path).map_err(|_| format!("tcc: file '{}' not found\n", path.display()))?;
    let file = FirmwareFile::read(&bytes).map_err(|error| format!("tcc: '{}': {error}\n", path.display()))?;
    if let Some(version) = file.version().filter(|version| !version.contains("KFLOP")) {
        return Err(format!("tcc: '{}' is the firmware of another board: {version}\n", path.display()));
    }
    Ok(Firmware::File(Arc::new(file)))
}

fn options(request: &CompileRequest, firmware: Option<Firmware>) -> Options {
    let defines =
        request.defines.iter().map(|(name, value)| (name.clone(), value.clone().unwrap_or("1".to_owned())));
    Options {
        preprocessor: pp::Options {
            include_dirs: request.include_dirs.clone(),
            defines: defines.collect(),
            undefines: request.undefines.clone(),
            embedded: kmotiondef::headers::EMBEDDED,
            standard: request.standard,
        },
        level: Level::default(),
        target: compiler::target::Target::C67x,
        firmware: firmware.unwrap_or_default(),
        addresses: SectionAddresses {
            text: Some(GuestAddr::new(request.text)),
            data: request.data.map(GuestAddr::new),
            bss: request.bss.map(GuestAddr::new),
        },
        ..Options::default()
    }
}

/// The thread whose space begins at an address; for other addresses, the first thread.
fn thread(text: u32) -> Option<ThreadId> {
    let own = ThreadId::all().find(|thread| program_base(*thread).get() == text);
    own.or_else(|| ThreadId::all().next())
}

/// Returns the errors of a compilation as text, if it has any.
fn silent_without_errors(compilation: &Compilation) -> Result<(), String> {
    let mut levels = Levels::default();
    levels.enable(Lint::Vendor);
    let shown: Vec<_> =
        compilation.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic)).collect();
    if shown.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        return Err(vendor::render(&shown, &compilation.sources));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_or_the_command_line_of_the_vendors_compiler_is_recognised() {
        for (line, expect) in [
            ("tcc67", true),
            ("/opt/KMotion/TCC67.exe prog.c", true),
            ("cc67 -text 80050000 -g -nostdinc prog.c DSPKFLOP.out", true),
            ("cc67 -Wl,-Ttext,80050000 -static prog.c", true),
            ("cc67 run -I x prog.c", false),
            ("cc67 --version", false),
            ("cc67 check -text.c", false),
            ("cc67", false),
        ] {
            let arguments: Vec<_> = line.split(' ').map(OsString::from).collect();
            assert_eq!(is_invoked(&arguments), expect, "{line}");
        }
    }
}
