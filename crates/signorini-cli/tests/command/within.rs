//! `SIGNORINI_WITHIN`: nothing outside of a folder is read or written, whoever names it.

use super::support::{BRICK, Ended, change, command};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder to stay in, next to files that must not be touched.
struct Yard {
    top: TempDir,
}

/// A mesh that would be read without a complaint.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
    $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

const NODES: &str = "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n";

/// A case over a mesh in a file.
fn over(mesh: &str) -> String {
    format!(
        "[mesh]\nfile = \"{mesh}\"\n[material.a]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\n\
        [[body]]\ngroup = \"all\"\nmaterial = \"a\"\n[[step]]\nname = \"one\"\nfix = [{{ on = \"base\", u = \"all\" }}]\n"
    )
}

impl Yard {
    fn new() -> Self {
        let yard = Self {
            top: tempfile::tempdir().unwrap(),
        };
        fs::create_dir(yard.root()).unwrap();
        fs::write(yard.outside("mesh.msh"), MESH).unwrap();
        fs::write(yard.outside("nodes.txt"), NODES).unwrap();
        fs::write(yard.outside("case.toml"), BRICK).unwrap();
        fs::write(yard.outside("tool.stl"), "solid a\nendsolid a\n").unwrap();
        yard
    }

    fn root(&self) -> PathBuf {
        self.top.path().join("root")
    }

