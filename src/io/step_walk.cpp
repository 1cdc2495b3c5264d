// Nothing recurses on what the file says: a list of visits with the product of the places on the way takes
// the place of the stack.
#include "step_walk.hpp"

#include <algorithm>

namespace freiform::step {

namespace {

constexpr int kMostDepth = 200;

// A place whose motion is that of the node itself, in the unit of what contains it.
struct Visit {
    Place place;
    int depth = 0;
};

}  // namespace

const Context* context_of_model(const Structure& structure) {
    for (const Node& n : structure.nodes)
        if (!n.context.unit.empty() && has_items(n)) return &n.context;
    return nullptr;
}

Result<void> each_place(const Structure& structure, double length, std::uint64_t most,
                        const std::function<Result<void>(const Place&)>& use) {
    const auto& nodes = structure.nodes;
    const bool products = std::any_of(nodes.begin(), nodes.end(), [](const Node& n) {
        return n.product && (has_items(n) || !n.children.empty());
    });
    std::vector<Visit> todo;
    for (std::size_t n = nodes.size(); n-- > 0;)
        if (!nodes[n].has_parent && (!products || nodes[n].product))
            todo.push_back({{std::uint32_t(n), {}, {}, {}, {}}, 0});
    for (std::uint64_t visits = 0; !todo.empty();) {
        Visit v = std::move(todo.back());
        todo.pop_back();
        Place& p = v.place;
        const Node& node = nodes[p.node];
        if (v.depth > kMostDepth)
            return refuse(RefusalKind::invalid, "assembly", "contains itself, or is nested too deep");
        if (++visits > most)
            return refuse(RefusalKind::limit, "assembly", text("has more than ", visits, " places"));
        if (!node.name.empty()) p.name = node.name;
        Motion scale;
        scale.scale = node.context.length / length;
        const Motion outer = p.at;
        p.at = outer * scale;
        if (auto ok = use(p); !ok) return ok;
        for (std::size_t k = node.children.size(); k-- > 0;) {
            const Node::Child& c = node.children[k];
            // The place is said in the unit of the parent.
            Motion at = c.at;
            at.to.o = scale.scale * at.to.o;
            todo.push_back({{c.node, outer * at, p.name, p.colour ? p.colour : c.colour,
                             structure.styles.joined_layers(p.layers, c.layers)},
                            v.depth + 1});
        }
    }
    return {};
}

}  // namespace freiform::step
