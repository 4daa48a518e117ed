#include "quality/surface_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "quality/largest_values.hpp"
#include "quality/sampled_surface.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t AT_ONCE = 1U << 15U;    // points looked at together
constexpr std::size_t FIRST_FEW = 64;         // whose nearest triangle is searched for at first
constexpr std::size_t MORE_EACH_TIME = 4;     // times as many as before
constexpr std::size_t MOST_COMPARED = 2'000;  // beyond the chord, compared with every triangle
constexpr std::size_t AMONG_ALL = 16;         // compared with every triangle in the end, at most
constexpr double ANY_DISTANCE = std::numeric_limits<double>::infinity();

template <class T>
std::span<const T> all_of(const Array<T>& values) {
    return {values.data(), values.size()};
}

/// Rows of samples by their distances, the largest first; of equal ones the lowest.
auto farthest_first(std::span<const double> distances) {
    return [distances](std::int32_t a, std::int32_t b) {
        return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    };
}

/// Keep the first ``count`` of some rows in an order.
template <class Order>
void keep_first(Array<std::int32_t>& rows, std::size_t count, const Order& order) {
    if (rows.size() <= count) return;
    std::nth_element(rows.begin(), rows.begin() + count, rows.end(), order);
    rows.resize(count);
}

Array<std::int32_t> merged(const Array<std::int32_t>& a, const Array<std::int32_t>& b) {
    Array<std::int32_t> both(a.size() + b.size());
    std::int32_t* const end = std::set_union(a.begin(), a.end(), b.begin(), b.end(), both.begin());
    both.resize(static_cast<std::size_t>(end - both.begin()));
    return both;
}

/// Call work(some members) block after block.
template <class Work>
void in_blocks(std::span<const std::int32_t> members, std::size_t length, const Work& work) {
    for (std::size_t k = 0; k < members.size(); k += length)
        work(members.subspan(k, std::min(length, members.size() - k)));
}

/// Members of 0, 1, ..., count - 1 that a test admits.
template <class Test>
Array<std::int32_t> rows_where(std::size_t count, const Test& test) {
    Array<std::int32_t> rows;
    for (std::size_t k = 0; k < count; ++k)
        if (test(k)) rows.push_back(static_cast<std::int32_t>(k));
    return rows;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const MeasuredMesh& mesh, const KnownDeviation& deviation,
                             std::span<const double> chord, IsOffFace is_off_face)
    : mesh_(mesh),
      deviation_(deviation),
      chord_(chord),
      is_off_face_(std::move(is_off_face)),
      stars_(mesh.points, mesh.triangles),
      by_triangle_(mesh.triangles.size(), 0.0) {}

double SurfaceSearch::chord_of(std::int32_t triangle) const {
    if (chord_.size() == 1) return chord_[0];
    const auto last = static_cast<std::int32_t>(chord_.size()) - 1;
    return chord_[std::clamp(mesh_.faces[triangle], 0, last)];
}

/// Is a triangle itself too far from its surface? Then what lies over it needs no second proof.
bool SurfaceSearch::is_far(std::int32_t triangle) const {
    return deviation_.of_each[triangle] > chord_of(triangle);
}

/// The distance up to which it does not matter which triangle is the nearest.
double SurfaceSearch::enough(std::int32_t triangle) const {
    return is_far(triangle) ? ANY_DISTANCE : chord_of(triangle);
}

void SurfaceSearch::look_over(std::span<const std::uint8_t> left_out,
                              std::span<const Weights> places) {
    const Array<std::int32_t> triangles =
        rows_where(mesh_.triangles.size(), [&](std::size_t t) { return left_out[t] == 0; });
    look_over_each(all_of(triangles), places, AT_ONCE / places.size());
}

/// Look at places over some triangles, so many of these together.
void SurfaceSearch::look_over_each(std::span<const std::int32_t> triangles,
                                   std::span<const Weights> places, std::size_t together) {
    if (failed_ != NIL) return;
    const std::size_t each = places.size();
    SurfaceDistances found = surface_distances(mesh_, triangles, places);
    failed_ = found.failed;
    double* distances = found.distance.data();
    in_blocks(triangles, together, [&](std::span<const std::int32_t> some) {
        if (failed_ != NIL) return;
        const auto places_of = [&](std::span<const std::int32_t> rows) {
            Array<std::int32_t> triangle, rule;
            for (const std::int32_t row : rows) {
                triangle.push_back(some[row / each]);
                rule.push_back(static_cast<std::int32_t>(row % each));
            }
            return places_at(all_of(triangle), all_of(rule), places);
        };
        take({some, each, {distances, each * some.size()}, places_of}, false);
        distances += each * some.size();
    });
}

