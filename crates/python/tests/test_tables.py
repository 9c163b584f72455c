"""Tables of a case: keys as attributes."""

from __future__ import annotations

import numpy as np
import pytest

import signorini as sg
from signorini import keys
from signorini._table import Items, Named, One, Table


def all_tables() -> list[type[Table]]:
    found = [one for one in vars(keys).values() if isinstance(one, type) and issubclass(one, Table)]
    return [one for one in found if one._attributes]


@pytest.mark.parametrize("table", all_tables(), ids=lambda table: table.__name__)
def test_every_key_has_a_docstring_with_its_meaning_and_toml_key(table: type[Table]) -> None:
    for name, key in table._attributes.items():
        text = getattr(table, name).__doc__
        assert key.doc in text
        assert f"`{key.path}`" in text


@pytest.mark.parametrize("table", all_tables(), ids=lambda table: table.__name__)
def test_every_key_can_be_set_read_and_removed(table: type[Table]) -> None:
    made = table.made_from({})
    for name, key in table._attributes.items():
        if isinstance(key, (One, Items, Named)):
            continue
        setattr(made, name, "word")
        assert getattr(made, name) == "word"
        assert made.to_dict() == {key.key: "word"}
        delattr(made, name)
        assert made.to_dict() == {}


def test_inner_tables_are_created_on_access() -> None:
    case = sg.Case()
    case.solver.newton.max_iterations = 20
    assert case.to_dict() == {"format": 1, "solver": {"newton": {"max_iterations": 20}}}


def test_reading_adds_nothing() -> None:
    case = sg.Case()
    assert case.solver.newton.max_iterations == 20
    assert list(case.contacts) == []
    assert case.output.every is not None
    assert case.to_dict() == {"format": 1}


def test_two_references_to_one_inner_table_are_the_same() -> None:
    case = sg.Case()
    first, second = case.solver.newton, case.solver.newton
    first.force_tol = 1e-8
    second.gap_tol = 1e-7
    assert case.to_dict()["solver"] == {"newton": {"force_tol": 1e-8, "gap_tol": 1e-7}}


def test_values_of_numpy_and_tuples_become_plain() -> None:
    step = sg.Case().step("press")
    step.load("top", force=np.array([0.0, 0.0, -1.0]))
    step.load("top", force=(np.float64(1.0), int(np.int32(2)), 3))
    assert type(step.loads[1].force[0]) is float  # type: ignore[index]  # pyright: ignore
    forces = [one.to_dict()["force"] for one in step.loads]
    assert forces == [[0.0, 0.0, -1.0], [1.0, 2, 3]]
    assert [type(x) for x in forces[1]] == [float, int, int]


def test_a_table_takes_a_dictionary_as_toml_would() -> None:
    case = sg.Case()
    case.solver = {"newton": {"max_iterations": 7}, "linear": "direct"}
    assert case.solver.newton.max_iterations == 7
    case.checkpoint.every = {"increments": 3}
    assert case.checkpoint.every.increments == 3


def test_an_unknown_key_proposes_the_closest() -> None:
    case = sg.Case()
    contact = case.contact("foot", "floor")
    with pytest.raises(AttributeError, match="did you mean 'friction'"):
        contact.fricton = 0.3  # type: ignore[attr-defined]  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(AttributeError, match="did you mean 'newton'"):
        _ = case.solver.newtn  # type: ignore[attr-defined]  # pyright: ignore
    with pytest.raises(AttributeError, match="did you mean 'penalty'"):
        contact.enforcement = {"penaltty": 1e5}


def test_a_method_is_not_overwritten() -> None:
    with pytest.raises(AttributeError, match="is a method"):
        sg.Case().body = "block"  # type: ignore[assignment,method-assign]  # pyright: ignore[reportAttributeAccessIssue]


def test_friction_is_a_number_or_a_table() -> None:
    contact = sg.Case().contact("foot", "floor", name="a")
    contact.friction.mu = 0.3
    contact.friction.cap = 20.0
    assert contact.to_dict()["friction"] == {"mu": 0.3, "cap": 20.0}
    contact.friction = 0.5
    assert contact.to_dict()["friction"] == 0.5


def test_lists_are_addressed_by_index_and_by_name() -> None:
    case = sg.Case()
    case.contact("a", "b", name="one")
    two = case.contact("c", "d", name="two")
    assert case.contacts["two"] is case.contacts[1] is case.contacts[-1] is two
    assert "two" in case.contacts and "three" not in case.contacts
    with pytest.raises(KeyError, match="did you mean 'one'"):
        _ = case.contacts["onne"]
    del case.contacts["one"]
    assert case.contacts.names() == ["two"]


def test_empty_lists_are_kept_where_they_were_assigned() -> None:
    step = sg.Case().step("turn")
    step.prints = []
    assert step.to_dict() == {"name": "turn", "print": []}


def test_none_and_del_remove_a_key() -> None:
    case = sg.Case(title="a", units="mm-N-MPa")
    case.title = None  # type: ignore[assignment]  # pyright: ignore[reportAttributeAccessIssue]
    del case.units
    assert case.to_dict() == {"format": 1}


def test_copies_are_independent_and_equal() -> None:
    case = sg.Case(units="mm-N-MPa")
    case.contact("foot", sg.Plane(normal="z"), name="floor", friction=0.3)
    case.step("press").move("head", z=-1.0)
    twin = case.copy()
    assert twin == case
    twin.contacts["floor"].friction = 0.4
    twin.steps["press"].moves[0].uz = -2.0
    assert twin != case
    assert case.contacts["floor"].friction == 0.3
    assert case.steps["press"].moves[0].uz == -1.0


def test_tables_print_what_was_given() -> None:
    assert repr(sg.LinearElastic(E=210e3, nu=0.3)) == "LinearElastic(E=210000.0, nu=0.3)"
    assert "<table>" in sg.LinearElastic(E=210e3, nu=0.3)._repr_html_()


def test_every_model_of_materials_has_a_class() -> None:
    models = {one._model for one in vars(keys).values() if isinstance(one, type) and issubclass(one, keys.Material)}
    declared = keys.Material._attributes["model"].values
    assert models - {""} == {word.strip('`"') for word in declared.split(", ")} - {"own"}


def test_materials_from_text_have_the_class_of_their_model() -> None:
    case = sg.Case.from_dict({"material": {"rubber": {"model": "neo-hookean", "E": 6.0, "nu": 0.4}}})
    assert isinstance(case.materials["rubber"], sg.NeoHookean)


def test_keys_that_python_reserves_have_an_underscore() -> None:
    assert keys.Axes(from_=[0, 0, 0]).to_dict() == {"from": [0, 0, 0]}
    assert sg.Case().constraint("cyclic", "a", with_="b").to_dict() == {"kind": "cyclic", "on": "a", "with": "b"}


def test_help_lists_units_and_toml_keys() -> None:
    text = sg.Case.contact.__doc__ or ""
    assert "[[contact]]" in text and "(length)" in text and "friction:" in text
