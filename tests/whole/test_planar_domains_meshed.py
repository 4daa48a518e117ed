"""Planar domains, meshed: constraint lines, holes, regions, sharp corners, hostile input."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import DomainError
from surfmesh.quality.measures.shape import alpha

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
SMALL = 0.2 + 0.6 * SQUARE
SMALLER = 0.4 + 0.2 * SQUARE


def circle(n, radius=1.0):
    angle = 2.0 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def meshed(domain, size=0.1, **options):
    """A mesh that passed what every planar mesh must pass."""
    mesh = sm.mesh(domain, size, **options)
    valid(mesh, domain)
    return mesh


def valid(mesh, domain):
    """Sound, flat, all triangles positive, of the domain's area, along all its segments."""
    assert mesh.broken_invariant() is None
    assert (mesh.points[:, 2] == 0.0).all()
    assert (areas(mesh) > 0.0).all()
    assert areas(mesh).sum() == pytest.approx(domain.area, rel=1e-9)
    assert len(np.unique(mesh.face_ids)) == domain.regions
    report = sm.check(mesh)
    assert report.manifold and report.oriented
    assert report.inverted == report.degenerate == report.folded == 0
    follows_segments(mesh, domain)


def areas(mesh):
    a, b, c = (mesh.points[corner, :2] for corner in mesh.triangles.T)
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def follows_segments(mesh, domain):
    """Edges of the mesh make up every segment that bounds or divides the inside.

    The ends of a segment are vertices to the last bit; edges on it add up to its length.
    """
    graph = domain.graph
    points = mesh.points[:, :2]
    a, b = (points[mesh.edges[:, k]] for k in (0, 1))
    known = {tuple(p) for p in points.tolist()}
    near = 1e-9 * np.ptp(graph.points, axis=0).max()
    for i, j in graph.segments:
        p, q = graph.points[i], graph.points[j]
        length = np.hypot(*(q - p))
        if not _is_inside(domain, 0.5 * (p + q)):
            continue
        assert tuple(p.tolist()) in known and tuple(q.tolist()) in known
        on = np.ones(len(a), bool)
        for end in (a, b):
            along = (end - p) @ (q - p) / length
            across = np.abs((end - p) @ np.array([p[1] - q[1], q[0] - p[0]])) / length
            on &= (across < near) & (along > -near) & (along < length + near)
        assert np.linalg.norm((b - a)[on], axis=1).sum() == pytest.approx(length, rel=1e-6)


def _is_inside(domain, place):
    import shapely

    from surfmesh.geometry.planar.domain_faces import inside_faces

    reach = 1e-9 * max(high - low for low, high in domain.domain)
    return shapely.intersects(shapely.Point(place).buffer(reach), inside_faces(domain.graph)).any()


# topology


def test_a_square():
    domain = sm.PlanarDomain(SQUARE)
    mesh = meshed(domain)
    report = sm.check(mesh)
    assert report.euler == 1 and report.area == pytest.approx(1.0, rel=1e-12)
    assert report.alpha_mean > 0.95 and report.alpha_min > 0.6


def test_islands_in_holes():
    domain = sm.PlanarDomain([SQUARE, SMALLER], [SMALL])
    report = sm.check(meshed(domain, 0.05))
    assert report.area == pytest.approx(1.0 - 0.36 + 0.04)
    assert report.components == 2 and report.euler == 0 + 1


def test_regions_have_their_areas():
    domain = sm.PlanarDomain(SQUARE, constraints=[[[0.3, 0], [0.3, 1]], [[0.3, 0.5], [1, 0.5]]])
    mesh = meshed(domain, 0.08)
    found = sorted(np.bincount(mesh.face_ids, areas(mesh)))
    assert found == pytest.approx([0.3, 0.35, 0.35])  # the second line ends on the first: a T


@pytest.mark.parametrize("name", ["letter_a", "floor_plate"])
def test_facts_of_the_gallery(name):
    domain = sm.load(name)
    mesh = sm.mesh(domain)
    report = sm.check(mesh, second_opinion=True)
    assert report.area == pytest.approx(domain.facts["area"], rel=1e-6)
    opinion = report.second_opinion
    assert opinion.agreed == opinion.compared == len(opinion.rows) - 2  # no volume in the plane
    assert report.euler == domain.facts["euler"]
    assert len(np.unique(mesh.face_ids)) == domain.facts["regions"]
    assert report.manifold and report.inverted == 0
    follows_segments(mesh, domain)


