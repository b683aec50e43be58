//! `cc67 build`: compile and link for a thread, write the requested files.

mod names;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::{Args, ValueEnum};
use coff::{Container, Image};
use kmotiondef::ThreadId;
use kmotiondef::boards::TargetBoard;
use kmotiondef::timing::Timing;

use super::inspect::Folder;
use crate::cli::args::compiler::{SourceArguments, TargetArguments};
use crate::cli::compile::units;
use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};
use crate::cli::report::diagnostics;
use compiler::diag::levels::Levels;
use compiler::image::{self, download, map};
use compiler::inspect::Inspection;
use compiler::link::LinkedProgram;
use compiler::object::{Object, SourceLine};
use compiler::target::Target;
use compiler::{Compilation, link_units};

/// Arguments of `cc67 build`.
#[derive(Debug, Args)]
pub(super) struct BuildArguments {
    /// Sources and objects (.o, .obj) of one program
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Thread of the program, 1 to 7
    #[arg(long, short = 't', value_name = "N", default_value = "1", value_parser = thread)]
    thread: ThreadId,
    /// Name of the image, or of the object with `-c` and one source
    #[arg(short = 'o', long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Compile to objects without linking; same as `--emit object`
    #[arg(short = 'c')]
    compile_only: bool,
    /// Also write a map of all addresses and the largest items
    #[arg(long)]
    map: bool,
    /// Also write the instructions with packets, units and cycles, FILE(N).asm; only with --target c67x
    #[arg(long)]
    asm: bool,
    /// Also write the commands that download the program to a controller's thread
    #[arg(long)]
    download_script: bool,
    /// Form of the image: COFF, or ELF for boards that load it
    #[arg(long, value_name = "FORM", value_enum, default_value_t)]
    form: ImageForm,
    /// Files to write, separated by commas
    #[arg(long, value_name = "KIND", value_enum, value_delimiter = ',')]
    emit: Vec<Emit>,
    #[command(flatten)]
    compiler: SourceArguments,
    #[command(flatten)]
    target: TargetArguments,
}

/// A form of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ImageForm {
    /// As the vendor's compiler writes it, with line numbers
    #[default]
    Coff,
    /// As TI's compiler writes it, without line numbers; Kogna only
    Elf,
}

impl From<ImageForm> for Container {
    fn from(form: ImageForm) -> Self {
        match form {
            ImageForm::Coff => Self::Coff,
            ImageForm::Elf => Self::Elf,
        }
    }
}

/// A form of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Emit {
    /// The linked program, FILE(N).out
    Image,
    /// An object for each source, FILE.o
    Object,
    /// The instructions of `--target sim` as text, FILE(N).txt
    Bytecode,
    /// A map of all addresses, FILE(N).map
    Map,
    /// The instructions of the controller's code with packets, units and cycles, FILE(N).asm
    Asm,
    /// Commands that download the program, FILE(N).kmd
    Download,
}

pub(super) fn thread(text: &str) -> Result<ThreadId, String> {
    let number = text.parse().ok().and_then(ThreadId::new);
    number.ok_or_else(|| format!("valid range 1-{}", ThreadId::MAX))
}

/// Compiles, links and writes.
pub(super) fn build(arguments: &BuildArguments) -> Result<Exit> {
    let options = arguments.compiler.resolve(arguments.target(), Timing::VENDOR)?;
    let levels = arguments.compiler.levels()?;
    let emit = arguments.emit();
    arguments.check_target(&emit)?;
    arguments.check_form(options.firmware.board())?;
    let mut units = units::compile(&arguments.files, &options)?;
    arguments.check_objects(&units)?;
    if emit == [Emit::Object] {
        if diagnostics::report_all(&units, &levels, arguments.compiler.format()) {
            return Ok(Exit::Failure);
        }
        return arguments.write_objects(&units);
    }
    // Linking consumes the objects.
    let objects = if emit.contains(&Emit::Object) { arguments.objects(&units)? } else { Vec::new() };
    let linked = link_units(&mut units, arguments.thread, &options);
    let has_errors = diagnostics::report_all(&units, &levels, arguments.compiler.format());
    let Some(linked) = linked.filter(|_| !has_errors) else { return Ok(Exit::Failure) };
    output::write_all(&objects)?;
    arguments.write_program(&linked, &emit)?;
    output::print(&(sizes(&linked, warnings(&units, &levels)) + "\n"))?;
    let board = options.firmware.board();
    if !board.is_proven {
        terminal::note(&format!(
            "{} is known from its header, manual and firmware file, and was never compared with a board",
            board.name
        ));
    }
    Ok(Exit::Success)
}

impl BuildArguments {
    /// The first file on the command line.
    pub(super) fn first(&self) -> Option<&OsStr> {
        self.files.first().map(|path| path.as_os_str())
    }

    fn target(&self) -> Target {
        self.target.named().unwrap_or(Target::C67x)
    }

    /// Rejects forms of output that do not exist for the controller's processor.
    fn check_target(&self, emit: &[Emit]) -> Result<()> {
        if self.target() == Target::Sim {
            ensure!(
                !emit.contains(&Emit::Asm),
                "`--asm` needs the controller's code: leave out `--target sim`"
            );
            return Ok(());
        }
        ensure!(
            !emit.contains(&Emit::Bytecode),
            "`--emit bytecode` needs `--target sim`: it is made of bytecode"
        );
        Ok(())
    }

