"""The benchmark's own arithmetic: the search for the fewest triangles, distances, totals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm

pytestmark = pytest.mark.usefixtures("benchmarks_in_path")


def _search(law, start, lowest=0.01, highest=100.0, attempts=40):
    from fewest import next_fineness

    tried, x = [], start
    while x is not None and len(tried) < attempts:
        tried.append((x, law(x)))
        x = next_fineness(tried, lowest, highest)
    return tried


@settings(max_examples=50, deadline=None)
@given(
    optimum=st.floats(0.02, 50.0), start=st.floats(0.02, 50.0), power=st.floats(0.7, 3.0)
)  # fmt: skip
def test_the_coarsest_that_keeps_the_limit_is_found(optimum, start, power):
    from fewest import NEAR

    tried = _search(lambda x: (optimum / x) ** power, start)
    best = min(x for x, share in tried if share <= 1.0)
    assert best / optimum <= NEAR**2
    assert len(tried) < 40


def test_a_law_of_squares_takes_few_attempts():
    assert len(_search(lambda x: (3.7 / x) ** 2, 1.0)) <= 4


def test_a_flat_model_is_asked_for_the_coarsest():
    tried = _search(lambda x: 0.0, 1.0)
    assert tried[-1][0] == 0.01


def test_a_limit_out_of_reach_ends_at_the_finest():
    tried = _search(lambda x: 2.0, 1.0)
    assert tried[-1][0] == 100.0
    assert len(tried) < 10


def test_steps_and_contradictions_end_too():
    """As gmsh: the deviation does not always fall, and comes in steps."""
    tried = _search(lambda x: (3.0 / round(x)) ** 2 * (1.3 if int(7 * x) % 2 else 1.0), 20.0, 1.0)
    assert len(tried) < 40
    assert min(x for x, share in tried if share <= 1.0) < 20.0


@pytest.mark.parametrize(("above", "kept"), [(0, True), (2, True), (3, False)])
def test_reach_lets_one_in_a_thousand_go(above, kept):
    from fewest import reach

    deviation = np.full(2999, 0.5)
    deviation[:above] = 7.0
    assert (reach(deviation) <= 1.0) is kept


def test_distances_from_a_sphere_and_a_plane():
    """An octahedron in the unit sphere: centroids 1 - 1/sqrt 3, middles 1 - 1/sqrt 2 inside."""
    from true_distance import TrueSurface, by_triangle, distances

    sphere = sm.load("sphere")
    plane = sm.ParametricSurface("u", "v", "3", u=(-9, 9), v=(-9, 9))
    radius = float(np.linalg.norm(sphere.evaluate(np.array([[0.3, 0.4]]), 0)[0][0]))
    uv, faces, points = [], [], []
    for number, surface in enumerate((sphere, plane)):
        sides = [np.linspace(a, b, 10)[1:-1] for a, b in surface.domain]
        grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
        uv.append(grid)
        points.append(surface.evaluate(grid, 0)[0])
        faces.append(np.full(len(grid), number))
    truth = TrueSurface((sphere, plane), *map(np.concatenate, (points, uv, faces)))

    corners = radius * np.vstack([np.eye(3), -np.eye(3)])
    triangles = np.array([(0, 1, 2), (0, 2, 4), (3, 4, 5)])
    away = by_triangle(truth, corners, triangles, 1e-6)
    assert away == pytest.approx(np.full(3, radius * (1 - 1 / np.sqrt(3))), rel=1e-5)
    assert distances(truth, np.array([(0.1, 0.2, 3.25)])) == pytest.approx(0.25)


def test_poles_mislead_no_search():
    """Both measures agree on a mesh of ours; at a pole all parameters of the longitude are one."""
    cq = pytest.importorskip("cadquery")
    from true_distance import by_triangle, true_surface

    model = sm.from_cadquery(cq.Workplane().sphere(1.0))
    limit = model.diagonal / 300
    mesh = sm.mesh(model, sm.Sizing(chord=limit))
    away = by_triangle(true_surface(model), mesh.points, mesh.triangles, limit)
    assert away.max() == pytest.approx(mesh.report.deviation_max, rel=0.02)


def test_verdicts_and_totals():
    from sizing_summary import beside, is_bad, totals

    good = {
        "surface": "a", "mesher": "ours", "share": 1000.0, "ratio": 1.0, "triangles": 100,
        "predicted": 110, "faces": 3, "faces_kept": 3, "largest": 0.9, "folded": 0,
    }  # fmt: skip
    stretched = [{**good, "ratio": ratio, "triangles": n} for ratio, n in [(5.0, 50), (20.0, 40)]]
    peer = {"surface": "a", "mesher": "gmsh", "share": 1000.0, "triangles": 200}
    assert not is_bad(good)
    assert is_bad({**good, "faces_kept": 2})
    assert is_bad({**good, "folded": 1})
    assert not is_bad({"surface": "b", "mesher": "ours", "left_out": "too many"})
    rows = [good, *stretched, peer]
    assert [row["triangles"] for row in beside(rows)] == [100, 40, 200]
    lines = "\n".join(totals(rows))
    assert "9 of 9" in lines
    assert "gmsh needs 2.00" in lines
    assert "ratio 20 needs 0.40" in lines