# lines and points


@pytest.mark.parametrize(
    "line",
    [
        [[0.2, 0.3], [0.8, 0.7]],  # both ends inside
        [[0.5, 0.5], [1.0, 0.5]],  # from inside to the outline
        [[0.1, 0.1], [0.5, 0.9], [0.9, 0.1], [0.1, 0.1]],  # closed
        [[0.2, 0.2], [0.4, 0.4], [0.4, 0.4], [0.6, 0.6], [0.8, 0.8]],  # collinear, one twice
        [[0.2, 0.5], [0.8, 0.5], [0.2, 0.5]],  # to and fro
        [[0.0, 0.0], [1.0, 1.0]],  # corner to corner
        [[0.0, 0.5], [0.0, 0.7]],  # along the outline
    ],
)
@pytest.mark.parametrize("optimise", [False, True])
def test_constraint_lines_are_edges(line, optimise):
    meshed(sm.PlanarDomain(SQUARE, constraints=[line]), optimise=optimise)


def test_crossing_lines_are_refused_or_split():
    lines = [[[0.1, 0.2], [0.9, 0.8]], [[0.1, 0.8], [0.9, 0.2]]]
    with pytest.raises(DomainError, match=r"constraint 0.* crosses constraint 1"):
        sm.PlanarDomain(SQUARE, constraints=lines)
    mesh = meshed(sm.PlanarDomain(SQUARE, constraints=lines, crossings="split"))
    assert np.hypot(*(mesh.points[:, :2] - 0.5).T).min() < 1e-12


def test_a_line_across_the_outline_counts_inside_only():
    domain = sm.PlanarDomain(SQUARE, constraints=[[[-0.5, 0.4], [1.5, 0.6]]], crossings="split")
    mesh = meshed(domain)
    assert domain.regions == 2
    assert mesh.points[:, 0].min() == 0.0 and mesh.points[:, 0].max() == 1.0


def test_lone_points_are_vertices():
    places = np.array([[0.31, 0.47], [0.5, 0.5], [0.77, 0.9], [0.5, 0.0]])
    mesh = meshed(sm.PlanarDomain(SQUARE, points=places))
    assert {tuple(p) for p in places.tolist()} <= {tuple(p) for p in mesh.points[:, :2].tolist()}


# corners and scales


def wedge(degrees):
    angle = np.radians(degrees)
    return meshed(sm.PlanarDomain([[0, 0], [1, 0], [np.cos(angle), np.sin(angle)]]), 0.05)


@pytest.mark.parametrize("degrees", [1.0, 5.0, 20.0])
def test_wedges(degrees):
    """No triangle is thinner than the isosceles one that the corner itself forces."""
    mesh = wedge(degrees)
    assert len(mesh.triangles) < 20_000
    angle = np.radians(degrees)
    isosceles = np.sqrt(3.0) * np.sin(angle) / (2.0 - np.cos(angle))
    assert alpha(mesh).min() > 0.5 * isosceles


THIN = "two sides of a sharp corner are not taken for a narrow gap: edges there stay long"


@pytest.mark.parametrize(
    "degrees",
    [
        pytest.param(1.0, marks=pytest.mark.xfail(strict=True, reason=THIN)),
        pytest.param(5.0, marks=pytest.mark.xfail(strict=True, reason=THIN)),
        10.0,
        20.0,
    ],
)
def test_triangles_off_a_sharp_corner_are_not_thin(degrees):
    mesh = wedge(degrees)
    off_corner = (np.hypot(*mesh.points[:, :2].T) > 0.0)[mesh.triangles].all(axis=1)
    assert alpha(mesh)[off_corner].min() > 0.2


@pytest.mark.parametrize("degrees", [1.0, 5.0, 20.0])
def test_lines_that_meet_at_a_sharp_angle_inside(degrees):
    angle = np.radians(degrees)
    tip = np.array([0.2, 0.3])
    lines = [[tip, tip + 0.5 * np.array(d)] for d in ((1, 0), (np.cos(angle), np.sin(angle)))]
    meshed(sm.PlanarDomain(SQUARE, constraints=lines), 0.05)


