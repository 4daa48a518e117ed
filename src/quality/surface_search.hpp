// How far points of the surfaces lie from a mesh: the other half of the Hausdorff distance.
//
//             x                 x: a point of the surface over a triangle. Its distance from that
//       o----/|\----o           triangle bounds the one from the mesh; where it might be the
//        \  / | \  /            largest, or is beyond the chord, the nearest triangle is searched
//         \/  |  \/             for: from neighbour to nearer neighbour, and of the farthest few
//          o-----o              among all triangles.
//
// In: a mesh on its surfaces, how far its triangles are from these, and the chord of each face. Out:
// a distance for each triangle, and the farthest point of all. Nothing of the mesh changes; it, and
// all that is handed over as a span, outlives the search.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "quality/measured_mesh.hpp"
#include "quality/segment_samples.hpp"
#include "quality/triangle_stars.hpp"
#include "space/measure.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct FarthestPoint {
    double distance;
    Point3 point;  // of the surface
    Point2 uv;
    std::int32_t triangle;  // that it is over
    bool at_rim;
};

/// The segments of CAD edges, each beside one or two triangles.
struct SidedSegments {
    EdgeSegments segments;
    std::span<const EdgeSides> sides;  // of each segment; NIL where no side of a triangle is one
};

/// Of the mesh from its surfaces, the other way.
struct KnownDeviation {
    std::span<const double> of_each;  // of the triangles
    double largest;
};

class SurfaceSearch {
  public:
    /// Does a place of (u, v) over a triangle lie beyond an edge of its face?
    using IsOffFace = std::function<bool(Point2 uv, std::int32_t triangle)>;

    /// chord: of each face, or one of all.
    SurfaceSearch(const MeasuredMesh& mesh, const KnownDeviation& deviation,
                  std::span<const double> chord, IsOffFace is_off_face);

    /// Look at barycentric places over the triangles of which ``left_out`` is 0.
    void look_over(std::span<const std::uint8_t> left_out, std::span<const Weights> places);
    /// Look along the edges of one triangle only, at fractions of their length.
    void look_along_rims(std::span<const EdgeSides> edges, std::span<const double> fractions);
    /// Look at the curves of edges between the ends of their segments, first in the middle: of an
    /// arc of an ellipse that settles the other ``fractions`` where it is as far from the triangle
    /// as they may be from the segment, ``beside_middle`` of its height. Segments whose nodes are
    /// farther from the curve than ``on_curve`` of their length say nothing. Returns how many
    /// segments have been looked at everywhere.
    std::size_t look_along_curves(const SidedSegments& all, std::span<const double> fractions,
                                  double beside_middle, double on_curve);
    /// Look closely over the ``count`` triangles that are farthest, one way or the other, but those
    /// of which ``left_out`` is not 0.
    void look_closely(std::span<const std::uint8_t> left_out, std::span<const Weights> places,
                      std::size_t count);

    /// The farthest point. One that is farther than all of the mesh is from the surface is compared
    /// with all triangles first: another part may be nearer.
    [[nodiscard]] FarthestPoint farthest();
    /// Over each triangle the largest distance that was seen, an upper bound: exact where it is
    /// beyond the chord; 0 where the triangle itself is too far from the surface.
    [[nodiscard]] Array<double> largest_over_each() const;

    /// The number of a surface that failed, or NIL: then nothing that was found counts.
    [[nodiscard]] std::int32_t failed() const { return failed_; }

  private:
    struct Places {
        Array<Point3> points;
        Array<Point2> uv;
    };
    /// Points over triangles, and their distances from these, which are lowered where another one
    /// is nearer. Places are made where they are asked for.
    struct Samples {
        std::span<const std::int32_t> triangles;
        std::size_t each;             // points over each triangle, one after the other
        std::span<double> distances;  // of all points
        std::function<Places(std::span<const std::int32_t> rows)> places;

        [[nodiscard]] std::int32_t triangle(std::size_t row) const { return triangles[row / each]; }
    };

    [[nodiscard]] double chord_of(std::int32_t triangle) const;
    [[nodiscard]] bool is_far(std::int32_t triangle) const;
    [[nodiscard]] double enough(std::int32_t triangle) const;

    [[nodiscard]] Places places_at(std::span<const std::int32_t> triangle,
                                   std::span<const std::int32_t> rule,
                                   std::span<const Weights> weights);
    void look_over_each(std::span<const std::int32_t> triangles, std::span<const Weights> places,
                        std::size_t together);
    void look_at_weights(std::span<const std::int32_t> triangle, std::span<const std::int32_t> rule,
                         std::span<const Weights> weights, bool at_rim);
    Array<double> look_at_points(std::span<const Point3> points,
                                 std::span<const std::int32_t> triangle, bool at_rim);
    [[nodiscard]] std::int32_t farther_side(EdgeSides sides) const;
    Array<std::int32_t> look_at_middles(const SidedSegments& all, double beside_middle,
                                        double on_curve);
    void look_between(const SidedSegments& all, std::span<const std::int32_t> segments,
                      std::span<const double> fractions, double on_curve);

    void take(const Samples& samples, bool at_rim);
    Array<std::int32_t> refine(const Samples& samples);
    void find_nearest(const Samples& samples, std::span<const std::int32_t> rows);
    void compare_beyond(const Samples& samples, std::span<const std::int32_t> rows,
                        const Places& places);
    void keep_farthest(const Samples& samples, Array<std::int32_t> refined, bool at_rim);

    MeasuredMesh mesh_;
    KnownDeviation deviation_;
    std::span<const double> chord_;
    IsOffFace is_off_face_;
    TriangleStars stars_;
    Array<double> by_triangle_;
    double largest_ = 0.0;  // of the points whose nearest triangle was searched for
    Array<FarthestPoint> found_;
    std::int32_t failed_ = NIL;
};

}  // namespace surfmesh
