#include "surfaces/sharp_bends.hpp"

#include <array>
#include <cmath>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {
namespace {

// Samples are taken so far inside a triangle, as a fraction of the way to the centroid: at a pole
// there is no normal, and at a crease one for each side.
constexpr double INSIDE = 1e-3;
constexpr int SIDES = 4, HALVES = 14;
constexpr std::size_t SAMPLES = (SIDES + 1) * (SIDES + 2) / 2;
constexpr double SHARP_TURN =
    20.0 * (3.141592653589793 / 180.0);  // what turns less triangles follow

struct Sample {
    Point2 uv;
    Point3 point, normal;
    bool sharp;
};

double angle_between(Point3 n, Point3 m) {
    return elementary::acos(std::min(std::max(dot(n, m), -1.0), 1.0));
}

/// Fill in what the surface is at the samples.
void look(SurfaceReader& surface, std::span<Sample> samples, double radius) {
    Array<Point2> uv;
    for (const Sample& s : samples) uv.push_back(s.uv);
    surface.read(uv, 2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const FundamentalForms forms = fundamental_forms(
            surface[1][i], surface[2][i], {surface[3][i], surface[4][i], surface[5][i]});
        const PrincipalCurvatures k = principal_curvatures(forms);
        samples[i].point = surface[0][i];
        samples[i].normal = forms.normal;
        samples[i].sharp =
            forms.degenerate || std::max(std::abs(k.k1), std::abs(k.k2)) * radius > 1.0;
    }
}

/// Barycentric weights of the samples in a triangle, and which of them are neighbours.
struct SampleGrid {
    std::array<std::array<double, 3>, SAMPLES> weights;
    std::array<std::array<std::size_t, 2>, 3 * SIDES*(SIDES + 1) / 2> neighbours;

    SampleGrid() {
        std::size_t number[SIDES + 1][SIDES + 1], k = 0, pair = 0;
        for (int i = 0; i <= SIDES; ++i)
            for (int j = 0; j <= SIDES - i; ++j) {
                const double grid[] = {double(i) / SIDES, double(j) / SIDES,
                                       double(SIDES - i - j) / SIDES};
                for (std::size_t c = 0; c < 3; ++c)
                    weights[k][c] = grid[c] + INSIDE * (1.0 / 3.0 - grid[c]);
                number[i][j] = k++;
            }
        constexpr int STEPS[3][2] = {{1, 0}, {0, 1}, {1, -1}};
        for (int i = 0; i <= SIDES; ++i)
            for (int j = 0; j <= SIDES - i; ++j)
                for (const auto [di, dj] : STEPS)
                    if (j + dj >= 0 && i + di + j + dj <= SIDES)
                        neighbours[pair++] = {number[i][j], number[i + di][j + dj]};
    }
};

/// A turn between two samples of a triangle.
struct Turn {
    std::size_t triangle;
    Sample p, q;
};

/// Is a turn made between two points on a circle of less than ``radius``?
bool is_made_within(double radius, const Turn& between, double turn) {
    return turn > SHARP_TURN && norm(between.q.point - between.p.point) < radius * turn;
}

/// The neighbouring samples whose normals differ most, and whether any sample is sharp.
Turn largest_turn(std::span<const Sample> samples, const SampleGrid& grid, std::size_t triangle) {
    double largest = -1.0;
    std::array<std::size_t, 2> worst = grid.neighbours[0];
    for (const auto& pair : grid.neighbours) {
        const double turn = angle_between(samples[pair[0]].normal, samples[pair[1]].normal);
        if (!(turn > largest)) continue;
        largest = turn;
        worst = pair;
    }
    return {triangle, samples[worst[0]], samples[worst[1]]};
}

/// Halve the turns once; those that are decided, or spread out, are dropped.
void halve(SurfaceReader& surface, Array<Turn>& turns, double radius, Array<std::uint8_t>& found) {
    Array<Sample> middles;
    std::size_t kept = 0;
    for (const Turn& t : turns)
        if (!found[t.triangle] && angle_between(t.p.normal, t.q.normal) > SHARP_TURN)
            turns[kept++] = t;
    turns.resize(kept);
    for (const Turn& t : turns) middles.push_back({0.5 * (t.p.uv + t.q.uv), {}, {}, false});
    look(surface, middles, radius);
    for (std::size_t i = 0; i < turns.size(); ++i) {
        Turn& t = turns[i];
        const double first = angle_between(t.p.normal, middles[i].normal);
        const double second = angle_between(middles[i].normal, t.q.normal);
        (first >= second ? t.q : t.p) = middles[i];
        found[t.triangle] = middles[i].sharp || is_made_within(radius, t, std::max(first, second));
    }
}

}  // namespace

Array<std::uint8_t> bends_sharply(SurfaceReader& surface,
                                  std::span<const ParameterTriangle> triangles, double radius) {
    static const SampleGrid GRID;
    Array<std::uint8_t> found(triangles.size(), 0);
    Array<Sample> samples;
    for (const ParameterTriangle& t : triangles)
        for (const auto& w : GRID.weights)
            samples.push_back({w[0] * t[0] + w[1] * t[1] + w[2] * t[2], {}, {}, false});
    look(surface, samples, radius);
    Array<Turn> turns;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const std::span<const Sample> own{samples.data() + k * SAMPLES, SAMPLES};
        const Turn turn = largest_turn(own, GRID, k);
        found[k] = std::any_of(own.begin(), own.end(), [](const Sample& s) { return s.sharp; }) ||
                   is_made_within(radius, turn, angle_between(turn.p.normal, turn.q.normal));
        turns.push_back(turn);
    }
    for (int n = 0; n < HALVES && !turns.empty(); ++n) halve(surface, turns, radius, found);
    return found;
}

}  // namespace surfmesh
