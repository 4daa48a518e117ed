"""The speed benchmark's own arithmetic: its models, its size law, figures that are missed."""

import sys

import numpy as np
import pytest

pytest.importorskip("OCP")
pytest.importorskip("psutil")
pytestmark = pytest.mark.usefixtures("benchmarks_in_path")


@pytest.mark.parametrize("faces", [11, 81])
def test_a_plate_has_the_faces_that_are_asked_for(faces, tmp_path):
    from speed_parts import plate, written

    assert plate(faces).faces().size() == faces
    assert written(tmp_path, faces).stat().st_size > 0


def test_the_sizes_of_the_plane_grow_fivefold():
    from speed_jobs import plane_sizes

    sizes = plane_sizes(0.01)(np.array([[0.5, 0.5], [0.0, 0.0], [1.0, 0.0]]))
    assert sizes == pytest.approx([0.01, 0.05, 0.05])


def test_a_size_is_changed_until_the_count_is_right():
    from speed_jobs import as_many

    def work(size):
        return None, np.empty((round(2.0 / size**2), 3))

    size = as_many(work, {"size": 0.1, "wanted": 1000})
    assert len(work(size)[1]) == pytest.approx(1000, rel=0.01)


def test_medians_and_shape():
    from speed_jobs import timed

    points = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, np.sqrt(0.75), 0], [9, 9, 9]])
    made = []

    def work():
        made.append(1)
        return points, np.array([[0, 1, 2]])

    found = timed({"times": 3}, work)
    assert len(made) == 4 and found["seconds"] >= 0.0
    assert found["triangles"] == 1 and found["alpha_min"] == pytest.approx(1.0)


def test_figures_are_printed_at_once_and_what_is_missed_is_counted(tmp_path, capsys):
    from speed import Figures
    from wanted import Wanted

    figures = Figures(tmp_path)
    for value, mark in ((1.0, "MISSED"), (3.0, "met"), (None, "")):
        figures.add(Wanted("times as fast", least=2.0), value, "said [of it]")
        line = capsys.readouterr().out
        assert "times as fast" in line and ">= 2.000" in line and "said [of it]" in line
        assert ("MISSED" in line, "met" in line) == (mark == "MISSED", mark == "met")
    assert figures.missed == 1


@pytest.mark.skipif(sys.platform == "win32", reason="make is played by a script")
def test_an_installation_is_timed_part_by_part(tmp_path, monkeypatch):
    import speed_install

    sources, commands = tmp_path / "sources", tmp_path / "commands"
    for folder in (sources / "build", commands):
        folder.mkdir(parents=True)
    log = "build/editable-test/.ninja_log"
    make = commands / "make"
    make.write_text(
        f"#!/bin/sh\nmkdir -p build/editable-test\nsleep 0.1\n"
        f"printf '# ninja log v6\\n0\\t2\\t0\\ta\\tb\\n1\\t4\\t0\\tc\\td\\n' > {log}\n"
    )
    make.chmod(0o755)
    monkeypatch.setattr(speed_install, "HERE", sources)
    monkeypatch.setenv("PATH", str(commands), prepend=":")
    found = speed_install.install(tmp_path, 60.0)
    assert list(found) == ["build", "install", "mesh"]
    assert found["build"] == 0.004 and min(found.values()) > 0.0
