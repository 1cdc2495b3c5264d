// The text of STEP files: ISO 10303-21, editions 1 to 3, as a table of instances.
//
// A file is one flat list of tokens, twelve bytes each, that refer to the bytes of the file; an instance is a
// range of them. Numbers and strings are converted when somebody asks. Nothing nests on the stack, and no
// count in the file makes memory be taken beyond a multiple of its size.
#pragma once
#include <freiform/core/result.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::step {

// The names of entities that the reader knows, in the order of the alphabet.
#define FF_STEP_TYPES(X)                               \
    X(ADVANCED_BREP_SHAPE_REPRESENTATION)              \
    X(ADVANCED_FACE)                                   \
    X(APPLIED_DOCUMENT_REFERENCE)                      \
    X(APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT)      \
    X(AXIS1_PLACEMENT)                                 \
    X(AXIS2_PLACEMENT_2D)                              \
    X(AXIS2_PLACEMENT_3D)                              \
    X(BEZIER_CURVE)                                    \
    X(BEZIER_SURFACE)                                  \
    X(BLOCK)                                           \
    X(BOUNDARY_CURVE)                                  \
    X(BREP_WITH_VOIDS)                                 \
    X(B_SPLINE_CURVE)                                  \
    X(B_SPLINE_CURVE_WITH_KNOTS)                       \
    X(B_SPLINE_SURFACE)                                \
    X(B_SPLINE_SURFACE_WITH_KNOTS)                     \
    X(CARTESIAN_POINT)                                 \
    X(CARTESIAN_TRANSFORMATION_OPERATOR_3D)            \
    X(CIRCLE)                                          \
    X(CLOSED_SHELL)                                    \
    X(COLOUR_RGB)                                      \
    X(COMPLEX_TRIANGULATED_FACE)                       \
    X(COMPLEX_TRIANGULATED_SURFACE_SET)                \
    X(COMPOSITE_CURVE)                                 \
    X(COMPOSITE_CURVE_ON_SURFACE)                      \
    X(COMPOSITE_CURVE_SEGMENT)                         \
    X(CONICAL_SURFACE)                                 \
    X(CONNECTED_EDGE_SET)                              \
    X(CONNECTED_FACE_SET)                              \
    X(CONTEXT_DEPENDENT_SHAPE_REPRESENTATION)          \
    X(CONVERSION_BASED_UNIT)                           \
    X(COORDINATES_LIST)                                \
    X(CSG_SOLID)                                       \
    X(CUBIC_BEZIER_TRIANGULATED_FACE)                  \
    X(CURVE_BOUNDED_SURFACE)                           \
    X(CURVE_REPLICA)                                   \
    X(CYLINDRICAL_SURFACE)                             \
    X(DEFINITIONAL_REPRESENTATION)                     \
    X(DEGENERATE_TOROIDAL_SURFACE)                     \
    X(DIRECTION)                                       \
    X(DOCUMENT_FILE)                                   \
    X(DRAUGHTING_PRE_DEFINED_COLOUR)                   \
    X(EDGE_BASED_WIREFRAME_MODEL)                      \
    X(EDGE_CURVE)                                      \
    X(EDGE_LOOP)                                       \
    X(ELLIPSE)                                         \
    X(EXTRUDED_AREA_SOLID)                             \
    X(EXTRUDED_FACE_SOLID)                             \
    X(FACETED_BREP)                                    \
    X(FACE_BASED_SURFACE_MODEL)                        \
    X(FACE_BOUND)                                      \
    X(FACE_OUTER_BOUND)                                \
    X(FACE_SURFACE)                                    \
    X(GEOMETRIC_CURVE_SET)                             \
    X(GEOMETRIC_SET)                                   \
    X(GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT)             \
    X(GLOBAL_UNIT_ASSIGNED_CONTEXT)                    \
    X(HYPERBOLA)                                       \
    X(INTERSECTION_CURVE)                              \
    X(ITEM_DEFINED_TRANSFORMATION)                     \
    X(LENGTH_UNIT)                                     \
    X(LINE)                                            \
    X(MANIFOLD_SOLID_BREP)                             \
    X(MAPPED_ITEM)                                     \
    X(NEXT_ASSEMBLY_USAGE_OCCURRENCE)                  \
    X(OFFSET_CURVE_2D)                                 \
    X(OFFSET_CURVE_3D)                                 \
    X(OFFSET_SURFACE)                                  \
    X(OPEN_SHELL)                                      \
    X(ORIENTED_CLOSED_SHELL)                           \
    X(ORIENTED_EDGE)                                   \
    X(ORIENTED_FACE)                                   \
    X(ORIENTED_OPEN_SHELL)                             \
    X(OUTER_BOUNDARY_CURVE)                            \
    X(OVER_RIDING_STYLED_ITEM)                         \
    X(PARABOLA)                                        \
    X(PCURVE)                                          \
    X(PLANE)                                           \
    X(PLANE_ANGLE_UNIT)                                \
    X(POLYLINE)                                        \
    X(POLY_LOOP)                                       \
    X(PRESENTATION_LAYER_ASSIGNMENT)                   \
    X(PRODUCT)                                         \
    X(PRODUCT_DEFINITION)                              \
    X(PRODUCT_DEFINITION_SHAPE)                        \
    X(PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS)    \
    X(PROPERTY_DEFINITION)                             \
    X(PROPERTY_DEFINITION_REPRESENTATION)              \
    X(QUASI_UNIFORM_CURVE)                             \
    X(QUASI_UNIFORM_SURFACE)                           \
    X(RATIONAL_B_SPLINE_CURVE)                         \
    X(RATIONAL_B_SPLINE_SURFACE)                       \
    X(RECTANGULAR_COMPOSITE_SURFACE)                   \
    X(RECTANGULAR_TRIMMED_SURFACE)                     \
    X(REPARAMETRISED_COMPOSITE_CURVE_SEGMENT)          \
    X(REPOSITIONED_TESSELLATED_ITEM)                   \
    X(REPRESENTATION_RELATIONSHIP)                     \
    X(REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION) \
    X(REVOLVED_AREA_SOLID)                             \
    X(REVOLVED_FACE_SOLID)                             \
    X(RIGHT_ANGULAR_WEDGE)                             \
    X(RIGHT_CIRCULAR_CONE)                             \
    X(RIGHT_CIRCULAR_CYLINDER)                         \
    X(SEAM_CURVE)                                      \
    X(SHAPE_DEFINITION_REPRESENTATION)                 \
    X(SHAPE_REPRESENTATION_RELATIONSHIP)               \
    X(SHELL_BASED_SURFACE_MODEL)                       \
    X(SHELL_BASED_WIREFRAME_MODEL)                     \
    X(SI_UNIT)                                         \
    X(SOLID_REPLICA)                                   \
    X(SPHERE)                                          \
    X(SPHERICAL_SURFACE)                               \
    X(STYLED_ITEM)                                     \
    X(SUBEDGE)                                         \
    X(SUBFACE)                                         \
    X(SURFACE_CURVE)                                   \
    X(SURFACE_OF_LINEAR_EXTRUSION)                     \
    X(SURFACE_OF_REVOLUTION)                           \
    X(SURFACE_PATCH)                                   \
    X(SURFACE_REPLICA)                                 \
    X(SWEPT_DISK_SOLID)                                \
    X(TESSELLATED_GEOMETRIC_SET)                       \
    X(TESSELLATED_SHELL)                               \
    X(TESSELLATED_SOLID)                               \
    X(TOROIDAL_SURFACE)                                \
    X(TORUS)                                           \
    X(TRIANGULATED_FACE)                               \
    X(TRIANGULATED_SURFACE_SET)                        \
    X(TRIMMED_CURVE)                                   \
    X(UNIFORM_CURVE)                                   \
    X(UNIFORM_SURFACE)                                 \
    X(VECTOR)                                          \
    X(VERTEX_LOOP)                                     \
    X(VERTEX_POINT)                                    \
    X(VERTEX_SHELL)                                    \
    X(WIRE_SHELL)

