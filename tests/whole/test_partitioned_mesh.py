"""Pieces that workers write: the mesh that is read is the one of a single process, bit for bit."""

import os
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from threading import Thread
from time import sleep

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh import partitioned_mesh
from surfmesh.errors import FileFormatError, MeshingError, SizingError
from surfmesh.io import leftovers, pvtu, read
from surfmesh.meshing.faces import partitions
from surfmesh.partitioned_mesh import mesh_into_pieces

SIZE = 0.4
ARRAYS = (
    "points", "triangles", "uv_points", "uv_triangles", "face_ids", "edge_segments", "edge_ids",
    "vertex_ids", "sizes", "solid_ids", "metric_root_3d", "promises",
)  # fmt: skip


@pytest.fixture(scope="module")
def model():
    part = cq.Workplane().box(4, 3, 1).faces(">Z").workplane().hole(1).edges("|Z").fillet(0.3)
    return sm.from_cadquery(part)


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch):
    monkeypatch.setattr(pvtu, "LARGEST", 200)


def require_same(found, expected, folder):
    expected = read(expected.save(folder / "expected.vtu"))
    for name in ARRAYS:
        ours, theirs = getattr(found, name), getattr(expected, name)
        assert (ours is None) == (theirs is None), name
        if ours is not None:
            assert np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f"), name
    assert found.groups == expected.groups


@pytest.mark.parametrize(
    "sizing", [SIZE, sm.Sizing(chord=0.01, anisotropy=3.0), {"type:plane": 0.5, "*": 0.3}]
)
def test_the_same_mesh(model, sizing, tmp_path):
    with ThreadPoolExecutor(2) as executor:
        found = mesh_into_pieces(tmp_path / "part.pvtu", model, sizing, executor)
    whole = sm.mesh(model, sizing)
    require_same(read(found.path), whole, tmp_path)
    report = sm.check(whole)
    assert (found.nodes, found.triangles) == (len(whole.points), len(whole.triangles))
    assert found.pieces == len(list((tmp_path / "part.pvtu.pieces").iterdir())) > 1
    assert found.area == pytest.approx(report.area, rel=1e-12)
    assert found.alpha_min == report.alpha_min and found.clean
    assert found.deviation == pytest.approx(report.deviation_max, rel=0.2)
    assert str(found.triangles) in str(found).replace(",", "")


def test_thin_walls_and_faces_that_fail(tmp_path):
    wall = sm.from_cadquery(cq.Workplane().circle(2).circle(1.99).extrude(1))
    sizing = sm.Sizing(chord=0.05)
    with ThreadPoolExecutor(1) as executor:
        found = mesh_into_pieces(tmp_path / "wall.pvtu", wall, sizing, executor, strict=False)
    whole = sm.mesh(wall, sizing, strict=False)
    require_same(read(found.path), whole, tmp_path)
    assert found.warnings == whole.warnings


@pytest.mark.skipif(os.name == "nt", reason="a worker is killed by a signal")
def test_two_machines_one_of_them_killed_half_way(model, tmp_path):
    distributed = pytest.importorskip("distributed", reason="Dask is not installed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:  # fmt: skip
        victim = next(iter(client.run(os.getpid).values()))

        def kill() -> None:
            for _ in range(6000):
                if any(tmp_path.glob("*.pieces/faces-*/*.npz")):  # the first face is done
                    break
                sleep(0.01)
            os.kill(victim, signal.SIGKILL)

        killer = Thread(target=kill)
        killer.start()
        found = mesh_into_pieces(tmp_path / "part.pvtu", model, SIZE, client.get_executor())
        killer.join()
    require_same(read(found.path), sm.mesh(model, SIZE), tmp_path)


def test_processes(model, tmp_path):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        found = mesh_into_pieces(str(tmp_path / "part.pvtu"), model, SIZE, executor)
    require_same(read(found.path), sm.mesh(model, SIZE), tmp_path)


def test_workers_that_do_not_share_the_folder_are_told(model, tmp_path, monkeypatch):
    def elsewhere(mark):
        file = leftovers.held(mark)
        mark.unlink()
        return file

    monkeypatch.setattr(partitioned_mesh, "held", elsewhere)
    with ThreadPoolExecutor(1) as executor, pytest.raises(MeshingError, match="share"):
        mesh_into_pieces(tmp_path / "part.pvtu", model, SIZE, executor)
    assert list(tmp_path.iterdir()) == []


def test_faces_of_killed_callers_are_swept(model, tmp_path):
    """A caller that ends without a word leaves its folder; one that lives keeps it."""
    script = (
        "import os, sys; from pathlib import Path; from surfmesh.io import pvtu, leftovers\n"
        "from surfmesh.meshing.faces.partitions import FaceStore\n"
        "store = FaceStore.made_in(pvtu.folder_of(Path(sys.argv[1])))\n"
        "held = leftovers.held(store.mark); Path(store.folder, 'face.npz').touch(); os._exit(9)"
    )
    target = tmp_path / "part.pvtu"
    subprocess.run([sys.executable, "-c", script, str(target)], check=False)
    (left,) = partitions.FaceStore.all_in(pvtu.folder_of(target))
    alive = partitions.FaceStore.made_in(pvtu.folder_of(target))
    with leftovers.held(alive.mark), ThreadPoolExecutor(1) as executor:
        found = mesh_into_pieces(target, model, SIZE, executor)
        assert not Path(left.folder).exists() and alive.mark.is_file()
    alive.remove()
    require_same(read(found.path), sm.mesh(model, SIZE), tmp_path)


def test_a_failure_leaves_the_old_mesh(model, tmp_path, monkeypatch):
    def fail(*_):
        raise FileFormatError("No space left on device")

    with ThreadPoolExecutor(1) as executor:
        mesh_into_pieces(tmp_path / "part.pvtu", model, SIZE, executor)
        before = {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
        monkeypatch.setattr(partitioned_mesh, "_written", fail)
        with pytest.raises(FileFormatError, match="No space left"):
            mesh_into_pieces(tmp_path / "part.pvtu", model, 0.5, executor)
    assert {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()} == before


def test_what_needs_the_whole_mesh_is_refused(model, tmp_path):
    with ThreadPoolExecutor(1) as executor, pytest.raises(SizingError, match="whole mesh"):
        sizing = sm.Sizing(volume=0.01)
        mesh_into_pieces(tmp_path / "part.pvtu", model, sizing, executor)


@pytest.mark.parametrize("option", ["--flip", "--simplify", "--order=2"])
def test_the_command_refuses_what_needs_the_whole_mesh(
    option, model, tmp_path, capsys, monkeypatch
):
    from contextlib import contextmanager

    from surfmesh import cli
    from surfmesh.cli import commands

    @contextmanager
    def two_threads(address):
        with ThreadPoolExecutor(2) as executor:
            yield executor

    monkeypatch.setattr(commands, "executor_of", two_threads)
    part, path = tmp_path / "part.step", tmp_path / "part.pvtu"
    cq.exporters.export(cq.Workplane().box(1, 1, 1), str(part))
    typed = ["mesh", str(part), "-o", str(path), "--size", "0.3", "--scheduler", "tcp://here:1"]
    assert cli.main([*typed, option]) == 2
    assert "needs the whole mesh" in capsys.readouterr().err and not path.exists()
    assert cli.main(typed) == 0
    assert "not looked at: topology" in capsys.readouterr().out
    assert cli.main(["check", str(path)]) == 0
