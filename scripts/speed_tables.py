"""The tables of compare_speed.py: costs, errors and forces of both programs."""

import datetime
import json
import math
import os
import pathlib
import platform
import re
from dataclasses import asdict

import numpy as np

from jobs import run

# the exponent is that of decks from so many unknowns on, which take one increment
LARGE = 50_000
# rows with a ratio of processor seconds below this are listed
SLOW = 2.0
NOTHING = "–"


def mean(values):
    """The geometric mean of those that there are."""
    some = [value for value in values if value is not None]
    return math.exp(sum(map(math.log, some)) / len(some)) if some else None


def wall(cost):
    return cost.wall


def processors(cost):
    return cost.processors


def memory(cost):
    return cost.memory


def sizes(outcomes, whose):
    """Unknowns and costs of the rows that the exponents are those of."""
    found = {}
    for outcome in outcomes:
        row, solution = outcome.row, whose(outcome)
        is_meant = row.kind == "hertz" and row.element == "C3D8" and row.dof >= LARGE and row.is_one_increment
        if is_meant and solution is not None and solution.cost is not None:
            found[outcome.dof] = solution.cost
    return found


def exponents(found):
    """How costs grow with the unknowns; none where there are not two sizes."""
    if len(found) < 2:
        return None
    slopes = {
        name: float(np.polyfit(np.log(list(found)), np.log([of(cost) for cost in found.values()]), 1)[0])
        for name, of in (("wall", wall), ("processors", processors), ("memory", memory))
    }
    return {"from": min(found), "to": max(found), **slopes}


def number(value, form):
    return NOTHING if value is None else format(value, form)


def both(outcome, of):
    """A text of ccx and of signorini, where they have one."""
    return [of(one) if one is not None and one.cost is not None else NOTHING for one in (outcome.ccx, outcome.ours)]


def counts(outcome, of):
    """A number of ccx and of signorini in one cell."""
    return " / ".join(both(outcome, lambda one: number(of(one), "d")))


def cost_cells(outcome, of, form):
    return [*both(outcome, lambda one: form(of(one.cost))), number(outcome.ratio(of), ".2f")]


