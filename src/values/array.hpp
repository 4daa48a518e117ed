// A growable array of plain values whose memory numpy can look at.
//
// It grows where it is filled. A numpy view shares the memory: growing leaves an older view with
// the older memory, which goes stale and never dangles. Copies are deep.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace surfmesh {

template <class T>
class Array {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Array() = default;
    explicit Array(std::size_t size, T value = T{}) { resize(size, value); }
    explicit Array(std::span<const T> values) {
        reserve(values.size());
        std::copy(values.begin(), values.end(), data_);
        size_ = values.size();
    }
    /// Of so many values, each of which its maker writes before anybody reads it: threads that fill
    /// parts of it touch their memory first.
    [[nodiscard]] static Array unfilled(std::size_t size) {
        Array made;
        made.reserve(size);
        made.size_ = size;
        return made;
    }
    Array(const Array& other) : Array(std::span<const T>(other.data_, other.size_)) {}
    Array(Array&& other) noexcept { swap(other); }
    Array& operator=(Array other) noexcept {
        swap(other);
        return *this;
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] T* data() const { return data_; }
    [[nodiscard]] const std::shared_ptr<T[]>& memory() const { return memory_; }

    T& operator[](std::ptrdiff_t i) {
        assert(i >= 0 && static_cast<std::size_t>(i) < size_);
        return data_[i];
    }
    const T& operator[](std::ptrdiff_t i) const {
        assert(i >= 0 && static_cast<std::size_t>(i) < size_);
        return data_[i];
    }
    T* begin() const { return data_; }
    T* end() const { return data_ + size_; }
    T& back() { return (*this)[static_cast<std::ptrdiff_t>(size_) - 1]; }

    void push_back(T value) {
        if (size_ == room_) reserve(size_ + size_ / 2 + 16);
        data_[size_++] = value;
    }
    T pop_back() {
        assert(size_ > 0);
        return data_[--size_];
    }
    void resize(std::size_t size, T value = T{}) {
        if (size > room_) reserve(std::max(size, size_ + size_ / 2));
        for (std::size_t i = size_; i < size; ++i) data_[i] = value;
        size_ = size;
    }
    void reserve(std::size_t room) {
        if (room <= room_) return;
        auto memory = std::make_shared_for_overwrite<T[]>(room);
        std::copy(data_, data_ + size_, memory.get());
        memory_ = std::move(memory);
        data_ = memory_.get();
        room_ = room;
    }
    void clear() { size_ = 0; }
    void fill(T value) { std::fill(begin(), end(), value); }
    void swap(Array& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(room_, other.room_);
    }

  private:
    std::shared_ptr<T[]> memory_;
    T* data_ = nullptr;
    std::size_t size_ = 0, room_ = 0;
};

}  // namespace surfmesh
