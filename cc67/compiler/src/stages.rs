//! Each stage after the front end as a function from text to text, for testing one stage alone.
//!
//! The tests in `tests/filetests/{lower,passes,legalize,bytecode}` use these.

use std::fmt::Write as _;
use std::path::Path;

use kmotiondef::timing::Timing;

use crate::bytecode::{Generator, show};
use crate::driver::{self, CompileContext, CompileRequest, Options};
use crate::ir::function::{Function, Signatures};
use crate::ir::text::{self, SymbolNames};
use crate::ir::{parse, verify};
use crate::{lower, passes, pp};

/// Compiles C to IR, before any pass; the folder of `path` is searched for includes.
///
/// # Errors
/// The first error of the program.
pub fn lower(path: &Path, source: Vec<u8>, files: &(dyn pp::Files + Sync)) -> Result<String, String> {
    driver::on_large_stack(|| {
        let mut context = CompileContext::default();
        let unit = CompileRequest { path, options: &Options::default(), files }
            .run_front_end(source, &mut context)
            .unit;
        if let Some(error) =
            context.sink.diagnostics().iter().find(|found| found.severity == crate::diag::Severity::Error)
        {
            return Err(error.message.clone());
        }
        let mut signatures = Signatures::default();
        let definitions = lower::Definitions::new(&unit, &mut signatures);
        let functions: Vec<_> = (unit.functions.iter())
            .map(|function| lower::lower(&unit, function, &definitions, Timing::Fast, &mut signatures))
            .collect();
        print(&functions, &signatures, &unit.symbols)
    })
    .map_err(|error| error.message)?
}

/// Reads IR and prints it again.
///
/// # Errors
/// The error in the text.
pub fn reprint(ir: &str) -> Result<String, String> {
    let unit = read(ir)?;
    print(&unit.functions, &unit.signatures, &unit.symbols)
}

/// Runs the pass with this name, one of [`passes::ALL`], over IR.
///
/// # Errors
/// There is no pass with this name, or the text or the result is not valid IR.
pub fn pass(name: &str, ir: &str) -> Result<String, String> {
    let (_, pass) = passes::ALL
        .iter()
        .find(|(pass, _)| *pass == name)
        .ok_or_else(|| format!("there is no pass `{name}`"))?;
    let mut unit = read(ir)?;
    pass(&mut unit.functions);
    print(&unit.functions, &unit.signatures, &unit.symbols)
}

/// Converts IR to IR that contains only instructions of the bytecode.
///
/// # Errors
/// The error in the text.
pub fn legalize(ir: &str) -> Result<String, String> {
    let unit = read(ir)?;
    let shown = |function| show::print_legalized(function, &unit.signatures, &unit.symbols);
    Ok(unit.functions.into_iter().map(shown).collect::<Vec<_>>().join("\n"))
}

/// Compiles IR to bytecode; its signatures and pooled constants come first.
///
/// # Errors
/// The error in the text, or a function is too large.
pub fn bytecode(ir: &str) -> Result<String, String> {
    let unit = read(ir)?;
    let mut generator = Generator::default();
    let mut words = String::new();
    for function in unit.functions {
        let name = unit.symbols.symbol_name(function.symbol).to_owned();
        let generated = generator.function(function, &name).map_err(|error| error.message.clone())?;
        // Writing to a string cannot fail.
        let _ =
            write!(words, "\n{name}:\n{}", show::print_words(generator.text(), &generated, &unit.symbols));
    }
    let (_, pool) = generator.finish();
    let mut head = String::new();
    for (number, signature) in unit.signatures.as_slice().iter().enumerate() {
        let params: Vec<_> = signature.params.iter().map(ToString::to_string).collect();
        let result = signature.result.map(|class| format!(" -> {class}")).unwrap_or_default();
        let _ = writeln!(head, "sig{number}: ({}){result}", params.join(", "));
    }
    for (number, bits) in pool.iter().enumerate() {
        let _ = writeln!(head, "pool[{number}]: {bits:#018x}");
    }
    Ok(head + &words)
}

fn read(ir: &str) -> Result<parse::Functions, String> {
    parse::parse(ir).map_err(|error| error.to_string())
}

/// The text of well-formed functions, with an empty line between them.
fn print(functions: &[Function], signatures: &Signatures, names: &dyn SymbolNames) -> Result<String, String> {
    let mut shown = Vec::new();
    for function in functions {
        let text = text::print(function, signatures, names);
        verify::verify(function, signatures).map_err(|found| format!("{found}\n{text}"))?;
        shown.push(text);
    }
    Ok(shown.join("\n"))
}
