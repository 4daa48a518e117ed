"""The report of ``check`` as sections of an HTML page, whatever fields it has."""

from collections.abc import Mapping
from html import escape
from typing import Any

import numpy as np

from surfmesh.quality import Report
from surfmesh.quality.measures.shape import shapes
from surfmesh.quality.text.summary import ROUNDING
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.colouring import Colouring
from surfmesh.view.histogram import histogram
from surfmesh.view.lines import worst_triangles
from surfmesh.view.page_data import MARKED

SHOWN_ROWS = 500  # of a table within the report; the JSON has them all
ALL_DIGITS = 9  # where every figure is listed
FEW_DIGITS = 7  # where two stand side by side
DOUBLE_DIGITS = 17  # where they differ
_SAID = ("problems", "warnings", "options")  # have places of their own
_NOT_KEPT = ("seconds",)  # differ every time, where the same mesh is to give the same page
_FIGURES = (  # title, fields, how they are said; a row whose first field is not known is left out
    ("topology", ("closed", "manifold", "oriented"), "closed {}, manifold {}, oriented {}"),
    ("self-intersections", ("self_intersections",), "{}"),
    ("Euler number", ("euler",), "{}"),
    ("exact Euler number", ("euler_exact",), "{}"),
    ("components, faces", ("components", "faces"), "{}, {}"),
    ("area", ("area",), "{}"),
    ("exact area", ("area_exact",), "{}"),
    ("area off by", ("area_error",), "{}"),
    ("volume", ("volume",), "{}"),
    ("exact volume", ("volume_exact",), "{}"),
    ("volume off by", ("volume_error",), "{}"),
    (
        "bodies",
        ("contacts", "overlapping_bodies", "touching_bodies"),
        "{1} pairs overlap, {2} touch without a common face, {0} pairs of triangles meet",
    ),
    ("alpha", ("alpha_mean", "alpha_p01", "alpha_min"), "mean {}, 1 % below {}, smallest {}"),
    ("alpha in the metric", ("alpha_metric_mean", "alpha_metric_min"), "mean {}, smallest {}"),
    ("angles", ("min_angle_deg", "max_angle_deg"), "{}° to {}°"),
    ("edges", ("edge_min", "edge_mean", "edge_max"), "{0} to {2}, mean {1}"),
    ("edges as wanted", ("quasi_unit_share",), "{} within a factor sqrt 2"),
    ("distance from the surface", ("deviation_max", "deviation_rms"), "largest {}, rms {}"),
    ("distance of the surface from the mesh", ("surface_deviation_max",), "largest {}"),
    ("chord asked for", ("chord",), "{}"),
    ("dihedral angles", ("angle_max",), "largest {}°"),
    ("angle asked for", ("angle",), "{}°"),
    (
        "sizes beyond growth",
        ("above_growth_share", "size_growth_max"),
        "{} of the edges, largest {} times what is allowed",
    ),
    ("folded, inverted", ("folded", "inverted"), "{}, {} triangles"),
)
_DISTANCES = ("deviation_max", "deviation_rms", "surface_deviation_max")
_OF_FACES = (  # title, field of its row
    ("face", "face"), ("name", "name"), ("kind", "kind"), ("triangles", "triangles"),
    ("area", "area"), ("exact", "area_exact"),
    ("distance", "deviation_max"), ("chord", "chord"), ("dihedral °", "angle_max"),
    ("angle °", "angle"), ("smallest alpha", "alpha_min"), ("stated limit", "limit"),
)  # fmt: skip


def certificate_html(mesh: SurfaceMesh, report: Report, colourings: dict[str, Colouring]) -> str:
    """Verdict, histograms, the worst triangles, the options, and every figure."""
    values = report.to_dict()
    problems = "".join(f'<p class="problem">{escape(text)}</p>' for text in report.problems)
    notes = "".join(f"<li>{escape(text)}</li>" for text in report.warnings)
    histograms = "".join(
        histogram(found.values, found.title, found.limits, found.logarithmic)
        for found in colourings.values()
        if not found.hues
    )
    figures = {name: value for name, value in values.items() if name not in _SAID + _NOT_KEPT}
    return "\n".join(
        (
            _section("Certificate", problems + _figures(values)),
            _opinion(values.get("second_opinion")),
            _folded(f"Notes ({len(report.warnings)})", f"<ul>{notes}</ul>") if notes else "",
            _folded("Histograms", histograms, is_open=True),
            _folded("Worst triangles", _worst(mesh), is_open=True),
            _folded("Faces", _faces(values["by_face"], values)) if len(report.by_face) > 1 else "",
            _folded("Options", _table(values.get("options") or {}), is_open=True),
            _folded("Every figure", _table(figures)),
            _folded("As text", f"<pre>{escape(str(report))}</pre>"),
        )
    )


def _figures(values: Mapping[str, Any]) -> str:
    """The rows that a reader looks for first."""
    rows = []
    for title, names, words in _FIGURES:
        found = [_beyond_rounding(name, values) for name in names]
        found = [
            f"{value:.2%}"
            if name.endswith("_share") and value is not None
            else f"{value:+.2%}"
            if name.endswith("_error") and value is not None
            else value
            for name, value in zip(names, found)
        ]
        if found[0] is not None:
            none = names[0] == "above_growth_share" and not values[names[0]]
            said = "none" if none else words.format(*map(_said, found))
            rows.append(f'<tr><th>{title}</th><td class="number">{escape(said)}</td></tr>')
    return f"<table>{''.join(rows)}</table>"


