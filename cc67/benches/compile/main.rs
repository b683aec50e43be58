//! The time of compilation, for each stage and for all together.
//!
//! The stages run over a program of `c-programs/` (what a user edits, header included) and over
//! generated text: `sequence` is 10,000 lines of ordinary statements, `table/n` is an initialiser
//! of n lines. The throughput of `table` and `statements` must not depend on n: everything is
//! linear in the length of the text.
//!
//! `cargo bench -p cc67 --bench compile`

mod generate;

use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

use compiler::diag::Sink;
use compiler::firmware::BuiltIn;
use compiler::names::Names;
use compiler::passes::Level;
use compiler::pp::{self, MemoryFiles};
use compiler::source::{FileId, SourceMap};
use compiler::{Options, driver, parse, sema};
use kmotiondef::timing::Timing;

/// A program of typical size.
const INIT_PROGRAM: &str = include_str!("../../../c-programs/motion/init3.c");

/// The state of a compilation before its first stage.
struct Start {
    sources: SourceMap,
    names: Names,
    sink: Sink,
    main: FileId,
}

impl Start {
    fn new(text: &str) -> Self {
        let mut sources = SourceMap::new();
        let main = sources.add_file("bench.c", Some(Path::new("bench.c")), text.as_bytes().to_vec(), None);
        Self { sources, names: Names::new(), sink: Sink::new(), main }
    }

    fn preprocess(&mut self, options: &Options) -> Vec<pp::Token> {
        let files = MemoryFiles::default();
        let Self { sources, names, sink, main } = self;
        pp::preprocess(*main, &options.preprocessor, &files, sources, names, sink)
    }
}

/// The stages one after another, each on the result of the previous one.
fn stages(c: &mut Criterion) {
    let options = Options::default();
    for (name, text) in [("init3", INIT_PROGRAM), ("sequence", &generate::sequence(10_000))] {
        let mut start = Start::new(text);
        let tokens = start.preprocess(&options);
        let Start { sources, names, mut sink, .. } = start;
        let mut names = names;
        let tree = parse::parse(&tokens, &sources, &names, &mut sink);
        let typed = sema::analyze(&tree, &mut names, &sources, &BuiltIn, &mut sink);
        assert!(!sink.has_errors(), "the program of a bench is correct");

        let mut group = c.benchmark_group("compile");
        group.throughput(Throughput::Elements(text.lines().count() as u64));
        group.bench_function(format!("preprocess/{name}"), |b| {
            b.iter(|| Start::new(text).preprocess(&options));
        });
        group.bench_function(format!("parse/{name}"), |b| {
            b.iter(|| parse::parse(&tokens, &sources, &names, &mut Sink::new()));
        });
        let all_names = names.clone();
        group.bench_function(format!("sema/{name}"), |b| {
            b.iter(|| sema::analyze(&tree, &mut all_names.clone(), &sources, &BuiltIn, &mut Sink::new()));
        });
        for (level, level_name) in [(Level::None, "O0"), (Level::Full, "O1")] {
            group.bench_function(format!("generate/{level_name}/{name}"), |b| {
                b.iter(|| driver::generate(&typed, &sources, level, Timing::default(), &mut Sink::new()));
            });
        }
        group.finish();
    }
}

/// All stages, as in `cc67 check`, with inputs of increasing size.
fn whole(c: &mut Criterion) {
    let options = Options { level: Level::None, ..Options::default() };
    let mut group = c.benchmark_group("compile/all");
    let mut bench = |name: &str, lines: usize, text: String| {
        group.throughput(Throughput::Elements(text.lines().count() as u64));
        group.bench_function(BenchmarkId::new(name, lines), |b| {
            b.iter(|| {
                let files = MemoryFiles::default();
                let compilation =
                    compiler::compile(Path::new("bench.c"), text.clone().into(), &options, &files);
                assert!(compilation.object.is_some(), "the program of a bench is correct");
            });
        });
    };
    bench("init3", INIT_PROGRAM.lines().count(), INIT_PROGRAM.to_owned());
    bench("sequence", 10_000, generate::sequence(10_000));
    for lines in [1_000, 10_000, 100_000] {
        bench("table", lines, generate::table(lines));
        bench("statements", lines, generate::statements(lines));
    }
    group.finish();
}

criterion_group! {
    name = compile;
    config = Criterion::default().sample_size(20);
    targets = stages, whole
}
criterion_main!(compile);
