//! Debug information: the location and type of everything that a source names while its program runs.
//!
//! A compilation is a function of its source and options, so information that is not in the image is obtained by
//! compiling the source again: types, scopes, and for every local its register or frame offset at each instruction.
//! [`Model::build`] compares the resulting image with the given one, byte for byte; if they differ, the information would
//! belong to another program, and there is none.

mod eval;
mod scope;
mod text;
mod value;

pub use eval::{CallResults, CodeScope, DebugReader, LocalPlace, Probe};
pub use text::NumberFormat;
pub use value::{Child, DebugValue, DisplayContext};

use std::fmt::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use kmotiondef::ThreadId;
use kmotiondef::boards::{TargetBoard, boards};

use crate::driver::{Options, front_and_object, on_large_stack};
use crate::image;
use crate::inspect::{Entry, EntryKind, Inspection};
use crate::link::LinkedProgram;
use crate::names::Names;
use crate::object::{InlinedPlaces, Object, ObjectFunction, VariablePlaces};
use crate::passes::Level;
use crate::pp::Files;
use crate::source::SourceMap;
use crate::target::Target;
use crate::ty::{FunctionType, ParameterTypes, Type};
use crate::typed::Unit;

pub use crate::object::Location;
pub use crate::watch::{AllowedCalls, CallRequest};

/// The debug information of one program.
#[derive(Debug)]
pub struct Model {
    /// The source file.
    pub path: PathBuf,
    /// Functions in the order of their addresses.
    pub functions: Vec<FunctionModel>,
    text: Vec<u8>,
    unit: Unit,
    names: Names,
    options: Options,
    image: Inspection,
}

/// A function.
#[derive(Debug)]
pub struct FunctionModel {
    /// Its name.
    pub name: String,
    /// Its code.
    pub addresses: Range<u32>,
    /// The file of its definition.
    pub file: String,
    /// The line of its name, and the line of its closing brace.
    pub lines: Range<u32>,
    /// The addresses at which lines begin, ascending, each with the line; the first is after the code that enters the
    /// function.
    pub statements: Vec<(u32, u32)>,
    /// Parameters and variables in the order of their declarations.
    pub locals: Vec<LocalModel>,
    /// The inlined calls.
    pub inlined: Vec<InlinedModel>,
}

/// An inlined call.
#[derive(Debug)]
pub struct InlinedModel {
    /// The called function.
    pub function: String,
    /// The line of the call.
    pub line: u32,
    /// The index of the inlined call that contains this line.
    pub inside: Option<usize>,
    /// Its code, without the code of calls in it.
    pub ranges: Vec<Range<u32>>,
    /// Parameters and variables of the called function.
    pub locals: Vec<LocalModel>,
}

impl FunctionModel {
    /// The inlined calls that contain an instruction, the innermost first.
    pub fn calls_at(&self, address: u32) -> impl Iterator<Item = &InlinedModel> {
        let innermost = self.call_at(address).and_then(|index| self.inlined.get(index));
        std::iter::successors(innermost, |call| self.inlined.get(call.inside?))
    }

    /// The index of the innermost inlined call that contains an instruction.
    #[must_use]
    pub fn call_at(&self, address: u32) -> Option<usize> {
        self.inlined.iter().position(|call| call.ranges.iter().any(|range| range.contains(&address)))
    }
}

/// A parameter or variable of a function.
#[derive(Clone, Debug)]
pub struct LocalModel {
    /// Its name.
    pub name: String,
    /// Its type as C spells it.
    pub ty: String,
    /// The lines in which its name means it.
    pub lines: Range<u32>,
    /// Its locations, each with the addresses for which it holds; elsewhere it is optimised out.
    pub places: Vec<(Range<u32>, Location)>,
    /// The position of its declaration in the source.
    pub(crate) declared: u32,
    type_id: crate::ty::TypeId,
}

impl LocalModel {
    /// Its location when the instruction at an address is next; `None` if it is optimised out there.
    #[must_use]
    pub fn location_at(&self, address: u32) -> Option<Location> {
        self.places.iter().find(|(range, _)| range.contains(&address)).map(|(_, location)| *location)
    }
}

