"""Sets of a mesh by name, checked when they are assigned."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._table import did_you_mean

Ids: TypeAlias = NDArray[np.int64]


class Sets(MutableMapping[str, Ids]):
    """Named arrays. They are read-only; assign another array to change one."""

    kind = "set"

    def __init__(self, change: Callable[[], None]) -> None:
        self._sets: dict[str, Ids] = {}
        self._change = change

    def check(self, name: str, value: Any) -> Ids:
        """The array to store, or an error that says what is wrong with it."""
        raise NotImplementedError

    def fill(self, sets: Mapping[str, Any] | None) -> None:
        """Assigns several sets."""
        for name, value in (sets or {}).items():
            self[name] = value

    def __getitem__(self, name: str) -> Ids:
        if name not in self._sets:
            raise KeyError(f"the mesh has no {self.kind} called {name!r}{did_you_mean(name, self._sets)}")
        return self._sets[name]

    def __setitem__(self, name: str, value: ArrayLike | Sequence[Any]) -> None:
        if not isinstance(name, str) or not name:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise TypeError(f"the name of a {self.kind} has to be text, found {name!r}")
        checked = self.check(name, value)
        checked.flags.writeable = False
        self._sets[name] = checked
        self._change()

    def __delitem__(self, name: str) -> None:
        _ = self[name]
        del self._sets[name]
        self._change()

    def __contains__(self, name: object) -> bool:
        return name in self._sets

    def __iter__(self) -> Iterator[str]:
        return iter(self._sets)

    def __len__(self) -> int:
        return len(self._sets)

    def __repr__(self) -> str:
        inside = ", ".join(f"{name!r}: {len(ids)}" for name, ids in self._sets.items())
        return f"<{self.kind}s {{{inside}}}>"


def indices(value: Any, count: int, what: str) -> Ids:
    """Indices below a count, from integers or from a mask of booleans."""
    array = np.asarray(value)
    if array.dtype == np.bool_:
        if array.shape != (count,):
            raise ValueError(f"{what}: a mask has to have shape ({count},), found {array.shape}")
        return np.flatnonzero(array).astype(np.int64)
    array = np.atleast_1d(array)
    if array.size == 0:
        return np.empty(0, np.int64)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise TypeError(f"{what} has to be indices or a mask, found shape {array.shape} of {array.dtype}")
    if array.min() < 0 or array.max() >= count:
        raise IndexError(
            f"{what}: index {int(array.max() if array.max() >= count else array.min())} is not below {count}"
        )
    return np.array(array, dtype=np.int64)


class NodeSets(Sets):
    """Sets of nodes: indices from 0, or masks."""

    kind = "node set"

    def __init__(self, count: int, change: Callable[[], None]) -> None:
        super().__init__(change)
        self._count = count

    def check(self, name: str, value: Any) -> Ids:
        """Indices of nodes."""
        return indices(value, self._count, f"node set {name!r}")


class CellSets(Sets):
    """Sets of cells: indices from 0 over all blocks in their order, masks, or a list with an array for each block."""

    kind = "cell set"

    def __init__(self, sizes: Sequence[int], change: Callable[[], None]) -> None:
        super().__init__(change)
        self._sizes = list(sizes)

    def check(self, name: str, value: Any) -> Ids:
        """Indices of cells over all blocks."""
        count = sum(self._sizes)
        parts = cast("list[Any]", value) if isinstance(value, (list, tuple)) else []
        if parts and len(parts) == len(self._sizes) and all(hasattr(part, "shape") or part is None for part in parts):
            starts = np.cumsum([0, *self._sizes[:-1]])
            given = [
                indices(part, size, f"cell set {name!r}") + start
                for part, size, start in zip(parts, self._sizes, starts, strict=True)
                if part is not None
            ]
            return np.concatenate([np.empty(0, np.int64), *given])
        return indices(value, count, f"cell set {name!r}")


class Surfaces(Sets):
    """Sets of faces: rows [block, cell in the block, side], all from 0, as `Mesh.faces_where` returns."""

    kind = "surface"

    def __init__(self, blocks: Sequence[tuple[int, int]], change: Callable[[], None]) -> None:
        super().__init__(change)
        self._blocks = list(blocks)

    def check(self, name: str, value: Any) -> Ids:
        """Rows of block, cell and side."""
        faces = np.array(value, dtype=np.int64) if len(value) else np.empty((0, 3), np.int64)
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise ValueError(f"surface {name!r} has to have rows [block, cell, side], found shape {faces.shape}")
        if faces.size:
            block = faces[:, 0]
            if block.min() < 0 or block.max() >= len(self._blocks):
                raise IndexError(f"surface {name!r}: block {int(block.max())} is not below {len(self._blocks)}")
            limits = np.array(self._blocks)[block]
            if (faces[:, 1:] < 0).any() or (faces[:, 1:] >= limits).any():
                bad = faces[((faces[:, 1:] < 0) | (faces[:, 1:] >= limits)).any(axis=1)][0]
                raise IndexError(f"surface {name!r}: the mesh has no face {bad.tolist()}")
        return faces
