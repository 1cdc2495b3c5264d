// Layers. A PRESENTATION_LAYER_ASSIGNMENT names a layer and lists items; the same name elsewhere is the same
// layer. Items are shapes, or styles of shapes, which stand for what they style.
//
// Cost: linear in the file. Items carry numbers of layers, not names, so that a long name on many faces is
// kept once; an item is on kMostLayers at most.
#include "step_structure.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>

namespace freiform::step {

void Styles::add_layers(std::vector<int>& to, std::uint32_t item) const {
    const auto known = on_layers.find(item);
    if (known == on_layers.end()) return;
    to = joined_layers(to, known->second);
}

std::vector<int> Styles::joined_layers(const std::vector<int>& a, const std::vector<int>& b) const {
    std::vector<int> out;
    std::ranges::set_union(a, b, std::back_inserter(out));
    if (out.size() > kMostLayers) {
        left_out += out.size() - kMostLayers;
        out.resize(kMostLayers);
    }
    return out;
}

void read_layers(const File& f, Structure& out) {
    Styles& styles = out.styles;
    std::unordered_map<std::string, int> known;
    for (const Layer& l : styles.layers) known.emplace(l.name, int(known.size()));
    for (std::uint32_t i = 0; i < f.instances.size(); ++i) {
        if (f.type(i) != Type::PRESENTATION_LAYER_ASSIGNMENT) continue;
        const Fields g(f, i, f.part(i, Type::PRESENTATION_LAYER_ASSIGNMENT));
        const auto items = g.references(2, "items");
        if (!items) {
            out.refused.push_back(items.error());
            continue;
        }
        const auto [at, fresh] = known.emplace(g.string(0), int(styles.layers.size()));
        if (fresh) styles.layers.push_back({at->first, {}});
        std::string& description = styles.layers[std::size_t(at->second)].description;
        if (description.empty()) description = g.string(1);
        for (std::uint32_t item : *items) {
            for (const Type t : {Type::STYLED_ITEM, Type::OVER_RIDING_STYLED_ITEM})
                if (const std::uint32_t list = f.part(item, t); list != kMissing)
                    if (const auto styled = Fields(f, item, list).reference(2, "item")) item = *styled;
            styles.on_layers[item].push_back(at->second);
        }
    }
    for (auto& [item, layers] : styles.on_layers) {
        sort(layers);
        layers.erase(std::ranges::unique(layers).begin(), layers.end());
        if (layers.size() <= kMostLayers) continue;
        out.approximations.push_back(
            {f.label(item), text("is on ", layers.size(), " layers; ", kMostLayers, " of them are kept"), 0});
        layers.resize(kMostLayers);
    }
}

}  // namespace freiform::step
