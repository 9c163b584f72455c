"""The command `signorini`, as the wheel installs it."""

from __future__ import annotations

import sys


def main() -> None:
    """Runs the command with the arguments of the process."""
    from . import _native

    sys.exit(_native.main(sys.argv[1:]))
