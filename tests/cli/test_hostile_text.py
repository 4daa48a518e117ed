"""Text from files and the command line: one line and status 2 for whatever is wrong with it."""

import os
import re
from pathlib import Path

import pytest

from surfmesh.cli import main
from surfmesh.cli.terminal import say, say_json
from surfmesh.errors import FormulaError, SurfaceError, printable
from surfmesh.geometry import text_file
from surfmesh.geometry.files import toml_entries
from surfmesh.geometry.files.surface_file import load_surface_file
from surfmesh.sizing.options.sizes_file import read_sizes

CORPUS = Path(__file__).resolve().parents[3] / "shared" / "cases" / "hostile"
SURFACE = 'name = "a"\nx = "u"\ny = "v"\nz = "u*v"\n[domain]\nu = [0, 1]\nv = [0, 1]\n'
UNSAFE = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def refused(capsys, *argv: str) -> str:
    """What is said of arguments that are refused: one clean line and nothing else."""
    try:
        status = main(argv)
    except SystemExit as end:
        status = end.code
    out, err = capsys.readouterr()
    assert status == 2, (argv, status, out, err)
    assert out == "" and err.startswith("surfmesh: ") and err.count("\n") == 1
    assert not UNSAFE.search(err) and len(err) < 1100
    return err


@pytest.fixture
def surface(tmp_path):
    """Writes a text as a surface file; gives its path."""

    def written(text: str | bytes, name: str = "a.toml") -> str:
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return str(path)

    return written


TOML = {
    "lists nested": ("a = " + "[" * 5000, "nested"),
    "a few lists": ("a = " + "[" * 20 + "]" * 20, "nested"),
    "tables nested": ("a = " + "{a = " * 1000, "nested"),
    "a key of parts": ("a" + ".a" * 20_000 + " = 1", "a key of more than"),
    "a header of parts": (SURFACE + "\n[" + '"a" . ' * 200 + "a]", "a key of more than"),
    "thousands of digits": ("name = 1" + "1" * 5000, "thousands of digits"),
    "hexadecimal digits": (SURFACE + "[sizing]\nchord = 0x" + "f" * 5000, "20000 bits"),
    "a domain without end": (SURFACE.replace("[0, 1]", "[0, " + "1" * 400 + "]"), "64"),
    "a large fact": (SURFACE + "[facts]\narea = " + "1" * 400, "'facts.area' is a whole number"),
    "NUL": (b"name = \0", "not a TOML file"),
    "UTF-16": (SURFACE.encode("utf-16"), "not a TOML file"),
    "a date": (SURFACE.replace('"u*v"', "1979-05-27"), "'z' must be text"),
    "a key in colour": ('"\\u001b[31m" = 1\n' + SURFACE, r"unknown key '\x1b[31m'"),
    "a key backwards": ('"\\u202e" = 1\n' + SURFACE, r"unknown key '\u202e'"),
    "a key of two lines": ('"a\\nb" = 1\n' + SURFACE, r"unknown key 'a\nb'"),
    "sizes that cannot be counted": (SURFACE + "[sizing]\nsize = 1e-300", "at least 1e-60"),
    "a large domain": ('name = "d"\nouter = [[0, 0], [1e300, 0], [1, ' + "1" * 400 + "]]", "64"),
    "a ragged domain": ('name = "d"\nouter = [[0, 0], [1, 0], [1]]', "not an array"),
    "too many values": ("a = [" + "1," * 2_000_001 + "]", "more than 2,000,000"),
    "too many keys": ("a=1\n" * 100_001, "more than 100,000"),
}


@pytest.mark.parametrize("text, reason", TOML.values(), ids=list(TOML))
def test_a_surface_file_is_refused_in_one_line(text, reason, surface, tmp_path, capsys):
    out = tmp_path / "out.vtu"
    assert reason in refused(capsys, "mesh", surface(text), "-o", str(out))
    assert not out.exists()


def test_what_is_no_file_is_not_read(tmp_path, capsys):
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "nowhere.toml").symlink_to(tmp_path / "gone")
    for name in ("pipe.toml", "folder.toml", "nowhere.toml", "missing.toml"):
        path = str(tmp_path / name)
        refused(capsys, "mesh", path, "-o", str(tmp_path / "out.vtu"))
        refused(capsys, "estimate", "plane", "--sizes", path)
        with pytest.raises(SurfaceError, match=r"not a file|no such file"):
            load_surface_file(path)
    refused(capsys, "estimate", "plane", "--sizes", "/dev/zero")
    with pytest.raises(SurfaceError, match="no such file"):
        load_surface_file("a\0b.toml")


def test_the_length_of_text_is_bounded(surface, monkeypatch):
    path = surface(SURFACE)
    monkeypatch.setattr(text_file, "MOST_BYTES", 20)
    with pytest.raises(SurfaceError, match=r"holds .* MB; a TOML file of up to"):
        load_surface_file(path)


