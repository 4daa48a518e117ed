#include <nanobind/stl/optional.h>

#include "binding/arrays.hpp"
#include "patch/mapping.hpp"
#include "patch/schedule.hpp"
#include "patch/size_requests.hpp"

namespace surfmesh::binding {

template <>
struct Row<Dihedrals::Pair> : RowOf<std::int32_t, 2> {};

namespace {

void bind_mapped(nb::module_& m) {
    nb::class_<MappedPatch>(m, "MappedPatch", "The triangles of a patch in space.")
        .def_prop_ro(
            "uv", [](const MappedPatch& p) { return view(p.uv); }, nb::rv_policy::automatic,
            "(k, 2) parameters of the vertices of the domain")
        .def_prop_ro(
            "points", [](const MappedPatch& p) { return view(p.points); }, nb::rv_policy::automatic,
            "(n, 3)")
        .def_prop_ro(
            "triangles", [](const MappedPatch& p) { return in_threes(p.seamless.triangles); },
            nb::rv_policy::automatic, "(m, 3) of the points")
        .def_prop_ro(
            "uv_triangles", [](const MappedPatch& p) { return in_threes(p.seamless.corners); },
            nb::rv_policy::automatic, "(m, 3) of vertices of the domain")
        .def_prop_ro(
            "vertex", [](const MappedPatch& p) { return view(p.seamless.vertex); },
            nb::rv_policy::automatic, "(n,) vertex of the domain that each point was computed from")
        .def_prop_ro(
            "non_manifold", [](const MappedPatch& p) { return view(p.seamless.non_manifold); },
            nb::rv_policy::automatic, "(k,) points where identification has made no surface")
        .def_prop_ro(
            "sizes", [](const MappedPatch& p) { return view(p.sizes); }, nb::rv_policy::automatic,
            "(n,) of the points: what the field asks for, with what the optimiser made smaller");
}

}  // namespace

void bind_results(nb::module_& m) {
    nb::class_<Unmended>(m, "Unmended", "What the optimiser has left.")
        .def_prop_ro(
            "far", [](const Unmended& u) { return view(u.far); }, nb::rv_policy::automatic,
            "Triangles (n,) still farther than ``chord`` from the surface.")
        .def_prop_ro(
            "folded", [](const Unmended& u) { return view(u.folded); }, nb::rv_policy::automatic,
            "Triangles (n,) turned far from the surface's normals.")
        .def_prop_ro(
            "bent", [](const Unmended& u) { return view(u.dihedrals.triangles); },
            nb::rv_policy::automatic,
            "Triangles (k, 2) on both sides of edges with more than ``angle`` between them.")
        .def_prop_ro(
            "angles", [](const Unmended& u) { return view(u.dihedrals.angles); },
            nb::rv_policy::automatic, "The angles (k,) there, radians.");
    nb::class_<SizeLimitArrays>(m, "SizeLimitArrays", "At each point the size is at most this.")
        .def_prop_ro(
            "points", [](const SizeLimitArrays& l) { return view(l.points); },
            nb::rv_policy::automatic, "(k, 3) in space")
        .def_prop_ro(
            "sizes", [](const SizeLimitArrays& l) { return view(l.sizes); },
            nb::rv_policy::automatic, "(k,) model units")
        .def_prop_ro(
            "uv", [](const SizeLimitArrays& l) { return view(l.uv); }, nb::rv_policy::automatic,
            "(k, 2) parameters of the points; empty where sizes are isotropic")
        .def_prop_ro(
            "metric_root_3d", [](const SizeLimitArrays& l) { return view(l.metric_root); },
            nb::rv_policy::automatic, "(k, 6) W; empty where sizes are isotropic");
    nb::class_<SizeRequests>(m, "SizeRequests",
                             "What a patch asks for, by what is not right there.")
        .def_ro("chord", &SizeRequests::chord)
        .def_ro("folds", &SizeRequests::folds)
        .def_ro("angle", &SizeRequests::angle);
    bind_mapped(m);
}

}  // namespace surfmesh::binding
