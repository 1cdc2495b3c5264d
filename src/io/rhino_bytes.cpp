#include "rhino_bytes.hpp"

#include <freiform/core/utf8.hpp>

#include <algorithm>
#include <array>

namespace freiform::rhino {

namespace {

void append_utf8(std::string& s, std::uint32_t c) {
    if (c < 0x80) return void(s += char(c));
    const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    constexpr std::array<std::uint32_t, 4> kFirst{0, 0xC0, 0xE0, 0xF0};
    s += char(kFirst[std::size_t(more)] | c >> (6 * more));
    for (int i = more - 1; i >= 0; --i) s += char(0x80 | (c >> (6 * i) & 0x3F));
}

struct Known {
    std::string_view uuid;
    ClassName name;
};

// Programs write the numbers of their own classes for the same bytes, old ones those of their time.
constexpr std::array kKnown = std::to_array<Known>({
    {"4ED7D4DD-E947-11D3-BFE5-0010830122F0", {Kind::nurbs_curve, "a NURBS curve"}},
    {"5EAF1119-0B51-11D4-BFFE-0010830122F0", {Kind::nurbs_curve, "a NURBS curve"}},
    {"76A709D5-1550-11D4-8000-0010830122F0", {Kind::nurbs_curve, "a NURBS curve"}},
    {"4ED7D4DB-E947-11D3-BFE5-0010830122F0", {Kind::line_curve, "a line"}},
    {"CF33BE2A-09B4-11D4-BFFB-0010830122F0", {Kind::arc_curve, "an arc"}},
    {"4ED7D4E6-E947-11D3-BFE5-0010830122F0", {Kind::polyline_curve, "a polyline"}},
    {"4ED7D4E0-E947-11D3-BFE5-0010830122F0", {Kind::poly_curve, "a polycurve"}},
    {"EF638317-154B-11D4-8000-0010830122F0", {Kind::poly_curve, "a polycurve"}},
    {"4ED7D4DE-E947-11D3-BFE5-0010830122F0", {Kind::nurbs_surface, "a NURBS surface"}},
    {"4760C817-0BE3-11D4-BFFE-0010830122F0", {Kind::nurbs_surface, "a NURBS surface"}},
    {"FA4FD4B5-1613-11D4-8000-0010830122F0", {Kind::nurbs_surface, "a NURBS surface"}},
    {"4ED7D4DF-E947-11D3-BFE5-0010830122F0", {Kind::plane_surface, "a plane"}},
    {"A16220D3-163B-11D4-8000-0010830122F0", {Kind::rev_surface, "a surface of revolution"}},
    {"0A8401B6-4D34-4B99-8615-1B4E723DC4E5", {Kind::rev_surface, "a surface of revolution"}},
    {"C4CD5359-446D-4690-9FF5-29059732472B", {Kind::sum_surface, "a sum of two curves"}},
    {"665F6331-2A66-4CCE-81D0-B5EEBD9B5417", {Kind::sum_surface, "a sum of two curves"}},
    {"36F53175-72B8-4D47-BF1F-B4E6FC24F4B9", {Kind::extrusion, "an extrusion"}},
    {"60B5DBC5-E660-11D3-BFE4-0010830122F0", {Kind::brep, "a polysurface"}},
    {"F06FC243-A32A-4608-9DD8-A7D2C4CE2A36", {Kind::brep, "a polysurface"}},
    {"0705FDEF-3E2A-11D4-800E-0010830122F0", {Kind::brep, "a trimmed surface"}},
    {"2D4CFEDB-3E2A-11D4-800E-0010830122F0", {Kind::brep, "a polysurface"}},
    {"F9CFB638-B9D4-4340-87E3-C56E7865D96A", {Kind::instance, "an instance of a block"}},
    {"4ED7D4E4-E947-11D3-BFE5-0010830122F0", {Kind::left_out, "mesh"}},
    {"F09BA4D9-455B-42C3-BA3B-E6CCACEF853B", {Kind::left_out, "subdivision surface"}},
    {"C3101A1D-F157-11D3-BFE7-0010830122F0", {Kind::bare, "point"}},
    {"2488F347-F8FA-11D3-BFEC-0010830122F0", {Kind::bare, "cloud of points"}},
    {"4ED7D4E5-E947-11D3-BFE5-0010830122F0", {Kind::bare, "grid of points"}},
    {"06936AFB-3D3C-41AC-BF70-C9319FA480A1", {Kind::bare, "cage"}},
    {"D379E6D8-7C31-4407-A913-E3B7040D034A", {Kind::bare, "control of a deformation"}},
    {"4ED7D4D8-E947-11D3-BFE5-0010830122F0", {Kind::bare, "curve on a surface"}},
    {"39FF3DD3-FE0F-4807-9D59-185F0D73C0E4", {Kind::bare, "chain of edges"}},
    {"DBC5A584-CE3F-4170-98A8-497069CA5C36", {Kind::passed_over, "a clipping plane"}},
    {"85A08513-F383-11D3-BFE7-0010830122F0", {Kind::passed_over, "a light"}},
    {"0559733B-5332-49D1-A936-0532AC76ADE5", {Kind::passed_over, "a hatch"}},
    {"C8C66EFA-B3CB-4E00-9440-2AD66203379E", {Kind::passed_over, "a view"}},
    {"74198302-CDF4-4F95-9609-6D684F22AB37", {Kind::passed_over, "a text"}},
    {"57376349-62A9-4A16-B411-A46BCD544790", {Kind::passed_over, "a text"}},
    {"945BF594-6FF9-4F5C-BFC0-B3AF528F29D2", {Kind::passed_over, "a leader"}},
    {"E550882B-F44D-4154-A1EF-6E50CBBBF543", {Kind::passed_over, "a dimension"}},
    {"D417786B-F6CD-4F12-9E1F-063F414DBEB6", {Kind::passed_over, "a dimension"}},
    {"FC749C2F-4C00-41FD-9840-26D94F047AD3", {Kind::passed_over, "a dimension"}},
    {"03124828-4C9B-4D28-9A82-664DDDE7A14F", {Kind::passed_over, "a dimension"}},
    {"D46767BA-7E8F-4D9D-9A92-66050219A5B9", {Kind::passed_over, "a dimension"}},
    {"B2B683FC-7964-4E96-B1F9-9B356A76B08B", {Kind::passed_over, "a dimension"}},
    {"841BC40B-A971-4A8E-94E5-BBA26D67348E", {Kind::passed_over, "a dimension"}},
    {"46F75541-F46B-48BE-AA7E-B353BBE068A7", {Kind::passed_over, "a text"}},
    {"14922B7A-5B65-4F11-8345-D415A9637129", {Kind::passed_over, "a leader"}},
    {"C8288D69-5BD8-4F50-9BAF-525A0086B0C3", {Kind::passed_over, "a dimension"}},
    {"BD57F33B-A1B2-46E9-9C6E-AF09D30FFDDE", {Kind::passed_over, "a dimension"}},
    {"8D820224-BC6C-46B4-9066-BF39CC13AEFB", {Kind::passed_over, "an annotation"}},
    {"5DE6B20D-486B-11D4-8014-0010830122F0", {Kind::passed_over, "a dimension"}},
    {"5DE6B20E-486B-11D4-8014-0010830122F0", {Kind::passed_over, "a dimension"}},
    {"5DE6B20F-486B-11D4-8014-0010830122F0", {Kind::passed_over, "a dimension"}},
    {"5DE6B210-486B-11D4-8014-0010830122F0", {Kind::passed_over, "a text"}},
    {"5DE6B211-486B-11D4-8014-0010830122F0", {Kind::passed_over, "a leader"}},
    {"8BD94E19-59E1-11D4-8018-0010830122F0", {Kind::passed_over, "a text"}},
    {"ABAF5873-4145-11D4-800F-0010830122F0", {Kind::passed_over, "an annotation"}},
});

}  // namespace

std::string Bytes::uuid() {
    constexpr std::array kOrder{3, 2, 1, 0, 5, 4, 7, 6, 8, 9, 10, 11, 12, 13, 14, 15};
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::array<int, 16> raw{};
    for (int& x : raw) x = u8();
    std::string s;
    for (std::size_t i = 0; i < 16; ++i) {
        const auto x = std::size_t(raw[std::size_t(kOrder[i])]);
        if (i == 4 || i == 6 || i == 8 || i == 10) s += '-';
        s += kDigits[x >> 4], s += kDigits[x & 15];
    }
    return s;
}

std::string Bytes::wide_string() {
    std::string s;
    const int n = count(2);
    for (int i = 0; i < n; ++i) {
        std::uint32_t c = get<std::uint16_t>();
        if (c == 0) {  // the last one
            skip(2 * std::size_t(n - i - 1));
            break;
        }
        if (c >= 0xD800 && c < 0xE000) {
            Bytes ahead = *this;
            const std::uint32_t low = i + 1 < n ? ahead.get<std::uint16_t>() : 0;
            const bool pair = c < 0xDC00 && low >= 0xDC00 && low < 0xE000;
            c = pair ? 0x10000 + ((c - 0xD800) << 10) + (low - 0xDC00) : 0xFFFD;
            if (pair) *this = ahead, ++i;
        }
        append_utf8(s, c);
    }
    return s;
}

std::string Bytes::narrow_string() {
    const int n = count(1);
    std::string raw(s_.substr(at_, std::size_t(n)));
    skip(std::size_t(n));
    raw.resize(std::min(raw.size(), raw.find('\0')));
    bool is_utf8 = true;
    for (std::string_view rest = raw; is_utf8 && !rest.empty();) {
        const std::size_t k = utf8_length(rest);
        is_utf8 = k > 0;
        rest.remove_prefix(k);
    }
    if (is_utf8) return raw;
    std::string s;
    for (const char c : raw) append_utf8(s, static_cast<unsigned char>(c));
    return s;
}

std::uint32_t Bytes::peek_type() const { return Bytes(*this).get<std::uint32_t>(); }

Chunk Bytes::chunk() {
    Chunk c;
    const std::size_t begin = at_;
    c.type = get<std::uint32_t>();
    c.value = wide_ ? get<std::int64_t>() : get<std::int32_t>();
    if (failed_) return c;
    if (c.is_short()) return inside_.emplace_back(begin, at_), c;
    if (c.value < 0 || std::uint64_t(c.value) > left()) return fail(), c;
    const auto length = std::size_t(c.value);
    const std::size_t sum = checked_ && (c.type & tag::kChecked) != 0 ? 4 : 0;
    if (length < sum) return fail(), c;
    c.body = Bytes(s_.substr(at_, length - sum), start_ + at_, wide_, checked_);
    at_ += length - sum;
    if (sum > 0) c.body.sum_ = get<std::uint32_t>();
    inside_.emplace_back(begin, at_);
    return c;
}

Result<void> Bytes::check_sum() const {
    static constexpr auto kTable = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t x = i;
            for (int k = 0; k < 8; ++k) x = x >> 1 ^ (x & 1 ? 0xEDB88320 : 0);
            table[i] = x;
        }
        return table;
    }();