def test_a_mark_of_bytes_and_ends_of_lines_are_no_fault(surface):
    for text in (b"\xef\xbb\xbf" + SURFACE.encode(), SURFACE.replace("\n", "\r\n").encode()):
        assert load_surface_file(surface(text)).name == "a"
    numbers = ", ".join(f"[0.{k}, 1.{k}]" for k in range(200))  # points are no key of many parts
    content = toml_entries.toml_content(Path(surface(f"a = [{numbers}]")), SurfaceError)
    assert len(content["a"]) == 200


SIZES = {
    '[sizes."*"]\nsize = "1"': "must be a number",
    '[sizes."*"]\nsize = true': "must be a number",
    '[sizes."*"]\ngap_faces = 1': "must be true or false",
    "[sizes]\na = true": "not true or false",
    '[sizes."*"]\nsize = 1e-300': "at least 1e-60",
    '[sizes."*"]\ngap = 1e300': "0.001 to 1000",
    '[sizes."*"]\nsize = 1' + "1" * 5000: "thousands of digits",
    '[[sizes."*".sources]]\nlines = [[["a", 0, 0], [1, 1, 1]]]\nsize = 1': "list of points",
    '[[sizes."*".sources]]\nlines = [[[0, 0, 0], [1, 1]]]\nsize = 1': "list of points",
    '[[sizes."*".sources]]\nlines = 3\nsize = 1': "list of lines",
    '[[sizes."*".sources]]\nlines = [[[0, 1979-05-27, 0]]]\nsize = 1': "list of points",
    '[[sizes."*".sources]]\nnear = [[0, 0, 0]]\nsize = 1\nradius = "x"': "radius must be a number",
    '[[sizes."*".sources]]\nball = [0, 0, "a"]\nradius = 1\nsize = 1': "three finite numbers",
    '[[sizes."*".sources]]\nbox = [[0, 0, 0]]\nsize = 1': "two corners",
    '[[sizes."*".sources]]\nbox = 5\nsize = 1': "two corners",
    '[[sizes."*".sources]]\nnear = [[0, 0, 0]]': "'size' is missing",
    '[[sizes."*".sources]]\nnear = [[0, 0, 0]]\nsize = 1\nfoo = 1': "unknown key 'foo'",
}


@pytest.mark.parametrize("text", SIZES)
def test_a_sizes_file_is_refused_in_one_line(text, surface, capsys):
    assert SIZES[text] in refused(capsys, "estimate", "plane", "--sizes", surface(text))


def test_sources_with_all_they_may_have_are_read(surface):
    path = surface(
        '[[sizes."*".sources]]\nnear = [[0, 0, 0]]\nsize = 1\ngrowth = 1.5\nreach = 3\nradius = 1\n'
        '[[sizes."*".sources]]\nball = [0, 0, 0]\nsize = 1\nradius = 1\n'
    )
    assert [type(source).__name__ for source in read_sizes(path)["*"].sources] == ["Near", "InBall"]


MESH = ["mesh", "plane", "-o", "out.vtu"]
PACK = ["pack", "--uniform", "1", "2"]
ARGUMENTS = [
    *([*MESH, f"--{name}={value}"]
      for name in ("chord", "size", "angle", "max-size", "growth", "anisotropy", "volume", "limit")
      for value in ("-1", "0", "nan", "1e400", "0x10", "", "1,5", "9" * 5000)),
    *([*MESH, f"--{name}=1e-300"] for name in ("chord", "size", "angle", "max-size", "gap")),
    *([*MESH, f"--jobs={value}"] for value in ("0", "-1", "1000000000", "9" * 5000)),
    *([*MESH, f"--order={value}"] for value in ("0", "7", "1.0", "")),
    [*MESH, "--size", "1e-140"], [*MESH, "--size", "1e-9"], [*MESH, "--gap", "1e300"],
    *(["mesh", *"--x u --y v --z u*v -o out.vtu --v 0 1 --u".split(), *u]
      for u in (["1", "1"], ["1", "0"], ["nan", "1"], ["0", "1e400"], ["0", "1e300"], ["0", ""])),
    *(["mesh", *"--x u --y v --z u*v -o out.vtu --v 0 1 --u 0 1 --param".split(), value]
      for value in ("a=nan", "a=1e400", "=1", "a", "\udcff=1", "a\x1b[31m=1")),
    ["mesh", *"--x u --y v -o out.vtu --v 0 1 --u 0 1 --z".split(), "u\x1b[2J"],
    *(["explain", "plane", "--at", *at]
      for at in (["nan", "0", "0"], ["1e300", "0", "0"], ["x\x9b", "0", "0"], ["0", "0"])),
    *([*PACK, "--count", "9", f"--seed={value}"] for value in ("-1", "1e5", "x", "9" * 5000)),
    *([*PACK, f"--count={value}"] for value in ("0", "2", "1000000000000", "9" * 40, "9" * 5000)),
    *([*PACK, f"--distance={value}"] for value in ("1e300", "1e7", "-1", "nan")),
    *(["pack", "--radius", "1", f"--distance={value}"] for value in ("1e300", "1e30", "1e7")),
    *(["pack", "--radius", value, "--count", "9"] for value in ("1e-300", "1e300", "0", "nan")),
    *(["pack", "--uniform", *lo_hi, "--count", "9"]
      for lo_hi in (("0", "0"), ("2", "1"), ("1e-300", "1"), ("1", "1e300"))),
    *(["pack", "--radius", "1", "--box", *box.split()]
      for box in ("0 0 0 0", "nan 0 1 1", "0 0 inf 1", "-1e300 -1e300 1e300 1e300",
                  "-1e9 -1e9 1e9 1e9")),
    *(["pack", "--radius", "1", "--count", "9", "--origin", *at.split()]
      for at in ("nan 0", "1e300 0", "1e16 0")),
    ["mesh", "\x1b[31m\udcff\nx", "-o", "out.vtu"], ["\x1b[31m\n"], ["mesh", "--\x1b[31m\n"],
    ["check", "\udcff.obj"], ["check", "a\n" * 2000 + ".obj"], ["estimate", "x" * 5000],
]  # fmt: skip


