//! Devices on pins, and actions on option boards.

use kmotiondef::variables::{KANALOG_PRESENT, SNAP_AMP_PRESENT};
use vm::memory::GuestMemory;

use crate::io::konnect::{KonnectBoard, Port};
use crate::io::snapamp::{Quantity, Side};
use crate::machine::connect_snapamp;
use crate::views::TypedAccess;
use crate::world::WorldAccess;
use crate::world::attached::DeviceSpec;
use crate::world::stimulus::reader::StatementReader;
use crate::world::stimulus::scene::Scene;
use crate::world::stimulus::tokens::Mistake;

/// Settings of devices that name an analog input of Kanalog.
const KANALOG_SETTINGS: &[&str] = &["adc", "sine", "cosine"];

/// The name of a device and its settings.
pub(crate) fn read_device(reader: &mut StatementReader<'_>) -> Result<(DeviceSpec,), Mistake> {
    let column = reader.column();
    let name = reader.take("the name of a device", |word| Some(word.to_owned()))?;
    let mut settings = Vec::new();
    while let Some(key) = reader.peek().map(str::to_owned) {
        reader.advance();
        reader.expect_equals()?;
        settings.push((key, reader.take("a value", |word| Some(word.to_owned()))?));
    }
    let device = DeviceSpec { name, settings };
    match device.build() {
        Ok(_) => Ok((device,)),
        Err(message) => Err((column, message)),
    }
}

pub(crate) fn attach(scene: &mut Scene<'_, '_, '_>, device: DeviceSpec) {
    if let Ok(device) = device.build() {
        scene.access.attach(device, scene.context.memory);
    }
}

/// Declares the inputs that a device will drive, so that they do not count as open until then; if one is an analog
/// input, a Kanalog is present.
pub(crate) fn announce_device(device: &DeviceSpec, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
    if let Some(bit) = device.build().ok().and_then(|device| device.drives()) {
        access.io.pins.declare(bit);
    }
    let is_analog = |(key, _): &&(String, String)| KANALOG_SETTINGS.contains(&key.as_str());
    for (_, channel) in device.settings.iter().filter(is_analog) {
        memory.set(KANALOG_PRESENT, 1);
        if let Ok(channel) = channel.parse() {
            access.io.kanalog.connect(channel);
        }
    }
}

pub(crate) fn read_konnect(reader: &mut StatementReader<'_>) -> Result<(KonnectBoard, u8, bool), Mistake> {
    let address = reader.below("an address from 0 to 7", 8)? as u8;
    let port = if reader.accept("aux0") { Port::Aux0 } else { Port::Aux1 };
    reader.expect("input")?;
    let input = reader.below("an input from 0 to 31", 32)? as u8;
    reader.expect_equals()?;
    Ok((KonnectBoard { port, address }, input, reader.level()?))
}

pub(crate) fn konnect(scene: &mut Scene<'_, '_, '_>, board: KonnectBoard, input: u8, level: bool) {
    scene.access.io.konnects.drive(board, input, level);
}

pub(crate) fn read_snapamp(
    reader: &mut StatementReader<'_>,
) -> Result<(usize, Side, Quantity, f64), Mistake> {
    let board = reader.below("a board, 0 or 1", 2)?;
    let quantity = reader.take("`current`, `volts` or `degrees`", |word| match word {
        "current" => Some(Quantity::Current),
        "volts" => Some(Quantity::Voltage),
        "degrees" => Some(Quantity::Temperature),
        _ => None,
    })?;
    let side = reader.take("a side, `A` or `B`", |word| match word {
        "A" => Some(Side::A),
        "B" => Some(Side::B),
        _ => None,
    })?;
    reader.expect_equals()?;
    Ok((board, side, quantity, reader.number("a number")?))
}

pub(crate) fn snapamp(
    scene: &mut Scene<'_, '_, '_>,
    board: usize,
    side: Side,
    quantity: Quantity,
    value: f64,
) {
    scene.access.io.snapamps.set(board, side, quantity, value, scene.context.now);
}

/// Declares a SnapAmp that an action uses as detected at power-up.
pub(crate) fn announce_snapamp(board: &usize, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
    connect_snapamp(&mut access.io.snapamps, &mut access.io.pins, *board);
    memory.set(SNAP_AMP_PRESENT, 1);
}
