use super::*;
use crate::case::{
    ConstraintKind, Enforcement, Factor, Features, Geometry, Locking, Method, Moment, Motion,
    Normals, PointKind, Shape, Sliding, Space, Stick, Tolerance,
};
use crate::deck::load::vector;
use crate::fs::RealFs;
use signorini_vocabulary::Chosen;

/// A square of one element between y = 0 and 1, with more of everything.
struct Deck {
    analysis: &'static str,
    domain: &'static str,
    element: &'static str,
    more_nodes: &'static [&'static str],
    more_elements: &'static [&'static str],
    segments: &'static [&'static str],
    material: &'static str,
    conditions: &'static [&'static str],
    functions: &'static [&'static str],
    sets: &'static [&'static str],
    checks: &'static str,
}

const DECK: Deck = Deck {
    analysis: "StaticStructural nsteps 2 deltat 0.5 rtolv 1.e-6 smtype 1",
    domain: "PlaneStrain",
    element: "quad1planestrain 1 nodes 4 1 2 3 4 crosssect 1 mat 1",
    more_nodes: &[],
    more_elements: &[],
    segments: &[],
    material: "isoLE 1 d 0. E 1e3 n 0.25 talpha 0.",
    conditions: &["BoundaryCondition 1 loadTimeFunction 1 dofs 2 1 2 values 2 0 0 set 1"],
    functions: &["ConstantFunction 1 f(t) 1."],
    sets: &[
        "set 1 nodes 2 1 2",
        "set 2 nodes 2 3 4",
        "set 3 elementboundaries 2 1 3",
    ],
    checks: "",
};

impl Deck {
    fn text(&self) -> String {
        let segments = match self.segments.len() {
            0 => String::new(),
            n => format!("ncontactseg {n}"),
        };
        let head = format!(
            "job.out\nA square\n{} nmodules 1\nerrorcheck\ndomain {}\nOutputManager\n\
             ndofman {} nelem {} ncrosssect 1 nmat 1 nbc {} nic 0 nltf {} nset {} {segments}\n\
             node 1 coords 2 0 0\nnode 2 coords 2 1 0\nnode 3 coords 2 1 1\nnode 4 coords 2 0 1\n",
            self.analysis,
            self.domain,
            4 + self.more_nodes.len(),
            1 + self.more_elements.len(),
            self.conditions.len(),
            self.functions.len(),
            self.sets.len()
        );
        let mut records = self.more_nodes.to_vec();
        records.push(self.element);
        records.extend(self.more_elements);
        records.extend(self.segments);
        records.extend(["SimpleCS 1 thick 1.", self.material]);
        records.extend(self.conditions);
        records.extend(self.functions);
        records.extend(self.sets);
        format!("{head}{}\n{}", records.join("\n"), self.checks)
    }

    fn read(&self) -> Result<Read, Diagnostics> {
        read(&RealFs, "job.in", self.text().as_bytes(), Compat::Oofem)
    }

    fn case(&self) -> Case {
        self.read()
            .unwrap_or_else(|found| panic!("{}", found.plain()))
            .case
    }

    fn refused(&self) -> String {
        self.read().unwrap_err().plain()
    }
}

#[test]
fn a_plain_deck_is_a_case_with_a_step_for_each_of_its_own() {
    let case = DECK.case();
    assert_eq!(case.title, "A square");
    assert_eq!(*case.model.space, Space::PlaneStrain);
    assert_eq!(case.bodies[0].locking.value, Locking::None);
    assert_eq!(case.materials[0].model.value, "linear-elastic");
    let steps: Vec<(f64, Geometry)> = case
        .steps
        .iter()
        .map(|s| (s.duration, s.geometry))
        .collect();
    assert_eq!(steps, [(0.5, Geometry::Linear), (0.5, Geometry::Auto)]);
    assert_eq!(case.steps[0].fixes[0].u.xyz, [true, true, false]);
    let large = Deck {
        element: "quad1planestrain 1 nodes 4 1 2 3 4 crosssect 1 mat 1 nlgeo 1",
        ..DECK
    };
    let large = large.case();
    assert_eq!(large.materials[0].model.value, "saint-venant-kirchhoff");
    assert_eq!(large.steps[0].geometry, Geometry::Nonlinear);
}

