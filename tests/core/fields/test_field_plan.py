"""Cells that the search for a size field starts from."""

import numpy as np
import pytest

from surfmesh._core.fields import GRID_DEPTH, root_grid, small_sources


def test_small_cells_lie_at_their_places():
    rng = np.random.default_rng(3)
    extent, grid = (3.0, 2.0), (6, 5)
    places = rng.uniform(0.0, 1.0, (200, 2)) * extent
    sizes = 10.0 ** rng.uniform(-7.0, 1.0, 200)
    step = np.array(extent) / grid
    found = small_sources(places, sizes, grid, extent)
    unit = 1 << GRID_DEPTH
    assert np.array_equal(found[:, :2], (places / step * unit).astype(np.int64))
    depth = np.ceil(np.log2(0.5 * step.max() / sizes))
    assert np.array_equal(found[:, 2], np.clip(depth, 0, GRID_DEPTH))


def test_cells_halve_until_they_are_no_wider_than_the_size():
    width = 0.5  # half of a root cell
    sizes = np.array([2.0, 1.0, 0.5, 0.5 * (1.0 - 1e-15), 0.25, 0.2, 1e-300, np.inf])
    depth = small_sources(np.zeros((8, 2)), sizes, (1, 1), (2.0 * width, 1.0))[:, 2]
    assert depth.tolist() == [0, 0, 0, 1, 1, 2, GRID_DEPTH, 0]


def test_places_beyond_the_plane_are_moved_to_it():
    places = np.array([[-1.0, 0.5], [9.0, 1.0]])
    found = small_sources(places, np.ones(2), (4, 2), (2.0, 1.0))
    assert found[:, :2].tolist() == [[0, 1 << GRID_DEPTH], [(4 << GRID_DEPTH) - 1,
                                                            (2 << GRID_DEPTH) - 1]]  # fmt: skip


def test_wrong_arguments_are_refused():
    with pytest.raises(ValueError, match="no plane"):
        root_grid((0.0, 1.0), 64)
    with pytest.raises(ValueError, match="no grid"):
        small_sources(np.zeros((1, 2)), np.ones(1), (0, 1), (1.0, 1.0))
    with pytest.raises(ValueError, match="not finite"):
        small_sources(np.array([[np.nan, 0.0]]), np.ones(1), (1, 1), (1.0, 1.0))
    with pytest.raises(ValueError, match="sizes"):
        small_sources(np.zeros((1, 2)), np.ones(2), (1, 1), (1.0, 1.0))
