#!/usr/bin/env python3
"""Tests of the scripts on made-up results, written with PyVista.

    python scripts/test_scripts.py [--nothing-skipped]

The results look like those of a run that presses a tip into one cell: a bilinear motion of its top, a tetrahedron that
moves along, a stress that is linear in the displacement. Every test either finds them in order or damages one thing
and expects that very thing to be named. Where pvpython is installed, it reads the same files;
where it is not, that test is skipped, which is a failure with --nothing-skipped. So is the test that runs generated
decks, where there is no target/release/signorini; the variable SIGNORINI names another program.
"""

import contextlib
import csv
import dataclasses
import gzip
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import pyvista
import python_reference

HERE = os.path.dirname(os.path.abspath(__file__))
SIGNORINI = os.environ.get("SIGNORINI", os.path.join(HERE, "..", "target", "release", "signorini"))
NFRAME = 4
BRICK = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
WEDGE = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
TENSOR = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]


def tensor_array(values):
    array = pyvista.convert_array(np.ascontiguousarray(values), name="stress")
    for i, name in enumerate(TENSOR):
        array.SetComponentName(i, name)
    return array


def make_results(folder, body=BRICK, tip=(0.5, 0.25, 1.0), nframe=NFRAME):
    """Frames, lists, history and summary of a run that never was."""
    frames = os.path.join(folder, "frames")
    os.makedirs(frames)
    x0, y0, _ = tip
    tool = [tip, (x0 - 0.3, y0 - 0.25, 1.8), (x0 + 0.3, y0 - 0.25, 1.8), (x0, y0 + 0.35, 1.8)]
    points = np.array([*body, *tool], dtype=float)
    n = len(body)
    cells = [n, *range(n), 4, *range(n, n + 4)]
    types = [12 if n == 8 else 13, 10]
    listed = {"results": [], "contact": []}
    rows = []
    for i in range(nframe):
        time = i / (nframe - 1)
        displacement = np.zeros_like(points)
        weight = (1.0 - abs(points[:n, 0] - x0)) * (1.0 - abs(points[:n, 1] - y0)) * points[:n, 2]
        displacement[:n, 2] = -0.35 * time * weight
        displacement[:n, 1] = -0.1 * time * weight * points[:n, 2]
        displacement[n:, 2] = -0.3 * time
        stress = np.zeros((len(points), 6))
        stress[:n] = displacement[:n, 2:] * np.array([1.0, 2.0, 500.0, 3.0, 4.0, 5.0])
        xx, yy, zz, xy, yz, xz = stress.T
        mises = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + xz**2)
        force = np.array([0.3, -22.4, 68.9]) * time
        size = float(np.linalg.norm(force))
        volume = pyvista.UnstructuredGrid(np.array(cells), np.array(types, dtype=np.uint8), points)
        volume.point_data["displacement"] = displacement
        volume.GetPointData().AddArray(tensor_array(stress))
        volume.point_data["von_mises"] = np.sqrt(mises)
        volume.point_data["contact_pressure"] = np.eye(len(points))[n] * size
        volume.point_data["reaction_force"] = np.zeros_like(points)
        volume.GetPointData().SetActiveVectors("displacement")
        contact = pyvista.UnstructuredGrid(np.array([1, 0]), np.array([1], dtype=np.uint8), points[n : n + 1])
        contact.point_data["contact_gap"] = np.array([-size * 1e-5])
        for name in ("contact_pressure", "contact_pressure_max", "contact_multiplier"):
            contact.point_data[name] = np.array([size])
        contact.point_data["contact_multiplier_traction"] = np.array([force])
        contact.point_data["contact_status"] = np.array([2 if i else 0], dtype=np.int8)
        contact.point_data["contact_force"] = np.array([force])
        contact.point_data["contact_traction"] = np.array([force])
        contact.point_data["contact_area"] = np.array([1.0])
        contact.point_data["contact_slip"] = np.zeros((1, 3))
        for name, grid in (("volume", volume), ("contact", contact)):
            grid.field_data["TimeValue"] = np.array([time])
            file = f"frames/{name}_{i:04}.vtu"
            grid.save(os.path.join(folder, file))
            listed["results" if name == "volume" else "contact"].append((time, file))
        if i > 0:
            rows.append([time, "press", i, 5, *force, size, -size * 1e-5, displacement[4, 2]])
    for name, entries in listed.items():
        write_pvd(os.path.join(folder, f"{name}.pvd"), entries)
    columns = ["time", "step", "increment", "iterations", "tip.force_x", "tip.force_y", "tip.force_z"]
    columns += ["tip.pressure_max", "tip.gap_min", "corner5_uz.displacement.z"]
    with open(os.path.join(folder, "history.csv"), "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([columns, *rows])
    last = rows[-1]
    tip_end = {"force": last[4:7], "pressure_max": last[7], "gap_min": last[8]}
    summary = {"exit_code": 0, "steps": [{"name": "press", "increments": len(rows)}], "contacts": {"tip": tip_end}}
    with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
        json.dump(summary, file)
    with open(os.path.join(folder, "case.resolved.toml"), "w", encoding="utf-8") as file:
        file.write(f"[mesh]\nnodes = [[5, {body[4][0]}, {body[4][1]}, {body[4][2]}]]\n")
        file.write('[[output.history]]\nname = "corner5_uz"\nquantity = "displacement.z"\nnode = 5\n')


def write_pvd(path, entries):
    lines = [f'<DataSet timestep="{time!r}" part="0" file="{file}"/>' for time, file in entries]
    with open(path, "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n')
        file.write("\n".join(lines) + "\n</Collection></VTKFile>\n")


def run(script, *arguments, program=sys.executable):
    command = [program, os.path.join(HERE, script), *arguments]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
    return done.returncode, done.stdout


def pretending(folder, name, text):
    """A program of this text, in place of one that solves."""
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"#!{sys.executable}\n{text}")
    os.chmod(path, 0o755)
    return path


class InFolder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = os.path.join(holder.name, "run.out")
        make_results(self.folder)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def change_grid(self, name, change):
        grid = pyvista.read(self.path("frames", name))
        change(grid)
        grid.save(self.path("frames", name))

    def change_text(self, name, old, new):
        with open(self.path(name), encoding="utf-8") as file:
            text = file.read()
        self.assertIn(old, text)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text.replace(old, new))

    def expect_failure(self, words, *arguments):
        code, said = run("check_results.py", self.folder, *arguments)
        self.assertEqual(code, 1, said)
        self.assertIn(words, said)

    def write_expected(self, expected):
        path = self.path("expected.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(expected, file)
        return path


class CheckResults(InFolder):
    def test_sound_results_pass(self):
        code, said = run("check_results.py", self.folder)
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"check_results: \d{3,} passed, 0 failed")

    @unittest.skipUnless(shutil.which("pvpython"), "pvpython is not installed")
    def test_sound_results_pass_in_pvpython_and_a_wrong_force_does_not(self):
        pvpython = shutil.which("pvpython")
        code, said = run("check_results.py", self.folder, program=pvpython)
        self.assertEqual(code, 0, said)
        self.assertIn("ParaView", said)
        self.change_text("summary.json", "68.9", "68.8")
        code, said = run("check_results.py", self.folder, program=pvpython)
        self.assertEqual(code, 1, said)

    def test_a_force_other_than_that_of_the_history_is_found(self):
        def change(grid):
            grid.point_data["contact_force"] = grid.point_data["contact_force"] * (1.0 + 1e-8)
            grid.point_data["contact_traction"] = grid.point_data["contact_force"]

        self.change_grid("contact_0002.vtu", change)
        self.expect_failure("contact frame 2: sum of contact_force of tip")

    def test_mortar_spreads_tractions_over_the_same_area(self):
        with open(self.path("case.resolved.toml"), "a", encoding="utf-8") as file:
            file.write('[[contact]]\nname = "tip"\nmethod = "mortar"\n')
        self.change_grid("contact_0001.vtu", lambda g: np.multiply(g["contact_area"], 1.01, out=g["contact_area"]))
        self.expect_failure("contact frame 1: sum of traction times area")

    def test_facets_that_meet_at_an_angle_are_bent(self):
        from check_results import bends

        points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 0, 0]])
        grid = pyvista.UnstructuredGrid(np.array([3, 0, 1, 4, 2, 1, 3]), np.array([21, 3], dtype=np.uint8), points)
        np.testing.assert_allclose(bends(grid), [0, 1, 0, 0, 0], atol=1e-15)
        grid.point_data["displacement"] = np.array([[0.0, 0, 0], [0, 0, 0], [0, 0, 0], [1, -1, 0], [0, 0, 0]])
        np.testing.assert_allclose(bends(grid), np.zeros(5), atol=1e-15)

    def test_a_missing_array_is_found(self):
        self.change_grid("volume_0001.vtu", lambda g: g.point_data.remove("reaction_force"))
        self.expect_failure("volume frame 1: there is no point array 'reaction_force'")

    def scale(self, name, factor):
        def change(grid):
            grid.point_data[name] = factor * np.array(grid.point_data[name])

        self.change_grid("contact_0003.vtu", change)

    def test_pressures_of_points_may_exceed_those_of_nodes_but_not_fall_below(self):
        self.scale("contact_pressure", 0.9)
        code, said = run("check_results.py", self.folder)
        self.assertEqual(code, 0, said)
        self.scale("contact_pressure", 1.2)
        self.expect_failure("contact frame 3: a mean pressure at a node is above the largest pressure around it")

    def test_another_largest_pressure_than_that_of_the_history_is_found(self):
        self.scale("contact_pressure_max", 1.1)
        self.expect_failure("contact frame 3: pressure_max of tip")

    def test_stress_in_another_order_is_found(self):
        def change(grid):
            grid.point_data["stress"] = np.array(grid.point_data["stress"])[:, [2, 3, 0, 1, 4, 5]]

        self.change_grid("volume_0003.vtu", change)
        self.expect_failure("volume frame 3: von_mises of the stress")

    def test_labels_of_another_order_are_found(self):
        array = lambda g: g.GetPointData().GetArray("stress")  # noqa: E731
        self.change_grid("volume_0003.vtu", lambda g: array(g).SetComponentName(4, "XZ"))
        self.expect_failure("stress is labelled")

    def test_another_time_is_found(self):
        self.change_grid("volume_0001.vtu", lambda g: g.field_data.update({"TimeValue": np.array([0.33])}))
        self.expect_failure("volume frame 1: TimeValue")

    def test_a_displacement_other_than_that_of_the_history_is_found(self):
        with open(self.path("history.csv"), encoding="utf-8") as file:
            last = file.read().split(",")[-1].strip()
        self.change_text("history.csv", last, str(float(last) + 1e-6))
        self.expect_failure("corner5_uz.displacement.z at time 1.0")

    def test_a_frame_that_is_not_listed_is_found(self):
        self.change_text("contact.pvd", '<DataSet timestep="1.0" part="0" file="frames/contact_0003.vtu"/>', "")
        self.expect_failure("contact.pvd lists 3 other times")

    def test_a_summary_of_another_run_is_found(self):
        self.change_text("summary.json", '"increments": 3', '"increments": 4')
        self.expect_failure("summary.json: 4 increments")

    def test_expected_values_are_compared(self):
        history = [{"row": 3, "column": "tip.force_z", "value": 68.9}]
        displacement = [{"frame": 3, "at": [0.5, 0.25, 1.0], "value": [0.0, 0.0, -0.3]}]
        right = {"frames": NFRAME, "points": 12, "history": history, "displacement": displacement}
        code, said = run("check_results.py", self.folder, "--expected", self.write_expected(right))
        self.assertEqual(code, 0, said)
        for wrong in (
            {"frames": 5},
            {"points": 8},
            {"history": [history[0] | {"value": 68.9001}]},
            {"history": [history[0] | {"row": 9}]},
            {"displacement": [displacement[0] | {"value": [0.0, 0.0, -0.3001]}]},
            {"displacement": [displacement[0] | {"at": [0.5, 0.3, 1.0]}]},
        ):
            code, said = run("check_results.py", self.folder, "--expected", self.write_expected(wrong))
            self.assertEqual(code, 1, said)
            self.assertEqual(said.count("FAILED"), 1, said)

    def test_results_that_are_not_there_are_an_error_of_their_own(self):
        code, said = run("check_results.py", self.path("nowhere"))
        self.assertEqual(code, 2, said)
        self.assertIn("results.pvd does not exist", said)


