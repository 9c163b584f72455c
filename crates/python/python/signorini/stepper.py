"""A run driven from Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .result import Frame, threads_of

if TYPE_CHECKING:
    from .case import Case
    from .mesh import Mesh


class Stepper:
    """A case in a state that goes forward when it is asked to: for coupling, control and optimisation.

    Changes of the case take effect at the next `advance`. `save` and `restore` go back to a state.

        stepper = case.stepper()
        while not stepper.done:
            frame = stepper.advance(0.1)
            case.steps["press"].loads[0].pressure = control(frame)
    """

    def __init__(self, case: Case, threads: int | None = None) -> None:
        from . import _native

        self.case = case
        self._mesh: Mesh = case.mesh
        self._space = str(case.model.space)
        self._native = _native.Stepper(case.job(), threads_of(case, threads))
        self._state = case.fingerprint()

    @property
    def time(self) -> float:
        """Total time of the present state."""
        return self._native.time

    @property
    def end(self) -> float:
        """The end of the last step."""
        return self._native.end

    @property
    def done(self) -> bool:
        """Whether all steps are done."""
        return self._native.done

    @property
    def frame(self) -> Frame:
        """The results at the present state."""
        return Frame(self._native.frame, self._mesh, self._space)

    @property
    def step(self) -> str:
        """The name of the step of the present state."""
        return self.frame.step

    def advance(self, dt: float) -> Frame:
        """Goes forward by a time, in one increment or several, no further than the end of the last step.

        Raises `NotConverged`; the state is then the last one that converged.
        """
        if not dt > 0.0:
            raise ValueError(f"dt has to be positive, found {dt}")
        self.update()
        return Frame(self._native.advance(float(dt)), self._mesh, self._space)

    def update(self) -> None:
        """Takes over changes of the case: loads, motions, materials, contacts, on the same mesh. `advance` calls it."""
        state = self.case.fingerprint()
        if state != self._state:
            self._native.update(self.case.job())
            self._state = state

    def save(self) -> bytes:
        """The state, to be restored here or in another process with the same case."""
        return self._native.save()

    def restore(self, state: bytes) -> None:
        """Goes to a state that was saved. Raises `RestartError` for bytes that are no state of this case."""
        self._native.restore(state)

    def __repr__(self) -> str:
        return f"<Stepper: time {self.time:g} of {self.end:g}>"
