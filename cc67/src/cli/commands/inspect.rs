//! `cc67 inspect`: the contents of an image.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use clap::{Args, ValueEnum};
use coff::{Image, dump};

use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use compiler::files;
use compiler::inspect::{Inspection, Order, Sources};

/// Arguments of `cc67 inspect`.
#[derive(Debug, Args)]
pub(super) struct InspectArguments {
    /// An image, an object or a firmware file
    #[arg(value_name = "IMAGE")]
    file: PathBuf,
    /// Show headers and sections; the default, together with the symbols
    #[arg(long)]
    headers: bool,
    /// Show functions and objects
    #[arg(long)]
    symbols: bool,
    /// Order of the symbols
    #[arg(long, value_name = "ORDER", value_enum, default_value_t = OrderName::Address)]
    sort: OrderName,
    /// Show the symbol table of the file, entry by entry
    #[arg(long)]
    raw: bool,
    /// Show the source line of each address
    #[arg(long)]
    lines: bool,
    /// Show the instructions of all functions or one, with their source lines
    #[arg(long, short = 'd', value_name = "FUNCTION", num_args = 0..=1, require_equals = true)]
    disassembly: Option<Option<String>>,
    /// Folder of the sources [default: that of the image]
    #[arg(long, value_name = "DIR")]
    sources: Option<PathBuf>,
    /// Show where variables are, and their types; needs the source
    #[arg(long)]
    debug: bool,
    /// Show the calls between functions
    #[arg(long)]
    calls: bool,
    /// Show the stack usage of each function and the chain of calls that needs most
    #[arg(long)]
    stack: bool,
    /// Show everything
    #[arg(long)]
    all: bool,
    /// Print JSON: headers, sections, symbols, lines, functions
    #[arg(long)]
    json: bool,
}

/// Orders by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OrderName {
    /// Ascending
    Address,
    /// The largest first
    Size,
    /// Alphabetically
    Name,
}

impl From<OrderName> for Order {
    fn from(name: OrderName) -> Self {
        match name {
            OrderName::Address => Self::Address,
            OrderName::Size => Self::Size,
            OrderName::Name => Self::Name,
        }
    }
}

/// Prints the requested parts.
pub(super) fn inspect(arguments: &InspectArguments) -> Result<Exit> {
    if arguments.debug {
        return debug(arguments);
    }
    let inspection = Inspection::new(read_image(&arguments.file)?);
    let order = arguments.sort.into();
    if arguments.json {
        output::print(&format!("{:#}\n", inspection.to_json(order)))?;
        return Ok(Exit::Success);
    }
    let folder = arguments.file.parent().unwrap_or(Path::new(""));
    let sources = Folder::new(arguments.sources.as_deref().unwrap_or(folder));
    let nothing = !(arguments.headers
        || arguments.symbols
        || arguments.raw
        || arguments.lines
        || arguments.disassembly.is_some()
        || arguments.calls
        || arguments.stack);
    let mut parts = Vec::new();
    if arguments.headers || arguments.all || nothing {
        parts.push(inspection.headers());
    }
    if arguments.symbols || arguments.all || nothing {
        parts.push(inspection.symbol_table(order));
    }
    if arguments.raw {
        parts.push(dump::symbols(&inspection.image));
    }
    if arguments.lines || arguments.all {
        parts.push(inspection.line_table());
    }
    if arguments.calls || arguments.all {
        parts.push(inspection.calls());
    }
    if arguments.stack || arguments.all {
        parts.push(inspection.stack());
    }
    if let Some(function) = &arguments.disassembly {
        parts.push(inspection.disassembly(&sources, function.as_deref()));
    } else if arguments.all {
        parts.push(inspection.disassembly(&sources, None));
    }
    output::print(&parts.join("\n"))?;
    Ok(Exit::Success)
}

/// Prints the debug information of an image.
fn debug(arguments: &InspectArguments) -> Result<Exit> {
    let image = read_image(&arguments.file)?;
    if image.target != coff::Target::CC67 {
        anyhow::bail!(
            "{}: debug information is of images for the simulated board alone",
            arguments.file.display()
        );
    }
    let path =
        arguments.sources.as_ref().map_or_else(|| arguments.file.clone(), |folder| folder.join("image"));
    let model = compiler::debug::of_image(&path, &read(&arguments.file)?, &compiler::Options::default());
    let model =
        model.map_err(|error| anyhow!("no debug information of {}: {error}", arguments.file.display()))?;
    output::print(&model.table())?;
    Ok(Exit::Success)
}

/// Reads an image; for another file, the message names its kind.
pub(super) fn read_image(path: &Path) -> Result<Image> {
    let bytes = read(path)?;
    Image::read(&bytes).map_err(|error| match files::describe(&bytes) {
        Some(what) => anyhow!("{} is {what}, not a TI COFF image", path.display()),
        None => anyhow!("{}: {error}", path.display()),
    })
}

/// A folder with source files.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(folder: &Path) -> Self {
        Self(folder.to_owned())
    }
}

impl Sources for Folder {
    fn text(&self, name: &str) -> Option<String> {
        let bytes = fs::read(self.0.join(name)).ok()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }
}
