//! The command line of the vendor's compiler.
//!
//! Options begin with one `-` and are listed in the table [`OPTIONS`]; an option's argument is the next word, or
//! follows directly if the table says so. Everything else is a file, whose kind is determined by its suffix.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use compiler::pp::Standard;

/// The text that is shown when there is nothing to compile.
pub(super) const HELP: &str = "\
usage: tcc67 [options] program.c firmware.out

  -text H      load address of the program, hexadecimal, a multiple of 32
  -data H      address of the initialised data, after the text by default
  -bss H       address of the uninitialised data, after the initialised by default
  -o FILE      write the program to FILE; without it the program is only compiled
  -g           write symbols and line numbers
  -I DIR       search DIR for included files
  -D NAME[=V]  define a macro
  -U NAME      undefine a macro
  -c           do not link

This is cc67 in place of the vendor's compiler; `cc67 --help` shows its own commands.
";

/// The default address of a program.
pub(super) const DEFAULT_TEXT: u32 = 0x400;

/// The alignment of the text.
const FETCH_PACKET: u32 = 32;

/// The meaning of a command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Invocation {
    /// Compile a program.
    Compile(Box<CompileRequest>),
    /// Show the help.
    Help,
    /// Print the directories that the compiler searches for its files.
    SearchDirectories,
}

/// A request to compile a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct CompileRequest {
    /// The source file.
    pub(super) source: PathBuf,
    /// The firmware file.
    pub(super) firmware: Option<PathBuf>,
    /// The output file; `None` if the program is only compiled.
    pub(super) output: Option<PathBuf>,
    /// The address of the text.
    pub(super) text: u32,
    /// The address of the initialised data; `None` for directly after the text.
    pub(super) data: Option<u32>,
    /// The address of the uninitialised data; `None` for directly after the initialised data.
    pub(super) bss: Option<u32>,
    /// True if symbols and line numbers are written.
    pub(super) has_symbols: bool,
    /// Directories of included files.
    pub(super) include_dirs: Vec<PathBuf>,
    /// Macros with their bodies.
    pub(super) defines: Vec<(String, Option<String>)>,
    /// Macros to undefine.
    pub(super) undefines: Vec<String>,
    /// The C standard of the program.
    pub(super) standard: Standard,
}

/// The way in which an option takes its argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ArgumentForm {
    /// It has no argument.
    Nothing,
    /// In the next word.
    Next,
    /// In the rest of the word, or in the next word if there is no rest.
    RestOrNext,
    /// In the rest of the word, which may be empty.
    Rest,
}

/// The meaning of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OptionMeaning {
    Text,
    Data,
    Bss,
    Symbols,
    IncludeDirectory,
    Define,
    Undefine,
    Output,
    CompileOnly,
    SearchDirectories,
    /// Options for the linker, some of which are used.
    Linker,
    /// The C standard of the program.
    Standard,
    /// Accepted for old command lines, and ignored.
    Nothing,
}

