// Idea. A reference stands for the instance that its name is given to, which may be a reference again. Each
// is followed once: all that are passed on the way stand for the same, so that long chains take linear time.
//
// References: ISO 10303-21:2016, 9 (anchor section), 10 (reference section).
//
// Why not references to other files? What is referred to, with all that it needs, would have to stand in one
// table with the instances of this file.
#include "step_anchors.hpp"

namespace freiform::step {

namespace {

// What is left of a statement.
class Statement {
public:
    explicit Statement(std::string_view s) : s_(s) {}

    bool sign(char c) {
        skip();
        if (!s_.starts_with(c)) return false;
        s_.remove_prefix(1);
        return true;
    }
    // "<...>" without its brackets.
    std::optional<std::string_view> resource() {
        if (!sign('<')) return std::nullopt;
        const std::size_t end = s_.find('>');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view inside = s_.substr(0, end);
        s_.remove_prefix(end + 1);
        return inside;
    }
    std::optional<std::uint32_t> number() {
        if (!sign('#')) return std::nullopt;
        std::uint64_t n = 0;
        std::size_t digits = 0;
        for (; digits < s_.size() && s_[digits] >= '0' && s_[digits] <= '9'; ++digits)
            n = std::min<std::uint64_t>(n * 10 + std::uint64_t(s_[digits] - '0'), kMissing);
        s_.remove_prefix(digits);
        if (digits == 0 || n >= kMissing) return std::nullopt;
        return std::uint32_t(n);
    }
    bool ends() {
        skip();
        return s_.empty();
    }
    bool has_tags() {
        skip();
        return s_.starts_with('{');
    }

private:
    void skip() {
        for (;;) {
            while (!s_.empty() && (unsigned char)(s_[0]) <= ' ') s_.remove_prefix(1);
            if (!s_.starts_with("/*")) return;
            const std::size_t end = s_.find("*/", 2);
            s_.remove_prefix(end == std::string_view::npos ? s_.size() : end + 2);
        }
    }
    std::string_view s_;
};

std::string shown(std::string_view resource) { return text("<", resource.substr(0, 200), ">"); }

}  // namespace

void Anchors::add_anchor(std::string_view statement, std::size_t at, const Tell& tell) {
    Statement s(statement);
    const auto name = s.resource();
    if (!name || !s.sign('='))
        return tell(RefusalKind::unreadable, 0, at, "an anchor is expected: <name> = an instance");
    auto id = s.number();
    if (id && !s.ends() && !s.has_tags()) id = std::nullopt;
    if (!anchors_.emplace(*name, id.value_or(kMissing)).second)
        tell(RefusalKind::invalid, id.value_or(0), at, text("the anchor ", shown(*name), " is given before"));
}

void Anchors::add_reference(std::string_view statement, std::size_t at, const Tell& tell) {
    Statement s(statement);
    if (s.sign('@'))
        return tell(RefusalKind::unsupported, 0, at, "a reference to a value, which is not read");
    const auto id = s.number();
    const auto resource = id && s.sign('=') ? s.resource() : std::nullopt;
    if (!resource || !s.ends())
        return tell(RefusalKind::unreadable, id.value_or(0), at,
                    "a reference is expected: # and a number = <#name>");
    if (!resource->starts_with('#')) return void(elsewhere_.emplace(*id, Reference{*id, *resource, at}));
    references_.push_back({*id, resource->substr(1), at});
}

void Anchors::resolve(const std::function<std::uint32_t(std::uint32_t)>& place, const Tell& tell) {
    std::unordered_map<std::uint32_t, std::size_t> by_id;
    for (std::size_t k = 0; k < references_.size(); ++k) {
        const Reference& r = references_[k];
        if (place(r.id) != kMissing || !by_id.emplace(r.id, k).second)
            tell(RefusalKind::unreadable, r.id, r.at, "its number is used before");
    }
    constexpr std::size_t kUnseen = 0;
    const auto known = [&](std::uint32_t id) {
        const auto at = places_.find(id);
        return at == places_.end() ? kMissing : at->second;
    };
    std::vector<std::size_t> walk(references_.size(), kUnseen);  // the walk that came along
    for (std::size_t k = 0; k < references_.size(); ++k) {
        if (walk[k] != kUnseen || place(references_[k].id) != kMissing || by_id.at(references_[k].id) != k)
            continue;
        std::vector<std::size_t> path;
        std::uint32_t found = kMissing;
        for (std::size_t at = k;;) {
            const Reference& r = references_[at];
            if (walk[at] != kUnseen) {  // a number that is followed already, perhaps by this walk
                if (walk[at] == k + 1)
                    tell(RefusalKind::invalid, r.id, r.at,
                         text("refers to itself, by ", shown("#" + std::string(r.resource))));
                else
                    found = known(r.id);
                break;
            }
            walk[at] = k + 1;
            path.push_back(at);
            const auto anchor = anchors_.find(r.resource);
            const std::uint32_t to = anchor == anchors_.end() ? kMissing : anchor->second;
            if (to != kMissing) found = place(to);
            if (found != kMissing) break;
            const auto next = to == kMissing ? by_id.end() : by_id.find(to);
            if (next == by_id.end()) {
                const std::string name = shown("#" + std::string(r.resource));
                tell(RefusalKind::invalid, r.id, r.at,
                     anchor == anchors_.end() ? text("refers to ", name, ", which the file does not name")
                     : to == kMissing         ? text("refers to ", name, ", which is no instance")
                                      : text("refers to ", name, ", #", to, ", which is not in the file"));
                break;
            }
            at = next->second;
        }
        if (found != kMissing)
            for (const std::size_t at : path) places_.emplace(references_[at].id, found);
    }
}

std::uint32_t Anchors::place_of(std::uint32_t id, const Tell& tell) {
    if (const auto at = places_.find(id); at != places_.end()) return at->second;
    if (const auto other = elsewhere_.find(id); other != elsewhere_.end()) {
        tell(RefusalKind::unsupported, id, other->second.at,
             text("refers to ", shown(other->second.resource), ", which is in another file"));
        elsewhere_.erase(other);
    }
    return kMissing;
}

}  // namespace freiform::step