def test_segments_a_millionth_of_the_domain():
    tiny = 1e-6
    notched = [[0, 0], [0.5, 0], [0.5, tiny], [0.5 + tiny, tiny], [0.5 + tiny, 0], [1, 0], [1, 1]]
    mesh = meshed(sm.PlanarDomain([*notched, [0, 1]]))
    assert len(mesh.triangles) < 20_000
    mesh = meshed(sm.PlanarDomain(SQUARE, constraints=[[[0.5, 0.5], [0.5 + tiny, 0.5]]]))
    assert len(mesh.triangles) < 20_000


def test_collinear_and_repeated_points_of_a_loop():
    side = np.linspace(0.0, 1.0, 41)[:-1]
    flat = np.zeros(40)
    loop = np.concatenate(
        [np.c_[side, flat], np.c_[flat + 1, side], np.c_[1 - side, flat + 1], np.c_[flat, 1 - side]]
    )
    meshed(sm.PlanarDomain(np.repeat(loop, 2, axis=0)))


@pytest.mark.parametrize("power", [-30, 30])
def test_the_unit_of_length_does_not_matter(power):
    factor = 2.0**power
    domain = sm.PlanarDomain(SQUARE * factor, [SMALLER * factor])
    found = meshed(domain, 0.1 * factor)
    plain = meshed(sm.PlanarDomain(SQUARE, [SMALLER]), 0.1)
    assert len(found.triangles) == pytest.approx(len(plain.triangles), rel=0.02)


@pytest.mark.parametrize("size", [0.7, 5.0, 100.0])
def test_sizes_larger_than_the_domain(size):
    assert len(meshed(sm.PlanarDomain(SQUARE), size).triangles) < 12


# the same domain said otherwise


def test_the_direction_of_loops_does_not_matter():
    one = meshed(sm.PlanarDomain(SQUARE, [SMALLER]))
    other = meshed(sm.PlanarDomain(SQUARE[::-1], [SMALLER[::-1]]))
    assert _picture(one) == _picture(other)


def test_a_repeated_first_point_does_not_matter():
    one = meshed(sm.PlanarDomain(SQUARE))
    other = meshed(sm.PlanarDomain(np.concatenate([SQUARE, SQUARE[:1]])))
    assert _picture(one) == _picture(other)


def _picture(mesh):
    """The triangles by their corners, whatever the numbering."""
    corners = mesh.points[mesh.triangles][..., :2].tolist()
    return {tuple(sorted(map(tuple, triangle))) for triangle in corners}


def test_same_input_same_bits():
    domain = sm.load("letter_a")
    first, second = sm.mesh(domain), sm.mesh(sm.load("letter_a"))
    for field in ("points", "triangles", "face_ids", "sizes"):
        assert getattr(first, field).tobytes() == getattr(second, field).tobytes()


def test_thirty_thousand_boundary_segments():
    across, up = 100, 75
    hole = 0.25 + 0.5 * SQUARE
    holes = [hole + (i, j) for i in range(across) for j in range(up)]
    outer = SQUARE * [across, up]
    domain = sm.PlanarDomain(outer, holes)
    assert len(domain.graph.segments) == 30_004
    mesh = sm.mesh(domain, 0.5)
    assert areas(mesh).sum() == pytest.approx(0.75 * across * up, rel=1e-9)
    assert len(mesh.points) - len(mesh.edges) + len(mesh.triangles) == 1 - len(holes)


def test_thirty_thousand_segments_far_shorter_than_the_size():
    n = 30_000
    domain = sm.PlanarDomain(circle(n))
    mesh = sm.mesh(domain, 0.1)
    assert len(mesh.boundary_edges) == n and sm.check(mesh).euler == 1
    assert areas(mesh).sum() == pytest.approx(0.5 * n * np.sin(2.0 * np.pi / n), rel=1e-9)


@pytest.mark.parametrize("width, height", [(2.356, 4.0), (2.3, 5.0)])
def test_between_the_sides_of_a_strip_there_is_no_vertex_too_many(width, height):
    """A vertex between the short side and the next row made triangles of alpha 0.71."""
    mesh = meshed(sm.PlanarDomain(SQUARE * [width, height]), 1.0)
    assert alpha(mesh).min() > 0.76
