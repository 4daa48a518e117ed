"""Is the mesh any good: shape, lengths, topology, deviation, and the report of them all.

    mesh -> measures -> figures   numbers, in parts  -+-> report -> text, JSON
                     -> verdict   problems, remarks  -+   opinion: other libraries beside ours

measures: what is measured, each once; knows nothing of right and wrong.
verdict: what is wrong, and what should be known, as records.
figures: the parts of the report, as data.
opinion: what trimesh and PyVista say; asked on request.
text: the report in words.
report: ``Report`` and ``check``, the doors of this room.
"""

from surfmesh.quality.report import Report, check

__all__ = ["Report", "check"]
