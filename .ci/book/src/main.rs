//! Builds the book and fails on what mdbook warns of, and on links of the pages that lead nowhere.
//!
//! The first argument is the folder of the book, the second one where its pages go.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs};

use mdbook_driver::MDBook;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Warnings and errors so far.
static COMPLAINTS: AtomicUsize = AtomicUsize::new(0);

fn main() -> ExitCode {
    let mut arguments = env::args_os().skip(1).map(PathBuf::from);
    let (Some(book), Some(pages)) = (arguments.next(), arguments.next()) else {
        eprintln!("usage: cc67-book BOOK PAGES");
        return ExitCode::from(2);
    };
    if tracing::subscriber::set_global_default(Listener).is_err() {
        complain("somebody listens already");
    }
    match build(&book, &pages) {
        Ok(()) => check(&pages),
        Err(error) => complain(&error),
    }
    ExitCode::from(u8::from(COMPLAINTS.load(Ordering::Relaxed) > 0))
}

fn complain(text: &str) {
    eprintln!("{text}");
    COMPLAINTS.fetch_add(1, Ordering::Relaxed);
}

fn build(book: &Path, pages: &Path) -> Result<(), String> {
    let pages = std::path::absolute(pages).map_err(|error| error.to_string())?;
    let mut book = MDBook::load(book).map_err(|error| format!("{error:?}"))?;
    book.config.build.build_dir = pages;
    book.build().map_err(|error| format!("{error:?}"))
}

/// Hears what mdbook says while it works.
struct Listener;

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN
    }

    fn event(&self, event: &Event<'_>) {
        let mut text = format!("{}:", event.metadata().level());
        event.record(&mut Words(&mut text));
        complain(&text);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// Joins the fields of an event.
struct Words<'a>(&'a mut String);

impl Visit for Words<'_> {
    fn record_debug(&mut self, _: &Field, value: &dyn std::fmt::Debug) {
        self.0.push_str(&format!(" {value:?}"));
    }
}

/// Every link within the pages leads to a page or file, and to a place in it.
fn check(pages: &Path) {
    let mut texts = BTreeMap::new();
    read(pages, "", &mut texts);
    let places: BTreeMap<&str, BTreeSet<&str>> =
        texts.iter().map(|(name, text)| (name.as_str(), values(text, " id=\"").collect())).collect();
    let mut count = 0;
    for (name, text) in &texts {
        for link in values(text, " href=\"").filter(|link| !link.contains("://")) {
            count += 1;
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let file = if file.is_empty() { name.clone() } else { beside(name, file) };
            let is_there = match places.get(file.as_str()) {
                Some(places) => place.is_empty() || places.contains(place),
                None => pages.join(file).exists(),
            };
            if !is_there {
                complain(&format!("{name} links to {link}, which is not there"));
            }
        }
    }
    println!("{} pages, {count} links", texts.len());
}

/// Reads the pages of a folder and of those in it, by their names from the top.
fn read(folder: &Path, prefix: &str, texts: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if path.is_dir() {
            read(&path, &format!("{name}/"), texts);
            continue;
        }
        // The page of all chapters has the links of the others again.
        let is_page = path.extension().is_some_and(|suffix| suffix == "html");
        if is_page && name != "print.html" && name != "toc.html" {
            texts.insert(name, fs::read_to_string(&path).unwrap_or_default());
        }
    }
}

/// The name of a file that a page links to, from the top.
fn beside(page: &str, link: &str) -> String {
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            "." | "" => {}
            ".." => drop(parts.pop()),
            name => parts.push(name),
        }
    }
    parts.join("/")
}

/// The text between each mark and the next quotation mark.
fn values<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(mark).skip(1).filter_map(|rest| rest.split('"').next())
}
