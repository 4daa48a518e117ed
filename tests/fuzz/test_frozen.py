"""What damaged input has brought to light, each as small as it could be made.

What it did before stands beside it. All is wanted to end as ``trials`` says: in one line, or as
something sound, quietly.
"""

import json
import os

import pytest
from fuzz import trials
from fuzz.mutations import Mutant

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="inputs are tried in forks")

POINTS = b"0 0 0\n1 0 0\n0 1 0\n"
RUN = b'{"groups":{},"runs":[[0,1]]%s}'
DOMAIN = b'name = "a"\nx = "u"\ny = "v"\nz = "u*v"\n[domain]\nu = [0, 1]\nv = [%s, 1]\n'
SQUARE = b'name = "a"\nouter = [[0, 0], [1, 0], [1, 1], [0, 1]]\n'


def with_record(text: bytes, mark: bytes) -> bytes:
    return mark + b"surfmesh-groups %d:%s\n" % (len(text), text)


def vtp(attributes: bytes) -> bytes:
    """A triangle, and an array of fields with odd attributes."""
    array = b'<DataArray type="%s" Name="a" format="ascii" %s>%s</DataArray>'
    points = array % (b"Float64", b'NumberOfComponents="3"', POINTS)
    corners, ends = (array % (b"Int32", b"", numbers) for numbers in (b"0 1 2", b"3"))
    return (
        b'<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData><FieldData>'
        + array % (b"Float64", attributes, b"0 0 0")
        + b'</FieldData><Piece NumberOfPoints="3" NumberOfPolys="1"><Points>'
        + points
        + b"</Points><Polys>"
        + corners.replace(b'"a"', b'"connectivity"')
        + ends.replace(b'"a"', b'"offsets"')
        + b"</Polys></Piece></PolyData></VTKFile>"
    )


