"""Opens reports in a browser without a window and checks what they show.

    apt-get install chromium
    pip install playwright numpy
    python scripts/test_report.py [--signorini PROGRAM] [--chromium PROGRAM] [--keep FOLDER]

Six examples are run and reported: in the plane, axisymmetric, in space, with friction, one that does not converge, and a
larger one. For each page: no error on the console; no request; every number of a table equals the one in summary.json or
history.csv; the pixels of the model change with the frame and with the field, and are the same again in the same frame; a
click of the mouse at the foremost node of the .vtu file picks this node, and a click next to the model picks none; the values
shown for the node are those of the .vtu files, also after the frame changes. The last line says how many passed.
"""

import argparse
import csv
import json
import math
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

import numpy
from playwright.sync_api import TimeoutError, sync_playwright

ROOT = Path(__file__).resolve().parent.parent
# name, example, changes, exit code
CASES = [
    ("plane", "hertz_cylinder_2d", [], 0),
    ("axisymmetric", "flat_punch_axisymmetric", [], 0),
    ("space", "twisting_blocks_3d_mortar", [], 0),
    ("friction", "friction_loop_3d_node_to_segment", [], 0),
    ("failed", "twisting_blocks_3d_mortar", ["solver.newton.max_iterations=3", "solver.on_trouble=[]"], 5),
    ("large", "hertz_sphere_3d", [], 0),
]
# the browser draws in software: a small window makes a difference
WINDOW = {"width": 640, "height": 480}
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
# values of the view have four bytes
TOLERANCE = 1e-6

# the matrices with which the view is drawn, column by column, and the canvas in the window
CAMERA = """() => {
    const { glplot, dataScale } = document.getElementById("stage")._fullLayout.scene._scene;
    const { model, view, projection } = glplot.cameraParams, box = glplot.canvas.getBoundingClientRect();
    return [[model, view, projection].map((m) => [...m]), [...dataScale], [box.left, box.top, box.width, box.height]];
}"""


def arrays(path):
    """The arrays over the nodes of a .vtu file with appended raw data, by name: components, and values node by node."""
    content = path.read_bytes()
    head, _, rest = content.partition(b"<AppendedData")
    data = rest[rest.index(b"_") + 1:]
    found = {}
    for section in ("PointData", "Points"):
        text = head.decode().split(f"<{section}")[1].split(f"</{section}>")[0]
        for tag in re.findall(r"<DataArray [^>]*>", text):
            attributes = dict(re.findall(r'(\w+)="([^"]*)"', tag))
            at = int(attributes["offset"])
            nblock, _, _ = struct.unpack_from("<3Q", data, at)
            sizes = struct.unpack_from(f"<{nblock}Q", data, at + 24)
            at += 24 + 8 * nblock
            plain = b""
            for size in sizes:
                plain += zlib.decompress(data[at:at + size])
                at += size
            count = int(attributes.get("NumberOfComponents", 1))
            names = [attributes.get(f"ComponentName{k}") or ("xyz"[k] if count == 3 else str(k + 1)) for k in range(count)]
            values = numpy.frombuffer(plain, attributes["type"].lower())
            found[attributes["Name"]] = (names, values.reshape(-1, count))
    return found


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Page:
    """A report in the browser, with everything that goes wrong in it."""

    def __init__(self, browser, path):
        self.wrong = []
        self.page = browser.new_page(viewport=WINDOW)
        self.page.on("console", lambda m: self.wrong.append(f"console: {m.text}") if m.type == "error" else None)
        self.page.on("pageerror", lambda error: self.wrong.append(f"error: {error}"))
        self.page.on("request", self.request)
        self.page.goto(path.resolve().as_uri())
        self.page.wait_for_function("document.body.dataset.ready", timeout=120_000)
        check(self.page.evaluate("document.body.dataset.ready") == "yes", "the script has failed")

    def request(self, request):
        if not request.url.startswith(("file:", "data:", "blob:")):
            self.wrong.append(f"request: {request.url}")

    def after_drawing(self, act):
        """The pixels of the model after an action that draws it again."""
        drawn = int(self.page.evaluate("document.body.dataset.drawn"))
        act()
        self.page.wait_for_function(f"Number(document.body.dataset.drawn) > {drawn}", timeout=60_000)
        return self.pixels()

    def next_frame(self):
        """Waits until what has been drawn is on the screen."""
        self.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def clip(self, left, top, right, bottom):
        """The pixels of a part of the window, as PNG."""
        self.next_frame()
        box = {"x": int(left), "y": int(top), "width": int(right) - int(left) + 1, "height": int(bottom) - int(top) + 1}
        return self.page.screenshot(clip=box)

    def around(self, x, y, distance):
        return self.clip(x - distance, y - distance, x + distance, y + distance)

    def pixels(self):
        """The pixels of the box around the last frame of the model: without the axes next to it and the legend."""
        return self.clip(*self.box)

    def place(self, points):
        """Where points of the model are: in pixels of the window, and how far behind the screen."""
        matrices, scale, (left, top, width, height) = self.page.evaluate(CAMERA)
        rows = numpy.hstack([points * scale, numpy.ones((len(points), 1))])
        for matrix in matrices:
            rows = rows @ numpy.reshape(matrix, (4, 4))
        x, y, z = (rows[:, :3] / rows[:, 3:]).T
        return numpy.column_stack([left + (0.5 + 0.5 * x) * width, top + (0.5 - 0.5 * y) * height]), z

    def frame(self, number):
        return self.after_drawing(lambda: self.page.evaluate(
            "number => { const s = document.getElementById('frame'); s.value = number; s.dispatchEvent(new Event('input')); }", number))

    def field(self, name):
        return self.after_drawing(lambda: self.page.select_option("#field", name))


