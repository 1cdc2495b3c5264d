// The bytes of 3DM files, put together by hand: what no program at hand writes.
#pragma once
#include <freiform/core/text.hpp>
#include <freiform/core/vec.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::test::rhino {

class Written {
public:
    template <class T>
    Written& number(T x) {
        std::uint64_t bits = 0;
        if constexpr (std::is_same_v<T, double>)
            bits = std::bit_cast<std::uint64_t>(x);
        else
            bits = std::uint64_t(x);
        for (std::size_t i = 0; i < sizeof(T); ++i) bytes += char(bits >> (8 * i) & 255);
        return *this;
    }
    Written& u8(int x) { return number(std::uint8_t(x)); }
    Written& u16(int x) { return number(std::uint16_t(x)); }
    Written& i32(std::int32_t x) { return number(x); }
    Written& f64(double x) { return number(x); }
    Written& f64s(std::initializer_list<double> all) {
        for (const double x : all) f64(x);
        return *this;
    }
    Written& nothing(std::size_t n) {
        bytes.append(n, '\0');
        return *this;
    }
    Written& raw(std::string_view s) {
        bytes += s;
        return *this;
    }
    Written& raw(const Written& w) {
        for (const auto& [begin, end] : w.inside_)
            inside_.emplace_back(bytes.size() + begin, bytes.size() + end);
        return raw(w.bytes);
    }
    // "4ED7D4DB-E947-11D3-BFE5-0010830122F0"
    Written& uuid(std::string_view s) {
        std::string hex;
        for (const char c : s)
            if (c != '-') hex += c;
        const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'A' + 10; };
        for (const int i : {3, 2, 1, 0, 5, 4, 7, 6, 8, 9, 10, 11, 12, 13, 14, 15})
            u8(digit(hex[std::size_t(2 * i)]) * 16 + digit(hex[std::size_t(2 * i) + 1]));
        return *this;
    }
    Written& wide(std::u16string_view s) {
        i32(int(s.size()) + 1);
        for (const char16_t c : s) u16(c);
        return u16(0);
    }
    // Lengths of four bytes, as before version 50.
    Written& chunk(std::uint32_t type, const Written& body) {
        const std::size_t begin = bytes.size();
        number(type);
        i32(int(body.bytes.size()) + ((type & 0x8000) != 0 ? 4 : 0));
        raw(std::string_view(body.bytes));
        if ((type & 0x8000) != 0) number(body.sum());
        inside_.emplace_back(begin, bytes.size());
        return *this;
    }
    Written& chunk(std::uint32_t type, std::string_view body) { return chunk(type, Written().raw(body)); }
    Written& short_chunk(std::uint32_t type, std::int32_t value) {
        inside_.emplace_back(bytes.size(), bytes.size() + 8);
        return number(type).i32(value);
    }

    std::string bytes;

private:
    // Bit by bit, without the chunks inside.
    std::uint32_t sum() const {
        std::uint32_t x = ~0u;
        for (std::size_t at = 0; at < bytes.size(); ++at) {
            bool is_inside = false;
            for (const auto& [begin, end] : inside_) is_inside = is_inside || (begin <= at && at < end);
            if (is_inside) continue;
            x ^= static_cast<unsigned char>(bytes[at]);
            for (int i = 0; i < 8; ++i) x = (x & 1) != 0 ? x >> 1 ^ 0xEDB88320u : x >> 1;
        }
        return ~x;
    }

    std::vector<std::pair<std::size_t, std::size_t>> inside_;  // chunks: where they begin and end
};

