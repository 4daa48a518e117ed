"""Foreign programs take our files: rows of benchmarks/clients.py, where they are installed."""

import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("OCP", reason="the parts are CAD models: OCP is not installed")
BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
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


@pytest.fixture(scope="module", autouse=True)
def benchmarks_in_path():
    sys.path.insert(0, str(BENCHMARKS))
    yield
    sys.path.remove(str(BENCHMARKS))


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
