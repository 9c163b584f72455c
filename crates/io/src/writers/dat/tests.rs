use super::*;
use crate::fs::{FailingFs, RealFs};
use signorini_geometry::element::quadrature::{
    HEX_8, QUAD_4, QUAD_9, TET_14, TRI_3, TRI_6, WEDGE_6,
};
use signorini_geometry::element::{TABLE, quadrature::Rule};
use signorini_geometry::tensor::Vec3;
use std::io::ErrorKind;

/// By hand, after a table of CalculiX.
const BY_HAND: &str = "
                        S T E P       2


                                INCREMENT    13


 displacements (vx,vy,vz) for set NALL and time  0.1250000E+01

         1  0.000000E+00 -1.844545E-04  1.000000E+10
   1234567 -1.000000-100  9.999999+199           NaN

 total force (fx,fy,fz) for set NALL and time  0.1250000E+01

        6.973057E-01  1.394591E+00 -2.500000E+01

 temperatures for set NALL and time  0.1250000E+01

         1  2.000000E+01

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.1250000E+01

         7   1  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00
         7  27  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00

 equivalent plastic strain (elem, integ.pnt.,pe)for set EALL and time  0.1250000E+01

         7   1  1.492537E-02

 volume (element, volume) for set EALL and time  0.1250000E+01

         7  1.000000E+00

 total volume for set EALL and time  0.1250000E+01

        1.000000E+00
";

fn page() -> Page {
    let mut page = Page::new(2, 13, 1.25);
    page.table(Kind::Displacements, "Nall");
    page.row(Of::One(1), &[0.0, -1.844_545e-4, 1e10]);
    page.row(Of::One(1_234_567), &[-1e-100, 9.999_999e199, f64::NAN]);
    page.table(Kind::TotalForce, "Nall");
    page.row(Of::All, &[0.697_305_7, 1.394_591, -25.0]);
    page.table(Kind::Temperatures, "Nall");
    page.row(Of::One(1), &[20.0]);
    page.table(Kind::Stresses, "Eall");
    let stress = Sym3::new(1.0, 2.0, 3.0, 4.0, 6.0, 5.0);
    page.row(Of::Point(7, 1), &tensor(&stress));
    page.row(Of::Point(7, 27), &tensor(&stress));
    page.table(Kind::PlasticStrains, "Eall");
    page.row(Of::Point(7, 1), &[0.014_925_373]);
    page.table(Kind::Volumes, "Eall");
    page.row(Of::One(7), &[1.0]);
    page.table(Kind::TotalVolume, "Eall");
    page.row(Of::All, &[1.0]);
    page
}

#[test]
fn a_page_is_calculix_s_byte_for_byte() {
    assert_eq!(page().text(), BY_HAND);
}

#[test]
fn times_have_nothing_before_the_point() {
    for (time, text) in [
        (1.0, " 0.1000000E+01"),
        (0.0, " 0.0000000E+00"),
        (0.1, " 0.1000000E+00"),
        (0.05, " 0.5000000E-01"),
        (0.999_999_99, " 0.1000000E+01"),
        (12_345.678_9, " 0.1234568E+05"),
        (-2.5, "-0.2500000E+01"),
        (1e-200, " 0.1000000-199"),
        (f64::INFINITY, "      Infinity"),
    ] {
        let mut got = String::new();
        put_time(&mut got, time);
        assert_eq!(got, text);
    }
}

#[test]
fn a_resumed_file_goes_on_behind_the_lines_kept() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("job.dat");
    let mut tables = Tables::create(&RealFs, &path).unwrap();
    tables.append(&page()).unwrap();
    let keep = tables.nrow();
    assert_eq!(keep, BY_HAND.lines().count() as u64);
    tables.append(&page()).unwrap();
    drop(tables);
    let mut tables = Tables::resume(&RealFs, &path, keep).unwrap();
    tables.append(&page()).unwrap();
    tables.sync().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text, BY_HAND.repeat(2));
    let lost = Tables::resume(&RealFs, &path, 2 * keep + 1);
    assert!(matches!(lost, Err(RowsError::MissingRows { .. })));
}

#[test]
fn a_failing_disk_leaves_whole_pages() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("job.dat");
    let counting = FailingFs::counting(RealFs);
    Tables::create(&counting, &path)
        .unwrap()
        .append(&page())
        .unwrap();
    for n in 1..=counting.count() {
        let fs = FailingFs::nth(RealFs, n, ErrorKind::StorageFull);
        let Ok(mut tables) = Tables::create(&fs, &path) else {
            continue;
        };
        // what failed is tried again
        if tables.append(&page()).is_err() {
            tables.append(&page()).unwrap();
        }
        tables.append(&page()).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, BY_HAND.repeat(2));
    }
}

