//! Formulas in LaTeX as MathML, which browsers draw without a script.

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};

/// A formula as one line of HTML that may stand in Markdown.
///
/// # Errors
/// What the parser says of a formula that it cannot read.
pub fn mathml(latex: &str, is_display: bool) -> Result<String, String> {
    let (latex, tag) = without_tag(latex);
    let html = rendered(latex, is_display)?;
    Ok(match tag {
        Some(tag) => format!(
            "<span class=\"equation\">{html}<span>({})</span></span>",
            quiet(tag)
        ),
        None => html,
    })
}

/// A formula without the number that it ends with, which the parser does not know, and that number.
fn without_tag(latex: &str) -> (&str, Option<&str>) {
    let latex = latex.trim_end();
    let split = latex
        .strip_suffix('}')
        .and_then(|inner| inner.rsplit_once("\\tag{"))
        .filter(|(_, tag)| !tag.contains(['{', '}']));
    split.map_or((latex, None), |(latex, tag)| (latex, Some(tag)))
}

fn rendered(latex: &str, is_display: bool) -> Result<String, String> {
    let latex = &with_greek_mu(latex);
    let storage = Storage::new();
    if let Some(error) = Parser::new(latex, &storage).find_map(Result::err) {
        let text = error.to_string();
        return Err(text.lines().next().unwrap_or_default().to_string());
    }
    let storage = Storage::new();
    let config = RenderConfig {
        display_mode: if is_display {
            DisplayMode::Block
        } else {
            DisplayMode::Inline
        },
        ..RenderConfig::default()
    };
    let mut out = String::new();
    push_mathml(&mut out, Parser::new(latex, &storage), config)
        .map_err(|error| error.to_string())?;
    Ok(quiet(&out))
}

/// A formula with the letter for `\mu`, for which the parser takes the sign of micro, which has no italic and no bold.
fn with_greek_mu(latex: &str) -> String {
    let mut out = String::new();
    let mut parts = latex.split("\\mu");
    out.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let is_longer = part.starts_with(|letter: char| letter.is_ascii_alphabetic());
        out.push_str(if is_longer { "\\mu" } else { "{\u{3bc}}" });
        out.push_str(part);
    }
    out
}

/// The same HTML on one line, with everything between tags written such that Markdown has nothing to say about it.
fn quiet(html: &str) -> String {
    let mut out = String::with_capacity(html.len());
    let mut is_tag = false;
    // a space that the parser writes as an entity, and its writer escapes
    let html = html.replace("&amp;nbsp;", "\u{2004}");
    for letter in html.replace("&nbsp;", "\u{2004}").chars() {
        match letter {
            '<' => is_tag = true,
            '>' => is_tag = false,
            _ => {}
        }
        match letter {
            '\n' | '\r' => out.push(' '),
            '*' | '_' | '`' | '[' | ']' | '|' | '\\' | '~' | '$' | '#' | '!' | '^' if !is_tag => {
                out.push_str(&format!("&#{};", u32::from(letter)));
            }
            _ => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fraction_becomes_mathml_on_one_line() {
        let html = mathml("p = \\frac{3F}{2\\pi a^2}", true).unwrap();
        assert!(
            html.starts_with("<math") && html.ends_with("</math>"),
            "{html}"
        );
        assert!(
            html.contains("<mfrac>") && html.contains("display=\"block\""),
            "{html}"
        );
        assert!(!html.contains('\n'), "{html}");
    }

    #[test]
    fn the_number_of_an_equation_stands_next_to_it() {
        let html = mathml("a = b \\tag{E1}", true).unwrap();
        assert!(html.ends_with("</math><span>(E1)</span></span>"), "{html}");
    }

    #[test]
    fn mu_is_a_greek_letter() {
        let html = mathml("\\mu p + \\boldsymbol\\mu", false).unwrap();
        assert!(
            html.contains('\u{3bc}') || html.contains('\u{1d707}'),
            "{html}"
        );
        assert!(
            html.contains('\u{1d741}') && !html.contains('\u{b5}'),
            "{html}"
        );
    }

    #[test]
    fn nothing_between_tags_is_markdown() {
        let html = mathml("a * b \\mid c\\ d", false).unwrap();
        assert!(
            !html.contains(['*', '|']) && !html.contains("&nbsp;"),
            "{html}"
        );
    }

    #[test]
    fn what_is_no_formula_is_an_error() {
        for latex in ["\\frac{1", "\\nosuchcommand x", "a_{b"] {
            assert!(mathml(latex, false).is_err(), "{latex}");
        }
    }
}
