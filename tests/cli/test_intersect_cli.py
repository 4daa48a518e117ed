"""``surfmesh intersect``: inputs by file or gallery name, what is kept, what is refused."""

import json

import cadquery as cq
import pytest

from surfmesh.cli import main


def test_a_torus_cut_by_a_plane(tmp_path, capsys):
    out = str(tmp_path / "cut.vtu")
    plane = tmp_path / "floor.toml"
    plane.write_text(
        'name = "floor"\nx = "u"\ny = "v"\nz = "0.3 + 0.01*u"\n[domain]\nu = [-5, 5]\n'
        "v = [-5.1, 5.2]\n"
    )
    argv = ["intersect", "torus", str(plane), "-o", out, "--size", "0.5", "--json"]
    assert main([*argv, "--keep", "torus=+floor", "--keep", "floor=0,0,0.3"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["clean"] and not report["closed"]
    assert report["files"]["mesh"] == out


@pytest.mark.parametrize(
    ("keep", "said"),
    [(["union"], "is not closed"), (["most"], "keep"), (["union", "torus=+wavy"], "NAME=SIDE")],
)
def test_what_cannot_be_kept_is_said_in_one_line(tmp_path, capsys, keep, said):
    argv = ["intersect", "wavy", "torus", "-o", str(tmp_path / "a.vtu")]
    for word in keep:
        argv += ["--keep", word]
    assert main(argv) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1


def test_patches_that_coincide_are_merged_on_request(tmp_path, capsys):
    text = 'name = "{}"\nx = "u"\ny = "v"\nz = "0"\n[domain]\nu = {}\nv = [-1, 1]\n'
    floors = [tmp_path / "one.toml", tmp_path / "other.toml"]
    for path, span in zip(floors, ("[-1, 1]", "[0, 2]")):
        path.write_text(text.format(path.stem, span))
    argv = ["intersect", *map(str, floors), "-o", str(tmp_path / "a.vtu"), "--size", "0.3"]
    assert main(argv) == 2
    assert "coincide on a patch through" in capsys.readouterr().err
    assert main([*argv, "--coincident", "merge", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["clean"]


def test_limits_of_reading_hold_for_cad_files_beside_formulas(tmp_path, capsys):
    part = tmp_path / "part.brep"
    cq.exporters.export(cq.Workplane().box(5, 5, 5), str(part))
    options = ["-o", str(tmp_path / "a.vtu"), "--size", "1", "--no-isolate"]
    assert main(["intersect", "wavy", "torus", *options]) == 2
    assert "isolate are of reading CAD files" in capsys.readouterr().err
    assert main(["intersect", "wavy", str(part), *options]) == 0
