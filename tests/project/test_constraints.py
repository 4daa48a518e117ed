"""The files of constraints say what pyproject.toml allows: the tests' versions and the lowest."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
PYTHONS = ["3.11", "3.12", "3.13"]


def wanted(*extras):
    """What the project needs with these extras, but for itself."""
    texts = [*PROJECT["dependencies"], *(text for extra in extras for text in EXTRAS[extra])]
    return [r for r in map(Requirement, texts) if r.name != "surfmesh"]


def pinned(name, python="3.11"):
    """The version of each package that a file of constraints names for this Python, on Linux."""
    where = {"python_version": python, "python_full_version": f"{python}.7"}
    where |= {"sys_platform": "linux", "platform_python_implementation": "CPython"}
    where |= {"implementation_name": "cpython"}
    lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
    found = {}
    for line in lines:
        if line and not line.startswith("#"):
            pin = Requirement(line)
            (one,) = pin.specifier
            assert one.operator == "==", line
            if pin.marker is None or pin.marker.evaluate(where):
                assert canonicalize_name(pin.name) not in found, line
                found[canonicalize_name(pin.name)] = Version(one.version)
    return found


@pytest.mark.parametrize("python", PYTHONS)
def test_every_dependency_is_pinned_within_its_bounds(python):
    pins = pinned("constraints.txt", python)
    for requirement in wanted(*EXTRAS):
        version = pins[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version, prereleases=True), requirement


def test_the_lowest_versions_are_the_lowest_that_are_allowed():
    pins = pinned("constraints-lowest.txt")
    for requirement in wanted("cad", "view", "test"):
        (bound,) = (s.version for s in requirement.specifier if s.operator == ">=")
        version = pins[canonicalize_name(requirement.name)]
        lowest = Version(bound).release
        assert requirement.specifier.contains(version)
        assert version.release[: len(lowest)] == lowest, requirement


def test_every_dependency_has_a_lower_bound():
    for requirement in wanted(*EXTRAS):
        assert any(s.operator == ">=" for s in requirement.specifier), requirement


def test_the_tests_core_exists():
    text = (ROOT / "Makefile").read_text(encoding="utf-8").replace("\\\n", " ")
    (core,) = re.findall(r"^CORE := (.*)$", text, re.MULTILINE)
    assert len(core.split()) > 5
    assert [name for name in core.split() if not (ROOT / name).exists()] == []
