"""What the caller hears while meshing: progress that can stop the work, and a quiet log."""

import logging
import subprocess
import sys

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.errors import Cancelled, SurfmeshError

PLATE = sm.PlanarDomain([(0, 0), (4, 0), (4, 3), (0, 3)])
THINGS = {
    "surface": (lambda: sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=(-1, 1)), 0.1),
    "plane": (lambda: PLATE, 0.3),
    "model": (lambda: sm.from_cadquery(cq.Workplane().box(1, 2, 3).faces(">Z").fillet(0.1)), 0.3),
}


@pytest.mark.parametrize("kind", THINGS)
def test_shares_never_fall_and_end_at_one(kind):
    make, sizes = THINGS[kind]
    heard = []
    sm.mesh(make(), sizes, progress=lambda *said: heard.append(said))
    fractions = [fraction for _, fraction in heard]
    assert fractions == sorted(fractions) and fractions[0] == 0.0 and fractions[-1] == 1.0
    stages = {stage for stage, _ in heard}
    assert stages >= {"sizing", "faces" if kind == "model" else "packing", "mapping"}
    assert len(set(fractions)) > 6  # faces and passes are heard of, not only stages


@pytest.mark.parametrize(
    "options",
    [dict(triangles=200), dict(chord=0.1, order=2), dict(chord=0.1, vertices="balanced")],
    ids=["triangles", "order 2", "balanced"],
)
def test_it_ends_at_one_where_there_is_more_to_do_after_a_mesh(options):
    heard = []
    sm.mesh(THINGS["surface"][0](), **options, progress=lambda *said: heard.append(said))
    fractions = [fraction for _, fraction in heard]
    assert fractions == sorted(fractions) and fractions.count(1.0) == 1


def test_faces_are_most_of_the_work_of_a_model():
    heard = []
    sm.mesh(THINGS["model"][0](), 0.3, progress=lambda *said: heard.append(said), jobs=1)
    last = max(fraction for stage, fraction in heard if stage == "faces")
    assert last == pytest.approx(0.9) and "packing" not in dict(heard)


@pytest.mark.parametrize("kind", THINGS)
@pytest.mark.parametrize("no", [False, np.False_])
def test_saying_no_stops_at_any_call(kind, no):
    make, sizes = THINGS[kind]
    thing, heard = make(), []
    sm.mesh(thing, sizes, progress=lambda *said: heard.append(said))
    for last in range(1, len(heard) + 1):
        calls = []

        def progress(*said, calls=calls, last=last):
            calls.append(said)
            return no if len(calls) == last else None

        with pytest.raises(Cancelled, match=calls[-1][0] if calls else "stopped"):
            sm.mesh(thing, sizes, progress=progress)
        assert len(calls) == last
    assert issubclass(Cancelled, SurfmeshError)


@pytest.mark.parametrize("answer", [None, True, 0, "", []])
def test_any_other_answer_goes_on(answer):
    assert sm.mesh(PLATE, 1.0, progress=lambda *_: answer) is not None


def test_what_progress_raises_comes_through():
    class Enough(Exception):
        pass

    def progress(stage, fraction):
        if stage == "boundary":
            raise Enough

    with pytest.raises(Enough):
        sm.mesh(PLATE, 0.5, progress=progress)


def test_a_stopped_command_leaves_no_file(tmp_path, monkeypatch, capsys):
    from surfmesh.cli.progress import ProgressBar

    monkeypatch.setattr(ProgressBar, "__call__", lambda self, stage, fraction: fraction < 0.5)
    argv = "mesh --x u --y v --z u*v --u 0 1 --v 0 1 --size 0.2 -o".split()
    assert main([*argv, str(tmp_path / "a.vtu"), "--picture", str(tmp_path / "a.png")]) == 2
    assert list(tmp_path.iterdir()) == []
    assert "stopped" in capsys.readouterr().err


def test_stages_and_warnings_reach_the_log(caplog):
    with caplog.at_level(logging.INFO, logger="surfmesh"):
        mesh = sm.mesh(sm.PlanarDomain([(0, 0), (1, 0), (1, 1)], name="corner"), 0.3)
    said = [record.getMessage() for record in caplog.records]
    for stage in mesh.seconds:
        assert any(line.startswith(f"{stage}: ") for line in said)
    assert said[-1].startswith(f"corner: {len(mesh.points)} nodes, {len(mesh.triangles)} triangles")
    assert {record.name.split(".")[0] for record in caplog.records} == {"surfmesh"}


def test_warnings_reach_the_log(caplog, monkeypatch):
    from surfmesh.meshing import planar_mesh

    real = planar_mesh.mesh_planar

    def warned_mesh(*given):
        return real(*given).with_warnings("a hair's breadth")

    monkeypatch.setattr(planar_mesh, "mesh_planar", warned_mesh)
    sm.mesh(PLATE, 1.0)
    warned = [record for record in caplog.records if record.levelno == logging.WARNING]
    assert [record.getMessage() for record in warned] == [f"{PLATE.name}: a hair's breadth"]


def test_the_library_is_silent_by_default():
    code = (
        "import logging, surfmesh as sm\n"
        "logging.getLogger('surfmesh').warning('x')\n"
        "sm.mesh(sm.PlanarDomain([(0, 0), (1, 0), (1, 1)]), 0.5)\n"
        "assert logging.root.handlers == [], logging.root.handlers\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == done.stderr == ""
