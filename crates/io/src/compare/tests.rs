use super::*;
use crate::case::mutate::{Generator, mutate};
use crate::fs::{Fs, RealFs};

const TIGHT: Tolerance = Tolerance {
    rel: 1e-3,
    abs: 0.0,
};

const DAT: &str = "
 displacements (vx,vy,vz) for set NALL and time  0.5000000E+00

         1  1.000000E+00  0.000000E+00  0.000000E+00
         2  2.000000E+00 -4.000000E+00  0.000000E+00

 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  2.000000E+00  0.000000E+00  0.000000E+00
         2  4.000000E+00 -8.000000E+00  0.000000E+00

 forces (fx,fy,fz) for set NALL and time  0.1000000E+01

         1  0.000000E+00  0.000000E+00  0.000000E+00
";

fn dat(text: &str, reference: &str) -> Vec<Finding> {
    let read = |text: &str| tables("a.dat.ref", text.as_bytes()).unwrap();
    compare(&read(text), &read(reference))
}

fn both(finding: &Finding) -> &Comparison {
    match &finding.outcome {
        Outcome::Both(one) => one,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_agrees_with_itself_and_banners_do_not_count() {
    let banner = "\n                        S T E P       1\n\n                                INCREMENT     1\n";
    for text in [
        DAT.to_owned(),
        format!("{banner}{DAT}"),
        DAT.replace("NALL", "nall"),
    ] {
        let findings = dat(&text, DAT);
        assert_eq!(findings.len(), 3);
        assert!(
            findings
                .iter()
                .all(|f| f.agrees(Tolerance { rel: 0.0, abs: 0.0 }))
        );
        assert_eq!(both(&findings[0]).norm, 4.0);
        assert_eq!(both(&findings[1]).norm, 8.0);
    }
}

#[test]
fn points_inside_a_face_in_contact_are_one_row() {
    let table = |caption: &str, rows: &[(u64, f64)]| {
        let rows = rows
            .iter()
            .map(|(e, v)| format!("{e:10}          3 {v:13.6E}\n"));
        let rows: String = rows.collect();
        format!("\n {caption}for all contact elements and time 0.1000000E+01\n\n{rows}")
    };
    for (name, of_two, of_four) in [("energy", 4.0, 2.0), ("stress", 3.0, 3.0)] {
        let caption = format!("contact {name} (slave element+face,{name}) ");
        let text = table(&caption, &[(7, of_two - 1.0), (7, of_two + 1.0), (8, 1.0)]);
        let four = [of_four - 1.5, of_four - 0.5, of_four + 0.5, of_four + 1.5];
        let mut reference: Vec<(u64, f64)> = four.iter().map(|value| (7, *value)).collect();
        reference.push((8, 1.0));
        let reference = table(&caption, &reference);
        let findings = dat(&text, &reference);
        assert_eq!(both(&findings[0]).nrow, 2, "{findings:?}");
        assert!(findings[0].agrees(TIGHT), "{findings:?}");
        let other = reference.replace("         8          3", "         9          3");
        assert!(!dat(&text, &other)[0].agrees(TIGHT));
    }
}

#[test]
fn differences_are_in_parts_of_the_largest_value_of_the_reference_at_that_time() {
    let findings = dat(&DAT.replace("1.000000E+00  0.0", "1.004000E+00  0.0"), DAT);
    let one = both(&findings[0]);
    assert!((one.difference - 0.004).abs() < 1e-12 && one.norm == 4.0);
    assert!((one.ratio() - 0.001).abs() < 1e-12);
    let worst = one.worst.as_ref().unwrap();
    assert_eq!((&worst.ids[..], worst.column.as_str()), (&[1][..], "vx"));
    assert_eq!((worst.found, worst.expected), (1.004, 1.0));
    assert!(one.agrees(Tolerance {
        rel: 1.01e-3,
        abs: 0.0
    }));
    assert!(!one.agrees(Tolerance {
        rel: 0.99e-3,
        abs: 0.0
    }));
    assert!(one.agrees(Tolerance {
        rel: 0.0,
        abs: 0.0041
    }));
    assert!(findings[1].agrees(TIGHT));
}

#[test]
fn a_reference_of_zeros_agrees_with_zeros_only() {
    let findings = dat(&DAT.replace("1  0.000000E+00", "1  1.000000E-20"), DAT);
    assert!(!findings[2].agrees(TIGHT));
    assert_eq!(both(&findings[2]).ratio(), f64::INFINITY);
    assert!(findings[2].agrees(Tolerance {
        rel: 1e-3,
        abs: 1e-15
    }));
}

#[test]
fn blocks_that_only_one_file_has_are_named() {
    let (head, rest) = DAT.split_at(
        DAT.find(" displacements (vx,vy,vz) for set NALL and time  0.10")
            .unwrap(),
    );
    for (found, reference, odd) in [(DAT, rest, Outcome::Extra), (rest, DAT, Outcome::Missing)] {
        let findings = dat(found, reference);
        assert_eq!(findings.len(), 3);
        let odd_one = findings.iter().find(|f| f.outcome == odd).unwrap();
        assert_eq!(odd_one.time, Some(0.5));
        assert!(!odd_one.agrees(TIGHT));
        assert_eq!(findings.iter().filter(|f| f.agrees(TIGHT)).count(), 2);
    }
    assert_eq!(dat(head, "").len(), 1);
}

#[test]
fn rows_are_matched_by_their_identifiers() {
    let swapped = "
 displacements (vx,vy,vz) for set NALL and time  0.5000000E+00

         2  2.000000E+00 -4.000000E+00  0.000000E+00
         1  1.000000E+00  0.000000E+00  0.000000E+00
";
    assert!(dat(swapped, DAT)[0].agrees(TIGHT));
    let other = dat(&DAT.replace("         2  2.0", "         3  2.0"), DAT);
    let mismatch = both(&other[0]).mismatch.clone().unwrap();
    assert!(
        mismatch.contains("only in the reference, such as [2]") && mismatch.contains("[3]"),
        "{mismatch}"
    );
    assert!(!other[0].agrees(Tolerance { rel: 1.0, abs: 1e9 }));
    // a number that is none agrees with its like only
    let none = DAT.replace("1.000000E+00  0.0", "NaN  0.0");
    assert!(dat(&none, &none)[0].agrees(TIGHT));
    assert!(!dat(&none, DAT)[0].agrees(Tolerance {
        rel: 1e300,
        abs: 1e300
    }));
    assert!(!dat(DAT, &none)[0].agrees(TIGHT));
}

#[test]
fn histories_are_compared_by_column_and_step() {
    let csv = "time,step,increment,iterations,c.force_z,c.gap_min\n0.5,a,1,3,10.0,NaN\n1.0,a,2,4,20.0,-1e-3\n2.0,\"b, c\",1,2,0.5,0\n";
    let read = |text: &str| tables("history.csv", text.as_bytes()).unwrap();
    let all = read(csv);
    let names: Vec<&str> = all.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "time in step a",
            "c.force_z in step a",
            "c.gap_min in step a",
            "time in step b, c",
            "c.force_z in step b, c",
            "c.gap_min in step b, c"
        ]
    );
    let slower = read(&csv.replace("2,4,20.0", "2,9,20.0"));
    assert!(
        compare(&slower, &all).iter().all(|f| f.agrees(TIGHT)),
        "iterations are no results"
    );
    let other = compare(&read(&csv.replace("20.0", "20.1")), &all);
    assert_eq!(other.iter().filter(|f| !f.agrees(TIGHT)).count(), 1);
    assert_eq!(both(&other[1]).worst.as_ref().unwrap().ids, [2]);
    assert!(tables("a.csv", b"a,b\n1\n").is_err());
    assert!(
        tables("a.txt", b"")
            .unwrap_err()
            .to_string()
            .contains(".dat, .frd, .csv, .vtu")
    );
}

