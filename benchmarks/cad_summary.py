"""The records of a CAD run judged: a table with a row for each model and mesher, and totals."""

import math
from collections.abc import Iterable
from statistics import fmean

from cad_measures import POOR
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from tables import heading, note
from tables import show as show_rows
from wanted import Wanted

ENOUGH = 0.005  # relative error of volumes and areas
NAMES_SHOWN = 12
WIDTH = 210  # of the table of models


def show(records: list[dict]) -> int:
    """Print everything; return 1 when something wanted is missed."""
    models = _by_model(records)
    _table(models)
    ours = [found["ours"] for found in models.values() if "ours" in found]
    ours = [record for record in ours if not record.get("left_out")]
    columns = {"surfmesh": _totals(ours, models)} if ours else {}
    beside = {}
    for mesher in ("gmsh", "ocp"):
        theirs = [found[mesher] for found in models.values() if mesher in found]
        if theirs:
            beside[mesher] = _totals(theirs, models)
    if not columns and not beside:
        return 0
    heading("All models together")
    missed = show_rows(_wanted(beside.get("gmsh", {})), columns, beside)
    both = _pairs(models)
    if both:
        heading(f"The {len(both)} models that surfmesh and gmsh both meshed whole")
        pair = {"surfmesh": _shape([a for a, _ in both]), "gmsh": _shape([b for _, b in both])}
        rows = _wanted_beside(pair["gmsh"])
        missed += show_rows(rows, {"surfmesh": pair["surfmesh"]}, {"gmsh": pair["gmsh"]})
    _failures(models)
    return int(missed > 0)


def _by_model(records: Iterable[dict]) -> dict[str, dict[str, dict]]:
    """file -> mesher -> record, with each solid's facts beside what was measured of it."""
    models: dict[str, dict[str, dict]] = {}
    for record in records:
        models.setdefault(record["file"], {})[record["mesher"]] = dict(record)
    for found in models.values():
        facts = (found.get("ours") or found.get("facts") or {}).get("facts", [])
        chord = next((r["chord"] for r in found.values() if "chord" in r), 0.0)
        for mesher, record in found.items():
            record["chord"] = chord
            record["judged"] = _judged(record.get("solids"), facts, chord, mesher == "ours")
    return models


def _judged(
    solids: list[dict] | None, facts: list[dict], chord: float, ordered: bool
) -> list[dict]:
    """Verdicts on the solids that are closed in the B-rep.

    Other meshers number solids as they like: theirs go by their exact volumes.
    """
    closed = [fact for fact in facts if fact["closed"]]
    if solids is None:
        return [{"meshed": False} for _ in closed]
    if ordered:
        pairs = list(zip(solids, facts))
    elif len(solids) == len(facts):
        by_size = sorted(solids, key=lambda solid: solid["volume_exact"])
        pairs = list(zip(by_size, sorted(facts, key=lambda fact: fact["volume"])))
    else:
        return [{"meshed": False} for _ in closed]
    return [_verdict(solid, fact, chord) for solid, fact in pairs if fact["closed"]]


def _verdict(solid: dict, fact: dict, chord: float) -> dict:
    if not solid.get("triangles"):
        return {"meshed": False, "faces": fact["faces"]}
    crowded = solid["crowded"] > 0 and fact["most"] <= 2
    watertight = solid["open"] == 0 and not crowded
    volume, area = (solid[k] / fact[k] - 1.0 if fact[k] else math.inf for k in ("volume", "area"))
    return {
        "meshed": True,
        "watertight": watertight,
        "oriented": solid["uneven"] == 0,
        "euler": solid["euler"] == fact["euler"],
        "volumes": (solid["volume"], fact["volume"]),
        "volume_error": abs(volume),
        "area_error": abs(area),
        "by_chord": chord * fact["area"] / fact["volume"] if fact["volume"] else math.inf,
        "said": f"{solid['open']} open, {solid['crowded']} crowded, {solid['uneven']} uneven "
        f"edges, Euler {solid['euler']} for {fact['euler']}, "
        f"volume {100 * volume:+.2f} %, area {100 * area:+.2f} %",
        "faces": fact["faces"],
    }


