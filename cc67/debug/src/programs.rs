//! Debug information of the programs in the threads.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use cc67_host::{Session, Target, UserProgram};
use compiler::debug::{CodeScope, FunctionModel, Model, source_of};
use compiler::files;
use compiler::pp::Disk;
use compiler::target::Target as CodeTarget;
use kmotiondef::{Axes, ThreadId};

/// The debug information of the programs in the threads, or the reason why there is none.
#[derive(Debug, Default)]
pub struct Programs {
    known: BTreeMap<ThreadId, (UserProgram, Result<Arc<Model>, String>)>,
    axes: Axes,
}

/// A statement: the thread of its program, its address and line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Statement {
    pub(crate) thread: ThreadId,
    pub(crate) address: u32,
    pub(crate) line: u32,
    pub(crate) function: String,
    /// The index of the inlined call that contains it.
    pub(crate) call: Option<usize>,
}

/// A function of the source that is being executed, called or inlined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Activation<'a> {
    pub(crate) thread: ThreadId,
    pub(crate) model: &'a Arc<Model>,
    /// The function that contains its code.
    pub(crate) around: &'a FunctionModel,
    /// The function itself, and the present line in it.
    pub(crate) scope: CodeScope<'a>,
    pub(crate) is_inlined: bool,
}

impl Programs {
    /// Updates the information to the loaded programs.
    pub fn update<T: Target>(&mut self, session: &Session<T>) {
        self.axes = session.target().axes();
        self.known.retain(|thread, _| session.programs().iter().any(|program| program.thread == *thread));
        for program in session.programs() {
            if self.known.get(&program.thread).is_none_or(|(known, _)| known.image != program.image) {
                let model = model(program, session).map(Arc::new);
                self.known.insert(program.thread, (program.clone(), model));
            }
        }
    }

    /// Returns the axes of the programs' board.
    pub(crate) const fn axes(&self) -> Axes {
        self.axes
    }

