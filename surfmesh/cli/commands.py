"""What each command does. Every one returns whether all is well."""

from __future__ import annotations

import json
import tomllib
from argparse import Namespace
from dataclasses import replace
from pathlib import Path
from textwrap import fill
from time import perf_counter
from typing import TYPE_CHECKING, Any

from surfmesh.cli.inputs import (
    asked_keep,
    asked_sizing,
    called,
    on_surface,
    refuse_options_of_faces,
    refuse_options_of_meshing,
    shown_mesh,
    surface_and_sizing,
    surface_begun,
    surfaces_that_meet,
)
from surfmesh.cli.outputs import (
    in_pieces,
    manifest_written,
    naming,
    report_written,
    require_outputs,
)
from surfmesh.cli.progress import ProgressBar
from surfmesh.cli.scheduler import executor_of
from surfmesh.cli.terminal import say, say_json
from surfmesh.errors import FileFormatError, SurfmeshError, printable

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.geometry.surface import Surface
    from surfmesh.meshing.estimate.estimation import Estimate
    from surfmesh.meshing.explain.explanation import Explanation
    from surfmesh.sizing.options.given_sizes import Sizes


def mesh(options: Namespace) -> bool:
    """Mesh, check, write; the files are looked at before the work is done."""
    with surface_begun(None, options) as surface_wanted:
        require_outputs(options)
        sizing = asked_sizing(options)

        # loaded while a child process reads a CAD file
        import surfmesh.api
        import surfmesh.io
        import surfmesh.quality  # noqa: F401

        surface = surface_wanted()
    return _made(surface, sizing, options)


def intersect(options: Namespace) -> bool:
    """Intersect, then as ``mesh``."""
    require_outputs(options)
    sizing = asked_sizing(options)

    from surfmesh import api

    surfaces = surfaces_that_meet(options)
    model = api.intersect(surfaces, asked_keep(options.keep), coincident=options.coincident)
    return _made(model, sizing, options)


def _made(surface: Surface | CadModel, sizing: Sizes, options: Namespace) -> bool:
    """The mesh of a surface, checked and written with all that is asked for beside it."""
    from surfmesh import api
    from surfmesh.io import save
    from surfmesh.quality import check as checked

    refuse_options_of_faces(surface, options)
    with ProgressBar() as progress, executor_of(options.scheduler) as executor:
        if executor is not None and in_pieces(surface, options):
            return _mesh_in_pieces(surface, sizing, options, executor, progress)
        result = api.mesh(
            surface,
            sizing,
            optimise=not options.no_optimise,
            progress=progress.up_to(0.92),
            strict=not options.no_strict,
            simplify=options.simplify,
            jobs=options.jobs,
            executor=executor,
            order=options.order,
        )
        result = result.flipped() if options.flip else result
        progress("check", 0.92)
        report = checked(result, second_opinion=options.second_opinion)
        progress("write", 0.95)
        start = perf_counter()
        chosen = {name: getattr(options, name) for name in ("ascii", "solids", "target")}
        files = {"mesh": str(save(result, options.output, **chosen))}
        report = replace(report, seconds={**report.seconds, "write": perf_counter() - start})
        with naming(files):
            if options.picture:
                from surfmesh.view import plot

                progress("picture", 0.97)
                files["picture"] = str(plot(result, options.picture, by=options.by))
            if options.report:
                files["report"] = str(report_written(result, report, options))
            if options.manifest:
                files["manifest"] = str(manifest_written(result, files, options))
    if options.json:
        say_json(report.to_dict() | {"files": files})
    else:
        say(report)
        say(f"  written    {printable(', '.join(files.values()))}")
    return report.clean


def _mesh_in_pieces(
    model: CadModel, sizing: Sizes, options: Namespace, executor: Executor, progress: ProgressBar
) -> bool:
    """Mesh a CAD model into a .pvtu file by the workers; no process holds the whole."""
    from surfmesh.partitioned_mesh import mesh_into_pieces

    found = mesh_into_pieces(
        Path(options.output), model, sizing, executor, optimise=not options.no_optimise,
        progress=progress, strict=not options.no_strict,
    )  # fmt: skip
    if options.json:
        say_json(found.to_dict() | {"files": {"mesh": str(found.path)}})
    else:
        say(found)
        say(f"  written    {printable(str(found.path))}")
    return found.clean


def check(options: Namespace) -> bool:
    """Report on a mesh file, against its surface when that is named."""
    from surfmesh.loading import mesh_of_file

    if options.surface:
        with surface_begun(options.surface, options) as surface_wanted:
            found = mesh_of_file(options.input)
            if found.uv_points is None:
                raise FileFormatError(
                    f"{options.input}: carries no (u, v) to compare it with a surface; "
                    "save it as .vtu or .vtp"
                )
            found = on_surface(found, surface_wanted())
        broken = found.broken_invariant()
        if broken:
            raise FileFormatError(f"{options.input}: {broken}")
    else:
        refuse_options_of_meshing(options, "name what the mesh was made from, with --surface")

        from surfmesh.result.model_facts import ModelFacts, file_sha256

        source = Path(options.input)
        found = mesh_of_file(options.input).replaced(
            facts=ModelFacts(source=source.name, sha256=file_sha256(source))
        )

    from surfmesh.quality import check as checked

    prove = True if options.prove else None
    report = checked(found, second_opinion=options.second_opinion, prove=prove)
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
        shown = shown_mesh(options, progress)

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
        shown = shown_mesh(options, progress)

        from surfmesh.quality import check as checked
        from surfmesh.view import html_report

        progress("check", 0.9)
        found = checked(shown, second_opinion=options.second_opinion)
        progress("write", 0.95)
        try:
            name = called(options.input)
            html_report(shown, options.output, by=options.by, name=name, report=found)
        except ValueError as error:  # the mesh has no data to colour by
            raise SurfmeshError(str(error)) from error
    if options.json:
        say_json(found.to_dict() | {"files": {"html": options.output}})
    else:
        say(found)
        say(f"  written    {printable(options.output)}")
    return found.clean


def explain(options: Namespace) -> bool:
    """Say which rule decides the size at a point."""
    surface, sizing = surface_and_sizing(options)

    from surfmesh import api

    _say_found(api.explain(surface, sizing, options.at), options)
    return True


def estimate(options: Namespace) -> bool:
    """Say how many triangles there would be, and how much memory they need."""
    surface, sizing = surface_and_sizing(options)

    from surfmesh import api

    _say_found(api.estimate(surface, sizing), options)
    return True


def _say_found(found: Explanation | Estimate, options: Namespace) -> None:
    if options.json:
        say_json(found.to_dict())
    else:
        say(found)


def pack(options: Namespace) -> bool:
    """Pack circles over the plane, say how good they are, draw them."""
    from surfmesh.io.formats import require_writable
    from surfmesh.view.packing_drawing import FORMATS

    if options.output:
        require_writable(options.output, *FORMATS)

    from surfmesh.circle_packing import pack as packed
    from surfmesh.sizing.options.radius_laws import UniformRadius

    law = options.radius or UniformRadius(options.uniform[0], options.uniform[1], options.seed)
    found = packed(
        law, options.origin, count=options.count, distance=options.distance, box=options.box
    )
    broken = found.broken_invariant()
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
    from surfmesh.intersection.meeting_file import meeting_gallery

    described = []
    for name, path in (surfaces() | meeting_gallery()).items():
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