/// f = −1 at t = 0, 1 at 2, then 1; the first step of NonLinearStatic has t = 0.
#[test]
fn functions_are_sampled_at_the_times_of_the_deck() {
    let conditions = &[
        "BoundaryCondition 1 loadTimeFunction 1 dofs 2 1 2 values 2 0 0 set 1",
        "BoundaryCondition 2 loadTimeFunction 2 dofs 2 1 2 values 2 0 3 set 2",
    ];
    for (function, wanted) in [
        (
            "PiecewiseLinFunction 2 npoints 2 t 2 0 2 f(t) 2 -1 1",
            [-1.0, 0.0, 1.0, 1.0],
        ),
        ("UsrDefLTF 2 f(t) $ 2*t^2 - 1 $", [-1.0, 1.0, 7.0, 17.0]),
        ("PeakFunction 2 t 2. f(t) 5.", [0.0, 0.0, 5.0, 0.0]),
        ("HeavisideLTF 2 origin 1.5 value 4.", [0.0, 0.0, 4.0, 4.0]),
    ] {
        let functions = ["ConstantFunction 1 f(t) 1.", function];
        let deck = Deck {
            analysis: "NonLinearStatic nsteps 4 controlmode 1",
            conditions,
            functions: Box::leak(Box::new(functions)),
            ..DECK
        };
        let case = deck.case();
        let Factor::Table(table) = &case.amplitudes[0].factor else {
            panic!("a table");
        };
        let at = |time: f64| {
            let after = table.partition_point(|row| row[0] < time);
            let [t, f] = table[after];
            if t == time || f == table[after - 1][1] {
                f
            } else {
                f64::NAN
            }
        };
        assert_eq!(
            [1.0, 2.0, 3.0, 4.0].map(at),
            wanted,
            "{function}: {table:?}"
        );
        let moved = &case.steps[0].moves[0].u;
        assert!(matches!(
            moved[1],
            Some(Motion::Amplitude { value: 3.0, .. })
        ));
        assert_eq!(moved[0], None);
    }
}

#[test]
fn loads_act_on_nodes_sides_and_mass() {
    let deck = Deck {
        material: "isoLE 1 d 2. E 1e3 n 0.25 talpha 0.",
        conditions: &[
            "BoundaryCondition 1 loadTimeFunction 1 dofs 2 1 2 values 2 0 0 set 1",
            "NodalLoad 2 loadTimeFunction 1 components 2 0 5. set 2",
            "ConstantEdgeLoad 3 loadTimeFunction 1 components 2 1. 2. loadType 3 set 3",
            "DeadWeight 4 loadTimeFunction 1 components 2 0. -9.81 set 4",
        ],
        sets: &[
            "set 1 nodes 2 1 2",
            "set 2 nodes 2 3 4",
            "set 3 elementboundaries 2 1 3",
            "set 4 elements 1 1",
        ],
        ..DECK
    };
    let case = deck.case();
    let kinds: Vec<&Chosen> = case.steps[0].loads.iter().map(|load| &load.kind).collect();
    assert_eq!(
        kinds,
        [
            &vector("per_node", [0.0, 5.0, 0.0]),
            &vector("traction", [1.0, 2.0, 0.0]),
            &vector("gravity", [0.0, -9.81, 0.0])
        ]
    );
    assert_eq!(
        case.materials[0].density.as_ref().map(|d| d.value),
        Some(2.0)
    );
}

