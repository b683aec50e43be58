//! Programs of any length.

use std::fmt::Write;

/// About `lines` lines of the code that machine builders write: loops, conditions, bits, moves.
pub(super) fn sequence(lines: usize) -> String {
    let mut text = String::from("#include \"KMotionDef.h\"\ndouble table[1024];\nint state;\n");
    let steps = lines / STEP.lines().count();
    for step in 0..steps {
        text += &STEP
            .replace("$step", &step.to_string())
            .replace("$axis", &(step % 8).to_string())
            .replace("$bit", &(step % 64).to_string());
    }
    text += "main()\n{\n";
    for step in 0..steps {
        let _ = writeln!(text, "    step_{step}(1, 2.0);");
    }
    text + "}\n"
}

const STEP: &str = r#"
// Step $step of the sequence.
int step_$step(int a, double speed)
{
    int i;
    double sum = 0.0;

    for (i = 0; i < 10; i++)
    {
        sum += table[i + $step % 1000] * speed;
        if (sum > 1000.0 && a != 3)
        {
            sum = 0.5 * sum;
            state = i;
        }
    }
    persist.UserData[$bit] = a + $step;
    ch$axis->Vel = 25.0 * speed;
    if (ReadBit($bit))
        SetBit(46);
    else
        ClearBit(46);

    while (!CheckDone($axis))
        WaitNextTimeSlice();
    switch (a)
    {
    case 0:
        state = 1;
        break;
    case 1:
        state = (int)(sum * 4.0) & 0xff;
        break;
    default:
        printf("step %d sum %f\n", a, sum);
    }
    return (int)sum + i;
}
"#;

/// A table of `lines` lines of numbers, as tools write them for cams and screw corrections.
pub(super) fn table(lines: usize) -> String {
    let mut text = String::from("double correction[] = {\n");
    for line in 0..lines {
        let _ = writeln!(text, "    {:.3}, {line},", line as f64 * 0.125);
    }
    text + "};\nmain() { correction[0] = 1; }\n"
}

/// One function of `lines` assignments.
pub(super) fn statements(lines: usize) -> String {
    let mut text = String::from("double at[8];\nmain()\n{\n");
    for line in 0..lines {
        let _ = writeln!(text, "    at[{}] = {line}.5 + at[{}];", line % 8, (line + 3) % 8);
    }
    text + "}\n"
}
