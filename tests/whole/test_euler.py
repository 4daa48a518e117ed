"""Meshes of files have the topology of their B-rep."""

import numpy as np
import pytest
from naive.brep_euler import brep_euler

import surfmesh as sm
from surfmesh.quality.measures.solids import solid_mesh

SMALL = ["librepcb_base.lplib__66b0d775-2450-4f25-a826-3e86cd81d5cc.step",
         "build123d__M6-1x12-countersunk-screw.step", "trimesh__featuretype.STEP"]  # fmt: skip


@pytest.mark.parametrize("name", SMALL)
def test_euler_number_of_files(cad_folder, name):
    if not (cad_folder / name).exists():
        pytest.skip(f"no {name}")
    model = sm.load(cad_folder / name)
    mesh = sm.mesh(model, sm.Sizing(chord=0.005 * model.diagonal))
    solid = solid_mesh(mesh, 0)
    euler = len(np.unique(solid.triangles)) - len(solid.edges) + len(solid.triangles)
    assert euler == brep_euler(model, 0)
