// Idea. Representations that are related without a transformation are one node. Mapped items and relations
// with a transformation, which assemblies are made of, are links from a node to its parts. What has no parent
// is a root; where products have shapes, only those.
//
// Which of the two representations of a relation is the assembly: the one that the usage names
// (NEXT_ASSEMBLY_ USAGE_OCCURRENCE), because some programs write them the wrong way around.
//
// References: ISO 10303-43:2011 (representations), -44 (products).
#include "step_structure.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <numeric>

namespace freiform::step {

namespace {

class Structurer {
public:
    explicit Structurer(const File& f) : f_(f), node_(f.instances.size(), kMissing) {}

    Structure run(std::vector<Layer> layers) {
        out_.styles = styles_of(f_);
        out_.styles.layers = std::move(layers);
        read_layers(f_, out_);
        find_representations();
        join_equals();
        make_nodes();
        name_products();
        link_assemblies();
        read_documents(f_, node_, of_definition_, out_);
        return std::move(out_);
    }

private:
    // (name, items, context), perhaps more: what ends with a list of instances and a context.
    void find_representations() {
        for (std::uint32_t i = 0; i < f_.instances.size(); ++i) {
            const Instance& x = f_.instances[i];
            bool shape = false, other = false;
            for (std::uint32_t k = x.first; k + 1 < x.first + x.tokens; k += 2 + f_.tokens[k + 1].size) {
                const std::string_view name = f_.text_of(f_.tokens[k]);
                shape = shape || name == "REPRESENTATION" || name.ends_with("SHAPE_REPRESENTATION");
                other = other || name.starts_with("MECHANICAL_DESIGN") || name.starts_with("DRAUGHTING") ||
                        name.starts_with("CONSTRUCTIVE") || name.starts_with("CONSTRUCTION") ||
                        name.starts_with("SHAPE_DEFINITION") || name.starts_with("CONTEXT_DEPENDENT") ||
                        name.starts_with("PROPERTY") || name.starts_with("PRESENTATION");
            }
            if (!shape || other) continue;
            const auto fields = fields_of(i);
            if (!fields || !fields->is(1, TokenKind::list)) continue;
            if (const auto context = fields->reference(2, "context");
                !context || !f_.is(*context, Type::GLOBAL_UNIT_ASSIGNED_CONTEXT))
                if (f_.text_of(f_.tokens[x.first]) == "REPRESENTATION") continue;  // properties, no shapes
            node_[i] = std::uint32_t(representations_.size());
            representations_.push_back(i);
        }
        same_.resize(representations_.size());
        std::iota(same_.begin(), same_.end(), 0u);
    }

    // The name, items and context of a representation: of the part that has them, if it is complex.
    std::optional<Fields> fields_of(std::uint32_t i) const {
        const Instance& x = f_.instances[i];
        for (std::uint32_t k = x.first; k + 1 < x.first + x.tokens; k += 2 + f_.tokens[k + 1].size) {
            Fields g(f_, i, k + 1);
            if (g.size() >= 3) return g;
        }
        return std::nullopt;
    }

    std::uint32_t root(std::uint32_t n) {
        while (same_[n] != n) n = same_[n] = same_[same_[n]];
        return n;
    }

    void join_equals() {
        for (std::uint32_t i = 0; i < f_.instances.size(); ++i) {
            if (f_.type(i) != Type::SHAPE_REPRESENTATION_RELATIONSHIP &&
                f_.type(i) != Type::REPRESENTATION_RELATIONSHIP)
                continue;
            const Fields g(f_, i, f_.instances[i].first + 1);
            const auto a = g.reference(2, "representation"), b = g.reference(3, "representation");
            if (!a || !b || node_[*a] == kMissing || node_[*b] == kMissing) continue;
            same_[root(node_[*a])] = root(node_[*b]);
        }
    }

    void make_nodes() {
        std::vector<std::uint32_t> place(representations_.size(), kMissing);
        for (std::uint32_t r = 0; r < representations_.size(); ++r) {
            std::uint32_t& at = place[root(r)];
            if (at == kMissing) {
                at = std::uint32_t(out_.nodes.size());
                out_.nodes.emplace_back();
                fresh_.push_back(true);
            }
        }
        for (std::uint32_t r = 0; r < representations_.size(); ++r) {
            const std::uint32_t n = place[root(r)], i = representations_[r];
            node_[i] = n;
            const auto g = fields_of(i);
            const auto context = g->reference(2, "context");
            const auto items = g->references(1, "items");
            if (!items) {
                out_.refused.push_back(items.error());
                continue;
            }
            Node& node = out_.nodes[n];
            const bool brings_shapes =
                std::any_of(items->begin(), items->end(), [&](std::uint32_t k) { return !is_placement(k); });
            if (context && (fresh_[n] || brings_shapes)) {
                node.context = context_of(f_, *context);
                fresh_[n] = false;
            }
            for (const std::uint32_t k : *items)
                if (!is_placement(k) &&
                    std::find(node.items.begin(), node.items.end(), k) == node.items.end())
                    node.items.push_back(k);
        }
        for (std::uint32_t n = 0; n < out_.nodes.size(); ++n) {
            std::vector<std::uint32_t> rest;
            for (const std::uint32_t k : std::exchange(out_.nodes[n].items, {}))
                if (!f_.is(k, Type::MAPPED_ITEM))
                    rest.push_back(k);
                else if (auto ok = link_mapped(n, k); !ok)
                    out_.refused.push_back(ok.error());
            for (std::uint32_t& k : rest)
                if (f_.is(k, Type::SOLID_REPLICA)) {
                    if (auto ok = replicate(n, k); !ok) out_.refused.push_back(ok.error());
                    k = kMissing;
                }
            std::erase(rest, kMissing);
            out_.nodes[n].items = std::move(rest);
        }
    }
    bool is_placement(std::uint32_t i) const {
        return f_.is(i, Type::AXIS2_PLACEMENT_3D) || f_.is(i, Type::CARTESIAN_POINT);
    }

