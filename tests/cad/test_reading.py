"""Files are read in a child process; whatever is wrong with them ends as one clear line."""

import sys
from pathlib import Path

import pytest

cq = pytest.importorskip("cadquery")

import shapes  # noqa: E402

from surfmesh.cad.reading import answer_of, read_cad  # noqa: E402
from surfmesh.errors import CadError  # noqa: E402


def assembly():
    part = cq.Workplane().box(1, 2, 3)
    whole = cq.Assembly(name="whole")
    whole.add(part, name="here", color=cq.Color(1, 0, 0))
    whole.add(part, name="there", loc=cq.Location(cq.Vector(5, 0, 0)), color=cq.Color(0, 0, 1))
    return whole


def test_step_with_names_colours_and_places(tmp_path):
    path = tmp_path / "ünder world.step"  # neither blanks nor letters get in the way
    assembly().export(str(path))
    model = read_cad(path, units="cm")
    assert model.check() == ""
    assert (model.unit, model.file_unit, model.source) == ("cm", "mm", path.name)
    assert [child.name for child in model.tree.children] == ["here", "there"]
    assert model.tree.children[1].solids == (1,)
    assert model.volume == pytest.approx(12e-3)
    assert model.faces[0].colour == pytest.approx((1, 0, 0))
    assert model.faces[-1].colour == pytest.approx((0, 0, 1))
    assert {round(v.point[0], 9) for v in model.vertices} == {-0.05, 0.05, 0.45, 0.55}


def test_a_damaged_file(tmp_path):
    path = tmp_path / "damaged.step"
    assembly().export(str(path))
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(CadError, match=r"damaged\.step") as caught:
        read_cad(path)
    assert "\n" not in str(caught.value)


def test_what_is_no_file(tmp_path):
    (tmp_path / "empty.step").touch()
    (tmp_path / "folder.step").mkdir()
    for name, words in {
        "empty.step": "is empty",
        "folder.step": "is not a file",
        "missing.step": "there is no file",
        "part.sldprt": "not known as a CAD file",
    }.items():
        with pytest.raises(CadError, match=words):
            read_cad(tmp_path / name)


def test_an_unknown_unit_is_refused_before_anything_is_read(tmp_path):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with pytest.raises(CadError, match="one of um, mm"):
        read_cad(tmp_path / "sphere.brep", units="parsec")


def test_the_time_limit(tmp_path):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with pytest.raises(CadError, match=r"sphere\.brep was not read within 0\.05 s"):
        read_cad(tmp_path / "sphere.brep", time_limit=0.05)


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("import os; os.abort()", r"crash \(SIGABRT\)"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", r"crash \(SIGSEGV\)"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "want of memory"),
        ("raise SystemExit('no such thing')", "fail: no such thing"),
        ("pass", "status 0"),
    ],
)
def test_a_child_that_dies(tmp_path, program, words):
    with pytest.raises(CadError, match=words):
        answer_of([sys.executable, "-c", program], tmp_path / "result", "part.step", 30.0)


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    monkeypatch.setattr("tempfile.tempdir", None)
    (tmp_path / "temporary").mkdir()
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with pytest.raises(CadError):
        read_cad(tmp_path / "sphere.brep", time_limit=0.05)
    assert list(Path(tmp_path, "temporary").iterdir()) == []
