#include "surfaces/spline_creases.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr std::array<double, 3> NO_JUMPS_KNOWN = {intervals::INFINITE, intervals::INFINITE,
                                                  intervals::INFINITE};

double size_of_terms(const Homogeneous& c) {
    return std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]);
}

double along_terms(const Point3& d, const Homogeneous& c) {
    return d.x * c[0] + d.y * c[1] + d.z * c[2];
}

/// Along the crease: the jump of the derivative of (A, w), and (A, w) itself.
struct CreaseLine {
    Array<Homogeneous> jump, value;
    double jump_error, jump_size = 0.0, value_size = 0.0, least_weight = intervals::INFINITE;

    CreaseLine(const CreaseSide& before, const CreaseSide& after, const CreaseShape& shape)
        : jump(shape.count), value(shape.count) {
        const auto p = static_cast<double>(shape.degree);
        const double rate_before = p / before.width, rate_after = p / after.width;
        for (std::size_t j = 0; j < shape.count; ++j) {
            const auto at = [&](const CreaseSide& side, std::size_t i) {
                return side.coefficients[i * shape.stride + j * shape.stride_along];
            };
            const auto last = at(before, shape.degree), previous = at(before, shape.degree - 1);
            const auto first = at(after, 0), next = at(after, 1);
            for (std::size_t c = 0; c < 4; ++c)
                jump[j][c] =
                    rate_after * (next[c] - first[c]) - rate_before * (last[c] - previous[c]);
            value[j] = first;
            jump_size = std::max(jump_size, size_of_terms(jump[j]));
            value_size = std::max({value_size, size_of_terms(first), size_of_terms(next),
                                   size_of_terms(last), size_of_terms(previous)});
            least_weight = std::min(least_weight, first[3] - shape.error);
        }
        // of four coordinates, each a difference of rounded differences
        jump_error = 4.0 * (rate_before + rate_after) *
                     (2.0 * shape.error + 8.0 * outward::ULP * value_size);
    }
};

/// The largest Bernstein coefficient of (d . dA) w - dw (d . A).
double largest_of_product(const CreaseLine& line, const Point3& d) {
    const std::size_t q = line.value.size() - 1;
    const auto binomials = [](std::size_t n) {
        Array<double> row(n + 1, 1.0);
        for (std::size_t k = 1; k <= n; ++k)
            row[k] = row[k - 1] * static_cast<double>(n + 1 - k) / static_cast<double>(k);
        return row;
    };
    const Array<double> own = binomials(q), both = binomials(2 * q);
    double most = 0.0;
    for (std::size_t k = 0; k <= 2 * q; ++k) {
        double sum = 0.0;
        for (std::size_t i = k > q ? k - q : 0; i <= std::min(k, q); ++i) {
            const Homogeneous &dA = line.jump[i], &A = line.value[k - i];
            const double term = along_terms(d, dA) * A[3] - dA[3] * along_terms(d, A);
            sum += own[i] * own[k - i] / both[k] * term;
        }
        most = std::max(most, std::abs(sum));
    }
    return most;
}

}  // namespace

std::array<double, 3> crease_jumps(const CreaseSide& before, const CreaseSide& after,
                                   const CreaseShape& shape, const Directions& directions) {
    if (!(before.width > 0.0) || !(after.width > 0.0) || shape.degree == 0) return NO_JUMPS_KNOWN;
    const CreaseLine line(before, after, shape);
    const double weight = shape.rational ? line.least_weight : 1.0;
    if (!(weight > 0.0)) return NO_JUMPS_KNOWN;
    const auto rounds = static_cast<double>(8 * shape.count + 64);
    std::array<double, 3> found{};
    for (std::size_t d = 0; d < 3; ++d) {
        double most = 0.0, off = 0.0;
        if (shape.rational) {
            most = largest_of_product(line, directions[d]);
            off = 2.0 * (line.jump_error * (line.value_size + 4.0 * shape.error) +
                         line.jump_size * 4.0 * shape.error) +
                  rounds * outward::ULP * line.jump_size * line.value_size;
        } else {
            for (const Homogeneous& jump : line.jump)
                most = std::max(most, std::abs(along_terms(directions[d], jump)));
            off = 2.0 * line.jump_error + rounds * outward::ULP * line.jump_size;
        }
        const double jump = (most + off) / (weight * weight) * (1.0 + rounds * outward::ULP);
        found[d] = jump <= intervals::INFINITE ? jump : intervals::INFINITE;
    }
    return found;
}

}  // namespace surfmesh
