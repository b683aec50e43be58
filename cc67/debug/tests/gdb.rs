//! Commands of gdb, whose output is compared word for word with gdb's own for the same program on this computer.
//!
//! These differences remain: addresses; the additions to a stop (thread and board time, the writer of a watched value,
//! and the position of a step within a function).

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use cc67_debug::{CommandOutput, Debugger, Shell};
use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use kmotiondef::{ThreadId, Ticks};

const PROGRAM: &str = r#"int total;
double ratio = 0.1;
float single = 1.5f;
char letter = 'A', zero;
unsigned char byte = 200;
short small = -3;
unsigned int large = 4000000000u;
long long wide = -5000000000LL;
char text[20] = "hello\n";
char *message = "done";
int table[40], numbers[4] = { 1, 2, 3, 4 };
double steps[3] = { 1, 2.5, 1e20 };
struct Point { int x; double y; char name[8]; struct Point *next; } here = { 1, 2.5, "ab" }, *cursor = &here;
typedef struct { int q; int w : 3; struct { float f; } in; } Pair;
Pair pair = { 7, -2, { 0.1f } };
int (*operation)(int);

void count(void)
{
    total++;
}

int square(int n)
{
    int result = n * n;
    return result;
}

int sum(int a, int b)
{
    int first = square(a);
    int second = square(b);
    return first + second;
}

int main(void)
{
    int i = 0;
    operation = square;
    here.next = cursor;
    for (i = 0; i < 4; i++)
    {
        total += sum(i, numbers[i]);
        table[i] = total;
        count();
    }
    total = 0;
    return 0;
}
"#;

const COMMANDS: &str = r#"break square if n == 2
info breakpoints
run
bt
bt 1
bt -1
info args
print n
p n + 1
print/x n * 100
print *cursor
print $1
print $
print $$2
print $1 + 4
set $k = 3
print $k
print table[$k]
print $nothing
print $99
up
info args
list
list
list -
list 10,12
list square
list 50
list 99
down
down
up 5
info locals
up
frame 1
frame
frame 9
finish
finish
until
until
next
next
next
step
info locals
info args
up
info args
down
advance 44
print table[0]@4
print numbers
print table
print here
print &here
print cursor
print cursor->next->name
print *numbers@2
print 1@2
print pair
print/x numbers
print/x here
print/d letter
print/x byte
print/x small
print/u small
print/c 65
print/t 10
print/o 8
print/z 5
print/a &numbers[1]
print letter
print zero
print byte
print text
print message
print &numbers[2]
print square
print operation
print *operation
print ratio
print steps
print single
print large
print wide
print square(5)
call count()
print count()
print 10/3
print 10/3.0
print 10 % 4 == 2
print -5/2
print 'A'
print "abc"
print sizeof(int)
print nosuch
print 1/0
print *(int *)0
print here.nosuch
print total = 7
print total++
print total
set var total = 9
print total
whatis here
whatis total + ratio
whatis cursor
whatis numbers
whatis operation
ptype here
ptype cursor
ptype struct Point
ptype square
ptype numbers
ptype int
ptype pair
ptype Pair
whatis pair
x/4xw numbers
x/4dw numbers
x/2dh numbers
x/s text
x/8xb text
x/3fg steps
x/2c text
output total
echo done\n
display total
display/x i
info display
tbreak count
continue
tbreak 44
continue
undisplay 1
undisplay 7
watch total
rwatch here.x
awatch numbers[3]
info watchpoints
delete 1
continue
continue
delete 7
disable 3
info breakpoints
delete
info breakpoints
info watchpoints
foo
info foo
"#;

/// Returns whether a program of the operating system can be started; prints a note if not.
fn is_there(name: &str) -> bool {
    let found = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    let found = found.is_ok_and(|status| status.success());
    if !found {
        println!("not run: there is no {name} (package {name})");
    }
    found
}

/// The answer of gdb to a call if the operating system does not let it write the registers of a process.
const CANNOT_CALL: &str = "Couldn't write extended state status";

