// Angles between the normals of two triangles that share an edge.
#pragma once

#include <span>

#include "triangulation/triangulation.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Sine and cosine of an angle, times the same positive number.
struct DihedralTurn {
    double across, along;
};

/// Squared sine of the angle between two sides, or one at a pole: only rounding.
inline constexpr double NO_DIHEDRAL_AREA = 1e-24;

/// From the normal of a-b-c to that of b-a-d; none where one has no area.
inline DihedralTurn dihedral_turn(Point3 a, Point3 b, Point3 c, Point3 d) {
    const Point3 u = b - a, v = c - a, w = d - a;
    const Point3 m = cross(u, v), n = cross(w, u);
    const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w), mm = dot(m, m), nn = dot(n, n);
    if (!(mm > NO_DIHEDRAL_AREA * uu * vv && nn > NO_DIHEDRAL_AREA * uu * ww)) return {0.0, 1.0};
    return {norm(cross(m, n)), dot(m, n)};
}

/// Radians between the normals of a-b-c and b-a-d; 0 where one has no area.
double dihedral_angle(Point3 a, Point3 b, Point3 c, Point3 d);

/// Two half-edges that meet, one in each of two triangles; -1 in the second: there is no other.
struct HalfEdgePair {
    HalfEdge first, second;
};

/// Edges across which triangles meet, and the angles there, radians.
struct DihedralAngles {
    Array<HalfEdgePair> edges;
    Array<double> angles;
};

/// The edges across which triangles turn by more than ``limit`` (radians), with their angles.
///
/// One half-edge of each edge between two triangles; borders, seams among them, have none.
DihedralAngles find_dihedrals_over(const Triangulation& t, const Array<Point3>& point,
                                   double limit);

/// Angle, radians, across edges of a finished mesh; 0 where there is no second half-edge.
///
/// Where both run the same way, as somewhere on a Moebius strip, one triangle is turned over.
Array<double> dihedral_angles(std::span<const Point3> points, std::span<const Vertex> corners,
                              std::span<const HalfEdgePair> edges);

}  // namespace surfmesh
