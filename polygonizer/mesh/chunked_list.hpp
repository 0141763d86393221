// A list that grows without moving its elements, in chunks that are small against the whole, so references stay valid.
// A vector that grows holds up to three times its elements while it moves them. std::deque would do, except that its
// chunks hold only a dozen edges and finding one takes a division.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace deburr {

template <class T>
class ChunkedList {
public:
    ChunkedList() = default;
    ChunkedList(const ChunkedList& other) {
        for (std::size_t k = 0; k < other.size(); ++k) push_back(other[k]);
    }
    ChunkedList(ChunkedList&& other) noexcept
        : chunks_(std::move(other.chunks_)), size_(std::exchange(other.size_, 0)) {}
    ChunkedList& operator=(ChunkedList other) noexcept {
        chunks_.swap(other.chunks_);
        std::swap(size_, other.size_);
        return *this;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](std::size_t k) { return chunks_[k / chunk][k % chunk]; }
    const T& operator[](std::size_t k) const { return chunks_[k / chunk][k % chunk]; }
    T& back() { return (*this)[size_ - 1]; }

    T& push_back(T value) {
        if (size_ == chunk * chunks_.size()) chunks_.push_back(std::make_unique<T[]>(chunk));
        T& place = (*this)[size_++];
        place = std::move(value);
        return place;
    }
    T& emplace_back() { return push_back(T{}); }

private:
    static constexpr std::size_t chunk = 256;

    std::vector<std::unique_ptr<T[]>> chunks_;
    std::size_t size_ = 0;
};

}  // namespace deburr
