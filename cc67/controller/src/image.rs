//! From a program to what is downloaded.

use cc67_host::{HostError, UserProgram};
use cc67_wire::LoadImage;
use coff::{Image, Target};
use kmotiondef::boards::stamp;

/// Returns the bytes of a program at their addresses, with the firmware that it was linked for.
///
/// # Errors
/// It is not an image for the controller's processor.
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
        _ if stamp(board) != Some(stated) => Some(format!("version {}.{:02}", stated / 100, stated % 100)),
        _ => None,
    };
    Ok(LoadImage { thread: program.thread, entry: header.entry, parts, firmware })
}