def table(headings, rows):
    lines = [headings, ["---"] * len(headings), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def speeds(outcomes):
    """Seconds, memory and iterations of all rows."""
    headings = ["row", "unknowns", "increments", "iterations"]
    for what in ("seconds", "processor seconds", "MB"):
        headings += [f"{what}: ccx", "ours", "ratio"]
    rows = []
    for one in outcomes:
        cells = [one.row.name, str(one.dof), counts(one, lambda s: s.increments), counts(one, lambda s: s.iterations)]
        for of in (wall, processors):
            cells += cost_cells(one, of, lambda seconds: f"{seconds:.2f}")
        cells += cost_cells(one, memory, lambda size: f"{size / 1e6:.0f}")
        rows.append([*cells, one.ccx.solver.lower() if one.ccx and one.ccx.cost else NOTHING])
    return table([*headings, "solver of ccx"], rows)


def accuracies(outcomes):
    """Errors of all rows."""
    headings = ["row", "tolerance of forces: ccx", "ours", "p0 fitted: ccx", "ours", "largest pressure: ccx", "ours"]
    headings += ["in the centre: ccx", "ours", "rms: ccx", "ours"]
    headings += ["friction along the surface: ccx", "ours", "along the axes: ccx", "ours"]
    rows = []
    for one in outcomes:
        cells = [one.row.name, *both(one, lambda s: number(s.tolerance, ".0e"))]
        signed = ("fitted", "largest", "centre")
        forms = {**dict.fromkeys(signed, "+.2%"), "rms": ".2%", "friction": "+.4%", "axes": "+.4%"}
        for key, form in forms.items():
            cells += both(one, lambda s, key=key, form=form: number(s.errors.get(key), form))
        rows.append(cells)
    return table(headings, rows)


def phases(outcomes):
    """Where signorini's seconds go."""
    solved = [one for one in outcomes if one.ours.phases]
    sums = {}
    for one in solved:
        for name, seconds in one.ours.phases.items():
            sums[name] = sums.get(name, 0.0) + seconds
    names = sorted(sums, key=sums.get, reverse=True)
    rows = [[one.row.name, *(number(one.ours.phases.get(name), ".2f") for name in names)] for one in solved]
    return table(["row", *names], rows)


def sums(outcomes):
    """What all rows together say: means of ratios, and exponents."""
    return {
        "ratios": {
            name: mean(one.ratio(of) for one in outcomes)
            for name, of in (("wall", wall), ("processors", processors), ("memory", memory))
        },
        "exponents": {
            "ccx": exponents(sizes(outcomes, lambda one: one.ccx)),
            "signorini": exponents(sizes(outcomes, lambda one: one.ours)),
        },
    }


def in_words(found):
    """The sums, a line each."""
    lines, ratios = [], found["ratios"]
    if ratios["wall"] is not None:
        compared = "{wall:.2f} in seconds, {processors:.2f} in processor seconds, {memory:.2f} in memory".format(**ratios)
        lines.append(f"* Geometric means of the ratios, ccx to signorini: {compared}.")
    for whose, grown in found["exponents"].items():
        if grown is not None:
            powers = "n^{wall:.2f} in seconds, n^{processors:.2f} in processor seconds, n^{memory:.2f} in memory"
            between = "from {from:,} to {to:,} unknowns".format(**grown)
            lines.append(f"* One increment of hertz with C3D8 {between} in {whose}: {powers.format(**grown)}.")
    return lines


def remarks(outcomes):
    """What was not solved, and what other solvers of CalculiX did, a line each."""
    lines = []
    for one in outcomes:
        lines += [f"{one.row.name}: {fault}" for fault in one.faults]
        if one.others and one.ccx.cost:
            lines.append(f"{one.row.name}: CalculiX: {'; '.join(one.others)}")
        if one.row.changes:
            lines.append(f"{one.row.name}: signorini with {' '.join(f'--set {change}' for change in one.row.changes)}")
    return lines


def machine():
    """Processor, cores, memory and load, in words."""
    model = platform.processor() or platform.machine()
    try:
        info = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
        found = re.search(r"model name\s*:\s*(.+)", info)
        model = found.group(1).strip() if found else model
    except OSError:
        pass
    size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    load = os.getloadavg()[0]
    return f"{model}, {os.cpu_count()} cores, {size:.0f} GiB; load before the run {load:.1f}"


def page(outcomes, about):
    """All tables of the hertz and slide rows, with what they are about."""
    parts = ["\n".join(about), speeds(outcomes), "\n".join(in_words(sums(outcomes))), accuracies(outcomes)]
    return joined([*parts, phases(outcomes), in_list(remarks(outcomes))])


def family_page(outcomes, about):
    """All tables of the rows of the ten families, with what they are about."""
    lines = [*in_words(sums(outcomes)), *by_family(outcomes), *slow_rows(outcomes)]
    parts = ["\n".join(about), family_costs(outcomes), "\n".join(lines), family_forces(outcomes), phases(outcomes)]
    return joined([*parts, in_list(remarks(outcomes))])


def joined(parts):
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def in_list(lines):
    return "\n".join(f"* {line}" for line in lines)


def family_costs(outcomes):
    """Processor seconds, seconds, memory and iterations of the rows of the families."""
    headings = ["row", "unknowns", "increments", "iterations"]
    for what in ("processor seconds", "seconds", "MB"):
        headings += [f"{what}: CalculiX", "signorini", "ratio"]
    rows = []
    for one in outcomes:
        cells = [one.row.name, str(one.dof), counts(one, lambda s: s.increments), counts(one, lambda s: s.iterations)]
        for of in (processors, wall):
            cells += cost_cells(one, of, lambda seconds: f"{seconds:.2f}")
        cells += cost_cells(one, memory, lambda size: f"{size / 1e6:.0f}")
        solver = f"{one.ccx.solver.lower()} {one.ccx.version}" if one.ccx and one.ccx.cost else NOTHING
        rows.append([*cells, solver])
    return table([*headings, "CalculiX' solver"], rows)


def family_forces(outcomes):
    """How far the forces of both programs differ, and how well those of signorini balance."""
    rows = []
    for one in outcomes:
        balance = number(one.imbalance, ".0e")
        rows.append([one.row.name, number(one.difference, ".2%"), format(one.row.tolerance, ".0%"), balance, verdict(one)])
    return table(["row", "difference of forces", "tolerance", "imbalance of signorini", "solved"], rows)


def verdict(outcome):
    if outcome.faults:
        return "**NO**"
    return "yes" if outcome.difference is not None else "not compared"


def by_family(outcomes):
    """The mean ratio of each family, in a line."""
    found = {}
    for one in outcomes:
        found.setdefault(one.row.kind, []).append(one.ratio(processors))
    means = {family: mean(ratios) for family, ratios in found.items()}
    words = [f"{family} {value:.1f}" for family, value in means.items() if value is not None]
    return [f"* Geometric means of the ratios in processor seconds, by family: {', '.join(words)}."] if words else []


def slow_rows(outcomes):
    """The rows where signorini is not much faster, in a line."""
    compared = [(one, one.ratio(processors)) for one in outcomes if one.ratio(processors) is not None]
    if not compared:
        return []
    slow = [f"{one.row.name} ({ratio:.2f})" for one, ratio in compared if ratio < SLOW]
    return [f"* Rows with a ratio below {SLOW:g} in processor seconds: {', '.join(slow) or 'none'}."]


def between_markers(text, new, markers):
    """A page with something new between two markers; none where it does not have them."""
    first, last = markers
    before, begin, rest = text.partition(first)
    _, end, after = rest.partition(last)
    return f"{before}{begin}\n{new}{end}{after}" if begin and end else None


def record(outcomes, about):
    rows = [{"name": one.row.name, **asdict(one)} for one in outcomes]
    return json.dumps({"about": about, "sums": sums(outcomes), "rows": rows}, indent=1) + "\n"


def in_short(outcome):
    """A line of a row while others still run."""
    solutions = [("CalculiX", outcome.ccx), ("signorini", outcome.ours)]
    parts = []
    for name, one in solutions:
        if one is not None and one.cost:
            parts.append(f"{name} {one.cost.processors:.2f} CPU s, {one.cost.wall:.2f} s")
    ratio = outcome.ratio(processors)
    parts += [f"ratio {ratio:.2f} in CPU s"] if ratio else []
    parts += [f"forces differ by {outcome.difference:.2%}"] if outcome.difference is not None else []
    return "\n".join([f"{outcome.row.name}: {', '.join(parts) or 'no results'}", *(f"  {fault}" for fault in outcome.faults)])


def about(args, programs):
    """Date, machine, programs, command line."""
    _, ours, _ = run([args.signorini, "--version"], ".", 60.0)
    threads = f"{args.threads} thread{'' if args.threads == 1 else 's'}"
    best = f"the least of {args.repeat} runs" if args.repeat > 1 else "one run each"
    names = ", ".join(f"CalculiX {program.version}" for program in programs) or "no CalculiX"
    options = [f"--compat {args.compat}", *(f"--set {change}" for change in args.set)]
    when = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    line = f"{when}, {machine()}. {ours.strip()}, {names}; {threads}, {best}; signorini with `{' '.join(options)}`."
    return [line, *([args.note] if args.note else [])]
