"""Own physics give the results of the built-in ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import signorini as sg

from .conftest import box, native, pressed

pytestmark = native

CENTER, RADIUS = np.array([0.4, 0.3, -3.0]), 3.001


def on_sphere(primary: Any, friction: Any = 0.2, **keys: Any) -> sg.Case:
    case = sg.Case(box(3))
    case.body("all", sg.NeoHookean(E=6.0, nu=0.3))
    case.contact("foot", primary, name="floor", method="gauss-point", friction=friction, **keys)
    step = case.step("press", increments={"fixed": 3}, geometry="nonlinear")
    step.move("head", x=0.01, y=0.0, z=-0.02)
    case.solver.newton.force_tol = 1e-12
    return case


def distance(x: np.ndarray) -> np.ndarray:
    return np.linalg.norm(x - CENTER, axis=1) - RADIUS


def gradient(x: np.ndarray) -> np.ndarray:
    return (x - CENTER) / np.linalg.norm(x - CENTER, axis=1, keepdims=True)


def hessian(x: np.ndarray) -> np.ndarray:
    n = gradient(x)
    r = np.linalg.norm(x - CENTER, axis=1)[:, None, None]
    return (np.eye(3) - n[:, :, None] * n[:, None, :]) / r


BALL = sg.Sphere(center=CENTER, radius=RADIUS)


def agree(own: sg.Case, built_in: sg.Case, tol: float = 1e-12) -> None:
    a, b = own.run(save=False), built_in.run(save=False)
    scale = np.abs(b.history["floor.force_z"]).max()
    assert scale > 0.0
    for axis in "xyz":
        assert np.allclose(a.history[f"floor.force_{axis}"], b.history[f"floor.force_{axis}"], rtol=0, atol=tol * scale)
    moved = np.abs(b[-1]["displacement"]).max()
    assert np.allclose(a[-1]["displacement"], b[-1]["displacement"], rtol=0, atol=tol * moved)


def test_a_signed_distance_is_a_sphere() -> None:
    agree(on_sphere(sg.SignedDistance(distance, gradient, hessian, size=RADIUS)), on_sphere(BALL))


def test_a_signed_distance_without_second_derivatives_is_a_sphere() -> None:
    agree(on_sphere(sg.SignedDistance(distance, gradient, size=RADIUS)), on_sphere(BALL), 1e-8)


def test_a_projection_is_a_sphere() -> None:
    def closest(x: np.ndarray) -> np.ndarray:
        return CENTER + RADIUS * gradient(x)

    own = sg.Projection(closest, gradient, lambda y: hessian(y), size=RADIUS)
    agree(on_sphere(own), on_sphere(BALL), 1e-9)


def test_a_contact_law_is_a_penalty() -> None:
    k = 200.0
    law = sg.ContactLaw(lambda g: (np.maximum(-k * g, 0.0), np.where(g <= 0.0, -k, 0.0)))
    penalty = {"penalty": k, "per": "area"}
    agree(on_sphere(BALL, 0.0, enforcement=law), on_sphere(BALL, 0.0, enforcement=penalty))


def test_a_friction_limit_is_that_of_coulomb() -> None:
    penalty = {"penalty": 200.0, "per": "area"}
    limit = sg.FrictionLimit(lambda p, path: (0.2 * p, np.full_like(p, 0.2)))
    agree(on_sphere(BALL, limit, enforcement=penalty), on_sphere(BALL, 0.2, enforcement=penalty))


def test_a_material_is_linear_elastic() -> None:
    E, nu = 6.0, 0.3
    lame, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)
    C = np.zeros((6, 6))
    C[:3, :3] = lame
    C[range(3), range(3)] += 2 * mu
    C[range(3, 6), range(3, 6)] = mu

    def respond(strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        stress = 2 * mu * strain
        stress[:, :3] += lame * strain[:, :3].sum(axis=1, keepdims=True)
        return stress, C

    def case(material: Any) -> sg.Case:
        case = pressed()
        case.materials["neo-hookean"] = material
        case.solver.newton.force_tol = 1e-12
        return case

    agree(case(sg.Material(respond, modulus=E)), case(sg.SaintVenantKirchhoff(E=E, nu=nu)))


def test_a_course_is_a_table() -> None:
    own, table = pressed(), pressed()
    own.steps[0].moves[0].uz = lambda t: -0.01 * t  # type: ignore[assignment]  # pyright: ignore
    agree(own, table)


def test_an_exception_in_own_physics_leaves_a_run_that_resumes(tmp_path: Path) -> None:
    calls = [0]

    def law(g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        calls[0] += 1
        if calls[0] == limit[0]:
            raise RuntimeError("of mine")
        return np.maximum(-200 * g, 0.0), np.where(g <= 0.0, -200.0, 0.0)

    limit = [0]
    whole = on_sphere(BALL, 0.0, enforcement=sg.ContactLaw(law)).run(save=False)
    limit[0] = calls[0] - 1
    calls[0] = 0
    with pytest.raises(RuntimeError, match="of mine") as caught:
        on_sphere(BALL, 0.0, enforcement=sg.ContactLaw(law)).run(tmp_path / "out")
    assert any(entry.name == "law" for entry in caught.traceback)
    limit[0] = 0
    resumed = on_sphere(BALL, 0.0, enforcement=sg.ContactLaw(law)).run(tmp_path / "out", resume=True)
    assert resumed.ok
    assert np.array_equal(resumed[-1]["displacement"], whole[-1]["displacement"])


def test_a_wrong_shape_is_named() -> None:
    with pytest.raises(ValueError, match="pressure of the contact law"):
        on_sphere(BALL, 0.0, enforcement=sg.ContactLaw(lambda g: (g[:1, None], g))).run(save=False)


def test_a_surface_is_asked_once_about_each_point() -> None:
    asked: list[bytes] = []

    def value(x: np.ndarray) -> np.ndarray:
        asked.append(x.tobytes())
        return distance(x)

    assert on_sphere(sg.SignedDistance(value, gradient, hessian, size=RADIUS)).run(save=False).ok
    assert 0 < len(asked) == len(set(asked))


def test_a_contact_law_is_asked_about_many_points_at_once() -> None:
    sizes: list[int] = []

    def law(gap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sizes.append(len(gap))
        return np.maximum(-200.0 * gap, 0.0), np.where(gap <= 0.0, -200.0, 0.0)

    assert on_sphere(BALL, 0.0, enforcement=sg.ContactLaw(law)).run(save=False).ok
    assert max(sizes) > 1
