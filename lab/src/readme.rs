//! Puts a table into a page, between two comments.

use std::{fs, path::Path};

const BEGIN: &str = "<!-- bench:begin -->";
const END: &str = "<!-- bench:end -->";

/// Replaces what stands between the comments.
pub fn replace_table(file: &Path, table: &str) -> Result<(), String> {
    let shown = file.display();
    let page = fs::read_to_string(file).map_err(|error| format!("{shown}: {error}"))?;
    let page =
        splice(&page, table).ok_or_else(|| format!("{shown} has no `{BEGIN}` before `{END}`"))?;
    fs::write(file, page).map_err(|error| format!("{shown}: {error}"))
}

fn splice(page: &str, table: &str) -> Option<String> {
    let begin = page.find(BEGIN)? + BEGIN.len();
    let end = begin + page[begin..].find(END)?;
    Some(format!(
        "{}\n{}\n{}",
        &page[..begin],
        table.trim_end(),
        &page[end..]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_comments_changes() {
        let page = format!("a\n{BEGIN}\nold\n{END}\nb\n");
        let new = splice(&page, "new\n").unwrap_or_default();
        assert_eq!(new, format!("a\n{BEGIN}\nnew\n{END}\nb\n"));
        assert_eq!(splice(&new, "new"), Some(new.clone()));
        assert_eq!(splice("no comments", "new"), None);
    }
}
