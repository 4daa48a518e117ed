// The whole way of a patch, with hooks that are the caller's own functions in Python.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <array>

#include "binding/arrays.hpp"
#include "binding/calls_back.hpp"
#include "insertion/boundary_arguments.hpp"
#include "patch/patch_mesh.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {
namespace {

/// What a patch is meshed on and how, with what keeps it alive.
struct PatchSettings {
    nb::object surface, chart, background;
    nb::object before_stage, while_packing, before_pass;
    PatchTask task;
};

template <class... Told>
auto told(CallsBack& calls, const nb::object& whom) {
    std::function<bool(Told...)> hook;
    if (!whom.is_none())
        hook = [&calls, &whom](Told... what) { return calls.run([&] { whom(what...); }); };
    return hook;
}

PatchMesh meshed(const PatchSettings& settings, const Points2& uv, const PatchBoundary& boundary) {
    CallsBack calls;
    PatchHooks hooks{told<PatchStage>(calls, settings.before_stage),
                     [&](Vertex circles) {
                         return calls.run([&] {
                             if (!settings.while_packing.is_none()) settings.while_packing(circles);
                         });
                     },
                     told<>(calls, settings.before_pass)};
    PatchMesh made = [&] {
        const nb::gil_scoped_release released;
        return mesh_patch(settings.task, rows<Point2>(uv), boundary, hooks);
    }();
    if (made.end == PatchEnd::surface_failed)
        raise_failure(settings.task.surface, SurfaceStatus::FAILED);
    calls.finish();
    return made;
}

void require_box(const std::array<double, 4>& box) {
    for (const double x : box)
        if (!std::isfinite(x)) throw nb::value_error("box is to be finite");
}

void bind_settings(nb::module_& m) {
    nb::class_<PatchSettings>(m, "PatchSettings", "What a patch is meshed on, and how.")
        .def(
            "__init__",
            [](PatchSettings* made, nb::object surface, nb::object chart, nb::object background,
               std::optional<double> chord, std::optional<double> angle, double min_size,
               const std::array<double, 4>& box, std::size_t expected, bool optimise, bool first,
               bool with_roots, std::optional<double> slope, bool is_width, bool on_lattice,
               bool fewest, std::optional<double> largest, nb::object before_stage,
               nb::object while_packing, nb::object before_pass) {
                require_box(box);
                const AskedAccuracy asked{chord,    angle, min_size, slope,
                                          is_width, false, fewest,   largest.value_or(NO_LARGEST)};
                const PatchTask task{nb::cast<const Surface&>(surface),
                                     nb::cast<const Chart&>(chart),
                                     nb::cast<const Background&>(background),
                                     asked,
                                     {box[0], box[1]},
                                     {box[2], box[3]},
                                     expected,
                                     optimise,
                                     first,
                                     with_roots,
                                     on_lattice};
                new (made) PatchSettings{std::move(surface),
                                         std::move(chart),
                                         std::move(background),
                                         std::move(before_stage),
                                         std::move(while_packing),
                                         std::move(before_pass),
                                         task};
            },
            nb::arg("surface"), nb::arg("chart"), nb::arg("background"),
            nb::arg("chord") = nb::none(), nb::arg("angle") = nb::none(), nb::arg("min_size") = 0.0,
            nb::kw_only(), nb::arg("box"), nb::arg("expected"), nb::arg("optimise") = true,
            nb::arg("first") = true, nb::arg("with_roots") = false, nb::arg("slope") = nb::none(),
            nb::arg("is_width") = false, nb::arg("on_lattice") = false, nb::arg("fewest") = false,
            nb::arg("largest") = nb::none(), nb::arg("before_stage") = nb::none(),
            nb::arg("while_packing") = nb::none(), nb::arg("before_pass") = nb::none(),
            "chord (model units), angle (degrees): what is asked for. box: x0, y0, x1, y1 of the "
            "plane that is packed, in which about ``expected`` circles have room. optimise: else "
            "only diagonals are chosen. first: the sizes come from no earlier round. with_roots: "
            "W of the vertices is wanted. slope: growth per length that sizes lowered there are "
            "graded "
            "to on the mesh. is_width: chord is that of the whole band that a triangle "
            "needs. on_lattice: sizes are for a lattice laid along principal "
            "directions. fewest: sizes up to ``largest`` follow the direction of edges, and the "
            "chord "
            "is used evenly.\nbefore_stage is called with each PatchStage, "
            "while_packing now and then with the number of circles, before_pass before each pass "
            "of smoothing; what they raise stops the work and comes through.");
}

void bind_ends(nb::module_& m) {
    nb::enum_<PatchStage>(m, "PatchStage", "Where the work on a patch is.")
        .value("PACKING", PatchStage::packing)
        .value("BOUNDARY", PatchStage::boundary)
        .value("OPTIMISATION", PatchStage::optimisation)
        .value("MAPPING", PatchStage::mapping);
    nb::enum_<PatchEnd>(m, "PatchEnd", "How the work on a patch ended.")
        .value("DONE", PatchEnd::done)
        .value("PACKING_FAILED", PatchEnd::packing_failed, "see ``packing``")
        .value("BOUNDARY_FAILED", PatchEnd::boundary_failed, "see ``boundary``")
        .value("SURFACE_FAILED", PatchEnd::surface_failed, "its reason is raised")
        .value("CANCELLED", PatchEnd::cancelled, "what the caller raised comes through");
}

void bind_mesh(nb::module_& m) {
    nb::class_<PatchMesh>(m, "PatchMesh", "What has become of a patch.")
        .def_ro("end", &PatchMesh::end, "All else is there where it is DONE.")
        .def_prop_ro("packing", [](const PatchMesh& made) { return made.packing.status; })
        .def_prop_ro(
            "place",
            [](const PatchMesh& made) {
                return std::pair(made.packing.place.x, made.packing.place.y);
            },
            "Where the packing ended, if not by its limits.")
        .def_ro("circles", &PatchMesh::circles, "How many were packed.")
        .def_ro("boundary", &PatchMesh::boundary)
        .def_ro("domain", &PatchMesh::domain, "The triangles in the scaled plane.")
        .def_ro("mapped", &PatchMesh::mapped, "The triangles in space.")
        .def_prop_ro(
            "metric_root_3d", [](const PatchMesh& made) { return view(made.metric_root); },
            nb::rv_policy::automatic, "(k, 6) W of the domain's vertices, if they are wanted")
        .def_ro("requests", &PatchMesh::requests, "Smaller sizes, for another round.");
}

}  // namespace

