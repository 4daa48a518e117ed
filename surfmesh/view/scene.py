"""A mesh as a PyVista scene."""

import numpy as np
import pyvista

from surfmesh.io.vtk_xml import to_pyvista
from surfmesh.view.camera import framed
from surfmesh.view.colour_maps import map_of
from surfmesh.view.drawing import Drawing, face_legend
from surfmesh.view.legend import INK
from surfmesh.view.lines import Lines
from surfmesh.view.overlays import legend

MARGIN, WIDE_MARGIN = 0.22, 0.36  # of the mesh: what is left around it for words and the bar
BAR = 0.05  # of half the height: the mesh moves up, out of the colour bar's way
TOP, LINE = 0.955, 0.032  # of the height: where the title stands, and the lines below it
SMOOTHED = 1.6  # supersampling makes lines thinner by this
NEARER = -4.0  # depth units by which lines lie before the triangles that they are drawn on


def scene(drawn: Drawing, *, off_screen: bool) -> pyvista.Plotter:
    """A plotter with the mesh, title, colour bar and camera, ready to be shown."""
    size, colours = drawn.size, drawn.colours
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=list(size))
    plotter.set_background("white")
    data = to_pyvista(drawn.mesh)
    data.clear_data()
    values = data.point_data if colours.per_vertex else data.cell_data
    values[colours.title] = colours.within
    unit = size[1] / 1000
    plotter.add_mesh(
        data,
        scalars=colours.title,
        cmap=map_of(colours),
        clim=colours.limits,
        log_scale=colours.logarithmic,
        n_colors=colours.hues or 256,
        show_edges=drawn.edges,
        edge_color=INK,
        edge_opacity=0.55,
        line_width=0.7 * unit,
        lighting=False,  # colours are those of the bar
        scalar_bar_args={
            "title": colours.title + "\n",
            "color": INK,
            "title_font_size": round(22 * unit),
            "label_font_size": round(20 * unit),
            "n_labels": 0 if colours.hues else 5,
            "fmt": "%.3g",
            "width": 0.5,
            "height": 0.06,
            "position_x": 0.25,
            "position_y": 0.05 if colours.hues else 0.02,
        },
        annotations={float(k): str(k) for k in range(colours.hues)} if colours.hues else None,
    )
    for layer in drawn.lines:
        _add_lines(plotter, layer, layer.width * unit * SMOOTHED)
    _add_words(plotter, drawn, unit)
    plotter.add_axes(color=INK, line_width=2, viewport=(0.0, 0.0, 0.16, 0.16))
    _set_camera(plotter, drawn)
    if drawn.edges or drawn.lines:
        plotter.enable_anti_aliasing("ssaa")
    return plotter


def _add_words(plotter: pyvista.Plotter, drawn: Drawing, unit: float) -> None:
    layers = legend(drawn.lines)
    said = [(drawn.title, INK), *((layer.name, layer.colour) for layer in layers)]
    said += [(f"{face}: {name}", colour) for face, name, colour in face_legend(drawn)]
    for row, (text, colour) in enumerate(said):
        plotter.add_text(
            text,
            position=(0.02, TOP - row * LINE),
            viewport=True,
            font_size=round((11 if row == 0 else 9) * unit),
            color=colour,
        )


def _set_camera(plotter: pyvista.Plotter, drawn: Drawing) -> None:
    flat = not np.ptp(drawn.mesh.points[:, 2])  # from above it fills the picture to its corners
    margin = WIDE_MARGIN if flat or drawn.colours.hues else MARGIN  # numbers stand below hues
    camera = framed(drawn.mesh.points, drawn.size[0] / drawn.size[1], margin=margin)
    centre = camera.centre - BAR * camera.half_height * camera.up
    eye = centre + camera.distance * camera.towards
    plotter.camera_position = [tuple(eye), tuple(centre), tuple(camera.up)]
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = camera.half_height
    plotter.reset_camera_clipping_range()


def _add_lines(plotter: pyvista.Plotter, layer: Lines, width: float) -> None:
    ends = layer.segments.reshape(-1, 3)
    cells = np.column_stack((np.full(len(ends) // 2, 2), np.arange(len(ends)).reshape(-1, 2)))
    actor = plotter.add_mesh(
        pyvista.PolyData(ends, lines=cells.ravel()),
        color=layer.colour,
        line_width=width,
        lighting=False,
        show_scalar_bar=False,
    )
    mapper = actor.mapper
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, NEARER)
