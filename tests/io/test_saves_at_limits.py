"""No file is lost: full disks, limits of file sizes, killed processes, places of every kind."""

import errno
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import pytest
from handmade_meshes import Saddle, grid

from surfmesh.errors import FileFormatError
from surfmesh.io import FORMATS, leftovers, read
from surfmesh.io.atomic import replacing

posix = pytest.mark.skipif(os.name == "nt", reason="Windows has other limits and permissions")


@pytest.fixture
def saves(benchmarks_in_path):
    """benchmarks/saves.py, which tries and judges."""
    pytest.importorskip("resource")
    import saves

    return saves


@pytest.fixture(scope="module")
def small():
    return grid(Saddle(), 12)


def judged(saves, suffix, write, folder, limits):
    folder.mkdir()
    row = saves.row_of(saves.Output(suffix, suffix, write), folder, limits, disks=2)
    assert row["how"] == [] and row["broken"] == 0
    assert row["tried"] >= limits and row["refused"] >= limits - 1


@posix
@pytest.mark.parametrize("extension", FORMATS)
def test_every_format_at_every_limit(extension, small, saves, tmp_path):
    judged(saves, extension, small.save, tmp_path / "saves", saves.LIMITS)


@posix
def test_text_page_picture_and_report_at_limits(small, saves, tmp_path):
    from surfmesh.cli.outputs import written
    from surfmesh.quality import check
    from surfmesh.view import html_report, plot

    report = check(small)
    writers = {
        ".stl": lambda path: small.save(path, ascii=True),
        ".html": lambda path: html_report(small, path, report=report),
        ".json": lambda path: written(report.to_json(), path),
        ".png": lambda path: plot(small, path, size=(160, 120)),
    }
    for suffix, write in writers.items():
        judged(saves, suffix, write, tmp_path / suffix, 6)


@pytest.fixture
def full_disk(small, tmp_path, saves):
    """A folder on a file system of 32 kB with an old mesh.vtu in it."""
    with saves._disk(tmp_path / "none", 32768) as disk:
        if disk is None:
            pytest.skip("no file system may be mounted here")
        (disk / "mesh.vtu").write_bytes(saves.OLD)
        yield disk


def test_a_disk_that_is_full_already(full_disk, small, saves):
    with open(full_disk / "rest", "wb", buffering=0) as file, pytest.raises(OSError):
        while file.write(bytes(4096)):
            pass
    for extension in FORMATS:
        with pytest.raises(FileFormatError, match=r"cannot be written: No space left on device"):
            small.save(full_disk / f"mesh{extension}")
    names = sorted(entry.name for entry in full_disk.iterdir())
    assert names == ["mesh.vtu", "rest"]
    assert (full_disk / "mesh.vtu").read_bytes() == saves.OLD


@pytest.mark.parametrize("raised", [KeyboardInterrupt, MemoryError, RuntimeError])
def test_whatever_is_raised_no_temporary_file_stays(raised, tmp_path):
    path = tmp_path / "mesh.stl"
    path.write_text("old")
    with pytest.raises(raised), replacing(path) as temporary:
        temporary.write_text("half")
        raise raised
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_disk_that_says_only_at_the_flush_that_it_is_full(tmp_path, small, monkeypatch):
    def full(descriptor):
        raise OSError(errno.EDQUOT, "Disk quota exceeded")

    path = small.save(tmp_path / "mesh.ply")
    old = path.read_bytes()
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileFormatError, match=r"mesh\.ply: cannot be written: Disk quota exceeded"):
        grid(Saddle(), 3).save(path)
    assert path.read_bytes() == old and list(tmp_path.iterdir()) == [path]


def killed_amid(path):
    """A process of its own that is killed while it writes ``path``; the file it leaves."""
    code = (
        "import sys, time\nfrom pathlib import Path\nfrom surfmesh.io.atomic import replacing\n"
        "with replacing(Path(sys.argv[1])) as temporary:\n"
        "    temporary.write_text('half')\n    print(temporary, flush=True)\n    time.sleep(60)"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True
    )
    return child, Path(child.stdout.readline().rstrip("\n"))


@posix
def test_what_a_killed_process_left_is_swept_up_and_what_a_living_one_writes_is_not(
    tmp_path, small
):
    child, temporary = killed_amid(tmp_path / "other.vtu")
    try:
        small.save(tmp_path / "mesh.stl")
        assert temporary.read_text() == "half"  # it is alive
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
        child.stdout.close()
    assert temporary.exists()
    small.save(tmp_path / "mesh.stl")
    assert [entry.name for entry in tmp_path.iterdir()] == ["mesh.stl"]


@posix
def test_what_another_machine_left_goes_after_an_hour(tmp_path):
    there = tmp_path / ".mesh-00000000-0123456789abcdef.surfmesh-tmp.vtu"
    there.write_text("half")
    assert leftovers.sweep(tmp_path) == []
    past = time.time() - leftovers.AGE - 60
    os.utime(there, (past, past))
    assert leftovers.sweep(tmp_path) == [there] and not there.exists()


def test_files_of_the_user_are_not_swept_up(tmp_path):
    names = (".mesh-0123abcd.vtu", "mesh.surfmesh-tmp.vtu", ".surfmesh-tmp", ".a.surfmesh-tmp.stl",
             "x-00000000-0123456789abcdef.surfmesh-tmp.vtu")  # fmt: skip
    for name in names:
        (tmp_path / name).write_text("mine")
        os.utime(tmp_path / name, (0, 0))
    (tmp_path / ".a-00000000-0123456789abcdef.surfmesh-tmp").mkdir()
    os.symlink(tmp_path / names[0], tmp_path / ".b-00000000-0123456789abcdef.surfmesh-tmp")
    assert leftovers.sweep(tmp_path) == []
    assert len(list(tmp_path.iterdir())) == len(names) + 2


