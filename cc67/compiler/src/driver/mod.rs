//! Compiles source texts to a linked program: the stages in order.
//!
//! [`CompileRequest::run_front_end`] makes the typed tree of a text, [`generate`] an object of the tree; commands call
//! [`compile`] and [`link_units`]. Watched expressions take the same [`CompileRequest::run_front_end`].

mod includers;
mod jumps;
mod library;
mod no_main;

use std::borrow::Cow;
use std::fmt;
use std::hint::black_box;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use kmotiondef::ThreadId;
use kmotiondef::boards::{TargetBoard, boards};
use kmotiondef::firmware::Origin;
use kmotiondef::jumps::JumpFunction;
use kmotiondef::timing::Timing;

use includers::includers;

use crate::bytecode::Generator;
use crate::diag::{Diagnostic, Sink};
use crate::firmware::{Firmware, FirmwareNames};
use crate::ir::function::Function;
use crate::link::{self, LinkErrorKind, LinkedProgram, SectionAddresses};
use crate::lints::LintContext;
use crate::names::Names;
use crate::object::{self, FunctionFacts, Object, UnitBuilder};
use crate::passes::inline::Candidates;
use crate::passes::{self, Level};
use crate::pp::{Headers, HeadersRead};
use crate::source::{FileId, SourceMap};
use crate::target::Target;
use crate::typed::Unit;
use crate::{c67x, files, lints, lower, parse, pp, sema, sharing};

/// The options of a compilation.
#[derive(Clone, Debug)]
pub struct Options {
    /// Include directories, macros, embedded headers.
    pub preprocessor: pp::Options,
    /// The level of optimisation.
    pub level: Level,
    /// The cycles that the code is charged on the simulated board.
    pub timing: Timing,
    /// The target of the code.
    pub target: Target,
    /// The firmware for which programs are compiled.
    pub firmware: Firmware,
    /// The quotients of floating numbers.
    pub division: Division,
    /// Drop sections that `main` cannot reach, when linking.
    pub gc_sections: bool,
    /// The addresses of sections outside the space of the thread.
    pub addresses: SectionAddresses,
    /// The elements of `persist.UserData` in which the PC stores a `float` before a program starts, for warnings.
    pub float_elements: Vec<u32>,
}

/// The quotients of floating numbers that are computed while a program runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Division {
    /// Rounded to nearest, infinite or NaN for a divisor of 0, as in IEEE 754.
    #[default]
    Nearest,
    /// As by the firmware's functions, which the vendor's code calls: the last bits may differ, and a division by 0
    /// yields NaN.
    Firmware,
}

impl Default for Options {
    /// The headers of the board, no definitions, the standard optimisations.
    fn default() -> Self {
        let embedded = kmotiondef::headers::EMBEDDED;
        Self {
            preprocessor: pp::Options { embedded, ..pp::Options::default() },
            level: Level::default(),
            timing: Timing::default(),
            target: Target::default(),
            firmware: Firmware::default(),
            division: Division::default(),
            gc_sections: true,
            addresses: SectionAddresses::default(),
            float_elements: Vec::new(),
        }
    }
}

impl Options {
    /// The board as lints look at it.
    pub(crate) fn lint_context(&self) -> LintContext<'_> {
        LintContext { firmware: &self.firmware, float_elements: &self.float_elements }
    }

    /// The options of the preprocessor, with the headers of the board that the firmware belongs to.
    fn preprocessor_of_board(&self) -> Cow<'_, pp::Options> {
        let board = self.firmware.board();
        if board.is_default() || self.preprocessor.embedded != TargetBoard::default_board().headers() {
            return Cow::Borrowed(&self.preprocessor);
        }
        Cow::Owned(pp::Options { embedded: board.headers(), ..self.preprocessor.clone() })
    }
}

/// A compiled source file, its errors included; or an object that was compiled earlier.
#[derive(Debug)]
pub struct Compilation {
    /// The name of the file, for messages.
    pub name: String,
    /// The files that were read.
    pub sources: SourceMap,
    /// The diagnostics.
    pub sink: Sink,
    /// The object, if there were no errors.
    pub object: Option<Object>,
    /// For a file without `main`, the programs in its folder that include it.
    included_by: Vec<String>,
}

impl Compilation {
    /// Returns the names of the programs in the folder that include a source without `main`.
    #[must_use]
    pub fn included_by(&self) -> &[String] {
        &self.included_by
    }