void bind_patch_mesh(nb::module_& m) {
    bind_settings(m);
    bind_ends(m);
    bind_mesh(m);
    m.def(
        "mesh_loops",
        [](const PatchSettings& settings, const Points2& uv, const Points2& nodes,
           const Pairs& segments, const Pairs& inner, const Vector<std::int64_t>& identity,
           const std::optional<Points3>& points) {
            require_rows(uv.shape(0), nodes.shape(0), "uv");
            return meshed(settings, uv, loop_boundary(nodes, segments, inner, identity, points));
        },
        nb::arg("settings"), nb::arg("uv"), nb::arg("nodes"), nb::arg("segments"), nb::arg("inner"),
        nb::arg("identity"), nb::arg("points") = nb::none(),
        "Mesh what is on the left of loops, without the interpreter.\n\nuv (k, 2), nodes (k, 2): "
        "the same in the scaled plane; the others as ``recover`` in the room insertion takes "
        "them.");
    m.def(
        "mesh_regions",
        [](const PatchSettings& settings, const Points2& uv, const Points2& nodes,
           const Pairs& pieces, const Numbers& segment, const Pairs& loop_segments,
           const Bytes& is_hole) {
            require_rows(uv.shape(0), nodes.shape(0), "uv");
            return meshed(settings, uv,
                          planar_boundary(nodes, pieces, segment, loop_segments, is_hole));
        },
        nb::arg("settings"), nb::arg("uv"), nb::arg("nodes"), nb::arg("pieces"), nb::arg("segment"),
        nb::arg("loop_segments"), nb::arg("is_hole"),
        "The same for a planar domain: keep the regions that lie in more outer loops than "
        "holes.\n\n"
        "nodes (k, 2). pieces (p, 2) int32: pairs of nodes. segment (p,) int32: the segment that "
        "each is\npart of. loop_segments (m, 2) int32: segment and loop. is_hole: (loops,) uint8.");
}

}  // namespace surfmesh::binding
