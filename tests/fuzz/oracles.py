"""What is done with each kind of hostile input, and what is held against the result.

Each oracle takes the file and the mutant in it and says in words what was read; errors of
surfmesh pass through, they are refusals.
"""

import contextlib
import json
import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from fuzz.mutations import MARK, Mutant
from fuzz.seed_files import CAD, MESHES, in_pieces, originals

OPEN_ENDED = (".obj", ".inp", ".off", ".ply")  # of other programs: their last number may be cut
LONGEST = 1000  # characters of a message


class Wrong(Exception):
    """What was read does not hold together; the words say why."""


class Partial(Exception):
    """A file that was cut was read as if it were whole."""


def _mesh(path: Path, found: Mutant) -> str:
    """Read, report in full, and write in one of the formats."""
    from surfmesh.io import FORMATS, read
    from surfmesh.quality import check

    mesh = read(path)
    _held_together(mesh)
    report = check(mesh)
    broken = mesh.broken_invariant()
    if broken and report.clean:
        raise Wrong(f"the report is clean, but {broken}")
    report.to_text()
    json.loads(report.to_json())
    if found.changes == ("truncated",):
        _as_whole(path, found, mesh)
    number = sum(found.data[-8:]) % len(FORMATS)
    return (
        f"{mesh}; {broken or 'sound'}{_saved(mesh, path.with_name('again' + [*FORMATS][number]))}"
    )


def _index(path: Path, found: Mutant) -> str:
    """A damaged index beside good pieces."""
    _put_pieces(path.parent)
    return _mesh(path, found._replace(changes=()))


def _piece(path: Path, found: Mutant) -> str:
    """A damaged piece beside good ones, below a good index."""
    _put_pieces(path.parent)
    whole = originals(".pvtu piece")[found.source]
    place = next(name for name, data in in_pieces().items() if data == whole)
    (path.parent / place).write_bytes(found.data)
    index = (path.parent / place).parent.name.removesuffix(".pieces")
    return _mesh(path.with_name(index), found._replace(changes=()))


def _put_pieces(folder: Path) -> None:
    for name, data in in_pieces().items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)


def _held_together(mesh: Any) -> None:
    """What broken_invariant() takes for granted: arrays that belong to these points, triangles."""
    points, triangles = len(mesh.points), len(mesh.triangles)
    if not triangles:
        raise Wrong("there are no triangles")
    for name, limit in (("edge_segments", points), ("vertex_ids", points)):
        numbers = getattr(mesh, name)
        if numbers is not None and len(numbers) and numbers.max() >= limit:
            raise Wrong(f"{name} holds {numbers.max()}, the points are {limit}")
    if mesh.edge_ids is not None and mesh.edge_segments is not None:
        if len(mesh.edge_ids) != len(mesh.edge_segments):
            raise Wrong("edge_ids and edge_segments are of different lengths")
    for face in set(mesh.face_ids.tolist()):
        mesh.face_name(face)


def _saved(mesh: Any, path: Path) -> str:
    from surfmesh.errors import SurfmeshError
    from surfmesh.io import save

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of corners alone for order 2
        try:
            save(mesh, path)
        except SurfmeshError as error:
            return f"; not saved: {error}"
        finally:
            path.unlink(missing_ok=True)
    return ""


@cache
def _whole(kind: str, source: int) -> Any:
    from surfmesh.io import read

    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, f"whole{kind}")
        place.write_bytes(originals(kind)[source])
        return read(place)


def _as_whole(path: Path, found: Mutant, mesh: Any) -> None:
    """A file that was cut gives all of the mesh, or is refused."""
    kind, original = path.suffix, originals(path.suffix)[found.source]
    if kind in OPEN_ENDED and MARK not in original:
        return
    whole = _whole(kind, found.source)
    same = all(
        _same(getattr(mesh, name), getattr(whole, name))
        for name in ("points", "triangles", "face_ids", "solid_ids", "mid_points", "sizes")
    )
    if not same or mesh.groups != whole.groups:
        raise Partial(f"cut at {len(found.data)} of {len(original)} bytes, read as {mesh}")


def _same(a: Any, b: Any) -> bool:
    return (a is None) == (b is None) and (
        a is None or (a.shape == b.shape and bool((a == b).all()))
    )


