// An allocator for large arrays: in huge pages where the system has them. Else every 4 KiB of a film costs a
// page fault (in all, a tenth of csg_examples' CPU time at 600x380), and rays through 100,000 placements wait
// for the translation of addresses.
#pragma once
#include <sys/mman.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

namespace deburr {

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
        madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: it may fail
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
    static constexpr std::size_t page = std::size_t(1) << 21;
    // A quarter of a huge page costs as much to clear as the faults of its small ones.
    static bool large(std::size_t count) { return count >= page / 4 / sizeof(T); }
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace deburr
