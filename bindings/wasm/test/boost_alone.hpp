// Boost where there are neither threads nor exceptions: what it asks for in their place. For the C++ tests.
#pragma once
#define BOOST_NO_EXCEPTIONS
#define BOOST_SMART_PTR_DETAIL_LIGHTWEIGHT_MUTEX_HPP_INCLUDED
#define _LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION
#include <cstdlib>
#include <exception>

namespace boost {

struct source_location;
[[noreturn]] inline void throw_exception(const std::exception&) { std::abort(); }
[[noreturn]] inline void throw_exception(const std::exception&, const source_location&) { std::abort(); }

namespace detail {
class lightweight_mutex {
public:
    class scoped_lock {
    public:
        explicit scoped_lock(lightweight_mutex&) {}
    };
};
}  // namespace detail

}  // namespace boost