    Result<Motion> motion_of(std::uint32_t from, std::uint32_t to) {
        const GeometryReader geometry(f_);
        const auto a = geometry.transformation(from), b = geometry.transformation(to);
        if (!a || !b) return std::unexpected(a ? b.error() : a.error());
        Motion source = motion_from(a->to), target = motion_to(b->to);
        target.scale = b->scale / a->scale;
        return target * source;
    }

    Result<void> link_mapped(std::uint32_t n, std::uint32_t item) {
        const auto g = Fields::of(f_, item, Type::MAPPED_ITEM, 3);
        if (!g) return std::unexpected(g.error());
        const auto map = g->reference(1, "map"), target = g->reference(2, "target");
        if (!map || !target) return std::unexpected(map ? target.error() : map.error());
        const Fields m(f_, *map, f_.instances[*map].first + 1);
        const auto origin = m.reference(0, "origin"), of = m.reference(1, "representation");
        if (!origin || !of) return std::unexpected(origin ? of.error() : origin.error());
        if (node_[*of] == kMissing || node_[*of] >= out_.nodes.size())
            return g->refused("maps what is no representation of shapes", RefusalKind::unsupported);
        const auto by = motion_of(*origin, *target);
        if (!by) return std::unexpected(by.error());
        std::vector<int> layers;
        out_.styles.add_layers(layers, item);
        link(n, node_[*of], *by, colour_of(item), std::move(layers));
        return {};
    }
    std::optional<Colour> colour_of(std::uint32_t item) const {
        const auto at = out_.styles.colours.find(item);
        return at == out_.styles.colours.end() ? std::nullopt : std::optional<Colour>(at->second);
    }

    void link(std::uint32_t parent, std::uint32_t child, const Motion& at, std::optional<Colour> colour,
              std::vector<int> layers) {
        if (parent == child) {
            out_.refused.push_back({RefusalKind::invalid, "representation", "contains itself"});
            return;
        }
        out_.nodes[parent].children.push_back({child, at, colour, std::move(layers)});
        out_.nodes[child].has_parent = true;
    }

    // SOLID_REPLICA: another solid in another place, perhaps itself such.
    Result<void> replicate(std::uint32_t n, std::uint32_t item) {
        Motion by;
        std::uint32_t at = item;
        for (int depth = 0; f_.is(at, Type::SOLID_REPLICA); ++depth) {
            const auto g = Fields::of(f_, at, Type::SOLID_REPLICA, 3);
            if (!g) return std::unexpected(g.error());
            if (depth > 100) return g->refused("is a replica of itself, or too deep", RefusalKind::invalid);
            const auto of = g->reference(1, "solid"), to = g->reference(2, "transformation");
            if (!of || !to) return std::unexpected(of ? to.error() : of.error());
            const auto op = GeometryReader(f_).transformation(*to);
            if (!op) return std::unexpected(op.error());
            Motion m = motion_to(op->to);
            m.scale = op->scale;
            by = by * m;
            at = *of;
        }
        out_.nodes[n].replicas.push_back({at, by});
        return {};
    }

    // Through references to an instance of the type, a few steps.
    std::uint32_t find_below(std::uint32_t i, Type type, int depth) const {
        std::vector<std::uint32_t> level{i};
        for (int d = 0; d <= depth && level.size() < 100; ++d) {
            std::vector<std::uint32_t> next;
            for (const std::uint32_t k : level) {
                if (f_.is(k, type)) return k;
                const Instance& x = f_.instances[k];
                for (std::uint32_t t = x.first; t < x.first + x.tokens; ++t)
                    if (f_.tokens[t].kind == TokenKind::reference && f_.tokens[t].at != kMissing)
                        next.push_back(f_.tokens[t].at);
            }
            level = std::move(next);
        }
        return kMissing;
    }

