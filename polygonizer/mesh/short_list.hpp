// A list that is usually short: it allocates memory only beyond `usual` elements. A subdivision has thousands of such
// lists. It replaces boost::container::small_vector, because Boost would be too heavy a dependency for one class.
#pragma once
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <type_traits>
#include <utility>

namespace deburr {

template <class T, std::uint32_t usual>
class ShortList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    ShortList() : more_(nullptr) {}
    ShortList(std::initializer_list<T> values) : ShortList() { append(values.begin(), values.end()); }
    ShortList(const T* first, const T* last) : ShortList() { append(first, last); }
    ShortList(const ShortList& other) : ShortList() { append(other.begin(), other.end()); }
    ShortList(ShortList&& other) noexcept : ShortList() { take(other); }
    ShortList& operator=(const ShortList& other) {
        if (this == &other) return *this;
        clear();
        append(other.begin(), other.end());
        return *this;
    }
    ShortList& operator=(ShortList&& other) noexcept {
        if (this != &other) take(other);
        return *this;
    }

    ~ShortList() {
        if (is_long()) delete[] more_;
    }

    T* begin() { return is_long() ? more_ : few_; }
    T* end() { return begin() + size_; }
    const T* begin() const { return is_long() ? more_ : few_; }
    const T* end() const { return begin() + size_; }
    T* data() { return begin(); }
    const T* data() const { return begin(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](std::size_t k) { return begin()[k]; }
    const T& operator[](std::size_t k) const { return begin()[k]; }
    T& front() { return *begin(); }
    T& back() { return end()[-1]; }
    const T& front() const { return *begin(); }
    const T& back() const { return end()[-1]; }

    void clear() { size_ = 0; }
    void push_back(T value) {
        reserve(size_ + 1);
        begin()[size_++] = value;
    }
    void append(const T* first, const T* last) {
        const std::uint32_t count = std::uint32_t(last - first);
        reserve(size_ + count);
        std::copy(first, last, end());
        size_ += count;
    }
    void insert(T* at, T value) {
        const std::ptrdiff_t index = at - begin();
        push_back(value);
        std::rotate(begin() + index, end() - 1, end());
    }
    void erase(T* first, T* last) {
        std::copy(last, end(), first);
        size_ -= std::uint32_t(last - first);
    }

private:
    bool is_long() const { return room_ > usual; }

    void reserve(std::uint32_t wanted) {
        if (wanted <= room_) return;
        const std::uint32_t room = std::max(2 * room_, wanted);
        T* more = new T[room];
        std::copy(begin(), end(), more);
        if (is_long()) delete[] more_;
        more_ = more;
        room_ = room;
    }
    void take(ShortList& other) {
        if (is_long()) delete[] more_;
        if (other.is_long())
            more_ = other.more_;
        else
            std::copy(other.few_, other.few_ + other.size_, few_);
        size_ = std::exchange(other.size_, 0);
        room_ = std::exchange(other.room_, usual);
    }

    std::uint32_t size_ = 0, room_ = usual;
    union {
        T few_[usual];  // while room_ is `usual`
        T* more_;       // once room_ is greater
    };
};

}  // namespace deburr
