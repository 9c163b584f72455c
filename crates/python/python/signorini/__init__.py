"""Signorini: contact mechanics by finite elements.

>>> import signorini as sg
>>> case = sg.Case(units="mm-N-MPa")
>>> body = case.body("block", sg.LinearElastic(E=210e3, nu=0.3))
>>> case.bodies["block"].material
'linear-elastic'

A case is built in Python (`Case`), or read from a file (`load`); `Case.run` solves it and returns a `Result`, a sequence
of frames. `open` reads a folder of results. Every key of the case format is an attribute of the same name; the classes
of tables are in `signorini.keys`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import errors, keys, physics
    from ._native import version as __version__
    from .batch import run_many
    from .case import Case, Preview, Step, load
    from .errors import (
        Diagnostic,
        InputError,
        InternalError,
        LimitError,
        ModelError,
        NotConverged,
        OutputError,
        RestartError,
        SignoriniError,
    )
    from .folder import open
    from .history import History
    from .keys import (
        Anisotropic,
        Ciarlet,
        Circle,
        Cone,
        Cylinder,
        Hyperfoam,
        LinearElastic,
        LinearElasticByTemperature,
        MooneyRivlin,
        MooneyRivlinLogarithmic,
        NeoHookean,
        NoCompression,
        NoTension,
        Ogden,
        Orthotropic,
        Plane,
        Polynomial,
        RambergOsgood,
        RambergOsgoodEulerian,
        RotatedLinear,
        SaintVenantKirchhoff,
        Sphere,
        Torus,
    )
    from .mesh import Mesh
    from .physics import ContactLaw, FrictionLimit, Material, Projection, SignedDistance
    from .result import ContactFrame, Frame, Increment, Result
    from .stepper import Stepper

_HOMES = {
    "batch": ["run_many"],
    "case": ["Case", "Preview", "Step", "load"],
    "errors": [
        "Diagnostic",
        "InputError",
        "InternalError",
        "LimitError",
        "ModelError",
        "NotConverged",
        "OutputError",
        "RestartError",
        "SignoriniError",
    ],
    "folder": ["open"],
    "history": ["History"],
    "keys": [
        "Anisotropic",
        "Ciarlet",
        "Circle",
        "Cone",
        "Cylinder",
        "Hyperfoam",
        "LinearElastic",
        "LinearElasticByTemperature",
        "MooneyRivlin",
        "MooneyRivlinLogarithmic",
        "NeoHookean",
        "NoCompression",
        "NoTension",
        "Ogden",
        "Orthotropic",
        "Plane",
        "Polynomial",
        "RambergOsgood",
        "RambergOsgoodEulerian",
        "RotatedLinear",
        "SaintVenantKirchhoff",
        "Sphere",
        "Torus",
    ],
    "mesh": ["Mesh"],
    "physics": ["ContactLaw", "FrictionLimit", "Material", "Projection", "SignedDistance"],
    "result": ["ContactFrame", "Frame", "Increment", "Result"],
    "stepper": ["Stepper"],
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "Anisotropic",
    "Case",
    "Ciarlet",
    "Circle",
    "Cone",
    "ContactFrame",
    "ContactLaw",
    "Cylinder",
    "Diagnostic",
    "Frame",
    "FrictionLimit",
    "History",
    "Hyperfoam",
    "Increment",
    "InputError",
    "InternalError",
    "LimitError",
    "LinearElastic",
    "LinearElasticByTemperature",
    "Material",
    "Mesh",
    "ModelError",
    "MooneyRivlin",
    "MooneyRivlinLogarithmic",
    "NeoHookean",
    "NoCompression",
    "NoTension",
    "NotConverged",
    "Ogden",
    "Orthotropic",
    "OutputError",
    "Plane",
    "Polynomial",
    "Preview",
    "Projection",
    "RambergOsgood",
    "RambergOsgoodEulerian",
    "RestartError",
    "Result",
    "RotatedLinear",
    "SaintVenantKirchhoff",
    "SignedDistance",
    "SignoriniError",
    "Sphere",
    "Step",
    "Stepper",
    "Torus",
    "__version__",
    "errors",
    "keys",
    "load",
    "open",
    "physics",
    "run_many",
]


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name == "__version__":
        found = import_module("._native", __name__).version
    elif name in _HOME:
        found = getattr(import_module(f".{_HOME[name]}", __name__), name)
    elif name in ("errors", "keys", "physics"):
        return import_module(f".{name}", __name__)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