#[test]
fn old_records_name_conditions_at_nodes_and_slaves_follow() {
    let deck = Deck {
        more_nodes: &[
            "node 5 coords 2 0 2 bc 2 1 0 load 1 2",
            "SlaveNode 6 coords 2 1 2 doftype 2 0 2 masterdofman 2 3 4 weights 2 0.25 0.75",
        ],
        conditions: &[
            "BoundaryCondition 1 loadTimeFunction 1 dofs 2 1 2 values 2 0 0 set 1",
            "NodalLoad 2 loadTimeFunction 1 components 1 7.",
        ],
        sets: &["set 1 nodes 3 1 2 6"],
        ..DECK
    };
    let case = deck.case();
    let fixes: Vec<[bool; 3]> = case.steps[0].fixes.iter().map(|fix| fix.u.xyz).collect();
    assert_eq!(
        fixes,
        [
            [true, true, false],
            [true, false, false],
            [true, false, false]
        ],
        "the set without the slave, the slave where it does not follow, node 5"
    );
    let ConstraintKind::Equation { terms, .. } = &case.constraints[0].kind else {
        panic!("{:?}", case.constraints)
    };
    let coefficients: Vec<f64> = terms.iter().map(|term| term.coefficient).collect();
    assert_eq!(coefficients, [1.0, -0.25, -0.75]);
    assert_eq!(
        case.steps[0].loads[0].kind,
        vector("per_node", [7.0, 0.0, 0.0])
    );
}

const CONTACT: Deck = Deck {
    analysis: "NonLinearStatic nsteps 1 controlmode 1 soldepextforces",
    more_nodes: &["node 5 coords 2 0.25 1.5", "node 6 coords 2 0 1.5"],
    more_elements: &["truss2d 2 nodes 2 5 6 crosssect 1 mat 1 cs 1"],
    ..DECK
};

#[test]
fn nodes_meet_nodes_along_the_line_between_them() {
    let deck = Deck {
        conditions: &[
            "n2npenaltycontact 1 loadTimeFunction 1 penalty 5. masterset 1 slaveset 2 usetangent",
            "n2nlagrangianmultipliercontact 2 loadTimeFunction 1 masterset 1 slaveset 2",
            "n2npenaltycontact 3 loadTimeFunction 1 penalty 5. masterset 1 slaveset 2 normal 2 0 3",
        ],
        sets: &[
            "set 1 nodes 2 4 3 ordered_nodes",
            "set 2 nodes 2 6 5 ordered_nodes",
        ],
        ..CONTACT
    };
    let case = deck.case();
    let normals: Vec<Normals> = case.contacts.iter().map(|one| one.normals).collect();
    let turned = 0.75_f64.hypot(0.5);
    let slanted = [-0.75 / turned, 0.5 / turned, 0.0];
    let up = Normals::Given([0.0, 1.0, 0.0]);
    assert_eq!(normals[0], up);
    let Normals::Given(n) = normals[1] else {
        panic!()
    };
    assert!((0..3).all(|k| (n[k] - slanted[k]).abs() < 1e-15), "{n:?}");
    assert_eq!(
        (normals.len(), normals[4]),
        (5, up),
        "pairs of one normal are one"
    );
    let methods = case
        .contacts
        .iter()
        .all(|one| *one.method == Method::NodeToNode);
    assert!(methods);
    assert_eq!(case.contacts[2].enforcement, Enforcement::Lagrange);
}

#[test]
fn nodes_meet_sides_circles_and_polynomials() {
    let deck = Deck {
        segments: &[
            "linear2delementedgecontactsegment 1 edgeset 3",
            "circlecontactsegment 2 centerpoint 2 0.5 3. radius 1.",
            "polynomialcontactsegment 3 coeffs 3 1. 0. -5.",
        ],
        conditions: &[
            "n2spenaltycontact 1 loadTimeFunction 1 penalty 5. nodeset 1 5 segmentset 3 1 2 3 usetangent",
        ],
        ..CONTACT
    };
    let case = deck.case();
    let [sides, circle, polynomial] = &case.contacts[..] else {
        panic!()
    };
    assert_eq!(
        (sides.features, sides.sliding),
        (Features::Faces, Sliding::Small)
    );
    assert_eq!(sides.primary.value, "set-3");
    assert_eq!(circle.sliding, Sliding::Finite);
    assert_eq!(polynomial.primary.value, "segment-3");
    let shapes = case.surfaces.iter().map(|surface| match &surface.shape {
        Shape::Analytical(shape) => shape,
        Shape::Stl { .. } => panic!(),
    });
    let [circle, polynomial] = shapes.collect::<Vec<_>>()[..] else {
        panic!()
    };
    assert_eq!(circle.name, "circle");
    assert_eq!(circle.values.number("radius"), Ok(1.0));
    assert_eq!(polynomial.name, "polynomial");
    assert_eq!(polynomial.values.text("side"), Some("above"));
}

