// What the surfaces of CAD faces have in common: a parameter box of their own.
#pragma once

#include "surfaces/surface.hpp"

namespace surfmesh {

class FaceSurface : public Surface {
  public:
    explicit FaceSurface(const ParameterBox& domain) : domain_(domain) {}
    [[nodiscard]] ParameterBox domain() const final { return domain_; }

  protected:
    ParameterBox domain_;
};

/// How often by u and by v the derivatives of a surface are taken, in their sequence.
struct DerivativeOrders {
    int by_u, by_v;
};
inline constexpr std::array<DerivativeOrders, 10> DERIVATIVES = {
    {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}}};

}  // namespace surfmesh
