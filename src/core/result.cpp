#include <freiform/core/result.hpp>

namespace freiform {

std::string_view name_of(RefusalKind kind) {
    switch (kind) {
        case RefusalKind::invalid:
            return "invalid";
        case RefusalKind::nonfinite:
            return "nonfinite";
        case RefusalKind::out_of_domain:
            return "out_of_domain";
        case RefusalKind::unreadable:
            return "unreadable";
        case RefusalKind::unsupported:
            return "unsupported";
        case RefusalKind::unavailable:
            return "unavailable";
        case RefusalKind::limit:
            return "limit";
        case RefusalKind::not_converged:
            return "not_converged";
        case RefusalKind::ill_conditioned:
            return "ill_conditioned";
        case RefusalKind::no_answer:
            return "no_answer";
        case RefusalKind::io:
            return "io";
    }
    return "invalid";
}

}  // namespace freiform
