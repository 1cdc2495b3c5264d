// What tessellate says about a mesh.
#pragma once
#include "sewing.hpp"

#include <freiform/model/tessellate.hpp>

namespace freiform::cli {

struct TessellateReport {
    const Tessellation& t;
    const Model& model;
    const std::optional<Sewing>& sewing;
    const TessellateOptions& how;
    std::string output;   // the file; empty: none
    double rounding = 0;  // of coordinates stored as float
    struct Seconds {
        double read = 0, sew = 0, write = 0, total = 0;
    } seconds;
    std::optional<double> angle;  // asked for, in degrees
};

void write_report(json::Writer& w, const TessellateReport& r);
std::string report_text(const TessellateReport& r);

}  // namespace freiform::cli
