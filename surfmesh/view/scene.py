"""A mesh as a PyVista scene."""

import pyvista

from surfmesh.io.vtk_xml import to_pyvista
from surfmesh.surface_mesh import SurfaceMesh
from surfmesh.view.camera import framed
from surfmesh.view.colouring import Colouring
from surfmesh.view.legend import INK, title_of

BAR = 0.05  # of half the height: the mesh moves up, out of the colour bar's way


def scene(
    mesh: SurfaceMesh,
    colours: Colouring,
    *,
    edges: bool,
    size: tuple[int, int],
    off_screen: bool,
) -> pyvista.Plotter:
    """A plotter with ``mesh``, title, colour bar and camera, ready to be shown."""
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=list(size))
    plotter.set_background("white")
    data = to_pyvista(mesh)
    data.clear_data()
    values = data.point_data if colours.per_vertex else data.cell_data
    values[colours.title] = colours.values
    unit = size[1] / 1000
    plotter.add_mesh(
        data,
        scalars=colours.title,
        cmap=colours.colours,
        clim=colours.limits,
        log_scale=colours.logarithmic,
        show_edges=edges,
        edge_color=INK,
        line_width=0.7 * unit,
        lighting=True,
        ambient=0.4,
        diffuse=0.65,
        specular=0.0,
        scalar_bar_args={
            "title": colours.title + "\n",
            "color": INK,
            "title_font_size": round(22 * unit),
            "label_font_size": round(20 * unit),
            "n_labels": 5,
            "fmt": "%.3g",
            "width": 0.5,
            "height": 0.06,
            "position_x": 0.25,
            "position_y": 0.02,
        },
    )
    plotter.add_text(
        title_of(mesh),
        position=(0.02, 0.955),
        viewport=True,
        font_size=round(11 * unit),
        color=INK,
    )
    camera = framed(mesh.points, size[0] / size[1], margin=0.22)
    centre = camera.centre - BAR * camera.half_height * camera.up
    eye = centre + camera.distance * camera.towards
    plotter.camera_position = [tuple(eye), tuple(centre), tuple(camera.up)]
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = camera.half_height
    plotter.reset_camera_clipping_range()
    if edges:
        plotter.enable_anti_aliasing("ssaa")
    return plotter
