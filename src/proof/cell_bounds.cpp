#include "proof/cell_bounds.hpp"

#include "proof/triangle_grid.hpp"

namespace surfmesh {
namespace {

constexpr double CELL_ROUNDING = 0x1p-44;  // relative, more than that of any sum here

/// The largest of -1/2 sum l_i l_j x_ij over the triangle; x: its least values by side.
double rise(const BySide& least) {
    return 0.5 * largest_on_simplex(-least[0], -least[1], -least[2]);
}

double largest_error(const CellCorners& corner) {
    return std::max({corner[0]->bends.error, corner[1]->bends.error, corner[2]->bends.error});
}

/// What R - L is made of at a place of a cell: values at its corners, g_k there by side and corner, and
/// R''''(e_k, e_k, e_m, e_m) by sides k and m,
///
///     l_k,    l_i l_j (l_c + [c is i or j]),    (s_k mean_k(s_m) + s_m mean_m(s_k)) / 2
///
/// with i and j the ends of side k, s_k = l_i l_j, and the mean of smooth_bounds.hpp; half of that
/// where k = m.
constexpr double bend_weight(const Barycentric& l, std::size_t k, std::size_t c) {
    const std::size_t i = k, j = (k + 1) % 3;
    return l[i] * l[j] * (l[c] + (c == i || c == j ? 1.0 : 0.0));
}

/// Of s_m at x + s ((1 - t) u_i + t u_j - x), with the weight s, for the ends of side k.
constexpr double mean_of_product(std::size_t k, std::size_t m, const Barycentric& l) {
    const std::size_t a = m, b = (m + 1) % 3;
    const auto half = [k](std::size_t c) { return c == k || c == (k + 1) % 3 ? 0.5 : 0.0; };
    const double same = k == m ? 1.0 / 24.0 : 0.0;
    return (l[a] * l[b] + l[a] * half(b) + l[b] * half(a)) / 12.0 + same;
}

constexpr double fourth_weight(const Barycentric& l, std::size_t k, std::size_t m) {
    const auto product = [&l](std::size_t side) { return l[side] * l[(side + 1) % 3]; };
    const double both =
        product(k) * mean_of_product(k, m, l) + product(m) * mean_of_product(m, k, l);
    return k == m ? 0.25 * both : 0.5 * both;
}

/// The places of a cell that is cut into FINER^2: its corners, where R - L is known; those on a side,
/// which all else but its own ends and side has no weight at; those within.
template <std::size_t FINER>
struct PlaceWeights {
    static constexpr std::size_t SIDE = FINER - 1, INNER = (FINER - 1) * (FINER - 2) / 2,
                                 COUNT = 3 + 3 * SIDE + INNER;
    using AtSide = std::array<double, SIDE>;
    using Within = std::array<double, INNER>;
    std::array<AtSide, 2> side_value{}, side_bend{};  // by end
    AtSide side_fourth{};
    std::array<Within, 3> value{};
    std::array<std::array<Within, 3>, 3> bend{};  // [side][corner]
    std::array<Within, SIDE_PAIRS> fourth{};

    constexpr PlaceWeights() {
        for (std::size_t place = 0; place < SIDE; ++place) {
            const Barycentric l = {part(FINER - 1 - place), part(place + 1), 0.0};
            for (std::size_t c = 0; c < 2; ++c) {
                side_value[c][place] = l[c];
                side_bend[c][place] = bend_weight(l, 0, c);
            }
            side_fourth[place] = fourth_weight(l, 0, 0);
        }
        std::size_t place = 0;
        for (std::size_t a = 1; a < FINER; ++a)
            for (std::size_t b = 1; a + b < FINER; ++b, ++place) {
                const Barycentric l = {part(FINER - a - b), part(a), part(b)};
                for (std::size_t k = 0; k < 3; ++k) {
                    value[k][place] = l[k];
                    for (std::size_t c = 0; c < 3; ++c) bend[k][c][place] = bend_weight(l, k, c);
                }
                for (std::size_t p = 0; p < SIDE_PAIRS; ++p)
                    fourth[p][place] = fourth_weight(l, PAIR_FIRST[p], PAIR_OTHER[p]);
            }
    }

