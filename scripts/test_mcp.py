"""A client of `signorini mcp` with the package mcp: a broken case is mended by its messages, run and read.

    pip install "mcp>=2"
    python scripts/test_mcp.py                        # the command signorini of the path
    python scripts/test_mcp.py target/release/signorini

Prints a line for every check; the exit code is 1 where one fails.
"""

from __future__ import annotations

import asyncio
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from mcp import ClientSession, StdioServerParameters
from mcp.client.stdio import stdio_client

HERE = Path(__file__).resolve().parent
CASE = (HERE / "../examples/paper_brick_symmetric_3d/case.toml").read_text(encoding="utf-8")
TOOLS = "check explain init list_files read_case report results run schema status write_case".split()
passed = 0


def check(what: str, holds: bool, seen: object = "") -> None:
    """Counts what holds, and ends where something does not."""
    global passed
    if not holds:
        print(f"✗ {what}\n{seen}")
        sys.exit(1)
    passed += 1
    print(f"✓ {what}")


async def call(session: ClientSession, tool: str, **arguments: object):
    """The text and the object that a tool returns; it must do its work."""
    result = await session.call_tool(tool, arguments)
    text = result.content[0].text
    check(f"{tool} does its work", not result.is_error, text)
    return text, result.structured_content


async def refused(session: ClientSession, tool: str, **arguments: object) -> str:
    """What a tool says that must refuse."""
    result = await session.call_tool(tool, arguments)
    shown = json.dumps(arguments)[:60]
    check(f"{tool} refuses {shown}", bool(result.is_error), result)
    return result.content[0].text


def mended(text: str, finding: dict) -> str | None:
    """The text with the word at the place of a message replaced by the one that it proposes."""
    remarks = " ".join([finding.get("label") or "", *finding.get("help", []), *finding.get("notes", [])])
    proposed = re.search(r"did you mean [`\"]?([\w.-]+)", remarks)
    if not proposed or "line" not in finding:
        return None
    lines = text.split("\n")
    line, column = finding["line"] - 1, finding["column"] - 1
    rest = re.sub(r"[\w-]+", proposed[1], lines[line][column:], count=1)
    lines[line] = lines[line][:column] + rest
    return "\n".join(lines)


async def mend_and_run(session: ClientSession) -> None:
    """The way of an agent from a broken case to numbers."""
    broken = CASE.replace("secondary", "secondry", 1).replace("increments", "incremnts", 1)
    text = broken
    for _ in range(8):
        _, checked = await call(session, "check", path="brick/case.toml", text=text)
        if checked["ok"]:
            break
        fixes = (mended(text, finding) for finding in checked["diagnostics"])
        text = next(fix for fix in fixes if fix)
    check("the case is mended by its messages", text == CASE and text != broken, text)
    reports: list[str] = []

    async def hear(progress: float, total: float | None, message: str | None) -> None:
        reports.append(message or "")

    result = await session.call_tool("run", {"path": "brick/case.toml", "threads": 1}, progress_callback=hear)
    ran = result.structured_content
    check("the run is solved and meets its expectations", ran["ok"] and ran["status"] == "solved", result)
    check("progress was reported", any(report.startswith("step ") for report in reports), reports)
    _, status = await call(session, "status", path=ran["output"])
    check("the run is finished", status["state"] == "finished", status)
    text, results = await call(session, "results", path=ran["output"], rows=3)
    check("results have a table, fields and a summary", results["table"]["rows"] and results["fields"], text)
    check("the summary is that of the run", results["summary"] == ran["summary"], results["summary"])
    result = await session.call_tool("report", {"path": ran["output"]})
    if result.is_error and "unrecognized subcommand" in result.content[0].text:
        print("- skipped: this signorini has no report")
    else:
        page = Path(result.structured_content["absolute_path"])
        check("the report is there", page.is_file() and page.stat().st_size > 1000, result)


async def stay_inside(session: ClientSession, outside: Path) -> None:
    """What is refused."""
    for path in ["../secret.toml", str(outside), "/etc/passwd", "a/../../secret.toml", ".ssh/config.toml"]:
        for tool in ["check", "run", "read_case", "results", "status"]:
            await refused(session, tool, path=path)
        await refused(session, "write_case", path=path, text="x")
    await refused(session, "write_case", path="big.toml", text="x" * (1 << 21))
    text = f'[mesh]\nfile = "{outside}"\n'
    text += '[material.a]\nmodel = "linear-elastic"\nE = 1.0\nnu = 0.3\n[[body]]\ngroup = "b"\nmaterial = "a"\n'
    text += '[[step]]\nname = "s"\n'
    said, checked = await call(session, "check", path="outside.toml", text=text)
    check("a mesh outside is refused", not checked["ok"] and "is outside of" in said, said)
    try:
        await session.call_tool("write_case", {"path": "big.toml", "text": "x" * (8 << 20)})
        check("a request of 8 MB is refused", False)
    except Exception as error:  # the library raises an error of its own for every protocol error
        check("a request of 8 MB is refused", "longer than" in str(error), error)


async def main(command: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        root, outside = Path(folder, "root"), Path(folder, "secret.toml")
        root.mkdir()
        outside.write_text("secret", encoding="utf-8")
        server = StdioServerParameters(command=command, args=["mcp", "--root", str(root)])
        async with stdio_client(server) as streams, ClientSession(*streams) as session:
            hello = await session.initialize()
            check("the server says how it is used", "`check`" in (hello.instructions or ""), hello)
            listed = await session.list_tools()
            check("all tools are listed", sorted(tool.name for tool in listed.tools) == TOOLS, listed)
            await mend_and_run(session)
            await stay_inside(session, outside)
            both = [session.call_tool("explain", {"what": code}) for code in ["S0102", "S0501"]]
            answers = await asyncio.gather(*both)
            check("calls at once are answered", not any(answer.is_error for answer in answers), answers)
    junk = "no json\n{}\n[]\n" + "x" * 10_000_000 + "\n"
    ended = subprocess.run([command, "mcp"], input=junk, capture_output=True, text=True, timeout=60)
    check("junk ends no server but by its end", ended.returncode == 0, ended.stderr)
    print(f"{passed} passed, 0 failed")


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1] if len(sys.argv) > 1 else "signorini"))
