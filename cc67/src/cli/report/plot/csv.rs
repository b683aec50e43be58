//! Tables of numbers, as written by programs that gather data and by `cc67 run --trace`.
//!
//! Columns are separated by commas, semicolons, tabs or blanks. A first line that contains anything but numbers names
//! the columns. Lines that begin with `#` and empty lines are skipped. The files of the vendor's step response and Bode
//! screens are recognised by their first column.

use anyhow::{Result, bail};

use super::chart::Chart;
use super::responses;
use super::samples::{Column, Samples};

/// Names of a first column that contains times.
const TIMES: [&str; 5] = ["t", "time", "time_s", "seconds", "time (s)"];

/// A chart of the table: one panel per column, over the first column if it contains times, otherwise over the line's
/// number.
pub(super) fn chart(title: &str, text: &str) -> Result<Chart> {
    let table = read(text)?;
    match table.names.first().map(String::as_str) {
        Some("Sample") if table.names.len() >= 5 => return responses::step(title, &table),
        Some("Freq") if table.names.len() >= 5 => return responses::bode(title, &table),
        _ => {}
    }
    let has_time = table.names.first().is_some_and(|name| TIMES.contains(&name.to_lowercase().as_str()));
    let times: Vec<f64> = match has_time {
        true => table.rows.iter().filter_map(|row| row.first().copied()).collect(),
        false => (0..table.rows.len()).map(|index| index as f64).collect(),
    };
    if let Some(index) = times.windows(2).position(|pair| pair[1] < pair[0]) {
        bail!("the time goes back after row {} of the numbers", index + 1);
    }
    let first = usize::from(has_time);
    let names = table.names.iter().skip(first);
    let columns = names.map(|name| Column { name: name.clone(), unit: String::new() }).collect();
    let rows = times.iter().copied().zip(table.rows.into_iter().map(|row| row[first..].to_vec())).collect();
    let end = times.last().copied().unwrap_or_default();
    // The table contains every value, so none is held longer.
    let samples = Samples { columns, rows, step: f64::INFINITY, end, ..Samples::default() };
    let panels = if has_time { samples.panels() } else { samples.plain_panels() };
    let strips = if has_time { samples.strips() } else { Vec::new() };
    if panels.is_empty() && strips.is_empty() {
        bail!("there is nothing but the time in it");
    }
    let range = (times.first().copied().unwrap_or_default(), end);
    let abscissa = if has_time { "time (s)" } else { "line" };
    Ok(Chart {
        title: title.to_owned(),
        abscissa: abscissa.to_owned(),
        panels,
        strips,
        range,
        ..Chart::default()
    })
}

/// Named columns of numbers.
pub(super) struct Table {
    pub(super) names: Vec<String>,
    pub(super) rows: Vec<Vec<f64>>,
}

fn read(text: &str) -> Result<Table> {
    if text.contains('\0') {
        bail!("this is not text");
    }
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .peekable();
    let Some((_, first)) = lines.peek() else { bail!("there are no numbers in it") };
    let fields = head(first);
    let is_head = fields.iter().any(|field| field.parse::<f64>().is_err());
    let names: Vec<String> = match is_head {
        true => fields,
        false => (1..=fields.len()).map(|column| format!("column {column}")).collect(),
    };
    if is_head {
        lines.next();
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        let fields = split(line);
        if fields.len() != names.len() {
            bail!("line {number} has {} columns, the first has {}", fields.len(), names.len());
        }
        let mut row = Vec::with_capacity(fields.len());
        for field in fields {
            match field.parse() {
                Ok(value) => row.push(value),
                Err(_) => bail!("line {number}: `{field}` is not a number"),
            }
        }
        rows.push(row);
    }
    if rows.is_empty() {
        bail!("there are no numbers in it");
    }
    Ok(Table { names, rows })
}

/// The fields of the first line; fields in quotes may contain commas.
fn head(line: &str) -> Vec<String> {
    if !line.contains('"') {
        return split(line).into_iter().map(str::to_owned).collect();
    }
    let mut fields = vec![String::new()];
    let mut is_quoted = false;
    for character in line.chars() {
        match character {
            '"' => is_quoted = !is_quoted,
            ',' | ';' | '\t' if !is_quoted => fields.push(String::new()),
            _ => fields.last_mut().into_iter().for_each(|field| field.push(character)),
        }
    }
    fields
}

/// The fields of a line.
fn split(line: &str) -> Vec<&str> {
    match [',', ';', '\t'].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expect: &str) {
        let shown = match chart("", text) {
            Ok(chart) => {
                let names: Vec<_> = chart.panels.iter().map(|panel| panel.title.as_str()).collect();
                format!("{} over {} {:?}", names.join(" "), chart.abscissa, chart.range)
            }
            Err(error) => error.to_string(),
        };
        assert_eq!(shown, expect);
    }

    #[test]
    fn columns_become_panels() {
        check("time,dest0,pos0\n0.1,1,2\n0.2,3,4\n", "axis 0: Dest and Position over time (s) (0.1, 0.2)");
        check("1 2\n3 4\n5 6\n", "column 1 column 2 over line (0.0, 2.0)");
        check("t,dest0,pos0,bit4\n1,2,3,0\n", "axis 0: Dest and Position over time (s) (1.0, 1.0)");
        check("dest0\n1\n", "dest0 over line (0.0, 0.0)");
        check("t,\"f(a, b)\",c\n1,2,3\n", "f(a, b) c over time (s) (1.0, 1.0)");
        check("# gathered\nDest; Position\n1; 2\n", "Dest Position over line (0.0, 0.0)");
    }

    #[test]
    fn invalid_tables_are_explained() {
        check("", "there are no numbers in it");
        check("GIF\0", "this is not text");
        check("a,b\n", "there are no numbers in it");
        check("a,b\n1,2\n3\n", "line 3 has 1 columns, the first has 2");
        check("a,b\n1,x\n", "line 2: `x` is not a number");
        check("t,a\n2,1\n1,1\n", "the time goes back after row 1 of the numbers");
        check("t\n2\n", "there is nothing but the time in it");
    }
}
