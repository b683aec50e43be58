//! Moves and jogs of one to three axes, each of which may interrupt the previous one.

use super::ScenarioWriter;

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    let count = 1 + writer.draw.below(3);
    let speeds: Vec<f64> = (0..count).map(|axis| set_up(writer, axis)).collect();
    if count > 1 && writer.draw.chance(20) {
        let gain = writer.draw.signed(0.1, 3.0);
        writer.start(format!("chan[1].MasterAxis=0; chan[1].SlaveGain={gain:?};"));
    }
    let letters: Vec<String> =
        (0..4).map(|letter| if letter < count { letter.to_string() } else { "-1".to_owned() }).collect();
    writer.start(format!("DefineCoordSystem({});", letters.join(",")));
    for axis in 0..count {
        let place = if writer.draw.chance(50) { 0.0 } else { writer.draw.signed(0.01, 20.0) };
        writer.start(format!("EnableAxisDest({axis},{place:?});"));
    }
    for _ in 0..1 + writer.draw.below(6) {
        let axis = writer.draw.below(count);
        let text = statement(writer, axis, speeds[axis as usize]);
        writer.add_later(2, 45, text);
    }
    let more = 3 + writer.draw.below(80);
    let destinations = (0..count).map(|axis| format!("chan[{axis}].Dest"));
    let columns = ["ServoTick-T0_".to_owned()].into_iter().chain(destinations);
    writer.observe_slices(more, columns.chain(["CS0_StoppingState".to_owned()]).collect::<Vec<_>>());
}

/// Sets up an axis; returns its speed.
fn set_up(writer: &mut ScenarioWriter, axis: u32) -> f64 {
    let speed = writer.draw.magnitude(5.0, 2000.0);
    let acceleration = speed * writer.draw.magnitude(8.0, 300.0);
    let jerk = acceleration * writer.draw.magnitude(10.0, 3000.0);
    writer.start(format!(
        "chan[{axis}].InputMode=NO_INPUT_MODE; chan[{axis}].OutputMode=NO_OUTPUT_MODE; chan[{axis}].MaxFollowingError=1e30;"
    ));
    writer.start(format!(
        "chan[{axis}].Vel={speed:.3}; chan[{axis}].Accel={acceleration:.2}; chan[{axis}].Jerk={jerk:.1};"
    ));
    if writer.draw.chance(12) {
        let limit = writer.draw.magnitude(0.01, 1.0) * speed * 0.05;
        let field = writer.draw.pick(&["SoftLimitPos=", "SoftLimitNeg=-"]);
        writer.start(format!("chan[{axis}].{field}{limit:.4};"));
    }
    if writer.draw.chance(12) {
        let amount = writer.draw.magnitude(0.001, 0.1) * speed;
        let rate = writer.draw.magnitude(0.1, 10.0) * speed;
        writer.start(format!(
            "chan[{axis}].BacklashMode=1; chan[{axis}].BacklashAmount={amount:.4}; chan[{axis}].BacklashRate={rate:.3};"
        ));
    }
    speed
}

fn statement(writer: &mut ScenarioWriter, axis: u32, speed: f64) -> String {
    let draw = &mut writer.draw;
    let distance = speed * draw.signed(0.0002, 0.03);
    let speed = speed * draw.magnitude(0.05, 1.5);
    match draw.below(24) {
        0..=3 => format!("Move({axis},{distance:.5});"),
        4..=6 => format!("MoveRel({axis},{distance:.5});"),
        7 | 8 => format!("MoveAtVel({axis},{distance:.5},{speed:.4});"),
        9 => format!("MoveRelAtVel({axis},{distance:.5},{speed:.4});"),
        10..=12 => format!("Jog({axis},{});", if draw.chance(50) { speed } else { -speed }),
        13 | 14 => format!("Jog({axis},0);"),
        15 | 16 => format!("MoveExp({axis},{distance:.5},{:?});", draw.magnitude(0.0005, 0.02)),
        17 => format!("MoveXYZABC({distance:.5},{:.5},{:.5},0,0,0);", distance / 3.0, -distance),
        18 => "StopCoordinatedMotion();".to_owned(),
        19 => draw.pick(&["ResumeCoordinatedMotion();", "ClearStopImmediately();"]).to_owned(),
        20 => format!("chan[{axis}].Vel={speed:.3};"),
        21 => draw.pick(&["DisableAxis", "EnableAxis", "Zero"]).to_owned() + &format!("({axis});"),
        22 => format!("EnableAxisDest({axis},{distance:.5});"),
        _ => format!("chan[{axis}].Dest={distance:.5};"),
    }
}
