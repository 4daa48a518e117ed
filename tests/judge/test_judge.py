"""The judge finds faults that are put into good meshes, and finds none in the good ones."""

import cadquery as cq
import numpy as np
import pytest
import shapely
from scipy.spatial import Delaunay

import surfmesh as sm
from judge import domains, solids, surfaces
from judge.index_topology import border_loops, euler_number, fans, faults_of_indices, pieces
from judge.piercing import folded, piercing

CHORD = 0.15
PLATE = shapely.Polygon(
    [(0, 0), (6, 0), (6, 4), (0, 4)], [[(1, 1), (3, 1), (3, 2), (1, 2)]]
)  # fmt: skip
LINE = np.array([(3.5, 0.5), (5.5, 3.5)])


@pytest.fixture(scope="module")
def part():
    return cq.Workplane().box(8, 6, 3).faces(">Z").workplane().hole(2.5).val()


@pytest.fixture(scope="module")
def solid(part):
    mesh = sm.mesh(part, sm.Sizing(chord=CHORD, max_size=1.5))
    return mesh.points, mesh.triangles.astype(np.int64)


TORUS = surfaces.Truth(
    ("(3 + cos(v))*cos(u)", "(3 + cos(v))*sin(u)", "sin(v)"),
    (0.0, 2 * np.pi), (0.0, 2 * np.pi), euler=0, borders=0,
)  # fmt: skip


@pytest.fixture(scope="module")
def torus():
    surface = sm.ParametricSurface(*TORUS.formulas, u=TORUS.u, v=TORUS.v)
    mesh = sm.mesh(surface, sm.Sizing(chord=CHORD))
    return mesh.points, mesh.triangles.astype(np.int64)


@pytest.fixture(scope="module")
def plate():
    outer, hole = np.array(PLATE.exterior.coords), np.array(PLATE.interiors[0].coords)
    mesh = sm.mesh(sm.PlanarDomain(outer, [hole], [LINE]), 0.6)
    return mesh.points, mesh.triangles.astype(np.int64)


def verdicts(request):
    """What the judge says of each of the three, by a name."""
    part = request.getfixturevalue("part")
    return {
        "solid": lambda p, t: solids.judged(p, t, part.wrapped, CHORD, euler=0),
        "torus": lambda p, t: surfaces.judged(p, t, TORUS, CHORD),
        "plate": lambda p, t: domains.judged(p, t, PLATE, [LINE]),
    }


def moved(points, triangles, rng):
    points = points.copy()
    points[rng.integers(len(points))] += 4 * CHORD * np.array([1.0, 1.0, 1.0])
    return points, triangles


def flipped(points, triangles, rng):
    triangles = triangles.copy()
    k = rng.integers(len(triangles))
    triangles[k] = triangles[k, ::-1]
    return points, triangles


def removed(points, triangles, rng):
    return points, np.delete(triangles, rng.integers(len(triangles)), axis=0)


def duplicated(points, triangles, rng):
    k = rng.integers(len(triangles))
    return points, np.concatenate([triangles, triangles[[k]]])


def torn(points, triangles, rng):
    """One corner of one triangle is a new point at the same place."""
    triangles = triangles.copy()
    k = rng.integers(len(triangles))
    points = np.concatenate([points, points[triangles[k, :1]]])
    triangles[k, 0] = len(points) - 1
    return points, triangles


def two_joined(points, triangles, rng):
    """Two distant points are made one."""
    apart = np.linalg.norm(points - points[0], axis=1).argmax()
    triangles = np.where(triangles == apart, 0, triangles)
    number = np.cumsum(np.arange(len(points)) != apart) - 1
    return np.delete(points, apart, axis=0), number[triangles]


def inside_out(points, triangles, rng):
    return points, triangles[:, ::-1]


def folded_over(points, triangles, rng):
    """A vertex is moved across the opposite side of one of its triangles, in its plane."""
    points = points.copy()
    border = faults_border(triangles)
    inner = [t for t in triangles if not np.isin(t, border).any()]
    a, b, c = inner[rng.integers(len(inner))]
    points[a] = points[b] + points[c] - points[a]
    return points, triangles


def faults_border(triangles):
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    found, times = np.unique(edges, axis=0, return_counts=True)
    return np.unique(found[times == 1])


FAULTS = [moved, flipped, removed, duplicated, torn, two_joined, inside_out, folded_over]


@pytest.mark.parametrize("kind", ["solid", "torus", "plate"])
def test_good_meshes_have_no_faults(kind, request):
    assert verdicts(request)[kind](*request.getfixturevalue(kind)).faults == ()


@pytest.mark.parametrize("kind", ["solid", "torus", "plate"])
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found(kind, fault, request):
    judge, good = verdicts(request)[kind], request.getfixturevalue(kind)
    for seed in range(2 if kind == "plate" else 1):
        broken = fault(*good, np.random.default_rng(seed))
        assert judge(*broken).faults, f"{fault.__name__} {seed} is not found"


