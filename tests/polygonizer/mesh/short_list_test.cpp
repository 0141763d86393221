// ShortList against std::vector under random operations.
#include "polygonizer/mesh/short_list.hpp"

#include <random>
#include <vector>

#include "catch.hpp"

using namespace deburr;

namespace {

using List = ShortList<int, 4>;

bool equal(const List& list, const std::vector<int>& expected) {
    return std::equal(list.begin(), list.end(), expected.begin(), expected.end());
}

}  // namespace

TEST_CASE("A short list does what a vector does, within itself and beyond, also after copies and moves") {
    std::mt19937 random(1);
    int longest = 0;
    for (int round = 0; round < 200; ++round) {
        List list;
        std::vector<int> same;
        for (int step = 0; step < 30; ++step) {
            const int value = int(random() % 100), at = same.empty() ? 0 : int(random() % same.size());
            switch (random() % 6) {
                case 0:
                case 1:
                    list.push_back(value);
                    same.push_back(value);
                    break;
                case 2:
                    list.insert(list.begin() + at, value);
                    same.insert(same.begin() + at, value);
                    break;
                case 3:
                    list.erase(list.begin() + at, list.end());
                    same.erase(same.begin() + at, same.end());
                    break;
                case 4: {
                    const List copy = list;
                    list = copy;
                    list.append(copy.begin(), copy.end());
                    same.insert(same.end(), same.begin(), same.begin() + long(copy.size()));
                    break;
                }
                default: {
                    List moved = std::move(list);
                    CHECK(list.empty());
                    list.push_back(value);  // a moved-from list is usable
                    list = std::move(moved);
                }
            }
            REQUIRE(equal(list, same));
            longest = std::max(longest, int(same.size()));
            if (same.size() > 500) break;
        }
    }
    CHECK(longest > 20);
}
