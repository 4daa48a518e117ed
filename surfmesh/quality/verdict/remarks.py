"""What is no fault of a mesh and still should be known, in the order in which it is said."""

from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.verdict.accuracy import min_size_forbids, without_bounds
from surfmesh.quality.verdict.area_and_volume import MinSizeForbidsVolume, volumes_exceeded
from surfmesh.quality.verdict.connectivity import sheets_apart, triangles_not_joined
from surfmesh.quality.verdict.contacts import faces_not_sewn, meeting_bodies
from surfmesh.quality.verdict.finding import Remark, Warned
from surfmesh.quality.verdict.orientation import turned_inward
from surfmesh.quality.verdict.triangles import folded_surfaces


def remarks(measured: Measurements, prove: bool = False) -> tuple[Remark, ...]:
    """What was said when the mesh was made comes first. prove: bounds are asked for."""
    return (
        *(Warned(words=words) for words in measured.mesh.warnings),
        *folded_surfaces(measured),
        *min_size_forbids(measured),
        *(without_bounds(measured) if prove else ()),
        *(one for one in volumes_exceeded(measured) if isinstance(one, MinSizeForbidsVolume)),
        *meeting_bodies(measured),
        *faces_not_sewn(measured),
        *triangles_not_joined(measured),
        *sheets_apart(measured),
        *turned_inward(measured),
    )
