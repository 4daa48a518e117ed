"""The report in full, as text: the summary, then tables of faces, solids and worst triangles."""

from collections.abc import Sequence

from surfmesh.errors import printable
from surfmesh.quality.figures.figures import Figures
from surfmesh.quality.figures.second_opinion import figure_in_words
from surfmesh.quality.measures.face_rows import FaceRow
from surfmesh.quality.measures.folds import FoldedTriangle
from surfmesh.quality.measures.places import place_in_words
from surfmesh.quality.text.summary import summary

SHOWN_FACES = 40  # those that are farthest from the surface
SHOWN_OPINIONS = 80
LEFT = ("name", "at", "near", "by", "figure", "of", "note")  # columns of words
BAR = 50  # characters of the longest bar of a histogram


def certificate(report: Figures) -> str:
    """Every part of ``report``; long lists of faces are cut, the JSON has them all."""
    parts = [summary(report), _faces(report), _solids(report), _worst(report), _folded(report)]
    parts += [
        _not_proved(report),
        _second_opinion(report),
        _meeting(report),
        _bodies(report),
        _histograms(report),
    ]
    parts += [_healing(report), _origin(report)]
    return "\n\n".join(part for part in parts if part)


def _faces(report: Figures) -> str:
    rows = [row for row in report.by_face if row.triangles]
    if not rows:
        return ""
    title = "faces"
    if len(rows) > SHOWN_FACES:
        title = f"faces, the {SHOWN_FACES} farthest from the surface of {len(rows)}"
        rows = sorted(rows, key=_badness, reverse=True)[:SHOWN_FACES]
    head: tuple[str, ...] = (
        "face", "name", "triangles", "area", "exact", "off", "largest", "chord", "rms",
    )  # fmt: skip
    head += ("> chord", "near", "turn", "angle", "alpha", "min", "size", "wanted")
    return _table(
        title,
        head,
        [
            (
                str(row.face), _short(row), f"{row.triangles:,}", _g(row.area, 6),
                _g(row.area_exact, 6), _error(row.area_error), _g(row.deviation_max),
                _g(row.chord),
                _g(row.deviation_rms), _percent(row.above_chord_share),
                place_in_words(row.deviation_point, 4),
                _g(row.angle_max if row.angle else None), _g(row.angle), _g(row.alpha_mean),
                _g(row.alpha_min), _g(row.size_mean), _g(row.size_wanted),
            )
            for row in rows
        ],
    )  # fmt: skip


def _badness(row: FaceRow) -> float:
    if row.deviation_max is not None or row.alpha_min is None:
        return row.deviation_max or 0.0
    return 1.0 - row.alpha_min


def _short(row: FaceRow) -> str:
    """Its name, and its kind where the name does not say it."""
    name = row.name if row.kind in row.name else f"{row.name} {row.kind}"
    return name if len(name) <= 32 else name[:29] + "..."


def _solids(report: Figures) -> str:
    head = ("solid", "name", "triangles", "closed", "Euler", "model", "area", "exact", "off")
    rows = [
        (
            str(row.solid), row.name[:32], f"{row.triangles:,}", "yes" if row.closed else "no",
            str(row.euler), _g(row.euler_exact), _g(row.area, 6), _g(row.area_exact, 6),
            _error(row.area_error), _g(row.volume, 6), _g(row.volume_exact, 6),
            _error(row.volume_error),
        )
        for row in report.by_solid[:SHOWN_FACES]
    ]  # fmt: skip
    more = len(report.by_solid) - SHOWN_FACES
    title = "solids" if more <= 0 else f"solids, the first {SHOWN_FACES} of {len(report.by_solid)}"
    return _table(title, (*head, "volume", "exact", "off"), rows) if rows else ""


def _worst(report: Figures) -> str:
    head = ("triangle", "alpha", "angles", "at", "face", "name")
    return _table(
        "worst triangles",
        head,
        [
            (
                str(row.triangle), f"{row.alpha:.4f}",
                f"{row.min_angle_deg:.1f}° to {row.max_angle_deg:.1f}°",
                place_in_words(row.point, 4),
                str(row.face), row.name,
            )
            for row in report.worst
        ],
    )  # fmt: skip


def _folded(report: Figures) -> str:
    if not report.folded_at:
        return ""
    rows = [
        (
            str(row.triangle), f"{row.angle_deg:.1f}°", place_in_words(row.point, 4), str(row.face),
            _why(row),
        )
        for row in report.folded_at
    ]  # fmt: skip
    return _table("folded triangles", ("triangle", "turned", "at", "face", "why"), rows)