def _good(verdict: dict) -> bool:
    return (
        verdict["meshed"] and verdict["watertight"] and verdict["oriented"] and verdict["euler"]
        and verdict["volume_error"] <= max(ENOUGH, verdict["by_chord"])
    )  # fmt: skip


def _silent(record: dict) -> int:
    """Holes that no face that was named as not meshed explains: solids that are not watertight,
    else cracks in sheets; and faces without triangles."""
    named = set(record.get("failed_faces", ()))
    holes = [
        verdict for verdict in record["judged"]
        if verdict.get("watertight") is False and not named & set(verdict["faces"])
    ]  # fmt: skip
    cracks = len(holes) or int(record.get("stray", 0) > 0)
    return cracks + len(record.get("bare_faces", ()))


def _whole_volume_error(record: dict) -> float:
    """Of the closed solids of a model together."""
    pairs = [verdict.get("volumes") for verdict in record["judged"]]
    if None in pairs:
        return math.inf
    found, exact = (math.fsum(column) for column in zip(*pairs))
    return abs(found / exact - 1.0) if exact else math.inf


def _share(flags: Iterable[bool]) -> float | None:
    flags = list(flags)
    return sum(flags) / len(flags) if flags else None


def _totals(records: list[dict], models: dict) -> dict:
    """Figures of one mesher over all its models."""
    solids = [verdict for record in records for verdict in record["judged"]]
    meshed = [record for record in records if record.get("triangles")]
    figures = {
        "models": len(records),
        "crashed": sum(record.get("ended") == "crash" for record in records),
        "hung": sum(record.get("ended") == "hang" and "error" in record for record in records),
        "refused": sum(record.get("ended") in ("refusal", "failure") for record in records),
        "faces": sum(record.get("faces", 0) for record in records),
        "failed": sum(record.get("failed", 0) for record in meshed),
        "solids": len(solids),
        "watertight": _share(bool(v.get("watertight")) for v in solids),
        "oriented": _share(bool(v.get("oriented")) for v in solids),
        "euler": _share(bool(v.get("euler")) for v in solids),
        "volume": _share(v.get("volume_error", math.inf) <= ENOUGH for v in solids),
        "by_chord": _share(
            v.get("volume_error", math.inf) <= max(ENOUGH, v.get("by_chord", 0.0)) for v in solids
        ),
        "area": _share(v.get("area_error", math.inf) <= ENOUGH for v in solids),
        "good": _share(_good(v) for v in solids),
        "whole_volume": _share(
            _whole_volume_error(record) <= ENOUGH for record in records if record["judged"]
        ),
        **_shape(meshed),
    }
    fitted = [record for record in meshed if "above_chord" in record]
    if fitted:
        above = sum(record["above_chord"] for record in fitted)
        figures["within_chord"] = 1.0 - above / sum(record["triangles"] for record in fitted)
        figures["worst"] = max(record["deviation_max"] / record["chord"] for record in fitted)
        figures["too_far"] = sum(
            record["deviation_max"] > 1.5 * record["chord"] for record in fitted
        )
        figures["inverted"] = sum(record["inverted"] for record in fitted)
        figures["silent"] = sum(_silent(record) for record in fitted)
        figures["clean"] = _share(
            bool(record["clean"]) for record in fitted if "clean" in record and record["judged"]
        )
        figures["sheet_area"] = _share(
            abs(record["area"] / record["area_exact"] - 1.0) <= ENOUGH for record in records
            if "area_exact" in record and "area" in record
        )  # fmt: skip
    sampled = [record for record in meshed if "sampled" in record]
    if sampled:
        above = sum(record["sampled_above"] * _weight(record) for record in sampled)
        figures["within_chord"] = 1.0 - above / sum(record["triangles"] for record in sampled)
        figures["worst"] = max(record["sampled_max"] / record["chord"] for record in sampled)
        figures["too_far"] = sum(
            record["sampled_max"] > 1.5 * record["chord"] for record in sampled
        )
    return figures


def _weight(record: dict) -> float:
    """Triangles that one of the sample stands for."""
    return record["triangles"] / record["sampled"]


