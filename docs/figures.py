"""The figures of the README, of docs/method.md, after Wang, Ming and Lo (2007), and of the guides.

    python docs/figures.py [FOLDER]

They go to docs/images, or to FOLDER.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.patches import Circle

import surfmesh as sm

FILL, RIM, INK, FRONT = "#f2c14e55", "#b07d10", "#1f3a5f", "#c0392b"
DOTS_PER_INCH = 90


def circles_of(axes, centres, radii, fill=FILL, rim=RIM):
    collection = EllipseCollection(
        2 * radii, 2 * radii, 0 * radii, units="xy", offsets=centres,
        offset_transform=axes.transData, facecolors=fill, edgecolors=rim, linewidths=0.7,
    )  # fmt: skip
    axes.add_collection(collection)
    low, high = (centres - radii[:, None]).min(axis=0), (centres + radii[:, None]).max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))


def triangles_of(axes, points, triangles, width=0.5):
    faces = PolyCollection(points[triangles], facecolors="none", edgecolors=INK, linewidths=width)
    axes.add_collection(faces)


def bare(axes, title=""):
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(title, fontsize=10)


def written(figure, path):
    figure.savefig(path, dpi=DOTS_PER_INCH, bbox_inches="tight")
    plt.close(figure)


def packing_steps(folder: Path) -> None:
    """2.1 to 2.4: the front after 3, 7, 40 and 250 circles, radii growing to the right."""
    figure, row = plt.subplots(1, 4, figsize=(12, 3.2))
    for axes, count in zip(row, (3, 7, 40, 250)):
        packing = sm.pack(lambda p: np.maximum(1.0 + 0.04 * p[:, 0], 0.4), count=count)
        circles_of(axes, packing.centres, packing.radii)
        triangles_of(axes, packing.centres, packing.triangles)
        front = packing.centres[np.append(packing.front, packing.front[0])]
        axes.plot(*front.T, color=FRONT, lw=1.6)
        bare(axes, f"{count} circles")
    written(figure, folder / "packing_steps.png")


def apex(a, b, ra, rb, r):
    """The centre of a circle of radius r that touches circles a and b, left of a -> b."""
    d = np.linalg.norm(b - a)
    along = ((r + ra) ** 2 - (r + rb) ** 2 + d * d) / (2 * d)
    e = (b - a) / d
    height = np.sqrt((r + ra) ** 2 - along**2)
    return a + along * e + height * np.array([-e[1], e[0]])


def pushing_out(folder: Path) -> None:
    """2.3.3: the new circle overlaps its neighbour, and its support moves along the front."""
    radii = np.array([1.0, 0.9, 1.0, 0.9])
    centres = np.array([[0.0, 0.0], [1.9, 0.0], [2.55, 1.785], [2.95, 3.64]])
    wanted = 1.0
    figure, row = plt.subplots(1, 3, figsize=(11, 4))
    placed = [None, apex(centres[0], centres[1], 1.0, 0.9, wanted), None]
    placed[2] = apex(centres[0], centres[2], 1.0, 1.0, wanted)
    titles = (
        "a site of the front: m and m + 1",
        "touching m and m + 1 it overlaps m + 2",
        "pushed out: touching m and m + 2",
    )
    for axes, place, title in zip(row, placed, titles):
        circles_of(axes, centres, radii)
        for number, centre in enumerate(centres):
            name = "m" if number == 0 else f"m + {number}"
            axes.text(*centre, name, ha="center", va="center", fontsize=9)
        axes.plot(*centres.T, color=FRONT, lw=1.2, zorder=0)
        if place is not None:
            axes.add_patch(Circle(place, wanted, fc="#1f3a5f22", ec=INK))
            axes.plot(*place, "o", color=INK, ms=3)
            gap = np.linalg.norm(centres - place, axis=1) - radii - wanted
            worst = int(gap.argmin())
            if gap[worst] < -0.01:
                axes.plot(*np.array([place, centres[worst]]).T, color=INK, ls=":")
                title += f"\nf = d - (r + r') = {gap[worst]:.2f}"
        axes.set(xlim=(-1.2, 4.3), ylim=(-1.2, 4.5))
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set_title(title, fontsize=10)
    written(figure, folder / "pushing_out.png")


def random_radii(folder: Path) -> None:
    """4: radii drawn evenly from 1 to 100."""
    packing = sm.pack(sm.UniformRadius(1, 100, seed=2), count=300)
    figure, row = plt.subplots(1, 2, figsize=(10, 5))
    circles_of(row[0], packing.centres, packing.radii)
    bare(row[0], "300 circles, radii from 1 to 100")
    triangles_of(row[1], packing.centres, packing.triangles)
    row[1].set(xlim=row[0].get_xlim(), ylim=row[0].get_ylim())
    bare(row[1], f"{len(packing.triangles)} triangles, before any optimisation")
    written(figure, folder / "random_radii.png")


def boundary(folder: Path) -> None:
    """3: the circles know nothing of the domain; its boundary is inserted afterwards."""
    letter = sm.load("letter_a")
    law = sm.DistanceSize(letter, near=0.09, far=0.35, reach=1.0)
    raw, done = (sm.mesh(letter, sm.Sizing(size=law), optimise=best) for best in (False, True))
    low, high = raw.points[:, :2].min(axis=0), raw.points[:, :2].max(axis=0)
    box = (*(low - 0.4), *(high + 0.4))
    packing = sm.pack(lambda p: 0.5 * law(p), origin=tuple(0.5 * (low + high)), box=box)
    figure, row = plt.subplots(1, 3, figsize=(12, 5))
    circles_of(row[0], packing.centres, packing.radii)
    edges = raw.points[raw.boundary_edges][:, :, :2]
    for axes, mesh in zip(row, (None, raw, done)):
        if mesh is not None:
            triangles_of(axes, mesh.points[:, :2], mesh.triangles, 0.4)
        for edge in edges:
            axes.plot(*edge.T, color=FRONT, lw=1.4)
        axes.set(xlim=(box[0], box[2]), ylim=(box[1], box[3]))
        axes.set_aspect("equal")
        axes.axis("off")
    for axes, title in zip(row, ("packed over the plane", "boundary inserted", "optimised")):
        axes.set_title(title, fontsize=10)
    written(figure, folder / "boundary.png")


def on_the_surface(folder: Path) -> None:
    """4: circles on the surface are ellipses in the (u, v) plane."""
    surface = sm.load("two_peaks")
    raw = sm.mesh(surface, sm.Sizing(chord=0.03), optimise=False)
    size = np.empty(len(raw.uv_points))
    size[raw.uv_triangles] = raw.sizes[raw.triangles]
    _, r_u, r_v = surface.evaluate(raw.uv_points, order=1)
    first = np.stack([r_u, r_v], axis=1)
    form = first @ first.transpose(0, 2, 1)
    values, vectors = np.linalg.eigh(form)
    axes_lengths = size[:, None] / np.sqrt(values)
    turn = np.degrees(np.arctan2(vectors[:, 1, 0], vectors[:, 0, 0]))
    figure, axes = plt.subplots(figsize=(6, 6))
    ellipses = EllipseCollection(
        axes_lengths[:, 0], axes_lengths[:, 1], turn, units="xy", offsets=raw.uv_points,
        offset_transform=axes.transData, facecolors=FILL, edgecolors=RIM, linewidths=0.5,
    )  # fmt: skip
    axes.add_collection(ellipses)
    low, high = np.array(surface.domain).T
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    bare(axes, "surface 1: ellipses in the (u, v) plane")
    written(figure, folder / "ellipses.png")
    raw.plot(folder / "on_the_surface.png", by="size", circles=True, size=(1000, 750))


def bracket(folder: Path) -> None:
    """A CAD part of which some faces have names, for the README."""
    import cadquery as cq

    side = [(0, 0), (60, 0), (60, 8), (8, 8), (8, 45), (0, 45)]
    part = cq.Workplane("XZ").polyline(side).close().extrude(15, both=True)
    part = part.edges("|Y").edges("not(<X or >X)").fillet(5)
    bolts = cq.Workplane().pushPoints([(25, 7), (25, -7), (48, 7), (48, -7)]).circle(3).extrude(10)
    part = part.cut(bolts).cut(cq.Workplane("YZ").center(0, 30).circle(7).extrude(10))
    part = part.faces(cq.NearestToPointSelector((36, 0, 8))).tag("seat").end()
    part = part.faces(cq.NearestToPointSelector((4, 0, 30))).tag("bore").end()
    mesh = sm.mesh(part, sm.Sizing(chord=0.1, max_size=5))
    title = f"bracket: {len(mesh.triangles):,} triangles, watertight; faces by number"
    mesh.plot(folder / "bracket.png", by="face", worst=0, title=title, size=(1200, 900))


def stretched(folder: Path) -> None:
    """A plate with fillets and holes within one chord: isotropic, and at ratio 20."""
    import cadquery as cq
    import pyvista as pv

    block = cq.Workplane().box(60, 40, 12).edges("|Z").fillet(6)
    block = block.faces(">Z").workplane().rarray(20, 15, 3, 2).hole(6)
    part = sm.from_cadquery(block.faces(">Z").edges("not %CIRCLE").fillet(1.5))
    plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1500, 620), border=False)
    for column, ratio in enumerate((1.0, 20.0)):
        mesh = sm.mesh(part, sm.Sizing(chord=0.05, growth=1.4, anisotropy=ratio))
        plotter.subplot(0, column)
        faces = np.insert(mesh.triangles, 0, 3, axis=1).ravel()
        plotter.add_mesh(pv.PolyData(mesh.points, faces), color="#f4ead2", show_edges=True)
        plotter.add_text(f"{len(mesh.triangles):,} triangles", font_size=10, color=INK)
        plotter.camera_position = [(52, -78, 70), (0, 0, 0), (0, 0, 1)]
    plotter.screenshot(folder / "stretched.png")
    plotter.close()


def meeting(folder: Path) -> None:
    """A pipe through a wider one, with finer triangles along their common curve."""
    made = sm.mesh(sm.load("crossing_pipes"), {"*": 0.25, "edge:main/branch": 0.08})
    made.plot(folder / "meeting.png", by="face", size=(1000, 750))


def meeting_examples(folder: Path) -> None:
    """The ready-made surfaces that meet."""
    import pyvista as pv

    names = "crossing_pipes", "wing_and_fuselage", "wavy_cut", "three_sheets"
    colours = "#f2c14e", "#7fb7be", "#d96c52", "#9aa77a", "#b8a1c9", "#e8d5a3", "#6f8fb3"
    plotter = pv.Plotter(off_screen=True, shape=(2, 2), window_size=(1500, 1150), border=False)
    for place, name in enumerate(names):
        model = sm.load(name)
        mesh = sm.mesh(model, sm.Sizing(chord=2e-3 * model.diagonal, max_size=model.diagonal / 20))
        plotter.subplot(*divmod(place, 2))
        for face in range(len(model.faces)):
            own = np.insert(mesh.triangles[mesh.face_ids == face], 0, 3, axis=1).ravel()
            plotter.add_mesh(
                pv.PolyData(mesh.points, own), color=colours[face % len(colours)],
                show_edges=True, edge_color=INK, line_width=0.5,
            )  # fmt: skip
        plotter.add_text(f"{name}: {len(mesh.triangles):,} triangles", font_size=9, color=INK)
    plotter.screenshot(folder / "meeting_examples.png")
    plotter.close()


def wavy(folder: Path) -> None:
    """The gallery's wavy surface at its own sizes, coloured by shape: the README's picture."""
    sm.mesh("wavy").plot(folder / "wavy.png")


FIGURES = (
    wavy, packing_steps, pushing_out, random_radii, boundary, on_the_surface, bracket, stretched,
    meeting, meeting_examples,
)  # fmt: skip


if __name__ == "__main__":
    where = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "images"
    where.mkdir(parents=True, exist_ok=True)
    for figure in FIGURES:
        figure(where)
