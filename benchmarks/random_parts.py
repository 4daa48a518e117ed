"""Random CadQuery parts, meshed and judged by measures of their own.

    python benchmarks/random_parts.py [--isotropic 300] [--stretched 200] [--seed 0]
        [--time-limit 60] [--json OUT.jsonl]

A part is a seed: a base shape, one to four features (holes, bosses, cuts, fillets, chamfers,
shells, patterns), of random sizes, turned at random. Invalid results of OpenCASCADE are left out.
Each is meshed in this process at a random sizing; the judge (``judge.py``) uses nothing of the
mesher: index topology, volume and area against OpenCASCADE's, edges that pierce triangles, and
the distance both ways against a fine tessellation. Exits with 1 when a part fails.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import math
import signal
import sys
from pathlib import Path
from random import Random
from time import process_time

import cadquery as cq
from judge import Verdict, judged
from tables import console, heading

import surfmesh as sm

KINDS = ("isotropic", "stretched")


def main() -> int:
    options = _options()
    heading(f"random parts, seed {options.seed}")
    out = open(options.json, "w", encoding="utf-8") if options.json else None
    bad = 0
    for kind in KINDS:
        rows = []
        wanted, number = getattr(options, kind), 0
        while len(rows) < wanted:
            draw = Random(f"{options.seed} {kind} {number}")
            part, number = _valid_part(draw), number + 1
            if part is None:
                continue
            row = _row(part, _sizing(draw, part, kind == "stretched"), options.time_limit)
            row = {"kind": kind, "part": number - 1, **row}
            rows.append(row)
            if out:
                print(json.dumps(row), file=out, flush=True)
            if row["faults"]:
                console.print(f"{kind} part {number - 1}: {'; '.join(row['faults'])}", markup=False)
        bad += _summary(kind, rows)
    return int(bad > 0)


def _row(part: cq.Shape, sizing: sm.Sizing, limit: float) -> dict:
    """One part meshed and judged."""
    start = process_time()
    signal.signal(signal.SIGALRM, _too_long)
    signal.setitimer(signal.ITIMER_REAL, limit)
    try:
        mesh = sm.mesh(part, sizing)
        spent = process_time() - start
        report = sm.check(mesh)
    except sm.errors.SurfmeshError as error:
        spent = process_time() - start
        return {"faults": [f"refused: {error}"[:200]], "triangles": 0, "cpu": spent}
    except TimeoutError:
        return {"faults": [f"not done in {limit:g} s"], "triangles": 0, "cpu": limit}
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    found: Verdict = judged(mesh.points, mesh.triangles, part.wrapped, sizing.chord)
    faults = list(found.faults)
    if faults and report.clean:
        faults.append("and the report is clean")
    if not faults and not report.clean:
        faults = [f"not clean: {problem}"[:200] for problem in report.problems]
    return {
        "faults": faults, "clean": report.clean, "triangles": len(mesh.triangles), "cpu": spent,
        "faces": len(mesh.surfaces), "alpha_min": report.alpha_min, **found.figures,
    }  # fmt: skip


def _too_long(*_: object) -> None:
    raise TimeoutError


def _summary(kind: str, rows: list[dict]) -> int:
    """Print a line of figures; returns how many parts are at fault."""
    if not rows:
        return 0
    bad = sum(bool(row["faults"]) for row in rows)
    untrue = sum("and the report is clean" in row["faults"] for row in rows)
    made = [row for row in rows if row["triangles"]]
    far = max((row["deviation"] for row in made if row["deviation"] is not None), default=0.0)
    console.print(
        f"{kind}: {len(rows)} parts, {bad} at fault, {untrue} of them reported clean; "
        f"{sum(row['triangles'] for row in made):,} triangles, "
        f"{sum(row['cpu'] for row in rows):.0f} s, slowest "
        f"{max(row['cpu'] for row in rows):.1f} s; largest distance {far:.3g} chord",
        markup=False,
    )
    return bad


def _sizing(draw: Random, part: cq.Shape, stretched: bool) -> sm.Sizing:
    box = part.BoundingBox()
    chord = box.DiagonalLength * 10 ** draw.uniform(-3.3, -2.0)
    options = {"growth": draw.choice((1.2, 1.3, 1.5))}
    if stretched:
        options["anisotropy"] = draw.choice((3.0, 5.0, 30.0))
    if draw.random() < 0.3:
        options["max_size"] = box.DiagonalLength * draw.uniform(0.03, 0.15)
    return sm.Sizing(chord=chord, **options)


def _valid_part(draw: Random) -> cq.Shape | None:
    """None where OpenCASCADE fails or calls its own result invalid."""
    try:
        part = _base(draw)
        for _ in range(draw.randint(1, 4)):
            part = draw.choice(_FEATURES)(draw, part)
        shape = part.val()
        axis = cq.Vector(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0.1, 1))
        shape = shape.rotate(cq.Vector(0, 0, 0), axis, draw.uniform(0, 360))
        sound = shape.isValid() and shape.Volume() > 0.0 and len(part.solids().vals()) == 1
    except Exception:  # OCP's own exceptions have no common parent
        return None
    return shape if sound else None


def _base(draw: Random) -> cq.Workplane:
    a, b, c = (draw.uniform(4, 20) for _ in range(3))
    kind = draw.choice(("box", "cylinder", "prism", "cone", "sphere", "revolved", "loft", "tube"))
    plane = cq.Workplane()
    if kind == "box":
        return plane.box(a, b, c)
    if kind == "cylinder":
        return plane.cylinder(c, a / 2)
    if kind == "prism":
        return plane.polygon(draw.randint(3, 9), a).extrude(c, taper=draw.choice((0, 5)))
    if kind == "cone":
        return cq.Workplane(obj=cq.Solid.makeCone(a / 2, draw.choice((0, a / 5)), c))
    if kind == "sphere":
        return plane.sphere(a / 2)
    if kind == "tube":
        return plane.circle(a / 2).circle(a / 2 * draw.uniform(0.5, 0.95)).extrude(c)
    if kind == "revolved":
        outline = plane.moveTo(a / 4, 0).lineTo(a / 2, 0)
        outline = outline.spline([(a / 3, c / 2), (a / 2.5, c)], includeCurrent=True)
        return outline.lineTo(a / 4, c).close().revolve(draw.choice((360, 200)), (0, 0), (0, 1))
    first = plane.rect(a, b).workplane(offset=c)
    return first.circle(min(a, b) / 3).loft()


def _reach(part: cq.Workplane) -> float:
    return part.val().BoundingBox().DiagonalLength


def _hole(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = cq.Workplane().cylinder(3 * size, size * 10 ** draw.uniform(-2.2, -0.8))
    return part.cut(_placed(draw, tool, size / 5))


def _boss(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = draw.choice((
        cq.Workplane().cylinder(size, size * draw.uniform(0.05, 0.15)),
        cq.Workplane().box(size / 4, size / 3, size),
        cq.Workplane().sphere(size / 4),
    ))  # fmt: skip
    return part.union(_placed(draw, tool, size / 5))


def _pocket(draw: Random, part: cq.Workplane) -> cq.Workplane:
    size = _reach(part)
    tool = draw.choice((
        cq.Workplane().box(size / 3, size / 4, size / 3),
        cq.Workplane().sphere(size / 5),
        cq.Workplane(obj=cq.Solid.makeTorus(size / 4, size / 16)),
        cq.Workplane(obj=cq.Solid.makeCone(size / 6, 0, size / 2)),
    ))  # fmt: skip
    return part.cut(_placed(draw, tool, size / 3))


def _fillet(draw: Random, part: cq.Workplane) -> cq.Workplane:
    edges = part.edges(draw.choice(("|Z", ">Z", "<Z", "%CIRCLE")))
    return edges.fillet(_reach(part) * draw.uniform(0.005, 0.06))


def _chamfer(draw: Random, part: cq.Workplane) -> cq.Workplane:
    return part.edges(draw.choice((">Z", "<Z"))).chamfer(_reach(part) * draw.uniform(0.002, 0.04))


def _shell(draw: Random, part: cq.Workplane) -> cq.Workplane:
    return part.faces(draw.choice((">Z", "<Z"))).shell(-_reach(part) * draw.uniform(0.01, 0.05))


def _pattern(draw: Random, part: cq.Workplane) -> cq.Workplane:
    step = _reach(part) / 8
    face = part.faces(">Z").workplane(centerOption="CenterOfBoundBox")
    return face.rarray(step, step, 2, draw.randint(1, 3)).hole(step * draw.uniform(0.05, 0.7))


_FEATURES = (_hole, _hole, _boss, _pocket, _fillet, _chamfer, _shell, _pattern)


def _placed(draw: Random, tool: cq.Workplane, away: float) -> cq.Workplane:
    axis = (draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0.1, 1))
    angle = draw.choice((0, 0, 90, draw.uniform(0, 180)))
    return tool.rotate((0, 0, 0), axis, angle).translate(
        tuple(draw.uniform(-away, away) for _ in range(3))
    )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--isotropic", type=int, default=300)
    parser.add_argument("--stretched", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--time-limit", type=float, default=60.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    if not math.isfinite(options.time_limit) or options.time_limit <= 0:
        parser.error("--time-limit must be positive")
    return options


if __name__ == "__main__":
    sys.exit(main())
