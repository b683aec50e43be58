//! The contents of an image, as JSON and as the texts of `cc67 inspect`.

use compiler::files;
use compiler::inspect::{Inspection, Order, Sources};
use pyo3::prelude::*;

use crate::errors::input;

fn read(name: &str, bytes: &[u8]) -> PyResult<Inspection> {
    Inspection::read(bytes).map_err(|error| match files::describe(bytes) {
        Some(what) => input(format!("{name} is {what}, not a TI COFF image")),
        None => input(format!("{name}: {error}")),
    })
}

/// Return headers, sections, symbols, lines and functions as JSON.
#[pyfunction]
pub(crate) fn inspection(name: &str, bytes: &[u8]) -> PyResult<String> {
    Ok(read(name, bytes)?.to_json(Order::Address).to_string())
}

/// Return the parts of `cc67 inspect --all` as texts: headers, symbols, lines, calls, stack.
#[pyfunction]
pub(crate) fn parts(name: &str, bytes: &[u8]) -> PyResult<Vec<(&'static str, String)>> {
    let inspection = read(name, bytes)?;
    Ok(vec![
        ("headers", inspection.headers()),
        ("symbols", inspection.symbol_table(Order::Address)),
        ("lines", inspection.line_table()),
        ("calls", inspection.calls()),
        ("stack", inspection.stack()),
    ])
}

/// Return the instructions of one function, or of all, with their source lines.
#[pyfunction]
#[pyo3(signature = (name, bytes, folder, function = None))]
pub(crate) fn disassembly(
    name: &str,
    bytes: &[u8],
    folder: std::path::PathBuf,
    function: Option<&str>,
) -> PyResult<String> {
    Ok(read(name, bytes)?.disassembly(&Folder(folder), function))
}

/// Source files in a folder.
struct Folder(std::path::PathBuf);

impl Sources for Folder {
    fn text(&self, name: &str) -> Option<String> {
        let bytes = std::fs::read(self.0.join(name)).ok()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }
}