void SurfaceSearch::look_along_rims(std::span<const EdgeSides> edges,
                                    std::span<const double> fractions) {
    Array<std::int32_t> triangle, rule;
    Array<Weights> weights;
    for (const EdgeSides& edge : edges) {
        if (edge.twin != NIL) continue;
        const std::int32_t side = edge.half_edge % 3;
        for (const double t : fractions) {
            std::array<double, 3> w{};
            w[side] = 1.0 - t;
            w[(side + 1) % 3] = t;
            triangle.push_back(edge.half_edge / 3);
            rule.push_back(static_cast<std::int32_t>(weights.size()));
            weights.push_back({w[0], w[1], w[2]});
        }
    }
    look_at_weights(all_of(triangle), all_of(rule), all_of(weights), true);
}

void SurfaceSearch::look_closely(std::span<const std::uint8_t> left_out,
                                 std::span<const Weights> places, std::size_t count) {
    Array<double> worth = by_triangle_;
    for (std::size_t t = 0; t < worth.size(); ++t)
        worth[t] = std::max(worth[t], deviation_.of_each[t]);
    Array<std::int32_t> farthest;
    for (const std::int32_t t : largest_values(all_of(worth), count))
        if (left_out[t] == 0) farthest.push_back(t);
    look_over_each(all_of(farthest), places, farthest.size());
}

/// Points over triangles at weights[rule] of each, looked at together.
void SurfaceSearch::look_at_weights(std::span<const std::int32_t> triangle,
                                    std::span<const std::int32_t> rule,
                                    std::span<const Weights> weights, bool at_rim) {
    if (triangle.empty() || failed_ != NIL) return;
    SampledSurface found = sampled_surface(mesh_, triangle, rule, weights);
    failed_ = found.failed;
    if (failed_ != NIL) return;
    const auto places_of = [&](std::span<const std::int32_t> rows) {
        Places places;
        for (const std::int32_t row : rows) {
            places.points.push_back(found.points[row]);
            places.uv.push_back(found.uv[row]);
        }
        return places;
    };
    take({triangle, 1, {found.distance.data(), found.distance.size()}, places_of}, at_rim);
}

SurfaceSearch::Places SurfaceSearch::places_at(std::span<const std::int32_t> triangle,
                                               std::span<const std::int32_t> rule,
                                               std::span<const Weights> weights) {
    SampledSurface found = sampled_surface(mesh_, triangle, rule, weights);
    if (found.failed != NIL) {
        failed_ = found.failed;
        return {Array<Point3>(triangle.size()), Array<Point2>(triangle.size())};
    }
    return {std::move(found.points), std::move(found.uv)};
}

/// The triangle beside an edge that counts: of two faces the one that is farther from the mesh,
/// the round one.
std::int32_t SurfaceSearch::farther_side(EdgeSides sides) const {
    const std::int32_t first = sides.half_edge / 3;
    if (sides.twin == NIL) return first;
    const std::int32_t second = sides.twin / 3;
    return deviation_.of_each[second] > deviation_.of_each[first] ? second : first;
}

std::size_t SurfaceSearch::look_along_curves(const SidedSegments& all,
                                             std::span<const double> fractions,
                                             double beside_middle, double on_curve) {
    Array<std::int32_t> open = look_at_middles(all, beside_middle, on_curve);
    std::sort(open.begin(), open.end());
    look_between(all, all_of(open), fractions, on_curve);
    return open.size();
}

/// Returns the segments of which that does not say all.
Array<std::int32_t> SurfaceSearch::look_at_middles(const SidedSegments& all, double beside_middle,
                                                   double on_curve) {
    constexpr double MIDDLE = 0.5;
    const EdgeSegments& given = all.segments;
    const Array<std::int32_t> some =
        rows_where(all.sides.size(), [&](std::size_t k) { return all.sides[k].half_edge != NIL; });
    const SegmentSamples seen = samples_of_some(given, all_of(some), {&MIDDLE, 1}, on_curve);
    Array<std::int32_t> open;
    for (const bool at_rim : {true, false}) {
        const Array<std::int32_t> rows = rows_where(seen.segments.size(), [&](std::size_t row) {
            return (all.sides[seen.segments[row]].twin == NIL) == at_rim;
        });
        in_blocks(all_of(rows), AT_ONCE, [&](std::span<const std::int32_t> block) {
            Array<Point3> points;
            Array<std::int32_t> triangle;
            for (const std::int32_t row : block) {
                points.push_back(seen.points[row]);
                triangle.push_back(farther_side(all.sides[seen.segments[row]]));
            }
            const Array<double> stands = look_at_points(all_of(points), all_of(triangle), at_rim);
            for (std::size_t k = 0; k < block.size(); ++k) {
                const std::int32_t segment = seen.segments[block[k]];
                const auto [a, b] = given.nodes[segment];
                const double off = seen.off_arc[block[k]];
                const double height = norm(points[k] - 0.5 * (given.points[a] + given.points[b]));
                const double beside = beside_middle * (height + off) + off;
                if (!(stands[k] >= beside)) open.push_back(segment);
            }
        });
    }
    return open;
}

