//! Formatted output and input, and conversions of numbers and texts.

use super::ScenarioWriter;
use crate::cli::commands::compare::random::draw::Draw;

/// Declarations of conversions, which programs must declare themselves. Without `ltoa`: it reads an uninitialised
/// register.
const HEAD: &str = "int sprintf(char*,char*,...); int sscanf(const char*,const char*,...); double strtod(const char*,char**); int strtol(const char*,char**,int); int atoi(const char*); char *ecvt(double,int,int*,int*); char *fcvt(double,int,int*,int*); char b[400]; int i0,i1,i2; double d0,d1; float f0; char *e; void clear(void){ i0=-99; i1=-99; i2=-99; d0=-99; d1=-99; f0=-99; b[0]=0; }";

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    writer.head(HEAD);
    for _ in 0..8 {
        let text = match writer.draw.below(10) {
            0..=5 => print(&mut writer.draw),
            6 | 7 => scan(&mut writer.draw),
            _ => convert(&mut writer.draw),
        };
        writer.add_later(2, 2, text);
    }
    // The printed lines are still on their way; nothing else is compared.
    writer.scenario.slices = writer.slice + 8;
}

fn number(draw: &mut Draw) -> String {
    match draw.below(8) {
        0 => draw
            .pick(&["0.0", "1.0", "-1.0", "0.5", "1e6", "999999.5", "0.1", "123456789.0", "9.995", "-0.05"])
            .to_owned(),
        1 => format!("{}.0", draw.integer(-100_000, 100_000)),
        2 => format!("{:?}", draw.signed(1e-12, 1e12)),
        3 => format!("{:?}", draw.signed(1e-6, 1e-2)),
        _ => format!("{:?}", draw.signed(0.001, 10_000.0)),
    }
}

fn integer(draw: &mut Draw) -> String {
    match draw.below(4) {
        0 => draw.pick(&["0", "1", "-1", "2147483647", "-2147483647-1", "255", "65535"]).to_owned(),
        1 => draw.integer(-100_000_000, 100_000_000).to_string(),
        _ => draw.integer(-999, 999).to_string(),
    }
}

/// A `printf` conversion and its argument.
fn conversion(draw: &mut Draw) -> (String, String) {
    let flags: String = "-+ 0#".chars().filter(|_| draw.chance(12)).collect();
    let width = if draw.chance(40) { draw.below(16).to_string() } else { String::new() };
    let precision = if draw.chance(40) { format!(".{}", draw.below(10)) } else { String::new() };
    let (letter, argument) = match draw.below(12) {
        0..=2 => (draw.pick(&["d", "i", "x", "X", "u", "o"]), integer(draw)),
        3..=5 => ("f", number(draw)),
        6 | 7 => (draw.pick(&["g", "G"]), number(draw)),
        8 => (draw.pick(&["e", "E"]), number(draw)),
        9 => ("s", draw.pick(&["\"\"", "\"a\"", "\"some text\"", "\"%d\""]).to_owned()),
        10 => ("c", draw.integer(33, 126).to_string()),
        _ => (draw.pick(&["d", "x"]), integer(draw)),
    };
    (format!("%{flags}{width}{precision}{letter}"), argument)
}

fn print(draw: &mut Draw) -> String {
    let (mut format, mut arguments) = (String::new(), String::new());
    for _ in 0..1 + draw.below(3) {
        let (conversion, argument) = conversion(draw);
        format += draw.pick(&["", " ", "|", "x="]);
        format += &conversion;
        arguments += ",";
        arguments += &argument;
    }
    format!("printf(\"{format}|\\n\"{arguments});")
}

fn scan(draw: &mut Draw) -> String {
    let inputs = [
        "12 3.5",
        "-7,8",
        "0x1F 22",
        "  4  5",
        "1e3 2",
        "abc 5",
        "3.25abc",
        "",
        "+9 -0.5",
        "1,2,3",
        "12345678901",
        ".5 5.",
        "7 -",
        "0012 010",
    ];
    let formats = [
        "%d %d %d", "%d,%d", "%lf %lf", "%x %d", "%d %lf", "%f %d", "%s %d", "%d%d", "%c%d", "%*d %d",
        "%2d%d", "%lf,%d", "%i %i",
    ];
    let input = draw.pick(&inputs);
    let format = draw.pick(&formats);
    let mut arguments = String::new();
    let (mut integers, mut doubles) = (["&i0", "&i1", "&i2"].into_iter(), ["&d0", "&d1"].into_iter());
    let letters = format.split('%').skip(1).filter(|conversion| !conversion.starts_with('*'));
    for conversion in letters {
        let letters: String = conversion.chars().filter(char::is_ascii_alphabetic).collect();
        let argument = match letters.as_str() {
            "lf" => doubles.next(),
            "f" => Some("&f0"),
            "s" | "c" => Some("b"),
            _ => integers.next(),
        };
        arguments += ",";
        arguments += argument.unwrap_or("&i2");
    }
    format!(
        "clear(); n=n; printf(\"%d:\",sscanf(\"{input}\",\"{format}\"{arguments})); printf(\" %d %d %d %g %g %g %s\\n\",i0,i1,i2,d0,d1,f0,b);"
    )
}

fn convert(draw: &mut Draw) -> String {
    let text = draw.pick(&[
        "12",
        "-3.75",
        " 8e2",
        "1e-5xyz",
        "+.5",
        "0x10",
        "- 5",
        "abc",
        "1e400",
        "7e",
        "123456789012345678",
        "0.000001234",
    ]);
    match draw.below(5) {
        0 | 1 => format!("d0=strtod(\"{text}\",&e); printf(\"%.15g %s\\n\",d0,e);"),
        2 => format!("i0=strtol(\"{text}\",&e,{}); printf(\"%d %s\\n\",i0,e);", draw.pick(&[0, 8, 10, 16])),
        3 => format!("printf(\"%d\\n\",atoi(\"{text}\"));"),
        _ => {
            let (function, digits) = (draw.pick(&["ecvt", "fcvt"]), draw.below(12));
            format!("e={function}({},{digits},&i0,&i1); printf(\"%s %d %d\\n\",e,i0,i1);", number(draw))
        }
    }
}
