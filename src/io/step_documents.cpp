// Idea. An assembly may leave the shape of a part to another file. Then the part has a representation that is
// empty but for a placement, and a property of a DOCUMENT_FILE points at it:
//
//     APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT (its name) -> DOCUMENT_FILE
//       <- PROPERTY_DEFINITION <- PROPERTY_DEFINITION_REPRESENTATION -> SHAPE_REPRESENTATION
//
// Files without that property say which product the document belongs to. A part that has a shape here keeps
// it: its documents are drawings, or say the same once more.
//
// Reference: CAx-IF Recommended Practices for External References, 2.1.
#include "step_structure.hpp"

#include <algorithm>

namespace freiform::step {

namespace {

class DocumentReader {
public:
    DocumentReader(const File& f, std::span<const std::uint32_t> node,
                   std::span<const std::uint32_t> of_definition, Structure& out)
        : f_(f), node_(node), of_definition_(of_definition), out_(out) {}

    void run() {
        for (const Type t :
             {Type::DOCUMENT_FILE, Type::APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT,
              Type::PROPERTY_DEFINITION_REPRESENTATION, Type::PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS,
              Type::APPLIED_DOCUMENT_REFERENCE}) {
            for (std::uint32_t i = 0; i < f_.instances.size(); ++i)
                if (const std::uint32_t list = f_.part(i, t); list != kMissing)
                    take(t, i, Fields(f_, i, list));
            if (known_.empty()) return;
        }
    }

private:
    void take(Type t, std::uint32_t i, const Fields& g) {
        if (t == Type::DOCUMENT_FILE) {
            known_.emplace(i, std::uint32_t(out_.documents.size()));
            out_.documents.push_back({i, {}});
            add_name(out_.documents.back(), g.string(0));
        } else if (t == Type::APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT) {
            for (const std::uint32_t item : list_of(g, 3))
                if (const auto d = known_.find(item); d != known_.end())
                    add_name(out_.documents[d->second], g.string(0));
        } else if (t == Type::PROPERTY_DEFINITION_REPRESENTATION) {
            const auto property = g.reference(0, "property"), shape = g.reference(1, "representation");
            const std::uint32_t list = property ? f_.part(*property, Type::PROPERTY_DEFINITION) : kMissing;
            if (list == kMissing || !shape) return;
            const auto of = Fields(f_, *property, list).reference(2, "definition");
            if (of) set(node_[*shape], *of);
        } else if (t == Type::APPLIED_DOCUMENT_REFERENCE) {
            const auto document = g.reference(0, "document");
            for (const std::uint32_t item : list_of(g, 2))
                if (document) set(of_definition_[item], *document);
        } else {
            for (const std::uint32_t document : list_of(g, 4)) set(of_definition_[i], document);
        }
    }

    static std::vector<std::uint32_t> list_of(const Fields& g, int i) {
        auto all = g.references(i, "items");
        return all ? std::move(*all) : std::vector<std::uint32_t>();
    }

    void add_name(Document& d, std::string name) {
        if (!name.empty() && std::ranges::find(d.names, name) == d.names.end())
            d.names.insert(d.names.begin(), std::move(name));
    }

    void set(std::uint32_t n, std::uint32_t document) {
        const auto d = known_.find(document);
        if (n >= out_.nodes.size() || d == known_.end() || out_.documents[d->second].names.empty()) return;
        Node& node = out_.nodes[n];
        if (node.items.empty() && node.replicas.empty() && node.children.empty() && node.document == kMissing)
            node.document = d->second;
    }

    const File& f_;
    std::span<const std::uint32_t> node_, of_definition_;
    Structure& out_;
    std::unordered_map<std::uint32_t, std::uint32_t> known_;  // documents by instance
};

}  // namespace

void read_documents(const File& file, std::span<const std::uint32_t> node,
                    std::span<const std::uint32_t> of_definition, Structure& out) {
    DocumentReader(file, node, of_definition, out).run();
}

std::vector<std::string> paths_beside(std::string_view folder, std::string name) {
    std::ranges::replace(name, '\\', '/');
    while (name.starts_with("./")) name.erase(0, 2);
    const std::string last = name.substr(name.rfind('/') + 1);
    std::vector<std::string> out;
    if (name != last && !name.starts_with('/') && name.find(':') == name.npos && name.find("..") == name.npos)
        out.push_back(std::string(folder) + name);
    out.push_back(std::string(folder) + last);
    return out;
}

}  // namespace freiform::step
