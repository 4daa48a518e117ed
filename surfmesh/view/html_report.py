"""The report as one HTML file: the mesh to turn and to pick from, and its certificate.

It opens without a network, now and in years: mesh, viewer and licence are all within. The same
mesh gives the same page: the date is in it when ``SOURCE_DATE_EPOCH`` says one, and the seconds
of the report are left to its JSON.
"""

import json
from collections.abc import Collection
from dataclasses import replace
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from string import Template

from surfmesh.errors import FileFormatError
from surfmesh.io.asked_date import asked_date
from surfmesh.io.atomic import replacing
from surfmesh.quality import Report, check
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.certificate_html import certificate_html
from surfmesh.view.colouring import COLOURS, colourings_of, unknown_colouring
from surfmesh.view.faces_apart import faces_apart
from surfmesh.view.legend import name_of, require_drawable, title_of
from surfmesh.view.page_data import SHOWN, page_data

FORMATS = (".html", ".htm")
_ASSETS = files("surfmesh.view") / "assets"


def html_report(
    mesh: SurfaceMesh,
    path: str | Path,
    *,
    by: str = "alpha",
    name: str = "",
    report: Report | None = None,
) -> Path:
    """Write the report of ``mesh`` to ``path`` and return the path.

    by: what it is coloured by at first, as in ``plot``; everything the mesh carries is in the
    page's menu. name: the heading; empty: that of the surface. report: of ``check(mesh)``,
    when it is known already.

    Raises ``FileFormatError`` for a place that cannot be written, an extension other than .html
    or a mesh that cannot be drawn, ``ValueError`` for an unknown ``by`` or one that the mesh has
    no data for.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise FileFormatError(f"{path}: reports are written as .html, not '{path.suffix}'")
    require_drawable(mesh, path)
    text = page(mesh, by=by, name=name, report=check(mesh) if report is None else report)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")
    return path


def page(
    mesh: SurfaceMesh,
    *,
    by: str = "alpha",
    name: str = "",
    title: str | None = None,
    report: Report | None = None,
    shown: Collection[str] = SHOWN,
) -> str:
    """The text of the page; without a ``report`` the view alone.

    title: the heading after ``name``; None: counts and shape. shown: what is switched on at
    first, of ``page_data.SWITCHES``.
    """
    by = "alpha" if by == "quality" else by
    if by not in COLOURS:
        raise ValueError(unknown_colouring(by))
    drawn = faces_apart(mesh)  # curvature has a value for each face that meets in a vertex
    colourings = colourings_of(drawn)
    if by not in colourings:
        raise ValueError(f"cannot colour by {by!r}: the mesh carries no data for it")
    data = page_data(drawn, colourings, by, shown)
    title = title_of(mesh) if title is None else title
    heading = title if not name or name == name_of(mesh) else f"{name} - {title}"
    date = asked_date()
    made = "" if date is None else f", {date:%Y-%m-%d %H:%M} UTC"
    report = None if report is None else replace(report, seconds={})  # they differ every time
    clean = report is None or report.clean
    return Template(_asset("report.html")).substitute(
        title=escape(name or name_of(mesh) or "surfmesh report"),
        heading=escape(heading),
        kind="view" if report is None else "whole",
        verdict="clean" if clean else "NOT CLEAN",
        verdict_class="clean" if clean else "not-clean",
        style=_asset("report.css"),
        certificate="" if report is None else certificate_html(mesh, report, colourings),
        footer=escape(f"surfmesh {version('surfmesh')}{made}; view by three.js (MIT licence)"),
        # within a script element "<" must not begin a tag
        contents=json.dumps(data.contents, allow_nan=False).replace("<", "\\u003c"),
        arrays=data.arrays,
        licence=_asset("three.LICENSE"),
        three=_asset("three.min.js"),
        viewer=_asset("report.js"),
    )


def _asset(name: str) -> str:
    return (_ASSETS / name).read_text(encoding="utf-8")
