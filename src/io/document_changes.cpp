// What reading changed in the patches of a document: knots inserted for weights of zero and below.
//
// Why not carried along by the readers? All of them, down to the curve of a coedge, would hand it on for the
// sake of weights that almost no document has. The patches with such weights are read once more instead.
#include "document_detail.hpp"

#include <iterator>

namespace freiform::document_detail {

namespace {

struct Weights {
    std::size_t levels = 0;  // nested arrays
    bool all_positive = true;
};

Weights looked_at(json::Value v) {
    Weights w;
    if (!v.is(json::Kind::array)) {
        w.all_positive = !v.is(json::Kind::number) || v.number() > 0;
        return w;
    }
    for (const json::Value element : v.elements()) {
        const Weights inner = looked_at(element);
        w.levels = inner.levels + 1;
        w.all_positive = w.all_positive && inner.all_positive;
    }
    return w;
}

void collect(json::Value v, const std::string& where, std::vector<Approximation>& out);

// Nets are long and hold no objects.
void collect_inside(json::Value v, const std::string& where, std::vector<Approximation>& out) {
    if (v.is(json::Kind::array)) {
        std::size_t i = 0;
        for (const json::Value element : v.elements()) {
            if (element.is(json::Kind::number)) return;
            collect(element, text(where, "[", i++, "]"), out);
        }
        return;
    }
    for (const json::Member& m : v.members())
        if (m.key != "points" && m.key != "weights" && m.key != "weighted_points" && m.key != "knots")
            collect(m.value, text(where, where.empty() ? "" : ".", m.key), out);
}

// Recursion ends: texts deeper than json::kMaxDepth have been refused.
void collect(json::Value v, const std::string& where, std::vector<Approximation>& out) {
    if (!v.is(json::Kind::array) && !v.is(json::Kind::object)) return;
    collect_inside(v, where, out);
    if (!v.is(json::Kind::object)) return;
    for (const json::Member& m : v.members()) {
        if (m.key != "weights") continue;
        const Weights w = looked_at(m.value);
        if (w.all_positive) return;
        const auto read = w.levels == 1   ? read_patch<1>(v)
                          : w.levels == 2 ? read_patch<2>(v)
                                          : read_patch<3>(v);
        if (read && read->inserted > 0)
            out.push_back({where,
                           text(read->inserted, read->inserted == 1 ? " knot" : " knots",
                                " inserted to make all weights positive"),
                           read->moved, 0});
    }
}

}  // namespace

std::vector<Approximation> changes_in(json::Value object) {
    std::vector<Approximation> out;
    collect(object, "", out);
    return out;
}

}  // namespace freiform::document_detail
