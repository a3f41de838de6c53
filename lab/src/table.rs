//! Tables as Markdown and CSV.

use std::{fmt::Write, fs, path::Path};

/// Rows of text under a head.
pub struct Table {
    /// Name of its files.
    pub name: String,
    pub head: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(name: &str, head: &[&str]) -> Self {
        Self {
            name: name.to_owned(),
            head: head.iter().map(|&cell| cell.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    pub fn markdown(&self) -> String {
        let mut out = String::new();
        let rule: Vec<String> = self.head.iter().map(|_| "---".to_owned()).collect();
        for row in [&self.head, &rule].into_iter().chain(&self.rows) {
            let _ = writeln!(out, "| {} |", row.join(" | "));
        }
        out
    }

    pub fn csv(&self) -> String {
        let cell = |text: &String| {
            if text.contains([',', '"']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.clone()
            }
        };
        let mut out = String::new();
        for row in [&self.head].into_iter().chain(&self.rows) {
            let cells: Vec<String> = row.iter().map(cell).collect();
            let _ = writeln!(out, "{}", cells.join(","));
        }
        out
    }

    /// Writes both forms into a folder.
    pub fn save(&self, folder: &Path) -> Result<(), String> {
        let write = |ending: &str, text: String| {
            let file = folder.join(format!("{}.{ending}", self.name));
            fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))
        };
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        write("md", self.markdown())?;
        write("csv", self.csv())
    }
}

/// A number with three digits that count.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "–" } else { "∞" }.to_owned();
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1.0e-3..1.0e5).contains(&size) {
        format!("{value:.2e}")
    } else {
        let digits = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.digits$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_head_and_a_line_for_each_row() {
        let mut table = Table::new("t", &["a", "b"]);
        table.rows.push(vec!["1".to_owned(), "x, y".to_owned()]);
        assert_eq!(table.markdown(), "| a | b |\n| --- | --- |\n| 1 | x, y |\n");
        assert_eq!(table.csv(), "a,b\n1,\"x, y\"\n");
    }

    #[test]
    fn numbers_keep_three_digits() {
        assert_eq!(number(0.110_44), "0.110");
        assert_eq!(number(20.387), "20.4");
        assert_eq!(number(33_310.0), "33310");
        assert_eq!(number(1.0e8), "1.00e8");
        assert_eq!(number(0.0), "0");
    }
}
