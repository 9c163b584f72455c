//! The page of the manual that lists which choices combine, from what the program accepts and refuses.

use super::common::repository;
use super::scene::{Below, Choice, LAWS, METHODS, Refusal, SURFACES, Scene};
use std::fmt::Write;

const HEAD: &str = "# What goes with what

Every way to compare two sides, every law, every kind of facet and every surface, with friction and without: `+` is
solved, a number is the reason why the program refuses it. The tests of `crates/signorini/tests/methods` press and slide
a block by every way with a `+`, but for contact of a surface with itself.
[contact.md](contact.md) explains the keys. Written by

```sh
SIGNORINI_BLESS=1 cargo test --release -p signorini --test methods page
```
";

/// Facets of the elements.
const ELEMENTS: [(&str, &str); 12] = [
    ("tri3", "line2"),
    ("quad4", "line2"),
    ("tri6", "line3"),
    ("quad8", "line3"),
    ("tet4", "tri3"),
    ("wedge6", "tri3, quad4"),
    ("hex8", "quad4"),
    ("tet10", "tri6"),
    ("wedge15", "tri6, quad8"),
    ("hex20", "quad8"),
    ("hex27", "quad9"),
    ("quad9", "line3"),
];

/// The reasons so far; their places are their numbers.
#[derive(Default)]
struct Reasons(Vec<Refusal>);

impl Reasons {
    /// How a cell of a table shows what becomes of a scene; with friction and without, in the plane and in space the
    /// same.
    fn cell(&mut self, scene: &Scene, elements: &[&'static str]) -> String {
        let all = match scene.keys {
            "" => vec!["", "friction = 0.2"],
            keys => vec![keys],
        };
        let ways = elements.iter().flat_map(|&element| {
            let of = |keys: &&'static str| Scene {
                element,
                keys,
                ..*scene
            };
            all.iter().map(of).collect::<Vec<_>>()
        });
        let found: Vec<Option<Refusal>> = ways.map(|scene| scene.model().err()).collect();
        let first = found[0].clone();
        assert!(found.iter().all(|f| *f == first), "{scene:?}: {found:?}");
        first.map_or("+".into(), |refusal| self.number(refusal))
    }

    fn number(&mut self, refusal: Refusal) -> String {
        let place = self.0.iter().position(|r| *r == refusal);
        let place = place.unwrap_or_else(|| {
            self.0.push(refusal);
            self.0.len() - 1
        });
        (place + 1).to_string()
    }
}

fn row(page: &mut String, cells: &[String]) {
    writeln!(page, "| {} |", cells.join(" | ")).unwrap();
}

fn heading(page: &mut String, first: &str, rest: &[&str]) {
    writeln!(page, "| {first} | {} |", rest.join(" | ")).unwrap();
    writeln!(page, "|---|{}", "---|".repeat(rest.len())).unwrap();
}

/// Methods by laws.
fn laws(page: &mut String, reasons: &mut Reasons, below: Below, keys: &'static str) {
    heading(page, "", &LAWS.map(|l| l.0));
    for (name, method) in METHODS {
        let mut cells = vec![name.to_owned()];
        for (_, law) in LAWS {
            let scene = Scene {
                element: "quad4",
                below,
                method,
                law,
                keys,
            };
            cells.push(reasons.cell(&scene, &["quad4", "hex8"]));
        }
        row(page, &cells);
    }
}

/// Surfaces by methods.
fn surfaces(page: &mut String, reasons: &mut Reasons, element: &'static str) {
    let shown: Vec<Choice> = METHODS.into_iter().filter(|m| m.0 != "auto").collect();
    let names: Vec<&str> = shown.iter().map(|m| m.0).collect();
    heading(page, "", &names);
    for (n, (name, ..)) in SURFACES.iter().enumerate() {
        let mut cells = vec![format!("`{name}`")];
        for (_, method) in &shown {
            let scene = Scene {
                element,
                below: Below::Surface(n),
                method,
                law: LAWS[3].1,
                keys: "",
            };
            cells.push(reasons.cell(&scene, &[element]));
        }
        row(page, &cells);
    }
}

fn page() -> String {
    let mut page = String::from(HEAD);
    let mut reasons = Reasons::default();
    page.push_str("\n## Two bodies that touch\n\nIn the plane and in space, with Coulomb's friction and without.\n\n");
    laws(&mut page, &mut reasons, Below::Block, "");
    page.push_str("\n## Two bodies that are joined (`tied = true`)\n\n");
    laws(&mut page, &mut reasons, Below::Block, "tied = true");
    page.push_str("\n## A surface that touches itself (`primary = \"self\"`)\n\n");
    laws(&mut page, &mut reasons, Below::Itself, "");
    page.push_str("\n## Surfaces without a mesh, in the plane\n\nWith a penalty; other laws as above. A signed distance by closures belongs to the library and acts as they do.\n\n");
    surfaces(&mut page, &mut reasons, "quad4");
    page.push_str("\n## Surfaces without a mesh, in space\n\n");
    surfaces(&mut page, &mut reasons, "hex8");
    page.push_str("\n## Elements, their facets, and the method that `auto` takes\n\n");
    heading(
        &mut page,
        "element",
        &["facets", "with penalties", "with multipliers"],
    );
    for (element, facets) in ELEMENTS {
        let mut cells = vec![element.to_owned(), facets.to_owned()];
        for law in [LAWS[3].1, LAWS[0].1] {
            let scene = Scene {
                element,
                below: Below::Block,
                method: METHODS[0].1,
                law,
                keys: "",
            };
            cells.push(match scene.model() {
                Ok(model) => model.contacts[0].method.to_owned(),
                Err(refusal) => reasons.number(refusal),
            });
        }
        row(&mut page, &cells);
    }
    page.push_str("\n## Reasons\n\n");
    for (n, reason) in reasons.0.iter().enumerate() {
        writeln!(
            page,
            "{}. {}: {}. *{}.*",
            n + 1,
            reason.code,
            reason.message,
            reason.advice
        )
        .unwrap();
    }
    page
}

/// Compares with the page in the repository, or writes it again.
pub fn check() {
    let path = repository().join("docs/methods.md");
    let page = page();
    if std::env::var_os("SIGNORINI_BLESS").is_some() {
        std::fs::write(path, page).unwrap();
        return;
    }
    let written = std::fs::read_to_string(path).unwrap();
    assert_eq!(
        page, written,
        "write it anew: SIGNORINI_BLESS=1 cargo test --release -p signorini --test methods page"
    );
}
