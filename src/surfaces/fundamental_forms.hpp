// First and second fundamental forms, normals and principal curvatures at a point.
//
//     I = [E F; F G]     E = r_u.r_u   F = r_u.r_v   G = r_v.r_v
//     II = [L M; M N]    L = r_uu.n    M = r_uv.n    N = r_vv.n      n = r_u x r_v / |r_u x r_v|
//
// Source: do Carmo, "Differential Geometry of Curves and Surfaces", chapters 2-5 and 3-3. With
// this sign a sphere whose normal points outwards has k1 = k2 = -1/R.
#pragma once

#include "values/point.hpp"

namespace surfmesh {

/// a . b, first and third product first: two lanes of a processor add up so, as numpy does, with
/// which the meshes of old were made.
constexpr double lane_dot(Point3 a, Point3 b) { return (a.x * b.x + a.z * b.z) + a.y * b.y; }

struct FundamentalForms {
    double E, F, G, L, M, N;
    Point3 normal;    // unit, along r_u x r_v; zero where the point is degenerate
    bool degenerate;  // r_u and r_v do not span a plane (pole, apex, cusp)
};

struct SecondDerivatives {
    Point3 uu, uv, vv;
};

FundamentalForms fundamental_forms(Point3 ru, Point3 rv, const SecondDerivatives& second);

/// The larger and the smaller principal curvature, 1 / length.
struct PrincipalCurvatures {
    double k1, k2;
};

/// Zero at degenerate points.
///
/// I = C C^T with C lower triangular (Cholesky) turns II into the symmetric shape operator
/// S = C^-1 II C^-T of an orthonormal frame of the tangent plane, whose eigenvalues are k1 and
/// k2; no digits are lost to a stretched (u, v).
PrincipalCurvatures principal_curvatures(const FundamentalForms& forms);

/// The same with unit tangents of space as steps of (u, v), at right angles to each other.
///
/// At umbilics d1 runs along u; at degenerate points they are (1, 0) and (0, 1).
struct PrincipalDirections {
    PrincipalCurvatures k;
    Point2 d1, d2;
};
PrincipalDirections principal_directions(const FundamentalForms& forms);

}  // namespace surfmesh
