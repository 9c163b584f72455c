//! `docs/messages.md` compared with the codes of messages; SIGNORINI_BLESS writes it.

use crate::compare;
use signorini_io::diagnostic::codes::{ALL, Class, Code};
use std::fmt::Write as _;

const HEAD: &str = "# Messages

Every message carries a code. `signorini explain S0501` prints what this page says about one; the last column of the table
is the exit code of a run that ends on it as an error. Many codes are warnings or notes, too, and then end nothing; the key
`allow` of a case silences warnings by their code.

Written from the codes of the program by a test, which fails where the two differ.
";

const GROUPS: [(&str, &str); 9] = [
    ("S01", "The text of a case or deck"),
    ("S02", "References and meshes"),
    ("S03", "The model as a whole"),
    ("S04", "Plausibility"),
    ("S05", "The course of a solution"),
    ("S06", "Writing results"),
    ("S07", "Going on with a run"),
    ("S08", "Limits"),
    ("S09", "Several processes"),
];

/// Text of a message as Markdown: placeholders between angle brackets are no tags, asterisks no emphasis.
fn plain(text: &str) -> String {
    let mut out = String::new();
    for (number, part) in text.split('`').enumerate() {
        if number > 0 {
            out.push('`');
        }
        if number % 2 == 1 {
            out.push_str(part);
            continue;
        }
        for letter in part.chars() {
            if "<>*_[]$|".contains(letter) {
                out.push('\\');
            }
            out.push(letter);
        }
    }
    out
}

fn exit_code(code: &Code) -> u8 {
    let class: Class = code.class;
    class.exit_code()
}

fn written() -> String {
    let mut out = HEAD.to_string();
    out.push_str("\n| code | message | exit code |\n|---|---|---|\n");
    for code in ALL {
        let anchor = code.id.to_lowercase();
        writeln!(
            out,
            "| [{}](#{anchor}) | {} | {} |",
            code.id,
            plain(code.title),
            exit_code(code)
        )
        .unwrap();
    }
    for (head, title) in GROUPS {
        writeln!(out, "\n## {title}").unwrap();
        for code in ALL.iter().filter(|code| code.id.starts_with(head)) {
            writeln!(
                out,
                "\n### {}\n\n*{}.* {}",
                code.id,
                plain(code.title),
                plain(code.meaning)
            )
            .unwrap();
            for (heading, lines) in [
                ("Possible reasons", code.reasons),
                ("What to do", code.remedies),
            ] {
                if !lines.is_empty() {
                    writeln!(out, "\n{heading}:\n").unwrap();
                }
                for line in lines {
                    writeln!(out, "* {}", plain(line)).unwrap();
                }
            }
        }
    }
    out
}

#[test]
fn the_page_of_messages_is_what_the_codes_say() {
    compare("messages.md", &written());
}

#[test]
fn every_code_belongs_to_a_group_of_the_page() {
    let page = written();
    for code in ALL {
        assert!(
            page.contains(&format!("\n### {}\n", code.id)),
            "{}",
            code.id
        );
    }
}