/// Gauss's points of order two and three.
const G: f64 = 0.577_350_269_189_625_8;
const H: f64 = 0.774_596_669_241_483_4;

/// Where a value that is the place itself is printed.
fn printed(element: &str, rule: &Rule) -> Vec<Vec3> {
    let points = Points::new(element, rule, false);
    let at = |place, axis: usize| points.scalar(place, |p| rule.points[p].to_array()[axis]);
    (0..points.len())
        .map(|place| Vec3::new(at(place, 0), at(place, 1), at(place, 2)))
        .collect()
}

fn assert_places(got: &[Vec3], wanted: &[[f64; 3]], element: &str) {
    assert_eq!(got.len(), wanted.len(), "{element}");
    for (got, wanted) in got.iter().zip(wanted) {
        assert!(
            (*got - Vec3::from(*wanted)).max_abs() < 1e-14,
            "{element}: {got:?} {wanted:?}"
        );
    }
}

/// The places that CalculiX 2.20 prints, found from strains that are the coordinates.
#[test]
fn linear_fields_are_printed_at_calculix_s_points_in_its_order() {
    let line = |n: usize| -> Vec<f64> {
        if n == 2 {
            vec![-G, G]
        } else {
            vec![-H, 0.0, H]
        }
    };
    let square = |n| {
        let over = move |y| line(n).into_iter().map(move |x| [x, y, 0.0]);
        line(n).into_iter().flat_map(over).collect::<Vec<_>>()
    };
    let cube = |n| {
        let lift = |z: f64| square(n).into_iter().map(move |[x, y, _]| [x, y, z]);
        line(n).into_iter().flat_map(lift).collect::<Vec<_>>()
    };
    let (a, b) = (0.138_196_601_125_010_5, 0.585_410_196_624_968_5);
    let corners = [[a, a, a], [b, a, a], [a, b, a], [a, a, b]];
    let third = 1.0 / 3.0;
    let (near, far) = (1.0 / 6.0, 2.0 / 3.0);
    let triangle = [[near, near, 0.0], [far, near, 0.0], [near, far, 0.0]];
    let prism: Vec<_> = line(3)
        .into_iter()
        .flat_map(|z| triangle.map(|[x, y, _]| [x, y, z]))
        .collect();
    let by_name = |name: &str| TABLE.iter().find(|e| e.name() == name).unwrap();
    for (element, reduced, wanted) in [
        ("hex8", false, cube(2)),
        ("hex20", false, cube(3)),
        ("hex20", true, cube(2)),
        ("tet4", false, vec![[0.25; 3]]),
        ("tet10", false, corners.to_vec()),
        ("wedge6", false, vec![[third, third, -G], [third, third, G]]),
        ("wedge15", false, prism),
        ("tri3", false, vec![[third, third, 0.0]; 2]),
        ("tri6", false, triangle.repeat(3)),
        ("quad4", false, square(2).repeat(2)),
        ("quad8", false, square(3).repeat(3)),
        ("quad8", true, square(2).repeat(2)),
        ("line2", false, [[-G, 0.0, 0.0], [G, 0.0, 0.0]].repeat(4)),
    ] {
        let e = by_name(element);
        let rule = if reduced {
            e.reduced_rule()
        } else {
            e.full_rule()
        };
        let got = printed(element, rule);
        assert_places(&got, &wanted, element);
    }
    // rules with more points than are printed
    assert_places(&printed("tet10", &TET_14), &corners, "tet10");
    assert_places(&printed("tri3", &TRI_3), &[[third, third, 0.0]; 2], "tri3");
    assert_places(&printed("tri6", &TRI_6), &triangle.repeat(3), "tri6");
    assert_places(
        &printed("wedge6", &WEDGE_6),
        &[[third, third, -G], [third, third, G]],
        "wedge6",
    );
}

/// `σ_r = 2, σ_θ = 1` at the angle `±1°/√3`, and half of it where the layer is plane.
#[test]
fn tensors_of_revolution_turn_with_the_layer() {
    let stress = Sym3::diagonal(2.0, 5.0, 1.0);
    for (element, rule, share) in [("quad8", &QUAD_4, 1.0), ("quad4", &QUAD_4, 0.5)] {
        let points = Points::new(element, rule, true);
        for (place, sign) in [(0, -1.0), (3, -1.0), (4, 1.0), (7, 1.0)] {
            let turned = points.tensor(place, |_| stress);
            let angle = sign * share * G * 1f64.to_radians();
            assert!((turned.xz() - 0.5 * (2.0 * angle).sin()).abs() < 1e-15);
            assert!((turned.xx() - 1.0 - angle.cos().powi(2)).abs() < 1e-15);
            assert!((turned.yy() - 5.0).abs() < 1e-15);
        }
    }
    let middle = Points::new("quad8", &QUAD_9, true).tensor(13, |_| stress);
    assert_eq!(middle, stress);
    let flat = Points::new("quad8", &QUAD_4, false).tensor(0, |_| stress);
    assert_eq!(flat, stress);
    assert_eq!(
        Points::new("hex8", &HEX_8, false).tensor(7, |_| stress),
        stress
    );
}