  private:
    static constexpr double part(std::size_t n) {
        return static_cast<double>(n) / static_cast<double>(FINER);
    }
};

template <std::size_t COUNT>
double largest(const std::array<double, COUNT>& numbers) {
    double most = 0.0;
    for (const double x : numbers) most = std::max(most, x);
    return most;
}

template <std::size_t COUNT>
void add_scaled(std::array<double, COUNT>& sum, double factor,
                const std::array<double, COUNT>& weights) {
    for (std::size_t p = 0; p < COUNT; ++p) sum[p] += factor * weights[p];
}

/// |d . (R - L)| along axis d at most, at places of a cell; square: of its size over the triangle's;
/// error: of R''(e, e) at its corners, of which there is a sixth at most (sum l_i l_j g_ij / 2).
template <std::size_t FINER>
auto farthest_along(std::size_t d, const CellCorners& corner, const FourthParts& parts,
                    double square, double error) {
    using Places = PlaceWeights<FINER>;
    static constexpr Places WEIGHTS;
    std::array<double, Places::COUNT> found;
    auto* next = found.begin();
    const double off = square / 6.0 * error;
    const auto take = [&next, off](const auto& away, const auto& left) {
        for (std::size_t p = 0; p < away.size(); ++p) *next++ = std::abs(away[p]) + (left[p] + off);
    };
    const auto bend_at = [&](std::size_t k, std::size_t c) {
        return -square / 6.0 * corner[c]->bends.value[d][k];
    };
    const double fourth = square * square;
    // along the normal within rad of mid, else no larger than rho says
    const auto add_fourth = [&](std::size_t p, const auto& weights, auto& away, auto& left) {
        const BySide& rho = parts.rho[d];
        const double size = 6.0 * std::min(rho[PAIR_FIRST[p]], rho[PAIR_OTHER[p]]);
        if (d == 2) add_scaled(away, fourth * parts.mid[p], weights);
        add_scaled(left, fourth * (d == 2 ? parts.rad[p] : size), weights);
    };
    for (const PlaceJet* there : corner) *next++ = std::abs(there->away[d]) + off;
    for (std::size_t k = 0; k < 3; ++k) {
        typename Places::AtSide away{}, left{};
        for (std::size_t end = 0; end < 2; ++end) {
            const std::size_t c = (k + end) % 3;
            add_scaled(away, corner[c]->away[d], WEIGHTS.side_value[end]);
            add_scaled(away, bend_at(k, c), WEIGHTS.side_bend[end]);
        }
        add_fourth(PAIR_OF[k][k], WEIGHTS.side_fourth, away, left);
        take(away, left);
    }
    typename Places::Within away{}, left{};
    for (std::size_t c = 0; c < 3; ++c) {
        add_scaled(away, corner[c]->away[d], WEIGHTS.value[c]);
        for (std::size_t k = 0; k < 3; ++k) add_scaled(away, bend_at(k, c), WEIGHTS.bend[k][c]);
    }
    for (std::size_t p = 0; p < SIDE_PAIRS; ++p) add_fourth(p, WEIGHTS.fourth[p], away, left);
    take(away, left);
    return found;
}

/// The largest |n . (R - L)| and |R - L| at places of a cell.
template <std::size_t FINER>
PieceSize farthest_at_places(const CellCorners& corner, const FourthParts& parts, double square,
                             double error) {
    std::array<double, PlaceWeights<FINER>::COUNT> squares{}, heights{};  // of the last axis
    for (std::size_t d = 0; d < 3; ++d) {
        const auto away = farthest_along<FINER>(d, corner, parts, square, error);
        for (std::size_t p = 0; p < away.size(); ++p) heights[p] = away[p] * away[p];
        for (std::size_t p = 0; p < away.size(); ++p) squares[p] += heights[p];
    }
    return {std::sqrt(largest(heights)), std::sqrt(largest(squares))};
}

/// The largest number that what is computed of a cell is made of, and round-off at its corners.
struct CellSize {
    double size, error;
};

CellSize size_of_cell(const CellCorners& corner) {
    CellSize found{0.0, 0.0};
    for (const PlaceJet* there : corner) {
        found.error = std::max(found.error, there->away_error);
        for (std::size_t d = 0; d < 3; ++d) {
            found.size = std::max(found.size, std::abs(there->away[d]));
            for (const double x : there->bends.value[d])
                found.size = std::max(found.size, std::abs(x));
        }
    }
    return found;
}

/// Along a normal, and in all, of what is measured along axes that are tilted.
PieceSize on_safe_side(const PieceSize& size, double error, const TriangleFrame& frame) {
    const double whole = size.whole * (1.0 + 4.0 * frame.tilt + CELL_ROUNDING) + error;
    return {size.height + (frame.tilt + CELL_ROUNDING) * whole + error, whole};
}

constexpr std::size_t FEW_PLACES = 3, MANY_PLACES = 6;  // along a side

/// R - L at places of a cell, and what it rises by between them, by ``rises`` over their square.
template <std::size_t FINER>
PieceSize farthest(const CellCorners& corner, const FourthParts& parts, double square,
                   const TriangleFrame& frame, const PieceSize& rises) {
    constexpr double FINER_CELLS = FINER * FINER;
    const PieceSize there = farthest_at_places<FINER>(corner, parts, square, largest_error(corner));
    const auto [size, error] = size_of_cell(corner);
    const PieceSize most = on_safe_side(there, error + CELL_ROUNDING * size, frame);
    return {most.height + rises.height / FINER_CELLS, most.whole + rises.whole / FINER_CELLS};
}

/// One cell after the other.
class Cells {
  public:
    Cells(std::size_t n, const FourthParts& parts, const TriangleFrame& frame, CellPlaces within,
          bool with_slope)
        : scale_(1.0 / static_cast<double>(n)),
          parts_(parts),
          frame_(frame),
          within_(within),
          with_slope_(with_slope) {}

