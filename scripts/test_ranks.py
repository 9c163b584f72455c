#!/usr/bin/env python3
"""Runs of several processes, started by `mpirun`, against runs of one.

    python scripts/test_ranks.py --signorini BINARY [NAME ...]

BINARY is built with `--features mpi`, and `mpirun` is that of OpenMPI. Small cases of examples/ run on 1, 2 and 4 ranks:
results are those of one process, files and messages come from rank 0 alone, and faults, requests to stop and dead ranks
end all of them. NAMEs choose tests. The last line says how many have passed.
"""

import argparse
import csv
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback

from jobs import RANKS_ENVIRONMENT

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(HERE, "..", "examples")
# Seconds until a run counts as stuck.
PATIENCE = 600
# Seconds in which all ranks end where one is killed.
DEATH = 10


class Bench:
    """Where runs are made: a program, and a folder for everything that it leaves."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder
        self.made = 0
        self.alone = {}
        # of mpirun
        self.options = []

    def place(self):
        """The path of a folder that is not there yet."""
        self.made += 1
        return os.path.join(self.folder, f"{self.made}.out")

    def command(self, ranks, *arguments, first=None, second=None):
        """The command line: shell commands `first` on rank 0, and `second` on rank 1, come before the program."""
        own = [self.program, *arguments]
        if first or second:
            script = f'case "${{OMPI_COMM_WORLD_RANK:-0}}" in 0) {first or ":"};; 1) {second or ":"};; esac; exec "$@"'
            own = ["bash", "-c", script, "bash", *own]
        if ranks == 0:
            return own
        return ["mpirun", "--oversubscribe", *self.options, "-n", str(ranks), *own]

    def start(self, ranks, *arguments, **more):
        return subprocess.Popen(
            self.command(ranks, *arguments, **more),
            env={**os.environ, **RANKS_ENVIRONMENT},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, ranks, *arguments, **more):
        """Exit code, standard output and standard error; no ranks: the program without mpirun."""
        process = self.start(ranks, *arguments, **more)
        out, error = process.communicate(timeout=PATIENCE)
        return process.returncode, out, error

    def of_one(self, name, *more):
        """The results of one process, made once."""
        if (name, more) not in self.alone:
            place = self.place()
            code, _, said = self.run(0, *solve(name, place, *more))
            assert code == 0, said
            self.alone[name, more] = place
        return self.alone[name, more]


def solve(name, place, *more):
    case = os.path.join(EXAMPLES, name, "case.toml")
    return ["run", case, "-o", place, "--threads", "1", "--no-progress", *more]


def rows(place, name):
    with open(os.path.join(place, name), newline="") as file:
        return list(csv.reader(file))


def files(place):
    """All files in a folder, relative to it."""
    found = []
    for folder, _, names in os.walk(place):
        found += [os.path.relpath(os.path.join(folder, name), place) for name in names]
    return sorted(found)


def events(place, kind):
    try:
        with open(os.path.join(place, "events.jsonl")) as file:
            lines = file.read().splitlines()
    except FileNotFoundError:
        return []
    found = []
    for line in lines:
        try:
            event = json.loads(line)
        except ValueError:
            continue
        if event["ev"] == kind:
            found.append(event)
    return found


def summary(place):
    with open(os.path.join(place, "summary.json")) as file:
        return json.load(file)


def check_same(bench, place, reference):
    code, said, error = bench.run(0, "diff", place, reference, "--rel", "1e-9")
    assert code == 0, said + error
    head = [row[1:4] for row in rows(place, "history.csv")]
    assert head == [row[1:4] for row in rows(reference, "history.csv")], head
    assert files(place) == files(reference), files(place)


def until(condition, process, what):
    """Waits until something holds while a process goes on."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert process.poll() is None, f"the run has ended before {what}: {process.communicate()}"
        assert time.monotonic() < end, f"no {what} in {PATIENCE} s"
        time.sleep(0.005)


def process_of(mpirun, rank):
    """The number of the process that is a rank."""
    for number in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{number}/stat") as file:
                parent = int(file.read().rpartition(")")[2].split()[1])
            with open(f"/proc/{number}/environ") as file:
                variables = file.read().split("\0")
        except OSError:
            continue
        if parent == mpirun and f"OMPI_COMM_WORLD_RANK={rank}" in variables:
            return int(number)
    raise AssertionError(f"no process is rank {rank}")


# A run that is interrupted, with a checkpoint after every increment.
LONG = "friction_loop_3d_node_to_segment"
SAVED = ("--set", "checkpoint.every.increments=1")


