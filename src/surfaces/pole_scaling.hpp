// An axis that runs to a pole, scaled so that circles about the pole are straight lines in the plane.
//
// About a pole on the short axis of an ellipsoid lines of constant v are as long and thin as its
// section, and what is straight in space is bent in (u, v) as far as it is elongated: an edge of two
// thirds of a ring runs out to the far end of the ellipse and back. So the fraction w of the axis is a
// function of its scaled fraction t and of the other coordinate s. With k(s) the distance in space
// from the pole per w, over the least of them, and W = pi w, T = pi t,
//
//     poles at both ends    cot W = k cot T,    log k = cos^2(T/2) log k0 + sin^2(T/2) log k1
//     a pole at one         1 / w^2 - 1 = k^2 (1 / z^2 - 1),    z = sin(c t) / sin(c)
//
// which rise in t, the first as long as k0 and k1 are no farther apart than 1 : 180. Lines of constant t
// are circles about the pole at first, ellipses farther off, and lines of constant
// w in the end. The first makes directions from the centre of an ellipsoid, with t the angle from the
// axis of its poles: sides of triangles are sections by planes through the centre there, which are
// great circles of the directions, and bent no more than on a sphere.
#pragma once

#include <cstddef>

#include "values/array.hpp"

namespace surfmesh {

enum class PoleEnds { first, last, both };

/// w and its derivatives: by t, and by the k of the beginning and of the end.
struct ScaledFraction {
    double value, by_t, by_first, by_last;
};

/// w(t) for 0 <= t <= 1, both ends exact.
struct FractionScaling {
    PoleEnds poles;
    double c;            // of the formula for one pole, below pi / 2
    double first, last;  // k at the beginning and at the end, 1 where there is no pole

    [[nodiscard]] ScaledFraction at(double t) const;
    [[nodiscard]] double inverse(double w) const;
};

/// A function of the other coordinate by its values and derivatives at even places.
struct EvenCubic {
    double extent = 0.0;
    Array<double> values, slopes;

    struct Value {
        double value, rate;
    };
    /// Constant outside [0, extent].
    [[nodiscard]] Value at(double s) const;
    /// Least and largest value between two places.
    struct Range {
        double least, most;
    };
    [[nodiscard]] Range between(double first, double last) const;
};

/// How the axis that runs to the poles is scaled.
struct PoleScaling {
    std::size_t axis = 1;  // 0: u runs to the poles, 1: v
    PoleEnds poles = PoleEnds::both;
    double c = 1.0;
    EvenCubic first, last;  // k of the other coordinate, or 1

    [[nodiscard]] bool is_none() const { return first.values.empty(); }
    [[nodiscard]] FractionScaling beside(double s) const {
        return {poles, c, first.at(s).value, last.at(s).value};
    }
    /// Least and largest w for t from t0 to t1 and the other coordinate from s0 to s1.
    [[nodiscard]] EvenCubic::Range between(double t0, double t1, double s0, double s1) const;
};

/// A monotone cubic between values at even places.
[[nodiscard]] EvenCubic even_cubic(double extent, Array<double> values);

}  // namespace surfmesh
