// ChunkedList against its contract: stable addresses and independent copies.
#include "polygonizer/mesh/chunked_list.hpp"

#include "catch.hpp"

using namespace deburr;

TEST_CASE("A list in chunks keeps its values where they are as it grows, and copies of it are its own") {
    ChunkedList<int> list;
    CHECK(list.empty());
    int& first = list.push_back(0);
    for (int k = 1; k < 10'000; ++k) list.push_back(k);
    CHECK(list.emplace_back() == 0);
    CHECK(list.size() == 10'001);
    CHECK(&first == &list[0]);
    ChunkedList<int> copy = list;
    first = -1;
    int wrong = 0;
    for (int k = 1; k < 10'000; ++k) wrong += list[std::size_t(k)] != k || copy[std::size_t(k)] != k;
    CHECK(wrong == 0);
    CHECK(copy[0] == 0);
    list = std::move(copy);
    CHECK(list.back() == 0);
    CHECK(list[0] == 0);
    CHECK(list.size() == 10'001);
}