/// At all fractions of some segments, in their order.
void SurfaceSearch::look_between(const SidedSegments& all, std::span<const std::int32_t> segments,
                                 std::span<const double> fractions, double on_curve) {
    const std::size_t each = fractions.size();
    const SegmentSamples seen = samples_of_some(all.segments, segments, fractions, on_curve);
    for (const bool at_rim : {true, false}) {
        const Array<std::int32_t> rows = rows_where(seen.segments.size(), [&](std::size_t row) {
            return (all.sides[seen.segments[row]].twin == NIL) == at_rim;
        });
        in_blocks(all_of(rows), AT_ONCE / each, [&](std::span<const std::int32_t> block) {
            Array<Point3> points;
            Array<std::int32_t> triangle;
            for (const std::int32_t row : block)
                for (std::size_t j = 0; j < each; ++j) {
                    points.push_back(seen.points[each * row + j]);
                    triangle.push_back(farther_side(all.sides[seen.segments[row]]));
                }
            look_at_points(all_of(points), all_of(triangle), at_rim);
        });
    }
}

/// Look at points of the surface over triangles. Returns the distances from these that stand: -1
/// where one may be the largest, or beyond the chord, or is lowered.
Array<double> SurfaceSearch::look_at_points(std::span<const Point3> points,
                                            std::span<const std::int32_t> triangle, bool at_rim) {
    Array<double> distances(points.size());
    if (points.empty() || failed_ != NIL) return distances;
    for (std::size_t i = 0; i < points.size(); ++i)
        distances[i] = stars_.from(points[i], triangle[i]);
    Array<double> own = distances;
    const auto places_of = [&](std::span<const std::int32_t> rows) {
        Places places;
        for (const std::int32_t row : rows) {
            const TriangleCorners& q = mesh_.uv_triangles[triangle[row]];
            const Point2 sum = mesh_.uv[q.a] + mesh_.uv[q.b] + mesh_.uv[q.c];
            places.points.push_back(points[row]);
            places.uv.push_back({sum.x / 3.0, sum.y / 3.0});  // about there
        }
        return places;
    };
    take({triangle, 1, {distances.data(), distances.size()}, places_of}, at_rim);
    for (std::size_t i = 0; i < own.size(); ++i) {
        const bool stands =
            own[i] == distances[i] && own[i] <= largest_ && own[i] <= enough(triangle[i]);
        if (!stands) own[i] = -1.0;
    }
    return own;
}

/// What samples say of the triangles that they are over.
void SurfaceSearch::take(const Samples& samples, bool at_rim) {
    for (double& distance : samples.distances)
        if (!std::isfinite(distance)) distance = 0.0;  // where a formula has no value
    Array<std::int32_t> refined = refine(samples);
    const double* distance = samples.distances.data();
    for (const std::int32_t triangle : samples.triangles)
        for (std::size_t j = 0; j < samples.each; ++j, ++distance)
            by_triangle_[triangle] = std::max(by_triangle_[triangle], *distance);
    keep_farthest(samples, std::move(refined), at_rim);
}

