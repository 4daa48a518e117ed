"""What a notebook shows for a mesh: a small table."""

from html import escape

from surfmesh.quality.measures.shape import shapes
from surfmesh.result.surface_mesh import SurfaceMesh


def summary_html(mesh: SurfaceMesh) -> str:
    """An HTML table of counts, extent and shape."""
    rows = [("nodes", f"{len(mesh.points):,}"), ("triangles", f"{len(mesh.triangles):,}")]
    names = list(dict.fromkeys(mesh.face_name(i) for i in range(len(mesh.surfaces))))
    if names:
        rows.insert(0, ("surface", ", ".join(names[:3]) + (" ..." if len(names) > 3 else "")))
    if len(mesh.triangles):
        extent = mesh.points.max(axis=0) - mesh.points.min(axis=0)
        shape = shapes(mesh)
        rows += [
            ("extent", " × ".join(f"{side:.4g}" for side in extent)),
            ("area", f"{shape.area.sum():.6g}"),
            ("alpha", f"mean {shape.alpha.mean():.4f}, smallest {shape.alpha.min():.4f}"),
            ("angles", f"{shape.min_angle.min():.1f}° to {shape.max_angle.max():.1f}°"),
        ]
    rows += [("warning", text) for text in mesh.warnings]
    cells = "".join(f"<tr><th>{escape(a)}</th><td>{escape(b)}</td></tr>" for a, b in rows)
    return f"<table><caption>SurfaceMesh</caption>{cells}</table>"