def _shape(records: list[dict]) -> dict:
    """Triangles and time; the mean of alpha is over models, lest the large ones decide."""
    count = sum(record["triangles"] for record in records)
    if not count:
        return {}
    faces = sum(record["faces"] for record in records)
    seconds = sum(record["cpu_mesh"] for record in records)
    return {
        "triangles": count,
        "alpha_mean": fmean(record["alpha_mean"] for record in records),
        "alpha_all": sum(r["alpha_mean"] * r["triangles"] for r in records) / count,
        "alpha_min": min(record["alpha_min"] for record in records),
        "poor": sum(record["poor"] for record in records) / count,
        "ms_a_face": 1e3 * seconds / faces,
        "wall": 1e3 * sum(record["seconds_mesh"] for record in records) / faces,
        "triangles_a_second": count / seconds,
        "read": 1e3 * sum(record["seconds_read"] for record in records) / faces,
    }


def _pairs(models: dict) -> list[tuple[dict, dict]]:
    """(ours, gmsh's) of the models where neither left a face out."""
    pairs = [(found.get("ours", {}), found.get("gmsh", {})) for found in models.values()]
    return [pair for pair in pairs if all(r.get("triangles") and not r.get("failed") for r in pair)]


def _wanted(gmsh: dict) -> dict[str, Wanted]:
    percent = {"percent": True, "digits": 2}
    return {
        "models": Wanted("models", digits=0),
        "crashed": Wanted("crashes", most=0, digits=0),
        "hung": Wanted("not done within the time limit", most=0, digits=0),
        "refused": Wanted("refused or failed", most=0, digits=0),
        "faces": Wanted("faces", digits=0),
        "failed": Wanted("faces not meshed", most=0, digits=0),
        "silent": Wanted("holes without a word", most=0, digits=0),
        "solids": Wanted("solids closed in the B-rep", digits=0),
        "watertight": Wanted("  watertight", least=1.0, **percent),
        "oriented": Wanted("  oriented", least=1.0, **percent),
        "euler": Wanted("  Euler number of the B-rep", least=1.0, **percent),
        "volume": Wanted("  volume within 0.5 %, which is not asked for", **percent),
        "by_chord": Wanted("  volume within 0.5 % or chord x area", least=1.0, **percent),
        "area": Wanted("  area within 0.5 %", **percent),
        "good": Wanted("  closed, Euler number, volume by chord", least=1.0, **percent),
        "whole_volume": Wanted("models with their volume within 0.5 %, solids together", **percent),
        "sheet_area": Wanted("models with their area within 0.5 %", **percent),
        "clean": Wanted("models of closed solids with a clean report", least=1.0, **percent),
        "within_chord": Wanted("triangles within chord", least=0.999, **percent),
        "worst": Wanted("largest deviation / chord", most=1.5),
        "too_far": Wanted("models beyond 1.5 chord", most=0, digits=0),
        "inverted": Wanted("inverted triangles", most=0, digits=0),
        "triangles": Wanted("triangles", digits=0),
        "alpha_min": Wanted("smallest alpha"),
        **_wanted_beside(gmsh, judged=False),
    }


def _wanted_beside(gmsh: dict, judged: bool = True) -> dict[str, Wanted]:
    """What is to be no worse than gmsh's; judged where the models are the same."""
    bound = gmsh if judged else {}
    return {
        "triangles": Wanted("triangles", digits=0),
        "alpha_mean": Wanted("alpha, mean over models", least=bound.get("alpha_mean"), digits=4),
        "alpha_all": Wanted("alpha, mean over triangles", least=bound.get("alpha_all"), digits=4),
        "poor": Wanted(
            f"triangles with alpha < {POOR}", most=bound.get("poor"), percent=True, digits=4
        ),
        "ms_a_face": Wanted("processor ms a face, meshing", most=bound.get("ms_a_face"), digits=2),
        "wall": Wanted("  by the clock on the wall", digits=2),
        "triangles_a_second": Wanted("triangles a second", digits=0),
        "read": Wanted("wall ms a face, reading", digits=2),
    }


