//! Random programs that wait by polling: loops of every form and condition, in several threads that wait for one
//! another, for motions, for inputs and for times.
//!
//! They need not end, and often wait for events that never occur: two ways of running them must give the same
//! observations.

use std::fmt::Write as _;

use crate::random::Random;

/// The machine and its surroundings for all programs: a switch that axis 0 closes, and inputs that change by
/// themselves.
pub const MACHINE: &str = "\
[[switch]]
bit = 28
axis = 0
when = \">= 300\"

[[switch]]
bit = 29
axis = 1
when = \"between 100 140\"

[[event]]
at = 0.013
set_bit = { 26 = 1 }

[[event]]
at = 0.0411
set_bit = { 26 = 0, 27 = 1 }

[[event]]
at = 0.09
adc = { 0 = 3000 }
";

/// The beginning of every program.
const HEAD: &str = "\
#include \"KMotionDef.h\"

volatile int flag;
int g, last;

int Helper(int bit)
{
    return ReadBit(bit) && CheckDone(0) == 1;
}

double Rest(int axis)
{
    return fast_fabs(chan[axis].Dest - 200.0);
}

main()
{
    int i, n = 0, x = 0;
    double t = Time_sec();

    ch0->InputMode = ch1->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = ch1->OutputMode = STEP_DIR_MODE;
    ch0->Vel = ch1->Vel = 10000; ch0->Accel = ch1->Accel = 400000; ch0->Jerk = ch1->Jerk = 4e6;
    DefineCoordSystem(0, 1, -1, -1);
";

/// The programs for a seed, for threads 1, 2 and so on.
#[must_use]
pub fn programs(seed: u64) -> Vec<String> {
    let mut writer = Writer { random: Random::of_seed(seed), text: String::new() };
    let threads = [1, 1, 1, 2, 2, 3, 4, 7][writer.below(8)];
    (0..threads).map(|_| writer.program()).collect()
}

struct Writer {
    random: Random,
    text: String,
}

impl Writer {
    fn below(&mut self, end: usize) -> usize {
        self.random.below(end)
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        self.random.pick(from)
    }

    fn program(&mut self) -> String {
        self.text = HEAD.to_owned();
        for axis in 0..2 {
            if self.below(3) != 0 {
                let _ = writeln!(self.text, "    EnableAxisDest({axis}, 0);");
            }
        }
        for _ in 0..2 + self.below(5) {
            self.action();
            let wait = self.wait();
            let _ = writeln!(self.text, "    t = Time_sec();\n    {wait}");
            if self.below(3) != 0 {
                self.text += "    printf(\"%d %d %d %.9f\\n\", n, x, last, Time_sec());\n";
            }
        }
        std::mem::take(&mut self.text) + "}\n"
    }

    /// An action for which other threads may wait.
    fn action(&mut self) {
        let (axis, bit, cell) = (self.below(2), self.bit(), self.below(4));
        let number = self.below(400);
        let action = match self.below(10) {
            0..=2 => format!("Move({axis}, {number});"),
            3 => format!("MoveXYZABC({number}, {cell}00, 0, 0, 0, 0);"),
            4 => format!("SetBit(10{cell}0);"),
            5 => format!("ClearBit(10{cell}0);"),
            6 => format!("persist.UserData[{cell}] = {};", number % 3),
            7 => format!("Delay_sec(0.000{number:03});"),
            8 => format!("SetStateBit({bit}, {});", number % 2),
            _ => "flag = 1; WaitNextTimeSlice();".to_owned(),
        };
        let _ = writeln!(self.text, "    {action}");
    }

    fn bit(&mut self) -> &'static str {
        self.pick(&["26", "27", "28", "29", "1000", "1010", "1020", "1030", "x", "46"])
    }

    /// A condition that may change at some time.
    fn condition(&mut self) -> String {
        let (axis, bit, cell) = (self.below(2), self.bit(), self.below(4));
        let number = self.below(400);
        let condition = match self.below(16) {
            0..=2 => format!("CheckDone({axis})"),
            3 => "CheckDoneXYZABC()".to_owned(),
            4 => "CheckDoneBuf()".to_owned(),
            5..=6 => format!("ReadBit({bit})"),
            7 => format!("chan[{axis}].Dest > {number}.0"),
            8 => format!("ch{axis}->Dest == {number}.0"),
            9 => format!("persist.UserData[{cell}] == {}", number % 3),
            10 => format!("Time_sec() < t + 0.0{number:03}"),
            11 => format!("Time_sec() - t > 0.0{number:03}"),
            12 => format!("Helper({bit})"),
            13 => format!("Rest({axis}) < {number}.0"),
            14 => format!("ReadBit({bit}) + ReadBit(26) + flag == {}", number % 3),
            _ => format!("ADC(0) > {number}0 || g"),
        };
        if self.below(2) == 0 { format!("({condition})") } else { format!("!({condition})") }
    }

    /// A condition that usually ends at some time.
    fn limited(&mut self) -> String {
        let condition = self.condition();
        match self.below(4) {
            0 => condition,
            1 => format!("{condition} && {}", self.condition()),
            2 => format!("({condition} || {}) && Time_sec() < t + 0.03", self.condition()),
            _ => format!("{condition} && Time_sec() < t + 0.0{:03}", 1 + self.below(300)),
        }
    }

    /// A loop that waits.
    fn wait(&mut self) -> String {
        let (limited, condition, other) = (self.limited(), self.condition(), self.condition());
        let bit = self.bit();
        match self.below(14) {
            0..=3 => format!("while ({limited}) ;"),
            4 => format!("do ; while ({limited});"),
            5 => format!("for (;;) {{ if (!({limited})) break; if ({condition}) {{ n++; break; }} }}"),
            6 => format!("while ({limited}) WaitNextTimeSlice();"),
            7 => {
                format!("while ({limited}) if ({condition}) break; else if ({other}) {{ x = 1000; break; }}")
            }
            8 => format!("while ({limited}) n++;"),
            9 => format!(
                "while ({limited}) {{ for (i = 0; i < 4; i++) if (ReadBit(1000 + 10 * i)) break; if (i == 3) break; }}"
            ),
            10 => format!(
                "for (i = 0; i < 3; i++) while ({limited}) {{ while ({condition} && Time_sec() < t + 0.002) ; if ({other}) break; }}"
            ),
            11 => format!("do {{ x = last; last = ReadBit({bit}); }} while (x == last && {limited});"),
            12 => format!("again: if ({limited}) goto again;")
                .replace("again", &format!("again{}", self.text.len())),
            _ => format!("while ({limited}) {{ x = ReadBit({bit}); if (x && {condition}) last++; }}"),
        }
    }
}
