//! Puts a table into a page, between two comments.

use std::{fs, path::Path};

/// Replaces what stands between the comments of this name.
pub fn replace_table(file: &Path, name: &str, table: &str) -> Result<(), String> {
    let shown = file.display();
    let page = fs::read_to_string(file).map_err(|error| format!("{shown}: {error}"))?;
    let page = splice(&page, name, table)
        .ok_or_else(|| format!("{shown} has no `{}` before `{}`", begin(name), end(name)))?;
    fs::write(file, page).map_err(|error| format!("{shown}: {error}"))
}

fn begin(name: &str) -> String {
    format!("<!-- {name}:begin -->")
}

fn end(name: &str) -> String {
    format!("<!-- {name}:end -->")
}

fn splice(page: &str, name: &str, table: &str) -> Option<String> {
    let (open, close) = (begin(name), end(name));
    let from = page.find(&open)? + open.len();
    let to = from + page[from..].find(&close)?;
    Some(format!(
        "{}\n{}\n{}",
        &page[..from],
        table.trim_end(),
        &page[to..]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_comments_of_the_name_changes() {
        let other = "<!-- b:begin -->\nother\n<!-- b:end -->";
        let page = format!("a\n{other}\n<!-- a:begin -->\nold\n<!-- a:end -->\nb\n");
        let new = splice(&page, "a", "new\n").unwrap_or_default();
        assert_eq!(
            new,
            format!("a\n{other}\n<!-- a:begin -->\nnew\n<!-- a:end -->\nb\n")
        );
        assert_eq!(splice(&new, "a", "new"), Some(new.clone()));
        assert_eq!(splice("no comments", "a", "new"), None);
    }
}
