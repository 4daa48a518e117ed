"""Parameters all over a domain."""

from surfmesh.geometry.parameter_grid import parameter_grid


def test_u_runs_fastest_and_the_sides_are_among_them():
    found = parameter_grid(((0.0, 1.0), (2.0, 6.0)), 3).tolist()
    assert found[:4] == [[0.0, 2.0], [0.5, 2.0], [1.0, 2.0], [0.0, 4.0]]
    assert len(found) == 9 and found[-1] == [1.0, 6.0]
