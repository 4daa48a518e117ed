#include "sizing/principal_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {
namespace {

constexpr int GRID = 9;             // places along u and along v
constexpr double SIDE_STEP = 1e-4;  // of the domain, of differences
constexpr std::size_t PLACES = GRID * GRID;

// Radians: over half the diagonal of the surface. It costs 1 % of the chord on cylinders.
constexpr double LARGEST_TURN = 0.07;

// The same of stretched triangles on saddles: corners that move make up for more.
constexpr double LARGEST_TURN_STRETCHED = 0.6;

// Ratios of curvatures that differ by less are one; below the second the best direction depends on
// them, and from the third on there is none to speak of.
constexpr double ALIKE = 0.05, TURNING = -0.6, BOWL = 0.3;

// Each place, and what lies beside it both ways along both axes.
constexpr std::array<Point2, 5> BESIDE = {
    {{0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};

/// A number of a place and of the four beside it.
template <class T>
using Around = std::array<T, BESIDE.size()>;

/// A value of each row at a place and beside it.
template <typename ValueOf>
auto around(std::size_t place, const ValueOf& value_of) {
    Around<std::decay_t<decltype(value_of(place))>> found;
    for (std::size_t beside = 0; beside < found.size(); ++beside)
        found[beside] = value_of(place * BESIDE.size() + beside);
    return found;
}

/// Derivatives of a field in fractions of the domain, along a step.
double change(const Around<double>& field, Point2 step) {
    const double by_u = (field[1] - field[2]) / (2.0 * SIDE_STEP);
    const double by_v = (field[3] - field[4]) / (2.0 * SIDE_STEP);
    return by_u * step.x + by_v * step.y;
}

Point2 change(const Around<Point2>& field, Point2 step) {
    Around<double> x, y;
    for (std::size_t k = 0; k < field.size(); ++k) x[k] = field[k].x, y[k] = field[k].y;
    return {change(x, step), change(y, step)};
}

double area(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

/// Where curvatures are looked at, place by place with what lies beside it.
Array<Point2> places_over(const ParameterBox& box) {
    const Point2 wide = box.high - box.low;
    Array<Point2> uv;
    for (int row = 0; row < GRID; ++row)
        for (int column = 0; column < GRID; ++column)
            for (const Point2 beside : BESIDE)
                uv.push_back({box.low.x + ((column + 0.5) / GRID + SIDE_STEP * beside.x) * wide.x,
                              box.low.y + ((row + 0.5) / GRID + SIDE_STEP * beside.y) * wide.y});
    return uv;
}

/// Principal curvatures and directions at places; none where one of them is degenerate or flat.
Array<PrincipalDirections> directions_at(SurfaceReader& surface, std::span<const Point2> uv) {
    surface.read(uv, 2);
    Array<PrincipalDirections> found;
    for (std::size_t k = 0; k < uv.size(); ++k) {
        const FundamentalForms forms = fundamental_forms(
            surface[1][k], surface[2][k], {surface[3][k], surface[4][k], surface[5][k]});
        const PrincipalDirections own = principal_directions(forms);
        const double larger = std::max(std::abs(own.k.k1), std::abs(own.k.k2));
        if (forms.degenerate || !(larger > 0.0) || !std::isfinite(larger)) return {};
        found.push_back(own);
    }
    return found;
}

/// Has a lattice a best direction, and the same one everywhere?
bool have_one_direction(const Array<PrincipalDirections>& at) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& [k, d1, d2] : at) {
        const double larger = std::max(std::abs(k.k1), std::abs(k.k2));
        const double ratio = k.k1 * k.k2 / (larger * larger);
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    return most <= BOWL && (most - least <= ALIKE || least >= TURNING);
}

/// Steps of one size along a direction, in fractions of the domain, one way as at the first place.
Around<Point2> steps_along(const Around<Point2>& direction, const Around<double>& size,
                           Point2 wide) {
    Around<Point2> steps;
    Point2 first{};
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const Point2 d{direction[k].x / wide.x, direction[k].y / wide.y};
        if (k == 0) first = d;
        steps[k] = (dot(d, first) < 0.0 ? -size[k] : size[k]) * d;
    }
    return steps;
}

/// The angle that a lattice turns by at a place, and the growth of sizes there, on a unit of length.
struct LatticeRates {
    double turn, growth;
};

LatticeRates rates_at(const Around<double>& size, const Around<Point2>& along_first,
                      const Around<Point2>& along_second) {
    const Point2 first = along_first[0], second = along_second[0];
    const Point2 bracket = change(along_second, first) - change(along_first, second);
    const double whole = area(first, second);
    const double a = area(bracket, second) / whole, b = area(first, bracket) / whole;
    const Point2 grown{change(size, first) / size[0], change(size, second) / size[0]};
    return {norm(Point2{a, b}) / size[0], norm(grown)};
}

/// The same of two sizes, the larger of their growths.
LatticeRates stretched_rates_at(const Around<double>& h1, const Around<double>& h2,
                                const Around<Point2>& along_first,
                                const Around<Point2>& along_second) {
    const Point2 first = along_first[0], second = along_second[0];
    const Point2 bracket = change(along_second, first) - change(along_first, second);
    const double whole = area(first, second);
    const double a = area(bracket, second) / whole, b = area(first, bracket) / whole;
    const auto growth = [&](const Around<double>& h) {
        return norm(Point2{change(h, first) / h1[0], change(h, second) / h2[0]});
    };
    return {norm(Point2{a / h1[0], b / h2[0]}), std::max(growth(h1), growth(h2))};
}

/// Are curvatures opposite, and sizes not bound by their ratio?
bool are_saddles(const Array<PrincipalDirections>& at, double anisotropy) {
    const double least = 1.0 / (anisotropy * anisotropy);
    return std::all_of(at.begin(), at.end(), [&](const PrincipalDirections& own) {
        const double ratio = -own.k.k1 / own.k.k2;
        return ratio > least && ratio * least < 1.0;
    });
}

/// The same of two sizes along the principal directions, on saddles alone.
bool keeps_stretched_lattice(SurfaceReader& surface, Point2 extent, const SizeRules& rules,
                             double slope) {
    const ParameterBox box = surface.domain();
    const Array<Point2> uv = places_over(box);
    const Array<PrincipalDirections> at = directions_at(surface, {uv.data(), uv.size()});
    if (surface.failed() || at.size() < uv.size() || !are_saddles(at, rules.anisotropy))
        return false;
    Array<PrincipalCurvatures> k;
    for (const PrincipalDirections& own : at) k.push_back(own.k);
    Array<PrincipalSizes> size(at.size());
    if (!rules.principal({k.data(), k.size()}, {&rules.anisotropy, 1}, {size.data(), size.size()}))
        return false;
    double largest = 0.0;
    for (const auto& [first, second] : size) largest = std::max(largest, std::max(first, second));
    if (largest >= rules.largest || std::min(extent.x, extent.y) < LEAST_ROWS_STRETCHED * largest)
        return false;
    const double farthest = 0.5 * norm(extent);
    const Point2 wide = box.high - box.low;
    for (std::size_t place = 0; place < PLACES; ++place) {
        const auto d1 = around(place, [&](std::size_t row) { return at[row].d1; });
        const auto d2 = around(place, [&](std::size_t row) { return at[row].d2; });
        const auto h1 = around(place, [&](std::size_t row) { return size[row].first; });
        const auto h2 = around(place, [&](std::size_t row) { return size[row].second; });
        const auto [turn, growth] =
            stretched_rates_at(h1, h2, steps_along(d1, h1, wide), steps_along(d2, h2, wide));
        if (!(growth <= slope && turn * farthest <= LARGEST_TURN_STRETCHED)) return false;
    }
    return true;
}

}  // namespace

bool keeps_lattice(SurfaceReader& surface, Point2 extent, const SizeRules& rules, double slope) {
    if (rules.by_curvature.empty()) return false;
    if (rules.is_anisotropic()) return keeps_stretched_lattice(surface, extent, rules, slope);
    const ParameterBox box = surface.domain();
    const Array<Point2> uv = places_over(box);
    const Array<PrincipalDirections> at = directions_at(surface, uv);
    if (surface.failed() || at.size() < uv.size() || !have_one_direction(at)) return false;
    Array<PrincipalCurvatures> k;
    for (const PrincipalDirections& own : at) k.push_back(own.k);
    Array<double> size(at.size());
    if (!rules.from_curvature(k, size)) return false;
    const double largest = *std::max_element(size.begin(), size.end());
    if (largest >= rules.largest || std::min(extent.x, extent.y) < LEAST_ROWS * largest)
        return false;
    const double farthest = 0.5 * norm(extent);
    const Point2 wide = box.high - box.low;
    for (std::size_t place = 0; place < PLACES; ++place) {
        const auto d1 = around(place, [&](std::size_t row) { return at[row].d1; });
        const auto d2 = around(place, [&](std::size_t row) { return at[row].d2; });
        const auto own = around(place, [&](std::size_t row) { return size[row]; });
        const auto [turn, growth] =
            rates_at(own, steps_along(d1, own, wide), steps_along(d2, own, wide));
        if (!(growth <= slope && turn * farthest <= LARGEST_TURN)) return false;
    }
    return true;
}

}  // namespace surfmesh