def frd_row(label, values):
    return f" -1{label:10d}" + "".join(f"{v:12.5E}" for v in values) + "\n"


def frd_block(rows):
    return "".join(frd_row(k, row) for k, row in enumerate(rows, 1)) + " -3\n"


def make_frd(folder):
    """The frames of made-up results in one file."""
    frames = [pyvista.read(os.path.join(folder, "frames", f"volume_{i:04}.vtu")) for i in range(NFRAME)]
    points = frames[0].points
    text = f"    1Cjob\n    2C{len(points):30d}{1:38d}\n" + frd_block(points) + f"    3C{2:30d}{1:38d}\n"
    for label, (kind, nodes) in enumerate([(1, range(1, 9)), (3, range(9, 13))], 1):
        text += f" -1{label:10d}{kind:5d}    0    1\n -2" + "".join(f"{n:10d}" for n in nodes) + "\n"
    text += " -3\n"
    fields = {
        "DISP": ("displacement", ["D1", "D2", "D3"]),
        "STRESS": ("stress", ["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"]),
        "FORC": ("reaction_force", ["F1", "F2", "F3"]),
    }
    for i, frame in enumerate(frames[1:], 1):
        for name, (field, components) in fields.items():
            text += f"    1PSTEP{i:26d}{i:12d}{1:12d}          \n"
            text += f"  100CL{100 + i:5d}{i / (NFRAME - 1):12.5E}{len(points):12d}{0:22d}{i:5d}{1:12d}\n"
            text += f" -4  {name:8}{len(components):5d}    1\n"
            text += "".join(f" -5  {c:8}    1    1    0    0\n" for c in components)
            text += frd_block(frame.point_data[field])
    with open(os.path.join(folder, "job.frd"), "w", encoding="utf-8") as file:
        file.write(text + " 9999\n")


class PythonReference(unittest.TestCase):
    def test_the_page_of_the_package_is_what_its_sources_say(self):
        self.assertEqual(python_reference.PAGE.read_text(), python_reference.page())

    def test_every_public_name_of_the_package_is_on_the_page(self):
        page = python_reference.page()
        for names in python_reference.homes().values():
            for name in names:
                self.assertIn(f"\n### {name}\n", page)


class CheckFrd(InFolder):
    def setUp(self):
        super().setUp()
        # bare frames: nodes of the made-up contact have no numbers
        os.remove(self.path("contact.pvd"))

    def test_a_file_with_the_values_of_the_frames_passes(self):
        make_frd(self.folder)
        code, said = run("check_frd.py", self.folder)
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"check_frd: \d+ passed, 0 failed")

    def test_stress_in_another_order_is_found(self):
        make_frd(self.folder)
        self.change_text("job.frd", "SYZ", "S??")
        self.change_text("job.frd", "SZX", "SYZ")
        self.change_text("job.frd", "S??", "SZX")
        code, said = run("check_frd.py", self.folder)
        self.assertEqual(code, 1, said)
        self.assertIn("volume_0003.vtu: stress", said)

    def test_a_wrong_sixth_digit_is_found(self):
        make_frd(self.folder)
        self.change_text("job.frd", "-3.00000E-01", "-3.00001E-01")
        code, said = run("check_frd.py", self.folder)
        self.assertEqual(code, 1, said)
        self.assertIn("volume_0003.vtu: displacement", said)
        self.assertNotIn("volume_0002.vtu", said)

    def test_results_without_such_a_file_are_an_error_of_their_own(self):
        code, said = run("check_frd.py", self.folder)
        self.assertEqual(code, 2, said)
        self.assertIn("--format vtu,frd", said)


