"""Tables of what ``sizing.py`` has found: the promise of ours, peers beside it, the totals."""

import math
from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.table import Table
from tables import console, heading, note

SLACK = 1.0 + 1e-9  # of a limit, for rounding
OURS = (
    "surface", "1/", "ratio", "triangles", "foretold", "fewer", "faces kept", "largest", "median",
    "below half", "alpha", "least", "unit", "folded", "s",
)  # fmt: skip
PEERS = (
    "model", "1/", "mesher", "triangles", "of ours", "within %", "99.9 %", "largest", "alpha",
    "least", "bare faces", "area", "tries", "s",
)  # fmt: skip


def show(rows: Sequence[dict]) -> int:
    """Print the tables; 1 when a mesh of ours breaks its promise or is folded, else 0."""
    ours = [row for row in rows if row["mesher"] == "ours"]
    heading("ours: triangles within a measured deviation")
    table = Table(*OURS, box=SIMPLE_HEAD, padding=(0, 1))
    for row in ours:
        table.add_row(*_our_cells(row, counterpart(ours, row)))
    console.print(table)
    shared = [row for row in rows if "area_exact" in row or row["mesher"] == "truth"]
    if shared:
        heading("ours and peers on CAD faces: the fewest triangles within the deviation")
        table = Table(*PEERS, box=SIMPLE_HEAD, padding=(0, 1))
        for row in beside(shared):
            table.add_row(*_peer_cells(row, counterpart(ours, row)))
        console.print(table)
    bad = [row for row in ours if is_bad(row)]
    for line in totals(rows):
        note(line)
    for row in rows:
        if "triangles" not in row:
            note(f"left out: {_asked(row)}: {row.get('left_out')}")
    for row in bad:
        kept = f"{row['faces_kept']} of {row['faces']} faces kept"
        note(f"MISSED: {_asked(row)}: {kept}, largest {row['largest']:.3f}, folded {row['folded']}")
    return int(bool(bad))


def _asked(row: dict) -> str:
    """Who was asked for what."""
    share = f" 1/{row['share']:g}" if "share" in row else ""
    ratio = f" ratio {row['ratio']:g}" if row.get("ratio") else ""
    return f"{row['surface']} {row['mesher']}{share}{ratio}"


def is_bad(row: dict) -> bool:
    """A mesh of ours that is farther away than was asked for, lacks a face, or is folded."""
    if "triangles" not in row:
        return False
    return row["faces_kept"] < row["faces"] or row["largest"] > SLACK or bool(row["folded"])


def counterpart(ours: Sequence[dict], row: dict) -> dict:
    """Our isotropic mesh of the same surface within the same deviation; empty without one."""
    for other in ours:
        asked = (other["surface"], other.get("share"), other.get("ratio"))
        if asked == (row["surface"], row.get("share"), 1.0) and "triangles" in other:
            return other
    return {}


def beside(rows: Sequence[dict]) -> list[dict]:
    """By surface and deviation: ours isotropic, the fewest of ours stretched, the peers."""
    order = list(dict.fromkeys((row["surface"], row.get("share")) for row in rows))
    shown = []
    for key in sorted(order, key=lambda key: [place for place, _ in order].index(key[0])):
        these = [row for row in rows if (row["surface"], row.get("share")) == key]
        stretched = [row for row in these if row.get("ratio", 0) > 1 and "triangles" in row]
        shown += [row for row in these if row.get("ratio") == 1.0]
        if stretched:
            shown.append(min(stretched, key=lambda row: row["triangles"]))
        shown += [row for row in these if row["mesher"] != "ours"]
    return shown


