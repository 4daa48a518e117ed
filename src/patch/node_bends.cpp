#include "patch/node_bends.hpp"

#include <cmath>

#include "sizing/curvature_sizes.hpp"
#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t NODES_TOGETHER = 1 << 10;  // read at once

// Of the square of the size that the chord allows: from the second on it is the chord that decides,
// below the first it is not. Between nodes fields are not exact.
constexpr double DECIDED[] = {0.85, 0.95};

/// Where the nodes lie in the plane.
class NodePlaces {
  public:
    explicit NodePlaces(const Background& b) : b_(b), places_(b.metric_root.size(), Point2{}) {}

    Array<Point2> find() && {
        const double wide = 1.0 / b_.box.across, high = 1.0 / b_.box.up;
        for (std::int32_t j = 0; j < b_.grid.ny; ++j)
            for (std::int32_t i = 0; i < b_.grid.nx; ++i)
                descend(j * b_.grid.nx + i, {b_.box.x0 + i * wide, b_.box.y0 + j * high},
                        {wide, high});
        return std::move(places_);
    }

  private:
    void descend(Cell cell, Point2 low, Point2 step) {
        const Cell first = b_.child[cell];
        const Point2 half = first < 0 ? step : 0.5 * step;
        for (std::int32_t k = 0; k < 4; ++k) {
            const Point2 corner = low + Point2{(k % 2) * half.x, (k / 2) * half.y};
            if (first < 0)
                places_[b_.corner[cell].node[k]] = corner;
            else
                descend(first + k, corner, half);
        }
    }

    const Background& b_;
    Array<Point2> places_;
};

/// Does the chord decide a size h? 1 where it does, 0 where it does not.
double decided_by_chord(PrincipalCurvatures k, double h, const AskedAccuracy& asked,
                        bool on_lattice) {
    const double chord = *asked.chord;
    double allowed = on_lattice ? lattice_chord_size(k, chord) : chord_size(k, chord);
    if (asked.is_width) allowed *= std::sqrt(share_of_width(k));
    const double part = (h * h) / (allowed * allowed);
    return std::clamp((part - DECIDED[0]) / (DECIDED[1] - DECIDED[0]), 0.0, 1.0);
}

}  // namespace

Array<NodeBend> node_bends(SurfaceReader& surface, const Chart& chart, const Background& background,
                           const AskedAccuracy& asked, bool on_lattice) {
    const Array<Point2> places = NodePlaces(background).find();
    Array<NodeBend> found(places.size(), NodeBend{{0.0, 0.0, 0.0}, 0.0});
    const double over = 1.0 / (8.0 * *asked.chord);
    surface.for_each_block(
        places.size(), NODES_TOGETHER,
        [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
            Array<Point2> uv, rates;
            for (std::size_t n = first; n < last; ++n) {
                const ChartPoint at = chart.at(places[n]);
                uv.push_back(at.uv);
                rates.push_back(at.rates);
            }
            reader.read({uv.data(), uv.size()}, 2);
            for (std::size_t i = 0; i < uv.size(); ++i) {
                const FundamentalForms forms = fundamental_forms(
                    reader[1][i], reader[2][i], {reader[3][i], reader[4][i], reader[5][i]});
                if (forms.degenerate) continue;
                const Point2 r = rates[i];
                const double h = 1.0 / background.metric_root[first + i].inverse_size;
                found[first + i] = {
                    {over * forms.L * r.x * r.x, over * forms.M * r.x * r.y,
                     over * forms.N * r.y * r.y},
                    decided_by_chord(principal_curvatures(forms), h, asked, on_lattice)};
            }
        });
    return found;
}

}  // namespace surfmesh
