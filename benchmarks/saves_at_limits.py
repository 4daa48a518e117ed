"""Saving at 17 limits a format: a refusal that names the target, and the old file as it was.

    python benchmarks/saves_at_limits.py [--json outputs/saves_at_limits.json]

Every file that surfmesh writes is written over an old one while the operating system allows so
many bytes a file (RLIMIT_FSIZE), from none to all but one, and on a file system of so much room
where one may be mounted. A save is broken when it ends in anything but one line that begins with
the target, when the old file is not as it was, when something else stays in the folder, or when
the process dies. This needs a system with ``resource``, thus not Windows.
"""

import argparse
import json
import sys
from pathlib import Path

import child_process
from rich.box import SIMPLE_HEAD
from rich.table import Table
from saves import LIMITS
from tables import console, note


def saves_at_limits() -> list[dict]:
    """A row for each output: ``what``, ``bytes``, ``tried``, ``refused``, ``saved`` (a compressed
    file that fits), ``broken`` and ``how`` each of these was. Processes that die count too."""
    rows: dict[str, dict] = {}
    while True:
        found = child_process.run("saves.py", {"from": len(rows)}, timeout=600.0)
        at, error = found.pop("_at", None), found.pop("error", None)
        found.pop("ended", None)
        rows.update(found)
        if error is None:
            return [{"what": name, **row} for name, row in rows.items()]
        if at is None or at in rows:
            raise RuntimeError(f"the saves could not be tried: {error}")
        rows[at] = {"bytes": 0, "tried": LIMITS, "refused": 0, "saved": 0, "broken": LIMITS,
                    "how": [error]}  # fmt: skip


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE", help="write the rows too")
    options = parser.parse_args()
    rows = saves_at_limits()
    names = ("what", "bytes", "tried", "refused", "saved", "broken")
    table = Table(box=SIMPLE_HEAD, padding=(0, 1))
    for name in names:
        table.add_column(name, justify="left" if name == "what" else "right")
    for row in rows:
        table.add_row(*(f"{row[name]:,}" if name != "what" else row[name] for name in names))
    console.print(table)
    for row in rows:
        for fault in row["how"][:3]:
            note(f"{row['what']}: {fault}")
    if any(row["tried"] == LIMITS for row in rows if not row["broken"]):
        note("no file system of its own may be mounted here: limits of file sizes alone")
    broken = sum(row["broken"] for row in rows)
    note(f"{len(rows)} outputs, {sum(row['tried'] for row in rows)} saves, broken {broken}")
    if options.json:
        Path(options.json).write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