FROZEN: dict[str, tuple[str, bytes, str]] = {
    # name: kind, the file, how it is to end ("" for either)
    "coordinate_that_is_no_number": (".off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", ""),
    # numpy's warnings before the answer
    "rise_next_to_zero": (  # numpy warned of a division
        "domain",
        SQUARE.replace(b"[1, 0]", b"[1, 1e-320]")
        + b"holes = [[[0.3, 0.3], [0.6, 0.3], [0.6, 0.6]]]\n",
        "read",
    ),
    "long_name_of_a_function": (  # a message of 3,000 characters
        "surface",
        (DOMAIN % b"0").replace(b"u*v", b"s" * 3000 + b"(u)"),
        "refused",
    ),
    "nothing_but_an_end": (  # ValueError
        "drawing", b'<svg viewBox="0 0 10 10"><path d="Z"/></svg>', "refused",
    ),
    "extent_that_is_no_number": (  # numpy warned of a difference
        "drawing", b'<svg><path d="M -1.5e308 0 L 1.5e308 0 L 0 1 Z"/></svg>', "refused",
    ),
    "text_among_points": (  # ValueError
        "sizes", b'[[sizes."*".sources]]\nnear = [0, "2*pi"]\nsize = 0.1\n', "refused",
    ),
    "long_name_of_a_key": ("domain", SQUARE + b"A" * 3000 + b" = 1\n", "refused"),
    "long_name_of_a_table": ("sizes", b"[" + b"A" * 3000 + b"]\na = 1\n", "refused"),
    "endless_circle_after_a_curve": (  # ValueError
        "drawing",
        b'<svg><rect width="30" height="20" rx="3"/><circle cx="1" cy="1" r="1e400"/></svg>',
        "refused",
    ),
    "coordinate_beyond_squares": (".off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1e308 0\n3 0 1 2\n", ""),
    "last_number_cut": (
        ".obj",  # read with triangle 1 2 1 instead of 1 2 12
        b"# surfmesh\n" + with_record(RUN % b"", b"# ") + b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
        "refused",
    ),
    "last_triangles_gone": (
        ".obj",
        b"# surfmesh\n" + with_record(b'{"groups":{},"runs":[[0,2]]}', b"# ")
        + b"v 0 0 0\nv 1 0 0\nv 0 1 0\n# face_id 0\nf 1 2 3\n",
        "refused",
    ),
    "text_ply_without_its_last_rows": (
        ".ply",  # trimesh said on the console that it could not convert colours
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        b"property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 2 3\n",
        "refused",
    ),
    "edges_of_points_that_are_not_there": (
        ".off",  # read, and the segments led out of the mesh
        b"OFF\n" + with_record(RUN % b',"edge_segments":[[0,11]],"edge_ids":[0]', b"# ")
        + b"3 1 0\n" + POINTS + b"3 0 1 2\n",
        "refused",
    ),
    "edges_without_numbers": (
        ".off",
        b"OFF\n" + with_record(RUN % b',"edge_segments":[[0,1]],"edge_ids":[]', b"# ")
        + b"3 1 0\n" + POINTS + b"3 0 1 2\n",
        "refused",
    ),
    "components_by_the_million": (".vtp", vtp(b'NumberOfComponents="2147483647"'), ""),
    # VTK killed the process, or did not come back
    "tuples_by_the_million": (".vtp", vtp(b'NumberOfTuples="9223372036854775807"'), ""),
    "drawing_below_another_root": (
        "drawing",  # AttributeError: no viewbox_transform
        b'<a><svg><path d="M0 0 L1 0 L1 1 Z"/></svg></a>',
        "",
    ),
    "drawing_of_itself": (
        "drawing",  # RecursionError; nine levels of ten <use> each ran for ever
        b'<svg><g id="a"><use href="#a"/></g></svg>',
        "refused",
    ),
    "drawing_of_a_milliard_shapes": (
        "drawing",
        b'<svg><path id="a0" d="M0 0L1 0L1 1Z"/>'
        + b"".join(
            b'<g id="a%d">%s</g>' % (n, b'<use href="#a%d"/>' % (n - 1) * 10) for n in range(1, 10)
        )
        + b"</svg>",
        "refused",
    ),
    "drawing_without_width": (
        "drawing",  # ZeroDivisionError
        b'<svg viewBox="0 0 0 0" width="9mm"><rect width="3" height="3"/></svg>',
        "",
    ),
    "drawing_beyond_squares": (
        "drawing",  # a warning of shapely, ValueError of a float that is no integer
        b'<svg><path d="M0 0 L1e300 0 L1e300 1e300 Z M0 0 Q1 1e999 2 0 Z"/></svg>',
        "refused",
    ),
    "corner_next_to_zero": (
        "domain",  # a warning of shapely
        SQUARE + b"holes = [[[0.1, 0.1], [0.2, 0.1], [1e-320, 0.2]]]\n[sizing]\nsize = 0.3\n",
        "",
    ),
    "size_below_zero": (
        ".ply",  # numpy's warning before the answer
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        b"property float z\nproperty float size\nelement face 1\n"
        b"property list uchar int vertex_indices\nend_header\n"
        b"0 0 0 0\n1 0 0 0\n0 1 0 -1\n3 0 1 2\n",
        "",
    ),
    "point_beyond_squares": (
        "command",  # ValueError: inf in JSON
        json.dumps(["explain", "plane", "--at", "0", "0", "1e300", "--json"]).encode(),
        "",
    ),
    "bound_of_400_digits": ("surface", DOMAIN % (b"1" + b"0" * 400), "refused"),  # OverflowError
    "bound_whose_square_overflows": ("surface", DOMAIN % b"-1e300", ""),  # ValueError of scipy
    "lists_within_lists": ("domain", SQUARE + b"holes = " + b"[" * 3000 + b"]" * 3000, "refused"),
    "tables_within_tables": ("sizes", b"a = " + b"{a=" * 3000 + b"1" + b"}" * 3000, "refused"),
    "key_of_many_parts": ("sizes", b"[" + b".".join([b"a"] * 3000) + b"]", "refused"),
    "formula_for_a_number": (
        "sizes",  # the whole of it in the one line
        b'[sizes."*"]\ngrowth = "u' + b"+u" * 900 + b'"\n',
        "refused",
    ),
    "nothing_for_a_name": ("command", json.dumps(["check", "\0"]).encode(), ""),
    "escapes_in_a_name": ("command", json.dumps(["check", "\x1b[2J.off"]).encode(), ""),
    "seed_below_zero": (
        "command",
        json.dumps(["pack", "--uniform", "1", "2", "--count", "9", "--seed", "-1"]).encode(),
        "",
    ),
    "distance_without_end": (
        "command",
        json.dumps(["pack", "--radius", "1", "--count", "9", "--distance", "1e300"]).encode(),
        "",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FROZEN)
def test_what_was_found_stays_mended(name):
    kind, data, end = FROZEN[name]
    task = trials.Task(kind, name, lambda: Mutant(data, -1, ()))
    (trial,) = trials.tried([task], prepare=False)
    assert not trial.is_fault, f"{trial.ended}: {trial.said}"
    assert end in ("", trial.ended), f"{trial.ended}: {trial.said}"