#[test]
fn folders_are_paired_by_names_and_results_by_kind() {
    let dir = tempfile::tempdir().unwrap();
    for (folder, names) in [
        (
            "a",
            &[
                "history.csv",
                "one.frd",
                "run.log",
                "frames/volume_0000.vtu",
                "frames/failed.vtu",
            ][..],
        ),
        ("b", &["history.csv", "two.frd", "frames/volume_0001.vtu"]),
    ] {
        for name in names {
            let path = dir.path().join(folder).join(name);
            RealFs.create_dir_all(path.parent().unwrap()).unwrap();
            RealFs.write(&path, b"").unwrap();
        }
    }
    let all = pairs(&RealFs, &dir.path().join("a"), &dir.path().join("b")).unwrap();
    let told: Vec<_> = all
        .iter()
        .map(|p| (p.name.as_str(), p.found.is_some(), p.reference.is_some()))
        .collect();
    assert_eq!(
        told,
        [
            ("frames/volume_0000.vtu", true, false),
            ("frames/volume_0001.vtu", false, true),
            ("history.csv", true, true),
            ("one.frd", true, true)
        ]
    );
    assert!(pairs(&RealFs, &dir.path().join("c"), &dir.path().join("b")).is_err());
}

#[test]
fn damaged_files_are_compared_or_refused() {
    let csv = "time,step,increment,iterations,c.force_z\n0.5,a,1,3,10.0\n1.0,\"a\"\"\",2,4,20.0\n";
    let mut generator = Generator::new(3);
    for (name, text) in [("a.dat", DAT), ("a.csv", csv)] {
        let reference = tables(name, text.as_bytes()).unwrap();
        let mut compared = 0;
        for _ in 0..3000 {
            let bytes = mutate(text.as_bytes(), &mut generator);
            if let Ok(found) = tables(name, &bytes) {
                let ahead = compare(&found, &reference);
                let back = compare(&reference, &found);
                let count = |all: &[Finding]| {
                    all.iter()
                        .filter(|f| matches!(f.outcome, Outcome::Both(_)))
                        .count()
                };
                assert_eq!(count(&ahead), count(&back));
                assert_eq!(ahead.len() + count(&ahead), found.len() + reference.len());
                compared += 1;
            }
        }
        assert!(compared > 500, "{name}: {compared}");
    }
}

#[test]
fn rows_of_zeros_that_the_reference_alone_has_say_nothing() {
    let zeros = DAT.replacen(
        " 0.000000E+00\n\n displacements",
        " 0.000000E+00\n         7  0.000000E+00  0.000000E+00  0.000000E+00\n\n displacements",
        1,
    );
    assert_ne!(zeros, DAT);
    assert!(dat(DAT, &zeros).iter().all(|one| one.agrees(TIGHT)));
    assert!(!dat(&zeros, DAT)[0].agrees(TIGHT));
    let more = zeros.replace("7  0.000000E+00", "7  1.000000E-09");
    assert!(!dat(DAT, &more)[0].agrees(TIGHT));
    let heading =
        " stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set E and time  0.1000000E+01\n";
    let headed = format!("{DAT}\n{heading}");
    assert!(dat(DAT, &headed).iter().all(|one| one.agrees(TIGHT)));
}
