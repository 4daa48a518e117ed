"""The files beside the mesh: report, manifest; and what is said when one cannot be written."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TypeGuard

from surfmesh.cli.inputs import called
from surfmesh.cli.option_groups import BY_DEFAULT
from surfmesh.errors import FileFormatError, MeshingError

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.quality.report import Report
    from surfmesh.result.surface_mesh import SurfaceMesh

_NOT_RECORDED = (
    "command", "input", "inputs", "output", "picture", "report", "manifest", "sizes", "json",
    "jobs", "sizing", "reading",
)  # fmt: skip
"""Options that are no part of a manifest: places, what is in the mesh's sizing, what changes
nothing in the files."""

_WHOLE = ("picture", "report", "manifest", "second_opinion", "simplify", "flip")


def report_written(result: SurfaceMesh, report: Report, options: Namespace) -> Path:
    """As JSON or as HTML, by its extension."""
    if Path(options.report).suffix.lower() == ".json":
        return written(report.to_json(), options.report)
    from surfmesh.view import html_report

    name = called(options.output)
    return html_report(result, options.report, by=options.by, name=name, report=report)


def manifest_written(result: SurfaceMesh, files: dict[str, str], options: Namespace) -> Path:
    """Hashes of all files but a JSON report, which holds the seconds that were taken."""
    from surfmesh.io import Manifest

    asked = {name: value for name, value in vars(options).items() if name not in _NOT_RECORDED}
    asked |= {**options.reading, "isolate": None}  # which changes nothing in the files
    hashed = [path for path in files.values() if Path(path).suffix.lower() != ".json"]
    return Manifest.of(
        result,
        hashed,
        inputs=[options.sizes] if options.sizes else (),
        options={name: value for name, value in asked.items() if value not in (None, False, [])},
    ).save(options.manifest)


def require_outputs(options: Namespace) -> None:
    """Raise FileFormatError for a file of the ``mesh`` command that could not be written."""
    from surfmesh.io.formats import require_writable

    for name, extension in (("ascii", ".stl"), ("solids", ".stl"), ("target", ".inp")):
        if getattr(options, name) and Path(options.output).suffix.lower() != extension:
            raise FileFormatError(f"{options.output}: --{name} is for {extension} files alone")
    require_writable(options.output)
    wanted = (options.picture, ".png"), (options.report, ".json", ".html")
    for path, *extensions in (*wanted, (options.manifest, ".json")):
        if path:
            require_writable(path, *extensions)
    _require_two_files(options.report, options.manifest)
    _require_coloured(options)


def in_pieces(surface: object, options: Namespace) -> TypeGuard[CadModel]:
    """Whether a CAD model goes into a .pvtu file by workers, so that none holds the whole.

    Raises ``MeshingError`` for an option that needs the whole mesh.
    """
    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.io import IN_PIECES

    if not isinstance(surface, CadModel) or Path(options.output).suffix.lower() not in IN_PIECES:
        return False
    asked = [f"--{name.replace('_', '-')}" for name in _WHOLE if getattr(options, name)]
    asked += ["--order 2"] if options.order == 2 else []
    if asked:
        raise MeshingError(
            f"{asked[0]} needs the whole mesh, which --scheduler does not gather for a .pvtu file: "
            "leave one of them out"
        )
    return True


def _require_two_files(report: str | None, manifest: str | None) -> None:
    if report and manifest and os.path.realpath(report) == os.path.realpath(manifest):
        raise FileFormatError(f"{manifest}: is the place of the report already")


def _require_coloured(options: Namespace) -> None:
    html = options.report and Path(options.report).suffix.lower() != ".json"
    if options.by != BY_DEFAULT and not options.picture and not html:
        raise FileFormatError(
            f"--by {options.by} does nothing here: it colours a --picture or an HTML --report"
        )


@contextmanager
def naming(files: dict[str, str]) -> Iterator[None]:
    """Files that were written before one could not be are named with the refusal."""
    try:
        yield
    except FileFormatError as error:
        raise FileFormatError(f"{error}; written before it: {', '.join(files.values())}") from error


def written(text: str, path: str) -> Path:
    from surfmesh.io.atomic import replacing

    with replacing(Path(path)) as temporary:
        temporary.write_text(  # halves of characters by their escapes, as JSON has them
            text + "\n", encoding="utf-8", errors="backslashreplace", newline="\n"
        )
    return Path(path)
