use super::*;
use crate::cubic::CUBIC;
use crate::fs::{FailingFs, RealFs};
use crate::readers::frd::{self, Frd};
use signorini_geometry::element::{self, Element};
use std::io::ErrorKind;

/// One element of each kind of this dimension, side by side; node and element numbers with gaps.
fn zoo(dim: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let kinds: Vec<Element> = element::TABLE
        .iter()
        .copied()
        .filter(|e| e.dim() == dim && CellType::of_element(*e).is_some())
        .collect();
    for (number, element) in (0_u64..).zip(kinds) {
        let first = mesh.points.len() as u32;
        for xi in element.nodes() {
            mesh.points
                .push(*xi + Vec3::new(3.0 * number as f64, 0.0, 0.0));
            mesh.node_labels.push(10 * mesh.points.len() as u64);
        }
        let nodes: Vec<u32> = (first..mesh.points.len() as u32).collect();
        mesh.push_cell(element, &nodes, 100 + 7 * number);
    }
    mesh
}

/// Values with six digits, so that the file holds all of them.
fn vectors(mesh: &Mesh, factor: f64) -> Vec<Vec3> {
    let value = |k: usize| Vec3::new(k as f64 * factor, -0.125, 3e-30);
    (0..mesh.nnode()).map(value).collect()
}

