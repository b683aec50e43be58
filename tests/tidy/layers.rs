//! The layers inside each crate, from top to bottom: a file may import from its own row and from the rows below.
//!
//! A new upward import fails with the names of both rows. What still points upwards is named in [`UPWARDS`], what still
//! goes round in [`CIRCLES`]; both lists only shrink, and an entry that is not needed any more should be taken out.

/// A row of a crate: the name of the layer, and its rooms as paths from `src` on. The longest path that fits counts.
pub(crate) type Row = (&'static str, &'static [&'static str]);

/// The crates and their rows.
pub(crate) const LAYERS: &[(&str, &[Row])] = &[
    (
        "kmotiondef",
        &[
            ("boards", &["boards"]),
            ("lists", &["firmware", "variables", "map", "headers", "hidden", "modes"]),
            ("structures", &["structs"]),
            ("places", &["place", "limits", "function"]),
            ("types", &["ctype", "bits", "jumps", "start", "timing"]),
            ("numbers", &["ids"]),
        ],
    ),
    (
        "coff",
        &[
            ("dump", &["dump"]),
            ("files", &["read", "write"]),
            ("records", &["file", "auxiliary"]),
            ("image", &["image"]),
            ("words", &["error", "names", "raw"]),
        ],
    ),
    (
        "vm/c67x",
        &[
            ("schedule", &["schedule"]),
            ("text", &["text"]),
            ("assembler", &["assemble"]),
            ("spelling", &["spelling"]),
            ("forms", &["alias", "model"]),
            ("registers of calls", &["convention"]),
            ("instructions", &["inst"]),
            ("table", &["table", "operand"]),
            ("words", &["mnemonic", "register", "kind"]),
        ],
    ),
    (
        "vm",
        &[
            ("machine", &["machine", "profile"]),
            ("engines", &["interp", "native", "dsp"]),
            ("access", &["access"]),
            ("engine", &["engine"]),
            ("loaded", &["loaded"]),
            ("loops that wait", &["polling"]),
            ("verify", &["verify"]),
            ("translations", &["translations"]),
            ("shared memory", &["shared"]),
            ("program", &["program"]),
            ("firmware", &["firmware"]),
            ("thread", &["thread"]),
            ("scheduler", &["scheduler"]),
            ("calls", &["call", "wake"]),
            ("views of instructions", &["meter", "patch", "text"]),
            ("guard", &["guard"]),
            ("instructions", &["op"]),
            ("kinds of instructions", &["kind"]),
            ("slots", &["slot"]),
            ("operands", &["operand"]),
            ("arguments", &["varargs"]),
            ("memory", &["memory", "bus"]),
            ("words", &["protection", "arith", "trap"]),
        ],
    ),
    (
        "runtime",
        &[
            ("board", &["board"]),
            ("kernel", &["kernel"]),
            ("calls and commands", &["firmware", "commands"]),
            ("world and PC", &["world", "pc"]),
            ("servo", &["servo"]),
            ("machine", &["machine"]),
            ("inputs and outputs", &["io"]),
            ("views", &["out", "views", "text"]),
        ],
    ),
    (
        "runtime/chips",
        &[
            ("registers", &["fpga"]),
            ("chips", &["encoder", "flash", "kanalog", "kstep", "stepgen", "uart"]),
            ("pins", &["pins"]),
            ("changes", &["changes"]),
        ],
    ),
    (
        "runtime/boot",
        &[
            ("board", &["board"]),
            ("addresses", &["bus", "loads"]),
            ("registers", &["window"]),
            ("surroundings", &["external"]),
            ("devices", &["control", "flash", "link", "sent", "timer"]),
            ("files and reports", &["file", "crash"]),
            ("functions in ROM", &["rom"]),
        ],
    ),
    (
        "cc67/compiler",
        &[
            ("whole programs", &["debug", "watch", "stages"]),
            ("driver", &["driver"]),
            ("images and reports", &["image", "inspect", "render"]),
            ("link", &["link"]),
            ("object", &["object"]),
            ("back ends", &["bytecode", "c67x"]),
            ("relocations", &["relocation"]),
            ("sharing", &["sharing"]),
            ("lower and passes", &["lower", "passes"]),
            ("sema", &["sema"]),
            ("lints", &["lints"]),
            ("firmware", &["firmware"]),
            ("ir", &["ir"]),
            ("typed", &["typed"]),
            ("types", &["ty"]),
            ("parse", &["parse"]),
            ("preprocessor", &["pp"]),
            ("tree", &["ast"]),
            ("operators", &["operators"]),
            ("diagnostics", &["diag"]),
            ("words", &["words", "names", "files", "source", "index", "target"]),
        ],
    ),
    (
        "cc67/wire",
        &[
            ("users", &["queue"]),
            ("client", &["client"]),
            ("boards", &["boards"]),
            ("transports", &["transport"]),
            ("stream", &["link", "lines"]),
            ("files and reports", &["disk", "found"]),
            ("words", &["address", "error", "clock"]),
        ],
    ),
    (
        "cc67/controller",
        &[
            ("connections", &["connection", "saving"]),
            ("target", &["controller"]),
            ("recordings", &["recording"]),
            ("the monitor", &["monitor"]),
            ("files, images, memory", &["files", "image", "seen"]),
            ("commands and threads", &["commands", "threads"]),
            ("words", &["clock", "terms"]),
        ],
    ),
    (
        "cc67/host",
        &[
            ("clients", &["client", "seats"]),
            ("shared state", &["state"]),
            ("session", &["session"]),
            ("targets", &["target"]),
            ("schedules", &["schedule"]),
            ("setup", &["setup"]),
            ("programs", &["user_program"]),
            ("answers", &["error", "message", "remark"]),
            ("capabilities", &["capability"]),
        ],
    ),
    (
        "cc67/live",
        &[
            ("server", &["server"]),
            ("board", &["board"]),
            ("hub", &["hub"]),
            ("words", &["control", "request", "names"]),
        ],
    ),
    (
        "cc67/debug",
        &[
            ("protocol", &["dap"]),
            ("commands", &["shell"]),
            ("words of commands, lines", &["words", "early"]),
            ("debugger", &["debugger"]),
            ("programs", &["programs"]),
        ],
    ),
    (
        "cc67/capi",
        &[
            ("functions", &["client", "console", "lines", "programs", "time", "token"]),
            ("clients", &["handle"]),
            ("border", &["border"]),
        ],
    ),
    (
        "cc67/python",
        &[
            ("classes", &["board"]),
            ("functions", &["image", "command"]),
            ("what a board begins with", &["setup"]),
            ("programs", &["program"]),
            ("link", &["controller"]),
            ("control", &["control"]),
            ("values over time", &["trace"]),
            ("exceptions", &["errors"]),
        ],
    ),
    (
        "cc67",
        &[
            ("main", &["main"]),
            ("command line", &["cli", "cli/commands"]),
            ("session", &["cli/session"]),
            ("compile", &["cli/compile"]),
            ("reports", &["cli/report"]),
            ("arguments", &["cli/args"]),
            ("input and output", &["cli/io"]),
            ("records", &["record"]),
        ],
    ),
];

/// Arrows that still point upwards: crate, room, room above.
pub(crate) const UPWARDS: &[(&str, &str, &str)] = &[];

/// Rooms of a crate that still lie in one circle.
pub(crate) const CIRCLES: &[(&str, &[&str])] = &[];

/// How many files of a crate still reach each other; three are allowed.
pub(crate) const FILES_IN_A_CIRCLE: &[(&str, usize)] = &[];
