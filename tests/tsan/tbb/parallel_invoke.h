// parallel_invoke on std::thread; see threads.hpp.
#pragma once
#include "threads.hpp"

namespace tbb {

template <class... Works>
void parallel_invoke(const Works&... works) {
    const std::function<void()> all[] = {std::cref(works)...};
    on_threads::loop(sizeof...(works), [&](std::size_t i) { all[i](); });
}

}  // namespace tbb