    /// A compilation that ends before the text is read.
    fn failed(path: &Path, error: Diagnostic) -> Self {
        let mut sink = Sink::new();
        sink.report(error);
        let name = path.to_string_lossy().into_owned();
        Self { name, sources: SourceMap::new(), sink, object: None, included_by: Vec::new() }
    }
}

/// Stack of the thread that compiles: a sum of 30,000 terms is a tree of that depth.
const STACK: usize = 512 << 20;

/// Compiles one source file; `path` is its name in messages, and its folder is searched for includes.
#[must_use]
pub fn compile(path: &Path, text: Vec<u8>, options: &Options, files: &(dyn pp::Files + Sync)) -> Compilation {
    on_large_stack(|| compile_here(path, text, options, files))
        .unwrap_or_else(|error| Compilation::failed(path, *error))
}

/// Runs on a stack that is large enough for any source text.
///
/// # Errors
/// The system starts no thread with such a stack.
pub(crate) fn on_large_stack<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Box<Diagnostic>> {
    thread::scope(|scope| {
        let handle = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || {
            keep_memory_ready();
            work()
        });
        let handle = handle.map_err(|error| {
            let size = STACK >> 20;
            Box::new(Diagnostic::global_error(format!(
                "the system starts no thread with a stack of {size} MiB for the compiler: {error}"
            )))
        })?;
        Ok(handle.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// Memory that a usual compilation takes.
const USUAL_MEMORY: usize = 4 << 20;

/// Allocates memory once and frees it, so that the allocator keeps it for later use.
///
/// On Linux, a thread's heap in the C library starts empty and grows page by page, each time with a system call, which
/// takes a tenth of the time of a small compilation. The first block is so large that it is mapped separately; freeing
/// it raises the allocator's threshold, so that the second block grows the heap and stays in it. The memory is not
/// touched, so it is not actually used; with other allocators this costs two calls.
fn keep_memory_ready() {
    for _ in 0..2 {
        // An unused allocation would be optimised away.
        drop(black_box(Vec::<u8>::with_capacity(USUAL_MEMORY)));
    }
}

/// The typed tree and the names of a text, and the object compiled from it.
pub(crate) fn front_and_object(
    path: &Path,
    text: Vec<u8>,
    options: &Options,
    files: &dyn pp::Files,
) -> (Unit, Compilation, Names) {
    let mut context = CompileContext::default();
    let request = CompileRequest { path, options, files };
    let unit = request.run_front_end(text, &mut context).unit;
    let CompileContext { sources, names, mut sink } = context;
    let object = (!sink.has_errors()).then(|| object_of(&unit, &sources, options, &mut sink));
    let object = object.filter(|_| !sink.has_errors());
    let name = path.to_string_lossy().into_owned();
    (unit, Compilation { name, sources, sink, object, included_by: Vec::new() }, names)
}

/// The object of a unit, for the machine that the options name.
fn object_of(unit: &Unit, sources: &SourceMap, options: &Options, sink: &mut Sink) -> Object {
    match options.target {
        Target::Sim => generate(unit, sources, options.level, options.timing, sink),
        Target::C67x => generate_code(unit, sources, options.level, sink),
    }
}

/// Compiles a text on the calling thread.
pub(crate) fn compile_here(
    path: &Path,
    text: Vec<u8>,
    options: &Options,
    files: &dyn pp::Files,
) -> Compilation {
    let refuse = |error| Compilation::failed(path, error);
    if let Some(what) = files::not_source(path, &text) {
        return refuse(Diagnostic::global_error(format!(
            "{} is not C source text but {what}",
            path.display()
        )));
    }
    if text.len() > pp::limits::FILE_BYTES as usize {
        let most = pp::limits::FILE_BYTES;
        return refuse(Diagnostic::global_error(format!("{} is larger than {most} bytes", path.display())));
    }
    let (text, request) = (Arc::new(text), CompileRequest { path, options, files });
    let (compilation, is_final) = compile_text(request, &text, Headers::AsNeeded);
    if is_final { compilation } else { compile_text(request, &text, Headers::Whole).0 }
}

/// Compiles a text; the second result tells if the first would be the same had all of the headers been read.
fn compile_text(request: CompileRequest<'_>, text: &Arc<Vec<u8>>, headers: Headers) -> (Compilation, bool) {
    let CompileRequest { path, options, files } = request;
    let mut context = CompileContext::default();
    let (FrontEndOutput { unit, .. }, read) = request.front_with(headers, Arc::clone(text), &mut context);
    let CompileContext { sources, names, mut sink } = context;
    let name = path.to_string_lossy().into_owned();
    // Earlier messages may name any declaration; later ones only name declarations that the program uses.
    let is_final = match read {
        HeadersRead::Whole => true,
        HeadersRead::Partly => sink.diagnostics().is_empty(),
        HeadersRead::TooLittle => false,
    };
    if is_final {
        lints::check(&unit, &names, &sources, options.lint_context(), &mut sink);
        if !sink.has_errors() {
            report_call_back_sharing(&unit, &sources, &mut sink);
        }
    }
    let object = (is_final && !sink.has_errors()).then(|| object_of(&unit, &sources, options, &mut sink));
    let object = object.filter(|_| !sink.has_errors());
    let included_by = if unit.defines("main") { Vec::new() } else { includers(path, files) };
    if sink.has_errors() && !included_by.is_empty() {
        sink.report(no_main::remark(&included_by));
    }
    (Compilation { name, sources, sink, object, included_by }, is_final)
}

/// The firmware's pointer to the function that the servo interrupt calls.
const USER_CALL_BACK: &str = "UserCallBack";

/// Adds advice about data that a program shares with its call-back, if it has one.
fn report_call_back_sharing(unit: &Unit, sources: &SourceMap, sink: &mut Sink) {
    // The header of the board declares it, too.
    let names_it =
        |text: &[u8]| text.windows(USER_CALL_BACK.len()).any(|word| word == USER_CALL_BACK.as_bytes());
    let has_call_back = sources.files().any(|(_, file)| file.path.is_some() && names_it(&file.text));
    // The data that a program shares with its call-back do not depend on the thread.
    let thread = ThreadId::all().next().filter(|_| has_call_back);
    let program = thread.map(|thread| sharing::ThreadProgram::new(thread, unit, sources));
    let advice = program.iter().flat_map(sharing::report_call_back_sharing).collect::<Vec<_>>();
    advice.into_iter().for_each(|advice| sink.report(advice));
}

/// A program that is compared with the programs of other threads.
#[derive(Debug)]
pub struct SharingProgram {
    /// The thread.
    pub thread: ThreadId,
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub text: Vec<u8>,
}

/// Compares programs of several threads, except those with errors; returns for each program the advice about the memory
/// that it shares with the others.
#[must_use]
pub fn advise(
    programs: Vec<SharingProgram>,
    options: &Options,
    files: &(dyn pp::Files + Sync),
) -> Vec<Compilation> {
    let first = programs.first().map(|program| program.path.clone());
    let advice = on_large_stack(|| {
        let read = |SharingProgram { thread, path, text }: SharingProgram| {
            let mut context = CompileContext::default();
            let request = CompileRequest { path: &path, options, files };
            let unit = request.run_front_end(text, &mut context).unit;
            (!context.sink.has_errors()).then_some((thread, path, unit, context.sources))
        };
        let units: Vec<_> = programs.into_iter().filter_map(read).collect();
        let listed: Vec<_> = units
            .iter()
            .map(|(thread, _, unit, sources)| sharing::ThreadProgram::new(*thread, unit, sources))
            .collect();
        let advice: Vec<_> = listed.iter().map(|program| sharing::advise(program, &listed)).collect();
        drop(listed);
        let compilations = units.into_iter().zip(advice).map(|((_, path, _, sources), advice)| {
            let mut sink = Sink::new();
            advice.into_iter().for_each(|advice| sink.report(advice));
            let name = path.to_string_lossy().into_owned();
            Compilation { name, sources, sink, object: None, included_by: Vec::new() }
        });
        compilations.collect()
    });
    advice.unwrap_or_else(|error| {
        first.iter().map(|path| Compilation::failed(path, (*error).clone())).collect()
    })
}

/// A request to compile a text.
#[derive(Clone, Copy)]
pub struct CompileRequest<'a> {
    /// The file of the text, for messages and for the search of its includes.
    pub path: &'a Path,
    /// The options.
    pub options: &'a Options,
    /// The files that it may include.
    pub files: &'a dyn pp::Files,
}

impl fmt::Debug for CompileRequest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CompileRequest").field("path", &self.path).finish_non_exhaustive()
    }
}

