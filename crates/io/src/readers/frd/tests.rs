use super::*;
use crate::case::mutate::{Generator, mutate};

const SMALL: &str = "    1Cjob
    1UUSER
    1UPGM               CalculiX
    2C                             4                                     1
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E+00 0.00000E+00 0.00000E+00
 -1         3 0.00000E+00 1.00000E+00 0.00000E+00
 -1         4 0.00000E+00 0.00000E+00 1.00000E+00
 -3
    3C                             1                                     1
 -1         9    3    0    1
 -2         1         2         3         4
 -3
    1PSTEP                         1           2           3          
  100CL  101 5.00000E-01           2                     0    1           1
 -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
 -1         2-1.00000E+00-2.00000E+00 3.00000-101
 -1         4         NaN 1.00000E+00 0.00000E+00
 -3
    1PSTEP                         2           2           3          
  100CL  101 5.00000E-01           1                     0    1           1
 -4  LONG        7    1
 -5  A           1    1    0    0
 -5  B           1    1    0    0
 -5  C           1    1    0    0
 -5  D           1    1    0    0
 -5  E           1    1    0    0
 -5  F           1    1    0    0
 -5  G           1    1    0    0
 -1         2 1.00000E+00 2.00000E+00 3.00000E+00 4.00000E+00 5.00000E+00 6.00000E+00
 -2           7.00000E+00
 -3
 9999
";

#[test]
fn a_file_is_read_with_its_mesh_and_data_sets() {
    let frd = parse(SMALL.as_bytes()).unwrap();
    assert_eq!(frd.title, "job");
    assert_eq!(frd.points[3], [0.0, 0.0, 1.0]);
    assert_eq!((frd.types[0], frd.nodes_of(0)), (3, &[1, 2, 3, 4][..]));
    let [disp, long] = &frd.datasets[..] else {
        panic!()
    };
    assert_eq!((disp.step, disp.increment, disp.time), (3, 2, 0.5));
    assert_eq!(disp.components, ["D1", "D2", "D3"]);
    assert_eq!(disp.nodes, [2, 4]);
    assert_eq!(disp.row(0), [-1.0, -2.0, 3e-101]);
    assert!(disp.row(1)[0].is_nan() && disp.row(2).is_empty());
    assert_eq!(long.row(0), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    assert!(frd.is_complete);
    assert_eq!(frd.last("LONG"), Some(long));
}

#[test]
fn lines_may_end_in_both_ways_and_the_end_may_be_missing() {
    let frd = parse(SMALL.as_bytes()).unwrap();
    let mut windows = parse(SMALL.replace('\n', "\r\n").as_bytes()).unwrap();
    // not a number is not equal to itself
    let text = |frd: &Frd| format!("{frd:?}");
    assert_eq!(text(&windows), text(&frd));
    windows = parse(SMALL.replace(" 9999\n", "").as_bytes()).unwrap();
    assert!(!windows.is_complete && windows.datasets.len() == 2);
}

#[test]
fn node_numbers_may_be_short() {
    let short = "    2C                             1                                     0
 -1    7 1.00000E+00 2.00000E+00 3.00000E+00
 -3
";
    let frd = parse(short.as_bytes()).unwrap();
    assert_eq!((frd.node_labels[0], frd.points[0]), (7, [1.0, 2.0, 3.0]));
}

#[test]
fn faults_are_reported_with_their_line() {
    let change = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        parse(SMALL.replacen(from, to, 1).as_bytes())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        change("5.00000E-01", "       soon"),
        "line 15: a data set has no time"
    );
    assert_eq!(
        change("    0    1           1\n -4", "    0    1           2\n -4"),
        "line 15: numbers in binary are not read; write them as text"
    );
    assert_eq!(
        change(
            " 0.00000E+00 1.00000E+00\n -3\n    3C",
            " 1.00000E+00\n -3\n    3C"
        ),
        "line 8: a coordinate is no number"
    );
    assert_eq!(
        change(" -1         9    3", " -1         9   33"),
        "line 11: a type of elements that is not known"
    );
    assert_eq!(
        change("         3         4\n", "         3\n"),
        "line 13: the entry before is not complete"
    );
    assert_eq!(
        change(" -2           7.00000E+00\n", ""),
        "line 35: the entry before is not complete"
    );
    assert_eq!(
        change(" -3\n    3C", "    3C"),
        "line 9: a block has no end"
    );
    assert_eq!(
        change("    1PSTEP", "hello"),
        "line 14: this is no line of a .frd file"
    );
    assert_eq!(
        change(" -3\n 9999\n", ""),
        "line 36: the file ends within a block"
    );
    let mesh =
        |from: &str, to: &str| read("a.frd", SMALL.replacen(from, to, 1).as_bytes()).unwrap_err();
    assert!(matches!(
        mesh("         3         4\n", "         3         5\n"),
        MeshError::MissingNode { node: 5, .. }
    ));
    assert!(matches!(
        mesh("         3         4\n", "         3         3\n"),
        MeshError::RepeatedNode { node: 3, .. }
    ));
    assert!(matches!(
        mesh(" -1         2 1", " -1         1 1"),
        MeshError::DuplicateNode { node: 1, .. }
    ));
    assert!(
        mesh(" -1         2 1", " -1         x 1")
            .to_string()
            .starts_with("a.frd, line 6: ")
    );
    assert!(matches!(
        read("a.frd", b" \n").unwrap_err(),
        MeshError::Empty { .. }
    ));
}

#[test]
fn damaged_files_are_read_or_refused() {
    let mut generator = Generator::new(7);
    let (mut refused, mut meshes) = (0, 0);
    for _ in 0..10_000 {
        let bytes = mutate(SMALL.as_bytes(), &mut generator);
        match parse(&bytes) {
            Ok(frd) => {
                assert_eq!(frd.offsets.len(), frd.types.len() + 1);
                assert_eq!(frd.offsets.last(), Some(&frd.connectivity.len()));
                for one in &frd.datasets {
                    assert_eq!(one.values.len(), one.nodes.len() * one.components.len());
                    let _ = one.row(one.nodes.len());
                }
            }
            Err(error) => {
                assert!(error.line <= 80);
                refused += 1;
            }
        }
        meshes += usize::from(read("a.frd", &bytes).is_ok());
    }
    assert!(refused > 1000 && meshes > 1000, "{refused} {meshes}");
}