#[test]
fn surfaces_of_contact_elements_meet_at_their_points() {
    let text = DECK.text();
    let text = text
        .replace("nelem 1", "nelem 3")
        .replace("nset 3", "nset 5 ncontactsurf 2");
    let text = text.replace("nbc 1", "nbc 2").replace(
        "crosssect 1 mat 1\n",
        concat!(
            "crosssect 1 mat 1 nlgeo 1\n",
            "StructuralContactElement_LineLin 2 nodes 2 3 4 crosssect 1 mat 1 nip 2\n",
            "StructuralContactElement_LineLin 3 nodes 2 2 1 crosssect 1 mat 1 nip 1\n",
            "StructuralFEContactSurface 1 ce_set 4\nStructuralFEContactSurface 2 ce_set 5\n",
        ),
    );
    let text = text.replace(
        "ConstantFunction",
        "structuralpenaltycontactbc 2 loadTimeFunction 1 dofs 2 1 2 pn 10. pt 5. friction 0.3 \
         mastersurface 1 slavesurface 2 nsd 2 generalizedfeatures 1 searchtol 1e-9\nConstantFunction",
    );
    let text = format!("{text}set 4 elements 1 2\nset 5 elements 1 3\n").replace("\n\n", "\n");
    let read = read(&RealFs, "job.in", text.as_bytes(), Compat::Oofem);
    let read = read.unwrap_or_else(|found| panic!("{}", found.plain()));
    let contact = &read.case.contacts[0];
    assert_eq!(
        (
            contact.secondary.value.as_str(),
            contact.primary.value.as_str()
        ),
        ("set-5", "set-4")
    );
    assert_eq!(
        (contact.rule.kind, contact.rule.points),
        (PointKind::Gauss, Some(1))
    );
    assert_eq!(contact.features, Features::Edges);
    assert!(contact.friction.is_some());
    assert!(read.found.plain().is_empty(), "{}", read.found.plain());
}

