"""The command line: exit statuses, one line for every mistake, nothing half done."""

import json
import subprocess
import sys
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from handmade_meshes import Saddle, grid

from surfmesh import api
from surfmesh.cli import main
from surfmesh.cli.arguments import parse
from surfmesh.cli.progress import ProgressBar
from surfmesh.io import read


@pytest.fixture
def stand_in(monkeypatch):
    """A mesher that gives a grid; ``asked`` collects what it was called with."""
    asked = []

    def mesh(surface, sizing=None, *, optimise=True, progress=None, **_):
        asked.append((surface, sizing, optimise))
        progress("packing", 0.5)
        return grid(Saddle(), 10, sizing=sizing, sizes=np.full(121, 0.25))

    monkeypatch.setattr(api, "mesh", mesh)
    return asked


SADDLE = "--x u --y v --z u*u-v*v --u -1 1 --v -1 1".split()


def test_mesh_writes_what_was_asked(stand_in, tmp_path, capsys):
    mesh, picture, report = (str(tmp_path / name) for name in ("a.vtu", "a.png", "a.json"))
    argv = ["mesh", *SADDLE, "-o", mesh, "--chord", "0.1", "--picture", picture, "--report", report]
    assert main([*argv, "--no-optimise"]) == 0
    surface, sizing, optimise = stand_in[0]
    assert surface.domain == ((-1, 1), (-1, 1)) and surface.name == "a"
    assert sizing.chord == 0.1 and not optimise
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a.json", "a.png", "a.vtu"]
    assert len(read(mesh).triangles) == 200
    assert json.loads((tmp_path / "a.json").read_text())["triangles"] == 200
    printed = capsys.readouterr()
    assert printed.err == "" and "200 triangles - clean" in printed.out and mesh in printed.out


def test_order_2_and_ascii_are_asked_for_by_name(tmp_path, capsys):
    path = str(tmp_path / "a.vtu")
    assert main(["mesh", "plane", "--size", "0.5", "--order", "2", "-o", path]) == 0
    assert read(path).order == 2
    assert main(["mesh", "plane", "--size", "0.5", "--ascii", "-o", path]) == 2
    assert "--ascii is for .stl files alone" in capsys.readouterr().err
    text = tmp_path / "a.stl"
    assert main(["mesh", "plane", "--size", "0.5", "--ascii", "-o", str(text)]) == 0
    assert text.read_text().startswith("solid ")


def test_without_sizes_the_surface_decides(stand_in, tmp_path):
    main(["mesh", "wavy", "-o", str(tmp_path / "a.stl"), "--json"])
    assert stand_in[0][0].name == "wavy" and stand_in[0][1] is None


