"""A small grammar of command lines: commands, their options, good and odd values of these.

A line is a function of a seed and a number. FOLDER stands for a folder with a few files in it.
"""

from random import Random

NUMBERS = (
    "1", "0.5", "2", "0", "-1", "1e-300", "1e-12", "1e300", "1e999", "nan", "-inf", "inf", "x", "",
    " ", "0x1", "1_0", "١", "1,5", "2**31", "-0.0", "1e-9",
)  # fmt: skip
WHOLE = ("1", "2", "0", "-1", "1.5", "99999999999999999999", "x", "", "1e3", "٣", "1" + "0" * 5000)
FORMULAS = (
    "u", "v", "u*v", "sin(u)", "0", "1/u", "sqrt(u)", "u**", "(", ")", "u" + "+u" * 200,
    "-u", "9**9**9", "1e400", "nan", "sqrt(-1)", "u\0", "π*u", "import os", "u.real", "x", "",
    "u;v", "abs(u)**0.1", "(" * 300 + "u" + ")" * 300, "\x1b[2Ju", "u\nv", "u if v else 1", "'u'",
)  # fmt: skip
BOUNDS = (
    "0",
    "1",
    "-1",
    "2*pi",
    "pi",
    "1e300",
    "-1e300",
    "nan",
    "inf",
    "u",
    "",
    "1/0",
    "1e-300",
    "0.5",
)
INPUTS = (
    "FOLDER/tetra.off", "FOLDER/bad.off", "FOLDER/surface.toml", "FOLDER/bad.toml",
    "FOLDER/domain.toml", "FOLDER/sizes.toml", "FOLDER/bad.step", "FOLDER/odd\n\x1b[31mname.off",
    "FOLDER/none.vtu", "FOLDER", "plane", "torus", "no such", "", "\0", "-", "--", "/dev/null",
    "a" * 300 + ".vtu", "..", "tôrus", "FOLDER/\x1b[2J.vtu", "FOLDER/bad.off/x.vtu",
)  # fmt: skip
GOOD_INPUTS = ("plane", "FOLDER/surface.toml", "FOLDER/domain.toml", "FOLDER/tetra.off")
OUTPUTS = {
    "mesh": ("FOLDER/o.vtu", "FOLDER/o.stl", "FOLDER/o.3mf", "FOLDER/o.bdf"),
    "picture": ("FOLDER/o.svg",),
    "report": ("FOLDER/o.html", "FOLDER/o.json"),
}
ODD_OUTPUTS = (
    "FOLDER", "FOLDER/none/o.vtu", "o", "FOLDER/o.xyz", "", "\0.vtu", "/dev/full",
    "FOLDER/" + "a" * 300 + ".vtu", "FOLDER/tetra.off/o.vtu", "FOLDER/o.vtu\n",
)  # fmt: skip
SIZES = ("--chord", "--angle", "--size", "--min-size", "--max-size", "--growth", "--anisotropy",
         "--volume", "--gap")  # fmt: skip


def command_line(seed: int, number: int) -> list[str]:
    """The words after ``surfmesh``."""
    random = Random(f"command {seed} {number}")
    command = random.choice(
        ("mesh", "mesh", "mesh", "check", "explain", "estimate", "pack", "report")
    )
    words = [command, *_COMMANDS[command](random)]
    if random.random() < 0.3:
        words.append("--json")
    if random.random() < 0.05:
        at = random.randrange(len(words) + 1)
        words.insert(at, random.choice(("--odd", "-x", "", "\0", "--help", "--version", "--", "é")))
    return words


def _input(random: Random) -> str:
    return random.choice(GOOD_INPUTS if random.random() < 0.6 else INPUTS)


def _output(random: Random, kind: str) -> list[str]:
    return ["-o", random.choice(OUTPUTS[kind] if random.random() < 0.8 else ODD_OUTPUTS)]


def _sizes(random: Random) -> list[str]:
    """Coarse sizes, or odd ones; a fine size is no fault but takes long."""
    if random.random() < 0.4:
        return ["--size", "0.5"]
    words = []
    for _ in range(random.choice((1, 1, 2, 3))):
        words += [random.choice(SIZES), random.choice(NUMBERS)]
    if random.random() < 0.2:
        words += ["--limit", random.choice(WHOLE)]
    if random.random() < 0.1:
        words += [
            "--sizes",
            random.choice(("FOLDER/sizes.toml", "FOLDER/bad.toml", "none", "FOLDER")),
        ]
    return words


def _mesh(random: Random) -> list[str]:
    words = _output(random, "mesh") + _sizes(random)
    if random.random() < 0.4:
        for axis in "xyz":
            words += [
                f"--{axis}",
                random.choice(FORMULAS if random.random() < 0.5 else ("u", "v", "u*v")),
            ]
        for axis in "uv":
            odd = random.random() < 0.3
            words += [f"--{axis}", *(random.choice(BOUNDS) if odd else end for end in ("0", "1"))]
        if random.random() < 0.2:
            given = (
                "a=1",
                "a",
                "=1",
                "a=x",
                "a=nan",
                "u=1",
                "pi=3",
                "sin=1",
                "a=1e999",
                "é=1",
                "\0=1",
            )
            words += ["--param", random.choice(given)]
    else:
        words.insert(0, _input(random))
    options = {
        "--order": ("1", "2", "3", "x"), "--jobs": ("1", "0", "-1", "x"),
        "--report": OUTPUTS["report"] + ODD_OUTPUTS, "--units": ("mm", "parsec", "", "\x1b"),
        "--imprint": NUMBERS, "--sew": NUMBERS,
    }  # fmt: skip
    for option, values in options.items():
        if random.random() < 0.08:
            words += [option, random.choice(values)]
    for flag in ("--no-optimise", "--flip", "--ascii", "--simplify", "--no-strict"):
        if random.random() < 0.08:
            words.append(flag)
    return words


def _check(random: Random) -> list[str]:
    words = [random.choice(("FOLDER/tetra.off", *INPUTS))]
    if random.random() < 0.3:
        words += ["--surface", _input(random)]
    return words


def _explain(random: Random) -> list[str]:
    return [_input(random), "--at", *random.choices(NUMBERS, k=3), *_sizes(random)]


def _estimate(random: Random) -> list[str]:
    return [_input(random), *_sizes(random)]


def _pack(random: Random) -> list[str]:
    """Always with an end; a count that is too large is no fault but takes long."""
    words = random.choice((["--radius", random.choice(NUMBERS)],
                           ["--uniform", "1", random.choice(NUMBERS)],
                           ["--uniform", *random.choices(NUMBERS, k=2)]))  # fmt: skip
    words += ["--count", random.choice(("30", "30", "30", "1", "2", "0", "-1", "x", ""))]
    if random.random() < 0.4:
        words += ["--seed", random.choice(WHOLE)]
    if random.random() < 0.3:
        words += ["--origin", *random.choices(NUMBERS, k=2)]
    if random.random() < 0.3:
        words += ["--distance", random.choice(NUMBERS)]
    if random.random() < 0.3:
        words += ["--box", *random.choices(NUMBERS, k=4)]
    if random.random() < 0.3:
        words += _output(random, "picture")
    return words


def _report(random: Random) -> list[str]:
    found = "FOLDER/tetra.off" if random.random() < 0.6 else _input(random)
    return [found, *_output(random, "report"), *_sizes(random)]


_COMMANDS = {"mesh": _mesh, "check": _check, "explain": _explain, "estimate": _estimate,
             "pack": _pack, "report": _report}  # fmt: skip