    /// Rejects ELF images for boards whose loader does not take them.
    fn check_form(&self, board: &TargetBoard) -> Result<()> {
        if self.form == ImageForm::Elf {
            ensure!(board.has_elf, "`--form elf`: {} loads COFF images alone", board.name);
            ensure!(
                self.target() == Target::C67x,
                "`--form elf` needs the controller's code: leave out `--target sim`"
            );
        }
        Ok(())
    }

    /// Checks that objects are for the requested target.
    fn check_objects(&self, units: &[Compilation]) -> Result<()> {
        for unit in units {
            let Some(target) = unit.object.as_ref().map(Object::target) else { continue };
            let (found, wanted) = match (target, self.target()) {
                (Target::Sim, Target::C67x) => ("bytecode for the simulated board", "sim"),
                (Target::C67x, Target::Sim) => ("code for the controller's processor", "c67x"),
                (Target::Sim, Target::Sim) | (Target::C67x, Target::C67x) => continue,
            };
            bail!("{} holds {found}: compile it again, or link with `--target {wanted}`", unit.name);
        }
        Ok(())
    }

    /// The requested kinds of output.
    fn emit(&self) -> Vec<Emit> {
        let mut emit = self.emit.clone();
        if self.compile_only {
            emit.push(Emit::Object);
        }
        if emit.is_empty() {
            emit.push(Emit::Image);
        }
        if self.map {
            emit.push(Emit::Map);
        }
        if self.asm {
            emit.push(Emit::Asm);
        }
        if self.download_script {
            emit.push(Emit::Download);
        }
        emit
    }

    fn write_objects(&self, units: &[Compilation]) -> Result<Exit> {
        output::write_all(&self.objects(units)?)?;
        Ok(Exit::Success)
    }

    /// The objects of all sources, with their file names.
    fn objects(&self, units: &[Compilation]) -> Result<Vec<(PathBuf, Vec<u8>)>> {
        let sources = self.files.iter().zip(units).filter(|(path, _)| !units::is_object_name(path));
        let sources: Vec<_> = sources.collect();
        ensure!(!sources.is_empty(), "`-c` needs a source; all files are objects already");
        let renamed = self.output.as_ref().filter(|_| self.emit() == [Emit::Object]);
        ensure!(
            renamed.is_none() || sources.len() == 1,
            "`-o` with `-c` names one object, but there are several sources"
        );
        let mut objects = Vec::new();
        for (path, unit) in sources {
            let Some(object) = &unit.object else { continue };
            let name = renamed.cloned().unwrap_or_else(|| names::object(path));
            objects.push((name, object.write().with_context(|| path.display().to_string())?));
        }
        Ok(objects)
    }

    /// Writes all files made from the linked program.
    fn write_program(&self, linked: &LinkedProgram, emit: &[Emit]) -> Result<()> {
        let first = self.files.first().context("there is a file")?;
        let program = self.output.clone().unwrap_or_else(|| names::image(first, self.thread));
        if self.files.contains(&program) {
            bail!("`-o {}` would overwrite an input", program.display());
        }
        let bytes = image::write_as(self.form.into(), linked).with_context(|| first.display().to_string())?;
        for kind in emit {
            match kind {
                Emit::Image => output::write(&program, &bytes)?,
                Emit::Map => {
                    output::write(&names::sibling_file(&program, "map"), map::render(linked).as_bytes())?;
                }
                Emit::Asm => {
                    let inspection = Inspection::read(&bytes).context("the image that was just made")?;
                    let folder = Folder::new(first.parent().unwrap_or(Path::new("")));
                    let text = inspection.cycles()
                        + "\n"
                        + &without_overlap(linked)
                        + &inspection.assembly(&folder, None);
                    output::write(&names::sibling_file(&program, "asm"), text.as_bytes())?;
                }
                Emit::Bytecode => {
                    let text = vm::text::disassemble(&linked.text.bytes);
                    output::write(&names::sibling_file(&program, "txt"), text.as_bytes())?;
                }
                Emit::Download => {
                    let image = Image::read(&bytes).context("the image that was just made")?;
                    let script = download::script(&image, self.thread);
                    output::write(&names::sibling_file(&program, "kmd"), script.as_bytes())?;
                }
                Emit::Object => {}
            }
        }
        Ok(())
    }
}

/// Returns the number of warnings shown.
fn warnings(units: &[Compilation], levels: &Levels) -> usize {
    units.iter().map(|unit| diagnostics::warnings(unit, levels)).sum()
}

/// The loops for which modulo scheduling exceeded its budget, one per line.
fn without_overlap(linked: &LinkedProgram) -> String {
    let loops = linked.functions.iter().flat_map(|function| &function.exceeded);
    let line = |place: &SourceLine| {
        let file = linked.files.get(place.file as usize).map_or("", String::as_str);
        format!(
            "{file}:{}: loop scheduled without pipelining: the search exceeded its work limit\n",
            place.line
        )
    };
    loops.map(line).collect()
}

/// The line that the vendor's editor shows after a compilation: the sizes of the sections, and the size from the first
/// to the last byte, including gaps.
fn sizes(linked: &LinkedProgram, warnings: usize) -> String {
    let warnings = match warnings {
        0 => "No Warnings".to_owned(),
        1 => "1 Warning".to_owned(),
        more => format!("{more} Warnings"),
    };
    let (text, data) = (linked.text.bytes.len(), linked.data.bytes.len());
    let total = linked.bss.address.get() + linked.bss.size - linked.text.address.get();
    format!("No Errors, {warnings}, text={text}, bss={}, data={data}, total={total}", linked.bss.size)
}

/// Returns whether a path has one of the given extensions, ignoring case.
fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let own = path.extension().unwrap_or_default();
    extensions.iter().any(|extension| own.eq_ignore_ascii_case(extension))
}
