#include "edges/edges_beside.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

/// How far the edges are apart by their boxes.
double way_between(const Box3& a, const Box3& b) {
    const auto apart = [](double low_a, double high_a, double low_b, double high_b) {
        return std::max(std::max(low_a - high_b, low_b - high_a), 0.0);
    };
    return norm(Point3{apart(a.low.x, a.high.x, b.low.x, b.high.x),
                       apart(a.low.y, a.high.y, b.low.y, b.high.y),
                       apart(a.low.z, a.high.z, b.low.z, b.high.z)});
}

/// The end of an edge at which its use begins or ends, and the sample beside it.
struct SidedEnd {
    std::int64_t at, beside;
};

SidedEnd end_of(const SampledEdges& sampled, std::int64_t edge, bool is_last) {
    const std::int64_t first = sampled.first[edge], last = sampled.first[edge + 1] - 1;
    return is_last ? SidedEnd{last, last - 1} : SidedEnd{first, first + 1};
}

void add_both_ways(std::int64_t face, std::int64_t a, std::int64_t b, Array<EdgesBeside>& found) {
    found.push_back({face, a, b});
    found.push_back({face, b, a});
}

void add_meeting(const SampledEdges& sampled, const FollowingCoedges& f,
                 std::span<const double> width, double acute, Array<EdgesBeside>& found) {
    for (std::size_t k = 0; k < f.one.size(); ++k) {
        const std::int64_t one = f.one[k], other = f.other[k], face = f.face[one];
        if (!(width[face] > 0.0)) continue;
        const SidedEnd end = end_of(sampled, f.edge[one], f.is_reversed[one] == 0);
        const SidedEnd start = end_of(sampled, f.edge[other], f.is_reversed[other] != 0);
        const Point3 into = sampled.points[end.beside] - sampled.points[end.at];
        const Point3 out = sampled.points[start.beside] - sampled.points[start.at];
        if (dot(into, out) > acute * (norm(into) * norm(out)))
            add_both_ways(face, f.edge[one], f.edge[other], found);
    }
}

/// The edges of some faces that are looked at with one width.
class NearEdgesOfFaces {
  public:
    NearEdgesOfFaces(const SampledEdges& sampled, const Array<double>& sag, double width,
                     const Array<std::int64_t>& faces)
        : all_(sampled), sag_(sag), width_(width), faces_(faces), first_(1, 0) {
        for (const std::int64_t face : faces) {
            for (const std::int64_t edge : edges_of(face)) edges_.push_back(edge);
            first_.push_back(static_cast<std::int64_t>(edges_.size()));
        }
    }

    void add(Array<EdgesBeside>& found) const {
        const EdgeGaps gaps = gaps_within_reach();
        const auto is_near = near_edges(gaps);
        Array<std::int64_t> near;
        for (const std::int64_t face : faces_) {
            near.clear();
            for (const std::int64_t edge : edges_of(face))
                if (is_near[edge] != 0) near.push_back(edge);
            for (const std::int64_t a : near)
                for (const std::int64_t b : near)
                    if (!have_common_vertex(all_.ends[a], all_.ends[b]) &&
                        way_between(gaps.boxes[a], gaps.boxes[b]) <= width_ + sag_[a] + sag_[b])
                        found.push_back({face, a, b});
        }
    }

  private:
    [[nodiscard]] std::span<const std::int64_t> edges_of(std::int64_t face) const {
        const auto first = static_cast<std::size_t>(all_.first_of_face[face]);
        return all_.edges.subspan(first,
                                  static_cast<std::size_t>(all_.first_of_face[face + 1]) - first);
    }

    [[nodiscard]] EdgeGaps gaps_within_reach() const {
        const double largest = sag_.empty() ? 0.0 : *std::max_element(sag_.begin(), sag_.end());
        Array<double> reach = Array<double>::unfilled(all_.points.size());
        for (std::size_t e = 0; e + 1 < all_.first.size(); ++e)
            std::fill(reach.data() + all_.first[e], reach.data() + all_.first[e + 1],
                      width_ + sag_.data()[e] + largest);
        return edge_gaps({all_.points,
                          {reach.data(), reach.size()},
                          all_.first,
                          all_.ends,
                          {edges_.data(), edges_.size()},
                          {first_.data(), first_.size()}});
    }

    [[nodiscard]] Array<std::uint8_t> near_edges(const EdgeGaps& gaps) const {
        Array<std::uint8_t> near(all_.first.size() - 1, 0);
        for (std::size_t e = 0; e < near.size(); ++e)
            near.data()[e] =
                std::any_of(gaps.gap.data() + all_.first[e], gaps.gap.data() + all_.first[e + 1],
                            [](double gap) { return std::isfinite(gap); });
        return near;
    }

    const SampledEdges& all_;
    const Array<double>& sag_;
    double width_;
    const Array<std::int64_t>& faces_;
    Array<std::int64_t> edges_, first_;  // of the faces, in one row
};

}  // namespace

Array<EdgesBeside> edges_beside(const SampledEdges& sampled, const FollowingCoedges& following,
                                std::span<const double> width, double acute) {
    Array<EdgesBeside> found;
    add_meeting(sampled, following, width, acute, found);
    const Array<double> sag = sags(sampled.points, sampled.first);
    Array<std::uint8_t> is_left(width.size());
    for (std::size_t face = 0; face < width.size(); ++face)
        is_left.data()[face] =
            width[face] > 0.0 && sampled.first_of_face[face + 1] - sampled.first_of_face[face] > 1;
    for (std::size_t first = 0; first < width.size(); ++first) {
        if (is_left.data()[first] == 0) continue;
        Array<std::int64_t> faces;
        for (std::size_t face = first; face < width.size(); ++face) {
            if (is_left.data()[face] == 0 || width[face] != width[first]) continue;
            is_left.data()[face] = 0;
            faces.push_back(static_cast<std::int64_t>(face));
        }
        NearEdgesOfFaces(sampled, sag, width[first], faces).add(found);
    }
    return found;
}

}  // namespace surfmesh