#[test]
fn penalties_are_made_from_the_elements_behind() {
    // one by two: E A/V is 500 below, 1000 at the sides
    let read = |slaves: &str, penalty: &str| {
        let text = (DECK.text())
            .replace("coords 2 1 1", "coords 2 1 2")
            .replace("coords 2 0 1", "coords 2 0 2")
            .replace("nelem 1", "nelem 5")
            .replace("nset 3", "nset 5 ncontactsurf 2")
            .replace("nbc 1", "nbc 2")
            .replace(
                "crosssect 1 mat 1\n",
                concat!(
                    "crosssect 1 mat 1\n",
                    "StructuralContactElement_LineLin 2 nodes 2 3 4 crosssect 1 mat 1\n",
                    "StructuralContactElement_LineLin 3 nodes 2 1 2 crosssect 1 mat 1\n",
                    "StructuralContactElement_LineLin 4 nodes 2 2 3 crosssect 1 mat 1\n",
                    "StructuralContactElement_LineLin 5 nodes 2 4 1 crosssect 1 mat 1\n",
                    "StructuralFEContactSurface 1 ce_set 4\nStructuralFEContactSurface 2 ce_set 5\n",
                ),
            )
            .replace(
                "ConstantFunction",
                &format!(
                    "structuralpenaltycontactbc 2 loadTimeFunction 1 dofs 2 1 2 {penalty} friction 0.3 \
                     mastersurface 1 slavesurface 2\nConstantFunction"
                ),
            );
        let text =
            format!("{text}set 4 elements 1 2\nset 5 elements {slaves}\n").replace("\n\n", "\n");
        let read = read(&RealFs, "job.in", text.as_bytes(), Compat::Oofem);
        read.unwrap_or_else(|found| panic!("{}", found.plain()))
            .case
    };
    let found = |case: &Case| -> Vec<(f64, Option<Vec<u64>>)> {
        let of = |contact: &crate::case::Contact| {
            let Enforcement::Penalty(Some(penalty)) = &contact.enforcement else {
                panic!()
            };
            let friction = contact.friction.as_ref().unwrap();
            assert_eq!(friction.stick, Some(Stick::Stiffness(penalty.value)));
            let mut sets = case.sets.iter();
            let set = sets.find(|set| set.name.value == contact.secondary.value);
            let elements = set.map(|set| match &set.content {
                SetContent::Elements(elements) => elements.clone(),
                other => panic!("{other:?}"),
            });
            (penalty.value, elements)
        };
        case.contacts.iter().map(of).collect()
    };
    let about = |found: &[(f64, Option<Vec<u64>>)], wanted: &[(f64, Option<Vec<u64>>)]| {
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found.0 / wanted.0 - 1.0).abs() < 1e-12, "{found:?}");
            assert_eq!(found.1, wanted.1);
        }
    };
    about(&found(&read("1 3", "autopenalty 1")), &[(500.0, None)]);
    about(
        &found(&read("3 3 4 5", "autopenalty 1 pn 7.")),
        &[(500.0, Some(vec![3])), (1000.0, Some(vec![4, 5]))],
    );
    about(
        &found(&read("1 3", "autopenalty 0 pn 7. pt 7.")),
        &[(7.0, None)],
    );
}

#[test]
fn checks_become_expectations() {
    let deck = Deck {
        checks: "#%BEGIN_CHECK% tolerance 1.e-3\n\
                 #NODE tStep 2 number 3 dof 2 unknown d value 1.5\n\
                 ## a remark\n\
                 #REACTION tStep 1 number 1 dof 1 value 2. tolerance 0.5\n\
                 #ELEMENT tStep 2 number 1 gp 1 keyword 4 component 6 value 4.\n\
                 #TIME tStep 2 value 1.\n\
                 #%END_CHECK%\n",
        ..DECK
    };
    let case = deck.case();
    let found: Vec<_> = (case.expectations.iter())
        .map(|one| (one.what.value.as_str(), one.at, one.value, one.tolerance))
        .collect();
    let (end, half) = (Moment::Time(1.0), Moment::Time(0.5));
    let within = Tolerance::Absolute;
    // OOFEM's first point is the one nearest to the third node; its shear strain is an angle
    let point = signorini_geometry::element::by_name("quad4").unwrap();
    let points = &point.full_rule().points;
    let third = points
        .iter()
        .position(|xi| xi.x > 0.0 && xi.y > 0.0)
        .unwrap()
        + 1;
    let strain = format!("strain.xy @ element 1 point {third}");
    assert_eq!(
        found,
        [
            ("displacement.y @ node 3", end, 1.5, within(1e-3)),
            ("reaction_force.x @ node 1", half, 2.0, within(0.5)),
            (strain.as_str(), end, 2.0, within(5e-4)),
        ]
    );
    let unasked = deck.text().replace("nmodules 1\nerrorcheck", "");
    let unasked = read(&RealFs, "job.in", unasked.as_bytes(), Compat::Oofem).unwrap();
    assert!(unasked.case.expectations.is_empty());
    assert!(unasked.found.plain().contains("no module `errorcheck`"));
}

