"""Compiled kernels on disk: damaged files are made anew, and no folder is a must."""

import errno
import os
import stat
import warnings
from pathlib import Path

import pytest

from surfmesh.kernels import jit

pytestmark = pytest.mark.skipif(
    not hasattr(jit.kernel(lambda x: x), "_cache"), reason="kernels are not compiled"
)


def doubled(x):
    return 2 * x


class Run:
    """One process that calls the kernel: what it said, and whether it found it compiled."""

    def __init__(self, monkeypatch) -> None:
        monkeypatch.setattr(jit, "_said", set())
        jit._unusable.cache_clear()
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            kernel = jit.kernel(doubled)
            assert kernel(3) == 6
            self.found = bool(kernel.stats.cache_hits)
            if not self.found:
                assert kernel(3.5) == 7.0  # a second signature: still one word in all
        self.said = [str(word.message) for word in said]


@pytest.fixture
def run(monkeypatch, tmp_path):
    monkeypatch.setenv("SURFMESH_CACHE_DIR", str(tmp_path))
    return lambda: Run(monkeypatch)


@pytest.fixture
def files(run):
    """The index and the data of the kernel, for integers."""
    first = run()
    assert not first.found and first.said == []
    folder = jit.cache_folder()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700 and jit.compiled_before()
    (index,) = folder.glob("*.nbi")
    data = sorted(folder.glob("*.nbc"))
    assert run().found and run().said == []
    return index, data[0]


def spoilt(content: bytes) -> dict[str, bytes]:
    flipped = bytearray(content)
    flipped[len(content) // 2] ^= 1
    return {
        "empty": b"", "cut": content[: len(content) // 2], "one byte short": content[:-1],
        "one bit": bytes(flipped), "zeros": bytes(len(content)), "noise": os.urandom(300),
        "without checksum": content[32:],
    }  # fmt: skip


@pytest.mark.parametrize("which", [0, 1], ids=["index", "data"])
def test_a_damaged_file_is_made_anew_with_a_word(which, files, run):
    for content in spoilt(files[which].read_bytes()).values():
        files[which].write_bytes(content)
        again = run()
        (said,) = again.said
        assert not again.found and "damaged; they are made anew" in said
        assert run().found and run().said == []


def test_data_of_another_signature_is_not_run(files, run):
    """Two processes may have written to one name."""
    _, data = files
    other = next(path for path in data.parent.glob("*.nbc") if path != data)
    data.write_bytes(other.read_bytes())
    assert "damaged" in run().said[0]


def test_what_a_killed_process_has_left_is_made_good(files, run):
    index, data = files
    data.unlink()
    (index.parent / f"{data.name}.tmp.0123").write_bytes(b"half")
    again = run()
    assert not again.found and again.said == [] and run().found


def test_a_folder_in_the_place_of_a_file(files, run):
    index, _ = files
    index.unlink()
    index.mkdir()
    assert run().said and not run().found


def test_a_full_disk_keeps_nothing_and_says_so_once(run, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(jit._CheckedFiles, "_write", full)
    (said,) = run().said
    assert "No space left" in said and "SURFMESH_CACHE_DIR names another folder" in said


def test_half_a_file_is_left_by_no_limit(run, tmp_path):
    resource = pytest.importorskip("resource")
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, old[1]))
    try:
        (said,) = run().said
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)
    assert "File too large" in said and not list(jit.cache_folder().iterdir())


def test_a_folder_that_cannot_be_is_done_without(run, tmp_path, monkeypatch):
    file = tmp_path / "file"
    file.write_text("")
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    for place in (file, loop, tmp_path / "a\nb" / ("x" * 300), Path("/proc/none")):
        monkeypatch.setenv("SURFMESH_CACHE_DIR", str(place))
        (said,) = run().said
        assert said.startswith("compiled kernels cannot be kept in ")
        assert not jit.compiled_before() and not jit.keeps_kernels()


def test_without_a_home_kernels_are_compiled_in_memory(run, monkeypatch):
    def lost():
        raise RuntimeError("Could not determine home directory.")

    for name in ("SURFMESH_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", lost)
    assert "home directory" in run().said[0] and not jit.compiled_before()


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="needs owners of files")
def test_a_folder_of_others_is_not_used(files, run, monkeypatch):
    """What lies in it is run."""
    folder = jit.cache_folder()
    for mode in (0o770, 0o707, 0o777):
        folder.chmod(mode)
        again = run()
        assert not again.found and "others may write to it" in again.said[0]
    folder.chmod(0o755)  # read by others, written by us
    assert run().found
    monkeypatch.setattr(os, "getuid", lambda: folder.stat().st_uid + 1)
    again = run()
    assert not again.found and "belongs to another user" in again.said[0]
    monkeypatch.undo()
    monkeypatch.setenv("SURFMESH_CACHE_DIR", str(folder.parent / "linked"))
    (folder.parent / "linked").mkdir()
    jit.cache_folder().symlink_to(folder)
    assert "it is no folder" in run().said[0]
