//! Breakpoints: at code, at watched expressions, and at expressions that become true; their conditions.

use cc67_host::{Capability, Target};
use compiler::firmware::FirmwareSymbols as _;
use kmotiondef::{GuestAddr, ThreadId};

use super::values::PreparedExpression;
use super::{DebugError, Debugger, HitCondition, file_name, place_of};
use crate::programs::Statement;

/// The kind of a breakpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BreakpointKind {
    /// Instructions: the location as text, and their addresses.
    Code(String, Vec<u32>),
    /// A change of an expression's value.
    Watch(String),
    /// An access by programs to the memory of an expression.
    Access(String, WatchedAccess),
    /// An expression that becomes true, evaluated after every tick.
    When(String),
}

/// The accesses that stop a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WatchedAccess {
    /// Reads.
    Read,
    /// Reads and writes.
    ReadWrite,
}

impl WatchedAccess {
    /// The breakpoint type in gdb's terms.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Read => "Hardware read watchpoint",
            Self::ReadWrite => "Hardware access (read/write) watchpoint",
        }
    }
}

/// A breakpoint.
#[derive(Debug)]
pub struct Breakpoint {
    /// Its number, counted from 1.
    pub id: u32,
    /// Its kind.
    pub kind: BreakpointKind,
    /// An expression of the program; the breakpoint stops only if it is not 0.
    pub condition: Option<String>,
    /// The number of further hits that do not stop.
    pub ignore: u64,
    /// A message that is printed instead of stopping; `{expression}` is replaced by its value.
    pub log: Option<String>,
    /// True if it is deleted when it stops.
    pub is_temporary: bool,
    /// True unless it was disabled.
    pub is_enabled: bool,
    /// The number of times that it was reached.
    pub hits: u64,
    /// The hits at which it stops; `None` for all.
    pub stops_at: Option<HitCondition>,
    /// The condition, compiled for each of its instructions; once for a watched expression.
    pub(super) conditions: Vec<(u32, PreparedExpression)>,
    /// The line that was requested.
    pub(super) line: u32,
    pub(super) subject: Subject,
}

/// The subject of a breakpoint.
#[derive(Debug)]
pub(super) enum Subject {
    /// Instructions of programs.
    Instructions,
    /// A watched expression.
    Change(WatchedExpression),
    /// An expression whose memory is accessed, and its value at the last stop.
    Access(WatchedExpression),
    /// An expression that becomes true, and whether it was true at the last tick.
    Truth(PreparedExpression, bool),
}

impl Subject {
    pub(super) const fn watched(&self) -> Option<&WatchedExpression> {
        if let Self::Change(watched) = self { Some(watched) } else { None }
    }

    /// The expression whose memory is watched for accesses.
    pub(super) const fn accessed(&self) -> Option<&WatchedExpression> {
        if let Self::Access(watched) = self { Some(watched) } else { None }
    }

    /// The expression of a watchpoint of any kind, for changes.
    pub(super) const fn expression_mut(&mut self) -> Option<&mut WatchedExpression> {
        if let Self::Change(watched) | Self::Access(watched) = self { Some(watched) } else { None }
    }

    /// The expression of a watchpoint of any kind.
    pub(super) const fn expression(&self) -> Option<&WatchedExpression> {
        if let Self::Change(watched) | Self::Access(watched) = self { Some(watched) } else { None }
    }

    pub(super) const fn watched_mut(&mut self) -> Option<&mut WatchedExpression> {
        if let Self::Change(watched) = self { Some(watched) } else { None }
    }

    pub(super) const fn was_true_mut(&mut self) -> Option<&mut bool> {
        if let Self::Truth(_, was_true) = self { Some(was_true) } else { None }
    }

    /// Reports whether it is evaluated after every tick.
    pub(super) const fn is_polled(&self) -> bool {
        match self {
            Self::Instructions | Self::Access(_) => false,
            Self::Change(watched) => watched.is_polled,
            Self::Truth(..) => true,
        }
    }
}

