#include "proof/polar_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr std::array<std::size_t, 3> PARTS = {8, 32, 128};  // of a curve
constexpr double LOW_SLOPE = 0.4;                           // worth no more parts
constexpr double POLAR_OFF = 1e-6;  // more than lengths and directions of triangles of use are off
constexpr double FLAT_TRIANGLE = 1e-6;  // height over the base, of that
constexpr double PLACE_OFF = 0x1p-48;   // relative, rounding of Bezier points
constexpr Directions BY_COORDINATE = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
constexpr PolarMove NOTHING_KNOWN = {intervals::INFINITE, intervals::INFINITE};

using Vector = std::array<Interval, 3>;

Interval range_of(double a, double b, double c) {
    const double off = PLACE_OFF * std::max({std::abs(a), std::abs(b), std::abs(c)});
    return {std::min({a, b, c}) - off, std::max({a, b, c}) + off};
}

Vector times(Interval factor, const Vector& x) {
    return {outward::multiply(factor, x[0]), outward::multiply(factor, x[1]),
            outward::multiply(factor, x[2])};
}
Vector sum(const Vector& x, const Vector& y) {
    return {outward::add(x[0], y[0]), outward::add(x[1], y[1]), outward::add(x[2], y[2])};
}
Vector exactly(Point3 p) {
    return {outward::exactly(p.x), outward::exactly(p.y), outward::exactly(p.z)};
}
Vector less(const Vector& x, const Vector& y) { return sum(x, times({-1.0, -1.0}, y)); }

double largest(const Vector& x) {
    const double a = outward::magnitude(x[0]), b = outward::magnitude(x[1]),
                 c = outward::magnitude(x[2]);
    return std::sqrt(a * a + b * b + c * c);
}

/// One coordinate of a quadratic curve, from s0 to s1: values there, and derivatives.
struct Stretch {
    Interval value, derivative;
};

Stretch stretch(double a, double b, double c, double s0, double s1) {
    const auto blossom = [=](double s, double t) {
        const double first = (1.0 - s) * a + s * b, second = (1.0 - s) * b + s * c;
        return (1.0 - t) * first + t * second;
    };
    const auto slope = [=](double s) { return 2.0 * ((1.0 - s) * (b - a) + s * (c - b)); };
    const double off = 8.0 * PLACE_OFF * std::max({std::abs(a), std::abs(b), std::abs(c)});
    const double first = slope(s0), last = slope(s1);
    return {range_of(blossom(s0, s0), blossom(s0, s1), blossom(s1, s1)),
            {std::min(first, last) - off, std::max(first, last) + off}};
}

/// A part of the piece: s from one number to another, all t.
struct PolarPart {
    Stretch around, off;  // b; w
    Interval s, depth;    // depth: g
    ParameterBox box;
};

/// What is bounded over a part.
struct Derivatives {
    Vector r_w, r_bw;
};

/// The triangle's plane: along the base, and across it.
struct PolarFrame {
    Point3 pole, base, first;      // first: from the pole to the base's start
    double length, height, start;  // start: along the base, of ``first``
};

PolarFrame polar_frame_of(const SpaceCorners& p) {
    const Point3 base = p[2] - p[1], first = p[1] - p[0];
    const double length = norm(base);
    return {
        p[0], base, first, length, norm(cross(first, base)) / length, dot(first, base) / length};
}

class PolarPiece {
  public:
    PolarPiece(const Surface& surface, const FourthDerivatives& derivatives,
               const PolarPieces& pieces, std::size_t t)
        : surface_(surface),
          derivatives_(derivatives),
          pole_(pieces.pole),
          base_(pieces.base[t]),
          frame_(polar_frame_of(pieces.corners[t])) {}

    SurfaceStatus bound(PolarMove& move);

