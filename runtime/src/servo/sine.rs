//! The board's sine: 120 line segments per turn, each with its slope and its value at angle 0, in single precision.
//!
//! The lines go through sines that the firmware computes when it starts. Its single-precision sines are not always the
//! nearest value, so the values here were measured in the memory of the booted firmware. 240 values of `Sine3PH` agree
//! bit by bit, both phases.

use std::sync::LazyLock;

/// The number of lines per turn, and per third and quarter of a turn.
const TURN: usize = 120;
pub(crate) const THIRD: usize = TURN / 3;
pub(crate) const QUARTER: usize = TURN / 4;
/// The number of lines in the table, which extends beyond a turn for phases that lead.
const LINES: usize = TURN + THIRD + 1;

/// The sines between the lines, as bits of singles.
const SINES: [u32; LINES + 1] = [
    0x0000_0000,
    0x3D56_5E3B,
    0x3DD6_1305,
    0x3E20_305C,
    0x3E54_E6CE,
    0x3E84_83EE,
    0x3E9E_377A,
    0x3EB7_7C01,
    0x3ED0_3FCA,
    0x3EE8_7171,
    0x3F00_0000,
    0x3F0B_6D76,
    0x3F16_7918,
    0x3F21_1B25,
    0x3F2B_4C25,
    0x3F35_04F3,
    0x3F3E_3EBE,
    0x3F46_F30A,
    0x3F4F_1BBC,
    0x3F56_B31E,
    0x3F5D_B3D8,
    0x3F64_1901,
    0x3F69_DE1D,
    0x3F6E_FF20,
    0x3F73_7870,
    0x3F77_46EA,
    0x3F7A_67E2,
    0x3F7C_D925,
    0x3F7E_98FE,
    0x3F7F_A62F,
    0x3F80_0000,
    0x3F7F_A630,
    0x3F7E_98FD,
    0x3F7C_D925,
    0x3F7A_67E2,
    0x3F77_46EA,
    0x3F73_7870,
    0x3F6E_FF22,
    0x3F69_DE1D,
    0x3F64_1900,
    0x3F5D_B3D7,
    0x3F56_B31E,
    0x3F4F_1BBE,
    0x3F46_F30B,
    0x3F3E_3EC0,
    0x3F35_04F4,
    0x3F2B_4C26,
    0x3F21_1B26,
    0x3F16_7918,
    0x3F0B_6D77,
    0x3F00_0001,
    0x3EE8_7175,
    0x3ED0_3FC7,
    0x3EB7_7C00,
    0x3E9E_377B,
    0x3E84_83F1,
    0x3E54_E6C8,
    0x3E20_305A,
    0x3DD6_1309,
    0x3D56_5E14,
    0x3425_5551,
    0xBD56_5E82,
    0xBDD6_1321,
    0xBE20_3065,
    0xBE54_E6D4,
    0xBE84_83EF,
    0xBE9E_3779,
    0xBEB7_7BFF,
    0xBED0_3FCC,
    0xBEE8_7173,
    0xBEFF_FFFF,
    0xBF0B_6D75,
    0xBF16_7916,
    0xBF21_1B21,
    0xBF2B_4C21,
    0xBF35_04F5,
    0xBF3E_3EBE,
    0xBF46_F30A,
    0xBF4F_1BBF,
    0xBF56_B31C,
    0xBF5D_B3D8,
    0xBF64_1900,
    0xBF69_DE1E,
    0xBF6E_FF22,
    0xBF73_7870,
    0xBF77_46EB,
    0xBF7A_67E1,
    0xBF7C_D925,
    0xBF7E_98FC,
    0xBF7F_A630,
    0xBF80_0000,
    0xBF7F_A630,
    0xBF7E_98FE,
    0xBF7C_D925,
    0xBF7A_67E3,
    0xBF77_46EB,
    0xBF73_7870,
    0xBF6E_FF1F,
    0xBF69_DE1E,
    0xBF64_1900,
    0xBF5D_B3D8,
    0xBF56_B31C,
    0xBF4F_1BBF,
    0xBF46_F30A,
    0xBF3E_3EBC,
    0xBF35_04EF,
    0xBF2B_4C24,
    0xBF21_1B21,
    0xBF16_7919,
    0xBF0B_6D75,
    0xBF00_0003,
    0xBEE8_7172,
    0xBED0_3FC4,
    0xBEB7_7C05,
    0xBE9E_3778,
    0xBE84_83F6,
    0xBE54_E6D2,
    0xBE20_3073,
    0xBDD6_12DE,
    0xBD56_5E3C,
    0xB4A2_AAA7,
    0x3D56_5E9A,
    0x3DD6_134C,
    0x3E20_306B,
    0x3E54_E6E9,
    0x3E84_83F2,
    0x3E9E_3784,
    0x3EB7_7C01,
    0x3ED0_3FCF,
    0x3EE8_716E,
    0x3F00_0001,
    0x3F0B_6D74,
    0x3F16_7918,
    0x3F21_1B20,
    0x3F2B_4C23,
    0x3F35_04EE,
    0x3F3E_3EC0,
    0x3F46_F30E,
    0x3F4F_1BBE,
    0x3F56_B320,
    0x3F5D_B3D7,
    0x3F64_1902,
    0x3F69_DE1C,
    0x3F6E_FF20,
    0x3F73_786F,
    0x3F77_46EA,
    0x3F7A_67E0,
    0x3F7C_D924,
    0x3F7E_98FC,
    0x3F7F_A62F,
    0x3F80_0000,
    0x3F7F_A62F,
    0x3F7E_98FD,
    0x3F7C_D924,
    0x3F7A_67E2,
    0x3F77_46EB,
    0x3F73_786E,
    0x3F6E_FF20,
    0x3F69_DE1F,
    0x3F64_1904,
    0x3F5D_B3D6,
    0x3F56_B31E,
];

