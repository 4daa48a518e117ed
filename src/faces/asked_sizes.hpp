// The sizes that are asked for on the faces of a model, whatever their extent.
//
// In: what one ``Sizing`` of Python asks for by numbers. Out: the rules on a surface of known
// diagonal, as surfmesh.sizing.rules.size_rules makes them, which has the words too.
#pragma once

#include <optional>

#include "sizing/size_rules.hpp"

namespace surfmesh {

/// Model units and degrees; nothing where there is no value. At least one of chord, angle and size
/// is there; sizes do not depend on the direction.
struct AskedSizes {
    std::optional<double> chord, angle, size, min_size, max_size;
    bool is_curved = false;      // ``chord`` is that of quadratic triangles
    bool is_width = false;       // ``chord`` is that of the whole band that a triangle needs
    double slope = 0.0;          // growth of the size per length, at most
    double default_angle = 0;    // of neighbours' normals, where a chord alone is asked for
    double default_largest = 0;  // size, as a fraction of the diagonal, where none is stated
};

/// The rules on a surface of this diagonal. on_lattice: for triangles that form a lattice.
[[nodiscard]] SizeRules rules_on(const AskedSizes& asked, double diagonal, bool on_lattice = false);

/// May triangles form a lattice along principal directions at all?
[[nodiscard]] inline bool may_form_lattice(const AskedSizes& asked) {
    return asked.chord && !asked.is_curved && !asked.is_width;
}

}  // namespace surfmesh
