// What a test asks of a refusal.
#pragma once
#include <freiform/core/result.hpp>

#include <gtest/gtest.h>
#include <string_view>

namespace freiform::test {

// A refusal of this kind at this place, whose message contains these words.
template <class T>
void expect_refusal(const Result<T>& r, RefusalKind kind, std::string_view where,
                    std::string_view message = "") {
    ASSERT_FALSE(r.has_value()) << where;
    EXPECT_EQ(name_of(r.error().kind), name_of(kind)) << r.error().message;
    EXPECT_EQ(r.error().where, where);
    EXPECT_FALSE(r.error().message.empty());
    EXPECT_NE(r.error().message.find(message), std::string_view::npos) << r.error().message;
}

}  // namespace freiform::test
