//! A servo with a motor simulated by a call-back: gains, filters, feed forward, limits.

use super::ScenarioWriter;
use crate::cli::commands::compare::random::scenario::PartKind;

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    let output = writer.draw.pick(&["NO_OUTPUT_MODE", "DC_SERVO_MODE", "DAC_SERVO_MODE", "DAC_SERVO_MODE"]);
    let channel = writer.draw.below(8);
    writer.head("double pl_v;");
    writer.start(format!(
        "ch0->InputMode=USER_INPUT_MODE; ch0->OutputMode={output}; ch0->OutputChan0={channel}; ch0->MaxFollowingError=1e30;"
    ));
    gains(writer);
    if writer.draw.chance(60) {
        for filter in 0..1 + writer.draw.below(3) {
            set_filter(writer, filter);
        }
    }
    if writer.draw.chance(20) {
        let (amount, rate) = (writer.draw.magnitude(0.1, 20.0), writer.draw.magnitude(10.0, 5000.0));
        writer.start(format!(
            "ch0->BacklashMode=1; ch0->BacklashAmount={amount:?}; ch0->BacklashRate={rate:?};"
        ));
    }
    let place = writer.draw.signed(0.01, 50.0);
    writer.start(format!("pl_v=0; ch0->Position={place:?};"));
    let place = writer.draw.signed(0.01, 50.0);
    let enables = if writer.draw.chance(70) {
        format!("EnableAxisDest(0,{place:?});")
    } else {
        "EnableAxis(0);".to_owned()
    };
    writer.start(enables);
    let (gain, friction) = (writer.draw.magnitude(1e-6, 0.05), writer.draw.real(0.0, 0.999));
    if writer.draw.chance(80) {
        let text = format!("pl_v=pl_v*{friction:?}+ch0->Output*{gain:?}; ch0->Position=ch0->Position+pl_v;");
        writer.part(PartKind::Tick, text);
    }
    for _ in 0..writer.draw.below(5) {
        let text = statement(writer);
        writer.add_later(4, 40, text);
    }
    let more = 8 + writer.draw.below(40);
    let columns =
        ["ch0->Output", "ch0->Dest", "ch0->Position", "ch0->integrator", "ch0->Backlash", "ch0->last_vel"];
    let outputs = [format!("LastPWM[{channel}]"), format!("DAC_Buffer[{channel}]")];
    writer.observe_ticks(more, columns.map(str::to_owned).into_iter().chain(outputs).collect::<Vec<_>>());
}

/// Sets the gains, some of them in single precision, as programs do.
fn gains(writer: &mut ScenarioWriter) {
    let limits = [
        ("P", 0.01, 100.0, 80),
        ("I", 1e-4, 1.0, 50),
        ("D", 0.1, 1000.0, 50),
        ("FFVel", 1e-5, 0.1, 30),
        ("FFAccel", 1e-6, 0.01, 30),
        ("MaxI", 0.1, 500.0, 30),
        ("MaxErr", 0.1, 500.0, 30),
        ("MaxOutput", 1.0, 3000.0, 50),
        ("DeadBandRange", 0.01, 10.0, 25),
        ("DeadBandGain", 0.01, 2.0, 25),
    ];
    for (field, low, high, percent) in limits {
        if writer.draw.chance(percent) {
            let value = writer.draw.magnitude(low, high);
            writer.start(format!("ch0->{field}={value:?};"));
        }
    }
    if writer.draw.chance(25) {
        let (gain, offset) = (writer.draw.signed(0.1, 3.0), writer.draw.signed(0.1, 50.0));
        writer.start(format!("ch0->OutputGain={gain:?}; ch0->OutputOffset={offset:?};"));
    }
}

/// Sets a stable filter.
fn set_filter(writer: &mut ScenarioWriter, filter: u32) {
    let draw = &mut writer.draw;
    let a2 = draw.real(-0.9, 0.9);
    let a1 = (1.0 - a2) * draw.real(-0.95, 0.95);
    let [b0, b1, b2] = [(); 3].map(|()| draw.real(-2.0, 2.0));
    writer.start(format!(
        "ch0->iir[{filter}].A1={a1:.5}; ch0->iir[{filter}].A2={a2:.5}; ch0->iir[{filter}].B0={b0:?}; ch0->iir[{filter}].B1={b1:?}; ch0->iir[{filter}].B2={b2:?};"
    ));
}

fn statement(writer: &mut ScenarioWriter) -> String {
    let draw = &mut writer.draw;
    let place = draw.signed(0.01, 60.0);
    match draw.below(12) {
        0 | 1 => format!("Move(0,{place:?});"),
        2 => format!("MoveRel(0,{place:?});"),
        3 => format!("Jog(0,{:?});", draw.signed(1.0, 5000.0)),
        4 => format!("MoveExp(0,{place:?},{:?});", draw.magnitude(0.0005, 0.02)),
        5 | 6 => format!("ch0->Dest={place:?};"),
        7 => "Zero(0);".to_owned(),
        8 => format!("DisableAxis(0); EnableAxisDest(0,{place:?});"),
        9 => format!("ch0->P={:?};", draw.magnitude(0.01, 100.0)),
        10 => format!("ch0->DestOffset={place:?};"),
        _ => "ResetFilters(0);".to_owned(),
    }
}