    /// R - L at a corner of cells, of which all are taken before these.
    void take_corner(const PlaceJet& there) { take_farther(away_of(there)); }
    /// direction: -1 where its sides run against those of the triangle.
    void take(const CellCorners& corner, double direction) {
        std::array<BySide, 3> more = parts_.rho;
        for (BySide& along : more)
            for (double& part : along) part *= scale_ * scale_;
        const SideBends bends = bends_of_cell(corner, more, with_slope_);
        if (within_ == CellPlaces::NONE)
            away_ = {intervals::INFINITE, intervals::INFINITE};
        else
            look_within(corner, size_from(bends, frame_));
        for (std::size_t k = 0; k < 3 && with_slope_; ++k)
            slope_[k] = std::max(slope_[k], steepest(corner, k, direction));
        take_larger(bends_, bends);
    }
    [[nodiscard]] BoundsOfCells found() const {
        BoundsOfCells all{bends_, away_, intervals::INFINITE};
        if (!with_slope_) return all;
        BySide part{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(frame_.lengths[k] > 0.0)) return all;
            part[k] = slope_[k] / frame_.lengths[k];
        }
        all.slope = slope_of(part, frame_);
        return all;
    }

  private:
    void take_farther(const PieceSize& there) {
        away_.height = std::max(away_.height, there.height);
        away_.whole = std::max(away_.whole, there.whole);
    }
    /// rises: from the plane through R - L at its corners, of cells as large as the triangle.
    void look_within(const CellCorners& corner, const PieceSize& rises) {
        PieceSize most{};
        for (const PlaceJet* there : corner) {
            const PieceSize away = away_of(*there);
            most = {std::max(most.height, away.height), std::max(most.whole, away.whole)};
        }
        const double square = scale_ * scale_;
        if (most.whole + square * rises.whole <= away_.whole &&
            most.height + square * rises.height <= away_.height)
            return;
        take_farther(farthest<FEW_PLACES>(corner, parts_, square, frame_,
                                          {square * rises.height, square * rises.whole}));
    }
    [[nodiscard]] PieceSize away_of(const PlaceJet& there) const {
        const auto& [x, y, z] = there.away;
        return on_safe_side({std::abs(z), std::sqrt(x * x + y * y + z * z)}, there.away_error,
                            frame_);
    }
    [[nodiscard]] double steepest(const CellCorners& corner, std::size_t k, double direction) const;

