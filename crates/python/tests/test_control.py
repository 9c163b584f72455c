"""Control of runs: callbacks, exceptions, Ctrl-C, resuming, steppers, many runs."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import signorini as sg
from signorini import _native
from signorini.result import threads_of

from .conftest import box, native, pressed

pytestmark = native


def long_case(increments: int = 40) -> sg.Case:
    return pressed(box(4), increments=increments)


def test_increments_are_reported_as_they_converge() -> None:
    heard: list[Any] = []
    result = pressed().run(save=False, on_increment=heard.append)
    assert [(one.step, one.increment) for one in heard] == [("press", 1), ("press", 2)]
    assert [one.time for one in heard] == [0.5, 1.0]
    assert all(one.newton_iterations >= 1 for one in heard)
    assert np.array_equal(heard[-1].contact["floor"].pressure, result[-1].contact["floor"].pressure)


def test_iterations_are_reported() -> None:
    heard: list[dict[str, Any]] = []
    pressed().run(save=False, on_iteration=heard.append)
    assert len(heard) >= 2 and all(one["residual"] >= 0.0 for one in heard)


def test_true_stops_and_the_run_can_be_resumed(tmp_path: Path) -> None:
    whole = long_case(8).run(tmp_path / "whole")
    stopped = long_case(8).run(tmp_path / "parts", on_increment=lambda one: np.bool_(one.increment == 3))
    assert not stopped.ok and stopped.error is None
    assert stopped.history.nrow == 3
    resumed = long_case(8).run(tmp_path / "parts", resume=True)
    assert resumed.ok
    assert (tmp_path / "parts" / "history.csv").read_bytes() == (tmp_path / "whole" / "history.csv").read_bytes()
    assert np.array_equal(resumed[-1]["displacement"], whole[-1]["displacement"])
    assert [one.time for one in resumed] == [one.time for one in whole]


def test_frames_may_stay_in_their_folder(tmp_path: Path) -> None:
    kept = pressed().run(tmp_path / "kept")
    read = pressed().run(tmp_path / "read", keep=False)
    assert len(read) == len(kept) == 3
    for one, other in zip(read, kept, strict=True):
        assert np.array_equal(one["displacement"], other["displacement"])
        assert np.array_equal(one.contact["floor"].pressure, other.contact["floor"].pressure)


def test_an_exception_of_a_callback_comes_back(tmp_path: Path) -> None:
    def fail(one: sg.Increment) -> None:
        if one.increment == 2:
            raise ZeroDivisionError("of mine")

    with pytest.raises(ZeroDivisionError, match="of mine") as caught:
        long_case(6).run(tmp_path / "out", on_increment=fail)
    assert any(entry.name == "fail" for entry in caught.traceback)
    assert long_case(6).run(tmp_path / "out", resume=True).ok


def test_a_wrong_case_is_an_input_error() -> None:
    case = pressed()
    case.contacts["floor"].secondary = "fot"
    with pytest.raises(sg.InputError) as caught:
        case.run(save=False)
    found = caught.value.diagnostics[0]
    assert found.code.startswith("S") and "foot" in str(caught.value)


def test_a_free_body_is_a_model_error() -> None:
    case = sg.Case(box())
    case.body("all", sg.LinearElastic(E=1.0, nu=0.0))
    case.step("s", geometry="linear").load("head", force=(1, 0, 0))
    with pytest.raises(sg.ModelError) as caught:
        case.run(save=False)
    (motion,) = caught.value.free_modes
    assert "slide" in motion and motion in str(caught.value)


def test_a_flat_element_is_named() -> None:
    mesh = sg.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], {"tet4": [[0, 1, 2, 3]]})
    case = sg.Case(mesh)
    case.body("all", sg.LinearElastic(E=1.0, nu=0.0))
    case.step("s", geometry="linear").fix("all", "xyz")
    with pytest.raises(sg.ModelError) as caught:
        case.run(save=False)
    assert caught.value.bad_elements == [1]


def test_what_converged_is_in_the_exception(tmp_path: Path) -> None:
    case = pressed(increments=4)
    case.steps["press"].moves[0].uz = -3.0  # through itself
    case.steps["press"].increments = {"initial": 0.1, "min": 0.05}
    with pytest.raises(sg.NotConverged) as caught:
        case.run(save=False)
    error = caught.value
    assert error.reason and error.result.exit_code == 5
    assert len(error.result) == error.result.history.nrow + 1 >= 1
    assert not error.result.ok


def test_a_case_without_a_mesh_says_so() -> None:
    with pytest.raises(sg.InputError, match="no mesh"):
        sg.Case().run(save=False)


def test_a_failed_expectation_is_a_result() -> None:
    case = pressed()
    case.expect("floor.force_z", 1e9, rel=1e-3)
    result = case.run(save=False)
    assert result.exit_code == 1 and not result.ok and result.expectations[0]["ok"] is False


def test_nothing_is_written_without_saving(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert pressed().run(save=False).ok
    assert list(tmp_path.iterdir()) == []
    assert pressed().run().folder == str(tmp_path / "signorini.out")
    assert (tmp_path / "signorini.out" / "results.pvd").is_file()


def test_the_interpreter_is_free_while_solving() -> None:
    ticks, done = [0], threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks[0] += 1
            time.sleep(1e-3)

    clock = threading.Thread(target=tick)
    clock.start()
    long_case().run(save=False)
    done.set()
    clock.join()
    assert ticks[0] > 10


# the programs below take SIGINT also where the tests run as a job in the background, whose children ignore it
INTERRUPTED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {tests!r})
import signorini as sg
from tests.test_control import long_case
case = long_case(400)
def said(one):
    print(one.increment, flush=True)
try:
    case.run({folder!r}, on_increment=said)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    raise SystemExit(130)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGINT")
def test_control_c_leaves_a_run_that_resumes_to_the_same_bits(tmp_path: Path) -> None:
    parent = str(Path(__file__).resolve().parents[1])
    code = INTERRUPTED.format(tests=parent, folder=str(tmp_path / "out"))
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=parent)
    assert process.stdout is not None
    for line in process.stdout:
        if line.strip() == "3":
            break
    start = time.monotonic()
    os.kill(process.pid, signal.SIGINT)
    said = process.stdout.read()
    assert process.wait() == 130 and "interrupted" in said
    assert time.monotonic() - start < 2.0
    resumed = long_case(400).run(tmp_path / "out", resume=True)
    whole = long_case(400).run(save=False)
    assert (tmp_path / "out" / "history.csv").read_text() == whole.history.text
    assert np.array_equal(resumed[-1]["displacement"], whole[-1]["displacement"])


MANY = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {tests!r})
import signorini as sg
from tests.test_control import long_case
print("started", flush=True)
try:
    sg.run_many([long_case(2000) for _ in range(4)])
except KeyboardInterrupt:
    print("interrupted", flush=True)
    raise SystemExit(130)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGINT")
def test_control_c_stops_many_runs() -> None:
    parent = str(Path(__file__).resolve().parents[1])
    code = MANY.format(tests=parent)
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=parent)
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "started"
    time.sleep(1.0)
    start = time.monotonic()
    os.kill(process.pid, signal.SIGINT)
    assert process.stdout.read().strip() == "interrupted" and process.wait() == 130
    assert time.monotonic() - start < 2.0


def test_many_runs_come_back_in_order() -> None:
    depths = [0.002 * k for k in range(1, 7)]
    results = sg.run_many([pressed(depth=depth) for depth in depths])
    forces = [result.history["floor.force_z"][-1] for result in results]
    assert all(result.ok for result in results)
    assert forces == sorted(forces) and len(set(forces)) == len(forces)
    alone = pressed(depth=depths[2]).run(save=False)
    assert alone.history["floor.force_z"][-1] == forces[2]


def test_a_failed_run_among_many_is_a_result() -> None:
    wrong = pressed()
    wrong.contacts["floor"].secondary = "fot"
    good, bad = sg.run_many([pressed(), wrong])
    assert good.ok and not bad.ok and isinstance(bad.error, sg.InputError)
    with pytest.raises(sg.InputError):
        sg.run_many([wrong, pressed()], on_error="raise")


def test_many_runs_need_a_list_of_cases() -> None:
    case: Any = pressed()
    wrongs: list[Any] = [case, {0.1: case}, [case, "block.toml"]]
    for wrong in wrongs:
        with pytest.raises(TypeError, match="takes a list of cases"):
            sg.run_many(wrong)


def test_many_runs_are_written_where_they_are_asked_to(tmp_path: Path) -> None:
    results = sg.run_many([pressed(), pressed(depth=0.02)], output=tmp_path / "study")
    assert [sg.open(tmp_path / "study" / name).ok for name in ("000", "001")] == [True, True]
    assert all(result.folder for result in results)


def test_a_stepper_goes_where_a_run_goes() -> None:
    case = pressed()
    stepper = case.stepper()
    assert stepper.time == 0.0 and not stepper.done
    frames = [stepper.advance(0.5) for _ in range(2)]
    assert stepper.done and stepper.time == 1.0
    result = case.run(save=False)
    assert np.allclose(frames[-1]["displacement"], result[-1]["displacement"], rtol=1e-9, atol=1e-12)


def test_a_stepper_goes_back_to_a_state() -> None:
    stepper = pressed(increments=4).stepper()
    stepper.advance(0.25)
    state = stepper.save()
    first = np.array(stepper.advance(0.25)["displacement"])
    stepper.restore(state)
    assert stepper.time == 0.25
    assert np.array_equal(stepper.advance(0.25)["displacement"], first)
    other = sg.Case(box(3))
    other.body("all", sg.LinearElastic(E=1.0, nu=0.3))
    other.step("press").move("head", x=0.0, y=0.0, z=-0.1)
    for junk in (b"nothing", other.stepper().save()):
        with pytest.raises(sg.SignoriniError):
            stepper.restore(junk)
    # the state is what it was
    assert stepper.time == 0.5
    second = stepper.advance(0.25)["displacement"]
    stepper.restore(state)
    stepper.advance(0.25)
    assert np.array_equal(stepper.advance(0.25)["displacement"], second)


def test_a_stepper_takes_changes_of_the_case() -> None:
    case = pressed(increments=4)
    stepper = case.stepper()
    stepper.advance(0.5)
    case.contacts["floor"].friction = 0.1
    case.steps["press"].moves[0].uz = -0.02
    frame = stepper.advance(0.5)
    assert frame["displacement"][:, 2].min() == pytest.approx(-0.02)


def test_load_reads_cases_and_their_overrides(tmp_path: Path) -> None:
    pressed().to_toml(tmp_path / "press.toml")
    case = sg.load(tmp_path / "press.toml", set={"material.neo-hookean.E": 12.0})
    assert case.name == "press" and case.default_output == str(tmp_path / "press.out")
    assert case.contacts["floor"].friction == 0.2
    soft = pressed().run(save=False).history["floor.force_z"]
    hard = sg.load(tmp_path / "press.toml", set={"material.neo-hookean.E": 12.0}).run(save=False)
    assert hard.history["floor.force_z"] == pytest.approx(2.0 * soft, rel=1e-3)
    with pytest.raises(sg.InputError):
        sg.load(tmp_path / "missing.toml")


def test_a_text_is_a_case() -> None:
    text = pressed().to_toml()
    again = sg.Case.from_toml(text)
    assert again.run(save=False).history.text == pressed().run(save=False).history.text


def test_cases_and_meshes_can_be_copied_and_pickled() -> None:
    case = pressed()
    expected = case.run(save=False)
    for other in (copy.deepcopy(case), pickle.loads(pickle.dumps(case))):
        found = other.run(save=False)
        assert np.array_equal(found[-1]["displacement"], expected[-1]["displacement"])


def test_a_case_says_on_how_many_threads_it_runs() -> None:
    case = pressed()
    case.solver.threads = 1
    started: list[int] = []

    def hear(event: dict[str, Any]) -> None:
        started.extend([event["threads"]] if event["ev"] == "start" else [])

    _native.run(case.job(), None, threads=threads_of(case, None), on_event=hear)
    _native.run(case.job(), None, threads=threads_of(case, 2), on_event=hear)
    assert started == [1, 2]


def test_a_number_of_threads_is_positive() -> None:
    with pytest.raises(ValueError, match="at least one thread"):
        pressed().run(save=False, threads=0)
