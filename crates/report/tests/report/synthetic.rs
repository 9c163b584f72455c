//! Results that no run has written: two blocks in contact, as fine as a test wants.

use signorini_io::fs::{Fs, MemoryFs};
use signorini_io::writers::json::{
    AuditEntry, ContactSummary, Expectation, Input, StepSummary, Summary,
};
use signorini_io::writers::pvd::Pvd;
use signorini_io::writers::vtu::{self, Fact, FactValue, Field, Grid, Options, Values};
use std::path::{Path, PathBuf};

/// The folder of the results.
pub const FOLDER: &str = "made-up.out";

/// Two layers of hexahedra, each of `n × n` cells, or one layer of quadrilaterals in the plane.
pub struct Blocks {
    pub n: usize,
    pub plane: bool,
}

impl Blocks {
    fn layers(&self) -> &[f64] {
        if self.plane {
            &[0.0]
        } else {
            &[0.0, 1.0, 1.0, 2.0]
        }
    }

    pub fn points(&self) -> Vec<[f64; 3]> {
        let step = 1.0 / self.n as f64;
        let mut points = Vec::new();
        for z in self.layers() {
            for j in 0..=self.n {
                points.extend((0..=self.n).map(|i| [i as f64 * step, j as f64 * step, *z]));
            }
        }
        points
    }

    /// Node `i`, `j` of a layer.
    fn node(&self, layer: usize, i: usize, j: usize) -> u32 {
        let row = self.n + 1;
        (layer * row * row + j * row + i) as u32
    }

    fn quad(&self, layer: usize, i: usize, j: usize) -> [u32; 4] {
        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| self.node(layer, i, j))
    }

    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let n = self.n;
        (0..n * n).map(move |k| (k % n, k / n))
    }

    /// The bytes of a frame of the solids.
    pub fn volume(&self, time: f64) -> Vec<u8> {
        let points = self.points();
        let mut connectivity = Vec::new();
        let lower: &[usize] = if self.plane { &[0] } else { &[0, 2] };
        for &layer in lower {
            for (i, j) in self.places() {
                connectivity.extend(self.quad(layer, i, j));
                if !self.plane {
                    connectivity.extend(self.quad(layer + 1, i, j));
                }
            }
        }
        let nnode = if self.plane { 4 } else { 8 };
        let ncell = connectivity.len() / nnode;
        let offsets: Vec<usize> = (0..=ncell).map(|k| k * nnode).collect();
        let types = vec![if self.plane { 9 } else { 12 }; ncell];
        let moved: Vec<[f64; 3]> = points
            .iter()
            .map(|x| [0.0, 0.0, -0.1 * time * x[2]])
            .collect();
        let stress: Vec<f64> = points
            .iter()
            .map(|x| time * (3.0 + (20.0 * x[0]).sin()))
            .collect();
        let ids: Vec<i64> = (1..=points.len() as i64).collect();
        let fields = [
            Field::new("displacement", Values::Vector(&moved)),
            Field::new("reaction_force", Values::Vector(&moved)),
            Field::new("von_mises", Values::Scalar(&stress)),
            Field::new("node_id", Values::Int64(&ids)),
        ];
        encode(&points, &types, &offsets, &connectivity, &fields, time)
    }

    /// The bytes of a frame of the contact: the lower side of the upper block.
    pub fn contact(&self, time: f64) -> Vec<u8> {
        let row = self.n + 1;
        let first = 2 * row * row;
        let points: Vec<[f64; 3]> = self
            .points()
            .into_iter()
            .skip(first)
            .take(row * row)
            .collect();
        let facets = self.places().flat_map(|(i, j)| self.quad(0, i, j));
        let connectivity: Vec<u32> = facets.collect();
        let ncell = self.n * self.n;
        let offsets: Vec<usize> = (0..=ncell).map(|k| 4 * k).collect();
        let moved: Vec<[f64; 3]> = points.iter().map(|_| [0.0, 0.0, -0.1 * time]).collect();
        let pressure: Vec<f64> = points
            .iter()
            .map(|x| time * (x[0] - 0.5).max(0.0))
            .collect();
        let gap: Vec<f64> = points.iter().map(|x| 0.001 - 0.002 * x[0] * time).collect();
        let status: Vec<i8> = pressure
            .iter()
            .map(|p| if *p > 0.0 { 2 } else { 0 })
            .collect();
        let ids: Vec<i64> = (0..points.len()).map(|k| (first + k + 1) as i64).collect();
        let pairs = vec![0; points.len()];
        let fields = [
            Field::new("displacement", Values::Vector(&moved)),
            Field::new("contact_gap", Values::Scalar(&gap)),
            Field::new("contact_pressure", Values::Scalar(&pressure)),
            Field::new("contact_pressure_max", Values::Scalar(&pressure)),
            Field::new("contact_status", Values::Int8(&status)),
            Field::new("contact_pair", Values::Int32(&pairs)),
            Field::new("node_id", Values::Int64(&ids)),
        ];
        encode(
            &points,
            &vec![9; ncell],
            &offsets,
            &connectivity,
            &fields,
            time,
        )
    }
}

