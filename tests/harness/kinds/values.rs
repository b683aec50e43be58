//! Variable arguments, and structures passed, returned and assigned by value.

use super::Writer;

/// Readers of variable arguments: the second one receives the list, and reads it again from a copy.
const READERS: &str = "static unsigned $r(unsigned sum, const char *kinds, va_list list)
{
    for (; *kinds; kinds++)
        switch (*kinds) {
            case 'i': sum = @mix(sum, va_arg(list, int)); break;
            case 'u': sum = @mix(sum, va_arg(list, unsigned) / 3); break;
            case 'l': sum = @wide(sum, va_arg(list, long long)); break;
            case 'd': sum = @real(sum, va_arg(list, double)); break;
            case 'p': sum = @mix(sum, *va_arg(list, int *)); break;
            case 's': sum = @mix(sum, va_arg(list, char *)[1]); break;
        }
    return sum;
}

static unsigned $v(unsigned sum, const char *kinds, ...)
{
    va_list list, again;

    va_start(list, kinds);
    va_copy(again, list);
    sum = $r(sum, kinds, list);
    sum = $r(sum, kinds, again);
    va_end(again);
    va_end(list);
    return sum;
}

";

/// Writes calls with variable arguments.
pub(super) fn write_arguments(writer: &mut Writer) {
    writer.put(READERS);
    writer.open("    int a[4] = { x, 7, -x, 9 };\n    char text[] = \"abcdef\";\n");
    for _ in 0..3 + writer.below(4) {
        let (mut kinds, mut arguments) = (String::new(), String::new());
        for _ in 0..writer.below(12) {
            let (kind, argument) = argument(writer);
            kinds.push(kind);
            arguments += &format!(", {argument}");
        }
        writer.line(&format!("sum = $v(sum, \"{kinds}\"{arguments});"));
    }
    writer.close();
}

/// An argument: its letter and its expression.
fn argument(writer: &mut Writer) -> (char, String) {
    match writer.below(9) {
        0 => ('i', format!("(char)({})", writer.integer(1))),
        1 => ('i', format!("(short)({})", writer.integer(1))),
        2 => ('u', format!("(unsigned)({})", writer.integer(1))),
        3 | 4 => ('l', format!("z * {}", writer.below(50))),
        5 => ('d', format!("(float)(w * {})", writer.fraction())),
        6 => ('d', format!("w + {}", writer.fraction())),
        7 => ('p', format!("a + {}", writer.below(4))),
        _ => ('s', format!("text + {}", writer.below(5))),
    }
}

/// Types of members, each with the function that adds one to the sum.
const MEMBERS: &[(&str, &str)] = &[
    ("char", "mix"),
    ("short", "mix"),
    ("int", "mix"),
    ("long long", "wide"),
    ("float", "real"),
    ("double", "real"),
    ("unsigned char", "mix"),
];

/// A structure: the functions that add its members.
type Structure = Vec<&'static str>;

/// Writes structures, functions that convert between them, and their calls.
pub(super) fn write_structures(writer: &mut Writer) {
    let structures: Vec<Structure> = (0..3).map(|number| declare(writer, number)).collect();
    for number in 0..3 {
        conversion(writer, &structures, number);
    }
    let objects: String = (0..3)
        .map(|n| format!("    struct $s{n} v{n} = $f{n}($z{n}, $z{}, x, w), *p{n} = &$z{n};\n", (n + 1) % 3))
        .collect();
    writer.open(&objects);
    for _ in 0..3 + writer.below(3) {
        statement(writer, &structures);
    }
    for (number, structure) in structures.iter().enumerate() {
        add(writer, &format!("v{number}"), structure);
        add(writer, &format!("$z{number}"), structure);
    }
    writer.close();
}

/// Writes a structure of up to four members, some of which may be arrays.
fn declare(writer: &mut Writer, number: usize) -> Structure {
    let mut text = format!("struct $s{number} {{");
    let mut structure = Structure::new();
    for member in 0..1 + writer.below(4) {
        let (ty, function) = MEMBERS[writer.below(MEMBERS.len())];
        text += &format!(" {ty} m{member};");
        structure.push(function);
    }
    if writer.below(3) == 0 {
        text += &format!(" char rest[{}];", 1 + writer.below(20));
    }
    writer.put(&format!("{text} }};\nstatic struct $s{number} $z{number};\n\n"));
    structure
}

/// Writes the function that computes a structure from itself, from the next one, and from numbers.
fn conversion(writer: &mut Writer, structures: &[Structure], number: usize) {
    let other = (number + 1) % 3;
    writer.put(&format!(
        "static struct $s{number} $f{number}(struct $s{number} a, struct $s{other} b, int x, double w)\n{{\n    struct $s{number} c = a;\n\n"
    ));
    for (member, function) in structures[number].iter().enumerate() {
        let value = match *function {
            "real" => format!("w * {} + a.m{member} * 0.25", writer.fraction()),
            _ if structures[other][0] == "real" => format!("a.m{member} * 3 + x + (b.m0 > 1)"),
            _ => format!("a.m{member} * 5 + x - (int)b.m0"),
        };
        writer.line(&format!("c.m{member} = {value};"));
    }
    let chosen = writer.pick(&["c", "x & 1 ? a : c", "c"]);
    writer.line(&format!("b.m0 = 1;\n    return {chosen};"));
    writer.put("}\n\n");
}

fn statement(writer: &mut Writer, structures: &[Structure]) {
    let number = writer.below(3);
    let (second, third) = ((number + 1) % 3, (number + 2) % 3);
    let value = writer.integer(1);
    let function = structures[number][0];
    match writer.below(6) {
        0 => writer.line(&format!(
            "*p{number} = $f{number}(v{number}, $f{second}(v{second}, v{third}, {value}, w), x, 2.5);"
        )),
        1 => {
            writer
                .line(&format!("sum = @{function}(sum, $f{number}(v{number}, *p{second}, {value}, w).m0);"));
        }
        2 => writer.line(&format!("v{number} = {value} & 1 ? *p{number} : v{number};")),
        3 => writer.line(&format!(
            "for (i = 0; i < 3; i++)\n        v{number} = $f{number}(v{number}, v{second}, i, w);"
        )),
        4 => writer.line(&format!("*p{number} = v{number};")),
        _ => writer.line(&format!("v{number} = $f{number}(*p{number}, v{second}, {value}, -w);")),
    }
}

fn add(writer: &mut Writer, object: &str, structure: &Structure) {
    for (member, function) in structure.iter().enumerate() {
        writer.line(&format!("sum = @{function}(sum, {object}.m{member});"));
    }
}
