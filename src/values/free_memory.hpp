// Memory that the C library keeps when it has been freed goes back to the system.
//
// Arrays of a large mesh are freed in an order that leaves gaps: without this, more than the mesh
// itself takes stays with the process (glibc; other libraries give large blocks back at once).
// Below MANY_TRIANGLES that is some ten megabytes, which the next mesh can use again.
#pragma once

#include <cstdlib>  // of glibc: defines __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace surfmesh {

inline constexpr long long MANY_TRIANGLES = 100'000;

/// After work on so many triangles.
inline void return_free_memory([[maybe_unused]] long long triangles) {
#ifdef __GLIBC__
    if (triangles >= MANY_TRIANGLES) malloc_trim(0);
#endif
}

}  // namespace surfmesh
