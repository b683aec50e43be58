//! Lists the files of facts in `boards/`, so that a new file there is a new board.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=boards");
    let folder = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("boards");
    let mut files =
        fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    files.retain(|path| path.extension().is_some_and(|extension| extension == "facts"));
    files.sort();
    let texts: Vec<_> = files.iter().map(|path| format!("include_str!({path:?})")).collect();
    fs::write(Path::new(&env::var("OUT_DIR")?).join("facts.rs"), format!("&[{}]", texts.join(", ")))?;
    Ok(())
}