impl Breakpoint {
    /// Reports whether it is evaluated after every tick.
    pub(super) fn is_polled(&self) -> bool {
        self.is_enabled && self.subject.is_polled()
    }
}

/// A watched expression.
#[derive(Debug)]
pub(super) struct WatchedExpression {
    pub(super) prepared: PreparedExpression,
    /// The memory from which it is read.
    pub(super) ranges: Vec<(GuestAddr, u32)>,
    /// Its own memory, if it is a place in memory.
    pub(super) own: Option<(GuestAddr, u32)>,
    /// True if it is also read from registers: then it is evaluated before every line.
    pub(super) has_registers: bool,
    /// True if it contains items of the board: then it is evaluated after every tick.
    pub(super) is_polled: bool,
    pub(super) last: String,
}

/// Setting and finding breakpoints.
impl<T: Target> Debugger<T> {
    /// Sets a breakpoint at `FILE:LINE`, `LINE`, `FUNCTION` or `*ADDRESS`, in the program of one thread or in all
    /// programs that contain it; returns its number and a message.
    ///
    /// # Errors
    /// There is no code at the location, or the condition does not compile.
    pub fn break_at(
        &mut self,
        place: &str,
        thread: Option<ThreadId>,
        condition: Option<&str>,
    ) -> Result<(u32, String), DebugError> {
        self.must_hold()?;
        let (found, note) = self.resolve(place.trim(), thread)?;
        let first = &found[0];
        let where_ = if first.line == 0 {
            format!("{:#010x}", first.address)
        } else {
            let activations = self.programs.activations(first.address);
            let with_line = activations.iter().find(|activation| activation.scope.line == first.line);
            let place = with_line.or(activations.first()).map(place_of);
            place.map_or_else(
                || format!("{:#010x}", first.address),
                |place| format!("{}, {}:{}", place.function, file_name(&place.file), first.line),
            )
        };
        let addresses = found.iter().map(|one| one.address).collect();
        let line = first.line;
        let kind = BreakpointKind::Code(where_.clone(), addresses);
        let conditions = self.conditions(&kind, condition)?;
        let id = self.add(kind, condition, conditions);
        if let Some(added) = self.breakpoints.last_mut() {
            added.line = line;
        }
        let at = match found.as_slice() {
            [one] if one.line > 0 => {
                let file = self.place(one.address).map_or_else(String::new, |place| place.file);
                format!("{:#x}: file {}, line {}.", one.address, file_name(&file), one.line)
            }
            [one] => format!("{:#x}", one.address),
            _ => format!("{:#x}: {place}. ({} locations)", found[0].address, found.len()),
        };
        let others = self.others_at(id, found[0].address);
        let text = format!("{others}Breakpoint {id} at {at}{note}");
        Ok((id, text))
    }

    /// A note that there are other breakpoints at an address.
    fn others_at(&self, id: u32, address: u32) -> String {
        let is_there = |one: &&Breakpoint| {
            one.id != id
                && matches!(&one.kind, BreakpointKind::Code(_, addresses) if addresses.contains(&address))
        };
        let others: Vec<_> = self.breakpoints.iter().filter(is_there).map(|one| one.id.to_string()).collect();
        match others.as_slice() {
            [] => String::new(),
            [one] => format!("Note: breakpoint {one} also set at pc {address:#x}.\n"),
            [first @ .., last] => {
                format!("Note: breakpoints {} and {last} also set at pc {address:#x}.\n", first.join(", "))
            }
        }
    }

    /// Stops when the value of an expression changes; returns its number and a message.
    ///
    /// # Errors
    /// The expression is not valid.
    pub fn watch(&mut self, expression: &str, condition: Option<&str>) -> Result<(u32, String), DebugError> {
        self.session.require(Capability::Watchpoints)?;
        let watched = self.watched(expression)?;
        let kind = BreakpointKind::Watch(expression.to_owned());
        let conditions = self.conditions(&kind, condition)?;
        let id = self.add(kind, condition, conditions);
        if let Some(added) = self.breakpoints.last_mut() {
            added.subject = Subject::Change(watched);
        }
        Ok((id, format!("Hardware watchpoint {id}: {expression}")))
    }

