//! Outputs of an axis in all modes, writes to amplifiers and bits.

use super::ScenarioWriter;
use crate::cli::commands::compare::random::scenario::PartKind;

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    let mode = writer.draw.below(9);
    let input = writer.draw.pick(&["USER_INPUT_MODE", "USER_INPUT_MODE", "NO_INPUT_MODE"]);
    let channel = writer.draw.below(14);
    writer.start(format!(
        "ch0->InputMode={input}; ch0->OutputMode={mode}; ch0->OutputChan0={channel}; ch0->OutputChan1={}; ch0->MaxFollowingError=1e30;",
        channel + 1
    ));
    settings(writer);
    let [position, place] = [(); 2].map(|()| writer.draw.signed(0.01, 50.0));
    writer.start(format!("ch0->Position={position:?}; EnableAxisDest(0,{place:?});"));
    if writer.draw.chance(60) {
        let gain = writer.draw.magnitude(1e-5, 0.5);
        writer
            .part(PartKind::Tick, format!("ch0->Position=ch0->Position+(ch0->Dest-ch0->Position)*{gain:?};"));
    }
    for _ in 0..1 + writer.draw.below(6) {
        let text = statement(writer, channel);
        writer.add_later(4, 25, text);
    }
    let more = 6 + writer.draw.below(20);
    let columns = [
        "ch0->Output",
        "ch0->Dest",
        "ch0->x1last",
        "ch0->x2last",
        "ch0->last_theta",
        "ch0->theta_correction",
    ];
    let outputs = [
        format!("LastPWM[{channel}]"),
        format!("LastPWM[{}]", channel + 1),
        format!("DAC_Buffer[{}]", channel % 8),
        "VirtualBits".to_owned(),
    ];
    writer.observe_ticks(more, columns.map(str::to_owned).into_iter().chain(outputs).collect::<Vec<_>>());
}

fn settings(writer: &mut ScenarioWriter) {
    let limits = [
        ("invDistPerCycle", 0.001, 1.0, 80),
        ("CommutationOffset", 0.1, 2000.0, 40),
        ("StepperAmplitude", 1.0, 255.0, 50),
        ("Lead", 0.01, 200.0, 40),
        ("P", 0.01, 50.0, 60),
        ("MaxOutput", 5.0, 2000.0, 50),
        ("OutputGain", 0.1, 3.0, 25),
        ("OutputOffset", 0.1, 100.0, 25),
        ("DestOffset", 0.1, 20.0, 25),
    ];
    for (field, low, high, percent) in limits {
        if writer.draw.chance(percent) {
            let is_signed = writer.draw.chance(25) && !matches!(field, "MaxOutput" | "StepperAmplitude");
            let value = writer.draw.magnitude(low, high);
            writer.start(format!("ch0->{field}={:?};", if is_signed { -value } else { value }));
        }
    }
    if writer.draw.chance(20) {
        let (amount, rate) = (writer.draw.magnitude(0.1, 30.0), writer.draw.magnitude(10.0, 5000.0));
        writer.start(format!(
            "ch0->BacklashMode=1; ch0->BacklashAmount={amount:?}; ch0->BacklashRate={rate:?};"
        ));
    }
}

fn statement(writer: &mut ScenarioWriter, channel: u32) -> String {
    let draw = &mut writer.draw;
    let place = draw.signed(0.01, 60.0);
    let other = draw.below(16);
    match draw.below(18) {
        0 | 1 => format!("Move(0,{place:?});"),
        2 => format!("Jog(0,{:?});", draw.signed(1.0, 5000.0)),
        3 => format!("ch0->Dest={place:?};"),
        4 => format!("MoveExp(0,{place:?},{:?});", draw.magnitude(0.0005, 0.02)),
        5 => "Zero(0);".to_owned(),
        6 => "DisableAxis(0);".to_owned(),
        7 => format!("EnableAxisDest(0,{place:?});"),
        8 => {
            format!("DisableAxis(0); Write3PH(ch0,{:?},{:?});", draw.signed(1.0, 300.0), draw.real(-2.0, 2.0))
        }
        9 => {
            format!("DisableAxis(0); Write4PH(ch0,{:?},{:?});", draw.signed(1.0, 300.0), draw.real(-2.0, 2.0))
        }
        10 => format!("WritePWM({},{});", draw.pick(&[channel, other]), draw.integer(-300, 300)),
        11 => format!("WritePWMR({},{});", draw.pick(&[channel, other]), draw.integer(-600, 600)),
        12 => format!("WritePWMC({},{});", draw.pick(&[channel, other]), draw.integer(-1100, 1100)),
        13 => format!("DAC({},{});", draw.below(8), draw.integer(-2100, 2100)),
        14 => format!("SetBit({});", draw.integer(48, 63)),
        15 => format!("SetStateBit({},{});", draw.integer(40, 63), draw.below(2)),
        16 => format!("ch0->OutputMode={};", draw.below(9)),
        _ => format!(
            "persist.UserData[{}]=ReadBit({})+10*GetBitDirection({other});",
            20 + draw.below(40),
            draw.integer(0, 63)
        ),
    }
}