    /// Returns the debug information of the program in a thread.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn of(&self, thread: ThreadId) -> Result<&Arc<Model>, String> {
        match self.known.get(&thread) {
            Some((_, Ok(model))) => Ok(model),
            Some((program, Err(why))) => Err(format!("no debug information of {}: {why}", program.name())),
            None => Err(format!("no program is loaded in thread {thread}")),
        }
    }

    /// The program that contains an address in its code.
    #[must_use]
    pub fn at(&self, address: u32) -> Option<(ThreadId, &Arc<Model>, &FunctionModel)> {
        self.all().find_map(|(thread, model)| Some((thread, model, model.function_at(address)?)))
    }

    /// The functions at an instruction: the inlined ones, innermost first, then the function that contains them.
    pub(crate) fn activations(&self, address: u32) -> Vec<Activation<'_>> {
        let Some((thread, model, around)) = self.at(address) else { return Vec::new() };
        let Some(mut line) = model.line_at(address) else { return Vec::new() };
        let activation = |function, line, locals, is_inlined| {
            let scope = CodeScope { function, line, locals };
            Activation { thread, model, around, scope, is_inlined }
        };
        let mut found = Vec::new();
        for call in around.calls_at(address) {
            found.push(activation(call.function.as_str(), line, call.locals.as_slice(), true));
            line = call.line;
        }
        found.push(activation(&around.name, line, &around.locals, false));
        found
    }

    /// Returns the number of functions at an address; 1 if nothing is known.
    pub(crate) fn depth(&self, address: u32) -> usize {
        self.at(address).map_or(1, |(_, _, function)| 1 + function.calls_at(address).count())
    }

    /// All programs with debug information.
    pub fn all(&self) -> impl Iterator<Item = (ThreadId, &Arc<Model>)> {
        self.known.iter().filter_map(|(thread, (_, model))| Some((*thread, model.as_ref().ok()?)))
    }

    /// Returns the reasons for which some programs have no debug information.
    pub fn unknown(&self) -> impl Iterator<Item = String> {
        self.known.keys().filter_map(|thread| self.of(*thread).err())
    }

    /// The statements of a program, or of one of its functions.
    pub(crate) fn statements(&self, thread: ThreadId, function: Option<&str>) -> Vec<Statement> {
        let Ok(model) = self.of(thread) else { return Vec::new() };
        let functions = model.functions.iter().filter(|known| function.is_none_or(|name| known.name == name));
        functions
            .flat_map(|known| {
                known.statements.iter().map(|(address, line)| Statement {
                    thread,
                    address: *address,
                    line: *line,
                    function: known.name.clone(),
                    call: known.call_at(*address),
                })
            })
            .collect()
    }

    /// Returns the statements at which to stop for a line of a file: the first statement in each function, and in each
    /// inlined call, that contains the line; for a line without code, the statements of the next line that has code.
    /// The second value is the line that was used.
    pub(crate) fn at_line(
        &self,
        file: Option<&str>,
        line: u32,
        thread: Option<ThreadId>,
    ) -> (Vec<Statement>, u32) {
        let mut all: Vec<Statement> = Vec::new();
        for (number, model) in self.all().filter(|(number, _)| thread.is_none_or(|thread| thread == *number))
        {
            let is_meant = |function: &FunctionModel| {
                file.is_none_or(|file| is_same_file(file, &function.file, &model.path))
            };
            let functions: Vec<_> = model.functions.iter().filter(|function| is_meant(function)).collect();
            for function in functions {
                all.extend(self.statements(number, Some(&function.name)));
                // An inlined call begins with its code: the first statement of the line may be later.
                all.extend(function.inlined.iter().filter_map(|call| {
                    let address = call.ranges.iter().map(|range| range.start).min()?;
                    let (line, name) = (call.line, function.name.clone());
                    Some(Statement { thread: number, address, line, function: name, call: call.inside })
                }));
            }
        }
        let Some(taken) = all.iter().map(|one| one.line).filter(|known| *known >= line).min() else {
            return (Vec::new(), line);
        };
        all.retain(|one| one.line == taken);
        all.sort_by_key(|one| (one.thread, one.call, one.address));
        all.dedup_by(|later, first| {
            (later.thread, &later.function, later.call) == (first.thread, &first.function, first.call)
        });
        all.sort_by_key(|one| one.address);
        (all, taken)
    }

    /// Returns the beginnings of a function, after its prologue.
    pub(crate) fn at_function(&self, name: &str, thread: Option<ThreadId>) -> Vec<Statement> {
        let mut found = Vec::new();
        for (number, model) in self.all().filter(|(number, _)| thread.is_none_or(|thread| thread == *number))
        {
            if model.function_named(name).is_none() {
                continue;
            }
            found.extend(self.statements(number, Some(name)).into_iter().next());
            // Also in each inlined call.
            let is_its = |one: &Statement| {
                let around = model.function_at(one.address);
                let call = around.and_then(|around| around.inlined.get(one.call?));
                call.is_some_and(|call| call.function == name)
            };
            let mut inside: Vec<_> = self.statements(number, None).into_iter().filter(is_its).collect();
            inside.sort_by_key(|one| (one.function.clone(), one.call, one.address));
            inside.dedup_by(|later, first| (&later.function, later.call) == (&first.function, first.call));
            found.extend(inside);
        }
        found
    }
}

/// Returns whether `wanted` names a file of a program: by its path, or by the end of its path.
fn is_same_file(wanted: &str, file: &str, program: &Path) -> bool {
    let wanted = Path::new(wanted);
    let full = program.parent().unwrap_or(Path::new("")).join(file);
    Path::new(file).ends_with(wanted)
        || full.ends_with(wanted)
        || program.ends_with(wanted)
        || wanted.canonicalize().is_ok_and(|wanted| {
            full.canonicalize().is_ok_and(|full| full == wanted)
                || (Path::new(file).file_name() == program.file_name()
                    && program.canonicalize().is_ok_and(|program| program == wanted))
        })
}

fn model<T: Target>(program: &UserProgram, session: &Session<T>) -> Result<Model, String> {
    let options = session.options();
    if options.target == CodeTarget::C67x {
        let path =
            if program.is_image { source_of(&program.path, &program.image)? } else { program.path.clone() };
        let text = files::read(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        return Model::of_real_code(&path, text, options, &Disk, program.thread, &program.image);
    }
    if program.is_image {
        return compiler::debug::of_image(&program.path, &program.image, session.options());
    }
    let text = files::read(&program.path).map_err(|error| format!("cannot read it: {error}"))?;
    Model::build(&program.path, text, session.options(), &Disk, program.thread, &program.image)
}
