"""The Rust side of the package."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Ids = NDArray[np.int64]
_Sets = dict[str, tuple[_Ids, _Ids, _Ids]]
_Diagnostics = list[dict[str, Any]]

__all__ = [
    "ContactFrame",
    "Frame",
    "Job",
    "Loaded",
    "Mesh",
    "Outcome",
    "Stepper",
    "check",
    "load",
    "main",
    "parse",
    "read_vtu",
    "report",
    "run",
    "schema",
    "version",
    "write",
]

version: str

def main(words: Sequence[str]) -> int:
    """Runs the command with these words, the name of the program the first; returns the exit code."""

def schema() -> str:
    """The JSON schema of a case."""

def parse(text: str, name: str = "case.toml") -> dict[str, Any]:
    """TOML as dictionaries. Raises `InputError`."""

def write(case: Mapping[str, Any]) -> str:
    """Dictionaries as TOML; floats to the last bit, keys in their order."""

def report(folder: str, compare: str | None = None) -> bytes:
    """The page of a folder of results, in UTF-8."""

def read_vtu(path: str) -> dict[str, Any]:
    """The arrays of a .vtu file: points, types, offsets, connectivity, point_data, cell_data, field_data."""

@final
class Mesh:
    """An immutable mesh."""

    def __new__(
        cls,
        points: _Floats,
        node_labels: NDArray[np.uint64] | None,
        blocks: Sequence[tuple[str, _Ids, NDArray[np.uint64] | None]],
        sets: Mapping[str, tuple[_Ids, _Ids, _Ids]],
    ) -> Mesh: ...
    @staticmethod
    def read(path: str) -> tuple[Mesh, _Diagnostics]:
        """Reads a mesh file."""
    @property
    def points(self) -> _Floats:
        """Coordinates (n, 3)."""
    @property
    def node_labels(self) -> NDArray[np.uint64]:
        """Numbers of the nodes."""
    @property
    def blocks(self) -> list[tuple[str, NDArray[np.uint32], NDArray[np.uint64]]]:
        """Element type, node indices and numbers of the cells of each block."""
    @property
    def sets(self) -> _Sets:
        """Nodes, cells [block, index] and faces [block, index, side] by name."""
    def boundary(self) -> tuple[_Ids, _Floats, _Floats]:
        """Outer faces of the solids, their centres and outward unit normals."""
    def face_nodes(self, faces: _Ids) -> list[_Ids]:
        """Node indices of faces."""
    def to_toml(self) -> str:
        """`[mesh]` in place, and `[sets]`."""

@final
class Job:
    """A case as text, with a mesh in memory and own physics."""

    def __new__(
        cls,
        text: str,
        name: str,
        folder: str,
        mesh: Mesh | None = None,
        record: str | None = None,
        own: Mapping[str, Mapping[str, Any]] | None = None,
        set: Sequence[tuple[str, str]] = ...,
    ) -> Job: ...

@final
class Loaded:
    """A case or a deck that was read from a file."""

    text: str
    mesh: Mesh
    mesh_file: str | None
    folder: str
    diagnostics: _Diagnostics

def load(path: str, set: Sequence[tuple[str, str]] = ..., compat: str | None = None) -> Loaded:
    """Reads a case or a deck with its mesh. Raises `InputError`."""

def check(job: Job) -> tuple[list[str], _Diagnostics]:
    """The lines that `signorini check` prints. Raises `InputError`, `ModelError`."""

@final
class ContactFrame:
    """One contact at one time."""

    name: str
    nodes: NDArray[Any]
    points: _Floats
    displacement: _Floats
    normal: _Floats
    gap: _Floats
    pressure: _Floats
    pressure_max: _Floats
    multiplier: _Floats
    multiplier_traction: _Floats
    traction: _Floats
    slip: _Floats
    status: NDArray[np.int8]
    area: _Floats
    nodal_force: _Floats
    facets: list[tuple[str, _Ids]]
    force: _Floats
    moment: _Floats
    force_normal: _Floats
    force_shear: _Floats
    center: _Floats
    area_open: float
    area_stick: float
    area_slip: float
    gap_min: float
    slip_max: float
    peak: float
    work_friction: float

@final
class Frame:
    """The results at one time."""

    time: float
    step: str
    increment: int
    contacts: list[ContactFrame]

    def names(self) -> list[str]:
        """The fields at nodes."""
    def field(self, name: str) -> NDArray[Any]:
        """A field at the nodes."""
    def cell_names(self) -> list[str]:
        """The fields of cells."""
    def cell_field(self, name: str) -> NDArray[Any]:
        """A field of the cells of the highest dimension."""

@final
class Outcome:
    """How a run ended."""

    exit_code: int
    status: str
    diagnostics: _Diagnostics
    summary: str
    history: str
    convergence: str
    frames: list[Frame]
    worst_nodes: list[int]
    error: BaseException | None

def run(
    job: Job,
    output: str | None = None,
    *,
    fresh: bool = False,
    resume: bool = False,
    threads: int | None = None,
    keep: bool = True,
    on_event: Callable[[dict[str, Any]], object] | None = None,
    on_iteration: Callable[[dict[str, Any]], object] | None = None,
    on_increment: Callable[[Frame, dict[str, Any]], object] | None = None,
) -> Outcome:
    """Solves a job. What returns true stops the run."""

@final
class Stepper:
    """A run driven from Python."""

    def __new__(cls, job: Job, threads: int | None = None) -> Stepper: ...
    time: float
    end: float
    done: bool
    frame: Frame

    def advance(self, dt: float) -> Frame:
        """Goes forward by a time."""
    def save(self) -> bytes:
        """The state."""
    def restore(self, state: bytes) -> None:
        """Goes to a state."""
    def update(self, job: Job) -> None:
        """Goes on with a changed case."""
