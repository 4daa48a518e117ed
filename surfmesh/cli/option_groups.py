"""Options that several commands have, and the types of what is typed after them."""

import argparse
import math
from collections.abc import Callable

BY_DEFAULT = "alpha"  # colour of pictures
BY_ROUNDING = "by-rounding"  # --imprint without a tolerance


def add_sizes(parser: argparse.ArgumentParser) -> None:
    """The options of ``Sizing``, and sizes by selection."""
    sizes = parser.add_argument_group(
        "sizes, in model units; any of them sets aside the sizes that INPUT brings; without any, "
        "chord is a thousandth of the diagonal"
    )
    for name, (kind, said) in SIZES.items():
        sizes.add_argument(f"--{name.replace('_', '-')}", type=kind, help=said)
    sizes.add_argument(
        "--proof", action="store_const", const=True, help="prove that the chord holds"
    )
    sizes.add_argument(
        "--fewest", action="store_const", const=True,
        help="as few triangles as keep the chord, for more time",
    )  # fmt: skip
    sizes.add_argument(
        "--vertices", choices=("on_surface", "balanced"),
        help="balanced: off the surface, so that it lies on both sides and volumes are kept",
    )  # fmt: skip
    sizes.add_argument(
        "--sizes", metavar="TOML", help='sizes by selection: [sizes."fillet*"] chord = 0.01'
    )


def add_cad(parser: argparse.ArgumentParser) -> None:
    """How a CAD model is read and meshed."""
    parser.add_argument(
        "--no-strict", action="store_true", help="leave out CAD faces that cannot be meshed"
    )
    add_reading(parser)


def add_reading(parser: argparse.ArgumentParser) -> None:
    """The options of ``load``."""
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
        type=positive,
        metavar="TOL",
        help="join loose faces of a CAD model whose edges lie within TOL; closed ones make solids",
    )
    parser.add_argument(
        "--time-limit",
        type=positive,
        metavar="SECONDS",
        help="of processor time for reading a CAD file (default 8 and 25 for each MB of it)",
    )
    parser.add_argument(
        "--memory-limit",
        type=positive,
        metavar="MB",
        help="of memory for reading a CAD file (default 1000 and 100 for each MB of it)",
    )
    parser.add_argument(
        "--no-isolate",
        dest="isolate",
        action="store_false",
        help="read a CAD file that you trust in this process, without limits",
    )


def add_second_opinion(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--second-opinion", action="store_true",
        help="ask trimesh and pyvista too; where they disagree the mesh is not clean",
    )  # fmt: skip


def add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--json", action="store_true", help="one JSON object on standard output, nothing else"
    )


def positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a positive number, not '{_brief(text)}'")
    return value


def _near(text: str) -> bool | float:
    return True if text == BY_ROUNDING else positive(text)


def number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number, not '{_brief(text)}'") from None


def whole_number(least: int, most: int = 10**15) -> Callable[[str], int]:
    """The type of whole numbers from ``least`` to ``most``."""

    def whole(text: str) -> int:
        is_short = text.isdecimal() and len(text) < 100  # int() takes thousands of digits badly
        if not is_short or not least <= int(text) <= most:
            span = f"from {least}" if most == 10**15 else f"from {least} to {most}"
            raise argparse.ArgumentTypeError(f"must be a whole number {span}, not '{_brief(text)}'")
        return int(text)

    return whole


def _brief(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


SIZES: dict[str, tuple[Callable[[str], float], str]] = {  # options of Sizing
    "chord": (positive, "largest distance between mesh and surface"),
    "angle": (positive, "largest angle between neighbours, degrees"),
    "size": (positive, "wanted edge length"),
    "min_size": (positive, "no edge is wanted shorter"),
    "max_size": (positive, "no edge is wanted longer"),
    "growth": (positive, "largest ratio of neighbouring sizes (default 1.2)"),
    "anisotropy": (positive, "largest ratio of two sizes at a point (default 1: isotropic)"),
    "volume": (positive, "largest relative error of solids' volumes, as 0.005"),
    "gap": (positive, "at least so many triangles across thin faces and gaps"),
    "triangles": (whole_number(4), "about so many in all, instead of chord, angle, size"),
    "limit": (whole_number(1), "most triangles (default 20 million)"),
}
READING = ("units", "imprint", "sew", "time_limit", "memory_limit", "isolate")  # options of load
