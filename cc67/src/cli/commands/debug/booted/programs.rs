//! What is known about the programs on a booted board: functions, lines, and variables outside of functions.
//!
//! Lines and functions are those of the images. Types come from compiling the source again, as for the modelled board.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use compiler::debug::{DebugReader, LocalModel, LocalPlace, Model, Probe, source_of};
use compiler::inspect::{EntryKind, Inspection};
use compiler::pp::Disk;
use compiler::{Options, files};
use kmotiondef::{GuestAddr, ThreadId};
use runtime::trace::Item;

use cc67_host::{Session, UserProgram};
use vm::memory::GuestMemory;

/// A program in a thread.
#[derive(Debug)]
pub(super) struct BootedProgram {
    /// The thread.
    pub(super) thread: ThreadId,
    image: Inspection,
    /// Its types, or why they are not known.
    pub(super) model: Result<Arc<Model>, String>,
}

/// A line of a source where code begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct CodeLine {
    /// The thread whose program it is of.
    pub(super) thread: ThreadId,
    /// The function.
    pub(super) function: String,
    /// The file.
    pub(super) file: String,
    /// The line; 0 if the image does not say.
    pub(super) line: u32,
}

/// A value in words.
#[derive(Clone, Debug)]
pub(super) struct ShownValue {
    /// Its type as C spells it.
    pub(super) ty: String,
    /// The value.
    pub(super) text: String,
    /// The same as a number, if it is one.
    pub(super) number: Option<f64>,
}

/// The programs in the threads.
#[derive(Debug, Default)]
pub(super) struct BootedPrograms {
    known: Vec<BootedProgram>,
    /// First and last addresses of all functions.
    functions: BTreeMap<u32, u32>,
    /// Where lines begin.
    lines: BTreeSet<u32>,
}

impl BootedPrograms {
    /// What is known about these programs, compiled as the options say.
    pub(super) fn new(programs: &[UserProgram], options: &Options) -> Self {
        let known = |program: &UserProgram| {
            let image = Inspection::read(&program.image).ok()?;
            Some(BootedProgram {
                thread: program.thread,
                image,
                model: model(program, options).map(Arc::new),
            })
        };
        let known: Vec<_> = programs.iter().filter_map(known).collect();
        let code = known.iter().flat_map(BootedProgram::functions).map(|(_, code)| (code.start, code.end));
        let functions = code.collect();
        let lines = known.iter().flat_map(BootedProgram::statements).map(|(at, _)| at).collect();
        Self { known, functions, lines }
    }

    /// All of them.
    pub(super) fn all(&self) -> &[BootedProgram] {
        &self.known
    }

    /// The program of a thread.
    pub(super) fn of(&self, thread: ThreadId) -> Option<&BootedProgram> {
        self.known.iter().find(|known| known.thread == thread)
    }

    /// Where functions begin, in all programs.
    pub(super) fn entries(&self) -> impl Iterator<Item = u32> {
        self.functions.keys().copied()
    }

    /// The code of the function that begins at an address, if one does.
    pub(super) fn begins(&self, at: u32) -> Option<Range<u32>> {
        self.functions.get(&at).map(|end| at..*end)
    }

    /// Where lines begin, in all programs.
    pub(super) fn statements(&self) -> impl Iterator<Item = u32> {
        self.lines.iter().copied()
    }

    /// Whether a line begins at an address.
    pub(super) fn begins_line(&self, at: u32) -> bool {
        self.lines.contains(&at)
    }

    /// Where an address is in its source.
    pub(super) fn place(&self, at: u32) -> Option<CodeLine> {
        self.known.iter().find_map(|known| known.place(at))
    }

    /// The places where to stop for `FILE:LINE`, `LINE`, a function or `*ADDRESS`.
    pub(super) fn resolve(&self, text: &str, thread: Option<ThreadId>) -> Result<Vec<u32>, String> {
        let of = self.known.iter().filter(|known| thread.is_none_or(|thread| thread == known.thread));
        if let Some(address) = text.strip_prefix('*') {
            let address = address.trim().trim_start_matches("0x");
            let at = u32::from_str_radix(address, 16).map_err(|_| format!("`{text}` is not an address"))?;
            return Ok(vec![at]);
        }
        let (file, line) = match text.rsplit_once(':') {
            Some((file, line)) => (Some(file), line),
            None => (None, text),
        };
        let found: Vec<u32> = match line.parse() {
            Ok(line) => of.flat_map(|known| known.at_line(file, line)).collect(),
            Err(_) => of.filter_map(|known| known.at_function(line)).collect(),
        };
        if found.is_empty() { Err(format!("there is no code at `{text}`")) } else { Ok(found) }
    }
}

impl BootedProgram {
    /// Its functions and their code.
    fn functions(&self) -> impl Iterator<Item = (&str, Range<u32>)> {
        let entries = self.image.symbols.iter().filter(|entry| entry.kind == EntryKind::Function);
        entries.map(|entry| {
            let size = entry.size.unwrap_or(0).max(4);
            (entry.name.as_str(), entry.address..entry.address + size)
        })
    }

