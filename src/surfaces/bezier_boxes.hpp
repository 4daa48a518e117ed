// Boxes of the derivatives of a Bezier polynomial to the third order, rational or not, between the
// differences of its coefficients; round-off included. A curve has one column.
//
// A rational polynomial is S = A / w, with A about a point of the part so that S is small:
//
//     S^(k,l) = (A^(k,l) - sum over (i,j) != 0 of (k over i) (l over j) w^(i,j) S^(k-i,l-j)) / w
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997, 4.4 and 5.3.
#pragma once

#include <span>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/bezier_ranges.hpp"
#include "surfaces/third_derivatives.hpp"

namespace surfmesh {

/// The coefficients over a part.
struct BezierNet {
    std::size_t rows, columns;
    double width_u, width_v;
    std::span<const Homogeneous> control;
    double error;    // of each coefficient
    double largest;  // of what they are made of
    bool is_rational;
};

/// What is worked in, for one net after the other of as many coefficients.
struct BezierWork {
    Array<double> numbers, weights, differences;

    explicit BezierWork(std::size_t count)
        : numbers(count), weights(count), differences(2 * count) {}
};

/// Along three directions up to the order, at most 3, the value itself too; over the part, or at one of its
/// corners where that is given.
DerivativeBoxes boxes_of_net(const BezierNet& net, const Directions& directions, int order,
                             const BezierCorner* corner, BezierWork& work);

}  // namespace surfmesh