impl Model {
    /// Number of the parameters of a function, which come first among its locals.
    #[must_use]
    pub fn parameters(&self, function: &str) -> usize {
        let found = self.unit.symbols.values().find(|symbol| symbol.name == function);
        let ty = found.map(|symbol| self.unit.types.get(symbol.ty));
        match ty {
            Some(Type::Function(FunctionType {
                parameters: ParameterTypes::Prototype { types, .. },
                ..
            })) => types.len(),
            _ => 0,
        }
    }

    /// The function of the image that has an address, one of the library among them.
    #[must_use]
    pub fn image_function(&self, address: u32) -> Option<&str> {
        let functions = self.image.symbols.iter().filter(|entry| entry.kind == EntryKind::Function);
        let has = |entry: &&Entry| {
            let size = entry.size.unwrap_or(0);
            (entry.address..entry.address.saturating_add(size)).contains(&address)
        };
        functions.filter(has).map(|entry| entry.name.as_str()).next()
    }

    /// Collects the information about a program from its source `text`, and its image for `thread`.
    ///
    /// # Errors
    /// The source does not compile, or results in another image.
    pub fn build(
        path: &Path,
        text: Vec<u8>,
        options: &Options,
        files: &(dyn Files + Sync),
        thread: ThreadId,
        program: &[u8],
    ) -> Result<Self, String> {
        on_large_stack(|| {
            if options.target == Target::C67x {
                return Err("it is code for the controller's processor".to_owned());
            }
            let (mut model, object, sources) = Self::here(path, text, options, files, thread, program)?;
            model.functions = model.functions_of(&object, &sources);
            Ok(model)
        })
        .map_err(|error| error.message)?
    }