    // PRODUCT <- .. PRODUCT_DEFINITION <- PRODUCT_DEFINITION_SHAPE <- SHAPE_DEFINITION_REPRESENTATION
    void name_products() {
        of_definition_.assign(f_.instances.size(), kMissing);
        for (std::uint32_t i = 0; i < f_.instances.size(); ++i) {
            if (f_.type(i) != Type::SHAPE_DEFINITION_REPRESENTATION) continue;
            const Fields g(f_, i, f_.instances[i].first + 1);
            const auto of = g.reference(0, "definition"), shape = g.reference(1, "representation");
            if (!of || !shape || node_[*shape] == kMissing) continue;
            const std::uint32_t list = f_.part(*of, Type::PRODUCT_DEFINITION_SHAPE);
            if (list == kMissing) continue;
            const auto definition = Fields(f_, *of, list).reference(2, "definition");
            if (!definition) continue;
            const std::string_view name = f_.text_of(f_.tokens[f_.instances[*definition].first]);
            if (!name.starts_with("PRODUCT_DEFINITION")) continue;
            Node& node = out_.nodes[node_[*shape]];
            node.product = true;
            of_definition_[*definition] = node_[*shape];
            if (const std::uint32_t p = find_below(*definition, Type::PRODUCT, 3); p != kMissing) {
                const Fields product(f_, p, f_.part(p, Type::PRODUCT));
                node.name = product.string(1).empty() ? product.string(0) : product.string(1);
            }
        }
    }

    void link_assemblies() {
        for (std::uint32_t i = 0; i < f_.instances.size(); ++i) {
            const std::uint32_t list = f_.part(i, Type::REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION);
            if (list == kMissing) continue;
            relations_.push_back(i);
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> usage;  // relation, usage
        for (std::uint32_t i = 0; i < f_.instances.size(); ++i) {
            if (f_.type(i) != Type::CONTEXT_DEPENDENT_SHAPE_REPRESENTATION) continue;
            const Fields g(f_, i, f_.instances[i].first + 1);
            const auto relation = g.reference(0, "relation"), shape = g.reference(1, "product");
            if (!relation || !shape) continue;
            const std::uint32_t l = f_.part(*shape, Type::PRODUCT_DEFINITION_SHAPE);
            if (l == kMissing) continue;
            if (const auto of = Fields(f_, *shape, l).reference(2, "definition"))
                usage.push_back({*relation, *of});
        }
        sort(usage.begin(), usage.end());
        for (const std::uint32_t i : relations_)
            if (auto ok = link_relation(i, usage); !ok) out_.refused.push_back(ok.error());
    }

    Result<void> link_relation(std::uint32_t i,
                               const std::vector<std::pair<std::uint32_t, std::uint32_t>>& usage) {
        const std::uint32_t list = f_.part(i, Type::REPRESENTATION_RELATIONSHIP);
        const Fields with(f_, i, f_.part(i, Type::REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION));
        if (list == kMissing) return with.refused("is a relation without representations");
        const Fields g(f_, i, list);
        const auto one = g.reference(2, "representation"), two = g.reference(3, "representation");
        const auto by = with.reference(with.size() - 1, "transformation");
        if (!one || !two || !by) return std::unexpected(!one ? one.error() : !two ? two.error() : by.error());
        if (node_[*one] == kMissing || node_[*two] == kMissing) return {};  // of drawings and the like
        const auto t = Fields::of(f_, *by, Type::ITEM_DEFINED_TRANSFORMATION, 4);
        if (!t) return std::unexpected(t.error());
        const auto first = t->reference(2, "item"), second = t->reference(3, "item");
        if (!first || !second) return std::unexpected(first ? second.error() : first.error());
        std::uint32_t child = node_[*one], parent = node_[*two], from = *first, to = *second;
        const auto at = std::lower_bound(usage.begin(), usage.end(), std::pair(i, 0u));
        bool swapped = false;
        if (at != usage.end() && at->first == i && f_.is(at->second, Type::NEXT_ASSEMBLY_USAGE_OCCURRENCE)) {
            const Fields u(f_, at->second, f_.part(at->second, Type::NEXT_ASSEMBLY_USAGE_OCCURRENCE));
            const auto assembly = u.reference(3, "assembly"), part = u.reference(4, "component");
            if (assembly && part) {
                const std::uint32_t a = of_definition_[*assembly], b = of_definition_[*part];
                swapped = a == child && b == parent && a != b;
            }
        }
        if (swapped) std::swap(child, parent), std::swap(from, to);
        // The placements belong to the representations that contain them, whatever their order.
        if (contains(*one, *second) && contains(*two, *first) &&
            !(contains(*one, *first) && contains(*two, *second)))
            std::swap(from, to);
        const auto motion = motion_of(from, to);
        if (!motion) return std::unexpected(motion.error());
        link(parent, child, *motion, std::nullopt, {});
        return {};
    }
    bool contains(std::uint32_t representation, std::uint32_t item) const {
        const auto g = fields_of(representation);
        const auto items = g ? g->references(1, "items") : Result<std::vector<std::uint32_t>>();
        return g && items && std::find(items->begin(), items->end(), item) != items->end();
    }

    const File& f_;
    Structure out_;
    std::vector<std::uint32_t> node_;  // of each instance: first its representation, then its node
    std::vector<std::uint32_t> representations_, same_, of_definition_, relations_;
    std::vector<bool> fresh_;
};

}  // namespace

Structure structure_of(const File& file, std::vector<Layer> layers) {
    return Structurer(file).run(std::move(layers));
}

}  // namespace freiform::step
