//! Threads, calls, variables, memory: the state that a client reads while the board is stopped.

use std::io::Write;

use cc67_host::{Capability, Target};
use kmotiondef::{GuestAddr, ThreadId};
use serde_json::{Value, json};
use vm::engine::ContextId;

use super::{CALLBACK, Reply, Server, number_of, wire};
use crate::debugger::{DebugError, Debugger, Reason, ShownVariable};
use crate::shell::{Assignment, format_of_letter, state};

/// The number of frame numbers per thread; the number of a frame contains its thread.
const FRAMES: i64 = 100_000;

/// The size in bytes that is assumed for an instruction outside code.
const INSTRUCTION: u32 = 8;
/// The maximum number of parts that are listed at once.
const PARTS: u32 = 10_000;

/// The meaning of a variable reference.
#[derive(Clone, Debug)]
pub(super) enum Handle {
    /// The locals of a call.
    Locals(i64),
    /// The variables of the program.
    Globals(i64),
    /// The items of the board.
    Board(i64),
    /// `persist.UserData`, each element as every type that it can hold.
    Persist(i64),
    /// The parts of an expression in the context of a call.
    Parts(i64, String),
}

impl Handle {
    const fn frame(&self) -> i64 {
        match self {
            Self::Locals(frame)
            | Self::Globals(frame)
            | Self::Board(frame)
            | Self::Persist(frame)
            | Self::Parts(frame, _) => *frame,
        }
    }
}

/// The maximum length of a value in an editor's list; the editor expands a longer one.
const MOST_LETTERS: usize = 300;

/// Reports whether a request is for numbers in hexadecimal.
fn wants_hex(arguments: &Value) -> bool {
    arguments["format"]["hex"] == true
}

/// The text of a variable; integers are in hexadecimal if requested.
fn text_of(variable: &ShownVariable, is_hex: bool) -> String {
    let digits = variable.text.split(' ').next().unwrap_or_default();
    match digits.parse::<i64>() {
        Ok(number) if is_hex && (number >= 0 || number < i64::from(i32::MIN)) => format!("{number:#x}"),
        Ok(number) if is_hex => format!("{:#x}", number as i32),
        _ => match variable.text.char_indices().nth(MOST_LETTERS) {
            Some((end, _)) => format!("{}...", &variable.text[..end]),
            None => variable.text.clone(),
        },
    }
}

/// A source file in the protocol's form.
pub(super) fn source(path: &str) -> Value {
    let full = std::path::Path::new(path)
        .canonicalize()
        .map_or_else(|_| path.to_owned(), |full| full.to_string_lossy().into_owned());
    json!({ "name": crate::debugger::file_name(path), "path": full })
}

/// The address in a memory reference.
pub(super) fn address_of(text: &str) -> Result<u32, DebugError> {
    let digits = text.trim_start_matches("0x").trim_start_matches("0X");
    u32::from_str_radix(digits, 16).map_err(|_| format!("`{text}` is not an address").into())
}

fn context_of(number: i64) -> Option<ContextId> {
    if number == CALLBACK {
        return Some(ContextId::CALLBACK);
    }
    i32::try_from(number).ok().and_then(ThreadId::new).map(ContextId::of)
}