    /// Stops after an instruction of a program accesses the memory of an expression; returns its number and a message.
    ///
    /// # Errors
    /// The expression is not valid, or is not a place in memory.
    pub fn watch_access(
        &mut self,
        expression: &str,
        access: WatchedAccess,
        condition: Option<&str>,
    ) -> Result<(u32, String), DebugError> {
        self.session.require(Capability::AccessWatchpoints)?;
        let watched = self.watched(expression)?;
        if watched.own.is_none() {
            return Err("Expression cannot be implemented with read/access watchpoint.".into());
        }
        let kind = BreakpointKind::Access(expression.to_owned(), access);
        let conditions = self.conditions(&kind, condition)?;
        let id = self.add(kind, condition, conditions);
        if let Some(added) = self.breakpoints.last_mut() {
            added.subject = Subject::Access(watched);
        }
        Ok((id, format!("{} {id}: {expression}", access.title())))
    }

    /// Stops at the end of the tick in which an expression becomes true (not 0); returns its number and a message.
    ///
    /// # Errors
    /// The expression is not valid.
    pub fn catch_when(&mut self, expression: &str) -> Result<(u32, String), DebugError> {
        let prepared = self.prepare(expression)?;
        let id = self.add(BreakpointKind::When(expression.to_owned()), None, Vec::new());
        if let Some(added) = self.breakpoints.last_mut() {
            added.subject = Subject::Truth(prepared, false);
        }
        Ok((id, format!("Catchpoint {id} (when {expression})")))
    }

    /// Deletes a breakpoint; returns whether it existed.
    pub fn delete(&mut self, id: u32) -> bool {
        let count = self.breakpoints.len();
        self.breakpoints.retain(|breakpoint| breakpoint.id != id);
        self.breakpoints.len() < count
    }

    /// A breakpoint, for changes.
    pub fn breakpoint_mut(&mut self, id: u32) -> Option<&mut Breakpoint> {
        self.breakpoints.iter_mut().find(|breakpoint| breakpoint.id == id)
    }

    /// Sets or removes the condition of a breakpoint.
    ///
    /// # Errors
    /// There is no such breakpoint, or the condition does not compile.
    pub fn set_condition(&mut self, id: u32, condition: Option<&str>) -> Result<(), DebugError> {
        let found = self.breakpoints.iter().find(|breakpoint| breakpoint.id == id);
        let kind = found
            .map(|breakpoint| breakpoint.kind.clone())
            .ok_or_else(|| format!("No breakpoint number {id}."))?;
        let conditions = self.conditions(&kind, condition)?;
        if let Some(breakpoint) = self.breakpoint_mut(id) {
            breakpoint.condition = condition.map(str::to_owned);
            breakpoint.conditions = conditions;
        }
        Ok(())
    }

    /// A condition, compiled for each location of a breakpoint.
    fn conditions(
        &self,
        kind: &BreakpointKind,
        condition: Option<&str>,
    ) -> Result<Vec<(u32, PreparedExpression)>, DebugError> {
        let Some(condition) = condition else { return Ok(Vec::new()) };
        match kind {
            BreakpointKind::Code(_, addresses) => {
                addresses.iter().map(|at| Ok((*at, self.prepare_at(*at, condition)?))).collect()
            }
            BreakpointKind::Watch(_) | BreakpointKind::Access(..) | BreakpointKind::When(_) => {
                Ok(vec![(0, self.prepare(condition)?)])
            }
        }
    }

    /// Compiles the expressions again after other programs were loaded.
    pub(super) fn compile_conditions(&mut self) {
        for index in 0..self.breakpoints.len() {
            let Breakpoint { id, kind, condition, .. } = &self.breakpoints[index];
            let id = *id;
            match self.conditions(kind, condition.as_deref()) {
                Ok(conditions) => self.breakpoints[index].conditions = conditions,
                Err(error) => {
                    self.messages.push_back(format!("condition of breakpoint {id}: {error}"));
                }
            }
        }
    }

