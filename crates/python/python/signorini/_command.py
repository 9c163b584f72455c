"""The command `signorini`, as the wheel installs it."""

from __future__ import annotations

import sys


def main() -> None:
    """Runs the command with the words of the process; `signorini mcp` starts itself again by the first of them."""
    from . import _native

    sys.exit(_native.main(sys.argv))
