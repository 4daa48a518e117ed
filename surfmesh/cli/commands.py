"""What each command does. Every one returns whether all is well."""

import json
import os
import tomllib
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from textwrap import fill
from time import perf_counter
from typing import Any

from surfmesh.cli.progress import ProgressBar, announce_compilation
from surfmesh.cli.terminal import say, say_json
from surfmesh.errors import FileFormatError, SurfaceError, SurfmeshError, printable

SIZES = (
    "chord", "angle", "size", "min_size", "max_size", "growth", "anisotropy", "volume", "gap",
    "limit",
)  # fmt: skip


def mesh(options: Namespace) -> bool:
    """Mesh, check, write; the files are looked at before the work is done."""
    from surfmesh.io.formats import require_writable

    require_writable(options.output, *([".stl"] if options.ascii else []))
    wanted = (options.picture, ".png"), (options.report, ".json", ".html")
    for path, *extensions in (*wanted, (options.manifest, ".json")):
        if path:
            require_writable(path, *extensions)
    _require_two_files(options.report, options.manifest)
    sizing = _sizing(options)
    surface = _surface(options)

    from surfmesh import api
    from surfmesh.io import save
    from surfmesh.quality import check as checked

    announce_compilation()
    with ProgressBar() as progress:
        result = api.mesh(
            surface,
            sizing,
            optimise=not options.no_optimise,
            progress=progress,
            strict=not options.no_strict,
            simplify=options.simplify,
            jobs=options.jobs,
            order=options.order,
        )
        result = result.flipped() if options.flip else result
        progress("check", 0.92)
        report = checked(result, second_opinion=options.second_opinion)
        progress("write", 0.95)
        start = perf_counter()
        files = {"mesh": str(save(result, options.output, ascii=options.ascii))}
        report = replace(report, seconds={**report.seconds, "write": perf_counter() - start})
        with _naming(files):
            if options.picture:
                from surfmesh.view import plot

                progress("picture", 0.97)
                files["picture"] = str(plot(result, options.picture, by=options.by))
            if options.report:
                files["report"] = str(_report_written(result, report, options))
            if options.manifest:
                files["manifest"] = str(_manifest_written(result, files, options))
    if options.json:
        say_json(report.to_dict() | {"files": files})
    else:
        say(report)
        say(f"  written    {printable(', '.join(files.values()))}")
    return report.clean


def check(options: Namespace) -> bool:
    """Report on a mesh file, against its surface when that is named."""
    from surfmesh.io import read
    from surfmesh.quality import check as checked

    found = read(options.input)
    if options.surface:
        if found.uv_points is None:
            raise FileFormatError(
                f"{options.input}: carries no (u, v) to compare it with a surface; "
                "save it as .vtu or .vtp"
            )
        found = _on_surface(found, _named_surface(options.surface, options))
        broken = found.check()
        if broken:
            raise FileFormatError(f"{options.input}: {broken}")
    else:
        from surfmesh.result.model_facts import ModelFacts, file_sha256

        source = Path(options.input)
        found = found.replaced(facts=ModelFacts(source=source.name, sha256=file_sha256(source)))
    report = checked(found, second_opinion=options.second_opinion)
    if options.json:
        say_json(report.to_dict())
    else:
        say(report.to_text())
    return report.clean


def compare(options: Namespace) -> bool:
    """Say which entries of a manifest agree with another's, or with the files themselves."""
    from surfmesh.io import Manifest

    manifest, other = Manifest.read(options.input), options.other or Path(options.input).parent
    folder = Path(other).is_dir()
    found = manifest.compared_with_folder(other) if folder else manifest.compared(
        Manifest.read(other)
    )  # fmt: skip
    same = all(entry.agrees for entry in found if entry.decisive)
    if options.json:
        say_json({"same": same, "entries": [entry.to_dict() for entry in found]})
        return same
    for section in dict.fromkeys(entry.section for entry in found):
        own = [entry for entry in found if entry.section == section]
        names = ", ".join(printable(entry.name) for entry in own if entry.agrees)
        if names:
            say(fill(f"  {section:<10} agree: {names}", subsequent_indent=" " * 13))
        for entry in own:
            if not entry.agrees:
                sides = " / ".join(map(_value, (entry.here, entry.there)))
                say(f"  {section:<10} DIFFER: {printable(entry.name)}: {sides}")
    what = "files" if folder else "mesh and files"
    verdict = f"the {what} are the same" if same else f"DIFFERENT {what.upper()}"
    say(f"{verdict}: {sum(entry.agrees for entry in found)} of {len(found)} entries agree")
    return same


