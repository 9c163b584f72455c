"""What the scripts that run decks share: to read decks, to run programs on them, to read what these leave."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

MEASURED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "measured.py")


# of ranks with one thread each, as root, on a machine with fewer cores than ranks
RANKS_ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    # in containers, a process may not read the memory of another one
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    # ranks that wait let others work
    "OMPI_MCA_mpi_yield_when_idle": "1",
}


def keywords(text):
    """The keywords of a deck, without blanks, in capitals, without their parameters."""
    lines = (line.strip() for line in text.splitlines())
    cards = (line for line in lines if line.startswith("*") and not line.startswith("**"))
    return [re.sub(r"\s", "", card[1:].split(",")[0]).upper() for card in cards]


def cards(text):
    """Keyword lines with their data lines, comments left out."""
    found = []
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            found.append((line, []))
        elif found:
            found[-1][1].append(line)
    return found


def fields(lines):
    return [field.strip() for line in lines for field in line.split(",") if field.strip()]


def parameter(card, name):
    match = re.search(rf"{name}\s*=\s*([^,\s]+)", card, re.IGNORECASE)
    return match.group(1).upper() if match else None


def environment(threads):
    """That of a program with so many threads."""
    return {**os.environ, "OMP_NUM_THREADS": str(threads), "CCX_NPROC_EQUATION_SOLVER": str(threads)}


def run(command, folder, timeout):
    """Exit code (None: out of time), output, seconds; with one thread."""
    began = time.monotonic()
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=environment(1),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=timeout,
        )
        code, said = done.returncode, done.stdout.decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        code, said = None, ""
    return code, said, time.monotonic() - began


@dataclass
class Cost:
    """What a program took: seconds by the clock and of processors, and the most memory it held, in bytes."""

    wall: float
    processors: float
    memory: int


def measured(command, folder, timeout, threads):
    """Exit code (None: out of time), what the program said, and its cost."""
    with tempfile.TemporaryDirectory() as scratch:
        report, output = os.path.join(scratch, "report"), os.path.join(scratch, "output")
        own = [sys.executable, "-S", "-E", MEASURED, str(timeout), report]
        with open(output, "wb") as file:
            subprocess.run(
                [*own, *command],
                cwd=folder,
                env=environment(threads),
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                check=True,
            )
        found = json.loads(pathlib.Path(report).read_text(encoding="ascii"))
        said = pathlib.Path(output).read_text(encoding="utf-8", errors="replace")
    return found["code"], said, Cost(found["wall"], found["processors"], found["memory"])


def events(said):
    """The lines of JSON in an output."""
    found = []
    for line in said.splitlines():
        try:
            event = json.loads(line)
        except json.JSONDecodeError:
            continue
        if isinstance(event, dict):
            found.append(event)
    return found


def version(ccx):
    """What ccx calls itself, as in 2.20."""
    _, said, _ = run([ccx, "-v"], ".", 60.0)
    words = said.split()
    return words[-1] if words else "of an unknown version"


def iterations_of_ccx(folder, deck):
    """The sum over the column ITRS of a .sta file."""
    try:
        lines = pathlib.Path(folder, f"{deck}.sta").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return None
    rows = [line.split() for line in lines[2:]]
    counts = [int(row[3]) for row in rows if len(row) == 7 and row[3].isdigit()]
    return sum(counts) if counts else None


def iterations_of_ours(results):
    try:
        with open(os.path.join(results, "summary.json"), encoding="utf-8") as file:
            return sum(step["iterations"] for step in json.load(file)["steps"])
    except (OSError, ValueError, KeyError):
        return None
