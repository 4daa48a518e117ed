#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <optional>
#include <tuple>

#include "binding/arrays.hpp"
#include "proof/closer_look.hpp"
#include "proof/curve_bounds.hpp"
#include "proof/curved_pieces.hpp"
#include "proof/isotopy.hpp"
#include "proof/polar_pieces.hpp"
#include "proof/ring_bounds.hpp"
#include "proof/side_rates.hpp"
#include "proof/triangle_bounds.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

namespace {

constexpr std::size_t COLUMNS = sizeof(TriangleBounds) / sizeof(double);
using Corners3 = nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;
using Corners2 = nb::ndarray<const double, nb::shape<-1, 3, 2>, nb::c_contig, nb::device::cpu>;
using BoundRows = Matrix<double, COLUMNS>;
using NewBoundRows = nb::ndarray<nb::numpy, double, nb::shape<-1, COLUMNS>>;

std::optional<NewBoundRows> bounds_of(const Surface& surface, const Corners3& corners,
                                      const Corners2& uv, const Corners2& bends,
                                      const Vector<double>& limits,
                                      const Vector<std::uint8_t>& rims, int depth,
                                      bool corners_are_on_surface, double slope,
                                      const std::optional<Corners3>& curved) {
    constexpr int DEEPEST = 12;
    const std::size_t count = corners.shape(0);
    require_rows(uv.shape(0), count, "uv");
    require_rows(bends.shape(0), count, "bends");
    require_rows(limits.shape(0), count, "limits");
    require_rows(rims.shape(0), count, "rims");
    if (curved) require_rows(curved->shape(0), count, "curved");
    if (depth < 0 || depth > DEEPEST) throw nb::value_error("depth is 0 to 12");
    auto found = Array<TriangleBounds>::unfilled(count);
    SurfaceStatus status;
    {
        const nb::gil_scoped_release released;
        status = triangle_bounds(
            surface,
            {rows<SpaceCorners>(corners), rows<PlaneCorners>(uv), rows<PlaneBends>(bends),
             rows<double>(limits), rows<std::uint8_t>(rims), corners_are_on_surface, slope,
             curved ? rows<SpaceBends>(*curved) : std::span<const SpaceBends>()},
            depth, {found.data(), found.size()});
    }
    raise_failure(surface, status);
    if (status == SurfaceStatus::UNKNOWN) return std::nullopt;
    const std::size_t shape[] = {count, COLUMNS};
    return NewBoundRows(reinterpret_cast<double*>(found.data()), 2, shape, owner_of(found));
}

void require_mesh(std::size_t count, const Matrix<std::int32_t, 3>& triangles,
                  const Vector<std::int32_t>& twins, const BoundRows& bounds) {
    require_rows(triangles.shape(0), count, "triangles");
    require_rows(twins.shape(0), 3 * count, "twins");
    require_rows(bounds.shape(0), count, "bounds");
    for (const std::int32_t twin : rows<std::int32_t>(twins))
        if (twin < NIL || (twin >= 0 && static_cast<std::size_t>(twin) >= 3 * count))
            throw nb::value_error("twins has an index that is out of range");
    for (std::size_t k = 0; k < 3 * count; ++k)
        if (triangles.data()[k] < 0 || static_cast<std::size_t>(triangles.data()[k]) >= 3 * count)
            throw nb::value_error("triangles has an index that is out of range");
}

auto around(const Corners3& corners, const Matrix<std::int32_t, 3>& triangles,
            const Vector<std::int32_t>& twins, const BoundRows& bounds,
            const Vector<double>& limits) {
    const std::size_t count = corners.shape(0);
    require_mesh(count, triangles, twins, bounds);
    require_rows(limits.shape(0), count, "limits");
    RingBounds found;
    {
        const nb::gil_scoped_release released;
        found = ring_bounds(rows<SpaceCorners>(corners), {triangles.data(), 3 * count},
                            rows<std::int32_t>(twins), rows<TriangleBounds>(bounds),
                            rows<double>(limits));
    }
    return std::pair(view(found.bound), view(found.by_ring));
}

auto closer(const Surface& surface, const Corners3& corners, const Corners2& uv,
            const Corners2& bends, const Matrix<std::int32_t, 3>& triangles,
            const Vector<std::int32_t>& twins, const BoundRows& bounds,
            const Vector<std::int32_t>& which, const Vector<double>& limits, int levels,
            const Vector<double>& bound, const Corners2& gaps,
            const Vector<std::int32_t>& gap_owners, const BoundRows& gap_bounds) {
    constexpr int FINEST = 6;
    const std::size_t count = corners.shape(0);
    require_rows(uv.shape(0), count, "uv");
    require_rows(bends.shape(0), count, "bends");
    require_rows(limits.shape(0), count, "limits");
    require_rows(bound.shape(0), count, "bound");
    require_indices(rows<std::int32_t>(which), count, "which");
    require_mesh(count, triangles, twins, bounds);
    require_rows(gap_owners.shape(0), gaps.shape(0), "gap_owners");
    require_rows(gap_bounds.shape(0), gaps.shape(0), "gap_bounds");
    if (levels < 0 || levels > FINEST) throw nb::value_error("levels is 0 to 6");
    Array<double> found(rows<double>(bound));
    SurfaceStatus status;
    {
        const nb::gil_scoped_release released;
        const ProofMesh mesh{rows<SpaceCorners>(corners), rows<PlaneCorners>(uv),
                             rows<PlaneBends>(bends),     {triangles.data(), 3 * count},
                             rows<std::int32_t>(twins),   rows<TriangleBounds>(bounds)};
        const PoleGaps between{rows<PlaneCorners>(gaps), rows<std::int32_t>(gap_owners),
                               rows<TriangleBounds>(gap_bounds)};
        status = look_closer(surface, mesh, between, rows<std::int32_t>(which),
                             rows<double>(limits), levels, {found.data(), found.size()});
    }
    raise_failure(surface, status);
    return view(found);
}

auto parted(const Corners2& uv, const Vector<std::int32_t>& twins) {
    const std::size_t count = uv.shape(0);
    require_rows(twins.shape(0), 3 * count, "twins");
    for (const std::int32_t twin : rows<std::int32_t>(twins))
        if (twin < NIL || (twin >= 0 && static_cast<std::size_t>(twin) >= 3 * count))
            throw nb::value_error("twins has an index that is out of range");
    return view(parted_half_edges(rows<PlaneCorners>(uv), rows<std::int32_t>(twins)));
}

void require_face(const Corners3& corners, const Corners2& uv,
                  const Matrix<std::int32_t, 3>& triangles, const Vector<std::int32_t>& twins) {
    const std::size_t count = corners.shape(0);
    require_rows(uv.shape(0), count, "uv");
    require_rows(triangles.shape(0), count, "triangles");
    require_rows(twins.shape(0), 3 * count, "twins");
    for (const std::int32_t twin : rows<std::int32_t>(twins))
        if (twin < NIL || (twin >= 0 && static_cast<std::size_t>(twin) >= 3 * count))
            throw nb::value_error("twins has an index that is out of range");
}

FaceSides sides_of(const Corners3& corners, const Corners2& uv,
                   const Matrix<std::int32_t, 3>& triangles, const Vector<std::int32_t>& twins) {
    return {rows<SpaceCorners>(corners),
            rows<PlaneCorners>(uv),
            {triangles.data(), 3 * triangles.shape(0)},
            rows<std::int32_t>(twins)};
}

using NewBends = nb::ndarray<nb::numpy, double, nb::shape<-1, 3, 2>>;

NewBends as_bends(const Array<PlaneBends>& bends) {
    const std::size_t shape[] = {bends.size(), 3, 2};
    return NewBends(reinterpret_cast<double*>(bends.data()), 3, shape, owner_of(bends));
}

NewBends curved(const Surface& surface, const Corners3& corners, const Corners2& uv,
                const Matrix<std::int32_t, 3>& triangles, const Vector<std::int32_t>& twins,
                const std::optional<Corners3>& middles) {
    require_face(corners, uv, triangles, twins);
    if (middles) require_rows(middles->shape(0), corners.shape(0), "middles");
    Array<PlaneBends> bends;
    SurfaceStatus status;
    {
        const nb::gil_scoped_release released;
        status = curved_pieces(
            surface, sides_of(corners, uv, triangles, twins),
            middles ? rows<SpaceCorners>(*middles) : std::span<const SpaceCorners>(), bends);
    }
    raise_failure(surface, status);
    return as_bends(bends);
}

NewBends straightened(const Corners2& bends, const Corners3& corners, const Corners2& uv,
                      const Matrix<std::int32_t, 3>& triangles, const Vector<std::int32_t>& twins,
                      const Vector<std::uint8_t>& is_bad) {
    require_face(corners, uv, triangles, twins);
    require_rows(bends.shape(0), corners.shape(0), "bends");
    require_rows(is_bad.shape(0), corners.shape(0), "is_bad");
    Array<PlaneBends> found(rows<PlaneBends>(bends));
    straighten(sides_of(corners, uv, triangles, twins), rows<std::uint8_t>(is_bad),
               {found.data(), found.size()});
    return as_bends(found);
}

using Segments3 = nb::ndarray<const double, nb::shape<-1, 2, 3>, nb::c_contig, nb::device::cpu>;

auto bounds_of_curve(const Curve& curve, const Matrix<double, 2>& t, const Segments3& ends) {
    constexpr int PARTS = 4;
    require_rows(ends.shape(0), t.shape(0), "ends");
    if (curve.dimension() != 3) throw nb::value_error("the curve must lie in space");
    Array<double> found;
    {
        const nb::gil_scoped_release released;
        found = curve_bounds(curve, rows<ParameterEnds>(t), rows<SegmentEnds>(ends), PARTS);
    }
    return view(found);
}

using NewMoves = nb::ndarray<nb::numpy, double, nb::shape<-1, 2>>;

std::optional<NewMoves> moves_at_pole(const Surface& surface, const Corners3& corners,
                                      const Corners2& base, bool is_v, double value) {
    const std::size_t count = corners.shape(0);
    require_rows(base.shape(0), count, "base");
    const auto* derivatives = dynamic_cast<const FourthDerivatives*>(&surface);
    if (derivatives == nullptr) return std::nullopt;
    Array<PolarMove> found(count);
    SurfaceStatus status;
    {
        const nb::gil_scoped_release released;
        status = polar_moves(surface, *derivatives,
                             {rows<SpaceCorners>(corners), rows<PlaneCorners>(base), {is_v, value}},
                             {found.data(), found.size()});
    }
    raise_failure(surface, status);
    if (status == SurfaceStatus::UNKNOWN) return std::nullopt;
    const std::size_t shape[] = {count, 2};
    return NewMoves(reinterpret_cast<double*>(found.data()), 2, shape, owner_of(found));
}

/// Every corner is a point, and each triangle has a number.
MovedMesh moved_mesh(const Points3& points, const Matrix<std::int32_t, 3>& triangles,
                     const Vector<double>& away, const Vector<double>& slope) {
    const std::size_t count = triangles.shape(0);
    require_rows(away.shape(0), count, "away");
    require_rows(slope.shape(0), count, "slope");
    for (std::size_t k = 0; k < 3 * count; ++k)
        if (triangles.data()[k] < 0 ||
            static_cast<std::size_t>(triangles.data()[k]) >= points.shape(0))
            throw nb::value_error("triangles has an index that is out of range");
    return {rows<Point3>(points),
            {triangles.data(), 3 * count},
            rows<double>(away),
            rows<double>(slope)};
}

/// (0, -1, -1) where it holds.
auto isotopy(const Points3& points, const Matrix<std::int32_t, 3>& triangles,
             const Vector<double>& away, const Vector<double>& slope) {
    const MovedMesh mesh = moved_mesh(points, triangles, away, slope);
    IsotopyProof found{};
    {
        const nb::gil_scoped_release released;
        found = prove_isotopy(mesh);
    }
    return std::tuple(static_cast<int>(found.fault), found.first, found.second);
}

auto bent(const Points3& points, const Matrix<std::int32_t, 3>& triangles,
          const Vector<double>& slope) {
    const MovedMesh mesh = moved_mesh(points, triangles, slope, slope);
    Array<std::int32_t> found;
    {
        const nb::gil_scoped_release released;
        found = bent_stars(mesh);
    }
    return view(found);
}

using Sides3 = nb::ndarray<const double, nb::shape<-1, 2, 3>, nb::c_contig, nb::device::cpu>;
using Sides2 = nb::ndarray<const double, nb::shape<-1, 2, 2>, nb::c_contig, nb::device::cpu>;

NewMoves rates_of_sides(const Surface& surface, const Sides3& ends, const Sides2& uv) {
    const std::size_t count = ends.shape(0);
    require_rows(uv.shape(0), count, "uv");
    Array<SideRate> found(count);
    SurfaceStatus status;
    {
        const nb::gil_scoped_release released;
        status = side_rates(surface,
                            {reinterpret_cast<const std::array<Point3, 2>*>(ends.data()), count},
                            {reinterpret_cast<const std::array<Point2, 2>*>(uv.data()), count},
                            {found.data(), count});
    }
    raise_failure(surface, status);
    const std::size_t shape[] = {count, 2};
    return NewMoves(reinterpret_cast<double*>(found.data()), 2, shape, owner_of(found));
}

void bind_single_triangles(nb::module_& m) {
    m.def(
        "triangle_bounds", &bounds_of, nb::arg("surface"), nb::arg("corners"), nb::arg("uv"),
        nb::arg("bends"), nb::arg("limits"), nb::arg("rims"), nb::arg("depth"),
        nb::arg("corners_are_on_surface") = true, nb::arg("slope") = intervals::INFINITE,
        nb::arg("curved") = nb::none(),
        "Of triangles with corners (m, 3, 3) and parameters (m, 3, 2): (m, 29) numbers, or None "
        "where the surface has no bounds.\n\nHeight over the plane; how far the piece leaves "
        "the sides 0, 1, 2 within it; how far it is from these at rims; shift within the plane; "
        "the whole distance point by point; how far corners are off; what ring_bounds asks of "
        "sides; the slope of that distance; what look_closer asks of cells. Triangles whose "
        "height, or "
        "distance at a rim (bit k of ``rims``: side k), is beyond ``limits`` are cut in four, "
        "``depth`` times. bends (m, 3, 2): of ``curved_pieces``. corners_are_on_surface=False: "
        "the corners give the plane alone. "
        "slope: what the slope of the distance should keep to, likewise. curved (m, 3, 3): how far "
        "middles of the sides of quadratic triangles are from those of straight ones; then the "
        "whole "
        "distance alone is meant, and infinite on surfaces without fourth derivatives.");
    m.def("curved_pieces", &curved, nb::arg("surface"), nb::arg("corners"), nb::arg("uv"),
          nb::arg("triangles"), nb::arg("twins"), nb::arg("middles") = nb::none(),
          "(m, 3, 2) how far the middles of sides 0, 1, 2 are moved in (u, v), for pieces that are "
          "hardly shifted within their triangles; 0 on surfaces without fourth derivatives.\n\n"
          "triangles: (m, 3) vertices; twins: (3 m,), -1 at rims; middles: (m, 3, 3) of the sides "
          "in space, where they are not straight.");
    m.def("straightened", &straightened, nb::arg("bends"), nb::arg("corners"), nb::arg("uv"),
          nb::arg("triangles"), nb::arg("twins"), nb::arg("is_bad"),
          "The same with straight sides of the triangles that have ``is_bad`` (m,).");
}

}  // namespace

