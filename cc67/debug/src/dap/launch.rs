//! The launch request of a client, and the capabilities of the server.

use std::ffi::OsString;

use serde_json::{Value, json};

use crate::debugger::DebugError;

/// Keys of a launch request that are not options: the editors' own keys, and those that are handled elsewhere.
const KEYS: &[&str] = &[
    "programs",
    "program",
    "args",
    "cwd",
    "env",
    "type",
    "name",
    "request",
    "noDebug",
    "stopOnEntry",
    "stopAtEnd",
    "preLaunchTask",
    "postDebugTask",
    "internalConsoleOptions",
    "presentation",
    "serverReadyAction",
    "debugServer",
    "console",
    "trace",
];

/// The arguments of a launch request: `"programs": ["1:/path/a.c", "2:/path/b.c"]`, or `"program"` alone, and the
/// options for a board by their long names: `"machine": "mill.toml"`, `"assist": true`, `"set": ["persist.5=7"]`, `"O":
/// 0`.
#[derive(Clone, Debug, Default)]
pub struct Launch(pub(super) Value);

impl Launch {
    /// Converts the request to arguments of `cc67 debug`.
    ///
    /// # Errors
    /// There is no program, or the value of an option is not a text, number or boolean.
    pub fn command_line(&self) -> Result<Vec<OsString>, DebugError> {
        let mut line = Vec::new();
        let empty = serde_json::Map::new();
        for (key, value) in self.0.as_object().unwrap_or(&empty) {
            if KEYS.contains(&key.as_str()) || key.starts_with('_') || key.starts_with('$') {
                continue;
            }
            let values = value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
            for value in values {
                push_option(key, value, &mut line)?;
            }
        }
        let mut programs: Vec<&str> = Vec::new();
        for key in ["program", "programs"] {
            match &self.0[key] {
                Value::String(one) => programs.push(one),
                Value::Array(many) => programs.extend(many.iter().filter_map(Value::as_str)),
                _ => {}
            }
        }
        if programs.is_empty() {
            return Err("\"programs\" names no program, such as [\"1:/path/a.c\"]".into());
        }
        line.push("--".into());
        line.extend(programs.into_iter().map(OsString::from));
        Ok(line)
    }
}

fn push_option(key: &str, value: &Value, line: &mut Vec<OsString>) -> Result<(), DebugError> {
    let dashes = if key.len() == 1 { "-" } else { "--" };
    let option = format!("{dashes}{key}");
    let text = match value {
        Value::Bool(true) => {
            line.push(option.into());
            return Ok(());
        }
        Value::Bool(false) | Value::Null => return Ok(()),
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string(),
        Value::Array(_) | Value::Object(_) => {
            return Err(format!("\"{key}\" takes a text, a number or true").into());
        }
    };
    line.push(if key.len() == 1 {
        format!("{option}{text}").into()
    } else {
        format!("{option}={text}").into()
    });
    Ok(())
}

/// Returns the capabilities of the server; `is_own` is true for a board that the server launches, which can go back in
/// time and restart.
pub(super) fn capabilities(is_own: bool) -> Value {
    json!({
        "supportsConfigurationDoneRequest": true,
        "supportsFunctionBreakpoints": true,
        "supportsConditionalBreakpoints": true,
        "supportsValueFormattingOptions": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsEvaluateForHovers": true,
        "supportsStepBack": is_own,
        "supportsSetVariable": true,
        "supportsSetExpression": true,
        "supportsRestartRequest": is_own,
        "supportsExceptionInfoRequest": true,
        "supportsLogPoints": true,
        "supportsDataBreakpoints": true,
        "supportsReadMemoryRequest": true,
        "supportsWriteMemoryRequest": true,
        "supportsDisassembleRequest": true,
        "supportsInstructionBreakpoints": true,
        "supportsSteppingGranularity": true,
        "supportsCompletionsRequest": true,
        "supportsTerminateRequest": is_own,
        "supportsBreakpointLocationsRequest": true,
        "supportsDelayedStackTraceLoading": true,
        "exceptionBreakpointFilters": [
            { "filter": "traps", "label": "Traps", "default": true, "description": "A thread did the impossible" },
            { "filter": "remarks", "label": "Remarks of the board", "default": false },
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_a_board_have_their_long_names() {
        let launch = Launch(json!({
            "type": "cc67", "request": "launch", "programs": ["1:/a.c", "2:/b.c"], "assist": true, "no-shortcuts": false,
            "set": ["persist.5=7", "persist.6=8"], "O": 0, "for": 2.5
        }));
        let line = launch.command_line().expect("it is right");
        let mut line: Vec<_> = line.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        let programs = line.split_off(line.len() - 3);
        assert_eq!(programs, ["--", "1:/a.c", "2:/b.c"]);
        line.sort();
        assert_eq!(line, ["--assist", "--for=2.5", "--set=persist.5=7", "--set=persist.6=8", "-O0"]);
        assert!(Launch(json!({})).command_line().is_err());
    }
}