def numbers_agree(page, folder):
    """Every number with a source equals that of the source; returns how many there are."""
    summary = json.loads((folder / "summary.json").read_text())
    rows = list(csv.DictReader((folder / "history.csv").open()))
    cells = page.page.evaluate("[...document.querySelectorAll('[data-key]')].map(c => [c.dataset.key, c.dataset.value, c.textContent])")
    for key, value, text in cells:
        if key.startswith("history.csv:"):
            _, row, column = key.split(":", 2)
            wanted = float(rows[int(row)][column])
        else:
            wanted = summary
            for part in key.split("/"):
                part = part.replace("~1", "/")
                wanted = wanted[int(part) if isinstance(wanted, list) else part]
            wanted = float("nan") if wanted is None else float(wanted)
        if math.isnan(wanted):
            check(value == "null", f"{key}: {value} is a number")
            continue
        check(float(value) == wanted, f"{key}: {value}, not {wanted}")
        if key == "memory_peak_bytes":
            continue
        shown = float(text.split("%")[0].replace("−", "-").replace("\u202f", ""))
        check(abs(shown - wanted) <= 1e-4 * abs(wanted), f"{key}: {text} is shown, not {wanted}")
    return len(cells)


def foremost(places, depths):
    """A node that nothing hides: the one with the least depth. In the plane all have it: the one nearest to the middle of
    those that have no other one within four pixels."""
    front = numpy.flatnonzero(depths <= depths.min() + 1e-6 * max(numpy.ptp(depths), 1e-6))
    places = places[front]
    apart = numpy.linalg.norm(places[:, None] - places[None], axis=2)
    numpy.fill_diagonal(apart, math.inf)
    to_middle = numpy.linalg.norm(places - places.mean(axis=0), axis=1)
    return front[numpy.argmin(numpy.where(apart.min(axis=1) > 4, to_middle, math.inf))]


def click_a_node(page, labels, points):
    """Clicks next to the model and at its foremost node."""
    picked = "document.getElementById('picked').dataset.node"
    corner = page.page.locator("#stage").bounding_box()
    empty = (corner["x"] + 6, corner["y"] + 6)
    page.page.mouse.click(*empty)
    page.next_frame()
    check(page.page.evaluate(picked) is None, "a click next to the model picks a node")
    # the room for the model depends on the numbers of the legend
    places, depths = page.place(points)
    node = foremost(places, depths)
    x, y = (round(float(pixel)) for pixel in places[node])
    check(page.around(x, y, 1) != page.around(*empty, 1), f"the pixel ({x}, {y}) of node {labels[node]} is empty")
    before = page.around(x, y, 12)
    after = page.after_drawing(lambda: page.page.mouse.click(x, y))
    found = int(page.page.evaluate(picked))
    check(found == labels[node], f"a click at node {labels[node]} picks node {found}")
    check(page.around(x, y, 12) != before, "the picked node has no mark")
    return found


def frame_of(folder, number):
    """The arrays of a frame of the solids and of the contacts, by its number in the lists of frames."""
    def listed(name):
        path = folder / name
        return dict(re.findall(r'timestep="([^"]*)".*file="([^"]*)"', path.read_text())) if path.exists() else {}

    solids, contacts = listed("results.pvd"), listed("contact.pvd")
    moment = list(solids)[number]
    return [arrays(folder / files[moment]) if moment in files else {} for files in (solids, contacts)]