def totals(rows: Sequence[dict]) -> list[str]:
    """The figures over all inputs, one line each."""
    ours = [row for row in rows if row["mesher"] == "ours" and "triangles" in row]
    lines = []
    if ours:
        faces = sum(row["faces"] for row in ours)
        kept = sum(row["faces_kept"] for row in ours)
        lines.append(f"faces where the promise holds: {kept} of {faces}, {kept / faces:.2%}")
    foretold = [row["predicted"] / row["triangles"] for row in ours if row.get("predicted")]
    if foretold:
        spread = f"{min(foretold):.2f} to {max(foretold):.2f}"
        lines.append(f"foretold over actual triangles: {spread}, mean {mean_ratio(foretold):.2f}")
    for share in sorted({row["share"] for row in rows if "share" in row}):
        for mesher in dict.fromkeys(row["mesher"] for row in rows if row["mesher"] != "ours"):
            ratios = _ratios([row for row in rows if row["mesher"] == mesher], ours, share)
            if ratios:
                title = "ours, searched," if mesher == "searched" else mesher
                lines.append(
                    f"1/{share:g}: {title} needs {mean_ratio(ratios):.2f} of our isotropic "
                    f"triangles, geometric mean of {len(ratios)} models"
                )
        for ratio in sorted({row["ratio"] for row in ours} - {1.0}):
            ratios = _ratios([row for row in ours if row["ratio"] == ratio], ours, share)
            if ratios:
                lines.append(
                    f"1/{share:g}: ours at ratio {ratio:g} needs {mean_ratio(ratios):.2f} of "
                    f"them, {len(ratios)} surfaces"
                )
    return lines


def _ratios(rows: Sequence[dict], ours: Sequence[dict], share: float) -> list[float]:
    pairs = [(row, counterpart(ours, row)) for row in rows if row.get("share") == share]
    return [
        row["triangles"] / other["triangles"]
        for row, other in pairs if "triangles" in row and other
    ]  # fmt: skip


def mean_ratio(ratios: Sequence[float]) -> float:
    """The geometric mean: twice and half cancel."""
    return math.exp(math.fsum(map(math.log, ratios)) / len(ratios))


def _short(name: str) -> str:
    """Without the project that a file of the corpus comes from."""
    return name.split("__")[-1][:20]


def _our_cells(row: dict, isotropic: dict) -> list[str]:
    start = [_short(row["surface"]), f"{row['share']:g}", f"{row['ratio']:g}"]
    if "triangles" not in row:
        return [*start, "left out", *[""] * (len(OURS) - 4)]
    fewer = isotropic.get("triangles", math.nan) / row["triangles"]
    return [
        *start, f"{row['triangles']:,}", f"{row['predicted']:,}" if row.get("predicted") else "-",
        f"{fewer:.1f}", f"{row['faces_kept']}/{row['faces']}", f"{row['largest']:.3f}",
        f"{row['median']:.2f}", f"{row['below_half']:.2f}", f"{row['alpha_mean']:.3f}",
        f"{row['alpha_min']:.3f}", f"{row['quasi_unit']:.3f}", str(row["folded"]),
        f"{row['seconds']:.2f}",
    ]  # fmt: skip


def _peer_cells(row: dict, isotropic: dict) -> list[str]:
    name = "ours searched" if row["mesher"] == "searched" else row["mesher"]
    name = name if row.get("ratio", 1.0) == 1.0 else f"ours 1:{row['ratio']:g}"
    start = [_short(row["surface"]), f"{row.get('share', 0):g}", name]
    if "triangles" not in row:
        return [*start, "left out", *[""] * (len(PEERS) - 4)]
    part = row["triangles"] / isotropic.get("triangles", math.nan)
    tries = f"{len(row['tried'])}{'+' if row.get('cut_short') else ''}" if "tried" in row else "-"
    return [
        *start, f"{row['triangles']:,}", f"{part:.2f}", f"{100 * row['within']:.2f}",
        f"{row['reach']:.3f}", f"{row['seen_largest']:.3f}", f"{row['alpha_mean']:.3f}",
        f"{row['alpha_min']:.3f}", str(row["missing"]), f"{row['area'] / row['area_exact']:.4f}",
        tries, f"{row['seconds']:.2f}",
    ]  # fmt: skip
