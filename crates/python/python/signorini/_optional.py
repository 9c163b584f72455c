"""Packages that are imported only where they are needed."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from typing import Any

EXTRAS = {"pyvista": "signorini[viz]"}


def need(package: str, purpose: str) -> Any:
    """The package, or an error that says how to install it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        if error.name is not None and error.name.partition(".")[0] != package:
            raise
        install = EXTRAS.get(package, package)
        raise ImportError(f'{purpose} needs {package}: pip install "{install}"', name=package) from error


def has(package: str) -> bool:
    """Whether a package can be imported."""
    try:
        return importlib.util.find_spec(package) is not None
    except (ImportError, ValueError):
        return False


def off_screen() -> bool | None:
    """Whether pictures are drawn without a window: where there is no display; elsewhere (None) as PyVista is set."""
    no_display = not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return True if sys.platform.startswith("linux") and no_display else None