def _cad(path: Path, found: Mutant) -> str:
    """What the child of ``read_cad`` does; what OCP prints there goes nowhere."""
    from surfmesh.cad.reading.readers import read_here
    from surfmesh.errors import CadError

    try:
        model = read_here(path, True, None)
    except Exception as error:  # as the child says it
        if type(error).__module__.startswith("OCP"):
            raise CadError(f"OCP gave up: {type(error).__name__}") from None
        raise
    return f"{len(model.faces)} faces"


def _cad_in_child(path: Path, found: Mutant) -> str:
    from surfmesh.cad.reading.read_file import read_cad

    return f"{len(read_cad(path).faces)} faces"


def _surface(path: Path, found: Mutant) -> str:
    """Load, and make a coarse mesh of few triangles."""
    import surfmesh as sm

    surface = sm.load(path)
    return f"{surface.name[:40]!r}: {sm.mesh(surface, sm.Sizing(angle=40, limit=3000))}"


def _drawing(path: Path, found: Mutant) -> str:
    import surfmesh as sm

    return f"{sm.mesh(sm.load(path), sm.Sizing(limit=3000))}"


def _sizes(path: Path, found: Mutant) -> str:
    """Read, and settle for a model whose faces have names."""
    import surfmesh as sm
    from surfmesh.sizing.options.sizes_file import read_sizes

    sizes = read_sizes(path)
    return f"{len(sizes)} selections, {sm.estimate(_box(), sizes).triangles} triangles"


@cache
def _box() -> Any:
    import cadquery as cq

    import surfmesh as sm

    parts = cq.Assembly(name="front").add(cq.Workplane().box(1, 1, 1), name="front box")
    return sm.from_cadquery(parts)


def _command_line(path: Path, found: Mutant) -> str:
    """Run in this process; the exit status and both streams are as the docs say."""
    import io

    from surfmesh.cli import main

    folder = path.parent / "commands"
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    words = [word.replace("FOLDER", str(folder)) for word in json.loads(found.data)]
    for name, data in _INPUTS.items():
        Path(folder, name).write_bytes(data)
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(words)
        except SystemExit as end:
            status = end.code
    said, complaints = out.getvalue(), err.getvalue()
    shown = f"{words}: {status} {complaints.strip()}"
    made = {entry.name for entry in folder.iterdir()} - set(_INPUTS)
    if status not in (0, 1, 2):
        raise Wrong(f"exit status {status!r} of {shown}")
    if status == 2:
        one_line = complaints.startswith("surfmesh: ") and complaints.count("\n") == 1
        if not one_line or said or not complaints.strip().isprintable():
            raise Wrong(f"not one line: {complaints!r}, {said[:80]!r} of {shown}")
        if made:
            raise Wrong(f"{made} left behind by {shown}")
    elif complaints:
        raise Wrong(f"status {status}, but it complains: {shown}")
    elif "--json" in words and status != 2 and "--help" not in words and said[:1] == "{":
        json.loads(said)
    return shown[:LONGEST]


_INPUTS = {
    "tetra.off": b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
    "bad.off": b"OFF\n4 4 0\n1 1 1\n",
    "surface.toml": b'name = "s"\nx = "u"\ny = "v"\nz = "u*v"\n[domain]\nu = [0, 1]\nv = [0, 1]\n',
    "bad.toml": b'name = "\x1b[2J"\nx = "u"\n',
    "sizes.toml": b'[sizes."*"]\nsize = 0.5\n',
    "domain.toml": b'name = "d"\nouter = [[0, 0], [1, 0], [1, 1], [0, 1]]\n[sizing]\nsize = 0.5\n',
    "bad.step": b"ISO-10303-21;\nHEADER;\n",
    "odd\n\x1b[31mname.off": b"OFF\n1 1 1\n",
}  # fmt: skip

TRIED: dict[str, Callable[[Path, Mutant], str]] = {
    **dict.fromkeys(MESHES, _mesh),
    ".pvtu": _index,
    ".pvtu piece": _piece,
    **dict.fromkeys(CAD, _cad),
    **{f"{kind} in a child": _cad_in_child for kind in CAD},
    "surface": _surface,
    "domain": _surface,
    "drawing": _drawing,
    "sizes": _sizes,
    "command": _command_line,
}
