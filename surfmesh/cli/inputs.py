"""What a command works on: the sizes asked for, the surface or mesh that INPUT names."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfmesh.cad.reading.read_file import SUFFIXES, begun_reading
from surfmesh.cli.progress import ProgressBar
from surfmesh.errors import SurfaceError, did_you_mean, printable

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.geometry.surface import Surface
    from surfmesh.result.surface_mesh import SurfaceMesh
    from surfmesh.sizing.options.sizing import Sizing

_LOOKED_AT = 2000  # triangles, to tell which side a mesh faces


def asked_sizing(options: Namespace) -> Sizing | dict[str, Sizing] | None:
    """The sizes that were asked for, or None; those of a file are of selections."""
    from surfmesh.sizing.options.sizing import Sizing

    if not options.sizes:
        return Sizing(**options.sizing) if options.sizing else None

    from surfmesh.sizing.options.sizes_file import read_sizes

    found = read_sizes(options.sizes)
    if options.sizing:
        found["*"] = found.get("*", Sizing()).replaced(**options.sizing)
    return found


def asked_keep(given: list[str]) -> str | dict[str, list[Any]]:
    """What ``--keep`` says: a word, or the sides of inputs by name."""
    if not given:
        return "all"
    if len(given) == 1 and "=" not in given[0]:
        return given[0]
    sides: dict[str, list[Any]] = {}
    for entry in given:
        name, sign, side = entry.partition("=")
        if not sign:
            raise SurfaceError(f"--keep '{entry}': one word alone, or NAME=SIDE several times")
        sides.setdefault(name.strip(), []).append(_side(side.strip()))
    return sides


def _side(text: str) -> str | tuple[float, ...]:
    """A point "x,y,z" as numbers; anything else as it is."""
    try:
        point = tuple(float(part) for part in text.split(","))
    except ValueError:
        return text
    return point if len(point) == 3 else text


@contextmanager
def surface_begun(
    name: str | None, options: Namespace
) -> Iterator[Callable[[], Surface | CadModel]]:
    """What gives the surface ``name`` once it is wanted; None: that of the ``mesh`` command.

    A CAD file is read from now on by a child process, while this one loads what it will need; the
    end of the ``with`` statement ends it.
    """
    path = Path((options.input if name is None else name) or "")
    require_program([path], options)
    if path.suffix.lower() in SUFFIXES and path.is_file() and not _formulas(options):
        with begun_reading(path, **options.reading) as reading:

            def model() -> CadModel:
                import surfmesh.meshing.model_mesh  # noqa: F401  needed next

                return reading.model()

            yield model
    elif name is None:
        yield lambda: surface_of(options)
    else:
        yield lambda: named_surface(name, options)


def surface_and_sizing(
    options: Namespace,
) -> tuple[Surface | CadModel, Sizing | dict[str, Sizing] | None]:
    """The surface or model of INPUT, and the sizes asked for."""
    with surface_begun(options.input, options) as surface_wanted:
        sizing = asked_sizing(options)

        import surfmesh.api  # noqa: F401  while a child process reads a CAD file

        return surface_wanted(), sizing


def _formulas(options: Namespace) -> dict[str, Any]:
    """What was given of --x --y --z --u --v and --param, by name."""
    given = {name: getattr(options, name, None) for name in (*"xyzuv", "param")}
    return {name: value for name, value in given.items() if value}


def surface_of(options: Namespace) -> Surface | CadModel:
    """The surface of the ``mesh`` command: INPUT, or --x --y --z --u --v."""
    if not _formulas(options):
        if not options.input:
            raise SurfaceError("name a formula file or a gallery surface, or give --x --y --z")
        return named_surface(options.input, options)
    if options.input:
        raise SurfaceError(f"either INPUT ('{options.input}') or formulas, not both")
    formulas = {name: getattr(options, name) for name in "xyzuv"}
    missing = [f"--{name}" for name, value in formulas.items() if value is None]
    if missing:
        raise SurfaceError(f"a surface by formulas needs {', '.join(missing)} too")
    _refuse_given(_of_reading(options), "formulas are not read from a file")
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

    x, y, z = (formulas[name].strip() for name in "xyz")
    u, v = ((first.strip(), last.strip()) for first, last in (options.u, options.v))
    return ParametricSurface(x, y, z, u, v, parameters, name=called(options.output))


def named_surface(name: str, options: Namespace) -> Surface | CadModel:
    """A file, or else a surface of the gallery; ``options.reading``: how a CAD file is read."""
    from surfmesh.geometry.files.surface_file import gallery as surfaces
    from surfmesh.intersection.meeting_file import meeting_gallery
    from surfmesh.loading import load

    if Path(name).suffix.lower() == ".py" and Path(name).is_file():
        return _of_program(Path(name), options)
    if Path(name).is_file():
        return load(name, **options.reading)
    known = surfaces() | meeting_gallery()
    if name in known:
        return load(known[name], **options.reading)
    if Path(name).suffix:
        raise SurfaceError(f"{name}: no such file")
    hint = did_you_mean(name, known) or "; 'surfmesh gallery' lists what there is"
    raise SurfaceError(f"'{name}' is neither a file nor a surface of the gallery{hint}")


def surfaces_that_meet(options: Namespace) -> list[Surface | CadModel]:
    """The inputs of ``intersect``; limits of reading hold for those of them that are CAD files."""
    paths = [Path(name) for name in options.inputs]
    require_program(paths, options)
    is_cad = [path.suffix.lower() in SUFFIXES for path in paths]
    without = {"time_limit": None, "memory_limit": None, "isolate": True}
    others = Namespace(**{**vars(options), "reading": options.reading | without})
    return [
        named_surface(name, options if cad or not any(is_cad) else others)
        for name, cad in zip(options.inputs, is_cad)
    ]


def _of_program(path: Path, options: Namespace) -> CadModel:
    """The model that a Python program makes, where the user has allowed to run it."""
    if not options.run_python:
        raise SurfaceError(
            f"'{path}' is a Python program, which may do anything: --run-python runs it and meshes "
            "the CadQuery object that it calls result"
        )
    from surfmesh.plugins.script_models import model_of_script

    reading = options.reading
    limits = ("time_limit", "memory_limit", "no_isolate")
    given = {name: value for name, value in _of_reading(options).items() if name in limits}
    _refuse_given(given, "a program runs in this process")
    return model_of_script(
        path, units=reading["units"], imprint=reading["imprint"], sew=reading["sew"]
    )


def refuse_options_of_meshing(options: Namespace, reason: str) -> None:
    """Raise SurfaceError for an option that says how a model is read or meshed, where none is."""
    given = getattr(options, "sizing", {}) | _of_reading(options)
    given |= {
        name: getattr(options, name, None) for name in ("run_python", "sizes", "no_strict", "prove")
    }
    _refuse_given(given, reason)


def require_program(inputs: Sequence[Path], options: Namespace) -> None:
    """Raise SurfaceError where programs are allowed to run and none is named."""
    if not any(path.suffix.lower() == ".py" for path in inputs):
        _refuse_given({"run_python": options.run_python}, "no program (.py) is named")


def refuse_options_of_faces(surface: Surface | CadModel, options: Namespace) -> None:
    """Raise SurfaceError for an option of the faces of a CAD model, where there is but one."""
    from surfmesh.geometry.surface import Surface

    if isinstance(surface, Surface):
        given = {name: getattr(options, name, None) for name in ("no_strict", "scheduler")}
        _refuse_given(given, "it is for the faces of CAD models")


def _of_reading(options: Namespace) -> dict[str, Any]:
    """What was given of the options of ``load``, by the names in which they are typed."""
    given = dict(options.reading)
    given["no_isolate"] = not given.pop("isolate")
    return given


def _refuse_given(given: Mapping[str, Any], reason: str) -> None:
    for name, value in given.items():
        if value not in (None, False):
            raise SurfaceError(f"--{name.replace('_', '-')} does nothing here: {reason}")


def shown_mesh(options: Namespace, progress: ProgressBar) -> SurfaceMesh:
    """The mesh of INPUT: read from its file, or made of what is in it."""
    from surfmesh.io import FORMATS, IN_PIECES, read

    if Path(options.input).suffix.lower() in FORMATS | IN_PIECES:
        refuse_options_of_meshing(options, f"{options.input} is a mesh already")
        return read(options.input)
    surface, sizing = surface_and_sizing(options)
    refuse_options_of_faces(surface, options)

    from surfmesh import api

    return api.mesh(surface, sizing, progress=progress.up_to(0.9), strict=not options.no_strict)


def on_surface(found: SurfaceMesh, surface: Surface | CadModel) -> SurfaceMesh:
    """The mesh that was read, on a surface or on the faces of a CAD model by their numbers."""
    from surfmesh.cad.model.cad_model import CadModel

    if not isinstance(surface, CadModel):
        from surfmesh.geometry.files.known_facts import known_facts

        return _facing(found.replaced(surfaces=(surface,), facts=known_facts(surface)))

    from surfmesh.cad.model.facts import model_facts
    from surfmesh.meshing.solids.joining import orientation

    turned, solids = orientation(surface)
    known = found.face_ids.min() >= 0 and found.face_ids.max() < len(turned)
    made = found.replaced(
        surfaces=tuple(face.surface for face in surface.faces),
        turned_faces=turned,
        solid_ids=solids[found.face_ids] if known else None,
        facts=model_facts(surface),
    )
    return _facing(made) if known else made


def _facing(found: SurfaceMesh) -> SurfaceMesh:
    """The mesh, taken for one that was turned over where most of it faces the other side."""
    import numpy as np

    corners = found.parametrisation
    if found.broken_invariant() or not len(found.triangles) or corners is None:
        return found
    count = len(found.triangles)
    rows = np.unique(np.linspace(0, count - 1, min(count, _LOOKED_AT)).astype(int))
    a, b, c = found.points[found.triangles[rows]].transpose(1, 0, 2)
    normals, faces = np.cross(b - a, c - a), found.face_ids[rows]
    ahead = 0.0
    for face in np.unique(faces).tolist():
        own = rows[faces == face]
        middle = corners.uv_points[corners.uv_triangles[own]].mean(axis=1)
        _, along_u, along_v = found.surfaces[face].evaluate(middle, 1)
        true = np.cross(along_u, along_v)
        true /= np.maximum(np.linalg.norm(true, axis=1), np.finfo(float).tiny)[:, None]
        turned = found.turned_faces is not None and found.turned_faces[face]
        ahead += float(np.nansum(normals[faces == face] * true)) * (-1.0 if turned else 1.0)
    if not ahead < 0.0:
        return found
    # as the surface is, so that what it says of itself turns too
    return found.replaced(model_links=found.model_links.flipped())


def called(path: str) -> str:
    """A file's name without its extension, fit to be written into files: halves of characters,
    which stand for bytes that are no text, are escaped."""
    return printable(Path(path).stem)