def _value(value: Any) -> str:
    """As JSON; of a hash the beginning."""
    text = "nothing" if value is None else json.dumps(value)
    return text if len(text) <= 40 else f"{text[:17]}..."


def view(options: Namespace) -> bool:
    """Show a mesh file, or a surface or CAD model meshed as its file or the options say."""
    if options.output:
        from surfmesh.io.formats import require_writable

        require_writable(options.output, ".png")
    with ProgressBar() as progress:
        shown = _shown(options, progress)

    from surfmesh.view import plot, show

    drawn = {name: getattr(options, name) for name in ("by", "circles", "directions", "worst")}
    try:
        if options.output:
            plot(shown, options.output, **drawn)
        else:
            show(shown, **drawn)
    except ValueError as error:  # the mesh has no data to colour by
        raise SurfmeshError(str(error)) from error
    return True


def report(options: Namespace) -> bool:
    """Write the HTML report of a mesh file, or of what is meshed for it."""
    from surfmesh.io.formats import require_writable

    require_writable(options.output, ".html", ".htm")
    with ProgressBar() as progress:
        shown = _shown(options, progress)

        from surfmesh.quality import check as checked
        from surfmesh.view import html_report

        progress("check", 0.9)
        found = checked(shown, second_opinion=options.second_opinion)
        progress("write", 0.95)
        try:
            name = _called(options.input)
            html_report(shown, options.output, by=options.by, name=name, report=found)
        except ValueError as error:  # the mesh has no data to colour by
            raise SurfmeshError(str(error)) from error
    if options.json:
        say_json(found.to_dict() | {"files": {"html": options.output}})
    else:
        say(found)
        say(f"  written    {printable(options.output)}")
    return found.clean


def _shown(options: Namespace, progress: ProgressBar) -> Any:
    """The mesh of INPUT: read from its file, or made of what is in it."""
    from surfmesh.io import FORMATS, read

    if Path(options.input).suffix.lower() in FORMATS:
        return read(options.input)
    sizing = _sizing(options)
    surface = _named_surface(options.input, options)

    from surfmesh import api

    announce_compilation()
    strict = {"strict": False} if options.no_strict else {}
    return api.mesh(surface, sizing, progress=progress, **strict)


def explain(options: Namespace) -> bool:
    """Say which rule decides the size at a point."""
    sizing = _sizing(options)
    surface = _named_surface(options.input, options)

    from surfmesh import api

    found = api.explain(surface, sizing, options.at)
    if options.json:
        say_json(found.to_dict())
    else:
        say(found)
    return True


def estimate(options: Namespace) -> bool:
    """Say how many triangles there would be, and how much memory they need."""
    sizing = _sizing(options)
    surface = _named_surface(options.input, options)

    from surfmesh import api

    found = api.estimate(surface, sizing)
    if options.json:
        say_json(found.to_dict())
    else:
        say(found)
    return True


def _sizing(options: Namespace) -> Any:
    """The sizes that were asked for, or None; those of a file are of selections."""
    from surfmesh.sizing.options.sizing import Sizing

    given = {name: getattr(options, name) for name in SIZES if getattr(options, name) is not None}
    if not options.sizes:
        return Sizing(**given) if given else None

    from surfmesh.sizing.options.sizes_file import read_sizes

    found = read_sizes(options.sizes)
    if given:
        found["*"] = found.get("*", Sizing()).replaced(**given)
    return found