/// After tables of CalculiX; the force, moment and centre of the statistics are those of its test deck for them, and the
/// moment about the centre follows from these rounded numbers.
const CONTACT_BY_HAND: &str = "
                        S T E P       1


                                INCREMENT     1


 relative contact displacement (slave node,normal,tang1,tang2) for all contact elements and time 0.1000000E+01

         1 -1.029545E-05  9.287926E-05  9.287926E-05

 contact stress (slave node,press,tang1,tang2) for all contact elements and time 0.1000000E+01

         1  9.996286E+01  7.430341E-03  7.430341E-03

 contact print energy (slave node,energy) forall contact elements and time 0.1000000E+01

         1  1.290383E-04

 total contact spring energy for time  0.1000000E+01

        5.161534E-04

 total number of contact elements for time  0.1000000E+01

                4


 statistics for slave set SSLAV, master set SMAST and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    3.026943E-01  6.054093E-01  2.500000E+01  1.209191E+01 -1.229596E+01  1.513575E-01

   center of gravity and mean normal

    4.999820E-01  4.999640E-01  9.998468E-01  0.000000E+00  0.000000E+00 -1.000000E+00

   moment about the center of gravity(mx,my,mz)

    1.981266E-01 -9.905793E-02  3.726000E-10

   area,  normal force (+ = tension) and shear force (size)

    2.500000E-01 -2.500000E+01  6.768635E-01
";

#[test]
fn a_page_of_contact_is_calculix_s_byte_for_byte() {
    let mut page = Page::new(1, 1, 1.0);
    page.contact_table(ContactKind::Gaps);
    page.row(Of::One(1), &[-1.029_545e-5, 9.287_926e-5, 9.287_926e-5]);
    page.contact_table(ContactKind::Tractions);
    page.row(Of::One(1), &[99.962_86, 7.430_341e-3, 7.430_341e-3]);
    page.contact_table(ContactKind::Energies);
    page.row(Of::One(1), &[1.290_383e-4]);
    page.contact_table(ContactKind::TotalEnergy);
    page.row(Of::All, &[5.161_534e-4]);
    page.contact_table(ContactKind::Count);
    page.count(4);
    let statistics = Statistics {
        force: Vec3::new(0.302_694_3, 0.605_409_3, 25.0),
        moment: Vec3::new(12.091_91, -12.295_96, 0.151_357_5),
        center: Vec3::new(0.499_982, 0.499_964, 0.999_846_8),
        normal: Vec3::new(0.0, 0.0, -1.0),
        area: 0.25,
    };
    page.statistics("Sslav", "Smast", &statistics);
    assert_eq!(page.text(), CONTACT_BY_HAND);
}

#[test]
fn faces_in_contact_are_named_by_element_and_side() {
    let mut page = Page::new(1, 1, 1.0);
    let start = page.text().len();
    page.contact_table(ContactKind::FaceGaps);
    page.row(Of::Side(2, 1), &[9.502_262e-4, 7.241_379e-3, 0.0]);
    page.contact_table(ContactKind::FaceEnergies);
    page.row(Of::Side(2, 1), &[5.489_104e-2]);
    // the lines of CalculiX 2.20
    let expected = "
 relative contact displacement (slave element+face,normal,tang1,tang2) for all contact elements and time 0.1000000E+01

         2          1  9.502262E-04  7.241379E-03  0.000000E+00

 contact print energy (slave element+face,energy)for all contact elements and time 0.1000000E+01

         2          1  5.489104E-02
";
    assert_eq!(&page.text()[start..], expected);
}

/// As CalculiX prints the same two blocks along three axes.
#[test]
fn tangents_follow_x_and_turn_right_about_the_normal() {
    let [x, y, z] = [0, 1, 2].map(Vec3::unit);
    assert_eq!(tangents(z), [x, y]);
    assert_eq!(tangents(y), [x, -z]);
    assert_eq!(tangents(x), [z, -y]);
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let [first, second] = tangents(normal);
    assert!((first - Vec3::new(0.8, 0.0, -0.6)).norm() < 1e-15);
    assert!((second - y).norm() < 1e-15);
}
