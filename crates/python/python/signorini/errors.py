"""Exceptions. Each prints as the program prints it; `diagnostics` holds code, place and help of each finding."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .result import Result


class Diagnostic(Mapping[str, Any]):
    """A finding: severity, code, message, file, line, column, notes and help.

    >>> found = Diagnostic({"severity": "error", "code": "S0102", "message": "unknown key"})
    >>> found.code, found.line
    ('S0102', None)
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = dict(values)

    @property
    def severity(self) -> str:
        """`error`, `warning` or `note`."""
        return str(self._values.get("severity", "error"))

    @property
    def code(self) -> str:
        """Such as S0102; `signorini explain S0102` says more."""
        return str(self._values.get("code", ""))

    @property
    def message(self) -> str:
        """What is wrong, in one line."""
        return str(self._values.get("message", ""))

    @property
    def file(self) -> str | None:
        """The file it is in."""
        return self._values.get("file")

    @property
    def line(self) -> int | None:
        """The line, from 1."""
        return self._values.get("line")

    @property
    def column(self) -> int | None:
        """The column, from 1."""
        return self._values.get("column")

    @property
    def notes(self) -> list[str]:
        """Facts with numbers."""
        return list(self._values.get("notes", ()))

    @property
    def help(self) -> list[str]:
        """What to do."""
        return list(self._values.get("help", ()))

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Any:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __str__(self) -> str:
        text = self._values.get("text")
        if text:
            return str(text).rstrip()
        lines = [f"{self.severity}[{self.code}]: {self.message}"]
        if self.file is not None:
            place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
            lines.append(f"   ┌─ {place}")
        lines += [f"   = {note}" for note in self.notes]
        lines += [f"   = help: {line}" for line in self.help]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<{self.severity} {self.code}: {self.message}>"


class SignoriniError(Exception):
    """Any failure of the program.

    `exit_code` is what the command ends with in the same case.
    """

    exit_code = 70

    def __init__(
        self, message: str | Sequence[Mapping[str, Any]] = "", diagnostics: Sequence[Mapping[str, Any]] = ()
    ) -> None:
        if not isinstance(message, str):
            diagnostics, message = message, ""
        self.message = message
        self.diagnostics = [one if isinstance(one, Diagnostic) else Diagnostic(one) for one in diagnostics]
        super().__init__(message)

    @classmethod
    def of(cls, diagnostics: Sequence[Mapping[str, Any]]) -> SignoriniError:
        """The exception for these findings."""
        return cls(diagnostics)

    def __str__(self) -> str:
        shown = [str(one) for one in self.diagnostics]
        if self.message and not any(self.message in one for one in shown):
            shown.insert(0, self.message)
        return "\n".join(shown) or type(self).__name__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"


class InputError(SignoriniError):
    """The case, the deck or the mesh is wrong; nothing was solved. `diagnostics` says what and where."""

    exit_code = 3


class ModelError(SignoriniError):
    """The model is ill-posed: free bodies, bad elements. Nothing was solved.

    `free_modes`: descriptions of the free motions; `bad_elements`: numbers of the elements.
    """

    exit_code = 4

    def __init__(
        self,
        message: str | Sequence[Mapping[str, Any]] = "",
        free_modes: Sequence[str] = (),
        bad_elements: Sequence[int] = (),
        *,
        diagnostics: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        super().__init__(message, diagnostics)
        self.free_modes = list(free_modes) or [str(m) for one in self.diagnostics for m in one.get("motions", ())]
        self.bad_elements = list(bad_elements) or [int(n) for one in self.diagnostics for n in one.get("elements", ())]


class _WithResult(SignoriniError):
    """A run that ended early. `result` has every converged frame; None where nothing was solved."""

    def __init__(
        self,
        message: str | Sequence[Mapping[str, Any]] = "",
        result: Result | None = None,
        *,
        diagnostics: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        super().__init__(message, diagnostics)
        self._result = result

    @property
    def result(self) -> Result:
        """What was computed."""
        if self._result is None:
            raise AttributeError("nothing was computed")
        return self._result


class NotConverged(_WithResult):
    """The run did not converge. `result` has every converged frame.

    `reason`: what kept it from converging; `worst_nodes`: numbers of the nodes with the largest force errors.
    """

    exit_code = 5

    def __init__(
        self,
        result: Result | None = None,
        reason: str = "",
        worst_nodes: Sequence[int] = (),
        *,
        diagnostics: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        super().__init__(reason, result, diagnostics=diagnostics)
        self.reason = reason
        self.worst_nodes = list(worst_nodes)

    @classmethod
    def of(cls, diagnostics: Sequence[Mapping[str, Any]]) -> NotConverged:
        """The exception for these findings, without a result."""
        found = [Diagnostic(one) for one in diagnostics]
        return cls(reason=found[-1].message if found else "", diagnostics=found)


class OutputError(_WithResult):
    """Results could not be written; what was written before is intact. `result` has the frames in memory."""

    exit_code = 6


class RestartError(_WithResult):
    """A folder cannot be resumed: no checkpoint, or that of another case."""

    exit_code = 7


class LimitError(_WithResult):
    """A limit was reached: memory or time. `result` has every converged frame; the run can be resumed."""

    exit_code = 8


class InternalError(_WithResult):
    """A bug in the program. Please send `bundle` with the case: what had converged is on the disk.

    `bundle`: the path of `crash-ID.zip`, with the message and the backtrace; None where it could not be written.
    """

    exit_code = 70
    bundle: str | os.PathLike[str] | None = None
