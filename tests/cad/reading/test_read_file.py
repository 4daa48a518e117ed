"""Files are read in a child process; whatever is wrong with them ends as one clear line."""

import math
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

cq = pytest.importorskip("cadquery")

import shapes  # noqa: E402

import surfmesh as sm  # noqa: E402
from surfmesh.cad.reading.limits import Limits  # noqa: E402
from surfmesh.cad.reading.read_file import Child, begun_reading, read_cad  # noqa: E402
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
    assert model.broken_invariant() == ""
    assert (model.unit, model.file_unit, model.source) == ("cm", "mm", path.name)
    assert [child.name for child in model.tree.children] == ["here", "there"]
    assert model.tree.children[1].solids == (1,)
    assert model.volume == pytest.approx(12e-3)
    assert model.faces[0].colour == pytest.approx((1, 0, 0))
    assert model.faces[-1].colour == pytest.approx((0, 0, 1))
    assert {round(v.point[0], 9) for v in model.vertices} == {-0.05, 0.05, 0.45, 0.55}


def test_what_opencascade_calls_a_shape_without_a_name_is_no_name(tmp_path):
    path = tmp_path / "bracket.step"
    cq.exporters.export(cq.Workplane().box(1, 2, 3), str(path))
    model = read_cad(path)
    assert model.name == "bracket"
    assert sm.check(sm.mesh(model)).counts.surface == "bracket.step"


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
    sieve = cq.Workplane().box(9, 9, 1).rarray(1, 1, 8, 8).circle(0.3).cutThruAll()
    cq.exporters.export(sieve, str(tmp_path / "sieve.step"))
    with pytest.raises(CadError, match=r"sieve\.step was not read within 0\.01 s of processor"):
        read_cad(tmp_path / "sieve.step", time_limit=0.01)


def test_a_child_that_waits_for_the_processor_is_not_ended(tmp_path):
    program = CHILD.format("import time; time.sleep(1.0); answer = 'read'")
    assert answer_of([sys.executable, "-c", program], Limits(0.5, 100.0)) == "read"


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("while True: pass", r"not read within 0\.2 s .*time_limit=.*--time-limit, SURFMESH"),
        ("answer = len(bytearray(10**9))", "MemoryError"),
    ],
)
def test_limits_that_a_child_imposes_on_itself(program, words):
    if sys.platform == "win32" or ("Memory" in words and sys.platform != "linux"):
        pytest.skip("the system has no such limit")
    command = [sys.executable, "-c", CHILD.format(program)]
    with pytest.raises(CadError, match=words):
        answer_of(command, Limits(0.2, 50.0))


def answer_of(command, limits):
    child = Child(command, {}, "part.step", limits)
    try:
        return child.answer()
    finally:
        child.end()


CHILD = """
import json, pickle, sys
from surfmesh.cad.reading.limits import Limits
wanted = json.load(sys.stdin)
Limits(wanted["seconds"], wanted["megabytes"]).impose()
{}
pickle.dump(answer, sys.stdout.buffer)
"""


def test_limits_are_by_the_size_of_the_file_unless_said(tmp_path, monkeypatch):
    path = tmp_path / "part.step"
    path.write_bytes(b" " * 2_000_000)
    assert Limits.of(path, None, None, joins=False) == Limits(58.0, 1200.0)
    assert Limits.of(path, None, None, joins=True).seconds == 464.0
    monkeypatch.setenv("SURFMESH_READ_SECONDS", "7")
    monkeypatch.setenv("SURFMESH_READ_MEMORY", "inf")
    assert Limits.of(path, None, None, joins=False) == Limits(7.0, math.inf)
    assert Limits.of(path, 3, 50, joins=False) == Limits(3.0, 50.0)


@pytest.mark.parametrize("wrong", [0, -1.0, math.nan, "soon"])
def test_limits_that_are_none(tmp_path, monkeypatch, wrong):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with pytest.raises(CadError, match=r"time_limit is .*a positive number of seconds"):
        read_cad(tmp_path / "sphere.brep", time_limit=wrong)
    monkeypatch.setenv("SURFMESH_READ_MEMORY", str(wrong))
    with pytest.raises(CadError, match=r"SURFMESH_READ_MEMORY is .*a positive number of MB"):
        read_cad(tmp_path / "sphere.brep")


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("import os; os.abort()", r"crash \(SIGABRT, perhaps for want of memory: .*memory_limit="),
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", r"crash \(SIGSEGV\)"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "want of memory"),
        ("raise SystemExit('no such thing')", "fail: no such thing"),
        ("raise SystemExit('no Memory')", "fail: no Memory; allow more with memory_limit="),
        ("pass", "status 0"),
    ],
)
def test_a_child_that_dies(program, words):
    with pytest.raises(CadError, match=words):
        answer_of([sys.executable, "-c", program], Limits(30.0, 1000.0))