def _table(models: dict) -> None:
    table = Table(box=SIMPLE_HEAD, padding=(0, 1))
    titles = (
        "model", "mesher", "faces", "failed", "solids good", "euler", "volume", "area",
        "triangles", "dev/chord", "above", "alpha", "smallest", f"< {POOR}", "ms a face", "read s",
    )  # fmt: skip
    for title in titles:
        table.add_column(title, justify="left" if title in titles[:2] else "right", no_wrap=True)
    for name, found in models.items():
        shown = name if len(name) <= 34 else name[:16] + ".." + name[-16:]
        for mesher, record in found.items():
            table.add_row(shown, mesher, *_cells(record))
            shown = ""
    heading("Model by model")
    Console(width=WIDTH).print(table)


def _cells(record: dict) -> list[str]:
    if record.get("left_out"):
        return [str(record["faces"]), "left out"]
    if not record.get("triangles"):
        return [str(record.get("faces", "-")), record.get("ended", "")]
    judged = record["judged"]
    volume = max((v.get("volume_error", math.inf) for v in judged), default=None)
    area = max((v.get("area_error", math.inf) for v in judged), default=None)
    if area is None and "area_exact" in record:
        area = abs(record["area"] / record["area_exact"] - 1.0)
    deviation = above = "-"
    if "above_chord" in record:
        deviation = f"{record['deviation_max'] / record['chord']:.2f}"
        above = f"{100 * record['above_chord'] / record['triangles']:.2f} %"
    if "sampled" in record:
        deviation = f"~{record['sampled_max'] / record['chord']:.2f}"
        above = f"~{100 * record['sampled_above'] / record['sampled']:.2f} %"
    return [
        str(record["faces"]),
        str(record["failed"]),
        f"{sum(map(_good, judged))}/{len(judged)}",
        f"{sum(bool(v.get('euler')) for v in judged)}/{len(judged)}",
        "-" if volume is None else f"{100 * volume:.2f} %",
        "-" if area is None else f"{100 * area:.2f} %",
        f"{record['triangles']:,}",
        deviation,
        above,
        f"{record['alpha_mean']:.3f}",
        f"{record['alpha_min']:.3f}",
        f"{100 * record['poor'] / record['triangles']:.2f} %",
        f"{1e3 * record['cpu_mesh'] / record['faces']:.1f}",
        f"{record['seconds_read']:.2f}",
    ]


def _failures(models: dict) -> None:
    """What went wrong, model by model, in a line each."""
    for mesher, title in (("ours", "surfmesh"), ("gmsh", "gmsh"), ("ocp", "OpenCASCADE")):
        lines = [
            f"{name}: {'; '.join(said)}"
            for name, found in models.items()
            if mesher in found and (said := _wrong(found[mesher]))
        ]
        if lines:
            heading(f"What went wrong: {title} ({len(lines)} models)")
            for line in lines:
                note(line)


def _wrong(record: dict) -> list[str]:
    if record.get("left_out"):
        return []
    said = []
    for key in ("error", "cut_short"):
        if record.get(key):
            said.append(f"{record.get('ended', 'refusal')}: {record[key]}")
    if record.get("failed"):
        first = f" ({record['reasons'][0]})" if record.get("reasons") else ""
        said.append(f"{record['failed']} faces not meshed{first[:200]}")
    if record.get("bare_faces"):
        said.append(f"faces {record['bare_faces'][:NAMES_SHOWN]} without triangles and a word")
    if record.get("stray"):
        said.append(f"{record['stray']} open edges where the model has none")
    if record.get("clean") is False:
        said.append(f"not clean: {'; '.join(record['problems'])}")
    if record.get("problem"):
        said.append(record["problem"])
    bad = [(k, v) for k, v in enumerate(record["judged"]) if record.get("triangles")]
    bad = [(k, v) for k, v in bad if not _good(v)]
    if bad:
        number, first = bad[0]
        said.append(
            f"{len(bad)} of {len(record['judged'])} solids, first {number}: "
            f"{first.get('said', 'no mesh')}"
        )
    if record.get("deviation_max", 0.0) > 1.5 * record.get("chord", math.inf):
        said.append(
            f"{record['deviation_max'] / record['chord']:.3g} chord from the surface "
            f"on face {record['deviation_of_face']}"
        )
    if record.get("above_chord", 0) > 0.001 * record.get("triangles", 0):
        said.append(f"{record['above_chord']} of {record['triangles']} triangles beyond chord")
    if record.get("inverted"):
        said.append(f"{record['inverted']} inverted triangles")
    return said
