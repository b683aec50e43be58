//! Sources to a program that can be linked for any thread.
//!
//! A source is compiled once; what is kept are the objects, as `cc67 build -c` writes them. So a program can be given to
//! other processes and machines, where it is linked for the thread that it gets.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cc67_host::UserProgram;
use compiler::diag::levels::Levels;
use compiler::diag::{Lint, Severity};
use compiler::firmware::{Firmware, FirmwareFile};
use compiler::object::{ReadError, is_object};
use compiler::passes::Level;
use compiler::pp::{Disk, Standard};
use compiler::render::human::Color;
use compiler::render::{self, Format};
use compiler::target::Target;
use compiler::{Compilation, Options, files, link_units, pp};
use kmotiondef::ThreadId;
use kmotiondef::boards::{TargetBoard, boards};
use pyo3::prelude::*;

use crate::errors::{LoadError, input, unreadable};

/// The options of a compilation, as Python passes them.
#[derive(Clone, Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CompileArguments {
    include: Vec<PathBuf>,
    define: Vec<(String, String)>,
    undefine: Vec<String>,
    optimize: String,
    warnings: Vec<String>,
    std: String,
    firmware: Option<PathBuf>,
    boot: Option<PathBuf>,
    board: Option<String>,
    target: Option<String>,
}

impl CompileArguments {
    fn options(&self) -> PyResult<Options> {
        let names = self.define.iter().map(|(name, _)| name).chain(&self.undefine);
        if let Some(name) = names.into_iter().find(|name| !is_macro_name(name)) {
            return Err(input(format!("`{name}` is not a macro name")));
        }
        let standard = Standard::named(&self.std)
            .ok_or_else(|| input(format!("std must be c90, c99, c11, c17 or vendor, not {:?}", self.std)))?;
        Ok(Options {
            preprocessor: pp::Options {
                include_dirs: self.include.clone(),
                defines: self.define.clone(),
                undefines: self.undefine.clone(),
                standard,
                ..Options::default().preprocessor
            },
            level: match self.optimize.as_str() {
                "0" => Level::None,
                "1" => Level::Full,
                "2" => Level::Fast,
                "s" => Level::Small,
                other => return Err(input(format!("optimize must be 0, 1, 2 or \"s\", not {other:?}"))),
            },
            firmware: self.firmware()?,
            target: self.target()?,
            gc_sections: self.optimize != "0",
            ..Options::default()
        })
    }

    fn target(&self) -> PyResult<Target> {
        match self.target.as_deref() {
            None if self.boot.is_some() => Ok(Target::C67x),
            None => Ok(Options::default().target),
            Some("c67x") => Ok(Target::C67x),
            Some("sim") => Ok(Target::Sim),
            Some(other) => Err(input(format!("target must be \"c67x\" or \"sim\", not {other:?}"))),
        }
    }

    fn firmware(&self) -> PyResult<Firmware> {
        if let Some(name) = &self.board {
            let names = || boards().map(|board| board.name).collect::<Vec<_>>().join(", ");
            let board = TargetBoard::named(name)
                .ok_or_else(|| input(format!("no board is called {name:?}; the boards are {}", names())))?;
            return Ok(if board.is_default() { Firmware::default() } else { Firmware::Board(board) });
        }
        let Some(path) = self.boot.as_ref().or(self.firmware.as_ref()) else {
            return Ok(Firmware::default());
        };
        let file = FirmwareFile::read(&read(path)?);
        let file = file.map_err(|error| input(format!("{}: {error}", path.display())))?;
        Ok(Firmware::File(Arc::new(file)))
    }

    fn levels(&self) -> PyResult<Levels> {
        let mut levels = Levels::default();
        for switch in &self.warnings {
            levels.set(switch).map_err(input)?;
        }
        Ok(levels)
    }
}

fn is_macro_name(name: &str) -> bool {
    let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    name.starts_with(is_letter) && name.chars().all(|c| is_letter(c) || c.is_ascii_digit())
}

/// The bytes of a file.
pub(crate) fn read(path: &Path) -> PyResult<Vec<u8>> {
    files::read(path).map_err(|error| unreadable(path, &error))
}

/// A program, not yet linked for a thread unless it is an image.
#[pyclass(frozen, name = "Program")]
#[derive(Debug)]
pub(crate) struct LinkableProgram {
    path: PathBuf,
    content: Content,
    pub(crate) options: Options,
}

/// The parts of a program.
#[derive(Clone, Debug)]
enum Content {
    /// Names and bytes of objects.
    Objects(Vec<(String, Vec<u8>)>),
    /// An image, which is linked for a thread already.
    Image(Vec<u8>),
}

