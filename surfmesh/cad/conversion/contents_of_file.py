"""What a CAD file holds that has no faces: curves, points, CSG, sweeps, triangles, with counts.

The readers of OCP pass over such entities without a word. They are counted in the text of the
file, roughly as it is written; comments and strings are not told from the rest.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID, TopAbs_VERTEX

from surfmesh.cad.parts import Part
from surfmesh.cad.sub_shapes import counted, each, unique


@dataclass(frozen=True)
class _Kind:
    """A kind of entity by its names in STEP and numbers in IGES, and what can be done about it."""

    one: str
    many: str
    step: tuple[str, ...] = ()
    iges: tuple[int, ...] = ()
    cure: str = ""


_EVALUATE = "have the CAD system evaluate them and export solids with faces (B-rep)"
CSG = _Kind(
    "CSG entity", "CSG entities",
    (
        "CSG_SOLID", "BOOLEAN_RESULT", "BLOCK", "RIGHT_CIRCULAR_CYLINDER", "RIGHT_CIRCULAR_CONE",
        "SPHERE", "TORUS", "RIGHT_ANGULAR_WEDGE", "HALF_SPACE_SOLID", "BOXED_HALF_SPACE",
        "ELLIPSOID", "ECCENTRIC_CONE", "FACETED_PRIMITIVE", "RECTANGULAR_PYRAMID",
    ),
    (150, 152, 154, 156, 158, 160, 168),
    _EVALUATE,
)  # fmt: skip
TREE = _Kind("CSG tree", "CSG trees", iges=(180, 182, 184), cure=_EVALUATE)  # of solids, also B-rep
SWEEP = _Kind(
    "swept solid", "swept solids",
    (
        "EXTRUDED_AREA_SOLID", "REVOLVED_AREA_SOLID", "EXTRUDED_FACE_SOLID", "REVOLVED_FACE_SOLID",
        "SWEPT_DISK_SOLID", "SURFACE_CURVE_SWEPT_AREA_SOLID", "SURFACE_CURVE_SWEPT_FACE_SOLID",
    ),
    (162, 164),
    _EVALUATE,
)  # fmt: skip
TRIANGLES = _Kind(
    "tessellated shape", "tessellated shapes",
    (
        "TESSELLATED_SOLID", "TESSELLATED_SHELL", "TRIANGULATED_SURFACE_SET",
        "COMPLEX_TRIANGULATED_SURFACE_SET", "TESSELLATED_CURVE_SET", "TESSELLATED_POINT_SET",
    ),
    cure="export surfaces (B-rep) instead of triangles",
)  # fmt: skip
CURVE = _Kind(
    "curve", "curves",
    (
        "LINE", "CIRCLE", "ELLIPSE", "PARABOLA", "HYPERBOLA", "POLYLINE", "BEZIER_CURVE",
        "B_SPLINE_CURVE", "B_SPLINE_CURVE_WITH_KNOTS", "OFFSET_CURVE_3D",
    ),
    (100, 102, 104, 106, 110, 112, 126, 130),
    "make faces of the curves in the CAD system",
)  # fmt: skip
POINT = _Kind("point", "points", iges=(116,))
NOTE = _Kind("note or drawing", "notes and drawings", iges=(*range(202, 231), 312, 404, 410))
ELEMENT = _Kind("node or finite element", "nodes and finite elements", iges=(134, 136, 138))
ELSEWHERE = _Kind("reference to another file", "references to other files", ("DOCUMENT_FILE",),
                  cure="load those files")  # fmt: skip

_BODIES = (CSG, SWEEP)  # would have faces, had they been evaluated
_OTHERS = (TREE, TRIANGLES, CURVE, POINT, NOTE, ELEMENT, ELSEWHERE)
_STEP_NAME = re.compile(rb"[=()]\s*([A-Z][A-Z_0-9]+)\s*\(")


def unread_bodies(path: Path) -> list[str]:
    """What a file holds that should have faces and has none; a sentence, or nothing."""
    held = _held(path)
    bodies = [kind for kind in _BODIES if held[kind.one]]
    return [f"{_listed(held, bodies)} besides: not read; {bodies[0].cure}"] if bodies else []


def without_faces(
    called: str, root: Part | None, path: Path | None, left_out: Sequence[str] = ()
) -> str:
    """The message for a model or a file without a face: what there is, and what to do.

    left_out: faces that are there and cannot be used, with the reasons.
    """
    held: Counter[str] = Counter() if path is None else _held(path)
    shapes = _of_shapes(root)
    kinds = [kind for kind in (*_BODIES, TREE, TRIANGLES) if held[kind.one]]
    if left_out:
        only = f", only {_listed(held, kinds)}" if kinds else ""
        more = f"; and {len(left_out) - 3} more" if len(left_out) > 3 else ""
        return f"{called} holds no face that can be meshed{only}: {'; '.join(left_out[:3])}{more}"
    if shapes:
        held |= shapes
        kinds += [kind for kind in (CURVE, POINT) if shapes[kind.one]]
    elif not kinds:
        kinds = [kind for kind in _OTHERS if held[kind.one]]
    said = _listed(held, kinds)
    empty = held["solid without faces"]
    if empty:
        said = " and ".join(filter(None, (said, f"{empty} solid{'s' * (empty > 1)} without faces")))
    if not said:
        return f"{called} holds no faces and nothing else: there is nothing to mesh"
    cure = next((f"; {kind.cure}" for kind in kinds if kind.cure), "")
    return f"{called} holds no faces, only {said}: there is nothing to mesh{cure}"


def _listed(held: Counter[str], kinds: Iterable[_Kind]) -> str:
    return ", ".join(counted(held[kind.one], kind.one, kind.many) for kind in kinds)


def _held(path: Path) -> Counter[str]:
    """How many entities of each kind a file has; none of a BREP file."""
    suffix = path.suffix.lower()
    if suffix in (".step", ".stp", ".p21"):
        names = Counter(_STEP_NAME.findall(path.read_bytes()))
        return Counter(
            {k.one: sum(names[name.encode()] for name in k.step) for k in (*_BODIES, *_OTHERS)}
        )
    if suffix in (".iges", ".igs"):
        numbers = Counter(_iges_numbers(path))
        return Counter({k.one: sum(numbers[name] for name in k.iges) for k in (*_BODIES, *_OTHERS)})
    return Counter()


def _iges_numbers(path: Path) -> Iterator[int]:
    """Of all entities: the first of the two lines of each in the directory, in fixed columns."""
    for line in path.read_bytes().splitlines():
        place, number = line[73:80].strip(), line[:8].strip()
        if line[72:73] == b"D" and place.isdigit() and int(place) % 2 and number.isdigit():
            yield int(number)


def _of_shapes(root: Part | None) -> Counter[str]:
    """Edges of no face, vertices of no edge, solids without faces."""
    found: Counter[str] = Counter()
    for part in root or ():
        if part.shape is None or part.shape.IsNull():
            continue
        found[CURVE.one] += len(list(each(part.shape, TopAbs_EDGE, TopAbs_FACE)))
        found[POINT.one] += len(list(each(part.shape, TopAbs_VERTEX, TopAbs_EDGE)))
        solids = unique(part.shape, TopAbs_SOLID)
        found["solid without faces"] += sum(not unique(s, TopAbs_FACE) for s in solids)
    return +found
