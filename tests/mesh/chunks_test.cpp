#include "mesh/chunks_detail.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

namespace freiform {
namespace {

TEST(Chunks, what_was_added_stays_where_it_is) {
    Chunks<int, 4> all;
    std::vector<std::size_t> places;
    std::vector<const int*> addresses;
    for (int i = 0; i < 100; ++i) {
        places.push_back(all.add(i));
        addresses.push_back(&all[places.back()]);
    }
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(all[places[i]], int(i));
        EXPECT_EQ(&all[places[i]], addresses[i]);
    }
}

// Of any lengths, as full chunks, empty ones and what is between end differently.
TEST(Chunks, another_one_is_taken_up_as_it_is) {
    for (int own = 0; own < 10; ++own)
        for (int others = 0; others < 10; ++others) {
            Chunks<int, 4> all, other;
            std::vector<std::size_t> places, of_other;
            for (int i = 0; i < own; ++i) places.push_back(all.add(i));
            for (int i = 0; i < others; ++i) of_other.push_back(other.add(own + i));
            const int* first = others > 0 ? &other[of_other[0]] : nullptr;
            const std::size_t shift = all.take(std::move(other));
            for (const std::size_t p : of_other) places.push_back(p + shift);
            for (int i = 0; i < 10; ++i) places.push_back(all.add(own + others + i));
            for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(all[places[i]], int(i));
            if (first != nullptr) {
                EXPECT_EQ(&all[places[std::size_t(own)]], first);
            }
        }
}

// Chunks of two sequences from one piece of memory while there are any, which stays as long as one of them.
TEST(Chunks, one_room_serves_several) {
    using Ints = Chunks<int, 4>;
    auto room = std::make_shared<Ints::Room>(30);  // 8 chunks
    std::weak_ptr<Ints::Room> known = room;
    Ints all, other;
    all.use(room), other.use(std::move(room));
    std::vector<const int*> addresses;
    std::vector<std::size_t> places, of_other;
    for (int i = 0; i < 25; ++i) {
        places.push_back(all.add(i)), of_other.push_back(other.add(100 + i));
        addresses.push_back(&all[places.back()]), addresses.push_back(&other[of_other.back()]);
    }
    std::vector<const int*> within = addresses;
    std::sort(within.begin(), within.end());
    int together = 0;
    for (const int* a : addresses) together += a - addresses.front() < 32 && a >= addresses.front();
    EXPECT_EQ(together, 32) << "all of the room is used";
    EXPECT_EQ(std::adjacent_find(within.begin(), within.end()), within.end()) << "by one each";
    const std::size_t shift = all.take(std::move(other));
    other = Ints();
    for (std::size_t i = 0; i < 25; ++i) {
        EXPECT_EQ(all[places[i]], int(i));
        EXPECT_EQ(all[of_other[i] + shift], 100 + int(i));
    }
    EXPECT_FALSE(known.expired());
    all = Ints();
    EXPECT_TRUE(known.expired());
}

}  // namespace
}  // namespace freiform