impl LinkableProgram {
    /// The program for a thread.
    pub(crate) fn for_thread(&self, thread: ThreadId) -> PyResult<UserProgram> {
        let objects = match &self.content {
            Content::Image(bytes) => return Ok(UserProgram::of_bytes(&self.path, thread, bytes.clone())),
            Content::Objects(objects) => objects,
        };
        let unit = |(name, bytes): &(String, Vec<u8>)| {
            Compilation::from_object(Path::new(name), bytes)
                .map_err(|error| input(format!("{name}: {error}")))
        };
        let mut units = objects.iter().map(unit).collect::<PyResult<Vec<_>>>()?;
        let linked = link_units(&mut units, thread, &self.options);
        let linked = linked.ok_or_else(|| LoadError::new_err(what_is_wrong(&units, thread)))?;
        UserProgram::of_linked(&self.path, &linked).map_err(|error| LoadError::new_err(error.to_string()))
    }
}

fn what_is_wrong(units: &[Compilation], thread: ThreadId) -> String {
    let text: String = units
        .iter()
        .map(|unit| {
            render::render(&owned(unit, &Levels::default()), &unit.sources, Format::Human, Color::Never)
        })
        .collect();
    format!("the program cannot be linked for thread {thread}\n{text}")
}

#[pymethods]
impl LinkableProgram {
    /// Make a program from an image, as `cc67 build` writes it.
    #[staticmethod]
    fn from_image(path: PathBuf, bytes: Vec<u8>) -> Self {
        Self { path, content: Content::Image(bytes), options: Options::default() }
    }

    /// Make a program from objects that were compiled earlier.
    #[staticmethod]
    fn from_objects(
        path: PathBuf,
        objects: Vec<(String, Vec<u8>)>,
        request: CompileArguments,
    ) -> PyResult<Self> {
        Ok(Self { path, content: Content::Objects(objects), options: request.options()? })
    }

    /// Return names and bytes of the objects; `None` for an image.
    fn objects(&self) -> Option<Vec<(String, Vec<u8>)>> {
        match &self.content {
            Content::Objects(objects) => Some(objects.clone()),
            Content::Image(_) => None,
        }
    }

    /// Return the image for a thread, 1 to 7.
    fn image(&self, py: Python<'_>, number: i32) -> PyResult<Vec<u8>> {
        let thread = thread(number)?;
        Ok(py.detach(|| self.for_thread(thread))?.image)
    }
}

/// A thread of that number.
pub(crate) fn thread(number: i32) -> PyResult<ThreadId> {
    ThreadId::new(number).ok_or_else(|| input(format!("no such thread {number} (1-{})", ThreadId::MAX)))
}

/// Compile sources and read objects, which make one program together, and link it once as a check. Return the program,
/// if it has no errors, and the diagnostics, one JSON object each.
#[pyfunction]
pub(crate) fn compile(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    request: CompileArguments,
    number: i32,
) -> PyResult<(Option<LinkableProgram>, Vec<String>)> {
    let (options, levels, thread) = (request.options()?, request.levels()?, thread(number)?);
    let Some(path) = paths.first().cloned() else { return Err(input("there is no file to compile")) };
    let sources = paths.into_iter().map(|path| Ok((read(&path)?, path))).collect::<PyResult<Vec<_>>>()?;
    py.detach(|| {
        let mut units = Vec::new();
        for (bytes, path) in sources {
            units.push(unit(&path, bytes, &options)?);
        }
        let write = |unit: &Compilation| {
            let object = unit.object.as_ref()?;
            Some(object.write().map(|bytes| (unit.name.clone(), bytes)))
        };
        let objects: Option<Result<Vec<_>, _>> = units.iter().map(write).collect();
        let objects = objects.transpose().map_err(input)?;
        let is_linked = link_units(&mut units, thread, &options).is_some();
        let mut found = Vec::new();
        let mut has_errors = false;
        for unit in &units {
            let diagnostics = owned(unit, &levels);
            has_errors |= diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
            let text = render::render(&diagnostics, &unit.sources, Format::Json, Color::Never);
            found.extend(text.lines().map(str::to_owned));
        }
        let objects = objects.filter(|_| is_linked && !has_errors);
        let program = objects.map(|objects| LinkableProgram {
            path,
            content: Content::Objects(objects),
            options: options.clone(),
        });
        Ok((program, found))
    })
}

/// The unit of one file; its content decides whether it is an object.
fn unit(path: &Path, bytes: Vec<u8>, options: &Options) -> PyResult<Compilation> {
    let has_suffix = |suffixes: &[&str]| {
        path.extension().is_some_and(|suffix| suffixes.iter().any(|known| suffix.eq_ignore_ascii_case(known)))
    };
    if !has_suffix(&["o", "obj"]) && !is_object(&bytes) {
        if has_suffix(&["out"]) {
            return Err(input(format!("{}: {}", path.display(), ReadError::Linked)));
        }
        return Ok(compiler::compile(path, bytes, options, &Disk));
    }
    Compilation::from_object(path, &bytes).map_err(|error| input(format!("{}: {error}", path.display())))
}

/// The diagnostics that are shown.
fn owned(unit: &Compilation, levels: &Levels) -> Vec<compiler::diag::Diagnostic> {
    unit.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic)).collect()
}

/// Return the names of all warnings.
#[pyfunction]
pub(crate) fn lints() -> Vec<&'static str> {
    Lint::ALL.iter().map(|lint| lint.name()).collect()
}