  private:
    [[nodiscard]] double around(Point2 p) const { return pole_.is_v ? p.x : p.y; }
    [[nodiscard]] double off(Point2 p) const { return pole_.is_v ? p.y : p.x; }
    [[nodiscard]] Point2 place(double b, double w) const {
        return pole_.is_v ? Point2{b, w} : Point2{w, b};
    }
    [[nodiscard]] bool runs_one_way() const;
    [[nodiscard]] PolarPart part_of(double s0, double s1) const;
    SurfaceStatus enclose(std::size_t parts);
    [[nodiscard]] PolarMove move_of(const PolarPart& part, const Derivatives& over) const;
    SurfaceStatus distance_at_pole(double& away) const;

    const Surface& surface_;
    const FourthDerivatives& derivatives_;
    PoleSide pole_;
    PlaneCorners base_;
    PolarFrame frame_;
    Array<PolarPart> parts_;
    Array<Derivatives> over_;
};

/// b is monotone, and the curve on one side of the pole: so that rays do not cross.
bool PolarPiece::runs_one_way() const {
    const double a = around(base_[0]), b = around(base_[1]), c = around(base_[2]);
    if (!((a < b && b < c) || (a > b && b > c))) return false;
    const double w = pole_.value;
    const double x = off(base_[0]) - w, y = off(base_[1]) - w, z = off(base_[2]) - w;
    return (x > 0.0 && y > 0.0 && z > 0.0) || (x < 0.0 && y < 0.0 && z < 0.0);
}

PolarPart PolarPiece::part_of(double s0, double s1) const {
    PolarPart part{stretch(around(base_[0]), around(base_[1]), around(base_[2]), s0, s1),
                   stretch(off(base_[0]), off(base_[1]), off(base_[2]), s0, s1),
                   {s0, s1},
                   {},
                   {}};
    part.depth = outward::subtract(part.off.value, outward::exactly(pole_.value));
    const Interval b = part.around.value, w = part.off.value;
    const double low = std::min(w.lo, pole_.value), high = std::max(w.hi, pole_.value);
    part.box = {place(b.lo, low), place(b.hi, high)};
    return part;
}

/// r_w over each box from its middle and second derivatives, and r_bw.
SurfaceStatus PolarPiece::enclose(std::size_t parts) {
    Array<ParameterBox> boxes;
    Array<Point2> middles;
    parts_.clear();
    for (std::size_t i = 0; i < parts; ++i) {
        const double n = static_cast<double>(parts);
        parts_.push_back(part_of(static_cast<double>(i) / n, static_cast<double>(i + 1) / n));
        const ParameterBox& box = parts_.back().box;
        boxes.push_back(box);
        middles.push_back(0.5 * (box.low + box.high));
    }
    const Array<Directions> directions(parts, BY_COORDINATE);
    Array<Bends> bends(parts);
    auto status = surface_.enclose_bends({boxes.data(), parts}, {directions.data(), parts},
                                         {bends.data(), parts});
    if (status != SurfaceStatus::DONE) return status;
    Array<SecondJet> jets(parts);
    status = derivatives_.enclose_second({middles.data(), parts}, {jets.data(), parts});
    over_.resize(parts);
    for (std::size_t i = 0; i < parts; ++i) {
        const auto& [value, error] = jets[i][pole_.is_v ? 2 : 1];
        const std::array<double, 3> middle = {value.x, value.y, value.z};
        const ParameterBox& box = boxes[i];
        const double more = 0.5 * (1.0 + PLACE_OFF);
        const double wide = more * (around(box.high) - around(box.low)),
                     deep = more * (off(box.high) - off(box.low));
        for (std::size_t d = 0; d < 3; ++d) {
            const Interval ww = pole_.is_v ? bends[i].vv[d] : bends[i].uu[d];
            const double away = wide * outward::magnitude(bends[i].uv[d]) +
                                deep * outward::magnitude(ww) + 2.0 * error;
            over_[i].r_w[d] = outward::add(outward::exactly(middle[d]), {-away, away});
            over_[i].r_w[d] = outward::widened(over_[i].r_w[d], 4.0);
            over_[i].r_bw[d] = bends[i].uv[d];
        }
    }
    return status;
}

