// Work of the core while Python may do other things.
#pragma once

#include <nanobind/nanobind.h>

namespace surfmesh::binding {

/// What ``work`` gives, done with the interpreter released.
template <class Work>
auto released(const Work& work) {
    const nanobind::gil_scoped_release released;
    return work();
}

}  // namespace surfmesh::binding