    /// Collects the information about code for the controller's processor: functions and their lines from the image,
    /// types, and global variables. The locations of locals are not known.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn of_real_code(
        path: &Path,
        text: Vec<u8>,
        options: &Options,
        files: &(dyn Files + Sync),
        thread: ThreadId,
        program: &[u8],
    ) -> Result<Self, String> {
        on_large_stack(|| {
            let (mut model, object, _) = Self::here(path, text, options, files, thread, program)?;
            model.functions = model.functions_of_image(&object);
            Ok(model)
        })
        .map_err(|error| error.message)?
    }

    fn here(
        path: &Path,
        text: Vec<u8>,
        options: &Options,
        files: &(dyn Files + Sync),
        thread: ThreadId,
        program: &[u8],
    ) -> Result<(Self, Object, SourceMap), String> {
        let (unit, mut compilation, names) = front_and_object(path, text.clone(), options, files);
        let object = compilation.object.clone().ok_or("the source has errors")?;
        let linked: Option<LinkedProgram> = compilation.link(thread, options);
        let made = linked.and_then(|linked| image::write(&linked).ok()).ok_or("the source does not link")?;
        if made != program {
            return Err("the source compiles to a different image".to_owned());
        }
        let image = Inspection::read(program).map_err(|error| error.to_string())?;
        let model = Self {
            path: path.to_owned(),
            functions: Vec::new(),
            text,
            unit,
            names,
            options: options.clone(),
            image,
        };
        Ok((model, object, compilation.sources))
    }

    /// Functions with their statements as the image has them.
    fn functions_of_image(&self, object: &Object) -> Vec<FunctionModel> {
        let entries = self.image.symbols.iter().filter(|entry| entry.kind == EntryKind::Function);
        let mut functions: Vec<_> = entries
            .map(|entry| {
                let addresses = entry.address..entry.address + entry.size.unwrap_or(0).max(4);
                let lines = self.image.lines.iter().filter(|line| addresses.contains(&line.address));
                let statements: Vec<_> = lines.map(|line| (line.address, line.line)).collect();
                let named = |function: &&ObjectFunction| object.symbols[function.symbol].name == entry.name;
                let lines = object.functions.iter().find(named).map(|function| lines_of(object, function));
                let lines = lines.unwrap_or_else(|| {
                    let lines = statements.iter().map(|(_, line)| *line);
                    lines.clone().min().unwrap_or(0)..lines.max().unwrap_or(0)
                });
                FunctionModel {
                    name: entry.name.clone(),
                    addresses,
                    file: entry.file.clone().unwrap_or_default(),
                    lines,
                    statements,
                    locals: Vec::new(),
                    inlined: Vec::new(),
                }
            })
            .collect();
        functions.sort_by_key(|function| function.addresses.start);
        functions
    }

    fn functions_of(&self, object: &Object, sources: &SourceMap) -> Vec<FunctionModel> {
        let mut functions = Vec::new();
        for function in &object.functions {
            let symbol = &object.symbols[function.symbol];
            let entry = self
                .image
                .symbols
                .iter()
                .find(|entry| entry.kind == EntryKind::Function && entry.name == symbol.name);
            let Some(index) = self.unit.functions.iter().position(|known| known.symbol == function.symbol)
            else {
                continue;
            };
            let lines = lines_of(object, function);
            let Some(entry) = entry else {
                functions.push(self.without_code(symbol.name.clone(), lines));
                continue;
            };
            let size = (function.words.end - function.words.start) * 8;
            let addresses = entry.address..entry.address + size;
            let address = |word: u32| entry.address + (word - function.words.start) * 8;
            let locals = |index: usize, lines: &Range<u32>, variables: &[VariablePlaces]| {
                let local = |variable| self.local_model(index, variable, sources, lines, &address);
                variables.iter().filter_map(local).collect::<Vec<_>>()
            };
            let inlined = |call: &InlinedPlaces| {
                let callee = object.functions.iter().find(|known| known.symbol == call.callee);
                let typed = self.unit.functions.iter().position(|known| known.symbol == call.callee);
                let locals = callee
                    .zip(typed)
                    .map(|(callee, typed)| locals(typed, &lines_of(object, callee), &call.variables));
                InlinedModel {
                    function: object.symbols[call.callee].name.clone(),
                    line: sources.place(call.call).map_or(lines.start, |place| place.line),
                    inside: call.inside.map(|index| index as usize),
                    ranges: call.words.iter().map(|run| address(run.start)..address(run.end)).collect(),
                    locals: locals.unwrap_or_default(),
                }
            };
            functions.push(FunctionModel {
                name: symbol.name.clone(),
                statements: self.statements(&addresses, &lines),
                addresses,
                file: object.files.get(symbol.place.file as usize).cloned().unwrap_or_default(),
                locals: locals(index, &lines, &function.variables),
                inlined: function.inlined.iter().map(inlined).collect(),
                lines: lines.clone(),
            });
        }
        functions.sort_by_key(|function| function.addresses.start);
        functions
    }

    /// A function without code of its own: all its calls were inlined into their callers, which contain its lines.
    fn without_code(&self, name: String, lines: Range<u32>) -> FunctionModel {
        let file = self.path.to_string_lossy().into_owned();
        FunctionModel {
            name,
            addresses: 0..0,
            file,
            lines,
            statements: Vec::new(),
            locals: Vec::new(),
            inlined: Vec::new(),
        }
    }

    /// The addresses at which the statements of a function begin; the first follows the words that enter it.
    fn statements(&self, addresses: &Range<u32>, lines: &Range<u32>) -> Vec<(u32, u32)> {
        let program = self.image.program.as_ref().ok();
        let body = program.and_then(|program| {
            let at = program.function_at(kmotiondef::GuestAddr::new(addresses.start))?;
            let function = program.functions().get(program.index_of(at)?)?;
            Some(program.address_of(function.body.start).get())
        });
        let mut statements: Vec<_> = (self.image.lines.iter())
            .filter(|line| addresses.contains(&line.address))
            .map(|line| (line.address.max(body.unwrap_or(line.address)), line.line))
            .collect();
        // The code that enters the function is on the line of its name.
        if let [(_, first), (_, second), ..] = statements.as_slice()
            && *first == lines.start
            && second != first
        {
            statements.remove(0);
        }
        statements
    }

    fn local_model(
        &self,
        index: usize,
        variable: &VariablePlaces,
        sources: &SourceMap,
        lines: &Range<u32>,
        address: &dyn Fn(u32) -> u32,
    ) -> Option<LocalModel> {
        let local = self.unit.functions[index].locals.get(variable.local)?;
        if local.name.is_empty() {
            return None;
        }
        let site = sources.call_site(local.span);
        let line = sources.place(local.span).map_or(lines.start, |place| place.line);
        let until = scope::end_of_block(&self.text, site.lo as usize)
            .map_or(lines.end, |end| scope::line_of(&self.text, end).min(lines.end));
        let is_parameter = self.unit.functions[index].parameters.contains(&variable.local);
        let until = if is_parameter { lines.end } else { until };
        Some(LocalModel {
            name: local.name.clone(),
            ty: self.unit.types.spell(&self.names, local.ty),
            lines: line..until + 1,
            places: (variable.places.iter())
                .map(|(words, location)| (address(words.start)..address(words.end), *location))
                .collect(),
            declared: site.lo,
            type_id: local.ty,
        })
    }

    /// The function that contains an address.
    #[must_use]
    pub fn function_at(&self, address: u32) -> Option<&FunctionModel> {
        self.functions.iter().find(|function| function.addresses.contains(&address))
    }

    /// The name of the function or variable at an address, with the distance from its beginning: `table+8`.
    #[must_use]
    pub fn symbol_at(&self, address: u32) -> Option<String> {
        let is_named = |entry: &Entry| matches!(entry.kind, EntryKind::Function | EntryKind::Object);
        // A string constant has no name in the source.
        let named = |entry: &&Entry| is_named(entry) && !entry.name.contains('.');
        let is_there = |entry: &&Entry| {
            let size = entry.size.unwrap_or(0).max(1);
            (entry.address..entry.address.saturating_add(size)).contains(&address)
        };
        let found = self.image.symbols.iter().filter(named).find(is_there);
        let (name, start) = match found {
            Some(entry) => (entry.name.as_str(), entry.address),
            None => self.function_at(address).map(|known| (known.name.as_str(), known.addresses.start))?,
        };
        let distance = address - start;
        Some(if distance == 0 { name.to_owned() } else { format!("{name}+{distance}") })
    }

    /// The line on which the body of a function begins.
    #[must_use]
    pub fn body_line(&self, function: &FunctionModel) -> u32 {
        let head = scope::begin_of_line(&self.text, function.lines.start);
        scope::begin_of_body(&self.text, head)
            .map_or(function.lines.start, |body| scope::line_of(&self.text, body.saturating_sub(1)))
    }

    /// The function of a name.
    #[must_use]
    pub fn function_named(&self, name: &str) -> Option<&FunctionModel> {
        self.functions.iter().find(|function| function.name == name)
    }

    /// The line of the instruction at an address.
    #[must_use]
    pub fn line_at(&self, address: u32) -> Option<u32> {
        self.image.line_at(address).map(|line| line.line)
    }

    /// The contents of the image.
    #[must_use]
    pub const fn image(&self) -> &Inspection {
        &self.image
    }

    /// The source text.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// Variables of the program outside functions, as the source names them: name, type, address.
    #[must_use]
    pub fn globals(&self) -> Vec<(String, String, u32)> {
        let mut globals = Vec::new();
        for entry in self.image.symbols.iter().filter(|entry| entry.kind == EntryKind::Object) {
            let symbol =
                self.unit.symbols.values().find(|symbol| symbol.name == entry.name && !symbol.is_anonymous());
            if let Some(symbol) = symbol {
                let ty = self.unit.types.spell(&self.names, symbol.ty);
                globals.push((entry.name.clone(), ty, entry.address));
            }
        }
        globals
    }

    /// The debug information as a table.
    #[must_use]
    pub fn table(&self) -> String {
        let mut out = String::new();
        for (name, ty, address) in self.globals() {
            // Writing to a string cannot fail.
            let _ = writeln!(out, "{address:08x} {name}: {ty}");
        }
        for function in &self.functions {
            let Range { start, end } = &function.addresses;
            let (first, last) = (function.lines.start, function.lines.end);
            let _ = writeln!(
                out,
                "{start:08x}-{end:08x} {}() in {} lines {first}-{last}",
                function.name, function.file
            );
            table_of(&function.locals, "  ", &mut out);
            for call in &function.inlined {
                let _ = writeln!(out, "  {}() inlined in line {}", call.function, call.line);
                for Range { start, end } in &call.ranges {
                    let _ = writeln!(out, "    {start:08x}-{end:08x}");
                }
                table_of(&call.locals, "    ", &mut out);
            }
        }
        out
    }
}

