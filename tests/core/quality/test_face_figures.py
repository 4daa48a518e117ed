"""Figures of faces and histograms, against the same in numpy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from surfmesh._core import quality
from surfmesh.result.connectivity import connect

FACES = 4
NUMBERS = st.floats(0.0, 1e3) | st.just(0.0) | st.just(1.0)


def figures(count, elements=NUMBERS):
    return arrays(np.float64, count, elements=elements)


@st.composite
def triangles(draw, parts):
    """Faces (m,) and so many figures (m,) of triangles."""
    count = draw(st.integers(0, 12))
    faces = draw(arrays(np.int32, count, elements=st.integers(0, FACES - 2)))
    return faces, *(draw(figures(count)) for _ in range(parts))


def on_faces(faces):
    """Triangles of these faces, all on the same three vertices."""
    corners = np.tile(np.arange(3, dtype=np.int32), (len(faces), 1))
    return quality.JoinedTriangles(np.eye(3), corners, faces, FACES, *connect(corners))


@given(triangles(2))
def test_shapes_are_added_up_face_by_face(given_):
    faces, area, alpha = given_
    number, total, alphas, least = on_faces(faces).face_shapes(area, alpha)
    np.testing.assert_array_equal(number, np.bincount(faces, minlength=FACES))
    np.testing.assert_array_equal(total, np.bincount(faces, area, FACES))
    np.testing.assert_array_equal(alphas, np.bincount(faces, alpha, FACES))
    smallest = np.full(FACES, np.inf)
    np.fmin.at(smallest, faces, alpha)
    np.testing.assert_array_equal(least, smallest)


@given(triangles(3), st.booleans())
def test_the_worst_triangle_of_a_face_is_the_first_that_is_farthest(given_, is_unknown):
    faces, distance, square, area = given_
    if is_unknown and len(faces):
        distance[0] = np.nan
    marked = (area > 1.0).view(np.uint8)
    largest, worst, squares, number = on_faces(faces).face_distances(distance, square, area, marked)
    for face in range(FACES):
        own = np.flatnonzero(faces == face)
        most = distance[own].max(initial=0.0)
        first = own[distance[own] == most]
        np.testing.assert_equal(largest[face], most)
        assert worst[face] == (first[0] if len(first) else 0)
    np.testing.assert_array_equal(squares, np.bincount(faces, area * square, FACES))
    np.testing.assert_array_equal(number, np.bincount(faces, marked, FACES))


@given(figures(20, st.floats(-2.0, 3.0)), st.integers(1, 25))
def test_every_finite_value_is_in_one_bin(values, bins):
    values = np.append(values, [np.nan, np.inf, -np.inf])
    counts = quality.binned_counts(values, 0.0, 1.0, bins)
    inner = values[(values >= 0.0) & (values < 1.0)]
    expected = np.bincount((inner * bins).astype(int), minlength=bins)
    expected[0] += np.count_nonzero(values[np.isfinite(values)] < 0.0)
    expected[-1] += np.count_nonzero(values[np.isfinite(values)] >= 1.0)
    np.testing.assert_array_equal(counts, expected)


def test_without_a_bin_nothing_is_counted():
    with pytest.raises(ValueError, match="no bin"):
        quality.binned_counts(np.ones(2), 1.0, 1.0, 3)