def values_agree(page, folder):
    """The values of the picked node are those of the .vtu files; returns how many there are."""
    node, number = page.page.evaluate("(d => [Number(d.node), Number(d.frame)])(document.getElementById('picked').dataset)")
    shown = page.page.evaluate("[...document.querySelectorAll('#picked td')].map(c => [c.dataset.field, Number(c.dataset.value)])")
    solids, contacts = frame_of(folder, number)
    count = 0
    for field, value in shown:
        name, _, component = field.partition(".")
        grid = contacts if name in contacts and name.startswith("contact_") else solids
        names, values = grid[name]
        wanted = values[grid["node_id"][1][:, 0] == node, names.index(component) if component else 0]
        size = numpy.abs(values[numpy.isfinite(values)]).max(initial=0.0)
        near = numpy.abs(wanted - value) <= TOLERANCE * numpy.maximum(numpy.abs(wanted), 1e-3 * size)
        check(near.any(), f"node {node}, {field}: {value} is shown, {wanted} is in the file")
        count += 1
    return count


def examine(browser, name, folder, keep):
    page = Page(browser, folder / "report.html")
    ncell = numbers_agree(page, folder)
    check(ncell > 15, f"only {ncell} numbers have a source")
    page.page.locator("#stage").scroll_into_view_if_needed()
    last = int(page.page.evaluate("document.getElementById('frame').max"))
    solids, _ = frame_of(folder, page.page.evaluate("JSON.parse(document.getElementById('data').textContent).view.frames.at(-1).number"))
    points = solids["Points"][1] + solids["displacement"][1]
    places, _ = page.place(points)
    page.box = [*places.min(axis=0), *places.max(axis=0)]
    start = page.pixels()
    check(page.frame(0) != start, "the view does not change with the frame")
    check(page.frame(last) == start, "the view does not change back with the frame")
    fields = page.page.evaluate("[...document.getElementById('field').options].map(o => o.value)")
    second = next(field for field in ["contact_pressure|-1", "displacement|-1"] if field in fields)
    check(page.field(second) != start, "the view does not change with the field")
    if keep:
        page.page.locator("#view").screenshot(path=str(keep / f"{name}-contact.png"))
    page.field(fields[0])
    node = click_a_node(page, solids["node_id"][1][:, 0], points)
    nvalue = values_agree(page, folder)
    check(nvalue > 6, f"only {nvalue} values of the node are shown")
    if keep:
        page.page.locator("#view").screenshot(path=str(keep / f"{name}-view.png"))
        page.page.evaluate("scrollTo(0, 0)")
        page.page.screenshot(path=str(keep / f"{name}.png"), full_page=True)
        page.page.pdf(path=str(keep / f"{name}.pdf"), prefer_css_page_size=True)
    page.frame(0)
    nvalue += values_agree(page, folder)
    check(not page.wrong, "; ".join(page.wrong))
    page.page.close()
    return f"{ncell} numbers of tables, {nvalue} values of node {node}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--signorini", default="signorini", help="the program")
    parser.add_argument("--chromium", default=shutil.which("chromium"), help="the browser; playwright's own where absent")
    parser.add_argument("--keep", type=Path, help="a folder for pictures of the pages")
    options = parser.parse_args()
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    passed = 0
    with tempfile.TemporaryDirectory() as scratch, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=options.chromium, args=FLAGS)
        for name, example, changes, code in CASES:
            began = time.monotonic()
            folder = Path(scratch) / name
            sets = [word for change in changes for word in ("--set", change)]
            command = [options.signorini, "run", str(ROOT / "examples" / example / "case.toml"), "-o", str(folder), "-q", "--report", *sets]
            done = subprocess.run(command, capture_output=True, text=True)
            try:
                check(done.returncode == code, f"exit code {done.returncode}, not {code}: {done.stderr}")
                found = examine(browser, name, folder, options.keep)
                size = (folder / "report.html").stat().st_size
                print(f"{name}: {found}, {size / 1e6:.1f} MB, {time.monotonic() - began:.0f} s", flush=True)
                passed += 1
            except (AssertionError, TimeoutError) as error:
                print(f"{name}: FAILED: {error}", flush=True)
        browser.close()
    print(f"report: {passed} passed")
    return 0 if passed == len(CASES) else 1


if __name__ == "__main__":
    sys.exit(main())