    pub(super) fn add(
        &mut self,
        kind: BreakpointKind,
        condition: Option<&str>,
        conditions: Vec<(u32, PreparedExpression)>,
    ) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        self.breakpoints.push(Breakpoint {
            id,
            kind,
            condition: condition.map(str::to_owned),
            ignore: 0,
            log: None,
            is_temporary: false,
            is_enabled: true,
            hits: 0,
            stops_at: None,
            conditions,
            line: 0,
            subject: Subject::Instructions,
        });
        id
    }

    /// Resolves a location as a user writes it; returns its statements and a note on them.
    pub(crate) fn resolve(
        &self,
        place: &str,
        thread: Option<ThreadId>,
    ) -> Result<(Vec<Statement>, String), DebugError> {
        if let Some(address) = place.strip_prefix('*') {
            let value = self.number(address)?;
            let address = value as u32 & !7;
            let found = self.programs.at(address);
            let (thread, _, function) = found.ok_or_else(|| format!("no code at {address:#x}"))?;
            let line = self.place(address).map_or(0, |place| place.line);
            return Ok((
                vec![Statement { thread, address, line, function: function.name.clone(), call: None }],
                String::new(),
            ));
        }
        let (file, rest) = place.rsplit_once(':').map_or((None, place), |(file, rest)| (Some(file), rest));
        if let Ok(line) = rest.parse::<u32>() {
            let present = || self.present().map(|place| place.file).filter(|_| file.is_none());
            let own = present();
            let file = file.or(own.as_deref());
            let thread = thread.or_else(|| file.is_none().then_some(self.thread));
            let (found, taken) = self.programs.at_line(file, line, thread);
            if found.is_empty() {
                let why = self.programs.unknown().next();
                let place = match (file, own.is_some()) {
                    (Some(file), false) => format!("file \"{file}\""),
                    _ => "the current file".to_owned(),
                };
                let text = format!(
                    "No line {line} in {place}.{}",
                    why.map_or_else(String::new, |why| format!("  {why}"))
                );
                return Err(text.into());
            }
            let note = if taken == line {
                String::new()
            } else {
                format!("  Line {line} has no code, {taken} is the next with some.")
            };
            return Ok((found, note));
        }
        let mut found = self.programs.at_function(rest, thread);
        if found.is_empty() && file.is_none() {
            found = self.calls_of(rest, thread);
            if !found.is_empty() {
                return Ok((found, format!("  Before each call of {rest}.")));
            }
            if self.session.options().firmware.find(rest).is_some() {
                return Err(format!("No program calls {rest}, which is the firmware's.").into());
            }
        }
        if found.is_empty() {
            let why = self.programs.unknown().next();
            return Err(why.unwrap_or_else(|| format!("Function \"{rest}\" not defined.")).into());
        }
        // The line at which it stops, not the line of the function's name.
        for statement in &mut found {
            statement.line = self.place(statement.address).map_or(statement.line, |place| place.line);
        }
        Ok((found, String::new()))
    }

    /// The instructions in the programs that call a firmware function.
    fn calls_of(&self, name: &str, thread: Option<ThreadId>) -> Vec<Statement> {
        let Some(symbol) = self.session.options().firmware.find(name) else { return Vec::new() };
        let target = format!(", {:#010x}", symbol.address.get());
        let mut found = Vec::new();
        for (number, model) in
            self.programs.all().filter(|(number, _)| thread.is_none_or(|one| one == *number))
        {
            for function in &model.functions {
                let mut at = function.addresses.start;
                while at < function.addresses.end
                    && let Some((text, size)) = self.session.target().disassemble(at)
                {
                    if text.starts_with("call_fw ") && text.ends_with(&target) {
                        let line = model.line_at(at).unwrap_or(0);
                        let function = function.name.clone();
                        found.push(Statement { thread: number, address: at, line, function, call: None });
                    }
                    at = at.saturating_add(size);
                }
            }
        }
        found
    }
}