def test_a_coarser_piece_is_found(solid, torus, part):
    """Edges of a curved part collapsed until chord is no longer kept."""
    coarse = sm.mesh(sm.ParametricSurface(*TORUS.formulas, u=TORUS.u, v=TORUS.v), 1.6)
    faults = surfaces.judged(coarse.points, coarse.triangles, TORUS, CHORD).faults
    assert any("chord" in fault for fault in faults)
    judge = solids.judged(*solid, part.wrapped, 0.5 * CHORD, euler=0)
    assert any("chord from" in fault for fault in judge.faults)


def test_an_edge_swapped_into_a_fold_is_found():
    """Two triangles whose quadrilateral is not convex: the new edge lies outside of it.

        c            abc and bad become adc and bcd, of which one is turned over
       /|\\
      / d \\     d above ab, below c
     a-----b
    """
    rng = np.random.default_rng(0)
    xy = np.concatenate([rng.uniform(0.05, 0.95, (60, 2)), [(0, 0), (1, 0), (1, 1), (0, 1)]])
    triangles = Delaunay(xy).simplices.astype(np.int64)
    points = np.column_stack([xy, np.zeros(len(xy))])
    a, b, c = (points[corner] for corner in triangles.T)
    turned = np.cross(b - a, c - a)[:, 2] < 0
    triangles[turned] = triangles[turned][:, ::-1]
    box = shapely.box(0, 0, 1, 1)
    assert domains.judged(points, triangles, box).faults == ()
    found = 0
    for t, triangle in enumerate(triangles):
        p, q, r = triangle
        beside = np.flatnonzero(np.isin(triangles, (p, q)).sum(axis=1) == 2)
        for other in beside[beside != t]:
            s = int(np.setdiff1d(triangles[other], (p, q))[0])
            x, y = xy[[s, r]] - xy[p], xy[[r, s]] - xy[q]
            if min(np.linalg.det(x), np.linalg.det(y)) < -1e-6 and found < 6:
                swapped = triangles.copy()
                swapped[t], swapped[other] = (p, s, r), (q, r, s)
                found += 1
                assert domains.judged(points, swapped, box).faults
                assert folded(points, swapped)
    assert found >= 3


def test_a_fold_of_a_curved_surface_is_found(torus):
    """A vertex pushed across its neighbour, along the surface."""
    points, triangles = torus[0].copy(), torus[1]
    a, b, c = triangles[5]
    at = 1.6 * (points[b] + points[c]) / 2 - 0.6 * points[a]
    ring = np.array([at[0], at[1], 0.0])
    ring *= 3.0 / np.linalg.norm(ring)
    points[a] = ring + (at - ring) / np.linalg.norm(at - ring)  # back onto the torus
    faults = surfaces.judged(points, triangles, TORUS, 10 * CHORD).faults
    assert any("wrong way" in fault for fault in faults)


def test_two_spheres_that_run_through_each_other_are_found():
    points, triangles = _octahedron()
    both = np.concatenate([points, points + [0.7, 0.1, 0.2]])
    faces = np.concatenate([triangles, triangles + len(points)])
    assert piercing(points, triangles) == 0 and piercing(both, faces) > 0
    assert pieces(faces) == 2 and faults_of_indices(both, faces, closed=True) == []


def _octahedron():
    points = np.concatenate([np.eye(3), -np.eye(3)])
    hull = np.array([t for t in np.ndindex(6, 6, 6) if t[0] < t[1] < t[2] and
                     len({k % 3 for k in t}) == 3])  # fmt: skip
    out = np.linalg.det(points[hull]) > 0
    return points, np.where(out[:, None], hull, hull[:, ::-1])


def test_numbers_of_known_meshes():
    points, triangles = _octahedron()
    assert euler_number(triangles) == 2 and border_loops(triangles) == 0
    assert euler_number(triangles[1:]) == 1 and border_loops(triangles[1:]) == 1
    assert (fans(points, triangles) == 1).all()
    tips = np.concatenate([points, points + [2.0, 0, 0]])  # they touch in (1, 0, 0)
    touching = np.concatenate([triangles, np.where(triangles == 3, 0, triangles + 6)])
    assert fans(tips, touching)[0] == 2


@pytest.mark.parametrize(
    "made, euler",
    [
        (lambda: cq.Workplane().box(1, 2, 3), 2),
        (lambda: cq.Workplane().sphere(1), 2),
        (lambda: cq.Workplane(obj=cq.Solid.makeTorus(3, 1)), 0),
        (lambda: cq.Workplane().box(4, 4, 1).faces(">Z").workplane().hole(1), 0),
        (lambda: cq.Workplane().box(4, 4, 1).faces(">Z").workplane().hole(1, 0.5), 2),
        (
            lambda: cq.Workplane().box(9, 4, 1).faces(">Z").workplane().rarray(3, 1, 2, 1).hole(1),
            -2,
        ),
    ],
)
def test_euler_numbers_of_solids(made, euler):
    assert solids.euler_of(made().val().wrapped) == euler


def test_area_and_volume_of_a_torus():
    area, volume = TORUS.contents
    assert area == pytest.approx(12 * np.pi**2, rel=1e-12)
    assert volume == pytest.approx(6 * np.pi**2, rel=1e-12)