def test_json_is_one_object_and_nothing_else(stand_in, tmp_path, capsys):
    path = str(tmp_path / "a.ply")
    assert main(["mesh", *SADDLE, "-o", path, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["clean"] and content["files"] == {"mesh": path}
    assert main(["check", path, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["nodes"] == 121
    assert main(["gallery", "--json"]) == 0
    assert {"wavy", "torus"} <= {s["name"] for s in json.loads(capsys.readouterr().out)["surfaces"]}


def test_a_mesh_that_is_not_clean_is_written_and_gives_1(stand_in, tmp_path, capsys):
    path = tmp_path / "a.vtu"
    assert main(["mesh", *SADDLE, "-o", str(path), "--chord", "1e-9"]) == 1
    assert path.is_file() and "NOT CLEAN" in capsys.readouterr().out


def test_check_against_a_surface(stand_in, tmp_path, capsys):
    path = str(tmp_path / "a.vtu")
    surface = tmp_path / "saddle.toml"
    surface.write_text(
        'name = "s"\nx = "u"\ny = "v"\nz = "u**2 - v**2"\n[domain]\nu = [-1, 1]\nv = [-1, 1]\n'
    )
    main(["mesh", *SADDLE, "-o", path, "--json"])
    capsys.readouterr()
    assert main(["check", path, "--surface", str(surface), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["deviation_max"] == pytest.approx(0.01, rel=0.05)
    bare = str(tmp_path / "a.stl")
    read(path).save(bare)
    assert main(["check", bare, "--surface", str(surface)]) == 2
    assert "carries no (u, v)" in capsys.readouterr().err


@pytest.mark.parametrize(
    "argv",
    [
        "",
        "nonsense",
        "mesh wavy",
        "mesh -o {}/a.vtu",
        "mesh wawy -o {}/a.vtu",
        "mesh wavy -o {}/a.foo",
        "mesh wavy -o {}/nowhere/a.vtu",
        "mesh wavy -o {}/a.vtu --picture {}/a.bmp",
        "mesh wavy -o {}/a.vtu --report {}/nowhere/a.json",
        "mesh wavy -o {}/a.vtu --size 0",
        "mesh wavy -o {}/a.vtu --size nan",
        "mesh wavy -o {}/a.vtu --jobs 0",
        "mesh wavy -o {}/a.vtu --growth 0.5",
        "mesh wavy -o {}/a.vtu --x u",
        "mesh --x u --y v -o {}/a.vtu",
        "mesh --x u+ --y v --z 0 --u 0 1 --v 0 1 -o {}/a.vtu",
        "mesh --x u.real --y v --z 0 --u 0 1 --v 0 1 -o {}/a.vtu",
        "mesh --x u --y v --z a --u 0 1 --v 0 1 --param a=b -o {}/a.vtu",
        "mesh --x u --y v --z 1/u --u -1 1 --v 0 1 -o {}/a.vtu",
        "mesh --x u --y v --z 0 --u 1 0 --v 0 1 -o {}/a.vtu",
        "check {}/none.vtu",
        "check {}",
        "view {}/none.vtu -o {}/a.png",
        "view wavy -o {}/a.png --worst 0",
        "report wavy",
        "report wavy -o {}/a.pdf",
        "report wawy -o {}/a.html",
        "report wavy -o {}/a.html --by colour",
        "report {}/none.vtu -o {}/a.html",
        "gallery extra",
    ],
)
def test_mistakes_give_2_one_line_and_no_file(argv, stand_in, tmp_path, capsys):
    try:
        status = main(argv.replace("{}", str(tmp_path)).split())
    except SystemExit as stopped:  # argparse
        status = stopped.code
    printed = capsys.readouterr()
    assert status == 2
    assert printed.out == ""
    assert printed.err.startswith("surfmesh: ") and printed.err.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "argv, said",
    [
        ("mesh wavy -o a.vtu --hausd 0.1", "here it is called --chord"),
        ("mesh wavy -o a.vtu --chrod 0.1", "did you mean --chord?"),
        ("mesh wawy -o a.vtu", "did you mean 'wavy'?"),
        ("mesh none.step -o a.vtu", "none.step: no such file"),
        ("mesh wavy -o a.png", "a picture is written by mesh.plot, or by --picture"),
        ("check wavy", "what one is made of: mesh it first"),
        ("mesh wavy -o a.vtu --units m", "its lengths have none"),
        ("mesh wavy -o a.vtu --simplify", "simplify is for CAD models and planar domains; "),
        ("mesh wavy -o a.vtu --units=--", "argument --units: '--' is no value"),
        ("mesh wavy -o a.vtu --gap 3", "gap 3: thin faces and gaps between faces are those of CAD"),
        ("mesh wavy -o a.vtu --by face", "--by face does nothing here: "),
    ],
)
def test_mistakes_are_told_with_what_to_do(argv, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with suppress(SystemExit):
        main(argv.split())
    assert said in capsys.readouterr().err


def test_failures_of_the_mesher_leave_nothing(tmp_path, capsys, monkeypatch):
    from surfmesh.errors import MeshingError

    def fail(*_, **__):
        raise MeshingError("the front ran away at (u, v) = (0, 1);\n ask for smaller sizes")

    monkeypatch.setattr(api, "mesh", fail)
    assert main(["mesh", "wavy", "-o", str(tmp_path / "a.vtu")]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said[-1].startswith("surfmesh: the front ran away") and said[-1].endswith("sizes")
    assert not list(tmp_path.iterdir())


def test_interrupt_is_quiet(monkeypatch, tmp_path, capsys):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(api, "mesh", interrupt)
    assert main(["mesh", "wavy", "-o", str(tmp_path / "a.vtu")]) == 130
    assert "Traceback" not in capsys.readouterr().err


def test_formulas_may_begin_with_a_minus():
    found = parse("mesh --x -u --y v --z -2*v --u -pi pi --v -1 1 -o a.vtu".split())
    assert [text.strip() for text in (found.x, found.z, *found.u)] == ["-u", "-2*v", "-pi", "pi"]


def test_view_writes_a_picture(stand_in, tmp_path):
    path = tmp_path / "a.png"
    assert main(["view", "wavy", "-o", str(path), "--by", "face"]) == 0
    assert path.stat().st_size > 1000


def test_report_is_one_html_file(stand_in, tmp_path, capsys):
    path = tmp_path / "a.html"
    assert main(["report", "wavy", "-o", str(path), "--chord", "0.1", "--by", "face"]) == 0
    assert stand_in[0][1].chord == 0.1
    assert "200 triangles - clean" in capsys.readouterr().out
    assert path.read_text("utf-8").startswith("<!DOCTYPE html>")
    mesh = tmp_path / "b.stl"
    grid(Saddle(), 3).save(mesh)
    assert main(["report", str(mesh), "-o", str(path), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["triangles"] == 18 and content["files"] == {"html": str(path)}
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["a.html", "b.stl"]


@pytest.mark.parametrize(
    ("argv", "said"),
    [
        (["check", "MESH", "--prove"], "--prove does nothing here: name what"),
        (["check", "MESH", "--units", "mm"], "--units does nothing here: name what"),
        (["report", "MESH", "-o", "a.html", "--chord", "1"], "--chord does nothing here: "),
        (["view", "MESH", "-o", "a.png", "--no-isolate"], "--no-isolate does nothing here: "),
    ],
)
def test_options_of_meshing_are_refused_where_the_mesh_is_there_already(
    argv, said, tmp_path, capsys, monkeypatch
):
    """They were passed over without a word."""
    monkeypatch.chdir(tmp_path)
    grid(Saddle(), 3).save("b.stl")
    assert main([word.replace("MESH", "b.stl") for word in argv]) == 2
    assert said in capsys.readouterr().err and [*tmp_path.iterdir()] == [tmp_path / "b.stl"]


@pytest.mark.parametrize("given", [["torus"], SADDLE], ids=["gallery", "formulas"])
@pytest.mark.parametrize("option", [
    ["--no-strict"], ["--scheduler", "tcp://nowhere:1"], ["--run-python"], ["--no-isolate"],
    ["--time-limit", "3"], ["--memory-limit", "5"],
])  # fmt: skip
def test_options_of_cad_models_are_refused_of_formulas(given, option, tmp_path, capsys):
    """They were passed over without a word."""
    assert main(["mesh", *given, "-o", str(tmp_path / "a.vtu"), "--size", "0.5", *option]) == 2
    name, said = option[0].removeprefix("--"), capsys.readouterr().err
    assert (name in said and "does nothing here" in said) or "are of reading CAD files" in said
    assert not [*tmp_path.iterdir()]


def test_a_program_is_read_without_limits(tmp_path, capsys):
    path = tmp_path / "part.py"
    path.write_text("result = 3")
    argv = ["estimate", str(path), "--run-python", "--time-limit", "3"]
    assert main(argv) == 2
    assert "--time-limit does nothing here: a program runs in" in capsys.readouterr().err


def test_mesh_writes_its_report_as_html(stand_in, tmp_path):
    path = tmp_path / "a.html"
    argv = ["mesh", *SADDLE, "-o", str(tmp_path / "a.vtu"), "--report", str(path)]
    assert main([*argv, "--chord", "1e-9"]) == 1
    assert "NOT CLEAN" in path.read_text("utf-8")


def test_view_draws_what_was_asked(stand_in, tmp_path):
    path = str(tmp_path / "a.png")
    assert main(["view", "wavy", "-o", path, "--size", "0.3", "--circles", "--directions"]) == 0
    assert stand_in[0][1].size == 0.3


def test_colours_that_can_be_typed_are_those_there_are():
    from surfmesh.cli.arguments import _COLOURS
    from surfmesh.view.colouring import COLOURS

    assert sorted(_COLOURS) == sorted(COLOURS)


def test_view_of_what_the_mesh_does_not_carry(tmp_path, capsys):
    mesh = grid(Saddle(), 2).save(tmp_path / "a.stl")
    assert main(["view", str(mesh), "-o", str(tmp_path / "a.png"), "--by", "size"]) == 2
    assert capsys.readouterr().err == (
        "surfmesh: cannot colour by 'size': the mesh carries no wanted sizes\n"
    )


def test_bar_appears_only_on_a_terminal_and_only_when_it_takes_long(monkeypatch, capsys):
    monkeypatch.setattr("surfmesh.cli.progress.PATIENCE", 0.0)
    with ProgressBar() as progress:
        progress("packing", 0.5)
        assert progress._bar is None
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
        progress("packing", 0.6)
        assert progress._bar is not None
    monkeypatch.setattr("surfmesh.cli.progress.PATIENCE", 60.0)
    with ProgressBar() as progress:
        progress("packing", 0.5)
        assert progress._bar is None


def test_report_outlives_its_mesh():
    from surfmesh.quality import check

    report = check(grid(Saddle(), 2))
    renamed = replace(report.counts, surface="other")
    assert replace(report, counts=renamed).surface == "other"


def run(*argv, **options):
    return subprocess.run(
        [sys.executable, "-m", "surfmesh", *argv], capture_output=True, text=True, **options
    )


def test_module_runs_and_help_is_light():
    found = run("--help")
    assert found.returncode == 0 and "exit status" in found.stdout
    assert run("mesh").stderr.startswith("surfmesh: ")


def test_closed_pipe_is_quiet():
    code = "import sys; from surfmesh.cli import main; sys.exit(main(['gallery']))"
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait() == 141