/// A line between two sines: its slope per turn, and its value at 0.
#[derive(Clone, Copy, Debug, Default)]
struct Secant {
    slope: f32,
    origin: f32,
}

static TABLE: LazyLock<[Secant; LINES]> = LazyLock::new(|| {
    std::array::from_fn(|index| {
        let [begin, end] = [index, index + 1].map(|index| f32::from_bits(SINES[index]));
        let slope = (end - begin) * TURN as f32;
        Secant { slope, origin: begin - slope * table_angle(index) }
    })
});

/// The angle of a number of table entries, in turns.
fn table_angle(lines: usize) -> f32 {
    const LINE: f32 = 1.0 / TURN as f32;
    lines as f32 * LINE
}

/// The sine of an angle in cycles, and the sine a number of lines ahead.
pub(crate) fn sine(cycles: f64, ahead: usize) -> f32 {
    let fraction = (cycles - libm::trunc(cycles)) as f32;
    value(if fraction < 0.0 { fraction + 1.0 } else { fraction }, ahead)
}

/// The value a number of lines after an angle.
fn value(angle: f32, ahead: usize) -> f32 {
    let index = (angle * TURN as f32) as i64 + ahead as i64;
    let line =
        usize::try_from(index).map_or_else(|_| secant_below_zero(index), |index| TABLE.get(index).copied());
    let line = line.unwrap_or_default();
    line.slope * (angle + table_angle(ahead)) + line.origin
}

/// Pointers in the list that precedes the table in memory, at the positions where lines have their slopes: those of the
/// SnapAmps' bits and of their slow measurements.
const POINTERS: [u32; 8] =
    [0x1001_A904, 0x1001_A908, 0x1001_9058, 0x1001_905C, 0x1001_A90C, 0x1001_A910, 0x1001_9078, 0x1001_907C];
/// The line of the first pointer.
const FIRST_POINTER: i64 = -27;

/// The line that the board uses for an angle below 0: it reads before its table. The numbers between the pointers are
/// too small for singles; the rest is 0.
fn secant_below_zero(index: i64) -> Option<Secant> {
    let pointer = usize::try_from(index - FIRST_POINTER).ok().and_then(|at| POINTERS.get(at))?;
    Some(Secant { slope: f32::from_bits(*pointer), origin: 0.0 })
}

/// Two phases a third of a turn apart, for an angle from 0 to 1.
pub(crate) fn two_phases(cycles: f32) -> [f32; 2] {
    [0, THIRD].map(|ahead| value(cycles, ahead))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn the_lines_end_at_sines() {
        for (index, bits) in SINES.into_iter().enumerate() {
            let sine = libm::sin(TAU * index as f64 / TURN as f64);
            assert!((f64::from(f32::from_bits(bits)) - sine).abs() < 1e-6, "{index}");
        }
        // Halfway between two values: the sine times cos(1.5°).
        let between = f64::from(sine(1.5 / 360.0, QUARTER));
        assert!((between - f64::midpoint(1.0, libm::cos(TAU / 120.0))).abs() < 1e-6, "{between}");
    }

    #[test]
    fn phases_match_the_measurement() {
        let measured: [[u32; 3]; 4] = [
            [0x3E09_96C8, 0x3F3F_5267, 0x3E4E_6170],
            [0x3F58_F16B, 0xBF51_7238, 0x3F68_173C],
            [0x3F43_86BC, 0xBF7E_F66A, 0x3F12_A3C0],
            [0x3DBB_BBBC, 0x3F0B_6D76, 0x3EE8_7178],
        ];
        for [angle, first, second] in measured {
            let found = two_phases(f32::from_bits(angle)).map(f32::to_bits);
            assert_eq!(found, [first, second], "{angle:08X}");
        }
    }

    #[test]
    fn an_angle_below_0_finds_pointers_before_the_table() {
        // `fidelity-2.jsonl`, "Sine3PH".
        let [first, second] = two_phases(-3.0 / 13.0);
        assert!((first + 5.900_993e-30).abs() < 1e-36, "{first}");
        assert!((second - 0.601_759_6).abs() < 1e-6, "{second}");
        assert_eq!(two_phases(-2.0 / 13.0)[0], 0.0);
    }

    #[test]
    fn phases_match_the_recording() {
        // `checks.jsonl`, "fractionf and Sine3PH".
        for (angle, expect) in [
            (0.1, [0.587_785_2, 0.406_736_9]),
            (0.25, [1.0, -0.5]),
            (-0.1, [0.0, 0.994_522]),
            (1.6, [0.0; 2]),
        ] {
            let found = two_phases(angle);
            assert!(
                found.iter().zip(expect).all(|(one, two)| (one - two).abs() < 1e-6),
                "{angle}: {found:?}"
            );
        }
    }
}