    double scale_;
    const FourthParts& parts_;
    const TriangleFrame& frame_;
    CellPlaces within_;
    bool with_slope_;
    SideBends bends_;
    PieceSize away_{0.0, 0.0};
    BySide slope_{};
};

/// The largest |D|, D = R'(e_k) - L'(e_k): within half of sum l_i l_j R'''(e_k, e_ij, e_ij) / n^2 of
/// linear between the corners, which is the mean of that along side k, n times the difference of
/// R''(e_ij, e_ij) at its ends, but for 15/2 rho / n.
double Cells::steepest(const CellCorners& corner, std::size_t k, double direction) const {
    constexpr double FARTHER = 7.5;  // parts of rho
    const PlaceBends &from = corner[k]->bends, &to = corner[(k + 1) % 3]->bends;
    const double cube = scale_ * scale_ * scale_;
    double squares = 0.0, error = 0.0;
    for (const PlaceJet* there : corner) error = std::max(error, there->slope_error);
    for (std::size_t d = 0; d < 3; ++d) {
        BySide least{}, lowest{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double mean = direction * scale_ * (to.value[d][i] - from.value[d][i]);
            const double off = scale_ * (to.error + from.error) + FARTHER * cube * parts_.rho[d][i];
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

/// How far something may go up and down.
struct BothWays {
    double up, down;
};

/// Of twice the integral of g_k, k = ij: by its Bernstein coefficients at i, j, c and for ij, jc, ci. With
/// A, B, C for g_k at i, j, c and M_m for R''''(e_k, e_k, e_m, e_m) these are, as mean_of_product is quadratic,
///
///     i, j    (2 A + B) / 3 - M_ij / 12     c     (A + B + C) / 3 - (M_ij + M_jc + M_ci) / 24
///     ij      (A + B) / 2 - M_ij / 8        jc    (2 A + 3 B + C) / 6 - (M_ij + M_jc) / 16 - M_ci / 48
BothWays averaged_along_normal(const CellCorners& corner, const FourthParts& parts, std::size_t k) {
    constexpr double SIXTH = 1.0 / 6.0;
    const std::size_t j = (k + 1) % 3, c = (k + 2) % 3;
    const double a = corner[k]->bends.value[2][k], b = corner[j]->bends.value[2][k],
                 third = corner[c]->bends.value[2][k];
    const std::size_t own = PAIR_OF[k][k], after = PAIR_OF[k][j], before = PAIR_OF[k][c];
    const double ij = parts.mid[own], jc = parts.mid[after], ci = parts.mid[before];
    const std::array<double, 6> values = {
        SIXTH * (4.0 * a + 2.0 * b - 0.5 * ij),
        SIXTH * (2.0 * a + 4.0 * b - 0.5 * ij),
        SIXTH * (2.0 * (a + b + third) - 0.25 * (ij + jc + ci)),
        SIXTH * (3.0 * (a + b) - 0.75 * ij),
        SIXTH * (2.0 * a + 3.0 * b + third - 0.375 * (ij + jc) - 0.125 * ci),
        SIXTH * (3.0 * a + 2.0 * b + third - 0.375 * (ij + ci) - 0.125 * jc)};
    const double off = std::max(0.125 * parts.rad[own],
                                0.0625 * (parts.rad[own] + parts.rad[after] + parts.rad[before]));
    double least = values[0], most = values[0];
    for (const double x : values) {
        least = std::min(least, x);
        most = std::max(most, x);
    }
    return {most + off, off - least};
}

}  // namespace

SideBends bends_of_cell(const CellCorners& corner, const std::array<BySide, 3>& more,
                        bool with_slope) {
    SideBends found;
    for (const PlaceJet* there : corner) join(found, there->bends, more, with_slope);
    return found;
}

SideBends averaged_bends(const CellCorners& corner, const FourthParts& parts) {
    const double error = largest_error(corner);
    SideBends found;
    for (std::size_t d = 0; d < 2; ++d)
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = corner[k]->bends.value[d][k],
                         b = corner[(k + 1) % 3]->bends.value[d][k],
                         c = corner[(k + 2) % 3]->bends.value[d][k];
            constexpr double THIRD = 1.0 / 3.0;
            const BySide values = {THIRD * (2.0 * a + b), THIRD * (a + 2.0 * b),
                                   THIRD * (a + b + c)};
            const double more = parts.rho[d][k] + error;
            const double up = std::max({values[0], values[1], values[2]}) + more;
            const double down = more - std::min({values[0], values[1], values[2]});
            found.by_axis[d][k] = std::max(up, down);
        }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [up, down] = averaged_along_normal(corner, parts, k);
        found.up[k] = up + error;
        found.down[k] = down + error;
        found.by_axis[2][k] = std::max(found.up[k], found.down[k]);
    }
    return found;
}

double height_at_places(const CellCorners& corner, const FourthParts& parts,
                        const TriangleFrame& frame, double rises, double whole) {
    const auto there = farthest_along<MANY_PLACES>(2, corner, parts, 1.0, largest_error(corner));
    const auto [size, error] = size_of_cell(corner);
    const double off = error + CELL_ROUNDING * size;
    return on_safe_side({largest(there), whole}, off, frame).height +
           rises / (MANY_PLACES * MANY_PLACES);
}

PieceSize size_at_places(const CellCorners& corner, const FourthParts& parts,
                         const TriangleFrame& frame, const PieceSize& rises) {
    return farthest<MANY_PLACES>(corner, parts, 1.0, frame, rises);
}

BoundsOfCells bounds_of_cells(std::span<const PlaceJet> places, std::size_t n,
                              const FourthParts& parts, const TriangleFrame& frame,
                              CellPlaces within, bool with_slope) {
    Cells cells(n, parts, frame, within, with_slope);
    if (within != CellPlaces::NONE)
        for (const PlaceJet& there : places) cells.take_corner(there);
    const auto row = [n](std::size_t i) { return i * (n + 1) - i * (i - 1) / 2; };
    // those in the middle first, beside which others often add nothing
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; i + j + 1 < n; ++j)
            cells.take(
                {&places[row(i + 1) + j + 1], &places[row(i) + j + 1], &places[row(i + 1) + j]},
                -1.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; i + j < n; ++j)
            cells.take({&places[row(i) + j], &places[row(i + 1) + j], &places[row(i) + j + 1]},
                       1.0);
    return cells.found();
}

}  // namespace surfmesh
