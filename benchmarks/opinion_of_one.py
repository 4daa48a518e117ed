"""One surface or CAD file meshed and judged by surfmesh, trimesh and PyVista: in a process of its
own, as a CAD file may take for ever."""

from time import perf_counter

from child_process import answer

import surfmesh as sm


def opinion(request: dict) -> dict:
    """{"triangles", "solids", "compared", "rows" that disagree, "unanswered", "seconds"}."""
    mesh = sm.mesh(sm.load(request["what"]), strict=False)
    start = perf_counter()
    report = sm.check(mesh, second_opinion=True)
    found = report.second_opinion
    return {
        "triangles": report.triangles,
        "solids": len(report.by_solid),
        "compared": found.compared,
        "agreed": found.agreed,
        "left": [
            f"{row.whose} {row.quantity} {row.of}: {row.note}"
            for row in found.rows
            if row.agree is None
        ],
        "rows": [
            f"{row.whose} {row.quantity} {row.of}: {row.theirs!r}, ours {row.ours!r}, "
            f"rounding {row.tolerance}"
            for row in found.disagreements
        ],
        "check": perf_counter() - start - report.seconds["second opinion"],
        "seconds": report.seconds["second opinion"],
    }


if __name__ == "__main__":
    answer(opinion)