def test_savers_at_once_do_not_disturb_each_other(tmp_path):
    """Threads that save to one file, each of which sweeps the folder as it starts."""
    meshes, failed = [grid(Saddle(), n) for n in (3, 5, 8)], []
    path = tmp_path / "mesh.ply"

    def save(mesh):
        try:
            for _ in range(15):
                mesh.save(path)
                assert len(read(path).triangles) in {len(m.triangles) for m in meshes}
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=save, args=(mesh,)) for mesh in meshes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == [] and list(tmp_path.iterdir()) == [path]


@posix
def test_a_link_is_followed(tmp_path, small):
    for folder in ("there", "here"):
        (tmp_path / folder).mkdir()
    real, link = tmp_path / "there" / "real.stl", tmp_path / "here" / "link.stl"
    link.symlink_to("../there/real.stl")
    small.save(link)  # nothing at its end yet
    small.save(link)
    assert link.is_symlink() and len(read(real).triangles) == len(small.triangles)
    assert list((tmp_path / "here").iterdir()) == [link]
    assert list((tmp_path / "there").iterdir()) == [real]


@posix
@pytest.mark.parametrize("end", ["real.vtp", "real", "a long name without an end.of it all"])
def test_the_format_is_that_of_the_link(end, tmp_path, small):
    link = tmp_path / "link.vtu"
    link.symlink_to(end)
    small.save(link)
    assert len(read(link).triangles) == len(small.triangles)
    assert b"UnstructuredGrid" in (tmp_path / end).read_bytes()


@posix
def test_a_new_file_permits_what_the_old_one_did(tmp_path, small):
    path = tmp_path / "mesh.stl"
    before = os.umask(0o027)
    try:
        assert small.save(path).stat().st_mode & 0o777 == 0o640
        for mode in (0o600, 0o664, 0o755):
            path.chmod(mode)
            assert small.save(path).stat().st_mode & 0o777 == mode
    finally:
        os.umask(before)


@posix
@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda path: os.mkfifo(path), "is a device or a pipe; only a file can be written"),
        (lambda path: path.symlink_to("/dev/null"), "is a device or a pipe"),
        (lambda path: path.symlink_to(path), "Too many levels of symbolic links"),
        (lambda path: path.symlink_to("nowhere/x.stl"), "does not exist"),
    ],
)
def test_places_that_are_no_files(make, said, tmp_path, small):
    path = tmp_path / "mesh.stl"
    make(path)
    with pytest.raises(FileFormatError, match=said) as caught:
        small.save(path)
    assert str(caught.value).startswith(f"{path}: ") and "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == [path]


@posix
def test_names_that_no_file_can_have(tmp_path, small):
    for name in ("n" * 300 + ".stl", "nul\0.stl"):
        with pytest.raises(FileFormatError, match="cannot be written"):
            small.save(tmp_path / name)
    longest = small.save(tmp_path / ("é" * 125 + ".stl"))  # 254 bytes
    other = small.manifest().save(tmp_path / ("m." + "é" * 126))
    assert set(tmp_path.iterdir()) == {longest, other}


@posix
def test_a_file_that_is_read_only_stays(tmp_path, small, monkeypatch):
    path = small.save(tmp_path / "mesh.stl")
    if os.geteuid() == 0:  # who may write everything
        may = os.access
        monkeypatch.setattr(os, "access", lambda at, mode: at != path and may(at, mode))
    path.chmod(0o444)
    with pytest.raises(FileFormatError, match="the file is read-only"):
        small.save(path)


@posix
def test_the_command_line_refuses_in_one_line_and_says_what_was_written(tmp_path, saves, small):
    mesh, page = tmp_path / "mesh.stl", tmp_path / "page.html"
    argv = "mesh --x u --y v --z u*u-v*v --u -1 1 --v -1 1 --size 0.8 -o".split()
    small.save(mesh)  # what is imported or compiled is so before there is a limit
    old = mesh.read_bytes()
    first = limited(saves, 0, [*argv, str(mesh)])
    assert first == (2, "", f"surfmesh: {mesh}: cannot be written: File too large\n")
    assert mesh.read_bytes() == old
    second = limited(saves, 20_000, [*argv, str(mesh), "--report", str(page)])
    said = f"surfmesh: {page}: cannot be written: File too large; written before it: {mesh}\n"
    assert second == (2, "", said)
    assert len(read(mesh).triangles) > 0 and list(tmp_path.iterdir()) == [mesh]


def limited(saves, size, argv):
    """Exit status, output and errors of the command line while files may have ``size`` bytes."""
    from surfmesh.cli import main

    out, err = StringIO(), StringIO()
    with redirect_stdout(out), redirect_stderr(err), saves._largest_file(size):
        status = main(argv)
    return status, out.getvalue(), err.getvalue()


@posix
def test_processes_of_surfmesh_live_on_at_a_limit():
    """SIGXFSZ would end them; Python ignores it, in children that Python starts as well."""
    code = "import signal, surfmesh.cli; print(signal.getsignal(signal.SIGXFSZ) == signal.SIG_IGN)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"
