use super::*;

/// A repository of a few files.
fn facts() -> Facts {
    let mut symbols = Symbols::default();
    let source = "pub trait Term { fn converged(&self); }\npub const SOLVERS: u8 = 0;\nfn f() { g(\"results.pvd\", \"force_x\"); }\n";
    let source_path = "crates/mechanics/src/system/term.rs";
    symbols.add_rust(Path::new(source_path), source).unwrap();
    let mut program = Program::default();
    program.add(
        "run",
        "Solve\n\nOptions:\n  -o, --output <DIR>\n      --set <KEY=VALUE>  Change\n",
    );
    let metadata = serde_json::json!({ "packages": [{
        "name": "signorini",
        "features": { "mumps": [] },
        "targets": [{ "name": "decks", "kind": ["test"] }, { "name": "signorini", "kind": ["bin"] }],
    }] });
    Facts {
        tree: Tree::of(&[
            "README.md",
            "docs/a.md",
            "scripts/draw.py",
            "examples/one/case.toml",
            "examples/one/one.geo",
            source_path,
        ]),
        program,
        packages: Packages::new(&metadata),
        scripts: vec![Script {
            path: PathBuf::from("scripts/draw.py"),
            text: "parser.add_argument(\"--wide\")".to_string(),
        }],
        keys: keys::tests::sample(),
        symbols,
    }
}

fn faults_in(facts: &Facts, source: &str) -> Vec<String> {
    let pages = [
        markdown::page(PathBuf::from("README.md"), source),
        markdown::page(PathBuf::from("docs/a.md"), "# A heading\n"),
    ];
    judge(&pages, facts)
        .iter()
        .map(ToString::to_string)
        .collect()
}

/// Each of these pages passes.
fn pass(sources: &[&str]) {
    for source in sources {
        assert_eq!(faults_in(&facts(), source), [""; 0], "{source}");
    }
}

/// Each of these pages has one fault.
fn fail(sources: &[&str]) {
    for source in sources {
        assert_eq!(
            faults_in(&facts(), source).len(),
            1,
            "{source}: {:?}",
            faults_in(&facts(), source)
        );
    }
}

#[test]
fn links_lead_to_files_and_headings() {
    pass(&[
        "[a](docs/a.md)",
        "[a](docs/a.md#a-heading)",
        "# Own one\n[a](#own-one)",
        "[a](https://example.org/x)",
        "[a]\n\n[a]: docs/",
    ]);
    fail(&[
        "[a](docs/b.md)",
        "![a](docs/b.png)",
        "[a](docs/a.md#lost)",
        "[a](#lost)",
        "text\n\n[b]: docs/b.md",
    ]);
}

#[test]
fn paths_exist_or_are_written_by_the_program() {
    pass(&[
        "`docs/a.md`",
        "`term.rs`",
        "`system/`",
        "`crates/NAME/src`",
        "`results.pvd`",
        "`case.out/results.pvd`",
        "`job.inp`",
    ]);
    fail(&[
        "`docs/b.md`",
        "`terms.rs`",
        "`systems/`",
        "`crates/io/`",
        "`result.pvd`",
        "`case.out/result.pvd`",
        "`strange.inp`",
    ]);
}

#[test]
fn commands_have_their_subcommands_options_and_files() {
    let block = |text: &str| format!("```sh\n{text}\n```");
    for good in [
        "signorini run examples/one/case.toml -o DIR --set material.rubber.E=8   # a remark",
        "cargo run --release -- run my.toml --output x",
        "SIGNORINI_LONG=1 cargo test --release -p signorini --features mumps --test decks -- --nocapture",
        "cargo test --workspace term::",
        "cargo xtask docs",
        "python scripts/draw.py --wide out.png && gmsh -2 examples/one/one.geo",
    ] {
        pass(&[&block(good)]);
    }
    for bad in [
        "signorini solve case.toml",
        "signorini run --outputs x case.toml",
        "signorini run examples/two/case.toml",
        "signorini run case.toml --set material.rubber.modulus=8",
        "cargo run --release -- solve case.toml",
        "cargo test -p signorini-old",
        "cargo test -p signorini --test gone",
        "cargo test -p signorini --features gone",
        "cargo test --workspace solver::",
        "cargo test --realease",
        "cargo xtask doc",
        "cargo teach",
        "python scripts/gone.py",
        "python scripts/draw.py --narrow",
        "gmsh -2 two.geo",
        "make all",
        "signorini run 'case.toml",
    ] {
        fail(&[&block(bad)]);
    }
    pass(&[
        "```console\n$ signorini run case.toml\nsome output\n```",
        "`--set material.any.E=1`",
        "`-o DIR`",
        "`--wide`",
    ]);
    fail(&[
        "```console\n$ signorini solve case.toml\n```",
        "`--wider`",
        "`signorini solve`",
        "```\nsignorini run case.toml\n```",
    ]);
}

#[test]
fn keys_of_cases_are_in_the_vocabulary() {
    pass(&[
        "```toml\n[[contact]]\nmethod = \"mortar\"\n```",
        "`[[contact]]`",
        "`[contact] method = \"auto\"`",
        "`enforcement = { penalty = 1e4 }`",
        "`{ penalty = 2 }`",
        "`method`",
        "`\"mortar\"`",
        "`material.rubber.E`",
        "`tip.force_x`",
        "`g = 0`",
    ]);
    fail(&[
        "```toml\n[[contact]]\nmetod = \"mortar\"\n```",
        "```toml\nformat = 1\n```",
        "`[[contacts]]`",
        "`[contact] method = \"nts\"`",
        "`enforcement = { stiffness = 1e4 }`",
        "`{ stiffness = 2 }`",
        "`metod = \"mortar\"`",
        "`metod`",
        "`\"nts\"`",
        "`material.rubber.modulus`",
        "`tip.force_sum`",
    ]);
}

#[test]
fn symbols_are_defined() {
    pass(&[
        "`Term`",
        "`Term::converged`",
        "`SOLVERS`",
        "`system::term`",
        "`converged()`",
        "`a < b`",
        "`M/h`",
        "`K_n`",
    ]);
    fail(&[
        "`Terms`",
        "`Term::verdict`",
        "`LAWS`",
        "`solve::term`",
        "`verdict()`",
    ]);
}

#[test]
fn faults_are_all_listed_with_their_lines() {
    let found = faults_in(
        &facts(),
        "`gone.rs`\n\n```toml\n[[contact]]\nmetod = 1\n```\n",
    );
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("README.md:1: `gone.rs`"), "{found:?}");
    assert!(
        found[1].starts_with("README.md:5: a case has no key `metod`"),
        "{found:?}"
    );
}

#[test]
fn a_deleted_file_and_a_renamed_key_are_missed() {
    let page = "[a](docs/a.md) and `method = \"mortar\"`";
    let mut facts = facts();
    assert_eq!(faults_in(&facts, page), [""; 0]);
    facts.tree = Tree::of(&["README.md"]);
    assert_eq!(faults_in(&facts, page).len(), 1);
    facts.keys = Keys::new(
        serde_json::json!({ "type": "object", "properties": { "way": { "enum": ["mortar"] } } }),
    );
    assert_eq!(faults_in(&facts, page).len(), 2);
}

#[test]
fn the_fragments_of_the_list_of_changes_are_no_pages() {
    assert!(is_page(Path::new("changes/README.md")) && is_page(Path::new("docs/a.md")));
    assert!(!is_page(Path::new("changes/0001-a.md")) && !is_page(Path::new("docs/a.png")));
}