def _beyond_rounding(name: str, values: Mapping[str, Any]) -> Any:
    """The value; 0 where it is rounding: of a distance beside the edges, of an angle in degrees."""
    value, shortest = values.get(name), values.get("edge_min")
    if name == "angle_max" and value is not None:
        return value if value > ROUNDING else 0.0
    if value is None or shortest is None or name not in _DISTANCES:
        return value
    return value if value > ROUNDING * shortest else 0.0


def _worst(mesh: SurfaceMesh) -> str:
    """The triangles of smallest alpha, each with a button that goes there."""
    _, numbers = worst_triangles(mesh, MARKED)
    alpha = shapes(mesh).alpha
    rows = []
    for number in numbers.tolist():
        middle = mesh.points[mesh.triangles[number]].mean(axis=0)
        face = int(mesh.face_ids[number])
        name = mesh.face_name(face)
        called = str(face) if name == f"face {face}" else f"{face} ({name})"
        rows.append(
            f'<tr><td><button type="button" data-triangle="{number}">{number}</button></td>'
            f'<td class="number">{alpha[number]:.4f}</td><td>{escape(called)}</td>'
            f'<td class="number">{", ".join(f"{x:.4g}" for x in middle)}</td></tr>'
        )
    head = "<tr><th>triangle</th><th>alpha</th><th>face</th><th>middle</th></tr>"
    return f"<table class='worst'><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"


def _faces(rows: list[Mapping[str, Any]], whole: Mapping[str, Any]) -> str:
    """What was reached on each face beside what was asked of it.

    whole: the figures of the mesh, whose shortest edge says what of a distance is rounding.
    """
    made = [{**row, "edge_min": whole["edge_min"]} for row in rows if row["triangles"]]
    return _records(
        [{title: _beyond_rounding(name, row) for title, name in _OF_FACES} for row in made]
    )


def _opinion(found: Mapping[str, Any] | None) -> str:
    """Ours beside those of each library, those that disagree first; open if there are."""
    if found is None:
        return ""
    tables = "".join(
        _opinion_of(name, [row for row in found["rows"] if row["whose"] == name])
        for name in dict.fromkeys(row["whose"] for row in found["rows"])
    )
    title = f"Second opinion ({found['agreed']:,} of {found['compared']:,} figures agree)"
    return _folded(title, tables, is_open=found["agreed"] < found["compared"])


def _opinion_of(name: str, rows: list[Mapping[str, Any]]) -> str:
    ordered = sorted(rows, key=lambda row: row["agree"] is not False)
    body = "".join(map(_opinion_row, ordered[:SHOWN_ROWS]))
    more = len(rows) - SHOWN_ROWS
    left = f'<p class="hint">{more:,} more rows are in the JSON report</p>' if more > 0 else ""
    head = f"<tr><th>{escape(name)}</th><th>ours</th><th>theirs</th><th>agree</th></tr>"
    return f'<table class="opinion"><thead>{head}</thead><tbody>{body}</tbody></table>{left}'


def _opinion_row(row: Mapping[str, Any]) -> str:
    figure = escape(row["quantity"] + (f" ({row['of']})" if row["of"] else ""))
    digits = DOUBLE_DIGITS if row["agree"] is False else FEW_DIGITS
    ours, theirs = (_said(row[name], digits) for name in ("ours", "theirs"))
    if row["agree"] is None:
        said = f'<td colspan="2">not compared: {escape(row["note"])}</td>'
    else:
        said = f'<td class="number">{theirs}</td><td>{"yes" if row["agree"] else "NO"}</td>'
    return f'<tr><td>{figure}</td><td class="number">{ours}</td>{said}</tr>'


def _table(values: Mapping[str, Any]) -> str:
    """Rows of what is simple; what is not follows below, each under its own name."""
    rows, below = [], []
    for name, value in values.items():
        words = escape(name.replace("_", " "))
        if isinstance(value, Mapping) and value:
            below.append(_folded(words, _table(value)))
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            below.append(_folded(f"{words} ({len(value)})", _records(value)))
        else:
            said = escape(_said(value, ALL_DIGITS))
            rows.append(f'<tr><th>{words}</th><td class="number">{said}</td></tr>')
    return (f"<table>{''.join(rows)}</table>" if rows else "") + "".join(below)


def _records(records: list[Mapping[str, Any]]) -> str:
    """A table with a row each; columns as they first occur."""
    names = list(dict.fromkeys(name for record in records for name in record))
    head = "".join(f"<th>{escape(name.replace('_', ' '))}</th>" for name in names)
    rows = "".join(
        "<tr>"
        + "".join(f'<td class="number">{escape(_said(record.get(n)))}</td>' for n in names)
        + "</tr>"
        for record in records[:SHOWN_ROWS]
    )
    more = len(records) - SHOWN_ROWS
    left = f'<p class="hint">{more:,} more rows are in the JSON report</p>' if more > 0 else ""
    table = f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>"
    return f'<div class="wide">{table}</div>{left}'


def _said(value: Any, digits: int = 5) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return ", ".join(_said(item, digits) for item in value) or "none"
    if isinstance(value, Mapping):
        return "; ".join(f"{name} {_said(item, digits)}" for name, item in value.items()) or "none"
    return str(value)


def _section(title: str, content: str) -> str:
    return f"<section><h2>{title}</h2>{content}</section>"


def _folded(title: str, content: str, is_open: bool = False) -> str:
    mark = " open" if is_open else ""
    return f"<details{mark}><summary>{title}</summary>{content}</details>"
