// A result, or a refusal: the one error model of the library. Nothing is thrown.
#pragma once
#include <freiform/core/text.hpp>

#include <expected>
#include <string>
#include <string_view>
#include <utility>

namespace freiform {

// Kinds are stable; docs/refusals.md has an example of each.
enum class RefusalKind {
    invalid,        // the data contradict themselves: counts that disagree, knots that decrease, zero weights
    nonfinite,      // NaN or infinity where a number is needed
    out_of_domain,  // a parameter outside the domain of the object
    unreadable,     // a file is not of the format that it claims to be, or damaged
    unsupported,    // well-formed, but outside what this version handles
    unavailable,    // an optional component was not built or not found
    limit,          // a limit on size, time or memory was reached; the message names the number needed
    not_converged,  // an iteration ended at its backstop
    ill_conditioned,  // no honest answer in double precision
    no_answer,        // the question is well-formed and has no answer
    io,               // reading or writing failed
};

std::string_view name_of(RefusalKind kind);

struct Refusal {
    RefusalKind kind = RefusalKind::invalid;
    std::string
        where;  // the field, entity, line or file: "knots[3]", "#1234 B_SPLINE_SURFACE", "teapot.bpt:7"
    std::string message;  // one sentence: what was found and what was expected
    friend bool operator==(const Refusal&, const Refusal&) = default;
};

template <class T>
using Result = std::expected<T, Refusal>;

inline std::unexpected<Refusal> refuse(RefusalKind kind, std::string where, std::string message) {
    return std::unexpected<Refusal>(Refusal{kind, std::move(where), std::move(message)});
}

// The same refusal seen from further out: "points[3]" inside "objects[0]" is "objects[0].points[3]".
inline std::unexpected<Refusal> refuse_within(std::string_view outer, Refusal r) {
    r.where = r.where.empty()     ? std::string(outer)
              : r.where[0] == '[' ? text(outer, r.where)
                                  : text(outer, ".", r.where);
    return std::unexpected<Refusal>(std::move(r));
}

}  // namespace freiform

// Preconditions of the caller: checked in debug builds and in the `checked` preset.
#if defined(FF_CHECKED) || !defined(NDEBUG)
#include <cassert>
#include <cstdio>
#include <cstdlib>
#define FF_REQUIRE(cond) \
    ((cond) ? (void)0    \
            : (std::fprintf(stderr, "%s:%d: REQUIRES %s\n", __FILE__, __LINE__, #cond), std::abort()))
#else
#define FF_REQUIRE(cond) ((void)0)
#endif
