"""What can be typed: commands, options, and their help. Nothing heavy is imported here."""

import argparse
import math
import re
from collections.abc import Callable, Sequence
from typing import NoReturn, TypeAlias

from surfmesh.cli.terminal import complain
from surfmesh.errors import did_you_mean

_VALUES = {  # option -> values it takes, which may begin with a minus
    "--x": 1, "--y": 1, "--z": 1, "--u": 2, "--v": 2, "--at": 3, "--origin": 2, "--box": 4,
}  # fmt: skip
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_BY_ROUNDING = "by-rounding"  # --imprint without a tolerance
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
    near = did_you_mean(found[1], [name.replace("_", "-") for name in _SIZES])
    return near.replace("'", "--", 1).replace("'", "")


_Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Options with ``command``, the name of a function in ``commands``. Exits on bad usage.

    ``sizing`` holds what was given of the options of ``Sizing``, ``reading`` those of ``load``.
    """
    options = _parser().parse_args(_imprint_alone(_values_shielded(argv)))
    held = vars(options)
    given = {name: held.pop(name) for name in (*_SIZES, "proof", "vertices") if name in held}
    options.sizing = {name: value for name, value in given.items() if value is not None}
    options.reading = {name: held.pop(name) for name in _READING if name in held}
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
            words[place] = f"--imprint={_BY_ROUNDING}"
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
    _add_sizes(mesh)
    mesh.add_argument("--no-optimise", action="store_true", help="the raw packing, for comparison")
    _add_cad(mesh)
    mesh.add_argument(
        "--simplify",
        action="store_true",
        help="collapse tiny edges of a CAD model; thin lines of a planar domain",
    )
    mesh.add_argument(
        "--order",
        type=_whole(1, 2),
        metavar="1|2",
        help="2: nodes amid the edges too; --chord is then that of the curved triangles",
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
        "--jobs", type=_whole(1, 1000), help="threads that mesh (default: all processors)"
    )
    mesh.add_argument(
        "--scheduler", metavar="ADDRESS",
        help="mesh the faces on the machines of a Dask scheduler, such as tcp://host:8786",
    )  # fmt: skip
    mesh.add_argument("--picture", metavar="PNG", help="write a picture too")
    mesh.add_argument("--by", default="alpha", choices=_COLOURS, help="colour of the picture")
    mesh.add_argument("--report", metavar="JSON|HTML", help="write the report too")
    mesh.add_argument(
        "--manifest", metavar="JSON", help="write versions, options and hashes, to compare"
    )
    _add_second_opinion(mesh)
    _add_json(mesh)


def _add_check(commands: _Commands) -> None:
    check = _command(commands, "check", "report on a mesh file")
    check.add_argument("input", metavar="MESH", help="mesh file, as mesh writes it")
    check.add_argument(
        "--surface", metavar="INPUT", help="formula file, gallery name or CAD file it was made from"
    )
    _add_units(check)
    check.add_argument(
        "--prove", action="store_true",
        help="bound the distance from the surface, both ways, with round-off",
    )  # fmt: skip
    _add_second_opinion(check)
    _add_json(check)


def _add_view(commands: _Commands) -> None:
    view = _command(commands, "view", "show a mesh or a surface")
    view.add_argument("input", metavar="INPUT", help=_ANYTHING)
    view.add_argument("-o", "--output", metavar="PNG", help="a picture instead of a window")
    view.add_argument("--by", default="alpha", choices=_COLOURS, help="colour")
    view.add_argument("--circles", action="store_true", help="draw the packing on the surface")
    view.add_argument("--directions", action="store_true", help="draw principal directions")
    view.add_argument(
        "--worst", type=_whole(1), help="how many of the worst triangles are outlined"
    )
    _add_sizes(view)
    _add_cad(view)


def _add_report(commands: _Commands) -> None:
    report = _command(commands, "report", "one HTML file: mesh, certificate, histograms")
    report.add_argument("input", metavar="INPUT", help=_ANYTHING)
    report.add_argument("-o", "--output", required=True, metavar="HTML", help="file to write")
    report.add_argument("--by", default="alpha", choices=_COLOURS, help="colour at first")
    _add_sizes(report)
    _add_cad(report)
    _add_second_opinion(report)
    _add_json(report)


def _add_compare(commands: _Commands) -> None:
    compare = _command(commands, "compare", "compare a manifest with another, or with files")
    compare.add_argument("input", metavar="MANIFEST", help="what mesh --manifest wrote")
    compare.add_argument(
        "other",
        nargs="?",
        metavar="OTHER",
        help="manifest of another run, or a folder with the files (default: that of MANIFEST)",
    )
    _add_json(compare)


def _add_explain(commands: _Commands) -> None:
    explain = _command(commands, "explain", "which rule decides the size at a point")
    explain.add_argument("input", metavar="INPUT", help=_MODEL)
    explain.add_argument(
        "--at", nargs=3, type=_number, required=True, metavar=("X", "Y", "Z"), help="the point"
    )
    _add_sizes(explain)
    _add_units(explain)
    _add_json(explain)


def _add_estimate(commands: _Commands) -> None:
    estimate = _command(commands, "estimate", "triangles and memory, before meshing")
    estimate.add_argument("input", metavar="INPUT", help=_MODEL)
    _add_sizes(estimate)
    _add_units(estimate)
    _add_json(estimate)


def _add_pack(commands: _Commands) -> None:
    pack = _command(commands, "pack", "pack circles over the plane, as in the paper")
    law = pack.add_mutually_exclusive_group(required=True)
    law.add_argument("--radius", type=_positive, help="one radius for all")
    law.add_argument(
        "--uniform", nargs=2, type=_positive, metavar=("LO", "HI"), help="random radii"
    )
    pack.add_argument("--seed", type=_whole(0), default=0, help="of the random radii (default 0)")
    pack.add_argument(
        "--origin", nargs=2, type=_number, default=(0.0, 0.0), metavar=("X", "Y"),
        help="where the packing begins (default 0 0)",
    )  # fmt: skip
    pack.add_argument("--count", type=_whole(1), help="stop at so many circles")
    pack.add_argument("--distance", type=_positive, help="stop at this distance from the origin")
    pack.add_argument(
        "--box", nargs=4, type=_number, metavar=("X0", "Y0", "X1", "Y1"), help="stop outside of it"
    )
    pack.add_argument("-o", "--output", metavar="SVG|PNG", help="draw the packing")
    pack.add_argument(
        "--show", default="both", choices=("circles", "mesh", "both"), help="what is drawn"
    )
    _add_json(pack)


def _add_gallery(commands: _Commands) -> None:
    gallery = _command(commands, "gallery", "list the ready-made surfaces")
    _add_json(gallery)


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


def _add_sizes(parser: argparse.ArgumentParser) -> None:
    sizes = parser.add_argument_group(
        "sizes, in model units; any of them sets aside the sizes that INPUT brings; without any, "
        "chord is a thousandth of the diagonal"
    )
    for name, (kind, said) in _SIZES.items():
        sizes.add_argument(f"--{name.replace('_', '-')}", type=kind, help=said)
    sizes.add_argument(
        "--proof", action="store_const", const=True, help="prove that the chord holds"
    )
    sizes.add_argument(
        "--vertices", choices=("on_surface", "balanced"),
        help="balanced: off the surface, so that it lies on both sides and volumes are kept",
    )  # fmt: skip
    sizes.add_argument(
        "--sizes", metavar="TOML", help='sizes by selection: [sizes."fillet*"] chord = 0.01'
    )


def _add_cad(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--no-strict", action="store_true", help="leave out CAD faces that cannot be meshed"
    )
    _add_units(parser)


def _add_units(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--run-python", action="store_true",
        help="run a program that you trust (.py) and take the CadQuery object that it calls result",
    )  # fmt: skip
    parser.add_argument(
        "--units", help="of the lengths of a CAD model: um, mm (default), cm, m, in, ft"
    )
    parser.add_argument(
        "--imprint",
        nargs="?",
        type=_near,
        default=False,
        metavar="TOL",
        help="bodies of a CAD model that touch (within TOL) share their faces",
    )
    parser.add_argument(
        "--sew",
        type=_positive,
        metavar="TOL",
        help="join loose faces of a CAD model whose edges lie within TOL; closed ones make solids",
    )
    parser.add_argument(
        "--time-limit",
        type=_positive,
        metavar="SECONDS",
        help="of processor time for reading a CAD file (default 8 and 25 for each MB of it)",
    )
    parser.add_argument(
        "--memory-limit",
        type=_positive,
        metavar="MB",
        help="of memory for reading a CAD file (default 1000 and 100 for each MB of it)",
    )
    parser.add_argument(
        "--no-isolate",
        dest="isolate",
        action="store_false",
        help="read a CAD file that you trust in this process, without limits",
    )


def _add_second_opinion(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--second-opinion", action="store_true",
        help="ask trimesh and pyvista too; where they disagree the mesh is not clean",
    )  # fmt: skip


def _add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--json", action="store_true", help="one JSON object on standard output, nothing else"
    )


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a positive number, not '{_brief(text)}'")
    return value


def _near(text: str) -> bool | float:
    return True if text == _BY_ROUNDING else _positive(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number, not '{_brief(text)}'") from None


def _whole(least: int, most: int = 10**15) -> Callable[[str], int]:
    """The type of whole numbers from ``least`` to ``most``."""

    def whole(text: str) -> int:
        is_short = text.isdecimal() and len(text) < 100  # int() takes thousands of digits badly
        if not is_short or not least <= int(text) <= most:
            span = f"from {least}" if most == 10**15 else f"from {least} to {most}"
            raise argparse.ArgumentTypeError(f"must be a whole number {span}, not '{_brief(text)}'")
        return int(text)

    return whole


_SIZES: dict[str, tuple[Callable[[str], float], str]] = {  # options of Sizing
    "chord": (_positive, "largest distance between mesh and surface"),
    "angle": (_positive, "largest angle between neighbours, degrees"),
    "size": (_positive, "wanted edge length"),
    "min_size": (_positive, "no edge is wanted shorter"),
    "max_size": (_positive, "no edge is wanted longer"),
    "growth": (_positive, "largest ratio of neighbouring sizes (default 1.2)"),
    "anisotropy": (_positive, "largest ratio of two sizes at a point (default 1: isotropic)"),
    "volume": (_positive, "largest relative error of solids' volumes, as 0.005"),
    "gap": (_positive, "at least so many triangles across thin faces and gaps"),
    "triangles": (_whole(4), "about so many in all, instead of chord, angle, size"),
    "limit": (_whole(1), "most triangles (default 20 million)"),
}
_READING = ("units", "imprint", "sew", "time_limit", "memory_limit", "isolate")  # options of load


def _brief(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


class _Version(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __init__(self, option_strings: list[str], dest: str) -> None:
        super().__init__(option_strings, dest, nargs=0, help="print the version")

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        import surfmesh

        print(f"surfmesh {surfmesh.__version__}")
        parser.exit(0)
