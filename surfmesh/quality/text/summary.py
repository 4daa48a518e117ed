"""The report as text: the verdict first, then one line for each thing a user asks about."""

import textwrap

from surfmesh.errors import printable
from surfmesh.quality.figures.figures import Figures
from surfmesh.quality.figures.proof import ProofFigures
from surfmesh.quality.figures.second_opinion import SecondOpinion
from surfmesh.quality.measures.lengths import GROWTH_SLACK
from surfmesh.quality.measures.places import count_in_words, place_in_words

WIDTH = 92
ROUNDING = 1e-10  # of a length, or of a hundredth: what is less is said to be none
_SHOWN_PROBLEMS, _SHOWN_WARNINGS, _SHOWN_STAGES = 5, 3, 8


def summary(report: Figures) -> str:
    """At most 25 lines of text about ``report``."""
    clean = "clean, but for a stated limit" if report.limits else "clean"
    verdict = (
        clean if report.clean else f"NOT CLEAN: {count_in_words(len(report.problems), 'problem')}"
    )
    name = f"{report.surface}: " if report.surface else ""
    lines = [f"{name}{report.nodes:,} nodes, {report.triangles:,} triangles - {verdict}"]
    lines += _listed(report.problems, _SHOWN_PROBLEMS, "problem")
    lines += [
        line
        for title, text in _rows(report)
        for line in textwrap.wrap(
            text, WIDTH, initial_indent=f"  {title:<11}", subsequent_indent=" " * 13
        )
    ]
    lines += _listed([f"warning: {text}" for text in report.warnings], _SHOWN_WARNINGS, "warning")
    return "\n".join(map(printable, lines))


def _rows(report: Figures) -> list[tuple[str, str]]:
    """A title, or none for more of the same, and its text."""
    rows = [
        ("topology", _topology(report)),
        ("size", _size(report)),
        (
            "shape",
            f"alpha mean {report.alpha_mean:.4f}, 1 % below {report.alpha_p01:.4f}, "
            f"smallest {report.alpha_min:.4f}",
        ),
        (
            "",
            f"radius ratio mean {report.radius_ratio_mean:.4f}, "
            f"smallest {report.radius_ratio_min:.4f}",
        ),
        *_narrow(report),
        *_in_the_metric(report),
        ("angles", f"{report.min_angle_deg:.2f}° to {report.max_angle_deg:.2f}°"),
        (
            "edges",
            f"{report.edge_min:.4g} to {report.edge_max:.4g}, mean {report.edge_mean:.4g}; "
            f"at a vertex up to 1 : {report.growth_max:.3g}",
        ),
    ]
    if report.quasi_unit_share is not None:
        rows.append(
            (
                "",
                f"{100 * report.quasi_unit_share:.2f} % as wanted within a factor sqrt 2; "
                f"length / wanted {report.length_mean:.3f} ± {report.length_std:.3f}",
            )
        )
    if report.above_growth_share is not None:
        rows.append(("", _growth(report)))
    rows.append(("deviation", _deviation(report)))
    if report.least_triangles:
        rows.append(("", _efficiency(report)))
    if report.proof is not None:
        rows.append(("proved", _proof(report.proof)))
    if report.angle is not None and report.angle_max is not None:
        rows.append(("turning", _dihedral_angles(report)))
    if report.second_opinion is not None:
        rows.append(("opinion", _second_opinion(report.second_opinion)))
    if report.seconds:
        rows.append(("seconds", _seconds(report)))
    return rows


def _topology(report: Figures) -> str:
    words = [
        "closed" if report.closed else f"{count_in_words(report.boundary_loops, 'boundary loop')}",
        "manifold" if report.manifold else "not manifold",
        "one-sided" if report.one_sided else "oriented" if report.oriented else "not oriented",
        f"Euler number {report.euler}",
        count_in_words(report.components, "component"),
    ]
    if report.euler_exact is not None:
        words[3] += (
            " as in the model"
            if report.euler == report.euler_exact
            else (f" (of the model {report.euler_exact})")
        )
    if report.self_intersections == 0:
        words.append("free of self-intersection")
    elif report.self_intersections:
        natural = " by nature" if report.crosses_itself else ""
        words.append(f"intersects itself{natural} ({report.self_intersections:,} pairs)")
    if report.contacts:
        words.append(f"separate bodies meet ({report.contacts:,} pairs of triangles)")
    if report.overlapping_bodies:
        words.append(f"{count_in_words(report.overlapping_bodies, 'pair')} of solids overlap")
    if report.faces > 1:
        words.append(count_in_words(report.faces, "face"))
    return ", ".join(words)


def _size(report: Figures) -> str:
    words = []
    for name in ("area", "volume"):
        found, exact = getattr(report, name), getattr(report, f"{name}_exact")
        if found is None:
            continue
        words.append(f"{name} {found:.7g}")
        if exact:
            off = 100 * (abs(found) - abs(exact)) / abs(exact)
            said = f"{off:+.2g} %" if abs(off) > ROUNDING else "to rounding"
            words[-1] += f" (exact {exact:.7g}, {said})"
    return ", ".join(words) + (f" in {report.unit}" if report.unit else "")


def _narrow(report: Figures) -> list[tuple[str, str]]:
    """Where faces are narrower than the chord."""
    if not report.narrow_triangles:
        return []
    text = f"{count_in_words(report.narrow_triangles, 'triangle')} on faces narrower than the chord"
    if report.alpha_mean_elsewhere is not None:
        text += (
            f"; without them alpha mean {report.alpha_mean_elsewhere:.4f}, "
            f"smallest {report.alpha_min_elsewhere:.4f}"
        )
    return [("", text)]