class PaperFigure(InFolder):
    def draw(self, *arguments):
        output = self.path("figure.png")
        folders = []
        for name, body in (("a", WEDGE), ("b", BRICK)):
            folders.append(self.path(name))
            make_results(folders[-1], body)
        last = str(NFRAME - 1)
        code, said = run("paper_figure.py", *folders, "--increments", "0", last, "-o", output, *arguments)
        self.assertEqual(code, 0, said)
        return said, pyvista.read(output)

    def assert_shows_something(self, image):
        values = np.array(image.point_data["PNGImage"])[:, :3]
        self.assertGreater(image.dimensions[0], 800)
        self.assertGreater(len(np.unique(values, axis=0)), 500)

    def test_matplotlib_draws(self):
        said, image = self.draw("--renderer", "matplotlib")
        self.assertIn("Matplotlib", said)
        self.assert_shows_something(image)

    def test_whatever_renderer_works_draws(self):
        _, image = self.draw()
        self.assert_shows_something(image)

    def test_frames_that_are_not_there_are_named(self):
        code, said = run("paper_figure.py", self.folder, "--increments", "60")
        self.assertEqual(code, 2, said)
        self.assertIn("lists 4 frames, increment 60 is not among them", said)


class Patches(unittest.TestCase):
    def test_pieces_of_a_warped_face_lie_on_its_bilinear_surface_and_cover_it(self):
        sys.path.insert(0, HERE)
        from paper_figure import patches

        x = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0.5], [0, 1, 0]], dtype=float)
        triangles, values = patches([np.arange(4)], x, x[:, 2])
        at = triangles.reshape(-1, 3)
        self.assertLess(abs(at[:, 2] - 0.25 * at[:, 0] * at[:, 1]).max(), 1e-14)
        self.assertLess(abs(values.ravel() - at[:, 2]).max(), 1e-14)
        flat = triangles[..., :2]
        a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        self.assertAlmostEqual(abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2, 2.0, places=12)
        for sides, area in (([np.array([0, 1, 3])], 1.0), ([np.array([0, 1, 3])] * 2, 2.0)):
            flat = patches(sides, x, x[:, 2])[0][..., :2]
            a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
            self.assertAlmostEqual(abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2, area, places=12)


class CompareCcx(unittest.TestCase):
    """Pieces of compare_ccx.py, and all of it with programs that only pretend."""

    def setUp(self):
        sys.path.insert(0, HERE)
        import compare_ccx

        self.script = compare_ccx
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def test_keywords_lose_blanks_comments_and_parameters(self):
        text = "** *DYNAMIC\n*Contact Pair, INTERACTION=A\n1, *2\n  *Static,DIRECT\n"
        self.assertEqual(self.script.keywords(text), ["CONTACTPAIR", "STATIC"])

    def test_static_are_decks_whose_procedures_all_are(self):
        for found, wanted in (
            (["STEP", "STATIC"], True),
            (["STATIC", "STATICDIRECT"], True),
            (["STATIC", "FREQUENCY"], False),
            (["STEP"], False),
        ):
            self.assertIs(self.script.is_static(found), wanted, found)

    def test_gaps_are_contact_and_their_conductance_is_not(self):
        for found, wanted in ((["GAP"], True), (["CONTACTPAIR"], True), (["GAPCONDUCTANCE"], False), (["TIE"], False)):
            self.assertIs(self.script.has_contact(found), wanted, found)

    def test_reasons_are_counted_without_what_is_the_decks_own(self):
        for reason, wanted in (
            ('there is no material `EL`', "there is no material …"),
            ('part.inp, line 9: element 1 has 9 nodes; a C3D8I has 8', "element n has n nodes; a C3D8I has n"),
            ("*DEFORMATION PLASTICITY is not supported: none", "*DEFORMATION PLASTICITY is not supported: none"),
        ):
            self.assertEqual(self.script.feature(reason), wanted)

    def test_tight_tolerances_stand_in_every_step_and_the_solver_is_direct(self):
        text = "*STEP\n*Static, Solver = ITERATIVE CHOLESKY, DIRECT\n1., 1.\n*End Step\n*STEP\n*STATIC\n*END STEP\n"
        found = self.script.converged(text)
        self.assertEqual(found.count(self.script.CONVERGED), 2)
        self.assertIn("*Static, DIRECT\n1., 1.\n*CONTROLS", found)

    def test_results_are_asked_for_in_the_last_step(self):
        text = "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n1., 1.\n*End Step\n"
        found = self.script.asked(text)
        self.assertEqual(found.count("*NODE FILE"), 1)
        self.assertTrue(found.endswith(f"1., 1.\n{self.script.ASKED}*End Step\n"))

    def test_global_models_of_submodels_are_named_by_their_results(self):
        text = '*SUBMODEL,TYPE=NODE,INPUT=beam.frd\nN1\n* Submodel, input="two.frd", GLOBAL ELSET=E\nN2\n*INCLUDE, INPUT=x.frd\n'
        self.assertEqual(self.script.GLOBAL.findall(text), ["beam.frd", "two.frd"])

    def test_tables_at_points_of_contact_do_not_count(self):
        def block(name, ratio):
            return {"name": name, "time": 1.0, "outcome": "compared", "numbers": {"ratio": ratio}}

        at_points = block("contact stress (slave element+face,press,tang1,tang2) for all contact elements", 0.5)
        energy = block("contact print energy (slave element+face,energy)for all contact elements", 1e-5)
        found = self.judge(at_points, energy)
        self.assertEqual((found.compared, found.largest), (1, 1e-5))

    def judge(self, *blocks, names=None):
        return self.script.judge("\n".join(json.dumps({"ev": "block", **block}) for block in blocks), names)

    def test_the_largest_difference_names_its_table(self):
        def block(name, time, ratio, **more):
            return {"name": name, "time": time, "outcome": "compared", "numbers": {"ratio": ratio, **more}}

        found = self.judge(block("U", 1.0, 1e-5), block("U", 2.0, 2e-3), block("S", 2.0, 1e-4))
        self.assertEqual((found.compared, found.largest, found.worst, found.lacking), (3, 2e-3, "U at 2", []))
        found = self.judge(block("U", 1.0, 1e-5, mismatch="1 row more"))
        self.assertEqual(found.largest, 1.0)
        found = self.judge(block("DISP", 1.0, 1e-5), block("nodes", None, 0.5), names=["DISP"])
        self.assertEqual((found.compared, found.largest), (1, 1e-5))

    def test_tables_must_be_there_at_their_last_time_only(self):
        def block(time, outcome):
            return {"name": "U", "time": time, "outcome": outcome, "numbers": {"ratio": 0.0}}

        found = self.judge(block(0.5, "only in the reference"), block(1.0, "compared"), block(2.0, "not in the reference"))
        self.assertEqual(found.lacking, [])
        found = self.judge(block(0.5, "compared"), block(1.0, "only in the reference"))
        self.assertEqual(found.lacking, ["U"])

    def compare(self, *more):
        """A folder of five decks and what is no deck, run through programs that pretend."""
        decks = os.path.join(self.folder, "decks")
        os.makedirs(decks)
        contact = "*CONTACT PAIR\n"
        for name, text in (("near", contact), ("far", ""), ("loose", ""), ("odd", contact), ("modes", "*FREQUENCY\n")):
            with gzip.open(os.path.join(decks, f"{name}.inp.gz"), "wt", encoding="utf-8") as file:
                file.write(f"{text}*STEP\n*STATIC\n*END STEP\n")
        ccx = pretending(
            self.folder,
            "ccx",
            """import sys
name = sys.argv[2]
open(name + ".dat", "w").write("table")
open(name + ".sta", "w").write("head\\nhead\\n 1 1 1 4 1. 1. 1.\\n 1 2 1 3 1. 1. 1.\\n")
""",
        )
        signorini = pretending(
            self.folder,
            "signorini",
            """import json, os, sys
if sys.argv[1] == "diff":
    near = "near" in sys.argv[2] or "loose-converged" in sys.argv[3]
    ratio = 1e-5 if near else 0.25
    print(json.dumps({"ev": "block", "name": "U", "time": 1.0, "outcome": "compared", "numbers": {"ratio": ratio}}))
    sys.exit(0)
name = sys.argv[2][: -len(".inp")]
if name == "odd":
    print(json.dumps({"ev": "diagnostic", "severity": "error", "message": "*ODD is not supported"}))
    sys.exit(3)
os.makedirs(name + ".out")
open(f"{name}.out/{name}.dat", "w").write("table")
open(f"{name}.out/summary.json", "w").write(json.dumps({"steps": [{"iterations": 5}, {"iterations": 1}]}))
""",
        )
        return run("compare_ccx.py", decks, "--ccx", ccx, "--signorini", signorini, *more)

    def test_every_static_deck_has_a_line_and_is_counted(self):
        page = os.path.join(self.folder, "page.md")
        code, said = self.compare("--markdown", page)
        self.assertEqual(code, 0, said)
        rows = {line.split()[0]: line.split()[1:] for line in said.splitlines() if line.strip()}
        self.assertEqual(rows["near"][:4], ["agrees", "1.0e-05", "6", "7"])
        self.assertEqual(rows["far"][:2], ["differs", "2.5e-01"])
        self.assertEqual(rows["far"][-3:], ["U", "at", "1"])
        self.assertEqual(rows["loose"][:2], ["converged", "2.5e-01"])
        self.assertEqual(rows["odd"][0], "refused")
        self.assertNotIn("modes", rows)
        self.assertIn("1 of 4 static decks agree, 1 more", said)
        self.assertIn("1 of 2 static decks with contact agree", said)
        self.assertIn("1 *ODD is not supported: odd", said)
        with open(page, encoding="utf-8") as file:
            self.assertIn("| far | differs | 2.5e-01 | 6 | 7 |", file.read())

    def test_fewer_than_asked_for_is_a_failure(self):
        code, said = self.compare("--contact", "--least-contact", "2")
        self.assertEqual(code, 1, said)
        self.assertIn("fewer than 2 contact decks agree", said)
        self.assertNotIn("far", said)

    def test_missing_programs_are_named(self):
        code, said = run("compare_ccx.py", self.folder, "--ccx", os.path.join(self.folder, "none"))
        self.assertEqual(code, 2, said)
        self.assertIn("there is no program", said)