/// A change of the deck, and what the message contains that follows.
type Fault = (fn(&mut Deck), &'static str);

fn assert_refused(changes: &[Fault]) {
    for (change, expected) in changes {
        let mut deck = DECK;
        change(&mut deck);
        let message = deck.refused();
        assert!(message.contains(expected), "{message}\n{expected}");
    }
}

#[test]
fn analyses_and_domains_that_are_not_built_are_refused_by_name() {
    assert_refused(&[
        (|d| d.analysis = "NonLinearStatic nsteps 2", "arc length"),
        (
            |d| d.analysis = "NonLinearStatic nsteps 2 controlmode 0",
            "arc length",
        ),
        (
            |d| d.analysis = "EigenValueDynamic nroot 2",
            "the analysis `eigenvaluedynamic`",
        ),
        (
            |d| d.analysis = "StaticStructural nsteps 0",
            "the deck has 0 steps",
        ),
        (
            |d| d.analysis = "StaticStructural nsteps 1 deltat -1.",
            "the length of steps is -1",
        ),
        (
            |d| d.analysis = "StaticStructural nsteps 1 ddm 2 1 1",
            "`ddm` of this staticstructural",
        ),
        (|d| d.domain = "3dShell", "the domain `3dshell`"),
    ]);
}

#[test]
fn faults_of_materials_and_elements_are_reported_with_their_records() {
    assert_refused(&[
        (
            |d| d.material = "Concrete2 1 d 0.",
            "the material `concrete2`",
        ),
        (
            |d| d.material = "isoLE 1 d 0. n 0.2",
            "this record has no `e`",
        ),
        (
            |d| d.material = "isoLE 2 d 0. E 1. n 0.2 talpha 0.",
            "have material 1, which",
        ),
        (
            |d| d.element = "quad1planestrain 1 nodes 4 1 2 3 4 crosssect 1 mat 1 nlgeo 2",
            "`nlgeo` other",
        ),
        (
            |d| d.element = "quad1planestrain 1 nodes 4 1 2 3 4 crosssect 1 mat 1 activityltf 2",
            "`activityltf` of this quad1planestrain record is not read",
        ),
    ]);
}

#[test]
fn faults_of_conditions_are_reported_with_their_records() {
    assert_refused(&[
        (
            |d| d.conditions = &["BoundaryCondition 1 loadTimeFunction 9 values 1 0 set 1"],
            "no function of time 9",
        ),
        (
            |d| d.conditions = &["BoundaryCondition 1 loadTimeFunction 1 values 1 0 set 8"],
            "there is no set 8",
        ),
        (
            |d| {
                d.conditions = &["BoundaryCondition 1 loadTimeFunction 1 dofs 1 3 values 1 0 set 1"]
            },
            "`dofs` is 3",
        ),
        (
            |d| d.conditions = &["LinearConstraintBC 1 weights 1 1."],
            "the condition `linearconstraintbc`",
        ),
    ]);
}

#[test]
fn functions_without_a_value_at_some_step_are_refused() {
    assert_refused(&[
        (
            |d| d.functions = &["PiecewiseLinFunction 1 t 2 1 1 f(t) 2 0 1"],
            "do not increase",
        ),
        (
            |d| d.functions = &["PiecewiseLinFunction 1 t 2 2 3 f(t) 2 0 1"],
            "begins at 2, after",
        ),
        (
            |d| d.functions = &["UsrDefLTF 1 f(t) $ 1/(t-1) $"],
            "its value at t = 1 is inf",
        ),
    ]);
}

#[test]
fn faults_of_checks_are_reported_with_their_step() {
    assert_refused(&[
        (
            |d| d.checks = "#%BEGIN_CHECK%\n#NODE tStep 1 number 3",
            "has no end",
        ),
        (
            |d| {
                d.checks =
                    "#%BEGIN_CHECK%\n#NODE tStep 9 number 3 dof 1 unknown d value 0\n#%END_CHECK%"
            },
            "there is no step 9",
        ),
        (
            |d| d.checks = "#%BEGIN_CHECK%\n#TIME tStep 1 value 9.\n#%END_CHECK%",
            "the time of step 1 is 0.5, not 9",
        ),
    ]);
}
