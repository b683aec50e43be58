//! Bit-fields of all types and widths next to members: stores, read-modify-writes, values of assignments, layout.

use super::Writer;

/// Types with their widths in bits.
const TYPES: &[(&str, usize)] = &[
    ("int", 32),
    ("unsigned", 32),
    ("signed char", 8),
    ("unsigned char", 8),
    ("short", 16),
    ("unsigned short", 16),
    ("long long", 64),
    ("unsigned long long", 64),
];

/// Writes a structure and a function that uses it.
pub(super) fn write(writer: &mut Writer) {
    let fields = declare(writer);
    writer.open("    struct $s *p = &$v[x & 1], a;\n");
    // The padding of a local structure is unspecified, so only its fields are read.
    for field in &fields {
        let value = writer.integer(1);
        writer.line(&format!("a.{field} = {value};"));
    }
    for _ in 0..6 + writer.below(8) {
        statement(writer, &fields);
    }
    for field in &fields {
        writer.line(&format!(
            "sum = @wide(sum, (long long)p->{field}); sum = @wide(sum, (long long)a.{field});"
        ));
    }
    writer.line("for (i = 0; i < (int)sizeof $v; i++)\n        sum = @mix(sum, ((unsigned char *)$v)[i]);");
    writer.close();
}

/// Writes the structure; returns the names of its members.
fn declare(writer: &mut Writer) -> Vec<String> {
    let mut fields = Vec::new();
    let mut text = String::from("struct $s {");
    for number in 0..3 + writer.below(8) {
        let (ty, bits) = TYPES[writer.below(TYPES.len())];
        let width = 1 + writer.below(bits);
        match writer.below(8) {
            0 => text += &format!(" {ty} m{number};"),
            1 => text += &format!(" {ty} : 0; {ty} m{number} : {width};"),
            2 => text += &format!(" {ty} : {width}; {ty} m{number} : {width};"),
            _ => text += &format!(" {ty} m{number} : {width};"),
        }
        fields.push(format!("m{number}"));
    }
    writer.put(&format!("{text} }};\nstatic struct $s $v[2];\n\n"));
    fields
}

fn statement(writer: &mut Writer, fields: &[String]) {
    let object = writer.pick(&["p->", "a.", "$v[i & 1]."]);
    let place = format!("{object}{}", fields[writer.below(fields.len())]);
    let value = writer.integer(2);
    match writer.below(9) {
        0 => {
            let operator = writer.pick(&["+", "-", "*", "&", "|", "^"]);
            writer.line(&format!("{place} {operator}= {value};"));
        }
        1 => {
            let step = writer.pick(&["++", "--"]);
            writer.line(&format!("{place}{step};"));
        }
        2 => writer.line(&format!("sum = @wide(sum, (long long)({place} = {value}));")),
        3 => writer.line(&format!("if ((long long){place} > {value})\n        i += 3;")),
        4 => writer.line("$v[1] = $v[0];"),
        5 => writer.line("*p = $v[i & 1];"),
        _ => writer.line(&format!("{place} = {value};")),
    }
}
