// Faces may name points that follow later in the file, so that they are resolved at the end.
#include "io/mesh_builder.hpp"

#include <freiform/core/scan.hpp>

#include <array>

namespace freiform {
namespace {

struct Corner {
    long long point = 0, normal = -1;  // from 0; -1: none
};

struct ObjFace {
    std::size_t first = 0, line = 0;  // of its corners
};

struct ObjPart {
    std::string name;
    std::optional<Colour> colour;
    std::size_t first_face = 0;
};

class ObjReader {
public:
    ObjReader(const std::string& name, const MeshReadOptions& options) : name_(name), options_(options) {}

    Result<TriangleMesh> read(std::string_view bytes) {
        parts_.push_back({});
        for (std::size_t at = 0; at < bytes.size();) {
            ++line_;
            const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
            std::string_view line = bytes.substr(at, end - at);
            at = end + 1;
            // A backslash continues the line.
            std::string joined;
            std::size_t continued = 0;
            while (ends_with_backslash(line) && at < bytes.size()) {
                const std::size_t next = std::min(bytes.find('\n', at), bytes.size());
                if (continued == 0) joined = line;
                joined.resize(joined.rfind('\\'));
                joined += ' ';
                joined += bytes.substr(at, next - at);
                line = joined;
                at = next + 1;
                ++continued;
            }
            if (auto r = read_line(line); !r) return std::unexpected(r.error());
            line_ += continued;
        }
        return build();
    }

private:
    static bool ends_with_backslash(std::string_view line) {
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line.ends_with('\\');
    }
    std::string where(std::size_t line) const { return text(name_, ":", line); }
    auto refuse_line(std::string message) const {
        return refuse(RefusalKind::unreadable, where(line_), std::move(message));
    }

    Result<void> read_line(std::string_view line) {
        Words words(line, name_);
        const std::string_view key = words.next();
        if (key == "v") return read_vector(words, points_);
        if (key == "vn") return read_vector(words, normals_);
        if (key == "f") return read_face(words);
        if (key == "g" || key == "o") {
            begin_part(std::string(words.rest_of_line()));
        } else if (key == "#") {
            read_comment(words);
        }
        return {};
    }

    void begin_part(std::string name) {
        if (parts_.back().first_face == faces_.size()) parts_.pop_back();
        parts_.push_back({std::move(name), std::nullopt, faces_.size()});
    }

    // Our own writer keeps the unit and the colours in comments.
    void read_comment(Words& words) {
        const std::string_view key = words.next();
        if (key == "unit") unit_ = words.next();
        if (key != "colour") return;
        std::array<double, 4> c;
        for (double& x : c) {
            const auto number = scan_number<double>(words.next());
            if (!number || *number < 0 || *number > 1) return;
            x = *number;
        }
        if (parts_.back().first_face == faces_.size()) parts_.back().colour = Colour{c[0], c[1], c[2], c[3]};
    }

    Result<void> read_vector(Words& words, std::vector<Vec<3>>& out) {
        Vec<3> v;
        for (double& x : v.c) {
            const std::string_view word = words.next();
            const auto number = scan_number<double>(word);
            if (!number) return refuse_line(text("expected three finite numbers, found ", shown(word)));
            x = *number;
        }
        if (out.size() >= kMost)
            return refuse(RefusalKind::limit, where(line_), text("more than ", kMost, " lines of a kind"));
        out.push_back(v);
        return {};
    }

    // "7", "7/2", "7//3", "7/2/3"; from 1, or from the end if negative.
    Result<long long> index(std::string_view word, std::string_view digits, std::size_t count) const {
        const auto i = scan_number<long long>(digits);
        if (!i || *i == 0)
            return refuse_line(
                text("expected an index as in \"7\", \"7//3\" or \"7/2/3\", found ", shown(word)));
        if (*i > 0) return *i - 1;
        if (-*i > (long long)(count))
            return refuse_line(text("index ", *i, " in ", shown(word), ", with ", count, " so far"));
        return (long long)(count) + *i;
    }

    Result<void> read_face(Words& words) {
        const ObjFace face{corners_.size(), line_};
        for (;;) {
            const std::string_view word = words.next();
            if (word.empty() || word.starts_with('#')) break;
            const std::size_t first = std::min(word.find('/'), word.size());
            const std::size_t second = std::min(word.find('/', first + 1), word.size());
            Corner corner;
            const auto p = index(word, word.substr(0, first), points_.size());
            if (!p) return std::unexpected(p.error());
            corner.point = *p;
            if (second < word.size()) {
                const auto n = index(word, word.substr(second + 1), normals_.size());
                if (!n) return std::unexpected(n.error());
                corner.normal = *n;
            }
            corners_.push_back(corner);
        }
        if (corners_.size() - face.first < 3)
            return refuse_line(
                text("a face of ", corners_.size() - face.first, " corners, at least 3 expected"));
        triangles_ += corners_.size() - face.first - 2;
        if (triangles_ > options_.max_triangles)
            return refuse(RefusalKind::limit, where(line_),
                          text("more than ", options_.max_triangles, " triangles, the limit"));
        faces_.push_back(face);
        return {};
    }

    Result<int> vertex(MeshBuilder& builder, const Corner& corner, std::size_t line) const {
        if (std::size_t(corner.point) >= points_.size())
            return refuse(RefusalKind::unreadable, where(line),
                          text("point ", corner.point + 1, ", the file has ", points_.size()));
        if (corner.normal >= 0 && std::size_t(corner.normal) >= normals_.size())
            return refuse(RefusalKind::unreadable, where(line),
                          text("normal ", corner.normal + 1, ", the file has ", normals_.size()));
        const int point = builder.point(points_[std::size_t(corner.point)]);
        return builder.vertex(point, corner.normal < 0 ? Vec<3>{} : normals_[std::size_t(corner.normal)]);
    }

    Result<TriangleMesh> build() {
        MeshBuilder builder(options_);
        std::size_t part = 0;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (part < parts_.size() && parts_[part].first_face == f) {
                builder.begin_part(parts_[part].name, parts_[part].colour);
                ++part;
            }
            const std::size_t end = f + 1 < faces_.size() ? faces_[f + 1].first : corners_.size();
            std::array<int, 3> v{};
            for (std::size_t i = faces_[f].first; i < end; ++i) {
                const auto corner = vertex(builder, corners_[i], faces_[f].line);
                if (!corner) return std::unexpected(corner.error());
                const std::size_t k = i - faces_[f].first;
                v[k == 0 ? 0 : 2] = *corner;
                if (k >= 2)
                    if (auto r = builder.triangle(name_, v[0], v[1], v[2]); !r)
                        return std::unexpected(r.error());
                if (k >= 1) v[1] = v[2];
            }
        }
        return builder.finish(unit_);
    }

    static constexpr std::size_t kMost = 0x7fffffff;
    const std::string& name_;
    const MeshReadOptions& options_;
    std::vector<Vec<3>> points_, normals_;
    std::vector<Corner> corners_;
    std::vector<ObjFace> faces_;
    std::vector<ObjPart> parts_;
    std::string unit_;
    std::size_t line_ = 0;
    std::uint64_t triangles_ = 0;
};

}  // namespace

Result<TriangleMesh> parse_obj(std::string_view bytes, const std::string& name,
                               const MeshReadOptions& options) {
    return ObjReader(name, options).read(bytes);
}

}  // namespace freiform