void bind_proof(nb::module_& m) {
    m.doc() = "Proved bounds of the distance between triangles and surfaces.";
    bind_single_triangles(m);
    m.def(
        "prove_isotopy", &isotopy, nb::arg("points"), nb::arg("triangles"), nb::arg("away"),
        nb::arg("slope"),
        "Can the mesh be deformed into its surface? (0, -1, -1): it can; (1, v, -1): not known, as "
        "pieces may change too fast at vertex v; (2, s, t): triangles s and t may meet.\n\n"
        "away: (m,) how far points of each triangle move at most; slope: (m,) how fast that "
        "changes.");
    m.def("bent_stars", &bent, nb::arg("points"), nb::arg("triangles"), nb::arg("slope"),
          "(k,) vertices at which pieces may change too fast for their stars.");
    m.def("side_rates", &rates_of_sides, nb::arg("surface"), nb::arg("ends"), nb::arg("uv"),
          "(k, 2) how fast the curve over a straight side of (u, v) leaves the side at most, along "
          "and across it; infinite without bounds.\n\nends: (k, 2, 3), uv: (k, 2, 2).");
    m.def("polar_moves", &moves_at_pole, nb::arg("surface"), nb::arg("corners"), nb::arg("base"),
          nb::arg("is_v"), nb::arg("value"),
          "(m, 2) how fast and how far points of triangles at a pole move to the surface at most, "
          "along rays; None on surfaces without fourth derivatives.\n\ncorners (m, 3, 3): pole "
          "first; base (m, 3, 2): Bezier points of the curve in (u, v) over the side from the "
          "second corner to the third; is_v: the pole is where v, or u, has ``value``.");
    m.def("curve_bounds", &bounds_of_curve, nb::arg("curve"), nb::arg("t"), nb::arg("ends"),
          "(k,) how far pieces of a curve, from t[:, 0] to t[:, 1], and the segments between "
          "``ends`` (k, 2, 3) are from each other at most; infinite where the curve has no "
          "bounds.");
    m.def("parted_half_edges", &parted, nb::arg("uv"), nb::arg("twins"),
          "(k,) half-edges with a twin after them whose ends have other parameters in the twin's "
          "triangle, as at seams.\n\nuv: (m, 3, 2); twins: (3 m,), -1 at rims.");
    m.def(
        "ring_bounds", &around, nb::arg("corners"), nb::arg("triangles"), nb::arg("twins"),
        nb::arg("bounds"), nb::arg("limits"),
        "(m,) how far triangles and surface are from each other at most, both ways, each with "
        "its neighbours; (m,) whether it took them.\n\ntriangles: (m, 3) vertices; twins: (3 m,) "
        "the opposite half-edge of each, -1 at rims; bounds: of ``triangle_bounds``; limits: (m,) "
        "within which little less is not looked for.");
    m.def("look_closer", &closer, nb::arg("surface"), nb::arg("corners"), nb::arg("uv"),
          nb::arg("bends"), nb::arg("triangles"), nb::arg("twins"), nb::arg("bounds"),
          nb::arg("which"), nb::arg("limits"), nb::arg("levels"), nb::arg("bound"), nb::arg("gaps"),
          nb::arg("gap_owners"), nb::arg("gap_bounds"),
          "The bounds ``bound`` (m,) of ``ring_bounds``, lower for those ``which`` (k,) of which "
          "a closer look at up to 4^levels cells each shows that.\n\ngaps: (g, 3, 2) triangles of "
          "the (u, v) plane that have none in space, at poles; gap_owners: (g,) the triangle that "
          "each lies beside, ascending; gap_bounds: their bounds along the axes of these.");
}

}  // namespace surfmesh::binding