def interrupted(bench, ranks, interrupt, *more):
    """A run that is interrupted behind its third checkpoint: its folder, exit code, what it said, and how long it went on."""
    place = bench.place()
    process = bench.start(ranks, *solve(LONG, place, *SAVED, *more))
    until(lambda: len(events(place, "checkpoint")) > 2, process, "its third checkpoint")
    interrupt(process.pid)
    begin = time.monotonic()
    out, error = process.communicate(timeout=PATIENCE)
    return place, process.returncode, out + error, time.monotonic() - begin


def check_resumed(bench, place, ranks):
    done = len(rows(place, "history.csv"))
    reference = bench.of_one(LONG, *SAVED)
    assert done < len(rows(reference, "history.csv")), "the run was not interrupted"
    code, _, said = bench.run(ranks, "resume", place, "--threads", "1", "--no-progress")
    assert code == 0, said
    check_same(bench, place, reference)


def results_are_those_of_one_process(bench):
    counts = {"two_blocks_2d": [1, 2, 4], "trusses_2d_node_to_node": [1, 2, 4], LONG: [2]}
    for name, all_ranks in counts.items():
        for ranks in all_ranks:
            place = bench.place()
            code, _, said = bench.run(ranks, *solve(name, place))
            assert code == 0, said
            check_same(bench, place, bench.of_one(name))
            assert summary(place).get("ranks", {"count": 1})["count"] == ranks
            assert len(events(place, "start")) == len(events(place, "end")) == 1
            assert said.count("solved:") == 1, said
            assert not [name for name in files(place) if name.endswith(".tmp")]
            wanted = f"{ranks} ranks of 1 thread" if ranks > 1 else "·  1 thread"
            assert said.count(wanted) == 1, said


def only_rank_0_says_events(bench):
    code, out, _ = bench.run(2, *solve("trusses_2d_node_to_node", bench.place(), "--json"))
    assert code == 0
    kinds = [json.loads(line)["ev"] for line in out.splitlines()]
    assert kinds.count("start") == kinds.count("end") == 1, kinds
    alone, out, _ = bench.run(0, *solve("trusses_2d_node_to_node", bench.place(), "--json"))
    assert alone == 0 and kinds == [json.loads(line)["ev"] for line in out.splitlines()]


def a_check_says_how_many_ranks_there_are(bench):
    case = os.path.join(EXAMPLES, "two_blocks_2d", "case.toml")
    place = bench.place()
    code, out, said = bench.run(2, "check", case, "-o", place)
    assert code == 0, said
    assert out.count("2 ranks") == out.count("nothing wrong was found") == 1, out
    assert files(place) == ["check.vtu"]
    code, out, said = bench.run(2, "check", case, "--json")
    assert code == 0 and json.loads(out)["ranks"] == 2, out + said


def refused_input_gives_one_message_and_exit_code_3(bench):
    for ranks in [0, 1, 4]:
        wrong = ["--set", "material.foot.E=-1"]
        code, _, said = bench.run(ranks, *solve("two_blocks_2d", bench.place(), *wrong))
        assert code == 3 and said.count("error[") == 1, (code, said)
        code, _, said = bench.run(ranks, "run", os.path.join(bench.folder, "nowhere.toml"))
        assert code == 3 and said.count("error[") == 1, (code, said)


def a_rank_that_cannot_read_says_so_and_ends_all(bench):
    case = os.path.join(bench.folder, "own.toml")
    shutil.copy(os.path.join(EXAMPLES, "two_blocks_2d", "case.toml"), case)
    place = bench.place()
    second = f'set -- "$1" run {case}.gone -o {place}'
    code, _, said = bench.run(3, "run", case, "-o", place, second=second)
    assert code == 3, (code, said)
    assert "stopped on rank 1 of 3" in said and "rank 1 has failed" in said, said
    assert not os.path.exists(place)


def ranks_that_read_other_cases_do_not_begin(bench):
    place = bench.place()
    other = solve("two_blocks_2d", place, "--set", "title=another")
    second = " ".join(["set --", '"$1"', *solve("two_blocks_2d", place)])
    code, _, said = bench.run(2, *other, second=second)
    assert code == 70 and said.count("of rank 1 is not that of rank 0") == 1, (code, said)
    assert not os.path.exists(place)


