//! Steps: loads, motions and their course over time.

use super::*;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::load::{
    BodyForce, Course, Force, Gravity, Load, Moment, PerNode, Place, Pressure, Spin, Traction,
};
use signorini_mechanics::model::{Change, LoadPart};
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
    let is = |part: &LoadPart, expected: &dyn Load| {
        assert_eq!(format!("{:?}", part.load.load), format!("{expected:?}"));
    };
    let nodes = |part: &LoadPart| match &part.load.place {
        Place::Nodes(nodes) => labels(nodes),
        other => panic!("{other:?}"),
    };
    let nface = |part: &LoadPart| match &part.load.place {
        Place::Faces(faces) => faces.len(),
        other => panic!("{other:?}"),
    };
    let ncell = |part: &LoadPart| match &part.load.place {
        Place::Cells(cells) => cells.len(),
        other => panic!("{other:?}"),
    };
    let force = load("on = 'top'\nforce = [0, 0, -5]");
    is(&force, &Force(Vec3::new(0.0, 0.0, -5.0)));
    assert_eq!(nface(&force), 1);
    let force = load("on = 'edge'\nforce = [0, 4, 0]");
    is(&force, &Force(Vec3::new(0.0, 4.0, 0.0)));
    assert_eq!(nodes(&force), [5, 6]);
    let per_node = load("on = 'edge'\nper_node = [0, 4, 0]");
    is(&per_node, &PerNode(Vec3::new(0.0, 4.0, 0.0)));
    assert_eq!(nodes(&per_node), [5, 6]);
    for (more, follows) in [
        ("", true),
        ("\nfollows = false", false),
        ("\nfollows = true", true),
    ] {
        let part = load(&format!("on = 'top'\npressure = 0.5{more}"));
        let pressure = 0.5;
        is(&part, &Pressure { pressure, follows });
        assert_eq!(nface(&part), 1);
    }
    let traction = load("on = 'top'\ntraction = [1, 0, 0]");
    is(&traction, &Traction(Vec3::unit(0)));
    let moment = load("on = 'top'\nmoment = [0, 0, 2]");
    is(&moment, &Moment(Vec3::unit(2) * 2.0));
    assert_eq!(nodes(&moment), [5, 6, 7, 8]);
    let body = load("on = 'low'\nbody_force = [0, 0, 1]");
    is(&body, &BodyForce(Vec3::unit(2)));
    assert_eq!(ncell(&body), 1);
    let gravity = load("on = 'all'\ngravity = [0, 0, -9810]");
    is(&gravity, &Gravity(Vec3::new(0.0, 0.0, -9810.0)));
    assert_eq!(ncell(&gravity), 1);
    let spin = Spin {
        speed: 3.0,
        point: Vec3::ZERO,
        axis: Vec3::unit(2),
    };
    let turns = load("on = 'low'\ncentrifugal = { speed = 3, axis = [0, 0, 2] }");
    is(&turns, &spin);
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
