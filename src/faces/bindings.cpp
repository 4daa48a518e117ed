// The work on faces, one by one and in a queue.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>

#include "binding/arrays.hpp"
#include "binding/calls_back.hpp"
#include "faces/face_queue.hpp"
#include "faces/inward_sizes.hpp"
#include "insertion/boundary_arguments.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

void bind_boundaries(nb::module_& m);
void bind_coedges(nb::module_& m);
void bind_joining(nb::module_& m);
void bind_graded(nb::module_& m);

namespace {

void require_unbent(const Chart& chart) {
    if (!chart.u.pieces.empty() || !chart.v.pieces.empty())
        throw nb::value_error("the chart of a face is not bent");
}

/// Raise what a surface of the caller's own has raised on the way.
void raise_if_failed(const Surface& surface, const FaceMesh& made) {
    if ((made.end == FaceEnd::patch_failed && made.patch.end == PatchEnd::surface_failed) ||
        made.coarse.points.size() != made.coarse.sizes.size())
        raise_failure(surface, SurfaceStatus::FAILED);
}

/// Work on a face without the interpreter, which is asked for signals now and then.
template <class Work>
FaceMesh worked(const Surface& surface, const Work& work) {
    CallsBack calls;
    const PatchHooks hooks{{}, [&](Vertex) { return calls.run([] {}); }, {}};
    FaceMesh made = [&] {
        const nb::gil_scoped_release released;
        return work(hooks);
    }();
    raise_if_failed(surface, made);
    calls.finish();
    return made;
}

void bind_coarse(nb::module_& m) {
    nb::class_<CoarseSegments> c(m, "CoarseSegments",
                                 "Where segments of a boundary are far longer than the sizes "
                                 "inside allow.");
    bind_read_only_array(c, "points", &CoarseSegments::points, "(k, 3) on the surface");
    bind_read_only_array(c, "sizes", &CoarseSegments::sizes, "(k,) of the field there");
    bind_read_only_array(c, "along", &CoarseSegments::along,
                         "(k, 3) unit directions of the segments");
    m.def(
        "coarse_segments",
        [](const Surface& surface, const Chart& chart, const Background& background,
           const FacePolygons& polygons, double min_size, bool is_anisotropic) {
            require_unbent(chart);
            CoarseSegments found = [&] {
                const nb::gil_scoped_release released;
                return coarse_segments({surface, chart, background}, polygons, min_size,
                                       is_anisotropic);
            }();
            if (found.points.size() != found.sizes.size())
                raise_failure(surface, SurfaceStatus::FAILED);
            return found;
        },
        nb::arg("surface"), nb::arg("chart"), nb::arg("background"), nb::arg("polygons"),
        nb::arg("min_size"), nb::arg("is_anisotropic"),
        "Where segments of the loops are more than twice as long as the sizes inside allow.");
}

void bind_ends(nb::module_& m) {
    nb::enum_<FaceEnd>(m, "FaceEnd", "How the work on a face ended.")
        .value("DONE", FaceEnd::done)
        .value("UNPREPARED", FaceEnd::unprepared,
               "There is no box, no positive sizes, or more cells are needed than are allowed.")
        .value("TUBES", FaceEnd::tubes, "It may have thin tubes, which are meshed by themselves.")
        .value("RUNS_TWICE", FaceEnd::runs_twice, "A segment runs twice the same way.")
        .value("PATCH_FAILED", FaceEnd::patch_failed, "See ``patch``.")
        .value("NOT_JOINED", FaceEnd::not_joined, "At the non-manifold points of ``patch``.");
    nb::class_<FaceMesh> c(m, "FaceMesh", "What has become of a face.");
    c.def_ro("end", &FaceMesh::end);
    c.def_ro("patch", &FaceMesh::patch);
    c.def_ro("coarse", &FaceMesh::coarse, "Segments that are to be cut; of a first round.");
    bind_read_only_array(c, "slots", &FaceMesh::slots,
                         "(n,) of the points: row in the boundary, -1 inside");
    bind_read_only_array(c, "uv", &FaceMesh::uv, "(k, 2) of the nodes of the loops");
    bind_read_only_array(c, "segments", &FaceMesh::segments, "(s, 2) int32 between these");
}

void bind_manner(nb::module_& m) {
    nb::class_<FaceManner>(m, "FaceManner", "How a face is meshed, whatever its sizes.")
        .def(
            "__init__",
            [](FaceManner* made, std::optional<double> chord, std::optional<double> angle,
               double min_size, bool optimise, bool first, bool is_anisotropic,
               std::optional<double> slope, bool keeps_lowered, bool on_lattice, bool fewest,
               std::optional<double> largest) {
                new (made) FaceManner{{chord, angle, min_size, slope, false, keeps_lowered, fewest,
                                       largest.value_or(NO_LARGEST)},
                                      optimise,
                                      first,
                                      is_anisotropic,
                                      on_lattice};
            },
            nb::arg("chord").none(), nb::arg("angle").none(), nb::arg("min_size"),
            nb::arg("optimise") = true, nb::arg("first") = true, nb::arg("is_anisotropic") = false,
            nb::arg("slope") = nb::none(), nb::arg("keeps_lowered") = false,
            nb::arg("on_lattice") = false, nb::arg("fewest") = false,
            nb::arg("largest") = nb::none(),
            "keeps_lowered: nodes of the boundary keep sizes that were lowered there. "
            "chord (model units), angle (degrees), min_size: what is asked for, with 0 for no "
            "least size. optimise: else only diagonals are chosen. first: the sizes come from no "
            "earlier round. is_anisotropic: they depend on the direction. slope: growth per "
            "length that such sizes are graded to on the mesh. on_lattice: sizes are for a lattice "
            "laid along principal directions. fewest: sizes up to ``largest`` follow the direction "
            "of "
            "edges, and the chord is used evenly.");
}

std::optional<InwardFace> inward_face(std::shared_ptr<Surface> surface,
                                      std::shared_ptr<FaceBoundary> boundary,
                                      std::optional<double> radius, const AskedRules& asked,
                                      double slope, FaceManner manner, bool look_for_tubes) {
    if (!(radius.value_or(1.0) > 0.0 && slope > 0.0))
        throw nb::value_error("radius and slope are to be positive");
    const PlaneBox box = boundary->box();
    const bool is_wide = box.low.x < box.high.x && box.low.y < box.high.y;  // false for nan
    if (boundary->has_degenerate() || !is_wide) return {};
    const EvenSurface even{*surface, radius, {box.low, box.high}};
    const InwardSizes sizes = inward_sizes(even, asked);
    if (!(sizes.largest > 0.0) || !std::isfinite(sizes.largest)) {
        if (auto failure = surface->take_failure()) std::rethrow_exception(failure);
        throw nb::value_error("no largest size is asked for");
    }
    manner.on_lattice = sizes.on_lattice;
    return InwardFace{std::move(surface),
                      std::move(boundary),
                      {even.speeds(), sizes.largest, slope},
                      manner,
                      look_for_tubes};
}

void bind_inward(nb::module_& m) {
    nb::class_<InwardFace>(m, "InwardFace",
                           "A face with constant speeds |r_u|, |r_v|, whose sizes grow inward "
                           "from those of its edges.")
        .def_prop_ro("largest", [](const InwardFace& face) { return face.growth.largest; })
        .def_prop_ro("on_lattice", [](const InwardFace& face) { return face.manner.on_lattice; });
    m.def("inward_face", &inward_face, nb::arg("surface"), nb::arg("boundary"),
          nb::arg("radius").none(), nb::arg("asked"), nb::arg("slope"), nb::arg("manner"),
          nb::arg("look_for_tubes") = false,
          "A plane (radius None) or a cylinder whose sizes grow by ``slope`` per length up to what "
          "the rules allow; None where a coedge is degenerate, or the box of the boundary has no "
          "area. look_for_tubes: a face that may have thin tubes is not meshed, see FaceEnd.");
}

/// What a call of the queue finishes; what a signal or a surface raises ends all work.
FinishedFaces finished(FaceQueue& queue, std::int64_t triangles) {
    CallsBack calls;
    FinishedFaces made = [&] {
        const nb::gil_scoped_release released;
        return queue.work(triangles, [&] { return calls.run([] {}); });
    }();
    calls.finish();
    for (const auto& [face, other] : made.others) raise_if_failed(queue.surface_of(face), other);
    return made;
}

void bind_rows(nb::module_& m) {
    nb::class_<FaceRows> c(m, "FaceRows",
                           "Meshes of faces in rows: those of a face go up to its ends, from those "
                           "of the face before it.");
    bind_array(c, "face", &FaceRows::face, "(k,) int64 numbers in the queue");
    bind_array(c, "point_end", &FaceRows::point_end, "(k,) int64");
    bind_array(c, "triangle_end", &FaceRows::triangle_end, "(k,) int64");
    bind_array(c, "corner_end", &FaceRows::corner_end, "(k,) int64");
    bind_array(c, "points", &FaceRows::points, "(n, 3)");
    bind_array(c, "slots", &FaceRows::slots, "(n,) of the points: row in the boundary, -1 inside");
    bind_array(c, "sizes", &FaceRows::sizes, "(n,) of the points");
    c.def_prop_ro(
        "triangles", [](const FaceRows& r) { return in_threes(r.triangles); },
        nb::rv_policy::automatic, "(m, 3) of the face's own points");
    c.def_prop_ro(
        "uv_triangles", [](const FaceRows& r) { return in_threes(r.uv_triangles); },
        nb::rv_policy::automatic, "(m, 3) of the face's own corners");
    bind_array(c, "uv", &FaceRows::uv, "(k, 2) of the corners");
}

std::vector<QueuedFace> queued(const std::vector<nb::object>& faces) {
    std::vector<QueuedFace> copies;
    copies.reserve(faces.size());
    for (const nb::object& face : faces) {
        InwardFace* inward = nullptr;
        GradedFace* graded = nullptr;
        if (face.is_none()) throw nb::type_error("None is no face");
        if (nb::try_cast(face, inward))
            copies.emplace_back(*inward);
        else if (nb::try_cast(face, graded))
            copies.emplace_back(*graded);
        else
            throw nb::type_error("a face is an InwardFace or a GradedFace");
    }
    return copies;
}

void bind_queue(nb::module_& m) {
    bind_rows(m);
    nb::class_<FinishedFaces>(m, "FinishedFaces", "Faces that a call of ``FaceQueue.work`` meshed.")
        .def_ro("rows", &FinishedFaces::rows, "Those that ask for nothing.")
        .def_prop_ro(
            "others",
            [](FinishedFaces& made) {
                nb::list found;
                for (OtherFace& other : made.others)
                    found.append(nb::make_tuple(other.face, std::move(other.made)));
                made.others.clear();
                return found;
            },
            nb::sig("def others(self) -> list[tuple[int, FaceMesh]]"),
            "Number and mesh of every other face; they are handed out once.")
        .def("__bool__", [](const FinishedFaces& made) { return !made.empty(); });
    nb::class_<FaceQueue>(m, "FaceQueue",
                          "Faces that any threads mesh one after the other, in their order.")
        .def(
            "__init__",
            [](FaceQueue* made, const std::vector<nb::object>& faces) {
                new (made) FaceQueue(queued(faces));
            },
            nb::arg("faces"),
            nb::sig("def __init__(self, faces: Sequence[InwardFace | GradedFace]) -> None"))
        .def("work", &finished, nb::arg("triangles"),
             "Mesh faces that nobody has begun, without the interpreter, until so many triangles "
             "are made; nothing when none is left.")
        .def("stop", &FaceQueue::stop, "Begin no face any more, and finish none.");
}

void bind_work(nb::module_& m) {
    m.def(
        "mesh_face",
        [](const Surface& surface, const Chart& chart, const Background& background,
           const FacePolygons& polygons, const FaceManner& manner) {
            require_unbent(chart);
            return worked(surface, [&](const PatchHooks& hooks) {
                return mesh_face({surface, chart, background}, polygons, manner, hooks);
            });
        },
        nb::arg("surface"), nb::arg("chart"), nb::arg("background"), nb::arg("polygons"),
        nb::arg("manner"), "Mesh a face with a given size field, without the interpreter.");
    m.def(
        "mesh_inward",
        [](const InwardFace& face) {
            return worked(*face.surface,
                          [&](const PatchHooks& hooks) { return mesh_inward(face, hooks); });
        },
        nb::arg("face"), "Mesh a face whose sizes grow inward, without the interpreter.");
    m.def(
        "metric_areas_inward",
        [](const std::vector<const InwardFace*>& faces) {
            Array<double> areas;
            for (const InwardFace* face : faces) {
                if (face == nullptr) throw nb::type_error("None is no face");
                areas.push_back(metric_area_inward(*face));
            }
            return view(areas);
        },
        nb::arg("faces"),
        "The metric areas (f,) that such sizes give to what lies within the loops; no numbers "
        "where there is no box, no positive sizes, or more cells are needed than are allowed.");
}

}  // namespace

void bind_faces(nb::module_& m) {
    m.doc() = "A face of a CAD model: its boundary in, its triangles out.";
    bind_boundaries(m);
    bind_coedges(m);
    bind_coarse(m);
    bind_ends(m);
    bind_manner(m);
    bind_inward(m);
    bind_graded(m);
    bind_queue(m);
    bind_joining(m);
    bind_work(m);
}

}  // namespace surfmesh::binding
