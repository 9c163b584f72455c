//! A tutorial or how-to page as what it is to its reader: files to write, commands to type, output to see.
//!
//! A remark in HTML before a block says what the block is:
//!
//! | remark | the block below it |
//! |---|---|
//! | `<!-- file: NAME -->` | is the content of a file in the reader's folder |
//! | `<!-- exit: 5 -->` | ends with this exit code; without the remark with 0 |
//! | `<!-- output -->` | is what the commands before it print, see [`agrees`] |
//! | `<!-- needs: python -->` | runs only where SIGNORINI_TOOLS names a folder of programs with it, as in `.ci/run` |
//! | `<!-- not run: REASON -->` | is run by nobody but the reader |
//!
//! `<!-- copy: PATH -->` stands alone: that file of the repository lies in the reader's folder from then on.

/// What a page asks of its reader.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Write a file.
    File { name: String, text: String },
    /// Take a file of the repository.
    Copy(String),
    /// Type commands.
    Commands(Commands),
    /// See these lines.
    Output(String),
}

/// Commands of one block.
#[derive(Clone, Debug, PartialEq)]
pub struct Commands {
    pub text: String,
    pub exit: i32,
    /// A program that not every machine has.
    pub needs: Option<String>,
    /// Why nobody runs it.
    pub not_run: Option<String>,
    pub line: usize,
}

/// Reads a page.
pub fn steps(page: &str) -> Result<Vec<Step>, String> {
    let mut steps = Vec::new();
    let (mut file, mut exit, mut needs, mut not_run, mut is_output) = (None, 0, None, None, false);
    let mut lines = page.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        if let Some(remark) = line
            .strip_prefix("<!-- ")
            .and_then(|rest| rest.strip_suffix(" -->"))
        {
            match remark.split_once(": ").unwrap_or((remark, "")) {
                ("file", name) => file = Some(name.to_string()),
                ("copy", path) => steps.push(Step::Copy(path.to_string())),
                ("exit", code) => {
                    exit = code
                        .parse()
                        .map_err(|_| format!("line {}: {line}", number + 1))?;
                }
                ("needs", program) => needs = Some(program.to_string()),
                ("not run", reason) if !reason.is_empty() => not_run = Some(reason.to_string()),
                ("output", "") => is_output = true,
                _ => {
                    return Err(format!(
                        "line {}: nobody knows the remark {line}",
                        number + 1
                    ));
                }
            }
            continue;
        }
        let Some(language) = line.strip_prefix("```") else {
            continue;
        };
        let block = lines.by_ref().map(|(_, line)| line);
        let text: Vec<&str> = block.take_while(|line| !line.starts_with("```")).collect();
        let text = text.join("\n") + "\n";
        if let Some(name) = file.take() {
            steps.push(Step::File { name, text });
        } else if std::mem::take(&mut is_output) {
            steps.push(Step::Output(text));
        } else if language == "sh" {
            steps.push(Step::Commands(Commands {
                text,
                exit: std::mem::take(&mut exit),
                needs: needs.take(),
                not_run: not_run.take(),
                line: number + 1,
            }));
        }
    }
    Ok(steps)
}

/// Whether the lines of a page are among those that were printed, in their order. Blanks between words do not count, numbers
/// may differ by a hundredth, and `…` stands for any words; alone on its line, for any lines.
pub fn agrees(page: &str, printed: &str) -> Result<(), String> {
    let mut rest = printed.lines();
    for wanted in page.lines().filter(|line| !line.trim().is_empty()) {
        if wanted.trim() == "…" {
            continue;
        }
        let words: Vec<&str> = wanted.split_whitespace().collect();
        if !rest
            .by_ref()
            .any(|line| matches(&words, &line.split_whitespace().collect::<Vec<_>>()))
        {
            return Err(format!("nothing printed reads\n{wanted}\nin\n{printed}"));
        }
    }
    Ok(())
}

fn matches(wanted: &[&str], found: &[&str]) -> bool {
    match (wanted, found) {
        ([], []) => true,
        (["…", after @ ..], _) => (0..=found.len()).any(|skip| matches(after, &found[skip..])),
        ([first, after @ ..], [word, rest @ ..]) => is_same(first, word) && matches(after, rest),
        _ => false,
    }
}

/// Whether two words are the same, or numbers with the same unit and a hundredth between them.
fn is_same(wanted: &str, found: &str) -> bool {
    let number = |word: &str| -> Option<(f64, String)> {
        let edge = |letter: char| !letter.is_ascii_digit() && !"+-.".contains(letter);
        let bare = word.trim_matches(edge);
        let around = word.replacen(bare, "", 1);
        Some((bare.parse().ok()?, around))
    };
    wanted == found
        || match (number(wanted), number(found)) {
            (Some((a, around)), Some((b, other))) => {
                let both_round = a == 0.0 || b == 0.0;
                around == other
                    && ((a - b).abs() <= 0.01 * a.abs().max(b.abs())
                        || both_round && (a - b).abs() < 1e-9)
            }
            _ => false,
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_say_what_blocks_are() {
        let page = "<!-- copy: a/b.msh -->\n<!-- file: x.toml -->\n```toml\na = 1\n```\n<!-- exit: 3 -->\n\
                    ```sh\nsignorini check x.toml\n```\n<!-- output -->\n```text\nhello\n```\n```toml\nb = 2\n```\n";
        let found = steps(page).unwrap();
        assert_eq!(found.len(), 4);
        assert_eq!(found[0], Step::Copy("a/b.msh".to_string()));
        let text = "a = 1\n".to_string();
        assert_eq!(
            found[1],
            Step::File {
                name: "x.toml".to_string(),
                text
            }
        );
        assert!(matches!(&found[2], Step::Commands(commands) if commands.exit == 3));
        assert_eq!(found[3], Step::Output("hello\n".to_string()));
    }

    #[test]
    fn an_unknown_remark_is_refused() {
        assert!(steps("<!-- ouptut -->\n").is_err());
    }

    #[test]
    fn numbers_may_differ_by_a_hundredth_and_no_more() {
        assert!(agrees("F = 17.50 N", "x\nF  =  17.51 N").is_ok());
        assert!(agrees("F = 17.50 N", "F = 18.50 N").is_err());
        assert!(agrees("F = 17.50 N", "F = 17.50 MN").is_err());
        assert!(agrees("(38.8)", "(38.81)").is_ok());
        assert!(agrees("p 1e-3", "p 2e-3").is_err());
    }

    #[test]
    fn lines_come_in_their_order() {
        assert!(agrees("a\nb", "a\nx\nb").is_ok());
        assert!(agrees("a\nb", "b\na").is_err());
    }

    #[test]
    fn dots_stand_for_words_and_lines() {
        assert!(
            agrees(
                "solved: … 3 increments …\n…\nend",
                "solved: in 3 increments, 2 s\nz\nend"
            )
            .is_err()
        );
        assert!(
            agrees(
                "solved: … increments …\n…\nend",
                "solved: 3 increments in 2 s\nz\nend"
            )
            .is_ok()
        );
    }
}