BALL = """*HEADING
Hertz quarter paraboloid R=100.0 on elastic block; C3D8
*NODE,NSET=NUP
1,0,0,0
2,2,0,0
3,2,2,0
4,0,2,0
5,0,0,9
6,2,0,9
7,2,2,9
8,0,2,9
*ELEMENT,TYPE=C3D8,ELSET=EUP
7,1,2,3,4,5,6,7,8
*SURFACE,NAME=SSLAVE,TYPE=ELEMENT
7,S1
*MATERIAL,NAME=EL
*ELASTIC
210000.,0.3
*MATERIAL,NAME=STIFF
*ELASTIC
2.1e8,0.3
*SOLID SECTION,ELSET=EUP,MATERIAL=EL
*SOLID SECTION,ELSET=ELO,MATERIAL=STIFF
*CONTACT PAIR,INTERACTION=SI,TYPE=SURFACE TO SURFACE
sslave,SMASTER
*STEP,INC=200
*STATIC,SOLVER=SPOOLES
1.0,1.
*NODE PRINT,NSET=NTOP,TOTALS=ONLY
RF
*END STEP
"""
TOTALS = """
 total force (fx,fy,fz) for set NTOP and time  0.2500000E+00

        1.000000E+00  0.000000E+00 -1.000000E+00

 total force (fx,fy,fz) for set NBOT and time  0.1000000E+01

        7.000000E+00  7.000000E+00  7.000000E+00

 total force (fx,fy,fz) for set NTOP and time  0.1000000E+01

        3.030000E+00  0.000000E+00 {force:.6E}
"""
TABLES = """ -4  CONTACT     6    1
 -5  COPEN       1    4    1    1
 -5  CSLIP1      1    4    2    2
 -5  CSLIP2      1    4    3    3
 -5  CPRESS      1    4    1    2
{rows} -3
 -4  ERROR       1    1
 -1         1 9.00000E+09
 -3
"""
MOTIONS = """ -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
{rows} -3
"""


class SpeedFigure(unittest.TestCase):
    """What speed_figure.py reads of a page."""

    def test_the_exponent_is_that_of_the_rows_in_one_increment(self):
        sys.path.insert(0, HERE)
        script = __import__("speed_figure")
        head = "| row | unknowns | increments | iterations | ccx | ours |\n| --- | --- | --- | --- | --- | --- |\n"
        row = "| {} | {} | 1 / 1 | 9 / 8 | {} | {} |\n"
        sizes = [50_000, 100_000, 400_000]
        rows = [row.format(f"hertz-C3D8-{n}-once", n, 2e-4 * n**1.25, 1e-5 * n) for n in sizes]
        others = row.format("hertz-C3D8-1000000-once", 10**6, "–", 10.0) + row.format("slide-C3D8-50000", 50_000, 1.0, 9.0)
        # the page has a table of other rows before it
        families = head.replace("iterations", "rounds") + row.format("tet10-3000-1", 3000, 2.0, 1.0) + "\n"
        found = script.read("words\n| another | table |\n\n" + families + head + "".join(rows) + others)
        self.assertEqual([len(points) for points in found.values()], [3, 4])
        self.assertAlmostEqual(script.exponent(found["CalculiX"]), 1.25, places=9)
        self.assertAlmostEqual(script.exponent(found["signorini"]), 1.0, places=9)


class EnergyFigure(InFolder):
    """What energy_figure.py draws of a history."""

    def write(self, *rows):
        names = ("internal", "kinetic", "contact", "friction", "damping", "algorithmic", "external")
        text = "time," + ",".join(f"energy.{name}" for name in names) + "\n"
        with open(self.path("history.csv"), "w", encoding="utf-8") as file:
            file.write(text + "".join(",".join(map(str, row)) + "\n" for row in rows))

    def test_increments_without_energies_are_left_out(self):
        sys.path.insert(0, HERE)
        script = __import__("energy_figure")
        self.write((1.0, 0, 0, 0, 0, 0, 0, 0), (1.5, 2, 3, 0, 1, 0, 0, 6), (2.0, 1, 4, 0, 1, 0, 0, 6))
        time, energy = script.energies(self.folder)
        self.assertEqual(list(time), [1.5, 2.0])
        self.assertEqual((list(energy["kinetic"]), list(energy["external"])), ([3.0, 4.0], [6.0, 6.0]))
        output = self.path("energies.png")
        code, said = run("energy_figure.py", self.folder, "-o", output)
        self.assertEqual(code, 0, said)
        self.assertGreater(pyvista.read(output).dimensions[0], 800)

    def test_a_run_without_a_motion_is_an_error_of_its_own(self):
        self.write((1.0, 0, 0, 0, 0, 0, 0, 0))
        code, said = run("energy_figure.py", self.folder)
        self.assertEqual(code, 2, said)
        self.assertIn("no increment has an energy", said)