fn written(mesh: &Mesh, frames: &[(Moment, Vec<Dataset<'_>>)]) -> (Vec<u8>, Frd) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.frd");
    let mut file = FrdFile::create(&RealFs, &path, "a title", mesh).unwrap();
    for (moment, datasets) in frames {
        file.frame(moment, datasets).unwrap();
    }
    let bytes = RealFs.read(&path).unwrap();
    let frd = frd::parse(&bytes).unwrap();
    (bytes, frd)
}

fn at(time: f64, step: u64, increment: u64) -> Moment {
    Moment {
        time,
        step,
        increment,
    }
}

#[test]
fn every_element_is_read_back_with_its_nodes_in_place() {
    for dim in [2, 3] {
        let mesh = zoo(dim);
        let (bytes, frd) = written(&mesh, &[]);
        assert_eq!(frd.title, "a title");
        assert_eq!(frd.node_labels, mesh.node_labels);
        assert!(frd.is_complete);
        let (read, notes) = frd::read("t.frd", &bytes).unwrap();
        assert!(notes.is_empty());
        for (point, other) in mesh.points.iter().zip(&read.points) {
            assert!((*point - *other).norm() <= 1e-5 * point.norm());
        }
        for cell in mesh.cells(dim) {
            let label = mesh.cell_label(cell);
            let same = read
                .cells(dim)
                .find(|&other| read.cell_label(other) == label)
                .unwrap();
            let (ours, theirs) = (mesh.cell(cell), read.cell(same));
            // those with nodes inside lose them
            assert_eq!(
                theirs,
                &ours[..theirs.len()],
                "{}",
                mesh.element(cell).unwrap().name()
            );
            let lost = ["hex27", "quad9"].contains(&mesh.element(cell).unwrap().name());
            assert_eq!(ours.len() != theirs.len(), lost);
        }
    }
}

#[test]
fn a_mesh_of_elements_that_the_format_lacks_is_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.frd");
    for element in CUBIC {
        let mut mesh = Mesh::default();
        mesh.points.extend(element.nodes());
        mesh.node_labels.extend(1..=element.nnode() as u64);
        let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
        mesh.push_cell(element, &nodes, 1);
        let refused = FrdFile::create(&RealFs, &path, "a title", &mesh).unwrap_err();
        assert!(
            matches!(&refused, FrdError::NoElement { element: name, .. } if *name == element.name())
        );
        assert!(refused.to_string().contains(element.name()));
        assert!(!path.exists());
    }
}

#[test]
fn frames_are_read_back_by_value() {
    let mesh = zoo(3);
    let n = mesh.nnode();
    let (u, f) = (vectors(&mesh, 0.5), vectors(&mesh, -2e12));
    let tensor = |k: usize| Sym3::new(k as f64, 2.0, 3.0, 4.0, 5.0, -6.0);
    let stress: Vec<Sym3> = (0..n).map(tensor).collect();
    let scalars: Vec<f64> = (0..n).map(|k| k as f64 / 4.0).collect();
    let (nodes, rows) = ([3, 1, 7], [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3]);
    let first = vec![
        Dataset::Displacement(&u),
        Dataset::Temperature(&scalars),
        Dataset::Stress(&stress),
        Dataset::Strain(&stress),
        Dataset::Force(&f),
        Dataset::PlasticStrain(&scalars),
        Dataset::Contact {
            nodes: &nodes,
            values: &rows,
        },
    ];
    let second = vec![Dataset::Displacement(&f)];
    let (_, frd) = written(
        &mesh,
        &[(at(0.25, 1, 3), first.clone()), (at(1.5, 2, 1), second)],
    );
    let names: Vec<&str> = frd.datasets.iter().map(|d| d.name.as_str()).collect();
    let expected: Vec<&str> = first.iter().map(Dataset::name).chain(["DISP"]).collect();
    assert_eq!(names, expected);
    let [disp, temperature, s, e, forc, pe, contact, last] = &frd.datasets[..] else {
        panic!()
    };
    assert_eq!((disp.time, disp.step, disp.increment), (0.25, 1, 3));
    assert_eq!((last.time, last.step, last.increment), (1.5, 2, 1));
    assert_eq!(disp.components, ["D1", "D2", "D3"]);
    assert_eq!(s.components, ["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"]);
    for k in 0..n {
        assert_eq!(disp.row(k), u[k].to_array());
        assert_eq!(forc.row(k), f[k].to_array());
        assert_eq!(last.row(k), f[k].to_array());
        // xx yy zz xy yz zx
        assert_eq!(s.row(k), [k as f64, 2.0, 3.0, 4.0, 5.0, -6.0]);
        assert_eq!((s.row(k)[4], s.row(k)[5]), (stress[k].yz(), stress[k].xz()));
        assert_eq!(e.row(k), s.row(k));
    }
    assert_eq!((&temperature.values, &pe.values), (&scalars, &scalars));
    assert_eq!(contact.nodes, [40, 20, 80], "numbers of the mesh");
    assert_eq!(contact.row(2), rows[2]);
}

#[test]
fn columns_are_those_of_calculix() {
    let mesh = zoo(2);
    let u = vectors(&mesh, 1.0);
    let stress = vec![Sym3::default(); mesh.nnode()];
    let datasets = vec![Dataset::Displacement(&u), Dataset::Stress(&stress)];
    let (bytes, _) = written(&mesh, &[(at(1.0, 1, 1), datasets)]);
    let text = String::from_utf8(bytes).unwrap();
    // lines of CalculiX 2.20, with the counts of this mesh
    for line in [
        "    2C                            30                                     1",
        "    3C                             5                                     1",
        " -1       100    7    0    1",
        "    1PSTEP                         1           1           1          ",
        "  100CL  101 1.000000000          30                     0    1           1",
        " -4  DISP        4    1",
        " -5  D1          1    2    1    0",
        " -5  ALL         1    2    0    0    1ALL",
        " -1        10 0.00000E+00-1.25000E-01 3.00000E-30",
        "    1PSTEP                         2           1           1          ",
        " -4  STRESS      6    1",
        " -5  SZX         1    4    3    1",
    ] {
        assert!(text.lines().any(|one| one == line), "{line}\n{text}");
    }
    assert!(text.ends_with(" -3\n 9999\n"));
}

#[test]
fn values_of_another_mesh_are_refused_before_anything_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.frd");
    let mesh = zoo(3);
    let mut file = FrdFile::create(&RealFs, &path, "", &mesh).unwrap();
    let before = RealFs.read(&path).unwrap();
    let error = file
        .frame(&at(1.0, 1, 1), &[Dataset::Temperature(&[1.0])])
        .unwrap_err();
    assert!(
        error.to_string().contains("1 values where there are"),
        "{error}"
    );
    let (nodes, values) = ([9999], [[0.0; 6]]);
    let outside = Dataset::Contact {
        nodes: &nodes,
        values: &values,
    };
    let error = file.frame(&at(1.0, 1, 1), &[outside]).unwrap_err();
    assert!(matches!(error, FrdError::NoSuchNode { node: 9999, .. }));
    assert_eq!(RealFs.read(&path).unwrap(), before);
}

