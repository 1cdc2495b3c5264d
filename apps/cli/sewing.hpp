// --sew: what commands that sew say about it.
#pragma once
#include "command.hpp"

#include <freiform/model/sew.hpp>

namespace freiform::cli {

struct SewArguments {
    bool wanted = false;
    std::optional<double> tolerance;  // none: the largest that the file gives

    void add_to(const Command& command);
};

// The model sewn, or nothing where that was not asked for. Refuses a file without tolerances when none is
// given.
Result<std::optional<Sewing>> sewn(const Model& model, const SewArguments& how);

void write_sewing(json::Writer& w, const Sewing& s);  // as field "sewing"
std::string sewing_text(const Sewing& s, const std::string& unit);

}  // namespace freiform::cli