def pack(options: Namespace) -> bool:
    """Pack circles over the plane, say how good they are, draw them."""
    from surfmesh.io.formats import require_writable
    from surfmesh.view.packing_drawing import FORMATS

    if options.output:
        require_writable(options.output, *FORMATS)

    from surfmesh.circle_packing import pack as packed
    from surfmesh.sizing.options.radius_laws import UniformRadius

    law = options.radius or UniformRadius(*options.uniform, seed=options.seed)
    announce_compilation()
    found = packed(
        law, options.origin, count=options.count, distance=options.distance, box=options.box
    )
    broken = found.check()
    figures = found.statistics.to_dict()
    if options.output:
        found.plot(options.output, options.show)
    if options.json:
        say_json(figures | {"problem": broken, "file": options.output})
    else:
        verdict = f"NOT VALID: {broken}" if broken else "valid"
        say(f"{figures['nodes']:,} circles, {figures['elements']:,} triangles - {verdict}")
        for title, names in _PACKING_ROWS.items():
            say(f"  {title:<34} {', '.join(f'{n} {figures[n]:.6g}' for n in names)}")
        if options.output:
            say(f"  written    {printable(options.output)}")
    return broken is None


_PACKING_ROWS = {
    "got over wanted radius, less one": ("max1", "avg1"),
    "ratio of neighbouring radii": ("max2", "avg2"),
    "shape alpha": ("min3", "avg3"),
    "iterations a circle, seconds": ("iterations", "seconds"),
}


def gallery(options: Namespace) -> bool:
    """List the ready-made surfaces."""
    from surfmesh.geometry.files.surface_file import gallery as surfaces

    described = []
    for name, path in surfaces().items():
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        described.append((name, content.get("description", ""), path))
    if options.json:
        keys = ("name", "description", "path")
        say_json({"surfaces": [dict(zip(keys, map(str, entry))) for entry in described]})
    else:
        width = max((len(name) for name, *_ in described), default=0)
        for name, description, _ in described:
            say(f"{printable(name):<{width}}  {printable(description)}")
    return True


def _surface(options: Namespace) -> Any:
    """The surface of the ``mesh`` command: INPUT, or --x --y --z --u --v."""
    formulas = {name: getattr(options, name) for name in "xyzuv"}
    if not any(formulas.values()) and not options.param:
        if not options.input:
            raise SurfaceError("name a formula file or a gallery surface, or give --x --y --z")
        return _named_surface(options.input, options)
    if options.input:
        raise SurfaceError(f"either INPUT ('{options.input}') or formulas, not both")
    missing = [f"--{name}" for name, value in formulas.items() if value is None]
    if missing:
        raise SurfaceError(f"a surface by formulas needs {', '.join(missing)} too")
    parameters = {}
    for entry in options.param:
        name, sign, value = entry.partition("=")
        try:
            parameters[name.strip()] = float(value)
        except ValueError:
            sign = ""
        if not sign:
            raise SurfaceError(f"--param must be NAME=NUMBER, not '{entry}'")

    from surfmesh.geometry.formulas.parametric import ParametricSurface

    stripped = {
        name: value.strip() if isinstance(value, str) else tuple(end.strip() for end in value)
        for name, value in formulas.items()
    }
    return ParametricSurface(**stripped, parameters=parameters, name=_called(options.output))


def _on_surface(found: Any, surface: Any) -> Any:
    """The mesh that was read, on a surface or on the faces of a CAD model by their numbers."""
    from surfmesh.cad.model.cad_model import CadModel

    if not isinstance(surface, CadModel):
        from surfmesh.geometry.files.known_facts import known_facts

        return _facing(found.replaced(surfaces=(surface,), facts=known_facts(surface)))

    from surfmesh.cad.model.facts import model_facts
    from surfmesh.meshing.model_mesh import orientation

    turned, solids = orientation(surface)
    known = found.face_ids.min() >= 0 and found.face_ids.max() < len(turned)
    made = found.replaced(
        surfaces=tuple(face.surface for face in surface.faces),
        turned_faces=turned,
        solid_ids=solids[found.face_ids] if known else None,
        facts=model_facts(surface),
    )
    return _facing(made) if known else made


_LOOKED_AT = 2000  # triangles, to tell which side a mesh faces