class HertzBodies(unittest.TestCase):
    """The pressure under a ball on a block, as hertz_bodies.py computes it."""

    def test_pressures_come_near_those_of_hertz_with_finer_cells(self):
        code, said = run("hertz_bodies.py", "--cells", "12")
        self.assertEqual(code, 0, said)
        coarse, fine, large = ([float(off) for off in re.findall(r"([+-][0-9.]+)%", line)] for line in said.splitlines())
        self.assertEqual([len(coarse), len(fine), len(large)], [4, 4, 4])
        self.assertLess(max(map(abs, fine + large)), 0.8)
        for one, half in zip(fine, coarse):
            self.assertLess(abs(one), 0.7 * abs(half))

    def test_too_small_bodies_are_refused(self):
        code, said = run("hertz_bodies.py", "--size", "12")
        self.assertEqual(code, 2)
        self.assertIn("a size above 12", said)


class CompareSpeed(unittest.TestCase):
    """Pieces of compare_speed.py and of what it stands on, and all of it with programs that only pretend."""

    def setUp(self):
        sys.path.insert(0, HERE)
        names = ("compare_speed", "speed_runs", "speed_tables", "accuracy", "jobs")
        self.script, self.runs, self.tables, self.accuracy, self.jobs = map(__import__, names)
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        return path

    def results(self, name, force, pressures, tilt=0.0):
        """A .dat and an .frd file with a force, and pressures by node in the last of two tables; nodes with x = 2 rise."""
        self.write(f"{name}.dat", TOTALS.format(force=force))
        rises = "".join(f" -1{node:10}{0.0:12.5E}{0.0:12.5E}{2.0 * tilt * (node in (2, 3)):12.5E}\n" for node in pressures)
        tables = MOTIONS.format(rows=rises)
        for scale in (0.5, 1.0):
            rows = "".join(
                f" -1{node:10}-1.00000E-03 0.00000E+00 0.00000E+00{scale * pressure:12.5E}\n"
                for node, pressure in pressures.items()
            )
            tables += TABLES.format(rows=rows)
        self.write(f"{name}.frd", tables)
        return os.path.join(self.folder, name)

    def test_forces_and_pressures_are_the_last_ones(self):
        results = self.results("deck", -10.1, {1: 512.5, 12: -3.25})
        self.assertEqual(list(self.accuracy.reaction(f"{results}.dat", "NTOP")), [3.03, 0.0, -10.1])
        self.assertEqual(self.accuracy.pressures(f"{results}.frd"), {1: 512.5, 12: -3.25})
        for wrong, name in ((self.accuracy.reaction, "NONE"), (self.accuracy.pressures, None)):
            with self.assertRaises(ValueError):
                wrong(f"{results}.dat", *([name] if name else []))

    def test_a_deck_tells_its_exact_solution_and_its_slave_surface(self):
        deck = self.accuracy.Deck(BALL)
        self.assertEqual((deck.dof, deck.radius), (24, 100.0))
        self.assertAlmostEqual(deck.modulus() / (210000.0 / 0.91 / 1.001), 1.0, places=12)
        self.assertEqual(deck.slave, {1: [0, 0, 0], 2: [2, 0, 0], 3: [2, 2, 0], 4: [0, 2, 0]})

    def test_sides_of_quadratic_tetrahedra_have_the_middles_of_their_edges(self):
        edges = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}
        count, sides = self.accuracy.SIDES["C3D10"]
        self.assertEqual(count, 10)
        for corners, side in zip(self.accuracy.TET, sides):
            wanted = {node for edge, node in edges.items() if set(edge) <= set(corners)}
            self.assertEqual((side[:3], set(side[3:])), (corners, wanted))

    def exact(self, force, deck):
        """Pressures of Hertz at the nodes of the slave surface."""
        p0, a = self.accuracy.hertz(4.0 * force, deck.radius, deck.modulus())
        at = {node: np.hypot(x, y) for node, (x, y, _) in deck.slave.items()}
        return p0, {node: p0 * np.sqrt(max(0.0, 1.0 - (r / a) ** 2)) for node, r in at.items()}

    def test_the_pressures_of_hertz_are_without_error_and_others_are_not(self):
        deck, force = self.accuracy.Deck(BALL), 5e4
        p0, exact = self.exact(force, deck)
        _, a = self.accuracy.hertz(4.0 * force, deck.radius, deck.modulus())
        # p0 is 3/2 of the mean pressure
        self.assertAlmostEqual(p0 * np.pi * a**2 / (1.5 * 4.0 * force), 1.0, places=12)
        found = self.accuracy.errors(deck, self.results("deck", -force, exact))
        self.assertEqual((found["force"], found["nodes"]), (4.0 * force, 4))
        for name in ("fitted", "largest", "centre", "rms"):
            self.assertLess(abs(found[name]), 1e-5, name)
        off = {**exact, 1: 0.8 * exact[1], 3: exact[3] + 0.3 * p0}
        found = self.accuracy.errors(deck, self.results("deck", -force, off))
        self.assertAlmostEqual(found["centre"], -0.2, places=4)
        self.assertAlmostEqual(found["largest"], max(off.values()) / p0 - 1.0, places=4)
        self.assertAlmostEqual(found["rms"], np.sqrt((0.2**2 + 0.3**2) / 4.0), places=4)
        # what is added across the exact pressures does not change the p0 that fits them, and no one at the edge does
        at = np.array([0.0, 0.5, 0.7, 0.9])
        shape = np.sqrt(1.0 - at**2)
        off = np.array([shape[1], -shape[0], 0.0, 5.0])
        p0, a = self.accuracy.hertz(1.0, 100.0, 1e3)
        found = self.accuracy.beside_hertz(1.0, 100.0, 1e3, at * a, p0 * (1.1 * shape + off))
        self.assertAlmostEqual(found["fitted"], 0.1, places=12)

    def test_nodes_outside_count_where_they_have_pressure(self):
        at, pressure = np.array([0.0, 2.0, 2.0]), np.array([1.0, 0.0, 0.5])
        p0, a = self.accuracy.hertz(1e-3, 100.0, 1e3)
        self.assertLess(a, 2.0)
        found = self.accuracy.beside_hertz(1e-3, 100.0, 1e3, at, pressure * p0)
        self.assertEqual(found["nodes"], 2)
        self.assertAlmostEqual(found["rms"], 0.5 / np.sqrt(2.0), places=12)

    def test_friction_is_judged_along_the_surface_where_it_ended(self):
        deck = self.accuracy.Deck(BALL.replace("R=100.0", "mu=0.3").replace("*STEP", "*FRICTION\n0.3,1e6\n*STEP"))
        results = self.results("deck", -10.0, {node: 7.0 for node in deck.slave}, tilt=0.02)
        found = self.accuracy.errors(deck, results)
        self.assertAlmostEqual(found["axes"], 0.01, places=9)
        normal = np.array([-0.02, 0.0, 1.0]) / np.hypot(1.0, 0.02)
        for one, wanted in zip(self.accuracy.mean_normal(deck, f"{results}.frd"), -normal):
            self.assertAlmostEqual(abs(one), abs(wanted), places=9)
        # a force that slips along a plane is one of Coulomb's there, and not along the axes
        across = np.array([1.0, 0.0, 0.02]) / np.hypot(1.0, 0.02)
        found = self.accuracy.beside_coulomb(5.0 * (normal - 0.3 * across), -normal, 0.3)
        self.assertAlmostEqual(found["friction"], 0.0, places=12)
        self.assertAlmostEqual(found["axes"], 1.09 * 0.02 / 0.3, places=3)

    def test_pressed_sides_alone_tell_the_normal(self):
        deck = self.accuracy.Deck(BALL)
        deck.slave_sides.append([11, 12, 13])
        deck.slave.update({11: [0, 0, 0], 12: [0, 1, 0], 13: [0, 0, 1]})
        for pressure, wanted in ((0.0, [0.0, 0.0, 1.0]), (4.0, [4.0, 0.0, 8.0])):
            given = {**dict.fromkeys((1, 2, 3, 4), 1.0), **dict.fromkeys((11, 12, 13), pressure)}
            found = self.accuracy.mean_normal(deck, f"{self.results('deck', -1.0, given)}.frd")
            for one, exact in zip(found, wanted):
                self.assertAlmostEqual(abs(one), exact / np.linalg.norm(wanted), places=12)

    def test_a_solver_takes_the_place_of_another_one(self):
        found = self.runs.with_solver("*STEP\n*Static, Solver=PARDISO, DIRECT\n1.,1.\n*STATIC\n", "SPOOLES")
        self.assertEqual(found, "*STEP\n*Static, DIRECT,SOLVER=SPOOLES\n1.,1.\n*STATIC,SOLVER=SPOOLES\n")

    def test_exponents_are_those_of_powers(self):
        costs = {n: self.jobs.Cost(3e-6 * n**1.25, 1e-6 * n**1.1, round(100.0 * n)) for n in (50_000, 150_000, 900_000)}
        found = self.tables.exponents(costs)
        self.assertEqual((found["from"], found["to"]), (50_000, 900_000))
        for name, power in (("wall", 1.25), ("processors", 1.1), ("memory", 1.0)):
            self.assertAlmostEqual(found[name], power, places=9)
        self.assertIsNone(self.tables.exponents({50_000: costs[50_000]}))

    def test_costs_are_those_of_the_program_and_not_of_who_asks(self):
        ballast = b"x" * 300_000_000
        code, said, cost = self.jobs.measured(["echo", "done"], self.folder, 600.0, 1)
        self.assertEqual((code, said), (0, "done\n"))
        self.assertLess(cost.memory, len(ballast) / 3)
        hold = [sys.executable, "-c", "import sys, time; held = b'x' * 200_000_000; sys.exit(3)"]
        code, _, cost = self.jobs.measured(hold, self.folder, 600.0, 1)
        self.assertEqual(code, 3)
        self.assertGreater(cost.memory, 200_000_000)
        self.assertGreater(cost.processors, 0.0)
        code, _, _ = self.jobs.measured(["sleep", "600"], self.folder, 0.2, 1)
        self.assertIsNone(code)

    def by_their_own_account(self, command, folder, limit, threads):
        """Measures programs that pretend by the seconds that they leave in a file, and stops them by these."""
        code, said, cost = self.jobs.measured(command, folder, 600.0, threads)
        with open(os.path.join(folder, "seconds"), encoding="ascii") as file:
            seconds = float(file.read())
            cost = dataclasses.replace(cost, wall=seconds, processors=seconds)
        if cost.wall > limit:
            return None, "", dataclasses.replace(cost, wall=limit)
        return code, said, cost

    def compare(self, *more, families=False):
        """A row through programs that pretend; CalculiX has two solvers, and the second one is faster."""
        generator = self.write("generator.py", f"import sys\nopen(sys.argv[2], 'w').write({BALL!r})\n")
        deck, force = self.accuracy.Deck(BALL), 5e4
        p0, exact = self.exact(force, deck)
        self.results("good", -force, {**exact, 1: 1.015 * p0})
        self.results("bad", -force, {**exact, 1: 1.25 * p0})
        ccx = pretending(
            self.folder,
            "ccx",
            f"""import shutil, sys
job = sys.argv[2]
if job == "-v":
    sys.exit("")
text = open(job + ".inp").read()
open("seconds", "w").write("0.1")
if "SOLVER=PASTIX" in text:
    print(" *ERROR in nonlingeo: the PASTIX library is not linked")
    sys.exit(201)
open("seconds", "w").write("1.5" if "SOLVER=SPOOLES" in text else "0.5")
open(job + ".sta", "w").write("head\\nhead\\n 1 1 1 4 1. 1. 1.\\n 1 2 1 3 1. 1. 1.\\n")
for end in (".dat", ".frd"):
    shutil.copyfile({self.folder!r} + "/bad" + end, job + end)
""",
        )
        signorini = pretending(
            self.folder,
            "signorini",
            f"""import json, os, shutil, sys
if sys.argv[1] == "--version":
    print("signorini 1.2.3")
    sys.exit(0)
open("seconds", "w").write("0.2")
if "x=2" in sys.argv:
    print("error: there is no x")
    sys.exit(3)
out = sys.argv[sys.argv.index("--output") + 1]
os.makedirs(out)
for end in (".dat", ".frd"):
    shutil.copyfile({self.folder!r} + "/good" + end, out + "/deck" + end)
open(out + "/case.resolved.toml", "w").write("force_tol = 1e-7   # largest\\n")
summary = {{"steps": [{{"iterations": 5, "increments": 2}}], "time": {{"solve": 0.25}}}}
open(out + "/summary.json", "w").write(json.dumps(summary))
""",
        )
        command = ["--ccx", ccx, "--signorini", signorini]
        command += [] if families else ["--generator", generator, "--rows", "hertz-C3D8-10000"]
        solvers = ["--ccx-solvers", "SPOOLES", "ITERATIVESCALING", "PASTIX"]
        argv = ["compare_speed.py", *command, *solvers, *more]
        said = io.StringIO()
        with (
            mock.patch.object(self.runs, "measured", self.by_their_own_account),
            mock.patch.object(sys, "argv", argv),
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
        ):
            code = self.script.main()
        return code, said.getvalue()

    def test_costs_and_errors_stand_side_by_side(self):
        page, numbers = os.path.join(self.folder, "page.md"), os.path.join(self.folder, "numbers.json")
        self.write("page.md", f"before\n{self.script.MARKERS[0]}\nold\n{self.script.MARKERS[1]}\nafter\n")
        code, said = self.compare("--markdown", page, "--json", numbers)
        self.assertEqual(code, 0, said)
        self.assertIn("has no PASTIX", said)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n"), text)
        self.assertNotIn("old", text)
        rows = [line.strip("| \n").split(" | ") for line in text.splitlines() if line.startswith("| hertz-C3D8-10000")]
        speed, errors, phases = rows
        self.assertEqual(speed[1:4] + speed[-1:], ["24", "2 / 2", "7 / 5", "iterativescaling"])
        self.assertAlmostEqual(float(speed[6]), float(speed[4]) / float(speed[5]), delta=0.1 * float(speed[6]))
        self.assertEqual(errors[1:3] + errors[5:7], ["5e-03", "1e-07", "+25.00%", "+1.50%"])
        p0, exact = self.exact(5e4, self.accuracy.Deck(BALL))
        share = p0**2 / sum(p**2 for p in exact.values())
        for cell, off in zip(errors[3:5], (0.25, 0.015)):
            self.assertAlmostEqual(float(cell.rstrip("%")) / 100.0, off * share, places=4)
        self.assertEqual(phases[1:], ["0.25"])
        with open(numbers, encoding="utf-8") as file:
            (row,) = json.load(file)["rows"]
        self.assertEqual((row["ours"]["iterations"], row["ccx"]["solver"]), (5, "ITERATIVESCALING"))

    def test_a_slower_solver_is_stopped(self):
        code, said = self.compare("--ccx-solvers", "ITERATIVESCALING", "SPOOLES")
        self.assertEqual(code, 0, said)
        self.assertIn("CalculiX: SPOOLES stopped after", said)

    def test_what_is_not_solved_is_a_failure_that_is_reported(self):
        code, said = self.compare("--set", "x=2")
        self.assertEqual(code, 1, said)
        self.assertIn("NOT SOLVED by signorini: exit code 3, error: there is no x", said)
        self.assertIn("1 of 1 rows NOT SOLVED: hertz-C3D8-10000", said)

    def make_forces(self, name, held, loaded):
        """A .dat file with the reactions of two sets, as a family has them, and an empty .frd file."""
        text = ""
        for one, force in (("HELD", held), ("LOADED", loaded)):
            text += f"\n total force (fx,fy,fz) for set {one} and time  0.1000000E+01\n\n"
            text += "".join(f"{x:15.6E}" for x in force) + "\n"
        self.write(f"{name}.dat", text)
        self.write(f"{name}.frd", "")

    def compare_forces(self, ccx, ours, *more):
        """A family's row, whose forces on a loaded set of nodes differ."""
        run = self.by_their_own_account

        def measure(command, folder, limit, threads):
            self.make_forces("bad", [-value for value in ccx], ccx)
            self.make_forces("good", [0.0, 0.0, 100.0], ours)
            return run(command, folder, limit, threads)

        with mock.patch.object(self, "by_their_own_account", measure):
            return self.compare("--rows", "tet10-*-1", "--quick", *more, families=True)

    def test_forces_of_both_programs_are_compared_relative_to_the_largest(self):
        page = self.write("page.md", "{}\n{}\n".format(*self.script.FAMILY_MARKERS))
        code, said = self.compare_forces([1.0, 0.0, -101.0], [0.0, 0.0, -100.0], "--markdown", page)
        self.assertEqual(code, 0, said)
        self.assertIn("ratio 2.50 in CPU s, forces differ by 0.99%", said)
        with open(page, encoding="utf-8") as file:
            costs, forces, _ = [line.strip("| \n").split(" | ") for line in file if line.startswith("| tet10")]
        self.assertEqual(costs[2:7], ["2 / 2", "7 / 5", "0.50", "0.20", "2.50"])
        self.assertEqual((forces[1], forces[3:]), ("0.99%", ["0e+00", "yes"]))

    def test_forces_that_differ_or_do_not_balance_are_a_failure(self):
        for ccx, ours, words in (
            ([0.0, 0.0, -150.0], [0.0, 0.0, -100.0], "FORCES DIFFER by 33.33%"),
            ([0.0, 0.0, -100.0], [0.1, 0.0, -100.0], "FORCES OF SIGNORINI NOT IN BALANCE"),
        ):
            with tempfile.TemporaryDirectory() as kept:
                code, said = self.compare_forces(ccx, ours, "--keep", kept)
                self.assertEqual((code, len(os.listdir(kept))), (1, 1), said)
            self.assertIn(words, said)

    def test_loads_count_in_the_balance_of_forces(self):
        found = {"A": [1.0, 0.0, 30.0], "B": [-1.0, 0.0, 69.0]}
        self.assertAlmostEqual(self.accuracy.imbalance(found, np.array([0.0, 0.0, -100.0])), 1.0 / 69.0, places=12)

    def test_all_builds_of_calculix_on_the_search_path_are_found_once(self):
        names = ["ccx", "ccx_2.22", "ccx_2.21_MT", "ccx_pastix", "ccx2.19"]
        others = ["ccx2paraview", "ccxtool", "cgx"]
        for name in [*names, *others]:
            pretending(self.folder, name, "print('This is Version 2.22')")
        os.symlink(os.path.join(self.folder, "ccx"), os.path.join(self.folder, "ccx_link"))
        with mock.patch.dict(os.environ, PATH=self.folder + os.pathsep + os.environ["PATH"]):
            found = self.runs.builds([])
        here = [one for one in found if os.path.dirname(one.path) == self.folder]
        self.assertEqual(sorted(os.path.basename(one.path) for one in here), sorted(names))
        self.assertEqual({one.version for one in here}, {"2.22"})
        (one,) = self.runs.builds([os.path.join(self.folder, "cgx")])
        self.assertEqual(os.path.basename(one.path), "cgx")

    def test_each_measure_counts_for_the_solver_that_needs_least_of_it(self):
        slow = self.runs.Solution(solver="A", cost=self.jobs.Cost(3.0, 5.0, 70))
        fast = self.runs.Solution(solver="B", cost=self.jobs.Cost(4.0, 4.5, 90))
        for found in (self.runs.better(slow, fast), self.runs.better(fast, slow)):
            self.assertEqual((found.solver, found.cost), ("B", self.jobs.Cost(3.0, 4.5, 90)))

    def test_what_the_command_line_lacks_is_named(self):
        program = pretending(self.folder, "signorini", "")
        page = self.write("page.md", "no markers")
        for arguments, word in (
            (["--rows", "odd"], "no row is called odd"),
            (["--markdown", page], "has no lines"),
            (["--signorini", os.path.join(self.folder, "none")], "there is no program"),
            (["--ccx", os.path.join(self.folder, "none")], "there is no program"),
            (["--generator", os.path.join(self.folder, "none")], "there is no generator"),
        ):
            code, said = run("compare_speed.py", "--signorini", program, *arguments)
            self.assertEqual(code, 2, said)
            self.assertIn(word, said)


