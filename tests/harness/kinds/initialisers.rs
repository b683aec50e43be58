//! Initialisers with designators in any order, ranges, repetitions and omitted braces.

use super::Writer;

/// The type of an object.
enum Shape {
    Integer,
    Real,
    Array(Box<Shape>, usize),
    Structure(Vec<Shape>),
}

/// The maximum number of scalars in an object.
const MOST_SCALARS: usize = 30;

/// Writes objects with initialisers and a function that reads all of them.
pub(super) fn write(writer: &mut Writer) {
    // The stack of the board is small.
    let shape = loop {
        let shape = shape(writer, 3);
        if scalars(&shape) <= MOST_SCALARS {
            break shape;
        }
    };
    let name = "v";
    let declarator = declare(&shape, name);
    let object = initialiser(writer, &shape, true);
    writer.put(&format!("static {} = {object};\n\n", declare(&shape, "$s")));
    let object = initialiser(writer, &shape, false);
    writer.open(&format!("    {declarator} = {object};\n"));
    for root in ["$s", "v"] {
        let mut leaves = Vec::new();
        paths(&shape, root, &mut leaves);
        for (path, is_real) in leaves {
            let function = if is_real { "real" } else { "mix" };
            writer.line(&format!("sum = @{function}(sum, {path});"));
        }
    }
    writer.close();
}

fn shape(writer: &mut Writer, depth: usize) -> Shape {
    match writer.below(4) {
        0 if depth < 3 => Shape::Integer,
        1 if depth < 3 => Shape::Real,
        _ if depth == 0 => Shape::Integer,
        2 => Shape::Array(Box::new(shape(writer, depth - 1)), 1 + writer.below(4)),
        _ => Shape::Structure((0..1 + writer.below(3)).map(|_| shape(writer, depth - 1)).collect()),
    }
}

/// A declaration of an object of a shape.
fn declare(shape: &Shape, name: &str) -> String {
    match shape {
        Shape::Integer => format!("int {name}"),
        Shape::Real => format!("double {name}"),
        Shape::Array(of, count) => declare(of, &format!("{name}[{count}]")),
        Shape::Structure(members) => {
            let members = members.iter().enumerate();
            let all: String =
                members.map(|(number, of)| format!(" {};", declare(of, &format!("m{number}")))).collect();
            format!("struct {{{all} }} {name}")
        }
    }
}

/// The scalars of an object, each with whether it is floating.
fn paths(shape: &Shape, root: &str, into: &mut Vec<(String, bool)>) {
    match shape {
        Shape::Integer => into.push((root.to_owned(), false)),
        Shape::Real => into.push((root.to_owned(), true)),
        Shape::Array(of, count) => (0..*count).for_each(|index| paths(of, &format!("{root}[{index}]"), into)),
        Shape::Structure(members) => {
            for (number, of) in members.iter().enumerate() {
                paths(of, &format!("{root}.m{number}"), into);
            }
        }
    }
}

fn scalars(shape: &Shape) -> usize {
    match shape {
        Shape::Integer | Shape::Real => 1,
        Shape::Array(of, count) => count * scalars(of),
        Shape::Structure(members) => members.iter().map(scalars).sum(),
    }
}

/// The number of parts of an aggregate.
fn len(shape: &Shape) -> usize {
    match shape {
        Shape::Integer | Shape::Real => 0,
        Shape::Array(_, count) => *count,
        Shape::Structure(members) => members.len(),
    }
}

fn part(shape: &Shape, index: usize) -> &Shape {
    match shape {
        Shape::Array(of, _) => of,
        Shape::Structure(members) => &members[index],
        Shape::Integer | Shape::Real => shape,
    }
}

fn designator(shape: &Shape, index: usize) -> String {
    match shape {
        Shape::Structure(_) => format!(".m{index}"),
        _ => format!("[{index}]"),
    }
}

/// An initialiser: braces for aggregates.
fn initialiser(writer: &mut Writer, shape: &Shape, is_static: bool) -> String {
    let count = len(shape);
    if count == 0 {
        return scalar(writer, shape, is_static);
    }
    let mut items = Vec::new();
    let mut next = 0;
    for _ in 0..1 + writer.below(count + 2) {
        if next >= count || writer.below(3) == 0 {
            next = writer.below(count);
            items.push(designated(writer, shape, next, is_static));
        } else {
            items.push(plain(writer, part(shape, next), is_static));
        }
        next += 1;
    }
    format!("{{ {} }}", items.join(", "))
}

/// An initialiser with a designator: for a part, for a range of an array, or for a part of a part.
fn designated(writer: &mut Writer, shape: &Shape, index: usize, is_static: bool) -> String {
    let of = part(shape, index);
    let place = designator(shape, index);
    match (shape, writer.below(4)) {
        // gcc rejects ranges of aggregates that are not constant.
        (Shape::Array(..), 0) if is_static || len(of) == 0 => {
            format!("[0 ... {index}] = {}", initialiser(writer, of, is_static))
        }
        (_, 1) if len(of) > 0 => {
            // The last part of the part: the following initialiser is for the part after it.
            let last = len(of) - 1;
            let value = initialiser(writer, part(of, last), is_static);
            format!("{place}{} = {value}", designator(of, last))
        }
        _ => format!("{place} = {}", initialiser(writer, of, is_static)),
    }
}

/// An initialiser for the next part: with braces, or all its scalars without.
fn plain(writer: &mut Writer, shape: &Shape, is_static: bool) -> String {
    if len(shape) == 0 || writer.below(3) > 0 {
        return initialiser(writer, shape, is_static);
    }
    let parts: Vec<_> = (0..len(shape)).map(|index| all(writer, part(shape, index), is_static)).collect();
    parts.join(", ")
}

/// All scalars of an object without braces.
fn all(writer: &mut Writer, shape: &Shape, is_static: bool) -> String {
    if len(shape) == 0 {
        return scalar(writer, shape, is_static);
    }
    let parts: Vec<_> = (0..len(shape)).map(|index| all(writer, part(shape, index), is_static)).collect();
    parts.join(", ")
}

fn scalar(writer: &mut Writer, shape: &Shape, is_static: bool) -> String {
    match shape {
        Shape::Real if is_static => writer.fraction(),
        Shape::Real => format!("w * {}", writer.fraction()),
        _ if is_static => writer.constant(),
        _ => writer.integer(1),
    }
}
