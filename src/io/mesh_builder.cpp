#include "io/mesh_builder.hpp"

#include <freiform/core/scan.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace freiform {
namespace {

std::uint64_t mixed(std::uint64_t h, std::uint64_t x) {
    h = (h ^ x) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

std::uint64_t hash_of(const Vec<3>& p, std::uint64_t seed) {
    for (double x : p.c) seed = mixed(seed, std::bit_cast<std::uint64_t>(x));
    return mixed(seed, 0);
}

// -0 becomes 0, so that equal points have equal bits.
Vec<3> without_minus_zero(Vec<3> p) {
    for (double& x : p.c) x += 0.0;
    return p;
}

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

void IndexTable::grow() {
    std::vector<Slot> old = std::move(slots_);
    slots_.assign(std::max<std::size_t>(64, 2 * old.size()), {});
    for (const Slot& slot : old) {
        if (slot.index < 0) continue;
        std::size_t at = slot.hash & (slots_.size() - 1);
        while (slots_[at].index >= 0) at = (at + 1) & (slots_.size() - 1);
        slots_[at] = slot;
    }
}

void MeshBuilder::end_part() {
    part_.count = int(mesh_.triangles.size()) - part_.first;
    if (part_.count > 0) mesh_.parts.push_back(part_);
}

void MeshBuilder::begin_part(const std::string& name, const std::optional<Colour>& colour) {
    end_part();
    part_ = {name, colour, int(mesh_.triangles.size()), 0, -1};
    part_vertices_ = mesh_.vertices.size();
}

int MeshBuilder::point(Vec<3> p) {
    p = without_minus_zero(p);
    const int next = int(mesh_.points.size());
    const int i =
        points_.find_or_add(hash_of(p, 1), next, [&](int k) { return mesh_.points[std::size_t(k)] == p; });
    if (i == next) mesh_.points.push_back(p);
    return i;
}

int MeshBuilder::vertex(int point, const Vec<3>& normal) {
    const Vec<3> n = is_finite(normal) ? without_minus_zero(unit(normal)) : Vec<3>{};
    const int next = int(mesh_.vertices.size());
    const std::uint64_t hash = hash_of(n, mixed(part_vertices_, std::uint64_t(point)));
    const int i = vertices_.find_or_add(hash, next, [&](int k) {
        const MeshVertex& v = mesh_.vertices[std::size_t(k)];
        return std::size_t(k) >= part_vertices_ && v.point == point && v.normal == n;
    });
    if (i == next) mesh_.vertices.push_back({point, n, {}});
    return i;
}

Result<void> MeshBuilder::triangle(const std::string& where, int a, int b, int c) {
    if (!room_for(1))
        return refuse(RefusalKind::limit, where,
                      text("more than ", options_.max_triangles, " triangles, the limit"));
    mesh_.triangles.push_back({a, b, c});
    return {};
}

TriangleMesh MeshBuilder::finish(std::string unit) {
    end_part();
    mesh_.unit = std::move(unit);
    return std::move(mesh_);
}

std::string_view Words::next() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    word_ = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(word_, at_ - word_);
}

std::string_view Words::rest_of_line() {
    const std::size_t begin = at_;
    at_ = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(begin, at_ - begin);
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    return line;
}

std::string Words::where() const {
    return text(file_, ":", 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(word_), '\n'));
}

Result<double> Words::number() {
    const std::string_view word = next();
    if (const auto x = scan_number<double>(word)) return *x;
    return refuse_here(text("expected a finite number, found ", shown(word)));
}

Result<long long> Words::integer() {
    const std::string_view word = next();
    if (const auto x = scan_number<long long>(word)) return *x;
    return refuse_here(text("expected an integer, found ", shown(word)));
}

bool equal_words(std::string_view word, std::string_view lower_case) {
    return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b; });
}

std::string shown(std::string_view word) {
    if (word.empty()) return "the end";
    std::string out = "\"";
    for (char c : word.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
    return out + (word.size() > 40 ? "...\"" : "\"");
}

}  // namespace freiform