impl<W: Write, T: Target> Server<'_, W, T> {
    pub(super) fn threads(&mut self) -> Reply {
        let debugger = self.debugger()?;
        let mut threads = Vec::new();
        for thread in ThreadId::all() {
            if let Some(state) = state(debugger, thread) {
                let program = debugger.session().programs().iter().find(|program| program.thread == thread);
                let name = program.map_or_else(String::new, |program| {
                    format!(" {}", crate::debugger::file_name(&program.name()))
                });
                threads
                    .push(json!({ "id": thread.get(), "name": format!("thread {thread}{name} ({state})") }));
            }
        }
        if debugger.session().held().is_some_and(|(context, _)| context == ContextId::CALLBACK) {
            threads.push(json!({ "id": CALLBACK, "name": "call-back in the servo interrupt" }));
        }
        Ok(json!({ "threads": threads }))
    }

    pub(super) fn stack_trace(&mut self, arguments: &Value) -> Reply {
        let number = arguments["threadId"].as_i64().unwrap_or(0);
        let context = context_of(number).ok_or("there is no such thread")?;
        let debugger = self.debugger()?;
        let frames = debugger.frames(context);
        if frames.is_empty()
            && debugger.session().thread(context.thread().unwrap_or(debugger.thread())).is_active()
            && !debugger.session().can(Capability::StopTime)
        {
            // Editors show variables only within a frame.
            let frame = json!({ "id": number * FRAMES, "name": "(running)", "line": 0, "column": 0 });
            return Ok(json!({ "stackFrames": [frame], "totalFrames": 1 }));
        }
        let start = arguments["startFrame"].as_u64().unwrap_or(0) as usize;
        let levels =
            arguments["levels"].as_u64().filter(|levels| *levels > 0).unwrap_or(FRAMES as u64) as usize;
        let shown = frames.iter().enumerate().skip(start).take(levels).map(|(index, frame)| {
            let id = number * FRAMES + index as i64;
            let mut shown = json!({
                "id": id, "name": frame.address.to_string(), "line": 0, "column": 0,
                "instructionPointerReference": format!("{:#010x}", frame.address.get()),
            });
            if let Some(place) = &frame.place {
                let arguments = debugger.arguments(frame);
                shown["name"] = match arguments.as_slice() {
                    [] => json!(place.function),
                    all => json!(format!("{}({})", place.function, all.join(", "))),
                };
                shown["line"] = json!(place.line);
                shown["column"] = json!(1);
                shown["source"] = source(&place.file);
            }
            shown
        });
        Ok(json!({ "stackFrames": shown.collect::<Vec<_>>(), "totalFrames": frames.len() }))
    }

    /// Selects a call by its number.
    fn select(&mut self, frame: i64) -> Result<&mut Debugger<T>, DebugError> {
        let debugger = self.debugger()?;
        if let Some(thread) = context_of(frame / FRAMES).and_then(ContextId::thread) {
            debugger.select(thread, (frame % FRAMES) as usize)?;
        }
        Ok(debugger)
    }

    fn handle(&mut self, handle: Handle) -> usize {
        self.handles.push(handle);
        self.handles.len()
    }

    pub(super) fn scopes(&mut self, arguments: &Value) -> Reply {
        let frame = arguments["frameId"].as_i64().unwrap_or(0);
        self.select(frame)?;
        let rows = [
            ("Locals", Handle::Locals(frame), "locals", false),
            ("Variables of the program", Handle::Globals(frame), "globals", false),
            ("Board", Handle::Board(frame), "registers", true),
            ("persist.UserData", Handle::Persist(frame), "registers", true),
        ];
        let scopes = rows.map(|(name, handle, hint, expensive)| {
            json!({ "name": name, "variablesReference": self.handle(handle), "presentationHint": hint, "expensive": expensive })
        });
        Ok(json!({ "scopes": scopes }))
    }

    fn shown(&mut self, frame: i64, variable: &ShownVariable, is_hex: bool) -> Value {
        let reference = if variable.parts > 0 {
            self.handle(Handle::Parts(frame, variable.expression.clone()))
        } else {
            0
        };
        let mut shown = json!({
            "name": variable.name, "value": text_of(variable, is_hex), "type": variable.ty,
            "variablesReference": reference,
            "evaluateName": variable.expression,
        });
        if variable.name.starts_with('[') || variable.ty.ends_with(']') {
            shown["indexedVariables"] = json!(if variable.ty.ends_with(']') { variable.parts } else { 0 });
        }
        if let Some(address) = variable.address {
            shown["memoryReference"] = json!(format!("{address:#010x}"));
        }
        shown
    }

    fn listed(&mut self, handle: &Handle, first: u32, count: u32) -> Result<Vec<ShownVariable>, DebugError> {
        let debugger = self.select(handle.frame())?;
        Ok(match handle {
            Handle::Locals(_) => debugger.locals(),
            Handle::Globals(_) => debugger.globals(),
            Handle::Board(_) => {
                let names = ["chan", "persist", "VirtualBits", "CS0_TimeDownTo", "gather_buffer"];
                names.iter().filter_map(|name| debugger.evaluate(name).ok()).collect()
            }
            Handle::Persist(_) => (first..first.saturating_add(count).min(200))
                .filter_map(|index| reading(debugger, index))
                .collect(),
            Handle::Parts(_, expression) => debugger.parts(expression, first, count)?,
        })
    }

    pub(super) fn variables(&mut self, arguments: &Value) -> Reply {
        let reference = arguments["variablesReference"].as_u64().unwrap_or(0) as usize;
        let handle = reference.checked_sub(1).and_then(|index| self.handles.get(index)).cloned();
        let handle = handle.ok_or("the reference is of an earlier stop")?;
        let first = arguments["start"].as_u64().unwrap_or(0) as u32;
        let count =
            arguments["count"].as_u64().filter(|count| *count > 0).map_or(PARTS, |count| count as u32);
        let listed = self.listed(&handle, first, count)?;
        let is_hex = wants_hex(arguments);
        let shown: Vec<_> =
            listed.iter().map(|variable| self.shown(handle.frame(), variable, is_hex)).collect();
        Ok(json!({ "variables": shown }))
    }

    pub(super) fn evaluate(&mut self, arguments: &Value) -> Reply {
        let text = arguments["expression"].as_str().unwrap_or_default().trim().to_owned();
        let frame = arguments["frameId"].as_i64();
        if let Some(frame) = frame {
            self.select(frame)?;
        }
        // `n,x` is `n` in hexadecimal, as in other debuggers.
        let (text, format) = match text.rsplit_once(',') {
            Some((text, format)) if matches!(format.trim(), "x" | "h") => (text.trim().to_owned(), "x"),
            Some((text, format @ ("d" | "o" | "t" | "c"))) => (text.trim().to_owned(), format),
            _ => (text, if wants_hex(arguments) { "x" } else { "" }),
        };
        let assignment = (arguments["context"] == "repl").then(|| Assignment::of(&text)).flatten();
        let letter = format_of_letter(if format == "x" { "" } else { format })?;
        let variable = match assignment {
            Some(Assignment { place, value, .. }) => self.debugger()?.set(&place, &value)?,
            // Only expressions that a person types may call functions; those that the editor evaluates by itself only
            // read.
            None if arguments["context"] == "repl" => self.debugger()?.evaluate_with_calls(&text, letter)?,
            None => self.debugger()?.look_at(&text, letter)?,
        };
        let number = frame.unwrap_or_else(|| {
            self.shell.as_ref().map_or(0, |shell| number_of(shell.debugger().context()) * FRAMES)
        });
        let shown = self.shown(number, &variable, format == "x");
        let mut body = json!({
            "result": shown["value"], "type": variable.ty, "variablesReference": shown["variablesReference"],
        });
        if let Some(address) = variable.address {
            body["memoryReference"] = json!(format!("{address:#010x}"));
        }
        Ok(body)
    }

    pub(super) fn set_variable(&mut self, arguments: &Value) -> Reply {
        let reference = arguments["variablesReference"].as_u64().unwrap_or(0) as usize;
        let handle = reference.checked_sub(1).and_then(|index| self.handles.get(index)).cloned();
        let handle = handle.ok_or("the reference is of an earlier stop")?;
        let name = arguments["name"].as_str().unwrap_or_default();
        let listed = self.listed(&handle, 0, PARTS)?;
        let found = listed.into_iter().find(|variable| variable.name == name);
        let expression = found.ok_or_else(|| format!("there is no `{name}` here"))?.expression;
        let value = arguments["value"].as_str().unwrap_or_default();
        let variable = self.select(handle.frame())?.set(&expression, value)?;
        Ok(json!({ "value": variable.text, "type": variable.ty }))
    }

    pub(super) fn set_expression(&mut self, arguments: &Value) -> Reply {
        if let Some(frame) = arguments["frameId"].as_i64() {
            self.select(frame)?;
        }
        let expression = arguments["expression"].as_str().unwrap_or_default();
        let variable = self.debugger()?.set(expression, arguments["value"].as_str().unwrap_or_default())?;
        Ok(json!({ "value": variable.text, "type": variable.ty }))
    }

    pub(super) fn data_breakpoint_info(&mut self, arguments: &Value) -> Reply {
        let name = arguments["name"].as_str().unwrap_or_default().to_owned();
        let reference = arguments["variablesReference"].as_u64().unwrap_or(0) as usize;
        let handle = reference.checked_sub(1).and_then(|index| self.handles.get(index)).cloned();
        let (frame, expression) = match handle {
            Some(handle) => {
                let listed = self.listed(&handle, 0, PARTS)?;
                let found = listed.into_iter().find(|variable| variable.name == name);
                (handle.frame(), found.ok_or_else(|| format!("there is no `{name}` here"))?.expression)
            }
            None => (arguments["frameId"].as_i64().unwrap_or(0), name),
        };
        if frame > 0 {
            self.select(frame)?;
        }
        let debugger = self.debugger()?;
        let sees_reads = debugger.session().can(Capability::AccessWatchpoints);
        match debugger.evaluate(&expression) {
            Ok(variable) => {
                let sees_reads = sees_reads && variable.address.is_some();
                let types = if sees_reads { json!(["read", "write", "readWrite"]) } else { json!(["write"]) };
                Ok(json!({
                    "dataId": format!("{}|{}|{expression}", frame / FRAMES, frame % FRAMES),
                    "description": expression, "accessTypes": types, "canPersist": false,
                }))
            }
            Err(error) => Ok(json!({ "dataId": null, "description": error.to_string() })),
        }
    }

    pub(super) fn completions(&mut self, arguments: &Value) -> Reply {
        let text = arguments["text"].as_str().unwrap_or_default();
        let word =
            text.rsplit(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next().unwrap_or("").to_owned();
        let debugger = self.debugger()?;
        let mut names: Vec<_> =
            debugger.locals().into_iter().chain(debugger.globals()).map(|one| one.name).collect();
        names.retain(|name| name.starts_with(&word));
        let targets: Vec<_> = names.into_iter().map(|name| json!({ "label": name })).collect();
        Ok(json!({ "targets": targets }))
    }

    pub(super) fn disassemble(&mut self, arguments: &Value) -> Reply {
        let base = address_of(arguments["memoryReference"].as_str().unwrap_or_default())?;
        let base = base.wrapping_add_signed(arguments["offset"].as_i64().unwrap_or(0) as i32);
        let first = base.wrapping_add_signed(
            (arguments["instructionOffset"].as_i64().unwrap_or(0) * i64::from(INSTRUCTION)) as i32,
        );
        let count = arguments["instructionCount"].as_u64().unwrap_or(0).min(10_000) as u32;
        let debugger = self.debugger()?;
        let mut at = first & !3;
        let instructions: Vec<_> = (0..count)
            .map(|_| {
                let found = debugger.session().target().disassemble(at);
                let size = found.as_ref().map_or(INSTRUCTION, |(_, size)| *size);
                let mut shown = json!({
                    "address": format!("{at:#010x}"),
                    "instruction": found.map_or_else(|| "(no code)".to_owned(), |(text, _)| text),
                });
                if let Some(place) = debugger.place(at) {
                    shown["line"] = json!(place.line);
                    shown["location"] = source(&place.file);
                }
                at = at.wrapping_add(size);
                shown
            })
            .collect();
        Ok(json!({ "instructions": instructions }))
    }

    pub(super) fn read_memory(&mut self, arguments: &Value) -> Reply {
        let base = address_of(arguments["memoryReference"].as_str().unwrap_or_default())?;
        let address = base.wrapping_add_signed(arguments["offset"].as_i64().unwrap_or(0) as i32);
        let count = arguments["count"].as_u64().unwrap_or(0).min(1 << 20) as u32;
        let debugger = self.debugger()?;
        let is_mapped =
            |at: &u32| debugger.session().target().is_mapped(GuestAddr::new(address.wrapping_add(*at)));
        let readable = (0..count).take_while(is_mapped).count() as u32;
        let bytes = debugger.bytes(address, readable);
        let mut body = json!({ "address": format!("{address:#010x}"), "data": wire::encode(&bytes) });
        if readable < count {
            body["unreadableBytes"] = json!(count - readable);
        }
        Ok(body)
    }

    pub(super) fn write_memory(&mut self, arguments: &Value) -> Reply {
        let base = address_of(arguments["memoryReference"].as_str().unwrap_or_default())?;
        let address = base.wrapping_add_signed(arguments["offset"].as_i64().unwrap_or(0) as i32);
        let bytes =
            wire::decode(arguments["data"].as_str().unwrap_or_default()).ok_or("the data is not base64")?;
        self.debugger()?.store(address, &bytes)?;
        Ok(json!({ "bytesWritten": bytes.len() }))
    }

    pub(super) fn exception_info(&mut self) -> Reply {
        let (id, text) = match &self.debugger()?.stop().reason {
            Reason::Trap(text) => ("trap", text.clone()),
            Reason::Remark(text) => ("remark", text.clone()),
            _ => return Err("no trap and no remark has stopped the board".into()),
        };
        Ok(json!({ "exceptionId": id, "description": text, "breakMode": "always" }))
    }
}

/// An element of `persist.UserData` as an integer, and as the other types that programs store there: a float in one
/// element, a double in two.
fn reading<T: Target>(debugger: &Debugger<T>, index: u32) -> Option<ShownVariable> {
    let expression = format!("persist.UserData[{index}]");
    let element = debugger.evaluate(&expression).ok()?;
    let bytes = debugger.bytes(element.address?, 8);
    let whole = u64::from_le_bytes(bytes.try_into().ok()?);
    let float = f32::from_bits(whole as u32);
    let double =
        if index.is_multiple_of(2) { format!(", double {:?}", f64::from_bits(whole)) } else { String::new() };
    let text = format!("{}, float {float:?}{double}", element.text);
    Some(ShownVariable { name: format!("persist.{index}"), text, ..element })
}