@pytest.mark.skipif(sys.platform == "win32", reason="has no such signal")
def test_the_child_dies_with_its_parent(tmp_path):
    child = tmp_path / "child.py"
    child.write_text(
        "import json, os, sys\n"
        "from surfmesh.cad.reading.lifeline import end_with\n"
        "end_with(json.load(sys.stdin)['parent'])\n"
        f"open({str(tmp_path / 'number')!r}, 'w').write(str(os.getpid()) + '.')\n"
        "while True: pass\n"
    )
    parent = tmp_path / "parent.py"
    parent.write_text(
        "import sys\n"
        "from surfmesh.cad.reading.read_file import Child\n"
        "from surfmesh.cad.reading.limits import Limits\n"
        f"Child([sys.executable, {str(child)!r}], {{}}, 'part.step', Limits(60.0, 1e3)).answer()\n"
    )
    where = {**os.environ, "TMPDIR": str(tmp_path)}
    process = subprocess.Popen([sys.executable, parent], env=where)
    try:
        number = _awaited(lambda: _written(tmp_path / "number"))
    finally:
        process.kill()
        process.wait()
    assert _awaited(lambda: not _lives(number))
    assert sorted(place.name for place in tmp_path.iterdir()) == ["child.py", "number", "parent.py"]


def _awaited(condition):
    """What ``condition`` gives as soon as it is true."""
    for _ in range(1200):
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError("nothing happened")


def _written(path):
    text = path.read_text() if path.exists() else ""
    return int(text[:-1]) if text.endswith(".") else None


def _lives(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{number}/stat")  # one that nobody has waited for is dead too
    return not (status.exists() and status.read_text().rpartition(")")[2].split()[0] == "Z")


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    monkeypatch.setattr("tempfile.tempdir", None)
    (tmp_path / "temporary").mkdir()
    with pytest.raises(CadError):
        answer_of([sys.executable, "-c", "pass"], Limits(30.0, 1000.0))
    assert list(Path(tmp_path, "temporary").iterdir()) == []


def test_a_trusted_file_is_read_without_a_child(tmp_path, monkeypatch, capfd):
    path = tmp_path / "whole.step"
    assembly().export(str(path))
    apart = read_cad(path, units="cm")
    monkeypatch.setattr(subprocess, "Popen", None)  # nothing can be started
    capfd.readouterr()
    here = read_cad(path, units="cm", isolate=False)
    assert capfd.readouterr().out == ""  # OCP talks
    assert here.sha256 == apart.sha256
    assert str(here.tree) == str(apart.tree)
    assert [face.area for face in here.faces] == [face.area for face in apart.faces]
    assert [tuple(v.point) for v in here.vertices] == [tuple(v.point) for v in apart.vertices]


def test_what_is_wrong_with_a_trusted_file_is_said_as_of_any_other(tmp_path, capfd):
    path = tmp_path / "damaged.step"
    assembly().export(str(path))
    path.write_bytes(path.read_bytes()[:2000])
    said = []
    for isolate in (True, False):
        with pytest.raises(CadError, match=r"damaged\.step") as caught:
            read_cad(path, isolate=isolate)
        said.append(str(caught.value))
    assert said[0] == said[1]
    assert capfd.readouterr().out == ""


def test_limits_beyond_what_the_system_counts(tmp_path):
    """The reader failed with an ``OverflowError``."""
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    assert read_cad(tmp_path / "sphere.brep", memory_limit=1e300, time_limit=1e300).faces


@pytest.mark.parametrize("limit", [{"time_limit": 1.0}, {"memory_limit": math.inf}])
def test_limits_need_a_child(tmp_path, limit):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with pytest.raises(CadError, match="hold in a child process alone"):
        read_cad(tmp_path / "sphere.brep", isolate=False, **limit)


def test_a_child_whose_model_is_not_wanted_is_ended(tmp_path):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    with begun_reading(tmp_path / "sphere.brep") as reading:
        process = reading._child._process
        assert process.poll() is None
    assert process.returncode != 0


def test_a_child_answers_once_its_parent_is_ready():
    program = CHILD.format("answer = 'read'")
    child = Child([sys.executable, "-c", program], {}, "part.step", Limits(5.0, 100.0))
    time.sleep(0.5)  # it has ended by now
    assert child.answer() == "read"
    child.end()


def test_the_child_loads_nothing_that_a_file_does_not_need(tmp_path):
    shapes.write_brep(shapes.bare_sphere(), tmp_path / "sphere.brep")
    code = (
        "import sys\nfrom surfmesh.cad.reading.read_file import read_cad\n"
        "assert 'numpy' not in sys.modules\n"  # so that the child starts at once
        f"read_cad({str(tmp_path / 'sphere.brep')!r}, isolate=False)\n"
        "print([m for m in ('scipy.interpolate', 'sympy', 'trimesh', 'vtkmodules', 'cadquery', "
        "'surfmesh.meshing', 'surfmesh.quality') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
