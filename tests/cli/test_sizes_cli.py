"""explain, estimate and files of sizes on the command line."""

import json

import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.errors import FileFormatError, SizingError
from surfmesh.sizing.options.sizes_file import read_sizes

SIZES = """
[sizes."*"]
size = 2
[[sizes."*".sources]]
near = [[0, 0, 15]]
size = 0.1
[[sizes."*".sources]]
ball = [5, 0, 0]
radius = 1
size = 0.5
[sizes.">Z"]
chord = 0.5
"""


@pytest.fixture
def folder(tmp_path):
    import cadquery as cq

    cq.exporters.export(cq.Workplane().box(10, 20, 30), str(tmp_path / "box.step"))
    (tmp_path / "sizes.toml").write_text(SIZES)
    return tmp_path


def test_files_of_sizes(folder):
    found = read_sizes(folder / "sizes.toml")
    assert list(found) == ["*", ">Z"] and found[">Z"].chord == 0.5
    assert [source.size for source in found["*"].sources] == [0.1, 0.5]


BROKEN = {
    "[sizes": (FileFormatError, "b.toml"),
    "[size]\nchord = 1": (FileFormatError, r"unknown table \[size\]"),
    "": (FileFormatError, "no table of sizes"),
    "[sizes.a]\nchrod = 1": (SizingError, "sizes of 'a': unknown size option 'chrod'"),
    "[[sizes.a.sources]]\nsize = 1": (SizingError, "one of near, lines, ball, box"),
    "[[sizes.a.sources]]\nball = [0, 0, 0]\nsize = 1": (SizingError, "source 'ball': .*radius"),
}


@pytest.mark.parametrize("text", BROKEN)
def test_files_that_are_refused(text, tmp_path):
    (tmp_path / "b.toml").write_text(text)
    error, message = BROKEN[text]
    with pytest.raises(error, match=message):
        read_sizes(tmp_path / "b.toml")


def test_explain_and_estimate(folder, capsys):
    model, sizes = str(folder / "box.step"), str(folder / "sizes.toml")
    assert main(["explain", model, "--at", "0", "-1", "15", "--sizes", sizes]) == 0
    printed = capsys.readouterr().out
    assert "'*' decides: source Near(1 points, size=0.1)" in printed and "on face" in printed
    assert main(["explain", model, "--at", "-5", "-1", "0", "--size", "1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["winner"]["rule"] == "size 1"
    assert main(["estimate", model, "--sizes", sizes, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["triangles"] == sm.estimate(sm.load(model), read_sizes(sizes)).triangles
    assert main(["estimate", "sphere", "--size", "0.1"]) == 0
    assert "triangles" in capsys.readouterr().out


def test_too_many_triangles_is_one_line(folder, capsys):
    out = folder / "a.vtu"
    argv = ["mesh", str(folder / "box.step"), "-o", str(out), "--size", "0.1", "--limit", "5000"]
    assert main(argv) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and "limit of 5,000" in printed.err and not out.exists()
