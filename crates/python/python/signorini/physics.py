"""Own physics in Python: rigid surfaces, contact laws, friction limits, materials and courses over time.

All functions are vectorised: they receive arrays over points and return arrays over the same points. What they return
is checked for its shape. Exceptions raised in them end the run and leave it resumable. They must answer the same whenever
they are asked: surfaces are asked once about each point of a run.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias, cast

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array: TypeAlias = NDArray[np.float64]

Course: TypeAlias = Callable[[float], float]
"""A factor over time: any function of the time that returns a number. As an amplitude, or as the value of a motion."""

KINDS = ("surface", "law", "friction", "material", "course")


class Physics:
    """What a case can name but only this program has."""

    kind = ""


def checked(value: Any, shape: tuple[int, ...], what: str) -> Array:
    """A returned array as C-contiguous float64, of this shape and finite.

    >>> checked([1.0, 2.0], (2,), "pressure of MyLaw")
    array([1., 2.])
    """
    import numpy as np

    try:
        out = np.asarray(value, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise TypeError(
            f"{what} has to be an array of numbers of shape {shape}, found {type(value).__name__}"
        ) from error
    if out.shape != shape:
        if out.ndim < len(shape) and _fits(out.shape, shape):
            return np.ascontiguousarray(np.broadcast_to(out, shape))
        raise ValueError(f"{what} has to have shape {shape}, found {out.shape}")
    if not np.isfinite(out).all():
        raise ValueError(f"{what} is not finite at {int((~np.isfinite(out)).sum())} of {out.size} values")
    return out


def _fits(found: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    """Whether a constant may stand for all points: the trailing dimensions agree."""
    return found == () or found == wanted[len(wanted) - len(found) :]


def _pair(value: Any, what: str) -> tuple[Any, Any]:
    if isinstance(value, tuple):
        pair = cast("tuple[Any, ...]", value)
        if len(pair) == 2:
            return pair[0], pair[1]
    raise TypeError(f"{what} has to return two arrays, found {type(cast('Any', value)).__name__}")


def _name(function: Callable[..., Any]) -> str:
    return getattr(function, "__qualname__", type(function).__name__)


def _needs_callable(function: object, what: str) -> None:
    if not callable(function):
        raise TypeError(f"{what} has to be a function of arrays, found {type(function).__name__}")


class SignedDistance(Physics):
    """A rigid surface given by its signed distance: positive outside, where bodies are.

    Parameters
    ----------
    value: `x (n, 3) -> (n,)`, the distance (length); near the surface only its zeros and gradient have to be exact
    gradient: `x (n, 3) -> (n, 3)`, the gradient of `value`, without unit; of length 1 for a true distance
    hessian: `x (n, 3) -> (n, 3, 3)` (1/length); absent: by central differences of the gradient
    size: a length over which the surface bends, for tolerances and differences
    ball: `(center, radius)` that contains the surface, where it is bounded

    TOML: `shape = { own = "NAME" }` of `[[surface]]`.

    >>> import numpy as np
    >>> sphere = SignedDistance(
    ...     lambda x: np.linalg.norm(x, axis=1) - 2.0,
    ...     lambda x: x / np.linalg.norm(x, axis=1, keepdims=True),
    ...     size=2.0,
    ... )
    >>> sphere.value(np.array([[0.0, 0.0, 3.0]]))
    array([1.])
    """

    kind = "surface"

    def __init__(
        self,
        value: Callable[[Array], ArrayLike],
        gradient: Callable[[Array], ArrayLike],
        hessian: Callable[[Array], ArrayLike] | None = None,
        size: float = 1.0,
        ball: tuple[ArrayLike, float] | None = None,
    ) -> None:
        _needs_callable(value, "value")
        _needs_callable(gradient, "gradient")
        if not size > 0.0:
            raise ValueError(f"size has to be positive, found {size}")
        self._value = value
        self._gradient = gradient
        self._hessian = hessian
        self.size = float(size)
        self.ball: tuple[list[float], float] | None = None
        if ball is not None:
            import numpy as np

            center = [float(x) for x in np.asarray(ball[0], dtype=float)]
            self.ball = ((*center, 0.0, 0.0)[:3], float(ball[1]))  # type: ignore[assignment]  # pyright: ignore[reportAttributeAccessIssue]

    def value(self, x: Array) -> Array:
        """The signed distance (length) at points `(n, 3)`."""
        return checked(self._value(x), (len(x),), f"the signed distance {_name(self._value)}")

    def gradient(self, x: Array) -> Array:
        """Its gradient `(n, 3)`."""
        return checked(self._gradient(x), (len(x), 3), f"the gradient {_name(self._gradient)}")

    def hessian(self, x: Array) -> Array:
        """Its second derivatives `(n, 3, 3)` (1/length)."""
        import numpy as np

        if self._hessian is not None:
            return checked(self._hessian(x), (len(x), 3, 3), f"the Hessian {_name(self._hessian)}")
        step = 6e-6 * self.size
        out = np.empty((len(x), 3, 3))
        for j in range(3):
            shift = np.zeros(3)
            shift[j] = step
            out[:, :, j] = (self.gradient(x + shift) - self.gradient(x - shift)) / (2.0 * step)
        return 0.5 * (out + np.swapaxes(out, 1, 2))

    def __repr__(self) -> str:
        return f"SignedDistance({_name(self._value)}, size={self.size:g})"


class Projection(Physics):
    """A rigid surface given by the closest point and the outward unit normal there.

    Parameters
    ----------
    closest: `x (n, 3) -> (n, 3)`, the closest point of the surface (length); NaN rows where there is none
    normal: `y (n, 3) -> (n, 3)`, the unit normal at points of the surface, towards the bodies
    normal_gradient: `y (n, 3) -> (n, 3, 3)` (1/length); absent: by central differences of the normal
    size: a length over which the surface bends

    TOML: `shape = { own = "NAME" }` of `[[surface]]`.
    """

    kind = "surface"

    def __init__(
        self,
        closest: Callable[[Array], ArrayLike],
        normal: Callable[[Array], ArrayLike],
        normal_gradient: Callable[[Array], ArrayLike] | None = None,
        size: float = 1.0,
    ) -> None:
        _needs_callable(closest, "closest")
        _needs_callable(normal, "normal")
        if not size > 0.0:
            raise ValueError(f"size has to be positive, found {size}")
        self._closest = closest
        self._normal = normal
        self._normal_gradient = normal_gradient
        self.size = float(size)

    def closest(self, x: Array) -> Array:
        """The closest points `(n, 3)` (length); NaN where there is none."""
        import numpy as np

        what = f"the closest points {_name(self._closest)}"
        out = np.ascontiguousarray(self._closest(x), dtype=np.float64)
        missing = np.isnan(out).any(axis=-1) if out.shape == (len(x), 3) else None
        if missing is None or not missing.any():
            return checked(out, (len(x), 3), what)
        checked(out[~missing], (int((~missing).sum()), 3), what)
        return out

    def normal(self, x: Array) -> Array:
        """The outward unit normals `(n, 3)` at points of the surface."""
        return checked(self._normal(x), (len(x), 3), f"the normals {_name(self._normal)}")

    def normal_gradient(self, x: Array) -> Array:
        """The gradients `(n, 3, 3)` of the normals (1/length)."""
        import numpy as np

        if self._normal_gradient is not None:
            what = f"the gradients of normals {_name(self._normal_gradient)}"
            return checked(self._normal_gradient(x), (len(x), 3, 3), what)
        step = 6e-6 * self.size
        out = np.empty((len(x), 3, 3))
        for j in range(3):
            shift = np.zeros(3)
            shift[j] = step
            out[:, :, j] = (self.normal(self.closest(x + shift)) - self.normal(self.closest(x - shift))) / (2.0 * step)
        return out

    def __repr__(self) -> str:
        return f"Projection({_name(self._closest)}, size={self.size:g})"


class ContactLaw(Physics):
    """A pressure as a function of the gap.

    `pressure(gap (n,)) -> (p (n,), dp_dgap (n,))`: the gap (length) is negative in penetration; `p` is a pressure (or a
    force per node with `per = "node"`), positive in compression, and must not grow with the gap. `energy(gap (n,)) -> (n,)`,
    where it is given, serves line searches and energy balances.

    TOML: `enforcement = { own = "NAME" }` of `[[contact]]`.

    >>> import numpy as np
    >>> law = ContactLaw(lambda g: (np.maximum(-1e4 * g, 0.0), np.where(g < 0.0, -1e4, 0.0)))
    >>> law.pressure(np.array([-0.001, 0.5]))[0]
    array([10.,  0.])
    """

    kind = "law"

    def __init__(
        self,
        pressure: Callable[[Array], tuple[ArrayLike, ArrayLike]],
        energy: Callable[[Array], ArrayLike] | None = None,
    ) -> None:
        _needs_callable(pressure, "pressure")
        self._pressure = pressure
        self._energy = energy

    @property
    def has_energy(self) -> bool:
        """Whether the law gives an energy."""
        return self._energy is not None

    def energy(self, gap: Array) -> Array:
        """Energies per area: the derivative by the gap is minus the pressure."""
        if self._energy is None:
            raise TypeError("this contact law gives no energy")
        return checked(self._energy(gap), gap.shape, f"the energy of the contact law {_name(self._energy)}")

    def pressure(self, gap: Array) -> tuple[Array, Array]:
        """Pressures and their derivatives by the gap."""
        name = _name(self._pressure)
        p, slope = _pair(self._pressure(gap), f"the contact law {name}")
        return (
            checked(p, gap.shape, f"the pressure of the contact law {name}"),
            checked(slope, gap.shape, f"the derivative of the contact law {name}"),
        )

    def __repr__(self) -> str:
        return f"ContactLaw({_name(self._pressure)})"


class FrictionLimit(Physics):
    """The largest shear traction as a function of the pressure and of the length of slip at the start of the increment.

    `limit(pressure (n,), path (n,)) -> (limit (n,), dlimit_dpressure (n,))`: limit and pressure (stress), path (length).

    TOML: `friction = { own = "NAME" }` of `[[contact]]`.

    >>> import numpy as np
    >>> coulomb = FrictionLimit(lambda p, s: (0.3 * p, np.full_like(p, 0.3)))
    >>> coulomb.limit(np.array([10.0]), np.array([0.0]))[0]
    array([3.])
    """

    kind = "friction"

    def __init__(self, limit: Callable[[Array, Array], tuple[ArrayLike, ArrayLike]]) -> None:
        _needs_callable(limit, "limit")
        self._limit = limit

    def limit(self, pressure: Array, path: Array) -> tuple[Array, Array]:
        """The limits and their derivatives by the pressure."""
        name = _name(self._limit)
        limit, slope = _pair(self._limit(pressure, path), f"the friction limit {name}")
        return (
            checked(limit, pressure.shape, f"the limit of the friction law {name}"),
            checked(slope, pressure.shape, f"the derivative of the friction law {name}"),
        )

    def __repr__(self) -> str:
        return f"FrictionLimit({_name(self._limit)})"


class Material(Physics):
    """A material by its stress and tangent.

    Parameters
    ----------
    respond: `strain (n, 6)[, old (n, history)] -> stress (n, 6), tangent (n, 6, 6)[, new (n, history)]`; components
        xx yy zz xy yz xz of the tensors (shears are not doubled). At finite strain, Green-Lagrange strain and second
        Piola-Kirchhoff stress (stress). `tangent[:, i, j]` multiplies the engineering strain j, whose shears are doubled.
    modulus: a stiffness (stress) of the size of Young's modulus, for penalties and scales
    history: how many internal variables each point has; they start at zero
    symmetric: whether the tangent is
    density: mass per volume, `expansion`: as in `[material.NAME]`

    TOML: `model = "own"`, `own = "NAME"` of `[material.NAME]`.
    """

    kind = "material"

    def __init__(
        self,
        respond: Callable[[Array], tuple[ArrayLike, ArrayLike]]
        | Callable[[Array, Array], tuple[ArrayLike, ArrayLike, ArrayLike]],
        modulus: float,
        history: int = 0,
        symmetric: bool = True,
        *,
        density: float | None = None,
        expansion: Any = None,
    ) -> None:
        _needs_callable(respond, "respond")
        if not modulus > 0.0:
            raise ValueError(f"modulus has to be positive, found {modulus}")
        if history < 0:
            raise ValueError(f"history has to be a count, found {history}")
        self._respond = cast("Callable[..., Any]", respond)
        self.modulus = float(modulus)
        self.history = int(history)
        self.symmetric = bool(symmetric)
        self.density = density
        self.expansion = expansion

    def respond(self, strain: Array, old: Array | None = None) -> tuple[Array, ...]:
        """Stresses, tangents and, with a history, its new values."""
        name = _name(self._respond)
        given = (strain,) if self.history == 0 else (strain, old)
        found = self._respond(*given)
        count = 2 if self.history == 0 else 3
        if not isinstance(found, tuple) or len(cast("tuple[Any, ...]", found)) != count:
            raise TypeError(
                f"the material {name} has to return {count} arrays, found {type(cast('Any', found)).__name__}"
            )
        found = cast("tuple[Any, ...]", found)
        n = len(strain)
        out = (
            checked(found[0], (n, 6), f"the stress of the material {name}"),
            checked(found[1], (n, 6, 6), f"the tangent of the material {name}"),
        )
        if self.history == 0:
            return out
        return (*out, checked(found[2], (n, self.history), f"the history of the material {name}"))

    def as_table(self) -> dict[str, Any]:
        """Its keys in a case."""
        table: dict[str, Any] = {"model": "own", "own": self}
        if self.density is not None:
            table["density"] = self.density
        if self.expansion is not None:
            table["expansion"] = self.expansion
        return table

    def __repr__(self) -> str:
        return f"Material({_name(self._respond)}, modulus={self.modulus:g})"
