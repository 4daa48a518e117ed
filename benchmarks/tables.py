"""Plain tables: a row for each figure, with what is wanted and whether it is met."""

import json
from collections.abc import Mapping
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from wanted import Wanted

MARK = {True: "[green]met[/green]", False: "[red]MISSED[/red]", None: ""}
console = Console(width=None if Console().is_terminal else 150, soft_wrap=True)


def heading(text: str) -> None:
    console.print(f"\n[bold]{escape(text)}[/bold]")


def note(text: str) -> None:
    console.print(f"  {escape(text)}")


def concluded(missed: int, results: Mapping, path: str | None) -> int:
    """The exit status of a run: 1 where figures are missed. ``results`` are kept as JSON."""
    note("every wanted figure is met" if not missed else f"{missed} wanted figures are missed")
    if path:
        Path(path).write_text(json.dumps(results, indent=2) + "\n")
        note(f"written to {path}")
    return 1 if missed else 0


def show(
    rows: Mapping[str, Wanted],
    columns: Mapping[str, Mapping],
    beside: Mapping[str, Mapping] | None = None,
) -> int:
    """Print ``rows`` of the measured ``columns``; ``beside``: more columns, which are not
    judged. Returns how many figures are missed."""
    beside = beside or {}
    table = Table(box=SIMPLE_HEAD, padding=(0, 1))
    table.add_column("")
    table.add_column("wanted", justify="right", no_wrap=True)
    for title in columns:
        table.add_column(title, justify="right", no_wrap=True)
        table.add_column("", no_wrap=True)
    for title in beside:
        table.add_column(title, justify="right", style="dim")
    missed = 0
    for key, row in rows.items():
        cells = [row.title, row.bound]
        for values in columns.values():
            value = values.get(key)
            small = values.get("triangles", row.from_triangles) < row.from_triangles
            met = None if small else row.met(value)
            missed += met is False
            cells += [row.shown(value), MARK[met]]
        cells += [row.shown(values.get(key)) for values in beside.values()]
        table.add_row(*cells)
    console.print(table)
    return missed
