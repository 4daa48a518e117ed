"""A proof that is asked for of a mesh that carries no surface."""

import surfmesh


def test_the_report_says_that_there_is_no_surface(tmp_path):
    surfmesh.mesh("sphere").save(tmp_path / "sphere.stl")
    report = surfmesh.check(tmp_path / "sphere.stl", prove=True)
    assert report.proof is None
    assert any("carries no surface" in warning for warning in report.warnings)
    assert not surfmesh.check(tmp_path / "sphere.stl").warnings