def _why(row: FoldedTriangle) -> str:
    if row.by_surface:
        return "by the surface"
    if row.off >= row.moved:
        return f"corner {row.off:.3g} off" if row.off else ""
    return f"(u, v) of a corner {row.moved:.3g} away"


def _bodies(report: Figures) -> str:
    head = ("kind", "name", "and", "solid", "solid", "triangles", "depth", "gap", "at")
    rows = [
        (
            pair.kind, *pair.names, *(str(k) if k >= 0 else "" for k in pair.solids),
            f"{pair.triangles:,}", _g(pair.depth), _g(pair.gap), place_in_words(pair.point, 4),
        )
        for pair in report.bodies
    ]  # fmt: skip
    return _table("bodies that meet", head, rows)


def _meeting(report: Figures) -> str:
    if not report.meeting:
        return ""
    rows = [
        (*map(str, pair.triangles), *map(str, pair.faces), place_in_words(pair.point, 4))
        for pair in report.meeting
    ]
    head = ("triangle", "meets", "face", "and face", "at")
    return _table("self-intersections", head, rows)


def _not_proved(report: Figures) -> str:
    """Faces some of whose triangles are not proved to keep to their chord."""
    rows = () if report.proof is None else report.proof.not_proved
    if not rows:
        return ""
    head = ("face", "name", "triangles", "of", "bound", "because")
    return _table(
        "not proved",
        head,
        [
            (
                str(row.face), row.name[:32], f"{row.triangles:,}", f"{row.of:,}", _g(row.bound),
                row.because,
            )
            for row in rows
        ],
    )  # fmt: skip


def _second_opinion(report: Figures) -> str:
    """Ours beside theirs, those that disagree first."""
    opinion = report.second_opinion
    if opinion is None:
        return ""
    rows = sorted(opinion.rows, key=lambda row: row.agree is not False)
    title = "second opinion"
    if len(rows) > SHOWN_OPINIONS:
        title += f", {SHOWN_OPINIONS} of {len(rows)} rows"
        rows = rows[:SHOWN_OPINIONS]
    head = ("by", "figure", "of", "ours", "theirs", "rounding", "agree", "note")
    return _table(
        title,
        head,
        [
            (
                row.whose, row.quantity, row.of[:32], figure_in_words(row.ours),
                figure_in_words(row.theirs), _g(row.tolerance, 2),
                "-" if row.agree is None else "yes" if row.agree else "NO", row.note,
            )
            for row in rows
        ],
    )  # fmt: skip


def _histograms(report: Figures) -> str:
    blocks = []
    for name, found in report.histograms.items():
        top = max(found.counts)
        if not top:
            continue
        lines = [name]
        filled = [k for k, count in enumerate(found.counts) if count]
        for k in range(filled[0], filled[-1] + 1):
            bar = "#" * -(-found.counts[k] * BAR // top)
            span = f"{found.edges[k]:.4g} to {found.edges[k + 1]:.4g}"
            lines.append(f"  {span:>24} {found.counts[k]:>10,}  {bar}".rstrip())
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)


def _healing(report: Figures) -> str:
    if not report.healing:
        return ""
    return "\n".join(["healing", *(f"  {printable(sentence)}" for sentence in report.healing)])


def _origin(report: Figures) -> str:
    options = ", ".join(
        f"{name} {value:.6g}" if isinstance(value, float) else f"{name} {value}"
        for name, value in report.options.items()
        if value is not None and value != ()
    )
    versions = ", ".join(f"{name} {number}" for name, number in report.versions.items())
    rows = [("source", report.source), ("unit", report.unit), ("sha256", report.source_sha256)]
    rows += [("options", options), ("mesh", f"sha256 {report.mesh_sha256}"), ("with", versions)]
    lines = (f"  {title:<11}{printable(text)}" for title, text in rows if text)
    return "\n".join(["origin", *lines])


def _table(title: str, head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    """Columns as wide as they must be; numbers to the right, words to the left."""
    if not rows:
        return ""
    columns = [tuple(map(printable, column)) for column in zip(head, *rows)]
    used = [column for column in columns if any(cell != "" for cell in column[1:])]
    lines = [title]
    for cells in zip(*used):
        padded = [
            cell.ljust(max(map(len, column)))
            if column[0] in LEFT
            else cell.rjust(max(map(len, column)))
            for cell, column in zip(cells, used)
        ]
        lines.append("  " + "  ".join(padded).rstrip())
    return "\n".join(lines)


def _g(value: float | None, digits: int = 4) -> str:
    return "" if value is None else f"{value:.{digits}g}"


def _percent(fraction: float | None) -> str:
    return "" if fraction is None else f"{100 * fraction:.3g} %"


def _error(error: float | None) -> str:
    return "" if error is None else f"{100 * error:+.2g} %"
