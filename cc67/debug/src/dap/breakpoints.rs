//! Breakpoints as clients set them: a request replaces all breakpoints of its set.

use std::io::Write;

use cc67_host::Target;
use serde_json::{Value, json};

use super::{Reply, Server};
use crate::debugger::{DebugError, Debugger, HitCondition, WatchedAccess};

/// Creates the breakpoint that the editor requests; returns its number and a message.
type Maker<'a, T> = dyn FnMut(&mut Debugger<T>, &Value) -> Result<(u32, String), DebugError> + 'a;

impl<W: Write, T: Target> Server<'_, W, T> {
    pub(super) fn set_breakpoints(&mut self, arguments: &Value) -> Reply {
        let path = arguments["source"]["path"].as_str().or_else(|| arguments["source"]["name"].as_str());
        let path = path.unwrap_or_default().to_owned();
        self.replace(&format!("file {path}"), &arguments["breakpoints"], &mut |debugger, wanted| {
            let line = wanted["line"].as_u64().unwrap_or(0);
            debugger.break_at(&format!("{path}:{line}"), None, wanted["condition"].as_str())
        })
    }

    pub(super) fn set_function_breakpoints(&mut self, arguments: &Value) -> Reply {
        self.replace("functions", &arguments["breakpoints"], &mut |debugger, wanted| {
            let name = wanted["name"].as_str().unwrap_or_default();
            debugger.break_at(name, None, wanted["condition"].as_str())
        })
    }

    pub(super) fn set_instruction_breakpoints(&mut self, arguments: &Value) -> Reply {
        self.replace("instructions", &arguments["breakpoints"], &mut |debugger, wanted| {
            let base = wanted["instructionReference"].as_str().unwrap_or_default();
            let address = super::look::address_of(base)?;
            let address = address.wrapping_add_signed(wanted["offset"].as_i64().unwrap_or(0) as i32);
            debugger.break_at(&format!("*{address:#x}"), None, wanted["condition"].as_str())
        })
    }

    pub(super) fn set_data_breakpoints(&mut self, arguments: &Value) -> Reply {
        self.replace("data", &arguments["breakpoints"], &mut |debugger, wanted| {
            let id = wanted["dataId"].as_str().unwrap_or_default();
            let mut parts = id.splitn(3, '|');
            let (thread, frame) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
            let expression = parts.next().ok_or("it is no dataId of dataBreakpointInfo")?;
            let thread = thread.parse().ok().and_then(kmotiondef::ThreadId::new);
            if let (Some(thread), Ok(frame)) = (thread, frame.parse()) {
                debugger.select(thread, frame)?;
            }
            let condition = wanted["condition"].as_str();
            match wanted["accessType"].as_str() {
                Some("read") => debugger.watch_access(expression, WatchedAccess::Read, condition),
                Some("readWrite") => debugger.watch_access(expression, WatchedAccess::ReadWrite, condition),
                _ => debugger.watch(expression, condition),
            }
        })
    }

    fn replace(&mut self, set: &str, wanted: &Value, make: &mut Maker<'_, T>) -> Reply {
        let old: Vec<u32> = self.set.iter().filter(|(name, _)| name == set).map(|(_, id)| *id).collect();
        self.set.retain(|(name, _)| name != set);
        let mut made = Vec::new();
        let debugger = self.debugger()?;
        for id in old {
            debugger.delete(id);
        }
        let mut shown = Vec::new();
        for wanted in wanted.as_array().map(Vec::as_slice).unwrap_or_default() {
            let hits = wanted["hitCondition"].as_str().filter(|text| !text.trim().is_empty());
            let hits = hits.map(str::parse::<HitCondition>).transpose();
            match hits.and_then(|hits| Ok((make(debugger, wanted)?, hits))) {
                Ok(((id, text), hits)) => {
                    made.push((set.to_owned(), id));
                    if let Some(breakpoint) = debugger.breakpoint_mut(id) {
                        breakpoint.log = wanted["logMessage"].as_str().map(str::to_owned);
                        breakpoint.stops_at = hits;
                    }
                    shown.push(verified(debugger, id, &text));
                }
                Err(error) => shown.push(json!({ "verified": false, "message": error.to_string() })),
            }
        }
        self.set.extend(made);
        Ok(json!({ "breakpoints": shown }))
    }

    pub(super) fn set_exception_breakpoints(&mut self, arguments: &Value) -> Reply {
        let has = |name: &str| {
            arguments["filters"].as_array().is_some_and(|filters| filters.iter().any(|filter| filter == name))
        };
        let (traps, remarks) = (has("traps"), has("remarks"));
        let catches = &mut self.debugger()?.catches;
        catches.no_traps = !traps;
        catches.remarks = remarks;
        Ok(json!({}))
    }

    pub(super) fn breakpoint_locations(&mut self, arguments: &Value) -> Reply {
        let path = arguments["source"]["path"].as_str().unwrap_or_default().to_owned();
        let first = arguments["line"].as_u64().unwrap_or(1) as u32;
        let last = arguments["endLine"].as_u64().map_or(first, |line| line as u32);
        let programs = self.debugger()?.programs();
        let mut lines = Vec::new();
        for line in first..=last.min(first.saturating_add(10_000)) {
            if programs.at_line(Some(&path), line, None).1 == line
                && !programs.at_line(Some(&path), line, None).0.is_empty()
            {
                lines.push(json!({ "line": line }));
            }
        }
        Ok(json!({ "breakpoints": lines }))
    }
}

/// The description of a breakpoint for clients.
fn verified<T: Target>(debugger: &Debugger<T>, id: u32, text: &str) -> Value {
    let mut shown = json!({ "id": id, "verified": true });
    let found = debugger.breakpoints().iter().find(|breakpoint| breakpoint.id == id);
    if let Some(crate::debugger::BreakpointKind::Code(_, addresses)) =
        found.map(|breakpoint| &breakpoint.kind)
        && let Some(place) = addresses.first().and_then(|address| debugger.place(*address))
    {
        shown["line"] = json!(place.line);
        shown["source"] = super::look::source(&place.file);
        shown["instructionReference"] = json!(format!("{:#010x}", addresses[0]));
    }
    if text.contains("has no code") {
        shown["message"] = json!(text);
    }
    shown
}
