// Representations of a file, how they contain each other, and the units that each is in.
#pragma once
#include "step_shape.hpp"

namespace freiform::step {

struct Context {
    double length = 1;  // millimetres
    std::string unit = "mm";
    double angle = 1;         // radians
    double tolerance = 1e-7;  // in its own unit of length
};

// One representation, or several that relations say are the same.
struct Node {
    std::vector<std::uint32_t> items;
    Context context;
    std::string name;      // of the product
    bool product = false;  // some product has it as its shape
    struct Child {
        std::uint32_t node = 0;
        Motion at;
        std::optional<Colour> colour;
        std::vector<int> layers;
    };
    std::vector<Child> children;
    std::vector<std::pair<std::uint32_t, Motion>> replicas;  // items in another place
    bool has_parent = false;
    std::uint32_t document = kMissing;  // of Structure::documents: the shape is in another file
};

// Another file that a shape is in.
struct Document {
    std::uint32_t instance = kMissing;
    std::vector<std::string> names;  // that it may have, the likeliest first
};

struct Structure {
    std::vector<Node> nodes;
    Styles styles;
    std::vector<Refusal> refused;
    std::vector<Approximation> approximations;
    std::vector<Document> documents;
};
// `layers`: that have numbers already; those of the file follow.
Structure structure_of(const File& file, std::vector<Layer> layers = {});

// The largest distance that can pass for an uncertainty: a part of the extent of all vertices.
double largest_uncertainty(const File& file);

// Of a representation context.
Context context_of(const File& file, std::uint32_t context);
Styles styles_of(const File& file);
// Into the styles of the file: the layers, and what lies on them.
void read_layers(const File& file, Structure& out);
// Which nodes, of those that have nothing themselves, are in other files. `node`: of each instance that is a
// representation; `of_definition`: of each that is a product definition; else kMissing.
void read_documents(const File& file, std::span<const std::uint32_t> node,
                    std::span<const std::uint32_t> of_definition, Structure& out);
// Where what a file calls another one may be, as paths from the folder of the first file: below `folder`,
// that of the file that says it, empty or with a slash at its end; else, and if it lies elsewhere, in that
// folder.
std::vector<std::string> paths_beside(std::string_view folder, std::string name);

}  // namespace freiform::step
