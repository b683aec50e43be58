//! Integers of 64 bits, and conversions between integers and floating point.

use super::Writer;

/// Writes arithmetic of 64 bits.
pub(super) fn write_wide(writer: &mut Writer) {
    writer.open("    long long a = z, b = z * x + y;\n    unsigned long long u = z ^ y, v = (unsigned long long)y << 29;\n");
    for _ in 0..8 + writer.below(10) {
        let (place, value) = (writer.pick(&["a", "b", "u", "v"]), wide(writer, 2));
        match writer.below(6) {
            0 => {
                let (operator, right) = (writer.pick(&["+", "-", "*", "&", "|", "^"]), wide(writer, 1));
                writer.line(&format!("{place} {operator}= {right};"));
            }
            1 => {
                let (operator, right) = (writer.pick(&["<<", ">>"]), wide(writer, 0));
                writer.line(&format!("{place} {operator}= {right} & 63;"));
            }
            2 => {
                let operator = writer.pick(&["<", ">=", "==", "!="]);
                writer.line(&format!("i += {value} {operator} {place};"));
            }
            3 => {
                let step = writer.pick(&["++", "--"]);
                writer.line(&format!("{place}{step};"));
            }
            _ => writer.line(&format!("{place} = {value};")),
        }
    }
    writer.line("sum = @wide(@wide(@wide(@wide(sum, a), b), u), v);");
    writer.close();
}

/// An expression of 64 bits.
fn wide(writer: &mut Writer, depth: usize) -> String {
    if depth == 0 {
        return match writer.below(7) {
            0 => format!("{}LL", writer.below(1 << 31) * 4099),
            1 => writer.constant(),
            2 => "0x8000000000000000ULL".to_owned(),
            _ => writer.pick(&["a", "b", "u", "v", "x", "y"]).to_owned(),
        };
    }
    let (left, right) = (wide(writer, depth - 1), wide(writer, depth - 1));
    match writer.below(10) {
        0..=2 => format!("({left} {} {right})", writer.pick(&["+", "-", "*", "&", "|", "^"])),
        3 => format!("((long long)({left}) {} ({right} & 63))", writer.pick(&["<<", ">>"])),
        4 => format!("((unsigned long long)({left}) >> ({right} & 63))"),
        5 => format!("((long long)({left}) {} (({right} & 1023) + 2))", writer.pick(&["/", "%"])),
        6 => format!("((unsigned long long)({left}) {} (({right}) | 5ULL))", writer.pick(&["/", "%"])),
        7 => format!("({})({left})", writer.pick(&["int", "unsigned", "short", "signed char", "long long"])),
        8 => format!("({} ({left}))", writer.pick(&["-", "~"])),
        _ => format!("({left} < {right} ? {left} : {right})"),
    }
}

/// Types of integers, each with the range of `double` values that fit.
const RANGES: &[(&str, &str, &str)] = &[
    ("int", "-2e9", "2e9"),
    ("unsigned", "0", "4.2e9"),
    ("short", "-32768", "32767"),
    ("unsigned char", "0", "255"),
    ("long long", "-9.2e18", "9.2e18"),
    ("unsigned long long", "0", "1.8e19"),
];

/// Writes floating-point arithmetic, and conversions to and from integers.
pub(super) fn write_conversions(writer: &mut Writer) {
    writer.open(
        "    float f = w, g = x;\n    double d = y, e = w * 3;\n    long long l = z;\n    unsigned long long u = z;\n    short s = x;\n    \
         unsigned char c = y;\n",
    );
    for _ in 0..8 + writer.below(8) {
        let value = real(writer, 2);
        match writer.below(8) {
            0 => {
                let (operator, place) = (writer.pick(&["+", "-", "*"]), writer.pick(&["f", "g", "d", "e"]));
                writer.line(&format!("{place} {operator}= {value};"));
            }
            1 => {
                let (ty, least, most) = RANGES[writer.below(RANGES.len())];
                writer.line(&format!(
                    "e = {value};\n    sum = @wide(sum, e > {least} && e < {most} ? ({ty})e : 7);"
                ));
            }
            2 => {
                let (ty, least, most) = RANGES[writer.below(RANGES.len())];
                writer.line(&format!(
                    "f = {value};\n    sum = @wide(sum, f > {least} && f < {most} ? ({ty})f : 9);"
                ));
            }
            3 => writer.line("e = f;\n    if (e > -30000 && e < 30000)\n        s = f;"),
            4 => {
                let other = writer.below(1000);
                writer.line(&format!("l = d > -1e9 && d < 1e9 ? l + (long long)d : {other};"));
            }
            5 => {
                let operator = writer.pick(&["<", ">=", "==", "!="]);
                writer.line(&format!("i += {value} {operator} f;"));
            }
            _ => {
                let place = writer.pick(&["f", "g", "d", "e"]);
                writer.line(&format!("{place} = {value};"));
            }
        }
        // Values stay in a range without infinities and denormals.
        writer.line("sum = @real(@real(@real(@real(sum, f), g), d), e);");
        for (place, most, value) in
            [("d", "1e12", "x"), ("f", "1e9f", "0.5f"), ("e", "1e12", "y"), ("g", "1e9f", "x")]
        {
            let is_moderate =
                format!("{place} > -{most} && {place} < {most} && !({place} > -1e-4 && {place} < 1e-4)");
            writer.line(&format!("if (!({is_moderate}))\n        {place} = {value};"));
        }
    }
    writer.line("sum = @wide(@wide(sum, l), s + c);");
    writer.close();
}

/// An expression of floating point.
fn real(writer: &mut Writer, depth: usize) -> String {
    if depth == 0 {
        return match writer.below(6) {
            0 => writer.fraction(),
            1 => format!("{}f", writer.fraction()),
            2 => writer
                .pick(&[
                    "(float)x",
                    "(double)y",
                    "(float)l",
                    "(double)l",
                    "(double)u",
                    "(float)u",
                    "(float)y",
                ])
                .to_owned(),
            3 => writer.pick(&["(double)s", "(float)c", "(double)x"]).to_owned(),
            _ => writer.pick(&["f", "g", "d", "e", "w"]).to_owned(),
        };
    }
    let (left, right) = (real(writer, depth - 1), real(writer, depth - 1));
    match writer.below(8) {
        0..=3 => format!("({left} {} {right})", writer.pick(&["+", "-", "*"])),
        4 => format!("({left} / {})", writer.pick(&["3.0", "7.0f", "(x | 1)", "(c + 2)"])),
        5 => format!("(float)({left})"),
        6 => format!("(-{left})"),
        _ => format!("({left} < {right} ? {left} : {right})"),
    }
}
