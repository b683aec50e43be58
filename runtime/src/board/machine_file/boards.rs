//! `[board]` and `[uart]`: option boards, flash and the serial port.

use super::MachineFile;
use super::read::{ReadResult, Table, Value, keys};

/// Addresses on a port.
const ADDRESSES: u32 = 8;

pub(super) fn board(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    keys!(table, |key, value| {
        "kanalog" => {
            let choices = [("auto", false), ("false", false), ("true", true)];
            machine.boards.has_kanalog = value.choice(&choices)?;
        };
        "kstep" => machine.boards.has_kstep = value.flag()?;
        "respect_enable" => machine.boards.respect_enable = value.flag()?;
        "konnect" => machine.boards.konnects[1] = konnects(&value)?;
        "konnect_aux0" => machine.boards.konnects[0] = konnects(&value)?;
        "snapamp" => machine.boards.snapamps = value.unsigned(2)? as usize;
        "flash" => machine.boards.flash = file(&value)?;
        "strict_flash" => machine.boards.strict_flash = value.flag()?;
    });
    Ok(())
}

/// The addresses at which boards are present: all of them, or a list.
fn konnects(value: &Value<'_>) -> ReadResult<u8> {
    if value.text().is_ok() {
        return value.choice(&[("any", u8::MAX)]);
    }
    let list = value.array().map_err(|_| value.is_wrong("\"any\" or a list of addresses such as [0, 1]"))?;
    list.iter().try_fold(0, |present, address| Ok(present | 1 << address.unsigned(ADDRESSES - 1)?))
}

pub(super) fn uart(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    keys!(table, |key, value| {
        "input" => machine.uart.input = file(&value)?;
        "output" => machine.uart.output = file(&value)?;
    });
    Ok(())
}

/// The name of a file; an empty one is none.
pub(super) fn file(value: &Value<'_>) -> ReadResult<Option<String>> {
    let name = value.text()?;
    Ok((!name.is_empty()).then(|| name.to_owned()))
}