/// Lower the distances, of the own triangles, to those of the nearest ones: where they are beyond
/// the chord, and where one of them may be the largest. Returns which, in their order.
Array<std::int32_t> SurfaceSearch::refine(const Samples& samples) {
    const std::span<double> distances = samples.distances;
    Array<std::int32_t> beyond, left, done;
    std::int32_t row = 0;
    for (const std::int32_t triangle : samples.triangles) {
        const double limit = enough(triangle);
        for (std::size_t j = 0; j < samples.each; ++j, ++row) {
            if (distances[row] > limit) beyond.push_back(row);
            if (distances[row] > largest_) left.push_back(row);
        }
    }
    for (std::size_t length = FIRST_FEW; failed_ == NIL; length *= MORE_EACH_TIME) {
        Array<std::int32_t> some = left;
        keep_first(some, length, farthest_first(distances));
        std::sort(some.begin(), some.end());
        if (!beyond.empty()) some = merged(some, beyond);  // all of them at once
        beyond.clear();
        if (some.empty()) break;
        find_nearest(samples, all_of(some));
        for (const std::int32_t row : some) largest_ = std::max(largest_, distances[row]);
        done = merged(done, some);
        const auto is_settled = [&](std::int32_t row) {
            return !(distances[row] > largest_) ||
                   std::binary_search(some.begin(), some.end(), row);
        };
        left.resize(static_cast<std::size_t>(std::remove_if(left.begin(), left.end(), is_settled) -
                                             left.begin()));
    }
    return done;
}

/// Lower the distances of some samples to those of nearer triangles, from neighbour to neighbour
/// while there are such.
void SurfaceSearch::find_nearest(const Samples& samples, std::span<const std::int32_t> rows) {
    const Places places = samples.places(rows);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        double& distance = samples.distances[rows[k]];
        distance = stars_.walk(places.points[k], samples.triangle(rows[k]), distance);
    }
    compare_beyond(samples, rows, places);
}

/// Lower what is still beyond the chord: the way from neighbour to neighbour ends early where
/// triangles are long and thin. Given up where nothing is lowered: the mesh is too far, then.
void SurfaceSearch::compare_beyond(const Samples& samples, std::span<const std::int32_t> rows,
                                   const Places& places) {
    const auto distance_of = [&](std::int32_t k) -> double& { return samples.distances[rows[k]]; };
    Array<std::int32_t> beyond = rows_where(rows.size(), [&](std::size_t k) {
        return distance_of(static_cast<std::int32_t>(k)) > enough(samples.triangle(rows[k]));
    });
    std::sort(beyond.begin(), beyond.end(), [&](std::int32_t a, std::int32_t b) {
        return distance_of(a) != distance_of(b) ? distance_of(a) > distance_of(b) : a < b;
    });
    std::size_t compared = 0, lowered = 0;
    for (const std::int32_t k : beyond) {
        if (compared >= MOST_COMPARED || (compared >= AMONG_ALL && lowered == 0)) return;
        ++compared;
        const std::int32_t triangle = samples.triangle(rows[k]);
        double exact = stars_.from_all(places.points[k], distance_of(k));
        if (exact > enough(triangle) && is_off_face_(places.uv[k], triangle)) exact = 0.0;
        if (exact < distance_of(k)) ++lowered;
        distance_of(k) = exact;
    }
}

/// refined: the samples whose nearest triangle is known.
void SurfaceSearch::keep_farthest(const Samples& samples, Array<std::int32_t> refined,
                                  bool at_rim) {
    const auto order = farthest_first(samples.distances);
    keep_first(refined, AMONG_ALL, order);
    std::sort(refined.begin(), refined.end(), order);
    if (refined.empty() || failed_ != NIL) return;
    const Places places = samples.places(all_of(refined));
    for (std::size_t k = 0; k < refined.size(); ++k)
        found_.push_back({samples.distances[refined[k]], places.points[k], places.uv[k],
                          samples.triangle(refined[k]), at_rim});
}

FarthestPoint SurfaceSearch::farthest() {
    std::stable_sort(
        found_.begin(), found_.end(),
        [](const FarthestPoint& a, const FarthestPoint& b) { return a.distance > b.distance; });
    std::optional<FarthestPoint> best;
    for (std::size_t k = 0; k < found_.size(); ++k) {
        const FarthestPoint& found = found_[k];
        if (best && (found.distance <= best->distance || k >= AMONG_ALL)) break;
        double exact = found.distance;
        if (exact > deviation_.largest) exact = stars_.from_all(found.point, exact);
        double& over = by_triangle_[found.triangle];
        if (exact < found.distance && found.distance == over) over = exact;
        if (!best || exact > best->distance) {
            best = found;
            best->distance = exact;
        }
    }
    if (best) return *best;
    // all that was looked at lies on the mesh to the last bit
    return {0.0, mesh_.points[mesh_.triangles[0].a], mesh_.uv[mesh_.uv_triangles[0].a], 0, false};
}

Array<double> SurfaceSearch::largest_over_each() const {
    Array<double> found = by_triangle_;
    for (std::size_t t = 0; t < found.size(); ++t)
        if (is_far(static_cast<std::int32_t>(t))) found[t] = 0.0;
    return found;
}

}  // namespace surfmesh
