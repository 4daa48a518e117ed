// How the outcome of building a size field looks to Python.
#pragma once

#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <tuple>
#include <utility>

#include "fields/field_builder.hpp"

namespace surfmesh::binding {

/// Status, place in the scaled plane, and a number of triangles or cells.
using OutcomeTuple = std::tuple<const char*, std::pair<double, double>, double>;

inline OutcomeTuple outcome_tuple(const FieldOutcome& outcome) {
    const auto name = [&] {
        switch (outcome.status) {
            case FieldStatus::done:
                return "done";
            case FieldStatus::too_many_triangles:
                return "too_many_triangles";
            case FieldStatus::too_many_cells:
                return "too_many_cells";
            case FieldStatus::not_graded:
                return "not_graded";
            case FieldStatus::failed:
                return "failed";
        }
        return "failed";
    };
    return {name(), {outcome.place.x, outcome.place.y}, outcome.number};
}

}  // namespace surfmesh::binding
