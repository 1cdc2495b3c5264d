#include "mesh/segments_detail.hpp"

#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace freiform {
namespace {

// Beside a vector: of any lengths, as full segments, empty ones and what is between end differently.
TEST(Segments, another_one_is_taken_up_as_it_is) {
    for (int own = 0; own < 10; ++own)
        for (int others = 0; others < 10; ++others) {
            Segments<int, 4> all, other;
            std::vector<std::size_t> places, of_other;
            for (int i = 0; i < own; ++i) {
                EXPECT_EQ(all.end(), std::size_t(i));
                places.push_back(all.add(i));
            }
            for (int i = 0; i < others; ++i) of_other.push_back(other.add(own + i));
            const int* first = others > 0 ? &other[of_other[0]] : nullptr;
            const std::size_t shift = all.take(std::move(other));
            EXPECT_EQ(other.count(), 0u);
            for (const std::size_t p : of_other) places.push_back(p + shift);
            if (first != nullptr) {
                EXPECT_EQ(&all[places[std::size_t(own)]], first);
            }
            for (int i = 0; i < 10; ++i) {
                const std::size_t next = all.end();
                places.push_back(all.add(own + others + i));
                EXPECT_EQ(places.back(), next);
            }
            for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(all[places[i]], int(i));
            EXPECT_EQ(all.count(), places.size());
            std::vector<std::size_t> visited;
            all.each_place([&](std::size_t p) { visited.push_back(p); });
            EXPECT_EQ(visited, places);
        }
}

TEST(Segments, what_has_room_is_not_moved) {
    Segments<int> all;
    all.reserve(1000);
    const std::size_t first = all.add(0);
    const int* address = &all[first];
    for (int i = 1; i < 1000; ++i) all.add(i);
    EXPECT_EQ(&all[first], address);
    EXPECT_EQ(all.count(), 1000u);
}

}  // namespace
}  // namespace freiform
