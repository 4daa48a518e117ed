"""The same mesh gives the same files whenever they are written, and a manifest says so."""

import json
import time
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from handmade_meshes import Saddle, grid

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.errors import FileFormatError
from surfmesh.io import FORMATS, Manifest, read
from surfmesh.result.model_facts import file_sha256
from surfmesh.view import html_report, plot

LATER = 400 * 86400.0  # seconds


@pytest.fixture
def made():
    return grid(Saddle(), 6, sizes=np.full(49, 0.3), sizing=sm.Sizing(size=0.3))


@pytest.fixture
def later(monkeypatch):
    """Puts the clock of this process forward."""

    def forward():
        now = time.time
        monkeypatch.setattr(time, "time", lambda: now() + LATER)
        monkeypatch.setattr(time, "localtime", lambda *_: time.struct_time((2031, *[1] * 8)))

    return forward


def written(mesh, folder, seconds):
    folder.mkdir()
    for extension in FORMATS:
        mesh.save(folder / f"mesh{extension}")
    mesh.save(folder / "text.stl", ascii=True)
    plot(mesh, folder / "mesh.png", size=(160, 120))
    report = sm.check(replace(mesh, seconds={"packing": seconds}))
    html_report(mesh, folder / "mesh.html", report=report)
    packing = sm.pack(1.0, count=30)
    packing.plot(folder / "packing.svg")
    packing.plot(folder / "packing.png")
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_every_file_is_the_same_at_any_time(made, later, tmp_path):
    first = written(made, tmp_path / "now", 1.0)
    later()
    then = written(made, tmp_path / "then", 2.5)
    assert len(first) == len(FORMATS) + 5
    assert [name for name in first if first[name] != then[name]] == []


def test_pictures_painted_without_opengl_do_not_name_a_version(made, tmp_path, monkeypatch):
    from surfmesh.view import picture

    monkeypatch.setattr(picture, "can_draw", lambda: False)
    assert b"Matplotlib" not in plot(made, tmp_path / "a.png").read_bytes()


def test_a_date_that_is_asked_for_is_in_the_page_and_the_archive(made, tmp_path, monkeypatch):
    path, page = tmp_path / "mesh.3mf", tmp_path / "mesh.html"
    dates = {"1700000000": (2023, 11, 14, 22, 13, 20), "0": (1980, 1, 1, 0, 0, 0),
             "99999999999": (2107, 12, 31, 0, 0, 0), "": (1980, 1, 1, 0, 0, 0)}  # fmt: skip
    for said, date in dates.items():
        monkeypatch.setenv("SOURCE_DATE_EPOCH", said)
        with zipfile.ZipFile(made.save(path)) as archive:
            assert {entry.date_time for entry in archive.infolist()} == {date}
        assert len(read(path).triangles) == len(made.triangles)
    assert "UTC" not in html_report(made, page).read_text()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert "2023-11-14 22:13 UTC" in html_report(made, page).read_text()
    for said in ("yesterday", "-1", "1.5", "9" * 12, "9" * 5000):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", said)
        with pytest.raises(FileFormatError, match=r"SOURCE_DATE_EPOCH is .* seconds since 1970"):
            made.save(path)


def test_places_in_memory_are_in_no_report(made):
    sized = replace(made, sizing=sm.Sizing(size=lambda points: points[:, 0]))
    assert "<lambda>>" in sm.check(sized).to_json() and " at 0x" not in sm.check(sized).to_json()


def test_a_manifest_names_versions_options_and_hashes(made, tmp_path):
    path = made.save(tmp_path / "mesh.3mf")
    manifest = made.manifest(path)
    assert manifest.files == {"mesh.3mf": file_sha256(path)}
    assert manifest.mesh["sha256"] == sm.check(made).mesh_sha256
    assert manifest.options["sizing"]["size"] == 0.3
    assert {"surfmesh", "python", "numpy", "zlib"} <= set(manifest.versions)
    assert Manifest.read(manifest.save(tmp_path / "manifest.json")) == manifest
    text = (tmp_path / "manifest.json").read_text()
    assert str(tmp_path) not in text and made.manifest(path).to_json() + "\n" == text
    assert all(entry.agrees for entry in manifest.compared_with_folder(tmp_path))
    path.write_bytes(path.read_bytes()[:-1])
    assert [e.name for e in manifest.compared_with_folder(tmp_path) if not e.agrees] == ["mesh.3mf"]


def test_two_manifests_agree_entry_by_entry(made):
    one = made.manifest()
    other = replace(one, versions={**one.versions, "numpy": "1.0"})
    (entry,) = [entry for entry in one.compared(other) if not entry.agrees]
    assert (entry.section, entry.name, entry.there) == ("versions", "numpy", "1.0")
    assert not entry.decisive
    moved = replace(made, points=made.points + 1e-15)
    differ = {entry.name for entry in one.compared(moved.manifest()) if not entry.agrees}
    assert differ == {"sha256"}
    assert any(e.decisive and not e.agrees for e in one.compared(moved.manifest()))
    with pytest.raises(FileFormatError, match="names no files"):
        one.compared_with_folder(".")


SECTIONS = {name: {} for name in ("versions", "machine", "options", "inputs", "mesh", "files")}
WHOLE = {"manifest_version": 1, **SECTIONS, "mesh": {"sha256": "0"}}


@pytest.mark.parametrize(
    "content",
    ["", "[]", "null", "{}", "[" * 100_000, '{"manifest_version": 1}', "1" * 5000, b"\xff\xfe",
     WHOLE | {"manifest_version": 2}, WHOLE | {"files": []}, WHOLE | {"mesh": {}},
     WHOLE | {"files": {"../../etc/passwd": "0"}}, WHOLE | {"files": {"nul\0": "0"}},
     WHOLE | {"files": {"a": None}}],
    ids=lambda content: str(content)[-20:],
)  # fmt: skip
def test_what_is_no_manifest_is_refused_in_one_line(content, tmp_path, capsys):
    path = tmp_path / "manifest.json"
    text = json.dumps(content) if isinstance(content, dict) else content
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    assert main(["compare", str(path)]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith(f"surfmesh: {path}: ") and err.count("\n") == 1


def test_the_command_line_writes_and_compares_manifests(tmp_path, capsys):
    paths = [tmp_path / "here.json", tmp_path / "there.json"]
    argv = "mesh --x u --y v --z u*u-v*v --u -1 1 --v -1 1 --size 0.4 -o".split()
    argv += [str(tmp_path / "mesh.vtu"), "--report", str(tmp_path / "report.json")]
    for path in paths:
        assert main([*argv, "--manifest", str(path)]) == 0
    assert paths[0].read_bytes() == paths[1].read_bytes()
    found = Manifest.read(paths[0])
    assert list(found.files) == ["mesh.vtu"]  # the JSON report holds seconds
    assert found.options["x"] == "u" and found.options["sizing"]["size"] == 0.4
    capsys.readouterr()
    assert main(["compare", *map(str, paths)]) == 0
    assert "mesh and files are the same" in capsys.readouterr().out
    assert main(["compare", str(paths[0])]) == 0
    (tmp_path / "mesh.vtu").write_text("other")
    capsys.readouterr()
    assert main(["compare", str(paths[0])]) == 1
    out = capsys.readouterr().out
    assert "files      DIFFER: mesh.vtu" in out and "DIFFERENT FILES" in out
    assert main(["compare", str(paths[0]), str(tmp_path), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["same"] is False
    argv[-1] = str(paths[0])
    assert main([*argv, "--manifest", str(paths[0])]) == 2
    assert "is the place of the report already" in capsys.readouterr().err