/// The state that the stages of a compilation share.
#[derive(Debug)]
pub struct CompileContext {
    /// The texts.
    pub sources: SourceMap,
    /// The names in them.
    pub names: Names,
    /// The diagnostics.
    pub sink: Sink,
}

impl Default for CompileContext {
    fn default() -> Self {
        Self { sources: SourceMap::new(), names: Names::new(), sink: Sink::new() }
    }
}

/// The result of the front end.
#[derive(Debug)]
pub struct FrontEndOutput {
    /// The number of the text among the sources.
    pub main: FileId,
    /// The typed tree; complete even after errors.
    pub unit: Unit,
}

impl CompileRequest<'_> {
    /// Preprocesses, parses and checks a text.
    pub fn run_front_end(self, text: Vec<u8>, context: &mut CompileContext) -> FrontEndOutput {
        self.front_with(Headers::Whole, Arc::new(text), context).0
    }

    /// Preprocesses, parses and checks a text, with only the needed declarations of the headers or with all of them.
    fn front_with(
        self,
        headers: Headers,
        text: Arc<Vec<u8>>,
        context: &mut CompileContext,
    ) -> (FrontEndOutput, HeadersRead) {
        let CompileContext { sources, names, sink } = context;
        let preprocessor = self.options.preprocessor_of_board();
        let main = sources.add_file(self.path.to_string_lossy(), Some(self.path), text, None);
        let (tokens, read) =
            pp::preprocess_as(headers, main, &preprocessor, self.files, sources, names, sink);
        let tree = parse::parse(&tokens, sources, names, sink);
        drop(tokens);
        let firmware = &self.options.firmware;
        let mut unit = sema::analyze_as(preprocessor.standard, &tree, names, sources, firmware, sink);
        if self.options.division == Division::Firmware {
            unit.divide_by_firmware();
        }
        (FrontEndOutput { main, unit }, read)
    }
}

