"""Foreign programs take our files: rows of benchmarks/clients.py, where they are installed."""

import re

import pytest

pytest.importorskip("OCP", reason="the parts are CAD models: OCP is not installed")
pytestmark = pytest.mark.usefixtures("benchmarks_in_path")
EXPECTED = {  # what the row says, and within which limits its numbers are
    "imprint": (r"(\d+) of 11 names, (\d+) of 19 pairs conformal, (\d+) others", (11, 19, 0), 0),
    "CalculiX shell": (
        r"ratio 0: .*, ([\d.]+) mm, theory of beams ([\d.]+)",
        (0.1905, 0.1905),
        0.05,
    ),
    "CalculiX shell, order 2": (
        r"tip ([\d.]+) mm, theory of beams ([\d.]+)",
        (0.1905, 0.1905),
        0.02,
    ),
    "OpenFOAM": (r"(\d+) regions by name, closed$", (6,), 0),
    "pyNastran": (r"(\d+) elements, (\d+) properties, cross-referenced", None, 0),
    "lib3mf": (r"read with (\d+) warnings", (0,), 0),
    "mmg": (r"(\d+) triangles", None, 0),
    "manifold3d": (r"NoError, volume ([\d.]+)", (16,), 1e-12),
    "capytaine": (r"balanced panels ([\d.]+) / ([\d.]+)", (0.831, 0.5), 0.005),
}


@pytest.mark.parametrize("name", EXPECTED)
@pytest.mark.filterwarnings("ignore")
def test_a_program_takes_what_we_write(name, tmp_path):
    from clients import CLIENTS

    try:
        told = CLIENTS[name](tmp_path)
    except (ImportError, FileNotFoundError) as error:
        pytest.skip(f"{name} is not installed: {error}")
    pattern, values, tolerance = EXPECTED[name]
    found = re.search(pattern, told)
    assert found, told
    if values is not None:
        assert [float(word) for word in found.groups()] == pytest.approx(values, rel=tolerance)
