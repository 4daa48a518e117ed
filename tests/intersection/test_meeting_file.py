"""Surfaces that meet, from files: the ready-made ones, and what is refused."""

import pytest

import surfmesh as sm
from surfmesh.errors import SurfaceError
from surfmesh.intersection.meeting_file import meeting_gallery

CUT = """
name = "cut"
intersect = ["ball", "floor.toml"]
keep = "{keep}"
[ball]
x = "cos(u)*cos(v)"
y = "sin(u)*cos(v)"
z = "sin(v)"
domain = {{ u = [0, "2*pi"], v = ["-pi/2", "pi/2"] }}
"""
FLOOR = 'name = "floor"\nx = "u"\ny = "v"\nz = "0.3"\ndomain = { u = [-2, 2], v = [-2, 2] }\n'


@pytest.mark.parametrize("name", ["crossing_pipes", "three_sheets", "wing_and_fuselage"])
def test_ready_made_ones_are_clean(name):
    model = sm.load(name)
    assert model.name == name and not model.broken_invariant()
    report = sm.check(sm.mesh(model, {"angle": 40.0, "max_size": 0.5}))
    assert report.clean, report.problems
    assert report.closed == (name == "wing_and_fuselage")


def test_four_are_there_under_their_names():
    assert set(meeting_gallery()) == {
        "crossing_pipes", "three_sheets", "wavy_cut", "wing_and_fuselage"
    }  # fmt: skip


def test_a_file_names_another_one_beside_it(tmp_path):
    (tmp_path / "floor.toml").write_text(FLOOR)
    path = tmp_path / "cut.toml"
    path.write_text(CUT.format(keep="all"))
    model = sm.load(path)
    assert [face.name for face in model.faces].count("ball") == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (CUT.format(keep="most"), "keep"),
        (CUT.format(keep="all").replace("floor.toml", "roof"), "neither a table there"),
        (CUT.format(keep="all") + "[more]\nx = 1\n", "unknown key 'more'"),
        ('intersect = ["a"]\nname = "b"\n', "neither a table"),
    ],
)
def test_faulty_files_are_refused_by_name(tmp_path, text, said):
    (tmp_path / "floor.toml").write_text(FLOOR)
    path = tmp_path / "cut.toml"
    path.write_text(text)
    with pytest.raises(SurfaceError, match=said) as refused:
        sm.load(path)
    assert "cut.toml" in str(refused.value)


def test_a_file_says_what_becomes_of_patches_that_coincide(tmp_path):
    (tmp_path / "floor.toml").write_text(FLOOR)
    path = tmp_path / "floors.toml"
    head, again = 'intersect = ["floor.toml", "again"]\n', FLOOR.replace("[-2, 2]", "[-1, 3]")
    path.write_text(f"{head}[again]\n{again}")
    with pytest.raises(SurfaceError, match=r"coincide on a patch through \("):
        sm.load(path)
    path.write_text(f'{head}coincident = "merge"\n[again]\n{again}')
    assert len(sm.load(path).faces) == 3
