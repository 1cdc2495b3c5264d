// The bytes of 3DM files: numbers, and chunks of a type and a length that contain others.
//
// What is read beyond the end of its chunk, or counts more than the chunk can have, is 0 and remembered: the
// reader of a chunk asks once, when it is through. So no count in a file makes memory be taken beyond a
// multiple of its size.
//
// Chunks of newer programs may have more than is known of them: what follows is passed over.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/vec.hpp>

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace freiform::rhino {

// Types of chunks.
namespace tag {
inline constexpr std::uint32_t kShort = 0x80000000, kChecked = 0x8000;
inline constexpr std::uint32_t kSettings = 0x10000015, kUnits = 0x20008031;
inline constexpr std::uint32_t kLayers = 0x10000011, kLayer = 0x20008050;
inline constexpr std::uint32_t kDefinitions = 0x10000021, kDefinition = 0x20008076;
inline constexpr std::uint32_t kObjects = 0x10000013, kObject = 0x20008070, kAttributes = 0x02008072;
inline constexpr std::uint32_t kClass = 0x00027FFA, kClassId = 0x0002FFFB, kClassData = 0x0002FFFC;
inline constexpr std::uint32_t kAnonymous = 0x40008000, kEndOfFile = 0x00007FFF;
}  // namespace tag

class Bytes;
struct Chunk;

class Bytes {
public:
    // `wide`: lengths of chunks have eight bytes. `checked`: chunks may end with a checksum.
    Bytes(std::string_view bytes, std::size_t at, bool wide, bool checked)
        : s_(bytes), start_(at), wide_(wide), checked_(checked) {}

    std::size_t left() const { return s_.size() - at_; }
    std::size_t at() const { return start_ + at_; }  // counted from the beginning of the file
    bool failed() const { return failed_; }
    void fail() { failed_ = true, at_ = s_.size(); }

    // Little-endian.
    template <class T>
    T get() {
        T x{};
        if (left() < sizeof(T)) return fail(), x;
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bits |= std::uint64_t(static_cast<unsigned char>(s_[at_ + i])) << (8 * i);
        at_ += sizeof(T);
        if constexpr (std::is_same_v<T, double>)
            return std::bit_cast<double>(bits);
        else
            return T(bits);
    }
    int i32() { return get<std::int32_t>(); }
    int u8() { return get<std::uint8_t>(); }
    double f64() { return get<double>(); }
    Vec<3> point() {
        Vec<3> p;
        for (double& x : p.c) x = f64();
        return p;
    }
    Interval interval() {
        const double lo = f64();
        return {lo, f64()};
    }
    void skip(std::size_t bytes) {
        if (left() < bytes) return fail();
        at_ += bytes;
    }
    // A number of things that take at least so many bytes each.
    int count(std::size_t bytes_each) { return counted(i32(), bytes_each); }
    int counted(int n, std::size_t bytes_each) {
        if (n >= 0 && std::size_t(n) <= left() / bytes_each) return n;
        return fail(), 0;
    }
    std::vector<int> indices() {
        std::vector<int> all(std::size_t(count(4)));
        for (int& i : all) i = this->i32();
        return all;
    }
    // "4ED7D4DD-E947-11D3-BFE5-0010830122F0", as such numbers are written.
    std::string uuid();
    // UTF-16 as UTF-8; what is none becomes U+FFFD.
    std::string wide_string();
    // One byte each, as UTF-8 if it is, else as Latin-1.
    std::string narrow_string();

    Chunk chunk();
    std::uint32_t peek_type() const;
    // Refuses (unreadable) other bytes than the checksum says, if the chunk has one. Chunks inside of it do
    // not count: those that have been read until now.
    Result<void> check_sum() const;

    // The first digit of a version in one byte, the second one in `minor`.
    int version(int& minor) {
        const int v = u8();
        minor = v & 15;
        return v >> 4;
    }

private:
    std::string_view s_;
    std::size_t at_ = 0, start_ = 0;
    bool wide_ = false, checked_ = false, failed_ = false;
    std::optional<std::uint32_t> sum_ = {};
    std::vector<std::pair<std::size_t, std::size_t>> inside_ = {};  // chunks: where they begin and end
};

struct Chunk {
    std::uint32_t type = 0;
    std::int64_t value = 0;  // of those that are short
    Bytes body{{}, 0, false, false};
    bool is_short() const { return (type & tag::kShort) != 0; }
};

// What is said of chunks that end too early, and of numbers that contradict each other.
std::unexpected<Refusal> ends_early(const Bytes& b, std::string_view what);
std::unexpected<Refusal> invalid(const Bytes& b, std::string message);

// Classes whose geometry is read, and what others are called.
enum class Kind {
    unknown,
    passed_over,  // views, texts, lights: no geometry of the model
    left_out,     // faces of another kind: meshes, subdivision surfaces
    bare,         // geometry without faces: points
    nurbs_curve,
    line_curve,
    arc_curve,
    polyline_curve,
    poly_curve,
    nurbs_surface,
    plane_surface,
    rev_surface,
    sum_surface,
    extrusion,
    brep,
    instance
};
struct ClassName {
    Kind kind = Kind::unknown;
    std::string_view name;  // such as "a mesh"
};
ClassName class_named(std::string_view uuid);

// An object of some class, as it stands in a chunk.
struct StoredObject {
    ClassName of;
    std::string uuid;
    Bytes data{{}, 0, false, false};
};
// Refuses (unreadable) what is none.
Result<StoredObject> object_in(Chunk chunk);
inline Result<StoredObject> object_in(Bytes& b) { return object_in(b.chunk()); }

}  // namespace freiform::rhino
