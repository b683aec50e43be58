//! Switches of every form, and jumps into and out of loops.

use super::Writer;

/// Writes a loop around switches.
pub(super) fn write_switches(writer: &mut Writer) {
    writer.open("    int n = 0, k;\n");
    writer.names.push("n".to_owned());
    writer.line("for (k = 0; k < 24; k++) {");
    for _ in 0..2 + writer.below(2) {
        switch(writer, 2);
    }
    writer.line("}");
    let offset = writer.below(5);
    writer.line(&duff(offset));
    writer.add("n");
    writer.close();
}

/// A loop that is entered in its middle.
fn duff(offset: usize) -> String {
    format!(
        "k = (x & 7) + {};\n    switch (k % 4) {{\n        do {{\n            case 0: n += 3; case 3: n ^= 5; case 2: n += k; case 1: n *= 3;\n        \
         }} while ((k -= 4) > 0);\n    }}",
        offset + 1
    )
}

fn switch(writer: &mut Writer, depth: usize) {
    let value = match writer.below(6) {
        0 => "z >> (k & 31)".to_owned(),
        1 => "(char)(n * 7 + k)".to_owned(),
        2 => "(unsigned char)(y + k)".to_owned(),
        3 => "(long long)k * 1000000007LL".to_owned(),
        4 => format!("(int)({}) % 12", writer.integer(1)),
        _ => format!("k * {} - {}", 1 + writer.below(3), writer.below(12)),
    };
    writer.line(&format!("switch ({value}) {{"));
    let mut next = writer.below(12) as i64 - 8;
    let default_at = writer.below(12);
    for number in 0..3 + writer.below(9) {
        if number == default_at {
            writer.line("default: n -= 3;");
        }
        next = case(writer, next, depth);
    }
    writer.line("}");
}

/// Writes a case with its statements; returns the next free value.
fn case(writer: &mut Writer, value: i64, depth: usize) -> i64 {
    let next = match writer.below(8) {
        // A gap, small or large, or a range.
        0 => {
            writer.line(&format!("case {value} ... {}:", value + 3));
            value + 4
        }
        1 => {
            writer.line(&format!("case {}:", value + 70_000));
            value + 70_001
        }
        2 => {
            writer.line(&format!("case {value}: case {}:", value + 2));
            value + 3
        }
        _ => {
            writer.line(&format!("case {value}:"));
            value + 1
        }
    };
    let change = writer.integer(1);
    writer.line(&format!("    n = n * 3 + ({change});"));
    if depth > 0 && writer.below(6) == 0 {
        switch(writer, depth - 1);
    }
    let end = writer.pick(&["break;", "break;", "continue;", ""]);
    writer.line(&format!("    {end}"));
    next
}

/// Writes loops with labels inside, and jumps to any of them.
pub(super) fn write_jumps(writer: &mut Writer) {
    let labels = 3 + writer.below(5);
    writer.open("    int n = x & 63, k = 0, steps = 0;\n");
    writer.names.extend(["n", "k"].map(str::to_owned));
    jump(writer, labels);
    for label in 0..labels {
        repetition(writer, label, labels);
    }
    writer.line("goto end;\n  out:\n    sum = @mix(sum, 77);\n  end:");
    writer.add("n + k * 31");
    writer.close();
}

/// Writes a jump that is taken only a limited number of times.
fn jump(writer: &mut Writer, labels: usize) {
    let (condition, label) = (writer.integer(1), writer.below(labels));
    writer.line(&format!(
        "if (++steps > 300)\n        goto out;\n    if (({condition}) & 3)\n        goto l{label};"
    ));
}

/// A loop that can be entered at its label; each pass counts a step.
fn repetition(writer: &mut Writer, label: usize, labels: usize) {
    let (most, skipped, change) = (1 + writer.below(9), writer.below(100), writer.integer(1));
    match writer.below(3) {
        0 => writer.line(&format!("for (k = 0; k < {most}; k++) {{")),
        1 => writer.line(&format!("while (k++ < {most}) {{")),
        _ => writer.line("do {"),
    }
    let is_do = writer.text.ends_with("do {\n");
    writer.line(&format!("if (k & 1)\n        n += {skipped};\n  l{label}:"));
    writer.line(&format!("n = n * 5 + ({change});"));
    jump(writer, labels);
    if writer.below(3) == 0 {
        let word = writer.pick(&["break;", "continue;"]);
        writer.line(&format!("if (n & 4)\n        {word}"));
        writer.line("n ^= k;");
    }
    writer.line(&if is_do { format!("}} while (++k < {most} && ++steps < 300);") } else { "}".to_owned() });
}