    fn outside(&self, name: &str) -> PathBuf {
        self.top.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> &Self {
        fs::write(self.root().join(name), text).unwrap();
        self
    }

    fn run(&self, arguments: &[&str]) -> Ended {
        let mut command = command(&self.root());
        command.env("SIGNORINI_WITHIN", self.root());
        command.args(arguments).output().unwrap().into()
    }

    /// Asserts that the path was refused by name, and that nothing was made next to the folder.
    #[track_caller]
    fn refuses(&self, arguments: &[&str], code: i32) {
        self.run(arguments).says(code, &["is outside of"]);
        let mut names: Vec<_> = fs::read_dir(self.top.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        let known = ["case.toml", "mesh.msh", "nodes.txt", "root", "tool.stl"];
        assert_eq!(names, known);
    }
}

#[test]
fn a_case_in_the_folder_is_solved_checked_and_resumed_as_without() {
    let yard = Yard::new();
    yard.write("case.toml", BRICK);
    yard.run(&["check", "case.toml"])
        .says(0, &["nothing wrong was found"]);
    yard.run(&["run", "case.toml", "-j", "2"])
        .says(0, &["solved"]);
    yard.run(&["info", "case.out"]).says(0, &["solved"]);
    yard.run(&["resume", "case.out"])
        .says(0, &["nothing is left to do"]);
    let absolute = yard.root().join("case.toml");
    yard.run(&["run", absolute.to_str().unwrap(), "-o", "a/b.out"])
        .says(0, &["solved"]);
}

#[test]
fn a_case_outside_is_refused() {
    let yard = Yard::new();
    let absolute = yard.outside("case.toml");
    for path in ["../case.toml", absolute.to_str().unwrap()] {
        yard.refuses(&["run", path], 3);
        yard.refuses(&["check", path], 3);
    }
    yard.refuses(&["info", "../mesh.msh"], 3);
}

#[test]
fn a_mesh_outside_is_refused_by_path_and_by_set() {
    let yard = Yard::new();
    let absolute = yard.outside("mesh.msh");
    for mesh in ["../mesh.msh", absolute.to_str().unwrap()] {
        yard.write("case.toml", &over(mesh));
        yard.refuses(&["check", "case.toml"], 3);
        yard.write("case.toml", &over("none.msh"));
        let file = format!("--set=mesh.file={mesh}");
        yard.refuses(&["run", "case.toml", &file], 3);
        let whole = format!("--set=mesh={{ file = \"{mesh}\" }}");
        yard.refuses(&["run", "case.toml", &whole], 3);
    }
}

#[test]
fn triangles_outside_are_refused() {
    let yard = Yard::new();
    let surface = "[[surface]]\nname = \"die\"\nshape = { stl = \"../tool.stl\" }\n[[step]]";
    yard.write("case.toml", &change(BRICK, "[[step]]", surface));
    yard.refuses(&["check", "case.toml"], 3);
}

#[test]
fn files_outside_that_decks_include_are_refused() {
    let yard = Yard::new();
    yard.write("a.inp", "*HEADING\n*INCLUDE, INPUT=../nodes.txt\n");
    yard.refuses(&["check", "a.inp"], 3);
    yard.write("b.inp", "*NODE, INPUT=../nodes.txt\n");
    yard.refuses(&["check", "b.inp"], 3);
    yard.write("c.in", "out\ntitle\n@include ../nodes.txt\n");
    yard.refuses(&["check", "c.in"], 3);
    yard.write("inner.inc", "*NODE, NSET=a, INPUT=../nodes.txt\n");
    yard.write("d.inp", "*INCLUDE, INPUT=inner.inc\n");
    yard.refuses(&["check", "d.inp"], 3);
    yard.write("e.toml", &over("a.inp"));
    yard.refuses(&["check", "e.toml"], 3);
}

#[test]
fn results_are_not_written_outside() {
    let yard = Yard::new();
    yard.write("case.toml", BRICK);
    let absolute = yard.outside("new.out");
    for folder in ["../new.out", absolute.to_str().unwrap()] {
        yard.refuses(&["run", "case.toml", "-o", folder], 6);
        yard.refuses(&["check", "case.toml", "-o", folder], 6);
    }
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_outside() {
    use std::os::unix::fs::symlink;
    let yard = Yard::new();
    yard.write("case.toml", BRICK);
    symlink(yard.top.path(), yard.root().join("up")).unwrap();
    symlink(yard.outside("case.toml"), yard.root().join("link.toml")).unwrap();
    symlink(yard.outside("new.out"), yard.root().join("case.out")).unwrap();
    yard.refuses(&["run", "up/case.toml"], 3);
    yard.refuses(&["run", "link.toml"], 3);
    yard.refuses(&["run", "case.toml"], 6);
    yard.refuses(&["run", "case.toml", "-o", "up/new.out"], 6);
    yard.write("over.toml", &over("up/mesh.msh"));
    yard.refuses(&["check", "over.toml"], 3);
}

#[test]
fn a_record_that_names_a_place_outside_resumes_nothing_there() {
    let yard = Yard::new();
    yard.write("mesh.msh", MESH);
    yard.write("case.toml", BRICK);
    yard.run(&["run", "case.toml"]).says(0, &["solved"]);
    let folder = yard.root().join("case.out");
    fs::remove_file(folder.join("summary.json")).unwrap();
    // the same case over a mesh in a file, said to come from the folder above
    let text = over("mesh.msh");
    fs::write(folder.join("checkpoint/case.toml"), &text).unwrap();
    let record = folder.join("checkpoint/run.json");
    let mut owner: serde_json::Value = serde_json::from_slice(&fs::read(&record).unwrap()).unwrap();
    owner["case"] = yard.outside("case.toml").to_str().unwrap().into();
    owner["sha256"] = hash(&text).into();
    fs::write(&record, owner.to_string()).unwrap();
    yard.refuses(&["resume", "case.out"], 3);
}

/// What the command calls the hash of a text.
fn hash(text: &str) -> String {
    use sha2::{Digest, Sha256};
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn a_folder_that_does_not_exist_is_an_error_of_the_command_line() {
    let yard = Yard::new();
    let mut command = command(&yard.root());
    command.env("SIGNORINI_WITHIN", "no such folder");
    let ended: Ended = command.args(["explain"]).output().unwrap().into();
    ended.says(2, &["SIGNORINI_WITHIN", "no such folder"]);
}