/// The largest singular value of the matrix with two columns: of middles, and what those may be off.
double largest_stretch(const Vector& p, const Vector& q) {
    double pp = 0.0, pq = 0.0, qq = 0.0, off = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
        const double x = 0.5 * (p[d].lo + p[d].hi), y = 0.5 * (q[d].lo + q[d].hi);
        const double dx = p[d].hi - x, dy = q[d].hi - y;
        pp += x * x;
        pq += x * y;
        qq += y * y;
        off += dx * dx + dy * dy;
    }
    const double half = 0.5 * (pp - qq);
    return std::sqrt(0.5 * (pp + qq) + std::sqrt(half * half + pq * pq)) + std::sqrt(off);
}

PolarMove PolarPiece::move_of(const PolarPart& part, const Derivatives& over) const {
    const Vector base = exactly(frame_.base);
    const Vector d = sum(exactly(frame_.first), times(part.s, base));
    const Vector along_ray = less(times(part.depth, over.r_w), d);
    const Interval factor = outward::multiply(part.around.derivative, part.depth);
    const Vector along_base =
        less(sum(times(factor, over.r_bw), times(part.off.derivative, over.r_w)), base);
    // across the base: d less what of it lies along the base
    const double from = frame_.start + part.s.lo * frame_.length,
                 to = frame_.start + part.s.hi * frame_.length;
    const Interval part_along = outward::widened({from / frame_.length, to / frame_.length}, 64.0);
    const Vector across = less(along_ray, times(part_along, along_base));
    const Interval one_over_length = outward::exactly(1.0 / frame_.length),
                   one_over_height = outward::exactly(1.0 / frame_.height);
    const double slope =
        largest_stretch(times(one_over_length, along_base), times(one_over_height, across));
    return {slope, largest(along_ray)};
}

/// How far the surface's pole is from the mesh's.
SurfaceStatus PolarPiece::distance_at_pole(double& away) const {
    const Point2 place_there = place(around(base_[0]), pole_.value);
    EnclosedPoint found{};
    const auto status = surface_.enclose({&place_there, 1}, {&found, 1});
    away = norm(found.value - frame_.pole) + 2.0 * found.error;
    return status;
}

SurfaceStatus PolarPiece::bound(PolarMove& move) {
    move = NOTHING_KNOWN;
    if (!runs_one_way() || !(frame_.height > FLAT_TRIANGLE * frame_.length))
        return SurfaceStatus::DONE;
    double at_pole = 0.0;
    if (const auto status = distance_at_pole(at_pole); status != SurfaceStatus::DONE) return status;
    for (const std::size_t parts : PARTS) {
        if (const auto status = enclose(parts); status != SurfaceStatus::DONE) return status;
        PolarMove most{0.0, 0.0};
        for (std::size_t i = 0; i < parts; ++i) {
            const auto row = static_cast<std::ptrdiff_t>(i);
            const PolarMove found = move_of(parts_[row], over_[row]);
            if (!(found.slope + found.away < intervals::INFINITE)) return SurfaceStatus::DONE;
            most = {std::max(most.slope, found.slope), std::max(most.away, found.away)};
        }
        move.slope = std::min(move.slope, most.slope * (1.0 + POLAR_OFF) + POLAR_OFF);
        move.away = std::min(move.away, (most.away + at_pole) * (1.0 + POLAR_OFF));
        if (move.slope < LOW_SLOPE) break;
    }
    return SurfaceStatus::DONE;
}

}  // namespace

SurfaceStatus polar_moves(const Surface& surface, const FourthDerivatives& derivatives,
                          const PolarPieces& pieces, std::span<PolarMove> out) {
    for (std::size_t t = 0; t < out.size(); ++t)
        if (const auto status = PolarPiece(surface, derivatives, pieces, t).bound(out[t]);
            status != SurfaceStatus::DONE)
            return status;
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