class SpeedDecks(InFolder):
    """Decks of the ten families, as text, and small ones through signorini where there is a build of it."""

    SMALL = 300

    def setUp(self):
        super().setUp()
        sys.path.insert(0, HERE)
        self.script, self.jobs = map(__import__, ("speed_decks", "jobs"))

    def make(self, family, seed, dof=SMALL):
        return self.script.make(family, dof, seed).text()

    def test_a_seed_gives_the_same_deck_again_and_another_seed_another_one(self):
        for family in self.script.FAMILIES:
            decks = [self.make(family, seed) for seed in (1, 2, 3, 4)]
            self.assertEqual(decks[0], self.make(family, 1), family)
            bodies = {deck.split("*NODE", 1)[1] for deck in decks}
            self.assertEqual(len(bodies), len(decks), family)

    def test_nodes_are_finite_and_used_and_surfaces_and_sets_are_not_empty(self):
        for family in self.script.FAMILIES:
            for seed in (1, 2, 3):
                with self.subTest(family=family, seed=seed):
                    self.check(self.jobs.cards(self.make(family, seed)))

    def check(self, cards):
        nodes, used, surfaces, pairs = {}, set(), {}, []
        for card, lines in cards:
            (keyword,) = self.jobs.keywords(card)
            if keyword == "NODE":
                for line in lines:
                    number, *at = line.split(",")
                    self.assertNotIn(int(number), nodes)
                    nodes[int(number)] = [float(x) for x in at]
            elif keyword == "ELEMENT":
                used |= {int(number) for line in lines for number in line.split(",")[1:]}
            elif keyword == "SURFACE":
                surfaces[self.jobs.parameter(card, "NAME")] = lines
            elif keyword == "CONTACTPAIR":
                pairs += [line.split(",") for line in lines]
            elif keyword == "NSET":
                self.assertTrue(self.jobs.fields(lines), card)
        self.assertTrue(np.isfinite(list(nodes.values())).all())
        self.assertEqual(used, set(nodes))
        self.assertTrue(pairs)
        for slave, master in pairs:
            self.assertTrue(surfaces[slave] and surfaces[master], (slave, master))

    def test_elements_are_right_handed(self):
        for family in self.script.FAMILIES:
            for seed in (1, 2, 3):
                for part in self.script.make(family, 2 * self.SMALL, seed).parts:
                    corners = part.mesh.points[part.mesh.cells]
                    last = {"hex": (1, 3, 4), "tet": (1, 2, 3), "quad": (1, 3)}[part.mesh.shape]
                    edges = np.stack([corners[:, one] - corners[:, 0] for one in last], axis=1)
                    self.assertGreater(np.linalg.det(edges).min(), 0.0, (family, seed, part.name))

    def test_printed_sets_share_no_node_so_that_their_forces_add_up(self):
        for family in self.script.FAMILIES:
            deck = self.script.make(family, self.SMALL, 1)
            nodes = [node for name in deck.printed for node in deck.sets[name]]
            self.assertEqual(len(nodes), len(set(nodes)), family)
            named = {name for name, *_ in deck.supports} | {name for step in deck.steps for name, *_ in step.moves}
            self.assertEqual(named, set(deck.printed), family)

    def test_unknowns_come_near_what_is_asked_for(self):
        for family in self.script.FAMILIES:
            for dof in (3000, 8000):
                self.assertLess(abs(self.script.make(family, dof, 1).dof / dof - 1.0), 0.15, family)

    def test_the_command_writes_the_deck(self):
        code, said = run("speed_decks.py", "plane", self.path("deck.inp"), "--dof", str(self.SMALL), "--seed", "3")
        self.assertEqual(code, 0, said)
        with open(self.path("deck.inp"), encoding="ascii") as file:
            self.assertEqual(file.read(), self.make("plane", 3))
        self.assertEqual(run("speed_decks.py", "--list")[1].split(), list(self.script.FAMILIES))
        self.assertEqual(run("speed_decks.py", "cubes", self.path("deck.inp"))[0], 2)

    @unittest.skipIf(shutil.which(SIGNORINI) is None, "there is no build of signorini")
    def test_small_decks_run_in_signorini_and_their_forces_balance(self):
        accuracy = __import__("accuracy")
        for family in self.script.FAMILIES:
            text = self.make(family, 1)
            with open(self.path("deck.inp"), "w", encoding="ascii") as file:
                file.write(text)
            command = ["run", self.path("deck.inp"), "--output", self.path(family), "--quiet"]
            done = subprocess.run([SIGNORINI, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(done.returncode, 0, f"{family}: {done.stdout}")
            deck = accuracy.Deck(text)
            forces = accuracy.forces(deck, self.path(family, "deck"))
            self.assertLess(accuracy.imbalance(forces, deck.applied), 1e-4, family)


HEX = """*NODE, NSET=ALL
1,0,0,0
2,2,0,0
3,2,1,0
4,0,1,0
5,0,0,1
6,2,0,1
7,2,1,1
8,0,1,1
9,1,0,0
10,2,.5,0
11,1,1,0
12,0,.5,0
13,1,0,1
14,2,.5,1
15,1,1,1
16,0,.5,1
17,0,0,.5
18,2,0,.5
19,2,1,.5
20,0,1,.5
*ELEMENT, TYPE=C3D20, ELSET=E
1,1,2,3,4,5,6,7,8,9,10,11,12,13,14,
15,16,17,18,19,20
*NSET, NSET=BASE
1,2,3,4,9,10,11,12
*STEP
*DLOAD
1, P2, 3.
*END STEP
"""

QUAD = """*NODE
1,0,2,0
2,0,0,0
3,1,0,0
4,1,2,0
5,0,1,0
6,.5,0,0
7,1,1,0
8,.5,2,0
*ELEMENT, TYPE=CPS8R, ELSET=E
1,1,2,3,4,5,6,7,8
*STEP
*CLOAD
4,2,-1.
8,2,-4.
1,2,-1.
*END STEP
"""


class Refinements(unittest.TestCase):
    """Decks of one element, cut into eight or four."""

    def setUp(self):
        sys.path.insert(0, HERE)
        self.script = __import__("refine_decks")

    def test_an_element_becomes_eight_that_share_their_nodes(self):
        mesh = self.script.Mesh(HEX, 2)
        self.assertEqual(len(mesh.new), 8)
        # those of a grid of 5 × 5 × 5 but the middles of faces and cells
        self.assertEqual(len(mesh.place), 81)
        self.assertEqual(mesh.old, set(range(1, 21)))
        self.assertEqual(mesh.place[1], (0.0, 0.0, 0.0))
        base = mesh.grown([1, 2, 3, 4, 9, 10, 11, 12])
        self.assertEqual(len(base), 21)
        self.assertTrue(all(mesh.place[node][2] == 0.0 for node in base))
        self.assertEqual(sum(",P2," in line for line in mesh.deck().splitlines()), 4)

    def test_forces_of_an_edge_are_those_of_its_parts(self):
        mesh = self.script.Mesh(QUAD, 2)
        rows = [line.split(",") for line in mesh.forces(["4,2,-1.", "8,2,-4.", "1,2,-1."])]
        forces = {mesh.place[int(node)][0]: float(value) for node, _, value in rows}
        wanted = {0.0: -0.5, 0.25: -2.0, 0.5: -1.0, 0.75: -2.0, 1.0: -0.5}
        self.assertEqual(sorted(forces), sorted(wanted))
        for x, force in wanted.items():
            self.assertAlmostEqual(forces[x], force)


class RunOofem(InFolder):
    """run_oofem.py with a program that only pretends: what it does depends on the name of the deck."""

    def setUp(self):
        super().setUp()
        self.program = os.path.join(self.folder, "signorini")
        with open(self.program, "w", encoding="utf-8") as file:
            file.write(
                f"""#!{sys.executable}
import json, os, sys
deck, out = sys.argv[2], sys.argv[sys.argv.index("-o") + 1]
name = os.path.basename(deck)
if name == "odd.in":
    print("error[S0111]: the material 1 is not supported", file=sys.stderr)
    sys.exit(3)
if name == "stuck.in":
    sys.exit(5)
os.makedirs(out)
value = 1.5 if name == "far.in" else 1.0
checks = [{{"what": "u", "value": 1.0, "got": value, "ok": value == 1.0}}]
checks = [] if name == "bare.in" else checks
open(os.path.join(out, "summary.json"), "w").write(json.dumps({{"expectations": checks}}))
sys.exit(int(value != 1.0))
"""
            )
        os.chmod(self.program, 0o755)

    def decks(self, *names):
        folder = os.path.join(self.folder, "decks", "below")
        os.makedirs(folder)
        for name in names:
            open(os.path.join(folder, name), "w", encoding="utf-8").close()
        return os.path.dirname(folder)

    def test_every_deck_has_a_line_and_is_counted(self):
        decks = self.decks("good.in", "far.in", "odd.in", "stuck.in", "bare.in")
        page = os.path.join(self.folder, "page.md")
        code, said = run("run_oofem.py", decks, "--signorini", self.program, "--markdown", page)
        self.assertEqual(code, 1, said)
        rows = {line.split()[0]: line.split()[1] for line in said.splitlines() if line.startswith("below")}
        names = ["bare", "far", "good", "odd", "stuck"]
        states = ["solved", "differs", "passed", "refused", "fails"]
        self.assertEqual(rows, {f"below/{n}.in": s for n, s in zip(names, states)})
        self.assertIn("0 of 1 checks; u is 1.5, not 1.0", said)
        self.assertIn("5 decks: 4 parsed, 3 run, 1 passed their checks", said)
        self.assertIn("1 x the material N is not supported", said)
        with open(page, encoding="utf-8") as file:
            self.assertIn("| below/good.in | passed | 1 checks |", file.read())

    def test_good_decks_are_a_success_and_no_decks_are_not(self):
        decks = self.decks("good.in")
        self.assertEqual(run("run_oofem.py", decks, "--signorini", self.program)[0], 0)
        empty = os.path.join(self.folder, "empty")
        os.makedirs(empty)
        self.assertEqual(run("run_oofem.py", empty, "--signorini", self.program)[0], 2)
        missing = os.path.join(self.folder, "none")
        self.assertEqual(run("run_oofem.py", decks, "--signorini", missing)[0], 2)


if __name__ == "__main__":
    strict = "--nothing-skipped" in sys.argv
    result = unittest.main(argv=[a for a in sys.argv if a != "--nothing-skipped"], verbosity=2, exit=False).result
    sys.exit(0 if result.wasSuccessful() and not (strict and result.skipped) else 1)
