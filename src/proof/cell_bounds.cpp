#include "proof/cell_bounds.hpp"

#include "proof/triangle_grid.hpp"

namespace surfmesh {
namespace {

constexpr double CELL_ROUNDING = 0x1p-44;  // relative, more than that of any sum here

/// The largest of -1/2 sum l_i l_j x_ij over the triangle; x: its least values by side.
double rise(const BySide& least) {
    return 0.5 * largest_on_simplex(-least[0], -least[1], -least[2]);
}

/// One cell after the other.
class Cells {
  public:
    Cells(std::size_t n, const FourthParts& rho, const TriangleFrame& frame, std::size_t finer,
          bool with_slope)
        : scale_(1.0 / static_cast<double>(n)),
          rho_(rho),
          frame_(frame),
          finer_(finer),
          with_slope_(with_slope) {}

    /// direction: -1 where its sides run against those of the triangle.
    void take(const CellCorners& corner, double direction) {
        SideBends bends;
        FourthParts more = rho_;
        for (BySide& along : more)
            for (double& part : along) part *= scale_ * scale_;
        for (const PlaceJet* there : corner) join(bends, there->bends, more);
        if (finer_ > 0) {
            const double part = scale_ * scale_ / static_cast<double>(finer_ * finer_);
            const double between = size_from(bends, frame_).whole * part;
            whole_ = std::max(whole_, farthest(corner) + between);
        } else {
            whole_ = intervals::INFINITE;
        }
        for (std::size_t k = 0; k < 3 && with_slope_; ++k)
            slope_[k] = std::max(slope_[k], steepest(corner, k, direction));
        take_larger(bends_, bends);
    }
    [[nodiscard]] BoundsOfCells found() const {
        if (!with_slope_) return {bends_, whole_, intervals::INFINITE};
        BySide part{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(frame_.lengths[k] > 0.0)) return {bends_, whole_, intervals::INFINITE};
            part[k] = slope_[k] / frame_.lengths[k];
        }
        return {bends_, whole_, slope_of(part, frame_)};
    }

  private:
    [[nodiscard]] double farthest(const CellCorners& corner) const;
    [[nodiscard]] double steepest(const CellCorners& corner, std::size_t k, double direction) const;

    double scale_;
    const FourthParts& rho_;
    const TriangleFrame& frame_;
    std::size_t finer_;
    bool with_slope_;
    SideBends bends_;
    double whole_ = 0.0;
    BySide slope_{};
};

/// |R - L| at places of the cell.
double Cells::farthest(const CellCorners& corner) const {
    const double square = scale_ * scale_;
    double most = 0.0;
    for_grid(finer_, [&](const Barycentric& l) {
        double squares = 0.0;
        for (std::size_t d = 0; d < 3; ++d) {
            double away = 0.0, bent = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                // g_k at (x + u_i + u_j) / 3, i and j the ends of side k
                const std::size_t i = k, j = (k + 1) % 3, m = (k + 2) % 3;
                const double g = (l[i] + 1.0) * corner[i]->bends.value[d][k] +
                                 (l[j] + 1.0) * corner[j]->bends.value[d][k] +
                                 l[m] * corner[m]->bends.value[d][k];
                bent += l[i] * l[j] * g;
                away += l[k] * corner[k]->away[d];
            }
            away -= bent * square / 6.0;
            squares += away * away;
        }
        most = std::max(most, squares);
    });
    double off = 0.0, size = 0.0, away = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
        double part = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            double error = 0.0;
            for (const PlaceJet* there : corner) {
                error = std::max(error, there->bends.error[k]);
                size = std::max(size, std::abs(there->bends.value[d][k]));
            }
            part = std::max(part, square * rho_[d][k] + error);
        }
        off += part * part;
    }
    for (const PlaceJet* there : corner) {
        away = std::max(away, there->away_error);
        for (const double x : there->away) size = std::max(size, std::abs(x));
    }
    return (std::sqrt(most) + std::sqrt(off) * square / 6.0) * (1.0 + 4.0 * frame_.tilt) + away +
           CELL_ROUNDING * size;
}

/// The largest |D|, D = R'(e_k) - L'(e_k): within half of sum l_i l_j R'''(e_k, e_ij, e_ij) / n^2 of
/// linear between the corners, which is the mean of that along side k, n times the difference of
/// R''(e_ij, e_ij) at its ends, but for 15/2 rho / n.
double Cells::steepest(const CellCorners& corner, std::size_t k, double direction) const {
    constexpr double FARTHER = 7.5;  // parts of rho
    const PlaceBends &from = corner[k]->bends, &to = corner[(k + 1) % 3]->bends;
    const double cube = scale_ * scale_ * scale_;
    double squares = 0.0, error = 0.0;
    for (const PlaceJet* there : corner) error = std::max(error, there->slope_error[k]);
    for (std::size_t d = 0; d < 3; ++d) {
        BySide least{}, lowest{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double mean = direction * scale_ * (to.value[d][i] - from.value[d][i]);
            const double off = scale_ * (to.error[i] + from.error[i]) + FARTHER * cube * rho_[d][i];
            least[i] = mean - off;
            lowest[i] = -mean - off;
        }
        double up = -intervals::INFINITE, down = up;
        for (const PlaceJet* there : corner) {
            up = std::max(up, there->slope[d][k]);
            down = std::max(down, -there->slope[d][k]);
        }
        const double most = std::max(up + rise(least), down + rise(lowest));
        squares += most * most;
    }
    return (std::sqrt(squares) * (1.0 + 4.0 * frame_.tilt) + 2.0 * error) * (1.0 + CELL_ROUNDING);
}

}  // namespace

SideBends averaged_bends(const CellCorners& corner, const FourthParts& rho) {
    SideBends found;
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = corner[k]->bends.value[d][k],
                         b = corner[(k + 1) % 3]->bends.value[d][k],
                         c = corner[(k + 2) % 3]->bends.value[d][k];
            constexpr double THIRD = 1.0 / 3.0;
            const BySide values = {THIRD * (2.0 * a + b), THIRD * (a + 2.0 * b),
                                   THIRD * (a + b + c)};
            const double error = std::max(
                {corner[0]->bends.error[k], corner[1]->bends.error[k], corner[2]->bends.error[k]});
            const double more = rho[d][k] + error;
            const double up = std::max({values[0], values[1], values[2]}) + more;
            const double down = more - std::min({values[0], values[1], values[2]});
            found.by_axis[d][k] = std::max(up, down);
            if (d == 2) {
                found.up[k] = up;
                found.down[k] = down;
            }
        }
    return found;
}

BoundsOfCells bounds_of_cells(std::span<const PlaceJet> places, std::size_t n,
                              const FourthParts& rho, const TriangleFrame& frame, std::size_t finer,
                              bool with_slope) {
    Cells cells(n, rho, frame, finer, with_slope);
    const auto row = [n](std::size_t i) { return i * (n + 1) - i * (i - 1) / 2; };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; i + j < n; ++j) {
            const PlaceJet &a = places[row(i) + j], &b = places[row(i + 1) + j],
                           &c = places[row(i) + j + 1];
            cells.take({&a, &b, &c}, 1.0);
            if (i + j + 1 == n) continue;
            const PlaceJet& across = places[row(i + 1) + j + 1];
            cells.take({&across, &c, &b}, -1.0);
        }
    return cells.found();
}

}  // namespace surfmesh
