// STEP files of assemblies whose parts are in other files.
#pragma once
#include "step_polygons.hpp"

namespace freiform::test {

// How a file says that a part is in another one.
enum class Link { property, reference, definition };

// A part in a place of the assembly.
struct Use {
    std::string file;   // what the assembly calls it
    std::string place;  // of the point, then of z and x: "1.,2.,3." and so on
    std::string z = "0.,0.,1.", x = "1.,0.,0.";
    Link link = Link::property;
    std::string document = {};  // the identifier of the document; else the file
    std::string context = "#1";
    std::string items = {};  // that the part has itself
};

inline std::string products(int n, std::string_view shape, std::string_view name,
                            std::string_view definition) {
    return text("#", n, "=PRODUCT('", name, "','", name, "','',());\n#", n + 1,
                "=PRODUCT_DEFINITION_FORMATION('','',#", n, ");\n#", n + 2, "=", definition, ";\n#", n + 3,
                "=PRODUCT_DEFINITION_SHAPE('','',#", n + 2, ");\n#", n + 4,
                "=SHAPE_DEFINITION_REPRESENTATION(#", n + 3, ",", shape, ");\n");
}

// `items`: of the assembly itself, each with a comma before it.
inline std::string assembly(const std::vector<Use>& uses, std::string_view more = "",
                            std::string_view items = "") {
    std::string s = text("#8=SHAPE_REPRESENTATION('',(#5", items, "),#1);\n",
                         products(10, "#8", "whole", "PRODUCT_DEFINITION('','',#11,$)"));
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const Use& u = uses[i];
        const std::size_t b = 10'000 * (i + 1);
        const std::string document = text("#", b + 20), part = text("#", b + 12);
        s += text("#", b, "=SHAPE_REPRESENTATION('',(#5", u.items, "),", u.context, ");\n");
        s += products(
            int(b) + 10, text("#", b), text("part ", i),
            u.link == Link::definition
                ? text("PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS('','',#", b + 11, ",$,(", document, "))")
                : text("PRODUCT_DEFINITION('','',#", b + 11, ",$)"));
        s += text(document, "=DOCUMENT_FILE('", u.document.empty() ? u.file : u.document, "','','',#", b + 21,
                  ",'',$);\n#", b + 21, "=DOCUMENT_TYPE('geometry');\n#", b + 22,
                  "=APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT('", u.file, "',#", b + 23, ",#", b + 24, ",(",
                  document, "));\n#", b + 23,
                  "=IDENTIFICATION_ROLE('external document id and location',$);\n#", b + 24,
                  "=EXTERNAL_SOURCE(IDENTIFIER(''));\n");
        if (u.link == Link::property)
            s += text("#", b + 25, "=PROPERTY_DEFINITION('external definition','',", document, ");\n#",
                      b + 26, "=PROPERTY_DEFINITION_REPRESENTATION(#", b + 25, ",#", b, ");\n");
        if (u.link == Link::reference)
            s += text("#", b + 25, "=APPLIED_DOCUMENT_REFERENCE(", document, ",'',(", part, "));\n");
        s += text("#", b + 30, "=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#12,", part, ",$);\n#", b + 31,
                  "=PRODUCT_DEFINITION_SHAPE('','',#", b + 30, ");\n#", b + 32,
                  "=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#", b + 33, ",#", b + 31, ");\n#", b + 33,
                  "=(REPRESENTATION_RELATIONSHIP('','',#", b,
                  ",#8)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#", b + 34,
                  ")SHAPE_REPRESENTATION_RELATIONSHIP());\n#", b + 34,
                  "=ITEM_DEFINED_TRANSFORMATION('','',#5,#", b + 35, ");\n#", b + 35,
                  "=AXIS2_PLACEMENT_3D('',#", b + 36, ",#", b + 37, ",#", b + 38, ");\n#", b + 36,
                  "=CARTESIAN_POINT('',(", u.place, "));\n#", b + 37, "=DIRECTION('',(", u.z, "));\n#",
                  b + 38, "=DIRECTION('',(", u.x, "));\n");
    }
    return flat_file(s += more);
}

}  // namespace freiform::test