def a_full_disk_of_rank_0_ends_all_with_exit_code_6(bench):
    for ranks in [0, 4]:
        place = bench.place()
        process = bench.start(ranks, *solve(LONG, place), first="trap '' XFSZ")
        until(lambda: len(events(place, "increment")) > 2, process, "its third increment")
        number = process_of(process.pid, 0) if ranks else process.pid
        # no file may grow any more; MPI has made its own
        resource.prlimit(number, resource.RLIMIT_FSIZE, (1024, 1024))
        _, said = process.communicate(timeout=PATIENCE)
        assert process.returncode == 6 and said.count("error[S0601]") == 1, (ranks, said)


def a_folder_that_is_held_is_refused_once(bench):
    place = bench.place()
    process = bench.start(0, *solve(LONG, place))
    until(lambda: events(place, "start"), process, "its start")
    # it holds the folder until it is killed
    process.send_signal(signal.SIGSTOP)
    code, _, said = bench.run(2, *solve(LONG, place))
    process.kill()
    process.communicate()
    assert code == 6 and said.count("held by another run") == 1, (code, said)


def the_time_limit_stops_all(bench):
    place = bench.place()
    code, _, said = bench.run(3, *solve(LONG, place, "--max-wall", "0.05s", *SAVED))
    assert code == 8, (code, said)
    assert summary(place)["status"] == "time limit reached"
    check_resumed(bench, place, 2)


def a_request_to_mpirun_stops_all(bench):
    # mpirun waits so long before it passes the signal on, and again before it kills: the run must be going on then
    bench.options = ["--mca", "odls_base_sigkill_timeout", "3"]
    many = ["--set", "step.drag.increments.fixed=3000"]
    place, code, said, _ = interrupted(bench, 3, lambda mpirun: os.kill(mpirun, signal.SIGTERM), *many)
    bench.options = []
    # mpirun has an exit code of its own
    assert code != 0 and said.count("stopping after") == 1, (code, said)
    end = summary(place)
    assert (end["exit_code"], end["status"]) == (143, "interrupted"), said
    assert bench.run(0, "status", place)[1].startswith("interrupted (exit code 143)")


def a_request_to_one_rank_stops_all(bench):
    def interrupt(mpirun):
        os.kill(process_of(mpirun, 1), signal.SIGTERM)

    place, code, said, _ = interrupted(bench, 2, interrupt)
    assert code == 143, (code, said)
    end = summary(place)
    assert (end["exit_code"], end["status"]) == (143, "interrupted"), said
    check_resumed(bench, place, 0)


def a_dead_rank_ends_all_and_others_go_on(bench):
    def interrupt(mpirun):
        os.kill(process_of(mpirun, 1), signal.SIGKILL)

    place, code, said, seconds = interrupted(bench, 4, interrupt)
    assert code != 0 and seconds < DEATH, (code, seconds, said)
    assert not os.path.exists(os.path.join(place, "summary.json"))
    torn = bench.place()
    shutil.copytree(place, torn)
    check_resumed(bench, place, 2)
    for name in ["a.sgc", "b.sgc"]:
        os.truncate(os.path.join(torn, "checkpoint", name), 100)
    code, _, said = bench.run(2, "resume", torn)
    assert code == 7 and said.count("error[S0701]") == 1, (code, said)


TESTS = [
    results_are_those_of_one_process,
    only_rank_0_says_events,
    a_check_says_how_many_ranks_there_are,
    refused_input_gives_one_message_and_exit_code_3,
    a_rank_that_cannot_read_says_so_and_ends_all,
    ranks_that_read_other_cases_do_not_begin,
    a_full_disk_of_rank_0_ends_all_with_exit_code_6,
    a_folder_that_is_held_is_refused_once,
    the_time_limit_stops_all,
    a_request_to_mpirun_stops_all,
    a_request_to_one_rank_stops_all,
    a_dead_rank_ends_all_and_others_go_on,
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--signorini", required=True, help="the program, built with --features mpi")
    parser.add_argument("tests", nargs="*", metavar="NAME", help="tests to run; all by default")
    options = parser.parse_args()
    chosen = [test for test in TESTS if not options.tests or test.__name__ in options.tests]
    failed = 0
    with tempfile.TemporaryDirectory(prefix="signorini-ranks-") as folder:
        bench = Bench(os.path.abspath(options.signorini), folder)
        for test in chosen:
            begin = time.monotonic()
            try:
                test(bench)
                verdict = "ok"
            except Exception:
                failed += 1
                traceback.print_exc()
                verdict = "FAILED"
            print(f"{test.__name__}: {verdict} ({time.monotonic() - begin:.1f} s)", flush=True)
    print(f"ranks: {len(chosen) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
