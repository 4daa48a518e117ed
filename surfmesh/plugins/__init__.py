"""surfmesh from within other libraries.

pyvista_accessor: ``data.surfmesh`` on PyVista's PolyData; PyVista finds it by its entry point.
cadquery_plugin: ``Workplane.surfmesh(...)`` in CadQuery, once this module is imported.
script_models: the model that a program with CadQuery in it makes.
"""
