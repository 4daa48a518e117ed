// The joining of faces as Python has it: given one by one, joined in one call.
#include <algorithm>
#include <limits>
#include <vector>

#include "binding/arrays.hpp"
#include "faces/face_queue.hpp"
#include "faces/joined_faces.hpp"

namespace surfmesh::binding {
namespace {

using Corners = Matrix<std::int32_t, 3>;

void require_slots(const FacePart& part) {
    const auto nodes = static_cast<std::int64_t>(part.numbers.size());
    bool fits = true;
    for (const std::int64_t slot : part.slots) fits = fits && slot >= -1 && slot < nodes;
    if (!fits) throw nb::value_error("slots has an index that is out of range");
}

/// Those of one face among the rows of several.
template <class T>
std::span<const T> between(const Array<T>& all, std::int64_t first, std::int64_t end) {
    return {all.data() + first, static_cast<std::size_t>(end - first)};
}

/// Faces that are to be joined, and what keeps their arrays.
class FaceJoiner {
  public:
    void add(const Points3& points, const Vector<std::int64_t>& slots, const Vector<double>& sizes,
             const Corners& triangles, const Points2& uv, const Corners& uv_triangles,
             nb::handle_t<FaceBoundary> boundary, std::int32_t face, bool is_turned) {
        require_rows(slots.shape(0), points.shape(0), "slots");
        require_rows(sizes.shape(0), points.shape(0), "sizes");
        require_rows(uv_triangles.shape(0), triangles.shape(0), "uv_triangles");
        const FacePart part{rows<Point3>(points),
                            rows<std::int64_t>(slots),
                            rows<double>(sizes),
                            {triangles.data(), triangles.size()},
                            rows<Point2>(uv),
                            {uv_triangles.data(), uv_triangles.size()},
                            numbers_of(boundary),
                            face,
                            is_turned};
        require_indices(part.triangles, part.points.size(), "triangles");
        require_indices(part.uv_triangles, part.uv.size(), "uv_triangles");
        given_.push_back({points, slots, sizes, triangles, uv, uv_triangles});
        keep(part, boundary);
    }

    void add_row(nb::handle_t<FaceRows> finished, std::int64_t place,
                 nb::handle_t<FaceBoundary> boundary, std::int32_t face, bool is_turned) {
        const FaceRows& all = nb::cast<const FaceRows&>(finished);
        if (place < 0 || place >= static_cast<std::int64_t>(all.face.size()))
            throw nb::value_error("place is out of range");
        const auto first = [place](const Array<std::int64_t>& ends) {
            return place == 0 ? 0 : ends[place - 1];
        };
        const std::int64_t p = first(all.point_end), t = first(all.triangle_end);
        const std::int64_t p_end = all.point_end[place], t_end = all.triangle_end[place];
        const FacePart part{between(all.points, p, p_end),
                            between(all.slots, p, p_end),
                            between(all.sizes, p, p_end),
                            between(all.triangles, 3 * t, 3 * t_end),
                            between(all.uv, first(all.corner_end), all.corner_end[place]),
                            between(all.uv_triangles, 3 * t, 3 * t_end),
                            numbers_of(boundary),
                            face,
                            is_turned};
        kept_.push_back(nb::borrow(finished));
        keep(part, boundary);
    }

    [[nodiscard]] JoinedFaces joined(const Points3& points, const Vector<double>& sizes) const {
        require_rows(sizes.shape(0), points.shape(0), "sizes");
        std::size_t vertices = points.shape(0), corners = 0;
        for (const FacePart& part : parts_) {
            require_indices(part.numbers, points.shape(0), "numbers");
            vertices += part.points.size();
            corners += part.uv.size();
        }
        if (std::max(vertices, corners) > std::numeric_limits<std::int32_t>::max())
            throw nb::value_error("faces have more points than int32 can number");
        const nb::gil_scoped_release released;
        return joined_faces({rows<Point3>(points), rows<double>(sizes)}, parts_);
    }

  private:
    struct Given {
        Points3 points;
        Vector<std::int64_t> slots;
        Vector<double> sizes;
        Corners triangles;
        Points2 uv;
        Corners uv_triangles;
    };

    static std::span<const std::int64_t> numbers_of(nb::handle boundary) {
        const auto& numbers = nb::cast<const FaceBoundary&>(boundary).numbers;
        return numbers;
    }

    void keep(const FacePart& part, nb::handle boundary) {
        require_slots(part);
        kept_.push_back(nb::borrow(boundary));
        parts_.push_back(part);
    }

    std::vector<FacePart> parts_;
    std::vector<Given> given_;
    std::vector<nb::object> kept_;
};

void bind_joined(nb::module_& m) {
    nb::class_<JoinedFaces> c(m, "JoinedFaces", "Faces as one mesh.");
    bind_array(c, "rank", &JoinedFaces::rank,
               "(s,) int64 of the shared nodes: their vertices, -1 for those of no triangle");
    bind_array(c, "points", &JoinedFaces::points,
               "(n, 3) shared nodes first, then those inside face after face");
    bind_array(c, "sizes", &JoinedFaces::sizes, "(n,) of the points: the least that is known");
    c.def_prop_ro(
        "triangles", [](const JoinedFaces& j) { return in_threes(j.triangles); },
        nb::rv_policy::automatic, "(m, 3) of the points, face after face");
    bind_array(c, "face_ids", &JoinedFaces::face_ids, "(m,) int32 of the triangles");
    bind_array(c, "uv", &JoinedFaces::uv, "(k, 2) of the corners, face after face");
    c.def_prop_ro(
        "uv_triangles", [](const JoinedFaces& j) { return in_threes(j.uv_triangles); },
        nb::rv_policy::automatic, "(m, 3) of the corners");
}

}  // namespace

void bind_joining(nb::module_& m) {
    bind_joined(m);
    nb::class_<FaceJoiner>(m, "FaceJoiner", "Joins meshes of faces, given one after the other.")
        .def(nb::init<>())
        .def("add", &FaceJoiner::add, nb::arg("points"), nb::arg("slots"), nb::arg("sizes"),
             nb::arg("triangles"), nb::arg("uv"), nb::arg("uv_triangles"), nb::arg("boundary"),
             nb::arg("face"), nb::arg("is_turned"),
             "A face with points (n, 3), their slots (n,) in its boundary, -1 inside, and sizes "
             "(n,); with triangles (m, 3) of these, and as many of uv (k, 2). is_turned: its "
             "triangles turn over.")
        .def("add_row", &FaceJoiner::add_row, nb::arg("rows"), nb::arg("place"),
             nb::arg("boundary"), nb::arg("face"), nb::arg("is_turned"),
             "The same of the face at a place among the rows of a queue.")
        .def("joined", &FaceJoiner::joined, nb::arg("points"), nb::arg("sizes"),
             "All of them; points (s, 3), sizes (s,): of the nodes of boundaries by number.");
}

}  // namespace surfmesh::binding
