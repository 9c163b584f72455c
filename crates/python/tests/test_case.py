"""Cases built in Python, as dictionaries."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import signorini as sg


def plain(case: sg.Case) -> dict[str, Any]:
    return case.to_dict()


def test_a_case_says_what_its_methods_were_told() -> None:
    case = sg.Case(title="t", units="mm-N-MPa")
    case.body(["sphere", "block"], sg.LinearElastic(E=1000.0, nu=0.3))
    case.contact("sphere_surface", "block_top", name="ball")
    press = case.step("press", increments=10)
    press.fix("block_bottom", "z")
    press.load("sphere_top", force=(0, 0, -25.0), coupling="rigid-z")
    assert plain(case) == {
        "format": 1,
        "title": "t",
        "units": "mm-N-MPa",
        "material": {"linear-elastic": {"model": "linear-elastic", "E": 1000.0, "nu": 0.3}},
        "body": [{"group": ["sphere", "block"], "material": "linear-elastic"}],
        "contact": [{"name": "ball", "secondary": "sphere_surface", "primary": "block_top"}],
        "step": [
            {
                "name": "press",
                "increments": 10,
                "fix": [{"on": "block_bottom", "u": ["z"]}],
                "load": [{"on": "sphere_top", "force": [0, 0, -25.0], "coupling": "rigid-z"}],
            }
        ],
    }


def test_a_shape_becomes_a_surface_with_a_name_of_its_own() -> None:
    case = sg.Case()
    for name in ("floor", "wall"):
        case.contact("foot", sg.Plane(normal=(0, 0, 1)), name=name)
    case.contact("foot", case.surfaces["floor-surface"], name="again")
    values = plain(case)
    assert [one["name"] for one in values["surface"]] == ["floor-surface", "wall-surface"]
    assert [one["primary"] for one in values["contact"]] == ["floor-surface", "wall-surface", "floor-surface"]
    assert values["surface"][0]["shape"] == {"plane": {"normal": [0, 0, 1], "point": [0.0, 0.0, 0.0]}}


def test_one_material_object_is_one_material() -> None:
    case = sg.Case()
    rubber = sg.NeoHookean(E=6.0, nu=0.4)
    case.body("a", rubber)
    case.body("b", rubber)
    case.body("c", sg.NeoHookean(E=7.0, nu=0.4))
    values = plain(case)
    assert list(values["material"]) == ["neo-hookean", "neo-hookean-2"]
    assert [one["material"] for one in values["body"]] == ["neo-hookean", "neo-hookean", "neo-hookean-2"]


def test_objects_may_be_assigned_where_a_name_is_expected() -> None:
    case = sg.Case()
    body = case.body("a")
    body.material = sg.NeoHookean(E=6.0, nu=0.4)  # type: ignore[assignment]  # pyright: ignore
    contact = case.contact("foot", "top", name="c")
    contact.primary = sg.Sphere(radius=2.0)
    values = plain(case)
    assert values["body"] == [{"group": "a", "material": "neo-hookean"}]
    assert values["surface"] == [{"name": "surface", "shape": {"sphere": {"radius": 2.0, "center": [0.0, 0.0, 0.0]}}}]
    assert values["contact"][0]["primary"] == "surface"


@pytest.mark.parametrize(
    ("given", "wanted"),
    [("all", "all"), ("z", ["z"]), ("xy", ["x", "y"]), (["x", "z"], ["x", "z"]), (None, "all")],
)
def test_directions(given: Any, wanted: Any) -> None:
    assert sg.Case().step().fix("a", given).to_dict() == {"on": "a", "u": wanted}


def test_directions_that_do_not_exist_are_refused() -> None:
    with pytest.raises(ValueError, match="'w'"):
        sg.Case().step().fix("a", "xw")


def test_rotations_alone_hold_no_displacements() -> None:
    assert sg.Case().step().fix("a", rot="all").to_dict() == {"on": "a", "rot": "all"}


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        (10, 10),
        ((0.02, 1e-6, 0.05), {"initial": 0.02, "min": 1e-6, "max": 0.05}),
        ((0.1,), {"initial": 0.1}),
        ({"fixed": 3}, {"fixed": 3}),
    ],
)
def test_increments(given: Any, wanted: Any) -> None:
    assert sg.Case().step("s", increments=given).to_dict()["increments"] == wanted


def test_motions_over_time() -> None:
    case = sg.Case()
    step = case.step("s")
    step.move("a", z=-0.4)
    step.move("b", x=[[0, 0], [1, 8], [2, 0]])
    step.move("c", rz=np.array([[0.0, 0.0], [1.0, 2.0]]))
    step.move("d", y=lambda t: t * t)
    step.move("e", uy={"amplitude": "saw", "value": 8.0})
    moves = plain(case)["step"][0]["move"]
    assert moves == [
        {"on": "a", "uz": -0.4},
        {"on": "b", "ux": {"table": [[0, 0], [1, 8], [2, 0]]}},
        {"on": "c", "rz": {"table": [[0.0, 0.0], [1.0, 2.0]]}},
        {"on": "d", "uy": {"amplitude": "course"}},
        {"on": "e", "uy": {"amplitude": "saw", "value": 8.0}},
    ]
    assert plain(case)["amplitude"] == {"course": {"own": "course"}}


def test_loads_over_time() -> None:
    case = sg.Case()
    step = case.step("s")
    step.load("a", pressure=[[0, 0], [1, 0.5]])
    step.load("b", force=(1, 0, 0), amplitude=[[0, 0], [1, 1]])
    step.load("c", force=(1, 0, 0), amplitude=np.sin)
    loads = plain(case)["step"][0]["load"]
    assert loads[0] == {"on": "a", "pressure": 1.0, "table": [[0, 0], [1, 0.5]]}
    assert loads[1]["table"] == [[0, 0], [1, 1]]
    assert loads[2]["amplitude"] == "course"


@pytest.mark.parametrize("given", [{}, {"force": (1, 0, 0), "pressure": 1.0}])
def test_a_load_is_exactly_one_quantity(given: Any) -> None:
    with pytest.raises(TypeError, match="a load is one of"):
        sg.Case().step().load("a", **given)


def test_a_motion_is_given_once() -> None:
    with pytest.raises(TypeError, match="the same"):
        sg.Case().step().move("a", x=1.0, ux=1.0)


def test_own_physics_are_named_and_collected() -> None:
    law = sg.ContactLaw(lambda g: (g, g))
    hill = sg.SignedDistance(lambda x: x[:, 2], lambda x: x)
    rubber = sg.Material(lambda e: (e, e), modulus=6.0, density=1e-9)
    limit = sg.FrictionLimit(lambda p, s: (p, p))
    case = sg.Case()
    case.body("a", rubber)
    case.contact("foot", hill, name="one", enforcement=law, friction=limit)
    case.contact("foot", "top", name="two", enforcement=law)
    case.amplitude("wave", np.sin, time="total")
    values, own = case._resolved()
    assert values["contact"] == [
        {
            "name": "one",
            "secondary": "foot",
            "primary": "one-surface",
            "enforcement": {"own": "one"},
            "friction": {"own": "one"},
        },
        {"name": "two", "secondary": "foot", "primary": "top", "enforcement": {"own": "one"}},
    ]
    assert values["surface"] == [{"name": "one-surface", "shape": {"own": "one-surface"}}]
    assert values["material"] == {"own": {"model": "own", "own": "material", "density": 1e-9}}
    assert values["amplitude"] == {"wave": {"own": "course", "time": "total"}}
    assert own["surface"] == {"one-surface": hill}
    assert list(own["law"].values()) == [law]
    assert list(own["friction"].values()) == [limit]
    assert own["material"] == {"material": rubber}
    assert own["course"] == {"course": np.sin}


def test_sets_expectations_history_references() -> None:
    case = sg.Case()
    case.set("top", plane="z", at=1.0)
    case.reference("pilot", at=(0, 0, 10))
    case.expect("floor.force_z", 25.0, rel=1e-6)
    case.history("pull", ["force_x", "force_z"], contact="floor")
    case.constraint("kinematic", "head", reference="pilot")
    case.spring("soft", on="base", stiffness=12.0)
    values = plain(case)
    assert values["sets"] == {"top": {"plane": "z", "at": 1.0}}
    assert values["reference"] == {"pilot": {"at": [0, 0, 10]}}
    assert values["expect"] == [{"what": "floor.force_z", "value": 25.0, "tol": {"rel": 1e-6}}]
    assert values["output"] == {"history": [{"name": "pull", "quantity": ["force_x", "force_z"], "contact": "floor"}]}
    assert values["constraint"] == [{"kind": "kinematic", "on": "head", "reference": "pilot"}]
    assert values["spring"] == [{"name": "soft", "on": "base", "stiffness": 12.0}]


def test_what_is_no_data_is_refused_with_its_key() -> None:
    case = sg.Case()
    case.contact("a", "b", name="c", area=object())  # type: ignore[arg-type]  # pyright: ignore
    with pytest.raises(TypeError, match="`area` of Contact"):
        plain(case)


def test_a_case_shows_itself() -> None:
    case = sg.Case(title="a <b>")
    case.body("block", sg.LinearElastic(E=1.0, nu=0.0))
    case.step("press").fix("base")
    assert repr(case) == "<Case: 'a <b>', bodies block, steps press>"
    assert "a &lt;b&gt;" in case._repr_html_()
