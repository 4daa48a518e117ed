"""Growth measured on the result: wanted sizes at both ends of every edge, in its direction."""

from dataclasses import replace

import numpy as np
import pytest

import surfmesh as sm
from surfmesh import SurfaceMesh
from surfmesh.quality.measures.lengths import edge_figures, size_growth

SLOPE = sm.Sizing(growth=1.5).gradient  # 2 (1.5 - 1) / (1.5 + 1) = 0.4


def strip(sizes, **more):
    """Two triangles over the unit square."""
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    mesh = SurfaceMesh(
        points=points, triangles=[(0, 1, 2), (0, 2, 3)], uv_points=points[:, :2], sizes=sizes,
        sizing=sm.Sizing(growth=1.5), **more,
    )  # fmt: skip
    return mesh, size_growth(mesh, edge_figures(mesh, slope=SLOPE))


def test_sizes_at_both_ends_of_edges():
    assert pytest.approx(0.4) == SLOPE
    _, just = strip([1.0, 1.4, 1.4, 1.0])
    assert just.fraction == 0 and just.largest == pytest.approx(1.0)
    mesh, more = strip([1.0, 1.8, 1.4, 1.0])
    # the edge 0-1 alone: its sizes differ by 0.8, 0.4 is allowed; 1-2 just so; 5 edges in all
    assert more.fraction == pytest.approx(1 / 5) and more.largest == pytest.approx(2.0)
    assert more.point == (0.5, 0.0, 0.0)
    report = sm.check(mesh)
    assert (report.growth, report.above_growth_share) == (1.5, more.fraction)
    assert report.size_growth_max == more.largest and report.size_growth_point == more.point
    text = " ".join(str(report).split())
    assert (
        "differ along 20 % of them by more than 1.1 times what growth 1.5 allows, up to 2" in text
    )
    assert sm.check(replace(mesh, sizing=None)).above_growth_share is None
    assert sm.check(replace(mesh, sizes=None)).above_growth_share is None


def test_in_the_direction_of_the_edge():
    """Sizes along x alone grow: edges along y do not notice."""
    along_x = np.array([1.0, 1.8, 1.8, 1.0])
    w = np.zeros((4, 6))
    w[:, 0], w[:, 3], w[:, 5] = 1 / along_x, 1.0, 1.0
    _, found = strip(np.ones(4), metric_root_3d=w)
    assert found.largest == pytest.approx(2.0) and found.point[1] in (0.0, 1.0)
    w = w.copy()
    w[:, 0], w[:, 3] = 1.0, 1 / along_x  # along y they do not change from end to end
    _, found = strip(np.ones(4), metric_root_3d=w)
    # but for the diagonal: 1 / h = |W d|, d = (1, 1) / sqrt 2
    sizes = [1 / np.hypot(1.0, 1.0 / h) * np.sqrt(2) for h in (1.0, 1.8)]
    assert found.largest == pytest.approx((sizes[1] - sizes[0]) / (0.4 * np.sqrt(2)))


@pytest.mark.parametrize("own, most", [(1.2, 1.05), (1.9, 1.2)])
def test_gradation_around_a_source(own, most):
    """Of a source of the same growth it is exact; a steeper one is graded within a tenth."""
    sizing = sm.Sizing(size=1.0, sources=sm.Near([0, 0, 0], size=0.05, growth=own))
    plane = sm.ParametricSurface("u", "v", "0*u", u=(-4, 4), v=(-4, 4))
    report = sm.check(sm.mesh(plane, sizing))
    assert 0.95 < report.size_growth_max < most
    assert own > 1.2 or report.above_growth_share < 0.01
