//! The conversion of a program to the data of a download.

use cc67_host::{HostError, UserProgram};
use cc67_wire::LoadImage;
use coff::{Image, Target};
use kmotiondef::boards::{TargetBoard, stamp};

/// Returns the bytes of a program at their addresses, with the firmware for which it was linked.
///
/// # Errors
/// The program is not an image for the controller's processor.
pub(crate) fn of_program(
    program: &UserProgram,
    linked_for: &str,
    board: &str,
) -> Result<LoadImage, HostError> {
    let refused = |reason: String| HostError::Link(format!("{}: {reason}", program.name()));
    let image = Image::read(&program.image).map_err(|error| refused(error.to_string()))?;
    if image.target != Target::C6000 {
        return Err(refused(
            "it is an image for simulation; `cc67 build` without `--target sim` makes one for the \
                            controller"
                .to_owned(),
        ));
    }
    let Some(header) = image.program else {
        return Err(refused("the image has no entry point".to_owned()));
    };
    let parts = image.sections.iter().filter(|section| !section.data().is_empty());
    let parts = parts.map(|section| (section.address, section.data().to_vec())).collect();
    let stated = header.version_stamp;
    let firmware = match (stated, program.is_image) {
        // Images of other linkers state nothing.
        (0, true) => None,
        (0, false) => Some(linked_for.to_owned()),
        (_, false) if stamp(linked_for) == Some(stated) => Some(linked_for.to_owned()),
        _ => other_firmware(stated, header.text_start, board),
    };
    Ok(LoadImage { thread: program.thread, entry: header.entry, parts, firmware })
}

/// The firmware that an image states, with code at an address, if it is not the one that the board reports.
fn other_firmware(stated: i16, code: u32, board: &str) -> Option<String> {
    if stamp(board) != Some(stated) {
        return Some(format!("version {}.{:02}", stated / 100, stated % 100));
    }
    // KFLOP and Kogna have firmware of the same version, at other addresses.
    let linked = TargetBoard::of_image(stated, code)?;
    (!board.starts_with(linked.kind())).then(|| linked.title())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_of_another_version_or_kind_of_board_is_not_of_its_firmware() {
        const KFLOP: &str = "KFLOP 5.3.2 Build 18:10:31 Jan 31 2024";
        const KOGNA: &str = "KOGNA 5.3.2 Build 18:10:31 Jan 31 2024";
        for (stated, code, board, expect) in [
            (532, 0x8005_0000, KFLOP, None),
            (532, 0xC008_0000, KOGNA, None),
            (532, 0xC008_0000, KFLOP, Some("KOGNA firmware 5.3.2")),
            (532, 0x8005_0000, KOGNA, Some("KFLOP firmware 5.3.2")),
            (434, 0x8005_0000, KFLOP, Some("version 4.34")),
        ] {
            assert_eq!(other_firmware(stated, code, board).as_deref(), expect, "{code:#x} on {board}");
        }
    }
}