    /// Where lines begin in functions, each with its line.
    fn statements(&self) -> Vec<(u32, u32)> {
        let lines = self.image.lines.iter().map(|line| (line.address, line.line));
        lines.filter(|(at, _)| self.functions().any(|(_, code)| code.contains(at))).collect()
    }

    fn place(&self, at: u32) -> Option<CodeLine> {
        let (name, code) = self.functions().find(|(_, code)| code.contains(&at))?;
        let line = self.image.line_at(at).filter(|line| line.address >= code.start);
        let file = self.image.at(code.start).and_then(|entry| entry.file.clone()).unwrap_or_default();
        let line = line.map_or(0, |line| line.line);
        Some(CodeLine { thread: self.thread, function: name.to_owned(), file, line })
    }

    /// The first code of a line in each function that has some; of the next line with code if it has none.
    fn at_line(&self, file: Option<&str>, line: u32) -> Vec<u32> {
        let is_meant = |at: u32| {
            let place = self.place(at);
            file.is_none_or(|file| place.is_some_and(|place| place.file.ends_with(file)))
        };
        let all: Vec<_> = self.statements().into_iter().filter(|(at, _)| is_meant(*at)).collect();
        let Some(taken) = all.iter().map(|(_, known)| *known).filter(|known| *known >= line).min() else {
            return Vec::new();
        };
        let mut found: Vec<u32> = Vec::new();
        for (_, code) in self.functions() {
            let first = all.iter().filter(|(at, known)| *known == taken && code.contains(at));
            found.extend(first.map(|(at, _)| *at).min());
        }
        found
    }

    fn at_function(&self, name: &str) -> Option<u32> {
        let (_, code) = self.functions().find(|(known, _)| *known == name)?;
        let first = self.statements().into_iter().map(|(at, _)| at).find(|at| code.contains(at));
        Some(first.unwrap_or(code.start))
    }

    /// The text of a line of its source.
    pub(super) fn source_line(&self, place: &CodeLine) -> Option<String> {
        let model = self.model.as_ref().ok().filter(|model| model.path.ends_with(&place.file))?;
        let text = String::from_utf8_lossy(model.text()).into_owned();
        text.lines().nth((place.line as usize).checked_sub(1)?).map(str::to_owned)
    }

    /// The value of an expression outside of functions, in which these items of the board have these values.
    pub(super) fn evaluate(
        &self,
        expression: &str,
        items: &[(String, f64)],
        memory: &GuestMemory,
    ) -> Result<ShownValue, String> {
        self.with_probe(expression, items, memory, |probe, at| {
            let value = probe.value(at)?;
            let shown = probe.shown(at);
            Ok(ShownValue {
                ty: shown.type_of(&value),
                text: shown.text(&value),
                number: shown.number(&value),
            })
        })
    }

    /// Where a variable is, and the bytes that a number is there.
    pub(super) fn stored(
        &self,
        expression: &str,
        number: f64,
        memory: &GuestMemory,
    ) -> Result<(GuestAddr, Vec<u8>), String> {
        self.with_probe(expression, &[], memory, |probe, at| {
            let value = probe.value(at)?;
            let place = value.address().zip(probe.bytes_of(&value, number, at));
            place.ok_or_else(|| format!("`{expression}` is not a variable that holds a number"))
        })
    }

    fn with_probe<T>(
        &self,
        expression: &str,
        items: &[(String, f64)],
        memory: &GuestMemory,
        work: impl FnOnce(&Probe, &Memory<'_>) -> Result<T, String>,
    ) -> Result<T, String> {
        let model =
            self.model.as_ref().map_err(|why| format!("no types of this program are known: {why}"))?;
        let names: Vec<_> = items.iter().map(|(name, _)| name.as_str()).collect();
        let probe = model.probe(None, &Session::spelled(expression), &names)?;
        work(&probe, &Memory { memory, items })
    }
}

/// The items of the board that an expression names, such as `bit46`.
pub(super) fn items_in(expression: &str) -> Vec<(String, Item)> {
    let expression = Session::spelled(expression);
    let words = expression.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let mut items: Vec<_> = words.filter_map(|word| Some((word.to_owned(), Item::new(word).ok()?))).collect();
    items.sort_by(|(one, _), (other, _)| one.cmp(other));
    items.dedup_by(|(one, _), (other, _)| one == other);
    items
}

/// Memory and items as expressions read them.
struct Memory<'a> {
    memory: &'a GuestMemory,
    items: &'a [(String, f64)],
}

impl DebugReader for Memory<'_> {
    fn bytes(&self, address: GuestAddr) -> [u8; 8] {
        std::array::from_fn(|offset| self.memory.peek::<u8>(address.offset(offset as u32)))
    }

    fn item(&self, index: usize) -> f64 {
        self.items.get(index).map_or(0.0, |(_, value)| *value)
    }

    fn local(&self, _: &LocalModel) -> Option<LocalPlace> {
        // In code for the processor nobody notes where locals are.
        None
    }
}

fn model(program: &UserProgram, options: &Options) -> Result<Model, String> {
    let path =
        if program.is_image { source_of(&program.path, &program.image)? } else { program.path.clone() };
    let text = files::read(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    Model::of_real_code(&path, text, options, &Disk, program.thread, &program.image)
}
