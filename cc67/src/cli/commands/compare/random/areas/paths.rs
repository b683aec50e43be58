//! Paths that a program builds in the segment buffer, with overrides, feedhold and moves of their axes.

use super::ScenarioWriter;

/// Functions that add a line, an arc, and a command to the buffer.
const SEGMENTS: &str = "\
PARAMETRIC_COEFF *P;
void letters(void){ P=&ParametricCoeffs[ParametricIndex]; P->special_param=0; P->x_axis=0; P->y_axis=1; P->z_axis=2; P->a_axis=255; P->b_axis=255; P->c_axis=255; P->u_axis=255; P->v_axis=255; }
void rate(double t,double a,double b,double c,double d){ P->t=t; P->a=a; P->b=b; P->c=c; P->d=d; }
void line(double t,double x0,double x1,double y0,double y1,double z0,double z1){ letters(); P->trajectory_mode=TRAJECTORY_LINEAR; rate(t,0,0,1/t,0); P->X.a=0; P->X.b=0; P->X.c=x1-x0; P->X.d=x0; P->Y.a=0; P->Y.b=0; P->Y.c=y1-y0; P->Y.d=y0; P->Z.c=z1-z0; P->Z.d=z0; IncParametricIndex(); }
void arc(double t,double cx,double cy,double rad,double a0,double a1){ letters(); P->trajectory_mode=TRAJECTORY_CIRCULAR; rate(t,0,0,1/t,0); P->X.a=a1-a0; P->X.b=a0; P->X.c=rad; P->X.d=cx; P->Y.a=a1-a0; P->Y.b=a0+1.5707963267948966; P->Y.c=rad; P->Y.d=cy; P->Z.c=0; P->Z.d=0; IncParametricIndex(); }
void special(int cmd,int bit){ letters(); P->trajectory_mode=TRAJECTORY_SPECIAL; P->x_axis=cmd; P->special_param=bit; P->t=0; IncParametricIndex(); }
void begin(void){ CoordSystem0=0; ParametricIndex=0; ParametricIndexWrapped=0; CS0_t=0; CS0_TimeExecuted=0; CS0_TimeDownloaded=0; CS0_TimeLost=0; CS0_DoingRapid=0; CS0_TimeBase=TIMEBASE; CS0_TimeBaseDesired=TIMEBASE; CS0_Flushed=0; LastCoordSystem0=&ParametricCoeffs[0]; }
void iOpenBuf(void); void iExecBuf(void);";

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    writer.head(SEGMENTS);
    let count = 1 + writer.draw.below(3);
    for axis in 0..count {
        let speed = writer.draw.magnitude(10.0, 1000.0);
        let acceleration = speed * writer.draw.magnitude(8.0, 200.0);
        let jerk = acceleration * writer.draw.magnitude(10.0, 1000.0);
        writer.start(format!(
            "chan[{axis}].InputMode=NO_INPUT_MODE; chan[{axis}].OutputMode=NO_OUTPUT_MODE; chan[{axis}].MaxFollowingError=1e30; chan[{axis}].Vel={speed:.3}; chan[{axis}].Accel={acceleration:.2}; chan[{axis}].Jerk={jerk:.1}; EnableAxisDest({axis},0);"
        ));
    }
    let letters: Vec<String> =
        (0..4).map(|letter| if letter < count { letter.to_string() } else { "-1".to_owned() }).collect();
    writer.start(format!("DefineCoordSystem({});", letters.join(",")));
    if writer.draw.chance(25) {
        let tau = writer.draw.magnitude(0.0003, 0.005);
        writer.start(format!("KLP=exp(-TIMEBASE/{tau:?}); TauKLP={tau:?};"));
    }
    let opens = writer.draw.pick(&["begin();", "begin();", "iOpenBuf();"]);
    writer.start(opens);
    let duration = segments(writer);
    let executes = writer.draw.pick(&[
        "iExecBuf(); CS0_Flushed=1;",
        "iExecBuf(); CS0_Flushed=1;",
        "iExecBuf();",
        "CS0_Flushed=1; CoordSystem0=LastCoordSystem0;",
        "CoordSystem0=LastCoordSystem0;",
    ]);
    writer.add_later(2, 9, executes);
    let slices = (duration / 180e-6) as u32;
    for _ in 0..writer.draw.below(5) {
        let text = statement(writer, count);
        writer.add_later(2, 10 + slices / 3, text);
    }
    let more = 5 + writer.draw.below(slices + 20).min(200);
    let destinations = (0..3).map(|axis| format!("chan[{axis}].Dest"));
    let others = ["CS0_t", "CS0_TimeExecuted", "CS0_TimeBase", "CS0_StoppingState"].map(str::to_owned);
    let columns = ["ServoTick-T0_".to_owned()].into_iter().chain(destinations).chain(others);
    writer.observe_slices(more, columns.collect::<Vec<_>>());
}

/// Adds segments, each beginning at the end of the previous one; returns their duration in seconds.
fn segments(writer: &mut ScenarioWriter) -> f64 {
    let mut duration = 0.0;
    let mut place = [0.0; 3];
    for _ in 0..1 + writer.draw.below(7) {
        let time = writer.draw.magnitude(0.0004, 0.015);
        match writer.draw.below(10) {
            0..=6 => {
                let to = place.map(|_| writer.draw.real(-2.0, 2.0));
                let pairs: Vec<String> =
                    place.iter().zip(&to).map(|(from, to)| format!("{from:?},{to:?}")).collect();
                writer.start(format!("line({time:?},{});", pairs.join(",")));
                place = to;
                duration += time;
            }
            7 | 8 => {
                let [x, y, radius, from, to] = [(); 5].map(|()| writer.draw.real(-3.0, 3.0));
                writer.start(format!("arc({time:?},{x:?},{y:?},{radius:?},{from:?},{to:?});"));
                duration += time;
            }
            _ => {
                let bit = writer.draw.integer(48, 55);
                let command = writer.draw.pick(&["0", "1", "4", "5"]);
                writer.start(format!("special({command},{bit});"));
            }
        }
    }
    duration
}

fn statement(writer: &mut ScenarioWriter, count: u32) -> String {
    let draw = &mut writer.draw;
    let axis = draw.below(count);
    let factor = draw.pick(&[0.0, 0.1, 0.5, 0.73, 1.0, 1.4, 2.0, -0.5, -1.0]);
    let time = draw.magnitude(0.0005, 0.05);
    match draw.below(20) {
        0..=3 => "StopCoordinatedMotion();".to_owned(),
        4..=6 => "ResumeCoordinatedMotion();".to_owned(),
        7 => "ClearStopImmediately();".to_owned(),
        8 | 9 => format!("SetFRO({factor:?});"),
        10 => format!("SetFROTemp({factor:?});"),
        11 => format!("SetRapidFRO({factor:?});"),
        12 | 13 => format!("SetFROwRate({factor:?},{time:?});"),
        14 => format!("SetFROwRateTemp({factor:?},{time:?});"),
        15 => format!("Jog({axis},{:?});", draw.signed(0.1, 100.0)),
        16 => format!("MoveRel({axis},{:?});", draw.signed(0.01, 3.0)),
        17 => "CS0_Flushed=1;".to_owned(),
        18 => "if(!CoordSystem0 && LastCoordSystem0) iExecBuf();".to_owned(),
        _ => format!("MoveXYZABC({:?},{:?},0,0,0,0);", draw.signed(0.01, 3.0), draw.signed(0.01, 3.0)),
    }
}