fn encode(
    points: &[[f64; 3]],
    types: &[u8],
    offsets: &[usize],
    connectivity: &[u32],
    fields: &[Field<'_>],
    time: f64,
) -> Vec<u8> {
    let grid = Grid {
        points,
        types,
        offsets,
        connectivity,
        point_data: fields,
        cell_data: &[],
        facts: &[Fact {
            name: "TimeValue",
            value: FactValue::Real(&[time]),
        }],
    };
    vtu::encode(&grid, &Options::default()).unwrap()
}

/// A file of the folder.
pub fn file(name: &str) -> PathBuf {
    Path::new(FOLDER).join(name)
}

/// Writes so many frames and the lists of them.
pub fn write_frames(fs: &MemoryFs, blocks: &Blocks, count: usize) {
    let mut lists = [
        Pvd::new(&file("results.pvd")),
        Pvd::new(&file("contact.pvd")),
    ];
    for k in 0..count {
        let time = k as f64 / (count.max(2) - 1) as f64;
        let names = [
            format!("frames/volume_{k:04}.vtu"),
            format!("frames/contact_{k:04}.vtu"),
        ];
        fs.write(&file(&names[0]), &blocks.volume(time)).unwrap();
        lists[0].add(fs, time, &[&names[0]]).unwrap();
        if !blocks.plane {
            fs.write(&file(&names[1]), &blocks.contact(time)).unwrap();
            lists[1].add(fs, time, &[&names[1]]).unwrap();
        }
    }
}

/// The summary of a solved run.
pub fn summary() -> Summary {
    let contact = ContactSummary {
        force: [1.0 / 3.0, -2.5e-17, 32.15563034983922],
        moment: [14.455803409659753, -0.1, 1e-9],
        pressure_max: 0.5,
        gap_min: -0.001,
        area_open: 0.5,
        area_slip: 0.5,
        imbalance_force: 1e-16,
        ..ContactSummary::default()
    };
    let entry = AuditEntry {
        passed: true,
        part: 0.1,
        limit: 0.7,
        ..AuditEntry::default()
    };
    let mut summary = Summary {
        status: "solved".into(),
        steps: vec![StepSummary {
            name: "press".into(),
            increments: 2,
            iterations: 7,
            cutbacks: 1,
            ..StepSummary::default()
        }],
        expectations: vec![Expectation {
            what: "foot.pressure_max".into(),
            value: 0.5,
            got: 0.5,
            ok: true,
        }],
        work_external: 0.00011567142010628889,
        memory_peak_bytes: 12_345_678,
        unknowns: 54,
        version: "0.1.0".into(),
        inputs: vec![Input {
            path: "case.toml".into(),
            sha256: "ab".repeat(32),
        }],
        ..Summary::default()
    };
    summary.contacts.insert("foot".into(), contact);
    summary.audit.passed = true;
    let checks = summary.audit.contacts.entry("foot".into()).or_default();
    checks.insert("stress".into(), entry);
    summary.time.insert("total".into(), 1.5);
    summary
}

/// The history of the solved run.
pub const HISTORY: &str = "time,step,increment,iterations,foot.force_x,foot.force_y,foot.force_z,foot.pressure_max,foot.gap_min,foot.slip_max,foot.area_open,foot.area_stick,foot.area_slip,foot.work_friction\n\
    0.5,press,1,4,0.1,0.0,10.0,0.7,-0.0005,0.01,0.5,0.0,0.5,0.001\n\
    1.0,press,2,3,0.3333333333333333,0.0,32.15563034983922,0.5,-0.001,0.02,0.5,0.0,0.5,0.002\n";

/// A complete folder with three frames.
pub fn complete() -> MemoryFs {
    let fs = MemoryFs::default();
    let text = |name: &str, text: &str| fs.write(&file(name), text.as_bytes()).unwrap();
    summary().write(&fs, &file("summary.json")).unwrap();
    text("history.csv", HISTORY);
    text(
        "convergence.csv",
        "step,increment,attempt,iteration,residual,correction,line_search,closed,flips,worst_node\n\
         press,1,1,1,2.0,0.0,1.0,4,4,\npress,1,1,2,1e-9,0.1,1.0,4,0,5\n",
    );
    text(
        "events.jsonl",
        "{\"v\":1,\"ev\":\"start\",\"case\":\"case\",\"title\":\"T\",\"version\":\"0.1.0\",\"threads\":2,\"nodes\":36,\"elements\":8,\"unknowns\":54}\n\
         {\"v\":1,\"ev\":\"cutback\",\"step\":\"press\",\"inc\":1,\"att\":1,\"time\":0.0,\"size\":0.5,\"why\":\"no convergence\"}\n{\"torn",
    );
    text(
        "case.resolved.toml",
        "title = \"Two blocks <of> 1/2\"\nunits = \"mm-N-MPa\"\n[model]\nspace = \"3d\"\n\
         [material.steel]\nmodel = \"linear-elastic\"\nE = 210e3\nnu = 0.3\n\
         [[body]]\ngroup = [\"upper\"]\nmaterial = \"steel\"\nintegration = \"full\"\nlocking = \"none\"\n\
         [[contact]]\nname = \"foot\"\nsecondary = \"a\"\nprimary = \"b\"\nmethod = \"mortar\"\nfriction = { mu = 0.3 }\nenforcement = { lagrange = {} }\nsliding = \"finite\"\n\
         [[step]]\nname = \"press\"\nkind = \"static\"\ngeometry = \"linear\"\nduration = 1.0\nincrements = 2\n\
         [[step.fix]]\non = \"base\"\nu = [\"x\", \"y\"]\n[[step.move]]\non = \"top\"\nuz = -0.1\n[[step.load]]\non = \"side\"\nforce = [0.0, 1.0, 0.0]\n",
    );
    write_frames(&fs, &Blocks { n: 2, plane: false }, 3);
    fs
}
