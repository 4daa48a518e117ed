#include "intersection/strip_integrals.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1024;  // places that the surface is asked for at a time

/// A piece of a strip: from first, signed width; the integrals of f and |f|.
struct StripPiece {
    std::size_t strip;
    double first, width;
    double sum = 0.0, size = 0.0;
};

class StripPieces {
  public:
    StripPieces(SurfaceReader& surface, std::span<const Point2> ends, const StripRule& rule,
                const std::optional<Point3>& origin)
        : surface_(surface), ends_(ends), rule_(rule), origin_(origin) {}

    void integrate(Array<StripPiece>& pieces) {
        const std::size_t each = rule_.places.size(), most = std::max<std::size_t>(BLOCK / each, 1);
        for (std::size_t start = 0; start < pieces.size() && !surface_.failed(); start += most) {
            const std::size_t count = std::min(most, pieces.size() - start);
            uv_.clear();
            for (std::size_t k = start; k < start + count; ++k) {
                const StripPiece& piece = pieces[static_cast<std::ptrdiff_t>(k)];
                for (const double place : rule_.places)
                    uv_.push_back({piece.first + piece.width * place, ends_[piece.strip].y});
            }
            surface_.read(uv_, 1);
            for (std::size_t k = 0; k < count; ++k)
                sum_up(pieces[static_cast<std::ptrdiff_t>(start + k)], k * each);
        }
    }

  private:
    void sum_up(StripPiece& piece, std::size_t row) const {
        for (std::size_t k = 0; k < rule_.places.size(); ++k) {
            const Point3 normal = cross(surface_[1][row + k], surface_[2][row + k]);
            const double density =
                origin_ ? dot(surface_[0][row + k] - *origin_, normal) / 3.0 : norm(normal);
            piece.sum += piece.width * rule_.weights[k] * density;
            piece.size += std::abs(piece.width) * rule_.weights[k] * std::abs(density);
        }
    }

    SurfaceReader& surface_;
    std::span<const Point2> ends_;
    const StripRule& rule_;
    const std::optional<Point3>& origin_;
    Array<Point2> uv_;
};

/// Strips cut at the knots.
Array<StripPiece> cut_strips(double fixed, std::span<const Point2> ends,
                             std::span<const double> knots) {
    Array<StripPiece> pieces;
    for (std::size_t strip = 0; strip < ends.size(); ++strip) {
        const double end = ends[strip].x, low = std::min(fixed, end), high = std::max(fixed, end);
        double first = low;
        const auto add = [&](double stop) {
            const double width = stop - first;
            if (end < fixed)
                pieces.push_back({strip, stop, -width});
            else
                pieces.push_back({strip, first, width});
            first = stop;
        };
        for (const double knot : knots)
            if (low < knot && knot < high) add(knot);
        add(high);
    }
    return pieces;
}

}  // namespace

Array<double> strip_integrals(SurfaceReader& surface, double fixed, std::span<const Point2> ends,
                              std::span<const double> knots, const StripRule& rule,
                              const std::optional<Point3>& origin) {
    StripPieces strips(surface, ends, rule, origin);
    Array<StripPiece> pieces = cut_strips(fixed, ends, knots);
    strips.integrate(pieces);
    Array<double> found(ends.size(), 0.0), size(ends.size(), 0.0);
    for (const StripPiece& piece : pieces)
        size[static_cast<std::ptrdiff_t>(piece.strip)] += piece.size;
    for (int round = 0; round < rule.halvings && !pieces.empty(); ++round) {
        Array<StripPiece> halves, differ;
        for (const auto& [strip, first, width, sum, own] : pieces) {
            halves.push_back({strip, first, 0.5 * width});
            halves.push_back({strip, first + 0.5 * width, 0.5 * width});
        }
        strips.integrate(halves);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const auto row = static_cast<std::ptrdiff_t>(k), one = 2 * row, other = one + 1;
            const auto strip = static_cast<std::ptrdiff_t>(pieces[row].strip);
            const double both = halves[one].sum + halves[other].sum;
            if (!(std::abs(both - pieces[row].sum) <= rule.agree * size[strip])) {
                differ.push_back(halves[one]);
                differ.push_back(halves[other]);
            } else {
                found[strip] += both;
            }
        }
        pieces = std::move(differ);
    }
    for (const StripPiece& piece : pieces)
        found[static_cast<std::ptrdiff_t>(piece.strip)] += piece.sum;
    return found;
}

}  // namespace surfmesh
