"""Section 3: the reference cuts the same domains out of the same packing as the fast code."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from naive.boundary_row import insert_row
from naive.relaxed_packing import RelaxedPacking
from stages import recovered

from surfmesh.geometry.planar.planar_domain import PlanarRegion
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.patch.packing import packed_over
from surfmesh.reference.boundary_insertion import insert_boundary
from surfmesh.reference.field_packing import FieldPacking, Limits
from surfmesh.reference.size_tensors import SizeTensor, circle
from surfmesh.sizing.field.size_field import plane_field

UNIT = PlanarRegion("unit square", ((0.0, 1.0), (0.0, 1.0)))


def cut(corners, pieces):
    """A closed polygon, each side cut into so many pieces."""
    sides = zip(corners, [*corners[1:], corners[0]], pieces)
    return [a + (b - a) * k / n for a, b, n in sides for k in range(n)]


def ring(centre, radius, n, turn=0.1):
    return [centre + radius * np.exp(1j * (turn + 2.0 * np.pi * k / n)) for k in range(n)]


ELL = [0.03 + 0.02j, 0.96 + 0.02j, 0.96 + 0.52j, 0.47 + 0.52j, 0.47 + 0.97j, 0.03 + 0.97j]
LINE = [0.21 + 0.22j, 0.31 + 0.27j, 0.41 + 0.34j, 0.46 + 0.45j, 0.61 + 0.52j]

SHAPES = {
    "square with a line": ([cut([0j, 1 + 0j, 1 + 1j, 1j], [8, 9, 8, 9])], LINE),
    "disc": ([ring(0.51 + 0.49j, 0.45, 24)], []),
    "L with a hole": ([cut(ELL, [8, 4, 4, 4, 4, 8]), ring(0.24 + 0.26j, 0.11, 6)[::-1]], []),
}


def graded(p):
    h = 0.06 + 0.15 * np.hypot(p[:, 0] - 0.2, p[:, 1] - 0.3)
    return np.stack([h, np.zeros(len(h)), h], axis=1)


def stretched(p):
    return np.tile([0.15, 0.04, 0.1], (len(p), 1)) * (1.0 + 0.3 * p[:, :1])


FIELDS = {
    "uniform": lambda p: np.tile([0.12, 0.0, 0.12], (len(p), 1)),
    "graded": graded,
    "stretched": stretched,
}


def numbered(loops, line):
    """Nodes, and pairs of them: of the loops, and of the line."""
    nodes, rim = [], []
    for loop in loops:
        first, n = len(nodes), len(loop)
        rim += [(first + k, first + (k + 1) % n) for k in range(n)]
        nodes += loop
    lines = list(pairwise(range(len(nodes), len(nodes) + len(line))))
    return nodes + list(line), rim, lines


def fast_triangles(field, nodes, rim, lines):
    """Corners (m, 3) as complex numbers."""
    uv = np.stack([np.real(nodes), np.imag(nodes)], axis=1)
    segments, inner = (np.array(s, np.int32).reshape(-1, 2) for s in (rim, lines))
    loops = BoundaryLoops(uv, segments, np.arange(len(uv)), inner)
    packing = packed_over(field, field.chart)
    domain = recovered(packing.t, loops, field, SimpleNamespace(name="domain"))
    triangles = domain.t.tri.reshape(-1, 3)
    return (domain.t.xy @ [1, 1j])[triangles]


def slow_triangles(field, nodes, rim, lines):
    def size(p):
        return SizeTensor(*field.tensors(np.array([[p.real, p.imag]]))[0].tolist())

    packing = RelaxedPacking(size, Limits(0.5 + 0.5j, box=(0j, 1 + 1j)))
    packing.advance()
    insert_row(packing, size, nodes, [*rim, *lines, *((b, a) for a, b in lines)])
    triangles = insert_boundary(packing, size, nodes, rim, lines)
    return np.array(packing.points)[np.array(triangles)]


def places(triangles):
    """A set of triangles by where their corners are, to rounding, from the lowest one on."""
    rows = [[(round(p.real, 9) + 0.0, round(p.imag, 9) + 0.0) for p in t] for t in triangles]
    return {tuple(row[row.index(min(row)) :] + row[: row.index(min(row))]) for row in rows}


@pytest.mark.parametrize("law", FIELDS)
@pytest.mark.parametrize("shape", SHAPES)
def test_the_same_triangles(shape, law):
    field = plane_field(UNIT, FIELDS[law], 1e6)
    problem = numbered(*SHAPES[shape])
    slow, fast = (way(field, *problem) for way in (slow_triangles, fast_triangles))
    assert len(slow) == len(fast) > 40
    assert places(slow) == places(fast)


def small_packing(h=0.2):
    packing = FieldPacking(lambda p: circle(0.5 * h), Limits(0.5 + 0.5j, box=(0j, 1 + 1j)))
    packing.advance()
    return packing, lambda p: circle(0.5 * h)


def test_the_triangles_cover_the_domain():
    nodes, rim, lines = numbered(*SHAPES["L with a hole"])
    packing, size = small_packing()
    corners = np.array(packing.points)
    triangles = insert_boundary(packing, size, nodes, rim, lines)
    a, b, c = np.array(packing.points)[np.array(triangles)].T
    areas = 0.5 * np.imag(np.conj(b - a) * (c - a))
    polygon = 0.5 * sum(np.imag(np.conj(nodes[a]) * nodes[b]) for a, b in rim)
    assert areas.min() > 0.0 and areas.sum() == pytest.approx(polygon)
    assert len(corners) < len(packing.points)


BROKEN = {
    "two segments cross": ([0.1 + 0.1j, 0.9 + 0.9j, 0.9 + 0.1j, 0.1 + 0.9j], "cross"),
    "a node twice": (
        [0.1 + 0.1j, 0.9 + 0.1j, 0.5 + 0.5j, 0.9 + 0.9j, 0.1 + 0.9j, 0.5 + 0.5j],
        "touches itself",
    ),
    "a node on a segment": (
        [0.1 + 0.1j, 0.9 + 0.1j, 0.9 + 0.9j, 0.5 + 0.1j, 0.1 + 0.9j],
        "runs through a node",
    ),
    "the wrong way round": ([0.1 + 0.1j, 0.1 + 0.9j, 0.9 + 0.9j, 0.9 + 0.1j], "does not enclose"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_errors_say_what_is_wrong(case):
    nodes, message = BROKEN[case]
    packing, size = small_packing()
    with pytest.raises(ValueError, match=message):
        insert_boundary(packing, size, *numbered([nodes], [])[:2])
