"""What can be typed: commands, options, and their help. Nothing heavy is imported here."""

import argparse
import re
from collections.abc import Sequence
from typing import NoReturn, TypeAlias

from surfmesh.cli.option_groups import (
    BY_DEFAULT,
    BY_ROUNDING,
    READING,
    SIZES,
    add_cad,
    add_json,
    add_reading,
    add_second_opinion,
    add_sizes,
    number,
    positive,
    whole_number,
)
from surfmesh.cli.terminal import complain
from surfmesh.errors import did_you_mean

_VALUES = {  # option -> values it takes, which may begin with a minus
    "--x": 1, "--y": 1, "--z": 1, "--u": 2, "--v": 2, "--at": 3, "--origin": 2, "--box": 4,
}  # fmt: skip
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_EXAMPLES = """examples:
  surfmesh mesh wavy -o wavy.vtu --chord 0.05 --picture wavy.png
  surfmesh mesh my_surface.toml -o my_surface.stl --size 0.1
  surfmesh mesh --x u --y v --z "u**2 - v**2" --u -1 1 --v -1 1 -o saddle.ply
  surfmesh intersect torus plane -o cut.vtu --keep torus=+plane --chord 0.01
  surfmesh check wavy.vtu --surface wavy
  surfmesh report bracket.step -o bracket.html --chord 0.05
  surfmesh mesh bracket.step -o bracket.vtu --sizes sizes.toml
  surfmesh mesh wavy -o wavy.vtu --manifest wavy.json
  surfmesh compare wavy.json there/wavy.json
  surfmesh explain bracket.step --at 0 0 5 --sizes sizes.toml
  surfmesh estimate bracket.step --chord 0.01
  surfmesh pack --uniform 1 100 --count 1000 -o circles.svg
  surfmesh gallery

exit status: 0 done and valid, 1 a mesh was made but its report is not clean, or compared files
differ, 2 bad input, 3 an error in surfmesh itself"""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """One line, where argparse would print the usage too."""
        complain(f"{message}{_meant(message)} (see {self.prog} --help)")
        self.exit(2)


def _meant(message: str) -> str:
    """The option that is meant by another program's name of it, or by nearly its own."""
    found = re.match(r"unrecognized arguments: --([\w-]+)", message)
    if found is None:
        return ""
    from surfmesh.sizing.options.other_words import own_word

    word = own_word(found[1])
    if word is not None:
        return f": here it is called --{word.replace('_', '-')}"
    near = did_you_mean(found[1], [name.replace("_", "-") for name in SIZES])
    return near.replace("'", "--", 1).replace("'", "")


_Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Options with ``command``, the name of a function in ``commands``. Exits on bad usage.

    ``sizing`` holds what was given of the options of ``Sizing``, ``reading`` those of ``load``.
    """
    parser = _parser()
    for word in argv:  # of which argparse makes an empty list
        if word.startswith("--") and word.endswith("=--"):
            parser.error(f"argument {word[:-3]}: '--' is no value")
    options = parser.parse_args(_imprint_alone(_values_shielded(argv)))
    held = vars(options)
    given = {
        name: held.pop(name) for name in (*SIZES, "proof", "fewest", "vertices") if name in held
    }
    options.sizing = {name: value for name, value in given.items() if value is not None}
    options.reading = {name: held.pop(name) for name in READING if name in held}
    return options


def _values_shielded(argv: Sequence[str]) -> list[str]:
    """A space before formulas and numbers such as -1e3, which argparse takes for options."""
    shielded, values = [], 0
    for word in argv:
        shielded.append(f" {word}" if values and word.startswith("-") else word)
        values = values - 1 if values else _VALUES.get(word, 0)
    return shielded


def _imprint_alone(argv: Sequence[str]) -> list[str]:
    """``--imprint`` takes the next word only when that is a number, not the name of a file."""
    words = list(argv)
    for place, (word, after) in enumerate(zip(words, [*words[1:], ""])):
        if word == "--imprint" and not _NUMBER.fullmatch(after):
            words[place] = f"--imprint={BY_ROUNDING}"
    return words


def _parser() -> _Parser:
    parser = _Parser(
        prog="surfmesh",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    for add in (
        _add_mesh, _add_intersect, _add_check, _add_view, _add_report, _add_compare,
        _add_explain, _add_estimate, _add_pack, _add_gallery,
    ):  # fmt: skip
        add(commands)
    return parser


def _command(commands: _Commands, name: str, does: str) -> _Parser:
    """One with a line of what it does, in the list of commands and above its own options."""
    return commands.add_parser(name, help=does, description=f"{does[0].upper()}{does[1:]}.")


def _add_mesh(commands: _Commands) -> None:
    mesh = _command(commands, "mesh", "mesh a surface, check it, write it")
    mesh.add_argument("input", nargs="?", metavar="INPUT", help=_MODEL)
    mesh.add_argument("-o", "--output", required=True, metavar="OUT", help=_OUT)
    formulas = mesh.add_argument_group("a surface by formulas in u and v, instead of INPUT")
    for axis in "xyz":
        formulas.add_argument(f"--{axis}", metavar="FORMULA", help="as u*cos(v)")
    for variable in "uv":
        formulas.add_argument(
            f"--{variable}", nargs=2, metavar=("FROM", "TO"), help="its range, as 0 2*pi"
        )
    formulas.add_argument(
        "--param", action="append", default=[], metavar="NAME=VALUE", help="a named number"
    )
    _add_made(mesh)


def _add_intersect(commands: _Commands) -> None:
    meet = _command(commands, "intersect", "mesh surfaces and models that cut each other")
    meet.add_argument("inputs", nargs="+", metavar="INPUT", help=_MODEL)
    meet.add_argument("-o", "--output", required=True, metavar="OUT", help=_OUT)
    meet.add_argument(
        "--keep", action="append", default=[], metavar="all|union|difference|common|NAME=SIDE",
        help="what is kept (default all); NAME=+OTHER, NAME=-OTHER or NAME=X,Y,Z: of an input the "
        "parts on one side, or nearest to a point; may be given several times",
    )  # fmt: skip
    meet.add_argument(
        "--coincident", choices=("refuse", "merge"), default="refuse",
        help="patches of two inputs that coincide: an error (default), or one patch of both",
    )  # fmt: skip
    _add_made(meet)


def _add_made(mesh: argparse.ArgumentParser) -> None:
    """What is asked of a mesh that is made, checked and written."""
    add_sizes(mesh)
    mesh.add_argument("--no-optimise", action="store_true", help="the raw packing, for comparison")
    add_cad(mesh)
    mesh.add_argument(
        "--simplify",
        action="store_true",
        help="collapse tiny edges of a CAD model; thin lines of a planar domain",
    )
    mesh.add_argument(
        "--order",
        type=whole_number(1, 2),
        metavar="1|2",
        help="2: nodes amid the edges too; --chord is then that of the curved triangles; "
        "without it there are as many as of order 1",
    )
    mesh.add_argument(
        "--flip", action="store_true", help="turn the mesh over: a closed surface that faces inward"
    )
    mesh.add_argument("--ascii", action="store_true", help="an .stl as text, solids by name")
    mesh.add_argument(
        "--solids",
        choices=("solids", "faces"),
        default="",
        help="of an .stl: a solid for each solid of the model, or for each of its faces",
    )
    mesh.add_argument(
        "--target", choices=("abaqus", "calculix"), default="", help="whose elements an .inp names"
    )
    mesh.add_argument(
        "--jobs", type=whole_number(1, 1000), help="threads that mesh (default: all processors)"
    )
    mesh.add_argument(
        "--scheduler", metavar="ADDRESS",
        help="mesh the faces on the machines of a Dask scheduler, such as tcp://host:8786",
    )  # fmt: skip
    mesh.add_argument("--picture", metavar="PNG", help="write a picture too")
    mesh.add_argument("--by", default=BY_DEFAULT, choices=_COLOURS, help="colour of the picture")
    mesh.add_argument("--report", metavar="JSON|HTML", help="write the report too")
    mesh.add_argument(
        "--manifest", metavar="JSON", help="write versions, options and hashes, to compare"
    )
    add_second_opinion(mesh)
    add_json(mesh)


def _add_check(commands: _Commands) -> None:
    check = _command(commands, "check", "report on a mesh file")
    check.add_argument("input", metavar="MESH", help="mesh file, as mesh writes it")
    check.add_argument(
        "--surface", metavar="INPUT", help="formula file, gallery name or CAD file it was made from"
    )
    add_reading(check)
    check.add_argument(
        "--prove", action="store_true",
        help="bound the distance from the surface, both ways, with round-off",
    )  # fmt: skip
    add_second_opinion(check)
    add_json(check)


def _add_view(commands: _Commands) -> None:
    view = _command(commands, "view", "show a mesh or a surface")
    view.add_argument("input", metavar="INPUT", help=_ANYTHING)
    view.add_argument("-o", "--output", metavar="PNG", help="a picture instead of a window")
    view.add_argument("--by", default=BY_DEFAULT, choices=_COLOURS, help="colour")
    view.add_argument("--circles", action="store_true", help="draw the packing on the surface")
    view.add_argument("--directions", action="store_true", help="draw principal directions")
    view.add_argument(
        "--worst", type=whole_number(1), help="how many of the worst triangles are outlined"
    )
    add_sizes(view)
    add_cad(view)


def _add_report(commands: _Commands) -> None:
    report = _command(commands, "report", "one HTML file: mesh, certificate, histograms")
    report.add_argument("input", metavar="INPUT", help=_ANYTHING)
    report.add_argument("-o", "--output", required=True, metavar="HTML", help="file to write")
    report.add_argument("--by", default=BY_DEFAULT, choices=_COLOURS, help="colour at first")
    add_sizes(report)
    add_cad(report)
    add_second_opinion(report)
    add_json(report)


def _add_compare(commands: _Commands) -> None:
    compare = _command(commands, "compare", "compare a manifest with another, or with files")
    compare.add_argument("input", metavar="MANIFEST", help="what mesh --manifest wrote")
    compare.add_argument(
        "other",
        nargs="?",
        metavar="OTHER",
        help="manifest of another run, or a folder with the files (default: that of MANIFEST)",
    )
    add_json(compare)


def _add_explain(commands: _Commands) -> None:
    explain = _command(commands, "explain", "which rule decides the size at a point")
    explain.add_argument("input", metavar="INPUT", help=_MODEL)
    explain.add_argument(
        "--at", nargs=3, type=number, required=True, metavar=("X", "Y", "Z"), help="the point"
    )
    add_sizes(explain)
    add_reading(explain)
    add_json(explain)


def _add_estimate(commands: _Commands) -> None:
    estimate = _command(commands, "estimate", "triangles and memory, before meshing")
    estimate.add_argument("input", metavar="INPUT", help=_MODEL)
    add_sizes(estimate)
    add_reading(estimate)
    add_json(estimate)


def _add_pack(commands: _Commands) -> None:
    pack = _command(commands, "pack", "pack circles over the plane, as in the paper")
    law = pack.add_mutually_exclusive_group(required=True)
    law.add_argument("--radius", type=positive, help="one radius for all")
    law.add_argument("--uniform", nargs=2, type=positive, metavar=("LO", "HI"), help="random radii")
    pack.add_argument(
        "--seed", type=whole_number(0), default=0, help="of the random radii (default 0)"
    )
    pack.add_argument(
        "--origin", nargs=2, type=number, default=(0.0, 0.0), metavar=("X", "Y"),
        help="where the packing begins (default 0 0)",
    )  # fmt: skip
    pack.add_argument("--count", type=whole_number(1), help="stop at so many circles")
    pack.add_argument("--distance", type=positive, help="stop at this distance from the origin")
    pack.add_argument(
        "--box", nargs=4, type=number, metavar=("X0", "Y0", "X1", "Y1"), help="stop outside of it"
    )
    pack.add_argument("-o", "--output", metavar="SVG|PNG", help="draw the packing")
    pack.add_argument(
        "--show", default="both", choices=("circles", "mesh", "both"), help="what is drawn"
    )
    add_json(pack)


def _add_gallery(commands: _Commands) -> None:
    gallery = _command(commands, "gallery", "list the ready-made surfaces")
    add_json(gallery)


_COLOURS = (
    "alpha", "quality", "angle", "size", "deviation", "face", "curvature", "gaussian", "mean"
)  # fmt: skip
_MODEL = (
    "CAD file (.step, .stp, .iges, .igs, .brep), formula file (.toml), drawing (.svg), program "
    "with CadQuery (.py, with --run-python) or gallery name"
)
_ANYTHING = f"mesh file, {_MODEL}"
_FORMATS = ".vtu .vtp .pvtu .stl .obj .ply .glb .3mf .off .msh .mesh .inp .bdf .su2 .xdmf .med"
_OUT = f"mesh file to write: {_FORMATS}"
_DESCRIPTION = f"""Triangle meshes of curved surfaces, checked against the true surface.

In:  .step .stp .iges .igs .brep (CAD models), .toml (formulas, planar domains), .svg (drawings),
     .py (CadQuery, with --run-python), or a name of the gallery
Out: {_FORMATS}"""


class _Version(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __init__(self, option_strings: list[str], dest: str) -> None:
        super().__init__(option_strings, dest, nargs=0, help="print the version")

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        import surfmesh

        print(f"surfmesh {surfmesh.__version__}")
        parser.exit(0)