@pytest.mark.filterwarnings("error")
def test_values_are_refused_in_one_line(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for argv in ARGUMENTS:
        refused(capsys, *argv)
    assert not list(tmp_path.iterdir())


def test_negative_numbers_with_an_exponent_are_numbers(capsys):
    assert main(["explain", "plane", "--size", "0.5", "--at", "-1e-3", "-.5", "-0e0"]) == 0
    assert "size" in capsys.readouterr().out


def test_names_are_shown_without_what_moves_the_cursor(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("\x1b[31m\n\udcff.toml").write_text(
        SURFACE.replace('"a"', '"\\u001b[31ma\\nclean\\u202e"'), encoding="utf-8"
    )
    assert main(["mesh", "\x1b[31m\n\udcff.toml", "--size", "0.5", "-o", "\x9b.vtu"]) == 0
    out, err = capsys.readouterr()
    assert r"\x9b.vtu" in out and err == "" and not UNSAFE.search(out)
    Path("\udcff.svg").write_text("<svg><path d='M0 0L1 0L1 1Z'/></svg>")
    for ending in (".json", ".html"):
        argv = ["mesh", "\udcff.svg", "-o", "\udcff.vtu", "--report", f"\udcff{ending}"]
        assert main(argv) == 0 and Path(f"\udcff{ending}").is_file()
        assert not UNSAFE.search(capsys.readouterr().out)
    assert main(["check", "\x9b.vtu"]) == 0
    assert not UNSAFE.search(capsys.readouterr().out)


def test_json_holds_the_text_itself(capsys):
    import json

    value = {"a\x9b": ["é漢\x1b\u202e\udcff\U000e0041", 1.5]}
    say_json(value)
    out = capsys.readouterr().out
    assert json.loads(out) == value and "é漢" in out and not UNSAFE.search(out)
    say("two\nlines\x1b")
    assert capsys.readouterr().out == "two\nlines\\x1b\n"


def test_printable_text_stays_as_it_is():
    plain = "é 漢 \u200d ° ± – 1.5 \\ 'a'"
    assert printable(plain) == plain
    assert printable("\x1b\x7f\x9b\n\u202e\u2066\u2028\u200b\ufeff\udc80\U000e0020") == (
        r"\x1b\x7f\x9b\n\u202e\u2066\u2028\u200b\ufeff\udc80\U000e0020"
    )


@pytest.mark.parametrize("length", [0, 100])
def test_the_caret_of_a_formula_stands_under_its_column(length):
    text = "u" * length + "\x1b[31m+%"
    _, shown, caret = str(FormulaError("no", text, len(text))).split("\n")
    assert shown[caret.index("^")] == "%" and not UNSAFE.search(shown)


def test_a_defect_is_one_line_and_status_3(monkeypatch, capsys):
    def broken(_):
        raise RecursionError("\x1b too deep")

    monkeypatch.setattr("surfmesh.cli.commands.gallery", broken)
    assert main(["gallery"]) == 3
    err = capsys.readouterr().err
    assert err.startswith(r"surfmesh: internal error: RecursionError: \x1b")
    assert err.count("\n") == 1
    monkeypatch.setenv("SURFMESH_DEBUG", "1")
    assert main(["gallery"]) == 3 and "Traceback" in capsys.readouterr().err


def test_a_warning_is_one_note(monkeypatch, capsys):
    import warnings

    monkeypatch.setattr(
        "surfmesh.cli.commands.gallery", lambda _: warnings.warn("a\x1b\nb", stacklevel=1) or True
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(warnings, "filters", [])
        assert main(["gallery"]) == 0
    assert capsys.readouterr().err == "surfmesh: note: a\\x1b\\nb\n"


@pytest.mark.skipif(not CORPUS.is_dir(), reason="the corpus of hostile files is not here")
def test_the_corpus_never_ends_in_a_traceback(capsys):
    """As surfaces that are read, and as sizes of the plane; what is good has status 0."""
    for path in sorted([*CORPUS.glob("attack/*.toml"), *CORPUS.glob("toml/*")]):
        for argv in (["estimate", str(path)], ["estimate", "plane", "--sizes", str(path)]):
            assert main(argv) in (0, 2), argv
            out, err = capsys.readouterr()
            assert err.count("\n") == (1 if out == "" else 0) and not UNSAFE.search(err)
