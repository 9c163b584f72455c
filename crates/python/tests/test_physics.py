"""Own physics: shapes of what functions return."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import signorini as sg
from signorini.physics import checked

X = np.array([[0.0, 0.0, 3.0], [1.0, 2.0, 2.0]])


def sphere(**more: Any) -> sg.SignedDistance:
    return sg.SignedDistance(
        lambda x: np.linalg.norm(x, axis=1) - 2.0, lambda x: x / np.linalg.norm(x, axis=1, keepdims=True), **more
    )


def test_second_derivatives_by_differences_are_those_of_a_sphere() -> None:
    n = X / 3.0
    exact = (np.eye(3) - n[:, :, None] * n[:, None, :]) / 3.0
    assert np.allclose(sphere(size=2.0).hessian(X), exact, atol=1e-9)


def test_normal_gradients_by_differences_are_those_of_a_sphere() -> None:
    ball = sg.Projection(lambda x: 2.0 * x / np.linalg.norm(x, axis=1, keepdims=True), lambda y: y / 2.0, size=2.0)
    y = ball.closest(X)
    n = y / 2.0
    exact = (np.eye(3) - n[:, :, None] * n[:, None, :]) / 2.0
    assert np.allclose(ball.normal_gradient(y), exact, atol=1e-9)


def test_points_without_a_projection_are_nan() -> None:
    half = sg.Projection(lambda x: np.where(x[:, 2:] > 2.5, np.nan, x), lambda y: y)
    assert np.isnan(half.closest(X)).any(axis=1).tolist() == [True, False]


def two_arrays(strain: Any, old: Any) -> Any:
    return strain, strain


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sg.SignedDistance(lambda x: x, lambda x: x).value(X), r"shape \(2,\), found \(2, 3\)"),
        (lambda: sg.SignedDistance(lambda x: x[:, 0] / 0, lambda x: x).value(X), "not finite at 2"),
        (lambda: sg.ContactLaw(lambda g: g).pressure(X[:, 0]), "two arrays, found ndarray"),  # type: ignore[arg-type,return-value]
        (lambda: sg.ContactLaw(lambda g: (g, g[:1])).pressure(X[:, 0]), "derivative of the contact law"),
        (lambda: sg.FrictionLimit(lambda p, s: (p, "a")).limit(X[:, 0], X[:, 0]), "array of numbers"),
        (lambda: sg.Material(lambda e: (e, e), 1.0).respond(np.zeros((2, 6))), "tangent of the material"),
        (lambda: sg.Material(two_arrays, 1.0, history=1).respond(np.zeros((2, 6)), X), "3 arrays"),
        (lambda: sg.Material(lambda e: (e, e), -1.0), "modulus has to be positive"),
        (lambda: sg.SignedDistance(3, lambda x: x), "has to be a function"),  # type: ignore[arg-type]
        (lambda: sphere(size=0.0), "size has to be positive"),
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_what_is_wrong_is_named(call: Any, message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        call()


def test_constants_stand_for_all_points() -> None:
    stress, tangent = sg.Material(lambda e: (10.0 * e, 10.0 * np.eye(6)), 10.0).respond(np.ones((3, 6)))
    assert stress.shape == (3, 6) and tangent.shape == (3, 6, 6) and tangent.flags.c_contiguous
    assert checked(0.5, (3,), "x").tolist() == [0.5, 0.5, 0.5]


def test_a_ball_of_the_plane_gets_a_third_coordinate() -> None:
    assert sphere(ball=((0, 0), 2)).ball == ((0.0, 0.0, 0.0), 2.0)
