"""Opens reports in a browser without a window and checks what they show.

    pip install playwright numpy
    python scripts/test_report.py [--signorini PROGRAM] [--chromium PROGRAM] [--keep FOLDER]

Six examples are run and reported: in the plane, axisymmetric, in space, with friction, one that does not converge, and a
larger one. For each page: no error on the console, no request to anywhere, every number of a table equals the one in
summary.json or history.csv, the pixels of the view change when the frame and when the field changes, a node is picked by
a click and its values are those of the .vtu file. The last line says how many passed.
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
import zlib
from pathlib import Path

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
# the browser draws in software
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
# values of the view have four bytes
TOLERANCE = 1e-6

KINDS = {"Float64": "d", "Float32": "f", "Int8": "b", "UInt8": "B", "Int32": "i", "Int64": "q"}


def arrays(path):
    """The arrays over the nodes of a .vtu file with appended raw data, by name: components and values."""
    content = path.read_bytes()
    head, _, rest = content.partition(b"<AppendedData")
    data = rest[rest.index(b"_") + 1:]
    found = {}
    points = head.decode().split("<PointData")[1].split("</PointData>")[0]
    for tag in re.findall(r"<DataArray [^>]*>", points):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        at = int(attributes["offset"])
        nblock, size, last = struct.unpack_from("<3Q", data, at)
        sizes = struct.unpack_from(f"<{nblock}Q", data, at + 24)
        at += 24 + 8 * nblock
        plain = b""
        for one in sizes:
            plain += zlib.decompress(data[at:at + one])
            at += one
        letter = KINDS[attributes["type"]]
        values = struct.unpack(f"<{len(plain) // struct.calcsize(letter)}{letter}", plain)
        count = int(attributes.get("NumberOfComponents", 1))
        names = [attributes.get(f"ComponentName{k}") or ("xyz"[k] if count == 3 else str(k + 1)) for k in range(count)]
        found[attributes["Name"]] = (names, values)
    return found


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Page:
    """A report in the browser, with everything that goes wrong in it."""

    def __init__(self, browser, path):
        self.wrong = []
        self.page = browser.new_page(viewport={"width": 1280, "height": 900})
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
        """The pixels of the view after an action that draws it again."""
        drawn = int(self.page.evaluate("document.body.dataset.drawn"))
        act()
        self.page.wait_for_function(f"Number(document.body.dataset.drawn) > {drawn}", timeout=60_000)
        return self.pixels()

    def within(self, what, milliseconds):
        """A value that comes to be within this time, or nothing."""
        try:
            self.page.wait_for_function(what, timeout=milliseconds)
        except TimeoutError:
            return None
        return self.page.evaluate(what)

    def pixels(self):
        self.page.wait_for_timeout(500)
        return self.page.locator("#stage").screenshot()

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


def click_a_node(page):
    """Clicks into the view until a node is picked; returns its number."""
    # plotly looks what is under the mouse when it draws, which takes its time without a graphics card
    box = page.page.locator("#stage").bounding_box()
    places = [(0.1 + 0.075 * i, 0.25 + 0.07 * j) for i in range(9) for j in range(8)]
    for x, y in sorted(places, key=lambda place: abs(place[0] - 0.42) + abs(place[1] - 0.55))[::2]:
        at = (box["x"] + x * box["width"], box["y"] + y * box["height"])
        page.page.mouse.move(*at)
        page.page.wait_for_timeout(300)
        page.page.mouse.move(at[0] + 1, at[1])
        page.page.wait_for_timeout(300)
        page.page.mouse.down()
        picked = page.within("document.getElementById('picked').dataset.node", 2_500)
        page.page.mouse.up()
        if picked:
            return int(picked)
    raise AssertionError("no click has picked a node")


def values_agree(page, folder):
    """The values of the picked node are those of the .vtu files; returns how many there are."""
    place, number = page.page.evaluate("(d => [Number(d.node), Number(d.frame)])(document.getElementById('picked').dataset)")
    shown = page.page.evaluate("[...document.querySelectorAll('#picked td')].map(c => [c.dataset.field, Number(c.dataset.value)])")
    volume, contact = (arrays(folder / f"frames/{kind}_{number:04}.vtu") if (folder / f"frames/{kind}_{number:04}.vtu").exists() else {}
                       for kind in ("volume", "contact"))
    count = 0
    for field, value in shown:
        name, _, component = field.partition(".")
        if name == "Points":
            continue
        grid = contact if name in contact and name.startswith("contact_") else volume
        names, values = grid[name]
        points = [k for k, label in enumerate(grid["node_id"][1]) if label == place]
        at = names.index(component) if component else 0
        wanted = [values[point * len(names) + at] for point in points]
        largest = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
        near = [w for w in wanted if abs(w - value) <= TOLERANCE * max(abs(w), 1e-3 * largest)]
        check(near, f"node {place}, {field}: {value} is shown, {wanted} is in the file")
        count += 1
    return count


def examine(browser, name, folder, keep):
    page = Page(browser, folder / "report.html")
    ncell = numbers_agree(page, folder)
    check(ncell > 15, f"only {ncell} numbers have a source")
    page.page.locator("#stage").scroll_into_view_if_needed()
    last = int(page.page.evaluate("document.getElementById('frame').max"))
    start = page.pixels()
    other = page.frame(0)
    check(start != other, "the view does not change with the frame")
    check(page.frame(last) != other, "the view does not change back with the frame")
    fields = page.page.evaluate("[...document.getElementById('field').options].map(o => o.value)")
    second = next(field for field in ["contact_pressure|-1", "displacement|-1"] if field in fields)
    check(page.field(second) != start, "the view does not change with the field")
    if keep:
        page.page.locator("#view").screenshot(path=str(keep / f"{name}-contact.png"))
    page.field(fields[0])
    click_a_node(page)
    nvalue = values_agree(page, folder)
    check(nvalue > 3, f"only {nvalue} values of the node are shown")
    if keep:
        page.page.locator("#view").screenshot(path=str(keep / f"{name}-view.png"))
        page.page.evaluate("scrollTo(0, 0)")
        page.page.screenshot(path=str(keep / f"{name}.png"), full_page=True)
        page.page.pdf(path=str(keep / f"{name}.pdf"), prefer_css_page_size=True)
    check(not page.wrong, "; ".join(page.wrong))
    page.page.close()
    return ncell, nvalue


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
            folder = Path(scratch) / name
            sets = [word for change in changes for word in ("--set", change)]
            command = [options.signorini, "run", str(ROOT / "examples" / example / "case.toml"), "-o", str(folder), "-q", "--report", *sets]
            done = subprocess.run(command, capture_output=True, text=True)
            try:
                check(done.returncode == code, f"exit code {done.returncode}, not {code}: {done.stderr}")
                ncell, nvalue = examine(browser, name, folder, options.keep)
                size = (folder / "report.html").stat().st_size
                print(f"{name}: {ncell} numbers of tables, {nvalue} values of a node, {size / 1e6:.1f} MB")
                passed += 1
            except AssertionError as error:
                print(f"{name}: FAILED: {error}")
        browser.close()
    print(f"report: {passed} passed")
    return 0 if passed == len(CASES) else 1


if __name__ == "__main__":
    sys.exit(main())
