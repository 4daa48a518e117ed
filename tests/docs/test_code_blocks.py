"""Every fenced block of code in README.md, CONTRIBUTING.md and docs/ does what it says.

The blocks of a page are run in their order: python in one namespace, sh through the command line,
toml as files of surfaces or of sizes; all in an empty folder with a bracket.step and an
outline.svg.
"""

import logging
import os
import re
import shlex
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import cadquery as cq
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.sizing.options.sizes_file import read_sizes

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
FOLDERS = ("surfmesh", "tests", "benchmarks", "docs", "notebooks", "tools")
FILES = [str(path.relative_to(ROOT)) for name in FOLDERS for path in (ROOT / name).rglob("*.py")]
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NEEDED = {"to-a-solver": ("tetgen", "gmsh")}
WITHOUT = {"README": ("tetgen", "meshio", "h5py", "distributed")}  # which make venv leaves out
SHOWN_ONLY = {"", "text", "{toctree}", "{eval-rst}"}
SQUARE = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0 H4 V3 H0 Z"/></svg>'


def blocks(page):
    """(language, code, line) of every fenced block."""
    text = page.read_text(encoding="utf-8")
    for found in FENCE.finditer(text):
        yield found[1].strip(), found[2], text.count("\n", 0, found.start()) + 2


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    part = cq.Workplane().box(20, 10, 4).faces(">Z").workplane().hole(5)
    cq.exporters.export(part, "bracket.step")
    Path("outline.svg").write_text(SQUARE, encoding="utf-8")
    logger = logging.getLogger("surfmesh")
    handlers, level = logging.root.handlers[:], logger.level
    yield tmp_path
    logging.root.handlers[:] = handlers
    logger.setLevel(level)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_code_of_a_page_runs(page, folder, monkeypatch):
    for package in WITHOUT.get(page.stem, ()):
        monkeypatch.setitem(sys.modules, package, None)
    for package in NEEDED.get(page.stem, ()):
        try:
            import_module(package)
        except (ImportError, OSError) as error:  # OSError: a library of the system is missing
            pytest.skip(f"{package}: {error}")
    names = {"__name__": f"docs.{page.stem}"}
    for language, code, line in blocks(page):
        if language == "python":
            # padded, so that a traceback names the line of the page
            exec(compile("\n" * (line - 1) + code, str(page), "exec"), names)
        elif language == "sh":
            for command in code.replace("\\\n", " ").splitlines():
                words = shlex.split(command, comments=True)
                assert words[0] == "surfmesh", command
                assert main(words[1:]) == 0, command
        elif language == "toml" and "[sizes." in code:
            (folder / "sizes.toml").write_text(code, encoding="utf-8")
            read_sizes(folder / "sizes.toml")
        elif language == "toml":
            (folder / "page.toml").write_text(code, encoding="utf-8")
            sm.load(folder / "page.toml")
        else:
            assert language in SHOWN_ONLY, f"{page.name}:{line}: nobody runs {language!r}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_points_at_is_there(page):
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)#\s]+)", text):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name}: {target}"
    for module in re.findall(r"`([a-z0-9_./]+\.py)[` ]", text):
        assert any(f"/{path}".endswith(f"/{module}") for path in FILES), f"{page.name}: {module}"
    for folder in re.findall(r"`([a-z0-9_./]+)/`", text):
        assert any((ROOT / top / folder).is_dir() for top in ("", "surfmesh")), folder
    for path in re.findall(r"`(src/[a-z0-9_/]+?)(?:\.[hc]pp|/)?`", text):
        assert (ROOT / path).is_dir() or list(ROOT.glob(f"{path}.[hc]pp")), f"{page.name}: {path}"


def test_every_public_name_is_in_the_reference():
    reference = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    for name in set(sm.__all__) - {"__version__"}:
        assert re.search(rf"surfmesh\.{name}\b", reference), name
    for name in re.findall(r"auto(?:function|class):: surfmesh\.([\w.]+)", reference):
        thing = sm
        for part in name.split("."):
            if not hasattr(thing, part):
                __import__(f"{thing.__name__}.{part}")
            thing = getattr(thing, part)
        assert thing.__doc__, name


def test_the_pages_build_without_a_warning(tmp_path):
    """``make docs``, but for running the notebooks, which have tests of their own."""
    options = ["-q", "-W", "-b", "html", "-D", "nb_execution_mode=off"]
    options += ["-d", str(tmp_path / "read")]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, str(ROOT / "docs"), str(tmp_path / "pages")],
        capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    api = (tmp_path / "pages" / "api.html").read_text(encoding="utf-8")
    assert 'id="surfmesh.NumericSurface"' in api and 'id="surfmesh.errors.Cancelled"' in api