inline constexpr std::string_view kLine = "4ED7D4DB-E947-11D3-BFE5-0010830122F0",
                                  kArc = "CF33BE2A-09B4-11D4-BFFB-0010830122F0",
                                  kPolyline = "4ED7D4E6-E947-11D3-BFE5-0010830122F0",
                                  kRow = "4ED7D4E0-E947-11D3-BFE5-0010830122F0",
                                  kNurbsCurve = "4ED7D4DD-E947-11D3-BFE5-0010830122F0",
                                  kNurbsSurface = "4ED7D4DE-E947-11D3-BFE5-0010830122F0",
                                  kPlane = "4ED7D4DF-E947-11D3-BFE5-0010830122F0",
                                  kRevolved = "A16220D3-163B-11D4-8000-0010830122F0",
                                  kSum = "C4CD5359-446D-4690-9FF5-29059732472B",
                                  kExtrusion = "36F53175-72B8-4D47-BF1F-B4E6FC24F4B9",
                                  kBrep = "60B5DBC5-E660-11D3-BFE4-0010830122F0",
                                  kMesh = "4ED7D4E4-E947-11D3-BFE5-0010830122F0",
                                  kText = "74198302-CDF4-4F95-9609-6D684F22AB37";

// The data of a class as an object.
inline Written object(std::string_view uuid, const Written& data) {
    Written inner;
    inner.chunk(0x0002FFFB, Written().uuid(uuid));
    inner.chunk(0x0002FFFC, data);
    inner.short_chunk(0x82027FFF, 0);
    return Written().chunk(0x00027FFA, inner);
}

// A file of version 4, in millimetres.
inline std::string file(const std::vector<Written>& objects, std::string_view version = "       4") {
    Written units, settings, table;
    units.i32(102).i32(2).f64s({1e-6, 0.01, 0.01}).i32(0).i32(3).f64(1).wide(u"");
    settings.chunk(0x20008031, units).short_chunk(0xFFFFFFFF, 0);
    for (const Written& o : objects) {
        Written record, attributes;
        attributes.u8(0x10)
            .nothing(16)
            .i32(0)
            .i32(0)
            .nothing(4 + 2 + 2 + 8 + 8 + 4)
            .nothing(4)
            .wide(u"")
            .wide(u"");
        record.short_chunk(0x82000071, 0).raw(o).chunk(0x02008072, attributes).short_chunk(0x8200007F, 0);
        table.chunk(0x20008070, record);
    }
    table.short_chunk(0xFFFFFFFF, 0);
    Written all;
    all.raw("3D Geometry File Format ").raw(version);
    all.chunk(0x00000001, std::string_view("made by a test"));
    all.chunk(0x10000015, settings).chunk(0x10000013, table);
    return all.bytes + Written().chunk(0x00007FFF, Written().i32(int(all.bytes.size()) + 12)).bytes;
}

inline Written line_data(const Vec<3>& a, const Vec<3>& b, double t0 = 0, double t1 = 1) {
    return Written().u8(0x10).f64s({a[0], a[1], a[2], b[0], b[1], b[2], t0, t1}).i32(3);
}
inline Written line(const Vec<3>& a, const Vec<3>& b) { return object(kLine, line_data(a, b)); }

// In the plane through `centre` with these axes.
inline Written arc(const Vec<3>& centre, const Vec<3>& x, const Vec<3>& y, double radius, double from,
                   double to) {
    const Vec<3> z = cross(x, y);
    Written w;
    w.u8(0x10);
    for (const Vec<3>& v : {centre, x, y, z}) w.f64s({v[0], v[1], v[2]});
    w.nothing(4 * 8).f64(radius).nothing(9 * 8).f64s({from, to, 0, 1}).i32(3);
    return object(kArc, w);
}

inline Written row(const std::vector<Written>& segments) {
    Written w;
    w.u8(0x10).i32(int(segments.size())).nothing(8 + 48).i32(int(segments.size()) + 1);
    for (std::size_t i = 0; i <= segments.size(); ++i) w.f64(double(i));
    for (const Written& s : segments) w.raw(s);
    return object(kRow, w);
}

inline Written nurbs_curve(int order, const std::vector<double>& knots,
                           const std::vector<std::vector<double>>& points, bool rational = false) {
    Written w;
    w.u8(0x10)
        .i32(3)
        .i32(rational ? 1 : 0)
        .i32(order)
        .i32(int(points.size()))
        .nothing(8 + 48)
        .i32(int(knots.size()));
    for (const double k : knots) w.f64(k);
    w.i32(int(points.size()));
    for (const auto& p : points)
        for (const double x : p) w.f64(x);
    return object(kNurbsCurve, w);
}

}  // namespace freiform::test::rhino