#define FF_STEP_NAME(name) name,
enum class Type : std::uint16_t { unknown, FF_STEP_TYPES(FF_STEP_NAME) };
#undef FF_STEP_NAME

enum class TokenKind : std::uint8_t {
    number,
    string,
    enumeration,
    binary,
    reference,  // at: place in the table of instances, or kMissing; size: the number after #
    omitted,    // $
    derived,    // *
    keyword,    // of an entity or of a typed value; a list follows
    list,       // size: how many tokens there are in it, all levels together
    external,   // <...>, @1, a constant: what other files hold
};

// unknown if it is not among them.
Type type_named(std::string_view name);

struct Token {
    TokenKind kind = TokenKind::omitted;
    Type type = Type::unknown;  // of a keyword
    std::uint32_t at = 0, size = 0;
};

inline constexpr std::uint32_t kMissing = 0xffffffff;

struct Instance {
    std::uint32_t id = 0, at = 0;         // its number, and its first byte
    std::uint32_t first = 0, tokens = 0;  // keyword, list, and so on: several pairs if complex
};

struct File {
    std::string_view bytes;
    std::vector<Token> tokens;
    std::vector<Instance> instances;  // of the data sections, in their order
    std::vector<Instance> header;
    std::vector<Refusal>
        refused;  // what could not be read, up to a number of them; the last one counts the rest
    std::uint32_t offset_curves = 0;  // how many OFFSET_CURVE_3D there are
    std::string schema;               // the first one that FILE_SCHEMA names

    std::string_view text_of(const Token& t) const { return bytes.substr(t.at, t.size); }
    // Of a simple instance its type, of a complex one unknown.
    Type type(std::uint32_t i) const {
        const Instance& x = instances[i];
        return x.tokens == tokens[x.first + 1].size + 2 ? tokens[x.first].type : Type::unknown;
    }
    // Whether it is of the type, alone or among others.
    bool is(std::uint32_t i, Type type) const { return part(i, type) != kMissing; }
    // The list that belongs to the type; kMissing if it is not of it.
    std::uint32_t part(std::uint32_t i, Type type) const;
    // "#12 CIRCLE"
    std::string label(std::uint32_t i) const;
};

// `bytes` have to live as long as the file. Refuses (unreadable) what is no such file or ends too early.
// Instances that are damaged are left out, and stand in `refused` with their number and byte.
Result<File> parse(std::string_view bytes);

// The characters that a string token stands for, as UTF-8: with the escapes \S\, \P.\, \X\, \X2\, \X4\ and
// doubled apostrophes and reverse solidi.
std::string decoded(std::string_view string);
// UTF-8 as the characters of a string token: what is not printable ASCII is an escape, and bytes that are not
// UTF-8 are taken as ISO 8859-1.
std::string encoded(std::string_view utf8);

}  // namespace freiform::step