/// Returns the answers of gdb.
fn of_gdb(folder: &Path, source: &Path, commands: &[&str]) -> Vec<String> {
    let program = folder.join("program");
    let built = Command::new("gcc")
        .args(["-g", "-O0", "-fno-pie", "-no-pie", "-o"])
        .arg(&program)
        .arg(source)
        .current_dir(folder)
        .status()
        .expect("gcc is there");
    assert!(built.success());
    let settings =
        ["confirm off", "pagination off", "width 0", "debuginfod enabled off", "startup-with-shell off"];
    let mut gdb = Command::new("gdb")
        .args(["-q", "-nx"])
        .args(settings.iter().flat_map(|setting| ["-iex".to_owned(), format!("set {setting}")]))
        .arg(&program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("gdb is there");
    // Both output streams in the order in which they are written.
    let script = format!("python import os; os.dup2(1, 2)\n{}\nkill\n", commands.join("\n"));
    gdb.stdin.take().expect("it is piped").write_all(script.as_bytes()).expect("gdb reads");
    let output = gdb.wait_with_output().expect("gdb ends");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let answers = text.split("(gdb) ").skip(2).map(str::to_owned);
    answers.take(commands.len()).collect()
}

/// Returns the answers of cc67.
fn of_cc67(source: &Path, commands: &[&str]) -> Vec<String> {
    let mut setup = Setup::default();
    setup.options.level = Level::None;
    setup.options.gc_sections = false;
    let thread = ThreadId::new(1).expect("there are 7");
    let program = UserProgram::compile(source, thread, &setup.options).expect("it compiles");
    setup.programs.push(program.started());
    let mut shell = Shell::new(Debugger::new(setup.session().expect("a board"), Ticks::new(1_000_000)));
    let answer = |line: &str| {
        let mut said = String::new();
        match shell.command(line, &mut |text| said.push_str(text)) {
            Ok(CommandOutput::Text(text)) => said + &text,
            Ok(CommandOutput::Quit) => said,
            Err(error) => format!("{said}{error}\n"),
        }
    };
    commands.iter().copied().map(answer).collect()
}

/// A text without the known differences: addresses of either program, repeated blanks, and lines about starting a
/// process.
fn plain(text: &str) -> String {
    let is_address = |number: u64| {
        (0x40_0000..0x41_0000).contains(&number) || (0x8005_0000..0x8006_0000).contains(&number)
    };
    let mut out = String::new();
    for line in text.lines() {
        let is_of_process = ["Starting program", "[Thread debugging", "Using host"];
        if is_of_process.iter().any(|start| line.starts_with(start)) {
            continue;
        }
        let mut rest = line;
        while let Some(at) = rest.find("0x") {
            let (before, hex) = rest.split_at(at);
            let digits: String = hex[2..].chars().take_while(char::is_ascii_hexdigit).collect();
            let is_it = u64::from_str_radix(&digits, 16).is_ok_and(is_address);
            out.push_str(before);
            out.push_str(if is_it { "ADDRESS" } else { &hex[..2 + digits.len()] });
            rest = &hex[2 + digits.len()..];
        }
        out.push_str(rest);
        out.push('\n');
    }
    let lines = out.lines().map(|line| {
        let is_table = line.starts_with("Num") || line.contains(" keep ") || line.contains(" del ");
        if is_table { line.split_whitespace().collect::<Vec<_>>().join(" ") } else { line.to_owned() }
    });
    lines.filter(|line| !line.is_empty()).map(|line| line + "\n").collect()
}

/// The output of cc67 without its additions to a stop: thread and time, and the accessor of a watched value.
fn without_additions(text: &str) -> String {
    let lines =
        text.lines().filter(|line| !line.starts_with("Written by ") && !line.starts_with("Accessed by "));
    lines
        .map(|line| line.split_once(" [thread ").map_or(line, |(before, _)| before))
        .fold(String::new(), |text, line| text + line + "\n")
}

#[test]
fn commands_answer_as_those_of_gdb() {
    if !is_there("gdb") || !is_there("gcc") {
        return;
    }
    let folder = std::env::temp_dir().join(format!("cc67-debug-gdb-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let source = folder.join("model.c");
    fs::write(&source, PROGRAM).expect("a file");
    let mut commands: Vec<_> = COMMANDS.lines().collect();
    let mut gdb = of_gdb(&folder, Path::new("model.c"), &commands);
    if gdb.iter().any(|answer| answer.contains(CANNOT_CALL)) {
        println!("calls are not compared: gdb cannot call functions on this system");
        commands.retain(|command| !command.ends_with(')'));
        gdb = of_gdb(&folder, Path::new("model.c"), &commands);
    }
    let cc67 = of_cc67(&source, &commands);
    fs::remove_dir_all(&folder).expect("the folder is ours");
    assert_eq!(gdb.len(), cc67.len(), "{gdb:#?}");
    let mut different = String::new();
    for ((command, gdb), cc67) in commands.iter().copied().zip(&gdb).zip(&cc67) {
        let (expect, found) = (plain(gdb), plain(&without_additions(cc67)));
        // Within a function, gdb shows only the line.
        let is_step = ["until", "next", "step"].contains(&command);
        let step = found.split_once('\n').map_or("", |(_, rest)| rest);
        if found != expect && !(is_step && step == expect) {
            let _ = write!(different, "{command}\ngdb:\n{expect}cc67:\n{found}\n");
        }
    }
    assert!(commands.len() > 40 && different.is_empty(), "{different}");
}