#[test]
fn numbers_beyond_32_bits_are_counted_anew() {
    let mut mesh = zoo(2);
    mesh.node_labels[0] = 1 << 40;
    let (_, frd) = written(&mesh, &[]);
    assert!(frd.node_labels.iter().copied().eq(1..=mesh.nnode() as u64));
    assert_eq!(frd.connectivity[0], 1);
    assert_eq!(frd.element_labels[0], 100);
}

/// Three frames; a frame that fails is tried again.
fn three_frames(fs: &dyn Fs, path: &Path, mesh: &Mesh) -> Result<u64, FrdError> {
    let u = vectors(mesh, 1.0);
    let mut file = FrdFile::create(fs, path, "", mesh)?;
    let mut failures = 0;
    for increment in 1..=3 {
        while file
            .frame(
                &at(increment as f64, 1, increment),
                &[Dataset::Displacement(&u)],
            )
            .is_err()
        {
            failures += 1;
        }
    }
    assert_eq!(file.mark().nframe, 3);
    Ok(failures)
}

#[test]
fn at_every_fault_of_the_disk_frames_are_whole_or_absent() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.frd");
    let mesh = zoo(2);
    let counting = FailingFs::counting(RealFs);
    three_frames(&counting, &path, &mesh).unwrap();
    let total = counting.count();
    let whole = RealFs.read(&path).unwrap();
    for n in 1..=total {
        match three_frames(
            &FailingFs::nth(RealFs, n, ErrorKind::StorageFull),
            &path,
            &mesh,
        ) {
            Ok(failures) => {
                assert_eq!(failures, 1);
                assert_eq!(RealFs.read(&path).unwrap(), whole, "operation {n}");
            }
            Err(error) => assert!(matches!(error, FrdError::Fs(FsError::DiskFull { .. }))),
        }
    }
}

#[test]
fn a_resumed_file_is_the_same_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.frd");
    let mesh = zoo(3);
    let u = vectors(&mesh, 1.0);
    let frame = |file: &mut FrdFile, k: u64| {
        let dataset = [Dataset::Displacement(&u), Dataset::Force(&u)];
        file.frame(&at(k as f64, 1, k), &dataset).unwrap();
    };
    let mut file = FrdFile::create(&RealFs, &path, "", &mesh).unwrap();
    frame(&mut file, 1);
    let mark = file.mark();
    let with_one = RealFs.read(&path).unwrap();
    frame(&mut file, 2);
    frame(&mut file, 3);
    drop(file);
    let whole = RealFs.read(&path).unwrap();
    // lost in the middle of the third frame, with frames behind the mark, or with nothing behind it
    for length in [whole.len() - 1000, whole.len(), mark.length as usize] {
        RealFs.write(&path, &whole[..length]).unwrap();
        let mut file = FrdFile::resume(&RealFs, &path, &mesh, mark).unwrap();
        assert_eq!(RealFs.read(&path).unwrap(), with_one);
        frame(&mut file, 2);
        frame(&mut file, 3);
        assert_eq!(RealFs.read(&path).unwrap(), whole);
    }
    RealFs
        .write(&path, &whole[..mark.length as usize - 1])
        .unwrap();
    let error = FrdFile::resume(&RealFs, &path, &mesh, mark).unwrap_err();
    assert!(matches!(error, FrdError::Fs(FsError::TooShort { .. })));
}

#[test]
fn nodes_of_no_element_are_left_out() {
    let mut mesh = zoo(3);
    let alone = mesh.nnode() as u32;
    mesh.points.push(Vec3::new(9.0, 9.0, 9.0));
    mesh.node_labels.push(9999);
    let u = vectors(&mesh, 0.5);
    let contact = Dataset::Contact {
        nodes: &[alone, 2],
        values: &[[1.0; 6], [2.0; 6]],
    };
    let (_, frd) = written(
        &mesh,
        &[(at(1.0, 1, 1), vec![Dataset::Displacement(&u), contact])],
    );
    assert_eq!(frd.node_labels, mesh.node_labels[..alone as usize]);
    let [disp, contact] = &frd.datasets[..] else {
        panic!()
    };
    assert_eq!(disp.nodes.len(), alone as usize);
    assert_eq!(contact.nodes, [mesh.node_labels[2]]);
}
