//! Options of the PC: its answers, M codes that start programs, the file of the board's flash.

use std::net::IpAddr;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use runtime::{Answers, MachineFile};

use super::heading;
use super::setting::{self, Setting};
use crate::cli::io::input::read;

/// Options about the PC.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = heading::PC)]
pub(crate) struct PcArguments {
    /// Take the PC's answers to programs from FILE: lines of `key=value`, as for `--answer`; for `live` also an address
    /// to listen on
    #[arg(long = "host", value_name = "FILE")]
    host: Option<PathBuf>,
    /// Set one answer of the PC, such as msgbox=no, input=1.5, mdi=0, request.14=-1, var.500=2; `help` lists the keys
    #[arg(long, value_name = "KEY=VALUE")]
    answer: Vec<String>,
    /// Store the parameters of an M code in persist.UserData, starting at element VAR: "M110 P1.23 Q4.56 R-1:0"
    #[arg(long, value_name = "CODE:VAR")]
    mcode: Option<String>,
    /// Keep the board's flash memory in FILE, and boot from it if the file exists
    #[arg(long, value_name = "FILE")]
    flash: Option<PathBuf>,
}

impl PcArguments {
    /// The address that `--host` is, if it is one and no file.
    pub(crate) fn address(&self) -> Option<IpAddr> {
        self.host.as_ref()?.to_str()?.parse().ok()
    }

    /// The answers that are given one by one, as they were typed.
    #[cfg(feature = "live")]
    pub(crate) fn single_answers(&self) -> &[String] {
        &self.answer
    }

    /// Returns whether a file of the flash is named here.
    pub(crate) const fn has_flash(&self) -> bool {
        self.flash.is_some()
    }

    /// Returns the PC's answers: those of the machine file, overridden by these.
    pub(crate) fn answers(&self, machine: &MachineFile) -> Result<Option<Answers>> {
        let mut answers = machine.pc.answers.clone();
        if let Some(path) = self.host.as_ref().filter(|_| self.address().is_none()) {
            let text = String::from_utf8_lossy(&read(path)?).into_owned();
            for (line, number) in text.lines().zip(1..) {
                answers.line(line).with_context(|| format!("{}:{number}", path.display()))?;
            }
        }
        for setting in &self.answer {
            if setting == "help" {
                bail!("`--answer` takes\n{}", runtime::ANSWERS_HELP.trim_end());
            }
            answers.set(setting).context("`--answer`")?;
        }
        Ok(Some(answers))
    }

    /// Returns the values that an M code stores before its program starts.
    pub(crate) fn mcode(&self) -> Result<Vec<Setting>> {
        self.mcode
            .as_deref()
            .map_or(Ok(Vec::new()), |text| mcode(text).with_context(|| format!("`--mcode \"{text}\"`")))
    }

    /// The file of the flash, here or in the machine file.
    pub(crate) fn flash_file(&self, machine: &MachineFile) -> Option<PathBuf> {
        self.flash.clone().or_else(|| machine.boards.flash.as_ref().map(PathBuf::from))
    }
}

/// The words that pass parameters, in the order in which they are stored.
const LETTERS: [char; 3] = ['P', 'Q', 'R'];

/// Reads an M code with its words, and the element that the PC's set-up names; see the manual, "MCodes with
/// Parameters": P, Q and R go into consecutive elements as singles, or else the M code's number into one.
fn mcode(text: &str) -> Result<Vec<Setting>> {
    let (code, variable) = text.rsplit_once(':').unwrap_or((text, "0"));
    let variable: u32 =
        variable.trim().parse().with_context(|| format!("`{variable}` is not an element of UserData"))?;
    let mut words = code.split_whitespace();
    let first = words.next().unwrap_or_default().to_ascii_uppercase();
    let number = |word: &str| word.parse::<f32>().with_context(|| format!("`{word}` is not a number"));
    if let Some(speed) = first.strip_prefix('S') {
        return Ok(vec![setting::single_setting(variable, number(speed)?)?]);
    }
    let code: i32 =
        first.strip_prefix('M').and_then(|code| code.parse().ok()).context("there is no M code")?;
    let mut parameters = [None; LETTERS.len()];
    let mut tool = None;
    for word in words {
        let word = word.to_ascii_uppercase();
        let letter = word.chars().next().unwrap_or_default();
        let value = word.get(1..).unwrap_or_default();
        match LETTERS.iter().position(|known| *known == letter) {
            Some(index) => parameters[index] = Some(number(value)?),
            None if letter == 'T' && code == 6 => {
                tool = Some(value.parse::<i32>().context("T needs a tool")?);
            }
            None => bail!("`{word}` is neither P, Q nor R"),
        }
    }
    if let Some(tool) = tool {
        // The slot, and behind it the tool's id; a tool table of the simplest kind has them equal.
        return Ok(vec![
            setting::integer_setting(variable, tool)?,
            setting::integer_setting(variable + 1, tool)?,
        ]);
    }
    let given: Vec<f32> = parameters.into_iter().flatten().collect();
    if given.is_empty() {
        return Ok(vec![setting::integer_setting(variable, code)?]);
    }
    (variable..).zip(given).map(|(element, value)| setting::single_setting(element, value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expect: &[(u32, u32)]) {
        let stored = |setting: Setting| (setting.address, setting.bytes);
        let settings: Vec<_> = mcode(text).expect(text).into_iter().map(stored).collect();
        let word = |(element, word): &(u32, u32)| stored(setting::word(*element, *word).expect("inside"));
        let expect: Vec<_> = expect.iter().map(word).collect();
        assert_eq!(settings, expect, "{text}");
    }

    #[test]
    fn parameters_go_into_consecutive_elements() {
        let single = |value: f32| value.to_bits();
        check("M110 P1.23 Q4.56 R-1:0", &[(0, single(1.23)), (1, single(4.56)), (2, single(-1.0))]);
        check("m110 r2 p1:10", &[(10, single(1.0)), (11, single(2.0))]);
        check("M101:5", &[(5, 101)]);
        check("M101", &[(0, 101)]);
        check("S1500:99", &[(99, single(1500.0))]);
        check("M6 T3:20", &[(20, 3), (21, 3)]);
    }

    #[test]
    fn wrong_codes_say_what_is_wrong() {
        for (text, expect) in [
            ("P1", "there is no M code"),
            ("M110 X5", "`X5` is neither P, Q nor R"),
            ("M110 Px", "`X` is not a number"),
            ("M110 P1:200", "outside"),
            ("M110 P1:a", "`a` is not an element of UserData"),
        ] {
            let error = format!("{:#}", mcode(text).expect_err(text));
            assert!(error.contains(expect), "{text}: {error}");
        }
    }
}
