// What commands that make surfaces of curves share: curves of two or three coordinates in, surfaces with what
// they are off by and a report out.
#pragma once
#include "command.hpp"

namespace freiform::cli {

// All in space, polynomial if all of them are.
struct SpaceCurves {
    std::vector<std::string> names;   // of the objects
    std::vector<std::string> labels;  // for refusals
    std::vector<Curve<Hom<3>>> rational;
    std::vector<Curve<Vec<3>>> polynomial;  // as many, or none
    std::string unit;

    std::size_t size() const { return rational.size(); }
    // f(std::span<const Curve<P>>), P as simple as possible.
    template <class F>
    decltype(auto) visit(F&& f) const {
        return polynomial.size() == rational.size() ? f(std::span<const Curve<Vec<3>>>(polynomial))
                                                    : f(std::span<const Curve<Hom<3>>>(rational));
    }
};
// Refuses objects that are no such curves, "which are PURPOSE" ("extruded").
Result<SpaceCurves> read_space_curves(const Context& context, const std::string& file,
                                      const std::string& object, std::string_view purpose);
// The same of a file that has to hold so many. Refuses others.
Result<SpaceCurves> read_space_curves(const Context& context, const std::string& file, std::size_t count,
                                      std::string_view purpose);

struct MadeSurfaces {
    Document document;
    double bound = 0;
    std::string of = "what was asked for";             // "surfaces within BOUND of ..."
    std::vector<std::pair<std::string, double>> said;  // more numbers for the report

    void add(std::string name, Shape surface, double off) {
        document.objects.push_back({std::move(name), std::move(surface), {}});
        bound = off > bound ? off : bound;
    }
};
Result<void> emit_surfaces(const Context& context, const std::string& format, MadeSurfaces made);

// Exactly so many numbers, or wrong usage.
std::vector<double> parse_numbers(const std::string& option, const std::vector<double>& given,
                                  std::size_t count);
Vec<3> parse_vector(const std::string& option, const std::vector<double>& given);
Vec<3> parse_direction(const std::string& option, const std::vector<double>& given);  // not 0

}  // namespace freiform::cli
