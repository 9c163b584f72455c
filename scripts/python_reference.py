"""Writes docs/python-api.md, the reference of the Python package, from its sources.

    python scripts/python_reference.py            writes the page
    python scripts/python_reference.py --check    fails where the page is not what the sources say

Nothing is imported: signatures and docstrings are read from the text of the sources, so that neither the package nor NumPy has
to be there.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "crates/python/python/signorini"
PAGE = ROOT / "docs/python-api.md"

HEAD = """# Python: classes and functions

Everything in the package `signorini`, with its signature and docstring. [The guide to the package](python.md) explains how
they belong together, [the tutorial](tutorials/python.md) begins at the beginning. Every key of a case is an attribute of the same
name: [keys](keys.md).

Written by `python scripts/python_reference.py` from the sources of the package; a test fails where the two differ.
"""

GROUPS = [
    ("Cases", ["Case", "Step", "Preview", "load"]),
    ("Meshes", ["Mesh"]),
    ("Running", ["run_many", "Stepper"]),
    ("Results", ["Result", "Frame", "ContactFrame", "Increment", "History", "open"]),
    ("Own physics", ["ContactLaw", "FrictionLimit", "Material", "SignedDistance", "Projection"]),
    ("Exceptions", None),
    ("Materials and surfaces", None),
]


def homes() -> dict[str, list[str]]:
    """The public names of each module, as `signorini/__init__.py` has them."""
    for node in ast.parse((PACKAGE / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "_HOMES":
            return ast.literal_eval(node.value)
    raise SystemExit("signorini/__init__.py has no table _HOMES")


def definitions(module: str) -> dict[str, ast.ClassDef | ast.FunctionDef]:
    """Classes and functions at the top of a module."""
    tree = ast.parse((PACKAGE / f"{module}.py").read_text())
    return {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def signature(node: ast.FunctionDef, name: str) -> str:
    """A call as a user writes it, without `self`, with what it returns."""
    arguments = node.args
    for first in (arguments.posonlyargs, arguments.args):
        if first and first[0].arg in ("self", "cls"):
            first.pop(0)
    returns = "" if node.returns is None else f" -> {ast.unparse(node.returns)}"
    return f"{name}({ast.unparse(arguments)}){returns}"


def prose(node: ast.ClassDef | ast.FunctionDef) -> list[str]:
    """A docstring as Markdown: examples become blocks, lists of parameters lists, the rest stays text."""
    lines: list[str] = []
    block = listed = False
    source = inspect.cleandoc(ast.get_docstring(node) or "").splitlines()
    for line, below in zip(source, [*source[1:], ""], strict=True):
        is_code = line.startswith((">>>", "...")) or (block and line.strip() != "")
        if is_code != block:
            lines.append("```pycon" if is_code else "```")
            block = is_code
        if is_code:
            lines.append(line)
        elif is_underline(below):
            lines.append(f"*{line}*")
            listed = True
        elif is_underline(line):
            lines.append("")
        else:
            listed = listed and line.strip() != ""
            name, colon, text = line.partition(": ")
            is_item = listed and colon != "" and not line.startswith(" ")
            lines.append((f"* `{name}`: {text}" if is_item else line).replace("<", "\\<"))
    if block:
        lines.append("```")
    return lines


def is_underline(line: str) -> bool:
    return len(line) > 2 and set(line) == {"-"}


def is_public(node: ast.stmt) -> bool:
    return isinstance(node, ast.FunctionDef) and (not node.name.startswith("_") or node.name == "__init__")


def is_property(node: ast.FunctionDef) -> bool:
    return any(ast.unparse(decorator) in ("property", "cached_property") for decorator in node.decorator_list)


def keys_of(node: ast.ClassDef) -> list[str]:
    """Rows for attributes that are keys of a case."""
    rows: list[str] = []
    for part in node.body:
        if isinstance(part, ast.AnnAssign) and isinstance(part.value, ast.Call):
            texts = [arg.value for arg in part.value.args if isinstance(arg, ast.Constant)]
            if len(texts) >= 2 and ast.unparse(part.value.func) == "Key":
                meaning, values = (str(text).replace("|", "\\|") for text in texts[:2])
                rows.append(f"| `{ast.unparse(part.target)}` | {values} | {meaning} |")
    return ["", "| key | value | meaning |", "|---|---|---|", *rows] if rows else []


def of_class(name: str, node: ast.ClassDef) -> list[str]:
    methods = [part for part in node.body if is_public(part)]
    start = next((part for part in methods if part.name == "__init__"), None)
    lines = ["", f"### {name}", ""]
    if start is not None:
        start.returns = None
        lines += ["```text", signature(start, name), "```", ""]
    lines += prose(node)
    if start is not None and ast.get_docstring(start):
        lines += ["", *prose(start)]
    lines += keys_of(node)
    properties = [part for part in methods if is_property(part)]
    if properties:
        lines += ["", "| attribute | type | |", "|---|---|---|"]
        for part in properties:
            first = (ast.get_docstring(part) or "").split("\n\n")[0].replace("\n", " ").replace("|", "\\|")
            kind = "" if part.returns is None else f"`{ast.unparse(part.returns)}`".replace("|", "\\|")
            lines.append(f"| `{part.name}` | {kind} | {first} |")
    for part in methods:
        is_other = any("setter" in ast.unparse(d) or "overload" in ast.unparse(d) for d in part.decorator_list)
        if part is not start and part not in properties and not is_other:
            lines += ["", f"#### {name}.{part.name}", "", "```text", signature(part, part.name), "```", "", *prose(part)]
    return lines


def page() -> str:
    home = {name: module for module, names in homes().items() for name in names}
    module = {name: definitions(name) for name in set(home.values())}
    found = {name: module[where].get(name) for name, where in home.items()}
    lost = [name for name, node in found.items() if node is None]
    if lost:
        raise SystemExit(f"no source defines {', '.join(lost)}")
    named = {name for _, names in GROUPS if names for name in names}
    rest = sorted(name for name in found if name not in named)
    errors = [name for name in rest if home[name] == "errors"]
    others = [name for name in rest if home[name] != "errors"]
    lines = HEAD.splitlines()
    for title, names in GROUPS:
        lines += ["", f"## {title}"]
        for name in names or (errors if title == "Exceptions" else others):
            node = found[name]
            if isinstance(node, ast.ClassDef):
                lines += of_class(name, node)
            else:
                lines += ["", f"### {name}", "", "```text", signature(node, name), "```", "", *prose(node)]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description="Writes docs/python-api.md.")
    parser.add_argument("--check", action="store_true", help="compare instead of writing; exit code 1 where they differ")
    text = page()
    if parser.parse_args().check:
        if PAGE.read_text() != text:
            print("docs/python-api.md is out of date: python scripts/python_reference.py")
            return 1
        return 0
    PAGE.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