def _in_the_metric(report: Figures) -> list[tuple[str, str]]:
    """Where sizes depend on the direction."""
    if report.alpha_metric_mean is None:
        return []
    mean, least = report.alpha_metric_mean, report.alpha_metric_min
    return [("", f"in the metric: alpha mean {mean:.4f}, smallest {least:.4f}")]


def _growth(report: Figures) -> str:
    allowed = f"{1.0 + GROWTH_SLACK:g} times what growth {report.growth:g} allows"
    if not report.above_growth_share:
        return f"wanted sizes differ along no edge by more than {allowed}"
    place = place_in_words(report.size_growth_point, 4)
    return (
        f"wanted sizes differ along {100 * report.above_growth_share:.2g} % of them by more than "
        f"{allowed}, up to {report.size_growth_max:.3g} times at {place}"
    )


def _deviation(report: Figures) -> str:
    if report.deviation_max is None:
        return "not known: the mesh carries no surface to compare with"
    farthest = max(report.deviation_max, report.surface_deviation_max or 0.0)
    if report.edge_min is not None and farthest <= ROUNDING * report.edge_min:
        return f"none beyond rounding{_between_samples(report)}"
    used = ""
    if report.chord_used is not None:
        used = f"median {100 * report.chord_used:.0f} % of chord where it decides the size; "
    place = place_in_words(report.deviation_point, 4)
    back = ""
    if report.surface_deviation_max is not None:
        there = place_in_words(report.surface_deviation_point, 4)
        rim = "a rim, " if report.surface_deviation_at_rim else ""
        most = f"{report.surface_deviation_max:.4g}"
        back = f"; the surface lies up to {most} from the mesh, at {rim}{there}"
    return (
        f"largest {report.deviation_max:.4g}{_of_chord(report, report.deviation_max)}, "
        f"rms {report.deviation_rms:.4g}; {used}"
        f"largest in triangle {report.deviation_triangle} at {place}{back}"
        f"{_between_samples(report)}"
    )


def _efficiency(report: Figures) -> str:
    """How many triangles there are beside those that the chord needs."""
    least = report.least_triangles or 1.0
    words = (
        f"{report.triangles / least:.3g} times the least that triangles of any shape need for "
        f"chord ({least:,.0f})"
    )
    if report.equilateral_triangles:
        times = report.triangles / report.equilateral_triangles
        words += f", {times:.3g} times what equilateral ones need"
    return words


def _of_chord(report: Figures, deviation: float) -> str:
    """How large the deviation is against the chord of its face, and of others."""
    rows = [
        (row.deviation_max, row.chord, row.deviation_triangle)
        for row in report.by_face
        if row.chord and row.deviation_max is not None
    ]
    there = [chord for _, chord, triangle in rows if triangle == report.deviation_triangle]
    chord = there[0] if there else report.chord
    if not chord:
        return ""
    words = f"{100 * deviation / chord:,.0f} % of chord {chord:.4g}"
    if len({chord for _, chord, _ in rows}) > 1:
        most = max(largest / chord for largest, chord, _ in rows)
        words += f" there, at most {100 * most:,.0f} % of that of any face"
    return f" ({words})"


def _between_samples(report: Figures) -> str:
    """What is known of features narrower than the triangles."""
    if report.functions:
        return "; features narrower than the triangles cannot be excluded: a function has no bounds"
    return "; nothing more between the samples, by the formula's bounds" * (report.unseen == 0)


def _dihedral_angles(report: Figures) -> str:
    place = place_in_words(report.angle_point, 4)
    return (
        f"largest {report.angle_max:.4g}° between neighbours ({report.angle:.4g}° asked for); "
        f"at {place}"
    )


def _proof(found: ProofFigures) -> str:
    share = 100 * found.proved_share
    words = [f"{share:.4g} % of the triangles, both ways; largest bound {found.bound_max:.4g}"]
    if found.bound_over_sampled is not None:
        words.append(f"{found.bound_over_sampled:.3f} times what samples say")
    if found.edges_bound_max is not None:
        words.append(f"edges {found.edges_bound_max:.4g}")
    if found.edges_without_bound:
        words.append(f"{found.edges_without_bound:,} segments of edges without a bound")
    words.append(f"homeomorphic: {found.homeomorphic}")
    return ", ".join(words[:-1]) + f"; {words[-1]}; isotopic: {found.isotopic}"


def _second_opinion(opinion: SecondOpinion) -> str:
    left = len(opinion.rows) - opinion.compared
    others = f" ({left:,} more cannot be compared)" if left else ""
    found = opinion.disagreements
    if not found:
        return (
            f"trimesh and pyvista agree on {opinion.agreed:,} of "
            f"{count_in_words(opinion.compared, 'figure')}{others}"
        )
    names = ", ".join(dict.fromkeys(f"{row.quantity} ({row.whose})" for row in found))
    return (
        f"{len(found):,} of {count_in_words(opinion.compared, 'figure')} disagree{others}: {names}"
    )


def _seconds(report: Figures) -> str:
    total = sum(report.seconds.values())
    rate = f", {report.triangles / total:,.0f} triangles a second" if total > 0 else ""
    longest = sorted(report.seconds, key=report.seconds.__getitem__, reverse=True)[:_SHOWN_STAGES]
    stages = ", ".join(
        f"{stage} {taken:.3f}" for stage, taken in report.seconds.items() if stage in longest
    )
    return f"{total:.3f} in all ({stages}){rate}"


def _listed(texts: "tuple[str, ...] | list[str]", shown: int, kind: str) -> list[str]:
    lines = [
        textwrap.shorten(f"  ! {text}", 2 * WIDTH, placeholder=" ...") for text in texts[:shown]
    ]
    lines = [f"  {line}" for line in lines]
    if len(texts) > shown:
        lines.append(f"  ! and {count_in_words(len(texts) - shown, 'more ' + kind)}")
    return lines
