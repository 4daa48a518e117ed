// Nodes by their place on the finest grid, as turns in which they were asked for: a table with open
// addressing, which grows.
#pragma once

#include <cstdint>

#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

using Turn = std::int32_t;

class KeyTable {
  public:
    KeyTable() { clear(1024); }

    /// The turn of a key, which is NIL where the key is new; the key is in the table then.
    Turn& operator[](std::int64_t key) {
        if (2 * (count_ + 1) > key_.size()) grow();
        const std::size_t at = slot(key);
        if (key_[at] == FREE) {
            key_[at] = key;
            ++count_;
        }
        return turn_[at];
    }

  private:
    static constexpr std::int64_t FREE = -1;

    void clear(std::size_t slots) {
        count_ = 0;
        key_ = Array<std::int64_t>(slots, FREE);
        turn_ = Array<Turn>(slots, NIL);
    }

    void grow() {
        const Array<std::int64_t> key = std::move(key_);
        const Array<Turn> turn = std::move(turn_);
        clear(4 * key.size());
        for (std::size_t k = 0; k < key.size(); ++k)
            if (key[k] != FREE) (*this)[key[k]] = turn[k];
    }

    [[nodiscard]] std::size_t slot(std::int64_t key) const {
        const std::size_t mask = key_.size() - 1;
        // keys of coarse cells are multiples of high powers of two: high bits have to come down
        std::uint64_t mixed = static_cast<std::uint64_t>(key) * 0x9E3779B97F4A7C15U;
        mixed = (mixed ^ (mixed >> 32)) * 0x9E3779B97F4A7C15U;
        std::size_t at = (mixed ^ (mixed >> 32)) & mask;
        while (key_[at] != FREE && key_[at] != key) at = (at + 1) & mask;
        return at;
    }

    std::size_t count_ = 0;
    Array<std::int64_t> key_;  // a power of two of them
    Array<Turn> turn_;
};

}  // namespace surfmesh