/// Writes the locations of locals as lines of a table.
fn table_of(locals: &[LocalModel], indent: &str, out: &mut String) {
    for local in locals {
        let (first, last) = (local.lines.start, local.lines.end.saturating_sub(1));
        let _ = writeln!(out, "{indent}{}: {}, lines {first}-{last}", local.name, local.ty);
        if local.places.is_empty() {
            let _ = writeln!(out, "{indent}  optimised out");
        }
        for (range, location) in &local.places {
            let _ = writeln!(out, "{indent}  {:08x}-{:08x} {location}", range.start, range.end);
        }
    }
}

/// The line of a function's name, and the line of its closing brace.
fn lines_of(object: &Object, function: &ObjectFunction) -> Range<u32> {
    let first = object.symbols[function.symbol].place.line;
    first..function.end.line.max(first)
}

/// Finds the debug information of an image file from the source in its folder.
///
/// The image must result from the given options, at their optimisation level or another one.
///
/// # Errors
/// The reason why there is no information.
pub fn of_image(path: &Path, program: &[u8], options: &Options) -> Result<Model, String> {
    let source = source_of(path, program)?;
    let text =
        crate::files::read(&source).map_err(|error| format!("cannot read {}: {error}", source.display()))?;
    let thread = thread_of(program).ok_or("the image is not linked for a thread")?;
    let levels = [(Level::Full, true), (Level::None, false), (Level::None, true), (Level::Full, false)];
    let others = levels.map(|(level, gc_sections)| Options { level, gc_sections, ..options.clone() });
    let mut first = None;
    for options in std::iter::once(options.clone()).chain(others) {
        // The name of the file is part of the image: as it was given, or as it is found.
        for name in [PathBuf::from(source.file_name().unwrap_or_default()), source.clone()] {
            match Model::build(&name, text.clone(), &options, &crate::pp::Disk, thread, program) {
                Ok(model) => return Ok(Model { path: source, ..model }),
                Err(error) => _ = first.get_or_insert(error),
            }
        }
    }
    Err(first.unwrap_or_default())
}

/// Finds the source of an image: at the path stated in it, or in the image's folder.
///
/// # Errors
/// The source does not exist.
pub fn source_of(path: &Path, program: &[u8]) -> Result<PathBuf, String> {
    let image = Inspection::read(program).map_err(|error| error.to_string())?;
    let main = image.symbols.iter().find(|entry| entry.kind == EntryKind::Function && entry.name == "main");
    let file = main.and_then(|entry| entry.file.clone()).ok_or("the image does not name its source")?;
    let beside = path.parent().unwrap_or(Path::new("")).join(&file);
    let found = [beside, PathBuf::from(&file)].into_iter().find(|path| path.is_file());
    found.ok_or_else(|| format!("its source {file} is not in the same folder"))
}

/// The thread that an image is linked for.
fn thread_of(program: &[u8]) -> Option<ThreadId> {
    let image = Inspection::read(program).ok()?.image;
    let text = image.section(".text")?.address;
    let begins =
        |board: &TargetBoard| ThreadId::all().find(|thread| board.program_base(*thread).get() == text);
    begins(TargetBoard::default_board()).or_else(|| boards().find_map(begins))
}
