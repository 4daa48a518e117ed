// Vectors and control points as the bindings of curves and surfaces take them.
#pragma once

#include "binding/arrays.hpp"

namespace surfmesh::binding {

using Vector3 = nb::ndarray<const double, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using Numbers = Vector<double>;

inline Point3 point(const Vector3& v) { return {v.data()[0], v.data()[1], v.data()[2]}; }

inline std::span<const double> numbers(const Numbers& values) { return rows<double>(values); }

/// The degree of a spline; ValueError where knots and control points do not fit together.
std::size_t checked_degree(std::span<const double> knots, std::size_t control);

}  // namespace surfmesh::binding
