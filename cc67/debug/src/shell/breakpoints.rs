//! The table of breakpoints.

use std::fmt::Write as _;

use cc67_host::Target;

use super::Shell;
use crate::debugger::{Breakpoint, BreakpointKind, Debugger, WatchedAccess, file_name};

/// The minimum width of the column with the types.
const TYPE_WIDTH: usize = 14;

fn type_of(breakpoint: &Breakpoint) -> &'static str {
    match &breakpoint.kind {
        BreakpointKind::Code(..) if breakpoint.log.is_some() => "dprintf",
        BreakpointKind::Code(..) => "breakpoint",
        BreakpointKind::Watch(_) => "hw watchpoint",
        BreakpointKind::Access(_, WatchedAccess::Read) => "read watchpoint",
        BreakpointKind::Access(_, WatchedAccess::ReadWrite) => "acc watchpoint",
        BreakpointKind::When(_) => "catchpoint",
    }
}

impl<T: Target> Shell<T> {
    /// The breakpoints, or only the watchpoints, as a table.
    pub(super) fn table(&self, only_watchpoints: bool) -> String {
        let is_meant = |breakpoint: &&Breakpoint| {
            let is_watchpoint =
                matches!(breakpoint.kind, BreakpointKind::Watch(_) | BreakpointKind::Access(..));
            is_watchpoint || !only_watchpoints
        };
        let shown: Vec<_> = self.debugger.breakpoints().iter().filter(is_meant).collect();
        if shown.is_empty() {
            let none =
                if only_watchpoints { "No watchpoints.\n" } else { "No breakpoints or watchpoints.\n" };
            return none.to_owned();
        }
        let width = shown.iter().map(|one| type_of(one).len()).fold(TYPE_WIDTH, usize::max);
        let mut out = format!("{:<7} {:<width$} Disp Enb {:<10} What\n", "Num", "Type", "Address");
        for breakpoint in shown {
            self.row(breakpoint, width, &mut out);
        }
        out
    }

    fn row(&self, breakpoint: &Breakpoint, width: usize, out: &mut String) {
        let Breakpoint { id, kind, condition, hits, ignore, .. } = breakpoint;
        let disposition = if breakpoint.is_temporary { "del" } else { "keep" };
        let enabled = if breakpoint.is_enabled { 'y' } else { 'n' };
        let debugger = &self.debugger;
        let (address, what) = match kind {
            BreakpointKind::Code(_, addresses) => match addresses.as_slice() {
                [one] => (format!("{one:#010x}"), place_in_words(debugger, *one)),
                _ => ("<MULTIPLE>".to_owned(), String::new()),
            },
            BreakpointKind::Watch(expression) | BreakpointKind::Access(expression, _) => {
                (String::new(), expression.clone())
            }
            BreakpointKind::When(expression) => (String::new(), format!("when {expression}")),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{}",
            format!(
                "{id:<7} {:<width$} {disposition:<4} {enabled:<3} {address:<10} {what}",
                type_of(breakpoint)
            )
            .trim_end()
        );
        if let Some(condition) = condition {
            let _ = writeln!(out, "\tstop only if {condition}");
        }
        if *hits > 0 {
            let plural = if *hits == 1 { "" } else { "s" };
            let _ = writeln!(out, "\tbreakpoint already hit {hits} time{plural}");
        }
        if *ignore > 0 {
            let _ = writeln!(out, "\tignore next {ignore} hits");
        }
        for command in self.commands.get(id).into_iter().flatten() {
            let _ = writeln!(out, "        {command}");
        }
        if let BreakpointKind::Code(_, addresses) = kind
            && addresses.len() > 1
        {
            for (index, address) in addresses.iter().enumerate() {
                let number = format!("{id}.{}", index + 1);
                let blank = width + 6;
                let place = place_in_words(debugger, *address);
                let _ = writeln!(out, "{number:<7} {:<blank$}{enabled:<3} {address:#010x} {place}", "");
            }
        }
    }
}

/// The location of an instruction, in the form of the table.
fn place_in_words<T: Target>(debugger: &Debugger<T>, address: u32) -> String {
    let place = debugger.place(address);
    place.map_or_else(String::new, |place| {
        format!("in {} at {}:{}", place.function, file_name(&place.file), place.line)
    })
}
