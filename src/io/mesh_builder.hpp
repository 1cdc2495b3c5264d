// What the readers of meshes share: welding of equal points, parts, and the words of text files.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/io/mesh_file.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

// Finds equal items by their hash: open addressing, at most half full.
class IndexTable {
public:
    // The index i of an earlier item with is_equal(i), or `next` after entering it.
    template <class IsEqual>
    int find_or_add(std::uint64_t hash, int next, IsEqual&& is_equal) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        std::size_t at = hash & (slots_.size() - 1);
        for (; slots_[at].index >= 0; at = (at + 1) & (slots_.size() - 1))
            if (slots_[at].hash == hash && is_equal(slots_[at].index)) return slots_[at].index;
        slots_[at] = {hash, next};
        ++used_;
        return next;
    }

private:
    struct Slot {
        std::uint64_t hash = 0;
        int index = -1;
    };
    void grow();
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

class MeshBuilder {
public:
    explicit MeshBuilder(const MeshReadOptions& options) : options_(options) {}

    void begin_part(const std::string& name, const std::optional<Colour>& colour);
    // Minus zero counts as zero. REQUIRES finite coordinates.
    int point(Vec<3> p);
    // The vertex of the present part with this normal; a normal that is not finite counts as none.
    int vertex(int point, const Vec<3>& normal);
    // Refuses beyond the limit on triangles; `where` is the file.
    Result<void> triangle(const std::string& where, int a, int b, int c);
    bool room_for(std::uint64_t triangles) const {
        return triangles <= options_.max_triangles &&
               mesh_.triangles.size() <= options_.max_triangles - triangles;
    }
    TriangleMesh finish(std::string unit);

private:
    void end_part();
    MeshReadOptions options_;
    TriangleMesh mesh_;
    IndexTable points_, vertices_;
    std::size_t part_vertices_ = 0;  // vertices of earlier parts
    MeshPart part_;
};

// The words of a text, from first to last.
class Words {
public:
    Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    // The next word, on whatever line; empty at the end.
    std::string_view next();
    // What is left of the line; the next word is on another one.
    std::string_view rest_of_line();
    // "FILE:LINE" of the word read last.
    std::string where() const;
    std::size_t at() const { return at_; }
    void seek(std::size_t at) { at_ = at; }
    auto refuse_here(std::string message) const {
        return refuse(RefusalKind::unreadable, where(), std::move(message));
    }
    Result<double> number();
    Result<long long> integer();

private:
    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0, word_ = 0;
};

bool equal_words(std::string_view word, std::string_view lower_case);
// How a message shows a word of a damaged file: bounded and printable.
std::string shown(std::string_view word);

Result<TriangleMesh> parse_stl(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options);
Result<TriangleMesh> parse_obj(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options);
Result<TriangleMesh> parse_ply(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options);
Result<TriangleMesh> parse_glb(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options);

}  // namespace freiform