/// All options; the first match counts.
const OPTIONS: &[(&str, ArgumentForm, OptionMeaning)] = &[
    ("-text", ArgumentForm::Next, OptionMeaning::Text),
    ("-data", ArgumentForm::Next, OptionMeaning::Data),
    ("-bss", ArgumentForm::Next, OptionMeaning::Bss),
    ("-bench", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-bt", ArgumentForm::Next, OptionMeaning::Nothing),
    ("-b", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-g", ArgumentForm::Nothing, OptionMeaning::Symbols),
    ("-nostdinc", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-nostdlib", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-print-search-dirs", ArgumentForm::Nothing, OptionMeaning::SearchDirectories),
    ("-rdynamic", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-r", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-shared", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-static", ArgumentForm::Nothing, OptionMeaning::Nothing),
    ("-std=", ArgumentForm::Rest, OptionMeaning::Standard),
    ("-c", ArgumentForm::Nothing, OptionMeaning::CompileOnly),
    ("-o", ArgumentForm::RestOrNext, OptionMeaning::Output),
    ("-I", ArgumentForm::RestOrNext, OptionMeaning::IncludeDirectory),
    ("-D", ArgumentForm::RestOrNext, OptionMeaning::Define),
    ("-U", ArgumentForm::RestOrNext, OptionMeaning::Undefine),
    ("-L", ArgumentForm::RestOrNext, OptionMeaning::Nothing),
    ("-B", ArgumentForm::RestOrNext, OptionMeaning::Nothing),
    ("-l", ArgumentForm::RestOrNext, OptionMeaning::Nothing),
    ("-Wl,", ArgumentForm::Rest, OptionMeaning::Linker),
    ("-W", ArgumentForm::Rest, OptionMeaning::Nothing),
    ("-O", ArgumentForm::Rest, OptionMeaning::Nothing),
    ("-m", ArgumentForm::Rest, OptionMeaning::Nothing),
    ("-f", ArgumentForm::Rest, OptionMeaning::Nothing),
];

/// Parses a command line without the program's name.
///
/// # Errors
/// The error, in the vendor's words if there are any.
pub(super) fn parse(arguments: &[OsString]) -> Result<Invocation, String> {
    let mut reading = PartialRequest {
        request: CompileRequest { text: DEFAULT_TEXT, ..CompileRequest::default() },
        sources: Vec::new(),
        compile_only: false,
        search_directories: false,
    };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let word = argument.to_string_lossy();
        if !word.starts_with('-') || word == "-" {
            reading.file(Path::new(argument))?;
            continue;
        }
        let (name, takes, meaning) = find(&word).ok_or_else(|| format!("invalid option -- '{word}'"))?;
        let joined = word.get(name.len()..).unwrap_or_default();
        let value = match takes {
            ArgumentForm::Nothing => String::new(),
            ArgumentForm::Rest => joined.to_owned(),
            ArgumentForm::RestOrNext if !joined.is_empty() => joined.to_owned(),
            ArgumentForm::Next | ArgumentForm::RestOrNext => {
                let next = rest.next().ok_or_else(|| format!("argument to '{name}' is missing"))?;
                next.to_string_lossy().into_owned()
            }
        };
        reading.option(meaning, &value)?;
    }
    reading.finish()
}

/// The matching row of the table.
fn find(word: &str) -> Option<(&'static str, ArgumentForm, OptionMeaning)> {
    let fits = |(name, takes, _): &&(&'static str, ArgumentForm, OptionMeaning)| match takes {
        ArgumentForm::Nothing | ArgumentForm::Next => word == *name,
        ArgumentForm::RestOrNext | ArgumentForm::Rest => word.starts_with(name),
    };
    OPTIONS.iter().find(fits).copied()
}

/// A command line during parsing.
struct PartialRequest {
    request: CompileRequest,
    sources: Vec<PathBuf>,
    compile_only: bool,
    search_directories: bool,
}

impl PartialRequest {
    fn option(&mut self, meaning: OptionMeaning, value: &str) -> Result<(), String> {
        let request = &mut self.request;
        match meaning {
            OptionMeaning::Text => request.text = text_address(value)?,
            OptionMeaning::Data => request.data = Some(address(value, "data")?),
            OptionMeaning::Bss => request.bss = Some(address(value, "bss")?),
            OptionMeaning::Symbols => request.has_symbols = true,
            OptionMeaning::IncludeDirectory => request.include_dirs.push(native(Path::new(value))),
            OptionMeaning::Define => {
                let (name, body) = value.split_once('=').map_or((value, None), |(n, v)| (n, Some(v)));
                request.defines.push((name.to_owned(), body.map(str::to_owned)));
            }
            OptionMeaning::Undefine => request.undefines.push(value.to_owned()),
            OptionMeaning::Output => request.output = Some(native(Path::new(value))),
            OptionMeaning::CompileOnly => self.compile_only = true,
            OptionMeaning::SearchDirectories => self.search_directories = true,
            OptionMeaning::Linker => {
                // `-Wl,-Ttext,80050000`, or with `=`: the form used by newer versions.
                let mut words = value.split([',', '=']).skip_while(|word| *word != "-Ttext").skip(1);
                if let Some(address) = words.next() {
                    request.text = text_address(address)?;
                }
            }
            OptionMeaning::Standard => request.standard = Standard::named(value).unwrap_or_default(),
            OptionMeaning::Nothing => {}
        }
        Ok(())
    }

    fn file(&mut self, path: &Path) -> Result<(), String> {
        let path = native(path);
        let suffix = path.extension().unwrap_or_default();
        if suffix.eq_ignore_ascii_case("c") {
            self.sources.push(path);
            return Ok(());
        }
        if suffix != "out" {
            return Err(format!(
                "unrecognized file type: '{}' (a program ends in .c, the firmware file in .out)",
                path.display()
            ));
        }
        match self.request.firmware.replace(path) {
            None => Ok(()),
            Some(first) => Err(format!("more than one firmware file, the first is '{}'", first.display())),
        }
    }

    fn finish(mut self) -> Result<Invocation, String> {
        if self.search_directories {
            return Ok(Invocation::SearchDirectories);
        }
        let mut sources = self.sources.into_iter();
        let Some(source) = sources.next() else { return Ok(Invocation::Help) };
        if let Some(second) = sources.next() {
            let (first, second) = (source.display(), second.display());
            return Err(format!("one program at a time: '{first}' and '{second}' are given"));
        }
        if self.compile_only && self.request.output.take().is_some() {
            return Err("option '-c' writes no file; without it the program is linked".to_owned());
        }
        self.request.source = source;
        Ok(Invocation::Compile(Box::new(self.request)))
    }
}

fn text_address(value: &str) -> Result<u32, String> {
    let address = address(value, "text")?;
    if !address.is_multiple_of(FETCH_PACKET) {
        return Err(".text linker section must be aligned to fetch packet (32 byte boundary)".to_owned());
    }
    Ok(address)
}

fn address(value: &str, section: &str) -> Result<u32, String> {
    let digits = value.strip_prefix("0x").or_else(|| value.strip_prefix("0X")).unwrap_or(value);
    // `from_str_radix` would accept a sign.
    let is_number = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let address = is_number.then(|| u32::from_str_radix(digits, 16).ok()).flatten();
    address.ok_or_else(|| format!("Invalid {section} address option"))
}

/// A path in this system's notation: calls by Windows programs have backslashes.
fn native(path: &Path) -> PathBuf {
    match path.to_str() {
        Some(text) if !cfg!(windows) && text.contains('\\') && !path.exists() => {
            PathBuf::from(text.replace('\\', "/"))
        }
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(words: &[&str]) -> Result<Invocation, String> {
        parse(&words.iter().map(OsString::from).collect::<Vec<_>>())
    }

    fn request(words: &[&str]) -> CompileRequest {
        match call(words) {
            Ok(Invocation::Compile(request)) => *request,
            other => panic!("{words:?}: {other:?}"),
        }
    }

    #[test]
    fn the_command_line_of_the_pc_software_is_understood() {
        let words = [
            "-text",
            "80050000",
            "-g",
            "-nostdinc",
            "-I",
            "DSP dir",
            "-I",
            "source dir",
            "-o",
            "prog(1).out",
            "prog.c",
            "DSP dir/DSPKFLOP.out",
        ];
        let expect = CompileRequest {
            source: "prog.c".into(),
            firmware: Some("DSP dir/DSPKFLOP.out".into()),
            output: Some("prog(1).out".into()),
            text: 0x8005_0000,
            has_symbols: true,
            include_dirs: vec!["DSP dir".into(), "source dir".into()],
            ..CompileRequest::default()
        };
        assert_eq!(request(&words), expect);
    }

    #[test]
    fn the_command_line_of_newer_versions_is_understood() {
        let words = [
            "-Wl,-Ttext,80060000",
            "-Wl,--oformat,coff",
            "-static",
            "-nostdinc",
            "-nostdlib",
            "-IDSP",
            "-DMILLS=3",
            "-DX",
            "-UY",
            "-O2",
            "-Wall",
            "-fno-common",
            "-m32",
            "-bt",
            "8",
            "-bench",
            "-lm",
            "DSP\\DSPKFLOP.out",
            "P.C",
            "-oP.out",
        ];
        let expect = CompileRequest {
            source: "P.C".into(),
            firmware: Some("DSP/DSPKFLOP.out".into()),
            output: Some("P.out".into()),
            text: 0x8006_0000,
            include_dirs: vec!["DSP".into()],
            defines: vec![("MILLS".to_owned(), Some("3".to_owned())), ("X".to_owned(), None)],
            undefines: vec!["Y".to_owned()],
            ..CompileRequest::default()
        };
        assert_eq!(request(&words), expect);
    }

    #[test]
    fn addresses_are_hexadecimal_and_text_starts_at_a_multiple_of_32() {
        assert_eq!(request(&["a.c"]).text, 0x400);
        let words = ["-text", "0x80050020", "-data", "80052000", "-bss", "80053000", "a.c"];
        let CompileRequest { text, data, bss, .. } = request(&words);
        assert_eq!((text, data, bss), (0x8005_0020, Some(0x8005_2000), Some(0x8005_3000)));
    }

    #[test]
    fn wrong_command_lines_give_the_vendors_messages() {
        for (words, expect) in [
            (&["-zzz", "a.c"][..], "invalid option -- '-zzz'"),
            (&["a.c", "-text"], "argument to '-text' is missing"),
            (&["-text", "80050010", "a.c"], ".text linker section must be aligned to fetch packet"),
            (&["-text", "xyz", "a.c"], "Invalid text address option"),
            (&["-text", "+1", "a.c"], "Invalid text address option"),
            (&["a.txt"], "unrecognized file type"),
            (&["a"], "unrecognized file type"),
            (&["a.c", "F.OUT"], "unrecognized file type"),
            (&["a.c", "b.c"], "one program at a time"),
            (&["a.c", "a.out", "b.out"], "more than one firmware file"),
            (&["-c", "-o", "a.o", "a.c"], "option '-c' writes no file"),
        ] {
            let message = call(words).expect_err("the command line is wrong");
            assert!(message.contains(expect), "{words:?}: {message}");
        }
        assert_eq!(call(&[]), Ok(Invocation::Help));
        assert_eq!(call(&["-g", "F.out"]), Ok(Invocation::Help));
        assert_eq!(call(&["-print-search-dirs"]), Ok(Invocation::SearchDirectories));
    }
}