def _facing(found: Any) -> Any:
    """The mesh, taken for one that was turned over where most of it faces the other side."""
    import numpy as np

    if found.check() or not len(found.triangles):
        return found
    count = len(found.triangles)
    rows = np.unique(np.linspace(0, count - 1, min(count, _LOOKED_AT)).astype(int))
    a, b, c = found.points[found.triangles[rows]].transpose(1, 0, 2)
    normals, faces = np.cross(b - a, c - a), found.face_ids[rows]
    ahead = 0.0
    for face in np.unique(faces).tolist():
        own = rows[faces == face]
        middle = found.uv_points[found.uv_triangles[own]].mean(axis=1)
        _, along_u, along_v = found.surfaces[face].evaluate(middle, 1)
        true = np.cross(along_u, along_v)
        true /= np.maximum(np.linalg.norm(true, axis=1), np.finfo(float).tiny)[:, None]
        turned = found.turned_faces is not None and found.turned_faces[face]
        ahead += float(np.nansum(normals[faces == face] * true)) * (-1.0 if turned else 1.0)
    if not ahead < 0.0:
        return found
    turned = found.flipped()  # as the surface is, so that what it says of itself turns too
    return found.replaced(model_links=turned.model_links)


def _named_surface(name: str, options: Namespace | None = None) -> Any:
    """A file, or else a surface of the gallery; options: those of a CAD model."""
    from surfmesh import api
    from surfmesh.geometry.files.surface_file import gallery as surfaces

    given = () if options is None else ("units", "imprint", "sew", "time_limit", "memory_limit")
    wanted = {option: getattr(options, option) for option in given}
    if Path(name).is_file():
        return api.load(name, **wanted)
    known = surfaces()
    if name in known:
        return api.load(known[name], **wanted)
    close = get_close_matches(name, known, n=1)
    hint = f"did you mean '{close[0]}'?" if close else "'surfmesh gallery' lists what there is"
    raise SurfaceError(f"'{name}' is neither a file nor a surface of the gallery; {hint}")


def _report_written(result: Any, report: Any, options: Namespace) -> Path:
    """As JSON or as HTML, by its extension."""
    if Path(options.report).suffix.lower() == ".json":
        return _written(report.to_json(), options.report)
    from surfmesh.view import html_report

    name = _called(options.output)
    return html_report(result, options.report, by=options.by, name=name, report=report)


_NOT_RECORDED = (
    "command", "input", "output", "picture", "report", "manifest", "sizes", "json", "jobs", *SIZES
)  # fmt: skip
"""Options that are no part of a manifest: places, what is in the mesh's sizing, what changes
nothing in the files."""


def _manifest_written(result: Any, files: dict[str, str], options: Namespace) -> Path:
    """Hashes of all files but a JSON report, which holds the seconds that were taken."""
    from surfmesh.io import Manifest

    asked = {name: value for name, value in vars(options).items() if name not in _NOT_RECORDED}
    hashed = [path for path in files.values() if Path(path).suffix.lower() != ".json"]
    return Manifest.of(
        result,
        hashed,
        inputs=[options.sizes] if options.sizes else (),
        options={name: value for name, value in asked.items() if value not in (None, False, [])},
    ).save(options.manifest)


def _require_two_files(report: str | None, manifest: str | None) -> None:
    if report and manifest and os.path.realpath(report) == os.path.realpath(manifest):
        raise FileFormatError(f"{manifest}: is the place of the report already")


@contextmanager
def _naming(files: dict[str, str]) -> Iterator[None]:
    """Files that were written before one could not be are named with the refusal."""
    try:
        yield
    except FileFormatError as error:
        raise FileFormatError(f"{error}; written before it: {', '.join(files.values())}") from error


def _written(text: str, path: str) -> Path:
    from surfmesh.io.atomic import replacing

    with replacing(Path(path)) as temporary:
        temporary.write_text(  # halves of characters by their escapes, as JSON has them
            text + "\n", encoding="utf-8", errors="backslashreplace", newline="\n"
        )
    return Path(path)


def _called(path: str) -> str:
    """A file's name without its extension, fit to be written into files: halves of characters,
    which stand for bytes that are no text, are escaped."""
    return printable(Path(path).stem)
