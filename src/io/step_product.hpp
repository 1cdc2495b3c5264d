// The product that a STEP file is about: contexts, units, and what ties shapes to it.
#pragma once
#include "step_detail.hpp"

#include <freiform/io/mesh_file.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace freiform::detail {

// What every file says once.
class Product {
public:
    // `uncertainty`: what lengths are uncertain by.
    Product(Entities& entities, std::string_view unit, double uncertainty) : e_(entities) {
        application_ = e_.add("APPLICATION_CONTEXT('managed model based 3d engineering')");
        e_.add(
            text("APPLICATION_PROTOCOL_DEFINITION('international standard',"
                 "'ap242_managed_model_based_3d_engineering',2014,#",
                 application_, ")"));
        const int length = length_unit(unit);
        const int angle = e_.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        const int solid = e_.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        const int accuracy = e_.add(text("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(", real(uncertainty),
                                         "),#", length, ",'distance_accuracy_value','')"));
        context_ = e_.add(text("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#",
                               accuracy, "))GLOBAL_UNIT_ASSIGNED_CONTEXT((#", length, ",#", angle, ",#",
                               solid, "))REPRESENTATION_CONTEXT('',''))"));
    }

    // Of one product, or those who read the file make what two of them have in common twice.
    void add(std::string_view representation, std::string_view name, const std::vector<int>& items) {
        if (items.empty()) return;
        const int shape = e_.add(text(representation, "('',", Entities::refs(items), ",#", context_, ")"));
        if (first_ != 0) {
            e_.add(text("SHAPE_REPRESENTATION_RELATIONSHIP('','',#", first_, ",#", shape, ")"));
            return;
        }
        first_ = shape;
        const int of_product = e_.add(text("PRODUCT_CONTEXT('',#", application_, ",'mechanical')"));
        const int product = e_.add(
            text("PRODUCT(", detail::quoted(name), ",", detail::quoted(name), ",'',(#", of_product, "))"));
        e_.add(text("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#", product, "))"));
        const int of_definition =
            e_.add(text("PRODUCT_DEFINITION_CONTEXT('part definition',#", application_, ",'design')"));
        const int formation = e_.add(text("PRODUCT_DEFINITION_FORMATION('','',#", product, ")"));
        const int definition =
            e_.add(text("PRODUCT_DEFINITION('design','',#", formation, ",#", of_definition, ")"));
        const int of_shape = e_.add(text("PRODUCT_DEFINITION_SHAPE('','',#", definition, ")"));
        e_.add(text("SHAPE_DEFINITION_REPRESENTATION(#", of_shape, ",#", shape, ")"));
    }

    int context() const { return context_; }

    void style(const std::vector<int>& items) {
        if (!items.empty())
            e_.add(text("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',", Entities::refs(items),
                        ",#", context_, ")"));
    }

private:
    int length_unit(std::string_view unit) {
        static constexpr std::pair<std::string_view, std::string_view> kPrefixes[] = {
            {"m", "$"},       {"mm", ".MILLI."}, {"cm", ".CENTI."}, {"dm", ".DECI."},
            {"km", ".KILO."}, {"um", ".MICRO."}, {"nm", ".NANO."}};
        std::string_view prefix;
        for (const auto& [word, its] : kPrefixes)
            if (word == unit) prefix = its;
        const auto metres = prefix.empty() ? metres_per(unit) : std::nullopt;
        const int si = e_.add(
            text("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(", prefix.empty() ? ".MILLI." : prefix, ",.METRE.))"));
        if (!metres) return si;
        const int of =
            e_.add(text("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(", real(*metres * 1000), "),#", si, ")"));
        const int exponents = e_.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
        std::string name(unit);
        for (char& c : name) c = c >= 'a' && c <= 'z' ? char(c - 32) : c;
        return e_.add(text("(CONVERSION_BASED_UNIT(", detail::quoted(name), ",#", of,
                           ")LENGTH_UNIT()NAMED_UNIT(#", exponents, "))"));
    }

    Entities& e_;
    int application_ = 0, context_ = 0, first_ = 0;
};

}  // namespace freiform::detail
