//! Diagnostics in one line each, for editors: `file:line:column: error: message [code]`.

use crate::diag::Diagnostic;
use crate::source::SourceMap;

use super::severity_name;

/// The diagnostic in one line, without a line end.
#[must_use]
pub fn render(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let severity = severity_name(diagnostic.severity);
    let place = diagnostic.span.and_then(|span| sources.place(span)).map_or_else(String::new, |place| {
        format!("{}:{}:{}: ", sources.file(place.file).name, place.line, place.column)
    });
    let code = diagnostic.lint.map_or_else(String::new, |lint| format!(" [{}]", lint.name()));
    format!("{place}{severity}: {}{code}", diagnostic.message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Lint;
    use crate::source::Span;

    #[test]
    fn place_severity_message_and_code_are_on_one_line() {
        let mut sources = SourceMap::new();
        sources.add_file("a.c", None, b"int a;\nint b;\n".to_vec(), None);
        let span = Span::new(11, 12);
        let check = |diagnostic: Diagnostic, expect| assert_eq!(render(&diagnostic, &sources), expect);
        check(Diagnostic::error(span, "no"), "a.c:2:5: error: no");
        check(Diagnostic::warning(Lint::ImplicitInt, span, "no"), "a.c:2:5: warning: no [implicit-int]");
        check(Diagnostic::global_error("no"), "error: no");
    }
}
