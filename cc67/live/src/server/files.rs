//! The files of the page, which are embedded in the binary.

#[derive(Debug)]
pub(super) struct File {
    path: &'static str,
    /// The MIME type, for the browser.
    pub(super) mime: &'static str,
    /// The contents.
    pub(super) text: &'static str,
}

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";

macro_rules! files {
    ($($path:literal = $mime:ident $name:literal;)*) => {
        /// All files.
        const FILES: &[File] =
            &[$(File { path: $path, mime: $mime, text: include_str!(concat!("../../page/", $name)) }),*];
    };
}

files! {
    "/" = HTML "index.html";
    "/favicon.svg" = SVG "favicon.svg";
    "/style.css" = CSS "style.css";
    "/panels.css" = CSS "panels.css";
    "/main.js" = SCRIPT "main.js";
    "/link.js" = SCRIPT "link.js";
    "/frame.js" = SCRIPT "frame.js";
    "/dom.js" = SCRIPT "dom.js";
    "/theme.js" = SCRIPT "theme.js";
    "/clock.js" = SCRIPT "clock.js";
    "/axes.js" = SCRIPT "axes.js";
    "/io.js" = SCRIPT "io.js";
    "/asks.js" = SCRIPT "asks.js";
    "/gather.js" = SCRIPT "gather.js";
    "/persist.js" = SCRIPT "persist.js";
    "/wheels.js" = SCRIPT "wheels.js";
    "/console.js" = SCRIPT "console.js";
    "/threads.js" = SCRIPT "threads.js";
    "/scope.js" = SCRIPT "scope.js";
    "/plot.js" = SCRIPT "plot.js";
    "/pen.js" = SCRIPT "pen.js";
    "/history.js" = SCRIPT "history.js";
    "/export.js" = SCRIPT "export.js";
    "/path.js" = SCRIPT "path.js";
    "/trail.js" = SCRIPT "trail.js";
    "/timeline.js" = SCRIPT "timeline.js";
    "/source.js" = SCRIPT "source.js";
    "/tabs.js" = SCRIPT "tabs.js";
    "/layout.js" = SCRIPT "layout.js";
}

/// The file at a path.
pub(super) fn find(path: &str) -> Option<&'static File> {
    FILES.iter().find(|file| file.path == path)
}
