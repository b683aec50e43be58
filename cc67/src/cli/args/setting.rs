//! `--set KEY=VALUE`: start values of what programs read, and keys of the machine file.

use anyhow::{Context, Result, anyhow, bail};
use kmotiondef::GuestAddr;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use runtime::MachineFile;

/// The prefix of a single.
const SINGLE: &str = "f:";

/// Elements of `persist.UserData`.
const USER_DATA: u32 = 200;

/// Bytes to store before the programs start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Setting {
    /// The address.
    pub(crate) address: GuestAddr,
    /// The value, little endian.
    pub(crate) bytes: Vec<u8>,
    /// The element of `persist.UserData` that it is if a single is stored in it.
    pub(crate) single: Option<u32>,
}

/// Reads all settings: start values, and keys of the machine file, which change `machine` at once.
pub(crate) fn all(texts: &[String], machine: &mut MachineFile) -> Result<Vec<Setting>> {
    let mut settings = Vec::new();
    for text in texts {
        let (key, value) = text.split_once('=').with_context(|| format!("`--set {text}` has no `=`"))?;
        match key.strip_prefix("persist.") {
            Some(index) => settings.push(persist(text, index, value)?),
            None => {
                machine.set(key.trim(), value.trim()).map_err(|error| anyhow!("`--set {text}`: {error}"))?;
            }
        }
    }
    Ok(settings)
}

/// Reads one start value.
fn persist(text: &str, index: &str, value: &str) -> Result<Setting> {
    let index: u32 = index.parse().with_context(|| format!("`{index}` in `--set {text}` is not an index"))?;
    let bytes = bytes(value).with_context(|| format!("value of `--set {text}`"))?;
    if index >= USER_DATA || index + (bytes.len() as u32 / 4) > USER_DATA {
        bail!("`--set {text}` is outside persist.UserData[0..{}]", USER_DATA - 1);
    }
    let single = value.starts_with(SINGLE).then_some(index);
    Ok(Setting { address: user_data().offset(4 * index), bytes, single })
}

/// A word of `persist.UserData`.
pub(crate) fn word(element: u32, word: u32) -> Result<Setting> {
    if element >= USER_DATA {
        bail!("element {element} is outside persist.UserData[0..{}]", USER_DATA - 1);
    }
    Ok(Setting { address: user_data().offset(4 * element), bytes: word.to_le_bytes().into(), single: None })
}

/// A whole number in `persist.UserData`.
pub(crate) fn integer_setting(element: u32, value: i32) -> Result<Setting> {
    word(element, value.cast_unsigned())
}

/// A single in `persist.UserData`.
pub(crate) fn single_setting(element: u32, value: f32) -> Result<Setting> {
    Ok(Setting { single: Some(element), ..word(element, value.to_bits())? })
}

/// Address of `persist.UserData[0]`.
fn user_data() -> GuestAddr {
    PERSIST.field(Persist::USER_DATA).address()
}

/// A decimal or hexadecimal integer, `f:` a single, `d:` a double.
fn bytes(value: &str) -> Result<Vec<u8>> {
    let wrong = || anyhow!("{}", suggest_spelling(value));
    if let Some(single) = value.strip_prefix(SINGLE) {
        return Ok(single.parse::<f32>().map_err(|_| wrong())?.to_le_bytes().into());
    }
    if let Some(double) = value.strip_prefix("d:") {
        return Ok(double.parse::<f64>().map_err(|_| wrong())?.to_le_bytes().into());
    }
    let (digits, sign) = value.strip_prefix('-').map_or((value, 1), |digits| (digits, -1));
    let magnitude: i64 = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hexadecimal) => i64::from_str_radix(hexadecimal, 16),
        None => digits.parse(),
    }
    .map_err(|_| wrong())?;
    let number = sign * magnitude;
    if !(i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(&number) {
        bail!("{value} does not fit 32 bits");
    }
    Ok((number as u32).to_le_bytes().into())
}

/// Suggests a valid spelling in place of an invalid value.
fn suggest_spelling(value: &str) -> String {
    let plain = value.trim_start_matches("f:").trim_start_matches("d:").replace(',', ".");
    match plain.parse::<f64>() {
        Ok(_) => format!(
            "`{value}` is not an integer; write f:{plain} for a float, which takes one element, or d:{plain} for a double, which takes two"
        ),
        Err(_) => format!(
            "`{value}` is not a value; write an integer such as 15 or 0x0F, f:1.5 for a float or d:1.5 for a double"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_integers_singles_or_doubles() {
        for (text, expect) in [
            ("5", vec![5, 0, 0, 0]),
            ("-1", vec![255; 4]),
            ("0x3F9D70A4", vec![0xa4, 0x70, 0x9d, 0x3f]),
            ("f:1.23", vec![0xa4, 0x70, 0x9d, 0x3f]),
            ("d:1.5", vec![0, 0, 0, 0, 0, 0, 0xf8, 0x3f]),
        ] {
            assert_eq!(bytes(text).expect("the value is good"), expect, "{text}");
        }
    }

    #[test]
    fn wrong_settings_say_what_is_wrong() {
        for (text, expect) in [
            ("persist.5", "has no `=`"),
            ("persist.200=1", "outside persist.UserData[0..199]"),
            ("persist.199=d:1", "outside persist.UserData[0..199]"),
            ("persist.x=1", "is not an index"),
            ("persist.1=5000000000", "value of `--set persist.1=5000000000`"),
            ("cpu.servo_us=100", "`--set cpu.servo_us=100`: `cpu.servo_us` must be below the 90 µs"),
            ("axis.0.modle=motor", "did you mean `model`?"),
            ("axis.0.model=magic", "must be \"follow\" or \"motor\" or \"none\", not \"magic\""),
        ] {
            let texts = [text.to_owned()];
            let error = all(&texts, &mut MachineFile::default()).expect_err("the setting is wrong");
            let message = error.to_string();
            assert!(message.contains(expect), "{text}: {message}");
        }
    }
}