/// The depth to which recursive calls are inlined in the controller's code, which should be small.
const CODE_LEVELS: usize = 1;

/// The object of a unit that has no errors.
///
/// Functions that are too large for the machine are reported to `sink`.
#[must_use]
pub fn generate(unit: &Unit, sources: &SourceMap, level: Level, timing: Timing, sink: &mut Sink) -> Object {
    let mut builder = UnitBuilder::new(unit, sources);
    let mut generator = Generator::default();
    let definitions = lower::Definitions::new(unit, builder.signatures());
    let mut candidates = Candidates::default();
    for function in &unit.functions {
        let mut ir = lower::lower(unit, function, &definitions, timing, builder.signatures());
        optimize(&mut ir, level, &mut candidates, sources);
        let about = FunctionFacts { symbol: ir.symbol, signature: ir.signature, end: ir.end };
        generator.keeps_variables(level == Level::None);
        match generator.function(ir, builder.name(about.symbol)) {
            Ok(generated) => builder.function(about, generated),
            Err(error) => sink.report(*error),
        }
    }
    builder.finish(generator.finish())
}

/// The object of a unit that has no errors, for the controller's processor.
///
/// Functions that are too large for the processor are reported to `sink`.
#[must_use]
pub fn generate_code(unit: &Unit, sources: &SourceMap, level: Level, sink: &mut Sink) -> Object {
    let mut builder = UnitBuilder::new(unit, sources);
    let mut generator = c67x::Generator::new(builder.externs(), level);
    let definitions = lower::Definitions::new(unit, builder.signatures());
    let mut candidates = match level {
        Level::Fast => Candidates::new(CODE_LEVELS),
        Level::Full | Level::None => Candidates::new(0),
        Level::Small => Candidates::small(),
    };
    for function in &unit.functions {
        let mut ir = lower::lower(unit, function, &definitions, Timing::Fast, builder.signatures());
        optimize(&mut ir, level, &mut candidates, sources);
        if level != Level::None {
            passes::loops_again(&mut ir);
        }
        if matches!(level, Level::Fast | Level::Small) {
            passes::evaluate(&mut ir);
        }
        if level == Level::Fast {
            passes::unroll(&mut ir);
        }
        let about = FunctionFacts { symbol: ir.symbol, signature: ir.signature, end: ir.end };
        let name = builder.name(about.symbol).to_owned();
        match generator.function(&ir, builder.signatures(), &name) {
            Ok(words) => builder.add_machine_function(about, words),
            Err(error) => sink.report(*error),
        }
    }
    let (code, added) = generator.finish();
    builder.finish_code(code, added)
}

/// Runs the passes over a function; small functions before it may be inlined into it.
fn optimize(ir: &mut Function, level: Level, candidates: &mut Candidates, sources: &SourceMap) {
    passes::run(ir, level);
    if level == Level::None {
        return;
    }
    let file = sources.place(ir.span).map_or(0, |place| place.file.as_u32());
    candidates.add(ir, file);
    if candidates.run(ir, file) {
        passes::run(ir, level);
    }
}

