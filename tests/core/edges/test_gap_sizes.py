"""What the distance of edges asks for, beside a slow twin."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.edges import gap_sizes

SAMPLES = 9
SIZES = st.floats(0.05, 3.0)


def size(gap, asked, law):
    ignored = max(law["ignored"], law["ignored_of_size"] * asked)
    if gap < ignored:
        return np.inf
    narrow = min(law["longer"] * gap, law["narrowest"])
    narrow = law["narrowest"] if narrow < law["least_narrow"] else narrow
    return max(law["along"] * gap, narrow, law["least"])


@settings(max_examples=60, deadline=None)
@given(
    gap=st.floats(0.001, 2.0), slope=st.floats(0.0, 0.5), asked=SIZES, reach=SIZES,
    along=st.floats(0.3, 8.0), least=st.floats(0.0, 0.3), ignored=st.floats(0.0, 0.2),
    narrowest=st.floats(0.01, 1.0),
)  # fmt: skip
def test_sizes_across_a_gap_that_widens(
    gap, slope, asked, reach, along, least, ignored, narrowest
):  # fmt: skip
    """Two straight edges of one face; the second is the x axis from 0 to 10."""
    law = {
        "along": along, "least": least, "ignored": ignored, "ignored_of_size": 1 / 150,
        "longer": 3.0, "narrowest": narrowest, "least_narrow": 0.3 * narrowest,
    }  # fmt: skip
    x = np.linspace(4.0, 6.0, SAMPLES)
    height = gap + slope * (x - 4.0)
    long = np.linspace(0.0, 10.0, SAMPLES)
    points = np.zeros((2 * SAMPLES, 3))
    points[:SAMPLES, 0], points[:SAMPLES, 1], points[SAMPLES:, 0] = x, height, long
    n = len(points)
    found = gap_sizes(
        points, np.full(n, reach), np.array([0, SAMPLES, n]), np.array([[0, 1], [2, 3]]),
        np.array([0, 1]), np.array([0, 2]), np.full(n, asked), **law,
    )[:SAMPLES]  # fmt: skip
    wanted = [size(h, asked, law) if h < reach else np.inf for h in height.tolist()]
    near_a_limit = (
        np.isclose(height, reach) | np.isclose(height, max(ignored, asked / 150))
        | np.isclose(3.0 * height, law["least_narrow"])
    )  # fmt: skip
    assert np.allclose(found[~near_a_limit], np.array(wanted)[~near_a_limit], rtol=1e-9)
