"""How fast surfmesh is, beside gmsh, netgen, MMGS and Triangle. One command:

    python benchmarks/speed.py [--only SECTION ...] [--quick | --large] [--json PATH]

Sections: install, start, cad, plane, surfaces, checks, stretched, cores, memory. Everything is
timed in processes of its own with one thread, as processor time, which other work on the machine
hardly changes; medians of three. Only ``cores`` and ``install`` look at the clock on the wall.
Beside each figure stands what is wanted of it, printed as soon as it is measured; the exit status
is 1 when something is missed. ``install`` runs only when it is asked for: it compiles the core
from nothing. ``--large`` adds a million triangles of each surface, four million on two cores and
ten million in one mesh; ``--quick`` does everything once and leaves the model of 978 faces out. On
that netgen, which takes minutes, is not asked.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import speed_install
import speed_jobs
import speed_parts
from rich.markup import escape
from tables import MARK, console, heading, note
from wanted import Wanted

TIMEOUT, QUICK_TIMEOUT = 900.0, 120.0
NETGEN_FACES = 100  # of larger models netgen is not asked
PLANE_SIZE = 0.00175  # the smallest edge: 100 thousand triangles
CAD_SIZE = 1.0
CHORDS = {"two_peaks": 6.8e-4, "wavy": 3.5e-2}  # 100 thousand triangles at GROWTH
GROWTH = 1.15
STRETCH = 8.0
SURFACE_SPEED, PLANE_SPEED = 300e3, 400e3
TARGET_SHAPE = {"alpha_mean": 0.993, "alpha_p01": 0.94, "alpha_min": 0.85}
PER_FACE = 3.0  # times as fast as gmsh
CHECK_SHARES = {"check": 0.20, "estimate": 0.15}  # of the time of the mesh


@dataclass
class Figures:
    """Rows of one section, printed one by one: a figure, what is wanted of it, and a remark."""

    folder: Path
    large: bool = False
    times: int = 3
    rows: list[tuple[Wanted, float | None, str]] = field(default_factory=list)

    @property
    def timeout(self) -> float:
        """Seconds for one job."""
        return TIMEOUT if self.times > 1 else QUICK_TIMEOUT

    @property
    def missed(self) -> int:
        return sum(row.met(value) is False for row, value, _ in self.rows)

    def add(self, row: Wanted, value: float | None, remark: str = "") -> None:
        self.rows.append((row, value, remark))
        figure = f"  {row.title:<46} {row.shown(value):>9}  {row.bound:<10}"
        console.print(f"{escape(figure)} {MARK[row.met(value)]} {escape(remark)}".rstrip())

    def ask(self, job: str, **request: object) -> dict:
        """What a job says; a failure becomes a row."""
        with console.status(job):
            found = speed_jobs.run(job, self.timeout, times=self.times, **request)
        if "error" in found:
            self.add(Wanted(f"{job} failed"), None, found["error"])
        return found


def main() -> int:
    options = _options()
    missed, results = 0, {}
    with tempfile.TemporaryDirectory(prefix="surfmesh-") as folder:
        for name in options.only or [name for name in SECTIONS if name != "install"]:
            figures = Figures(Path(folder), options.large, 1 if options.quick else 3)
            heading(f"{name}: {SECTIONS[name].__doc__}")
            SECTIONS[name](figures)
            missed += figures.missed
            results[name] = [(row.title, value, remark) for row, value, remark in figures.rows]
    note(f"load average {os.getloadavg()[0]:.1f}; {missed} figures are missed")
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=2) + "\n")
    return 1 if missed else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="How fast surfmesh is, beside other meshers.")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, metavar="SECTION")
    parser.add_argument("--large", action="store_true", help="meshes of millions of triangles too")
    parser.add_argument("--quick", action="store_true", help="once, and no large model")
    parser.add_argument("--json", metavar="PATH", help="write everything as one JSON object")
    return parser.parse_args()


def install(figures: Figures) -> None:
    """seconds on the wall of `make mesh` in a fresh copy with an empty environment, once"""
    most = {"build": 60.0}
    try:
        found = speed_install.install(figures.folder, TIMEOUT)
    except (RuntimeError, ValueError, OSError, subprocess.SubprocessError) as error:
        figures.add(Wanted("make mesh failed"), None, str(error))
        return
    for part, seconds in found.items():
        figures.add(Wanted(f"make mesh: {part}", most=most.get(part), digits=1), seconds)


# start: whole commands, each with its children


def start(figures: Figures) -> None:
    """processor seconds of whole commands, interpreter and all"""
    python, folder, times = sys.executable, figures.folder, figures.times
    mesh = [python, "-m", "surfmesh", "mesh"]
    first = [python, "-c", "import surfmesh as sm; sm.mesh(sm.load('torus'))"]
    figures.add(Wanted("first mesh", most=1.5, digits=2), spent(first, times))
    torus = spent([*mesh, "torus", "-o", str(folder / "torus.vtu")], times)
    figures.add(Wanted("torus by command", most=1.0, digits=2), torus)
    bare = spent([python, "-c", "import OCP"], times)
    figures.add(Wanted("bare import of OCP", digits=2), bare)
    size = ["-clmin", str(CAD_SIZE), "-clmax", str(CAD_SIZE), "-nt", "1", "-v", "0"]
    for faces in (11, 978) if times > 1 else (11,):
        file = str(speed_parts.written(folder, faces))
        options = ["-o", str(folder / "part.vtu"), "--size", str(CAD_SIZE), "--jobs", "1"]
        ours = spent([*mesh, file, *options], times)
        figures.add(Wanted(f"{faces} faces by command", digits=2), ours)
        if faces == 11:
            row = Wanted("11 faces, over the import of OCP", most=0.9, digits=2)
            figures.add(row, ours - bare)
        if gmsh := gmsh_command():
            theirs = spent([*gmsh, file, "-2", *size, "-o", str(folder / "gmsh.msh")], times)
            figures.add(Wanted(f"{faces} faces by gmsh's command", digits=2), theirs)
            least = 1.0 if faces > 11 else None
            row = Wanted(f"{faces} faces: gmsh's over ours", least=least, digits=2)
            figures.add(row, theirs / ours)


def gmsh_command() -> list[str] | None:
    script = Path(sys.executable).parent / "gmsh"
    if script.exists():
        return [sys.executable, str(script)]
    return [found] if (found := shutil.which("gmsh")) else None


def spent(command: list[str], times: int) -> float:
    """Processor seconds of a command and its children, the median; Python keeps its bytecode."""
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    seconds = []
    for _ in range(times):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1):  # 1: a mesh was made, its report is not clean
            raise RuntimeError(f"{' '.join(command)} failed: {done.stderr.strip()[-300:]}")
        seconds.append(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    return statistics.median(seconds)


# meshes, warm


def cad(figures: Figures) -> None:
    """CAD models, the same sizes and counts; processor time of the mesh alone"""
    models = speed_parts.FACES if figures.times > 1 else speed_parts.FACES[:-1]
    for faces in (*models, None):
        file = str(speed_parts.written(figures.folder, faces))
        name = f"{faces} faces" if faces else f"{speed_parts.LOFTS} lofts"
        ours = figures.ask("cad_surfmesh", file=file, size=CAD_SIZE)
        if "error" in ours:
            continue
        per_face = 1e3 * ours["seconds"] / ours["faces"]
        figures.add(Wanted(f"{name}: milliseconds a face", digits=2), per_face, shape_text(ours))
        few = faces is None or faces <= NETGEN_FACES
        for mesher in ("cad_gmsh", "cad_netgen") if few else ("cad_gmsh",):
            theirs = figures.ask(mesher, file=file, size=CAD_SIZE, wanted=ours["triangles"])
            if "error" not in theirs:
                least = PER_FACE if mesher == "cad_gmsh" else None
                row = Wanted(f"{name}: times as fast as {mesher[4:]}", least=least, digits=2)
                figures.add(row, theirs["seconds"] / ours["seconds"], shape_text(theirs))
            if mesher == "cad_gmsh" and "error" not in theirs:
                for key in TARGET_SHAPE:
                    row = Wanted(f"{name}: {key}, ours less gmsh's", least=0.0)
                    figures.add(row, ours[key] - theirs[key])


def shape_text(found: dict) -> str:
    figures = " / ".join(f"{found[key]:.3f}" for key in TARGET_SHAPE)
    return f"{found['triangles']:,} triangles, alpha {figures}"


def plane(figures: Figures) -> None:
    """the unit square, sizes growing fivefold from its middle, about 100 thousand triangles"""
    ours = figures.ask("plane_surfmesh", size=PLANE_SIZE)
    if "error" in ours:
        return
    speed = ours["triangles"] / ours["seconds"]
    row = Wanted("triangles a second", least=PLANE_SPEED, digits=0)
    figures.add(row, speed, shape_text(ours))
    for key, least in TARGET_SHAPE.items():
        figures.add(Wanted(key, least=least, digits=4), ours[key])
    for mesher in ("plane_triangle", "plane_gmsh"):
        theirs = figures.ask(mesher, size=PLANE_SIZE)
        if "error" not in theirs:
            ratio = speed * theirs["seconds"] / theirs["triangles"]
            row = Wanted(f"times as many a second as {mesher[6:]}", digits=2)
            figures.add(row, ratio, shape_text(theirs))


def surfaces(figures: Figures) -> None:
    """surfaces of formulas, growth 1.15"""
    import peers

    for name, chord in CHORDS.items():
        for millions in (0.1, 1.0) if figures.large else (0.1,):
            sizing = {"chord": 0.1 * chord / millions, "growth": GROWTH}
            ours = figures.ask("surface_surfmesh", name=name, sizing=sizing)
            if "error" in ours:
                continue
            speed = ours["triangles"] / ours["seconds"]
            row = Wanted(f"{name}: triangles a second", least=SURFACE_SPEED, digits=0)
            figures.add(row, speed, f"{shape_text(ours)}; {stages_text(ours['stages'])}")
            for mesher in ("gmsh spline", "mmgs") if millions < 1.0 else ():
                theirs = peers.peer(mesher, name, sizing, ours["triangles"], figures.timeout)
                if "error" in theirs:
                    figures.add(Wanted(f"{name}: {mesher}"), None, theirs["error"])
                    continue
                row = Wanted(f"{name}: times as many a second as {mesher}", digits=2)
                figures.add(row, speed / theirs["triangles_a_second"], shape_text(theirs))


def stages_text(stages: dict) -> str:
    whole = sum(stages.values())
    return ", ".join(f"{name} {seconds / whole:.0%}" for name, seconds in stages.items())


def checks(figures: Figures) -> None:
    """`check` and `estimate`: processor time over that of the mesh"""
    models = speed_parts.FACES if figures.times > 1 else speed_parts.FACES[:-1]
    for faces in (*models, None):
        file = str(speed_parts.written(figures.folder, faces))
        name = f"{faces} faces" if faces else f"{speed_parts.LOFTS} lofts"
        add_checks(figures, name, figures.ask("checked_model", file=file, size=CAD_SIZE))
    for name, chord in CHORDS.items():
        sizing = {"chord": chord, "growth": GROWTH}
        add_checks(figures, name, figures.ask("checked_surface", name=name, sizing=sizing))


def add_checks(figures: Figures, name: str, found: dict) -> None:
    for what, most in CHECK_SHARES.items() if "error" not in found else ():
        row = Wanted(f"{name}: {what} over mesh", most=most, digits=2)
        figures.add(row, found[what] / found["mesh"], f"mesh {found['mesh']:.3f} s")


def stretched(figures: Figures) -> None:
    """sizes that depend on the direction: processor time a triangle over the isotropic one"""
    for name, chord in CHORDS.items():
        plain = {"chord": chord, "growth": GROWTH}
        cost = []
        for sizing in (plain, {**plain, "chord": 0.5 * chord, "anisotropy": STRETCH}):
            found = figures.ask("surface_surfmesh", name=name, sizing=sizing)
            if "error" in found:
                break
            cost.append(found["seconds"] / found["triangles"])
        if len(cost) == 2:
            row = Wanted(f"{name}: anisotropy {STRETCH:g} over isotropic", most=1.5, digits=2)
            figures.add(row, cost[1] / cost[0], f"{found['triangles']:,} triangles")


def cores(figures: Figures) -> None:
    """the clock on the wall with jobs=1 over that with jobs=2"""
    file = str(speed_parts.written(figures.folder, 978))
    size = {"size": CAD_SIZE}
    cases = {"978 faces": {"file": file, "sizing": size, "warm": size}}
    if figures.large:
        chord = CHORDS["wavy"]
        fine, warm = ({"chord": part * chord, "growth": GROWTH} for part in (1.0 / 40.0, 1.0))
        cases["one face of 4 million triangles"] = {
            "name": "wavy", "sizing": fine, "warm": warm,
        }  # fmt: skip
    for name, request in cases.items():
        found = figures.ask("cores_surfmesh", **request)
        if "error" not in found:
            remark = f"{found['one']:.2f} s and {found['two']:.2f} s"
            figures.add(Wanted(name, least=1.8, digits=2), found["ratio"], remark)


def memory(figures: Figures) -> None:
    """one mesh of wavy: gigabytes over the interpreter, and how time grows"""
    rates = []
    for millions in (0.5, 10.0) if figures.large else (0.5, 1.0):
        sizing = {"chord": 0.1 * CHORDS["wavy"] / millions, "growth": GROWTH, "limit": 20_000_000}
        found = figures.ask("memory_surfmesh", name="wavy", sizing=sizing)
        if "error" in found:
            return
        most = 2.0 * found["triangles"] / 10e6
        row = Wanted(f"{millions:g} million triangles: gigabytes", most=most, digits=3)
        figures.add(row, found["gigabytes"], f"{found['triangles']:,} in {found['seconds']:.1f} s")
        rates.append(found["seconds"] / found["triangles"])
    row = Wanted("processor time a triangle, last over first", most=1.1, digits=2)
    figures.add(row, rates[-1] / rates[0])


SECTIONS: dict[str, Callable[[Figures], None]] = {
    section.__name__: section
    for section in (install, start, cad, plane, surfaces, checks, stretched, cores, memory)
}


if __name__ == "__main__":
    sys.exit(main())