#if defined(FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION)
    return {};
#endif
    if (!sum_) return {};
    std::uint32_t x = 0xFFFFFFFF;
    const auto add = [&](std::size_t from, std::size_t to) {
        for (const char c : s_.substr(from, to - from))
            x = x >> 8 ^ kTable[(x ^ static_cast<unsigned char>(c)) & 0xFF];
    };
    std::size_t from = 0;
    for (const auto& [begin, end] : inside_) add(from, begin), from = end;
    add(from, s_.size());
    if (~x == *sum_) return {};
    return refuse(RefusalKind::unreadable, text("byte ", start_), "is damaged: its checksum is another");
}

std::unexpected<Refusal> ends_early(const Bytes& b, std::string_view what) {
    return refuse(RefusalKind::unreadable, text("byte ", b.at()),
                  text(what, " ends too early, or counts more than it has"));
}

std::unexpected<Refusal> invalid(const Bytes& b, std::string message) {
    return refuse(RefusalKind::invalid, text("byte ", b.at()), std::move(message));
}

ClassName class_named(std::string_view uuid) {
    for (const Known& k : kKnown)
        if (k.uuid == uuid) return k.name;
    return {};
}

Result<StoredObject> object_in(Chunk chunk) {
    StoredObject o;
    Bytes& b = chunk.body;
    if (chunk.type != tag::kClass)
        return refuse(RefusalKind::unreadable, text("byte ", b.at()), "expected an object");
    Chunk id = b.chunk();
    o.uuid = id.body.uuid();
    Chunk data = b.chunk();
    if (b.failed() || id.body.failed() || id.type != tag::kClassId || data.type != tag::kClassData)
        return refuse(RefusalKind::unreadable, text("byte ", b.at()), "expected the class of an object");
    o.of = class_named(o.uuid);
    o.data = data.body;
    return o;
}

}  // namespace freiform::rhino
