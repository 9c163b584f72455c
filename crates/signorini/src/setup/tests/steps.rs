//! Steps: loads, motions and their course over time.

use super::*;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::contact::law::Table;
use signorini_mechanics::load::Course;
use signorini_mechanics::model::{Change, Load};
use signorini_mechanics::solve::Motion;

#[test]
fn loads_become_what_they_say() {
    let load = |what: &str| {
        let sets = "top = { plane = 'z', at = 1, of = 'low' }\nedge = { nodes = [5, 6] }\n";
        let text = format!("{sets}{STEP}[[step.load]]\n{what}\n");
        let text = format!("{CUBES}{BASE}{text}").replace("nu = 0.3", "nu = 0.3\ndensity = 7.8e-9");
        let mut built = parts_of(&text);
        built.steps[0].loads.remove(0)
    };
    let face_of = |faces: &[signorini_geometry::mesh::Face]| faces.len();
    match load("on = 'top'\nforce = [0, 0, -5]").load {
        Load::Force { faces, total } => {
            assert_eq!((face_of(&faces), total.z), (1, -5.0));
        }
        other => panic!("{other:?}"),
    }
    match load("on = 'edge'\nforce = [0, 4, 0]").load {
        Load::Nodes(nodes) => {
            assert!(nodes.len() == 2 && nodes.iter().all(|(_, f)| f.y == 2.0));
        }
        other => panic!("{other:?}"),
    }
    match load("on = 'edge'\nper_node = [0, 4, 0]").load {
        Load::Nodes(nodes) => assert!(nodes.iter().all(|(_, f)| f.y == 4.0)),
        other => panic!("{other:?}"),
    }
    let follows = |load: Load| match load {
        Load::Pressure {
            follows, pressure, ..
        } => {
            assert_eq!(pressure, 0.5);
            follows
        }
        other => panic!("{other:?}"),
    };
    assert!(follows(load("on = 'top'\npressure = 0.5").load));
    assert!(!follows(
        load("on = 'top'\npressure = 0.5\nfollows = false").load
    ));
    assert!(matches!(
        load("on = 'top'\ntraction = [1, 0, 0]").load,
        Load::Traction { traction, .. } if traction == Vec3::unit(0)
    ));
    assert!(matches!(
        load("on = 'top'\nmoment = [0, 0, 2]").load,
        Load::Moment { nodes, .. } if labels(&nodes) == [5, 6, 7, 8]
    ));
    assert!(matches!(
        load("on = 'low'\nbody_force = [0, 0, 1]").load,
        Load::Body { cells, .. } if cells.len() == 1
    ));
    assert!(matches!(
        load("on = 'all'\ngravity = [0, 0, -9810]").load,
        Load::Gravity { cells, acceleration } if cells.len() == 1 && acceleration.z == -9810.0
    ));
    assert!(matches!(
        load("on = 'low'\ncentrifugal = { speed = 3, axis = [0, 0, 2] }").load,
        Load::Centrifugal { speed, axis, .. } if speed == 3.0 && axis == Vec3::unit(2)
    ));
}

#[test]
fn loads_go_over_time_as_their_course_says() {
    let amplitudes = "[amplitude.saw]\ntable = [[0, 0], [1, 2]]\n[amplitude.whole]\ntable = [[0, 1], [5, 3]]\ntime = 'total'\n";
    let load = "on = 'base'\nper_node = [0, 0, 1]";
    let text = format!(
        "{amplitudes}{STEP}[[step.load]]\n{load}\n[[step.load]]\n{load}\ntable = [[0, 0.5]]\n[[step.load]]\n{load}\namplitude = 'saw'\n\
         [[step.load]]\n{load}\namplitude = 'whole'\n[[step]]\nname = 'two'\n[[step]]\nname = 'three'\n"
    );
    let built = cubes(&text);
    let courses: Vec<&Course> = built.steps[0].loads.iter().map(|l| &l.course).collect();
    assert_eq!(
        courses,
        [
            &Course::Ramp,
            &Course::Table(vec![[0.0, 0.5]]),
            &Course::Table(vec![[0.0, 0.0], [1.0, 2.0]]),
            &Course::TotalTable(vec![[0.0, 1.0], [5.0, 3.0]]),
        ]
    );
    assert!(
        built.warnings.is_empty(),
        "a load in total time goes on: {}",
        built.warnings
    );
}

#[test]
fn steps_change_what_they_name_and_keep_the_rest() {
    let text = format!(
        "{STEP}[[step.load]]\nname = 'push'\non = 'base'\nforce = [1, 0, 0]\n[[step]]\nname = 'two'\ngeometry = 'linear'\n\
         [[step.free]]\non = 'base'\nu = ['x']\n[[step.load]]\nname = 'push'\non = 'base'\nforce = [0, 0, 0]\n\
         [[step.move]]\non = 'base'\nuz = {{ table = [[0, 0], [1, 2]] }}\n[[step]]\nname = 'three'\n"
    );
    let built = cubes(&text);
    let [one, two, three] = &built.steps[..] else {
        panic!("three steps");
    };
    assert_eq!(
        (one.nonlinear, two.nonlinear, three.nonlinear),
        (true, false, false)
    );
    assert_eq!(one.loads[0].name, two.loads[0].name);
    assert!(matches!(&two.changes[0], Change::Release(_, components) if components == &[0]));
    let table = Motion::Table(vec![[0.0, 0.0], [1.0, 2.0]]);
    assert!(matches!(&two.changes[1], Change::Prescribe(_, motions) if motions == &[(2, table)]));
    assert!(three.changes.is_empty() && three.loads.is_empty());
    let notes = built.warnings.plain();
    assert!(
        notes.contains("S0405") && notes.contains("\"three\" changes nothing"),
        "{notes}"
    );
}
