// An allocator that puts large arrays into huge pages where the system has them. With pages of 4 KiB, page faults on a
// film took a tenth of csg_examples' CPU time at 600x380, and rays through 100,000 instances wait for address
// translation.
#pragma once
#include <sys/mman.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

namespace deburr {

/// An allocator for std::vector. Small arrays come from std::allocator.
template <class T>
struct LargePages {
    using value_type = T;

    LargePages() = default;
    template <class U>
    LargePages(const LargePages<U>&) {}

    T* allocate(std::size_t count) {
        if (!large(count)) return std::allocator<T>().allocate(count);
        const std::size_t bytes = (count * sizeof(T) + page - 1) / page * page;
        void* memory = std::aligned_alloc(page, bytes);
        if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
        madvise(memory, bytes, MADV_HUGEPAGE);  // only a hint, so failure is ignored
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) {
        if (large(count))
            std::free(memory);
        else
            std::allocator<T>().deallocate(memory, count);
    }
    bool operator==(const LargePages&) const = default;

private:
    static constexpr std::size_t page = std::size_t(1) << 21;  // 2 MiB
    // Whether an array of this length gets huge pages: from a quarter of one on, since clearing that costs as much as
    // the faults of its small pages.
    static bool large(std::size_t count) { return count >= page / 4 / sizeof(T); }
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace deburr
