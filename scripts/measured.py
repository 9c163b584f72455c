#!/usr/bin/env python3
"""Run a program, and write down what it took.

    python -S -E scripts/measured.py SECONDS REPORT PROGRAM ARGUMENT ...

REPORT becomes a line of JSON: the exit code (null where the program was stopped after SECONDS, negative where a signal
ended it), seconds by the clock and of processors, and the most memory it held, in bytes.

This is a program of its own because it is small: the peak of a process counts that of its parent at the time it was
started, and whoever asks may just have read a large file.

Only what comes with Python is used. Exit code: 0; 2 where the program cannot be started.
"""

import json
import os
import signal
import sys
import time

# of ru_maxrss: bytes on macOS, thousands of them elsewhere
UNIT = 1 if sys.platform == "darwin" else 1024


def measure(command, seconds):
    """Runs a command for so many seconds at most."""
    late = []

    def stop(_signal, _frame):
        late.append(True)
        os.killpg(child, signal.SIGKILL)

    began = time.monotonic()
    child = os.posix_spawnp(command[0], command, os.environ, setpgroup=0)
    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        _, status, usage = os.wait4(child, 0)
    except KeyboardInterrupt:
        os.killpg(child, signal.SIGKILL)
        raise
    wall = time.monotonic() - began
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    return {
        "code": None if late else os.waitstatus_to_exitcode(status),
        "wall": wall,
        "processors": usage.ru_utime + usage.ru_stime,
        "memory": usage.ru_maxrss * UNIT,
    }


def main():
    seconds, report, *command = sys.argv[1:]
    try:
        found = measure(command, float(seconds))
    except OSError as error:
        print(f"error: {command[0]}: {error.strerror}", file=sys.stderr)
        return 2
    with open(report, "w", encoding="ascii") as file:
        json.dump(found, file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
