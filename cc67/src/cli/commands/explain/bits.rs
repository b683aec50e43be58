//! I/O bits: the ranges, and single bits by number, as `bit46`, `bit 46` or `46`.

use std::fmt::Write as _;

use anyhow::{Result, bail};
use kmotiondef::Bit;
use kmotiondef::bits::{BIT_RANGES, BitDirection, BitKind, BitRange, kogna_range_of, range_of};

/// Every range.
pub(super) fn list() -> String {
    BIT_RANGES.iter().fold(String::new(), |mut rows, range| {
        let numbers = format!("{} to {}", range.first, range.last);
        let _ = writeln!(rows, "  {numbers:<14}{:<22}{}", range.name, on_a_line(range.doc));
        rows
    })
}

/// Explains a bit, if the name denotes one.
pub(super) fn answer(name: &str) -> Result<Option<String>> {
    let lower = name.to_lowercase();
    let digits = lower.strip_prefix("bit").unwrap_or(&lower).trim();
    let Ok(number) = digits.parse::<u32>() else { return Ok(None) };
    let Some(bit) = i32::try_from(number).ok().and_then(Bit::new) else {
        bail!("no such bit: {number} (0-2047)");
    };
    let Some(range) = range_of(bit).or_else(|| kogna_range_of(bit)) else {
        let text = format!(
            "# bit {number}\n\nNothing on the board or its option boards is connected to this bit: it reads 0 and cannot be \
             written. `cc67 --explain bits` lists the ranges.\n"
        );
        return Ok(Some(text));
    };
    Ok(Some(format!(
        "# bit {number}\n\n{} (bits {} to {}). {}\n\n{}{}",
        range.name,
        range.first,
        range.last,
        on_a_line(range.doc),
        use_of(range, number),
        describe_hardware(range, number)
    )))
}

/// Describes its use by a program.
fn use_of(range: &BitRange, number: u32) -> String {
    match range.direction {
        BitDirection::Programmable => format!(
            "An input at power-up, an output after `SetBitDirection({number}, 1)`:\n\n    if (ReadBit({number})) printf(\"on\\n\");\n\n    \
             SetBitDirection({number}, 1);\n    SetBit({number});\n"
        ),
        BitDirection::Input => {
            format!("An input; a write is ignored:\n\n    while (!ReadBit({number})) WaitNextTimeSlice();\n")
        }
        BitDirection::Output => {
            format!("An output with a fixed direction:\n\n    SetBit({number});\n    ClearBit({number});\n")
        }
        BitDirection::Memory => {
            let word = match range.kind {
                BitKind::VirtualEx => {
                    let (word, bit) = ((number - 1024) / 32, (number - 1024) % 32);
                    format!("It is bit {bit} of `VirtualBitsEx[{word}]`")
                }
                _ => format!("It is bit {} of `VirtualBits`", number - 48),
            };
            format!(
                "{word}: memory that threads, the PC and a stimulus read and write.\n\n    SetBit({number});\n    \
                 if (ReadBit({number})) printf(\"set\\n\");\n"
            )
        }
    }
}

/// Describes the required hardware, and how the simulated machine drives it.
fn describe_hardware(range: &BitRange, number: u32) -> String {
    let board = match range.kind {
        BitKind::KanalogInput
        | BitKind::KanalogOptoInput
        | BitKind::KanalogOptoOutput
        | BitKind::KanalogFet
        | BitKind::KanalogOutput => "It is on a Kanalog board: `board.kanalog = true` in the machine file.\n",
        BitKind::KstepInput => "It is on a KStep board: the program sets `KStepPresent = TRUE` first.\n",
        BitKind::SnapDifferential | BitKind::SnapOpto | BitKind::SnapGpio => "It is on a SnapAmp board.\n",
        BitKind::KognaPin | BitKind::KognaInput | BitKind::KognaOutput => "Only a Kogna has it.\n",
        BitKind::Pin | BitKind::Led | BitKind::Virtual | BitKind::VirtualEx => "",
    };
    let drive = match range.direction {
        BitDirection::Programmable | BitDirection::Input => format!(
            "In a run, drive it with a `[[switch]]` in the machine file, or with a stimulus: `at 1s bit {number} = 1`.\n"
        ),
        BitDirection::Output | BitDirection::Memory => String::new(),
    };
    let separator = if board.is_empty() && drive.is_empty() { "" } else { "\n" };
    format!("{separator}{board}{drive}")
}

fn on_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