impl Compilation {
    /// All diagnostics, in the order of the program; those without a location come last.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<&Diagnostic> {
        let mut diagnostics: Vec<_> = self.sink.diagnostics().iter().collect();
        diagnostics.sort_by_key(|diagnostic| {
            let order = diagnostic.span.map(|span| self.sources.reading_order(span));
            (order.is_none(), order)
        });
        diagnostics
    }

    /// A unit that was compiled earlier, read from the bytes of an object file.
    ///
    /// # Errors
    /// Why the bytes are not an object.
    pub fn from_object(path: &Path, bytes: &[u8]) -> Result<Self, object::ReadError> {
        let object = Some(Object::read(bytes)?);
        let name = path.to_string_lossy().into_owned();
        Ok(Self { name, sources: SourceMap::new(), sink: Sink::new(), object, included_by: Vec::new() })
    }

    /// Links the object, with the parts of the C library that it needs, for `thread`; linker errors are added to the
    /// diagnostics.
    pub fn link(&mut self, thread: ThreadId, options: &Options) -> Option<LinkedProgram> {
        link_units(std::slice::from_mut(self), thread, options)
    }
}

/// A warning about a firmware file of an unknown version.
fn unknown_version(firmware: &Firmware) -> Option<Diagnostic> {
    let Firmware::File(file) = firmware else { return None };
    let version = file.version().filter(|_| file.board().is_none())?;
    let known: Vec<_> = boards().map(|board| board.version).collect();
    let message = format!("the firmware file is of `{version}`, which cc67 does not know");
    let diagnostic = Diagnostic::global_warning(message).note(format!("known are {}", known.join(", ")));
    Some(diagnostic.note(
        "names and addresses are those of the file; header, structures and types are those of firmware 4.34",
    ))
}

/// Links units, with the parts of the C library that they need, to one program for `thread`; `None` if one of them has
/// errors.
///
/// Missing symbols are added to the diagnostics of the unit that needs them, errors about the whole program to those of
/// the first unit. The units' objects are consumed.
pub fn link_units(units: &mut [Compilation], thread: ThreadId, options: &Options) -> Option<LinkedProgram> {
    if units.iter().any(|unit| unit.object.is_none()) {
        return None;
    }
    let mut objects: Vec<Object> = units.iter_mut().filter_map(|unit| unit.object.take()).collect();
    let target = objects.first().map_or(options.target, Object::target);
    // The library was written for the default board, where its functions are preferred.
    let has_own = !options.firmware.board().is_default();
    let is_in_firmware =
        |name: &str| has_own && options.firmware.origin(name).is_some_and(|origin| origin != Origin::Library);
    let compile = |member: &library::Member<'_>| compile_library(member, target, options.timing).object;
    library::add_needed(&mut objects, is_in_firmware, compile);
    if target == Target::C67x && library::uses(&objects, &JumpFunction::ALL.map(JumpFunction::name)) {
        objects.push(jumps::object());
    }
    let firmware = &options.firmware;
    let options = link::Options { thread, firmware, gc: options.gc_sections, addresses: options.addresses };
    match link::link(&objects, &options) {
        Ok(linked) => {
            let unit = units.first_mut()?;
            for warning in &linked.warnings {
                unit.sink.report(warning.to_diagnostic());
            }
            unit.sink.report_if(unknown_version(firmware));
            Some(linked)
        }
        Err(errors) => {
            for error in &errors {
                let index = error.object.filter(|index| *index < units.len());
                let unit = units.get_mut(index.unwrap_or(0))?;
                let mut diagnostic = error.to_diagnostic();
                if let (LinkErrorKind::Undefined { .. }, Firmware::File(file)) = (&error.kind, firmware)
                    && let Some(version) = file.version()
                {
                    diagnostic = diagnostic.note(format!("the firmware file is of `{version}`"));
                }
                // The places of library members are in no source that the user has.
                diagnostic.span = diagnostic.span.filter(|_| index.is_some());
                if let (LinkErrorKind::NoMain, Some(object)) = (&error.kind, objects.first()) {
                    diagnostic = no_main::advise(diagnostic, object, &unit.included_by);
                }
                if diagnostic.span.is_none() {
                    diagnostic.message = format!("{}: {}", unit.name, diagnostic.message);
                }
                unit.sink.report(diagnostic);
            }
            None
        }
    }
}

/// Compiles one member of the C library.
fn compile_library(member: &library::Member<'_>, target: Target, timing: Timing) -> Compilation {
    let text = member.text.as_bytes().to_vec();
    let options = Options { target, timing, ..Options::default() };
    compile_here(Path::new(member.file), text, &options, &library::NoFiles)
}

#[cfg(test)]
mod tests;
