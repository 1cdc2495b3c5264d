#include "rhino_file.hpp"

#include <algorithm>
#include <array>

namespace freiform::rhino {

namespace {

// Layers by the numbers that objects have them by, and by their names.
struct Layers {
    std::map<int, int> by_number;
    std::map<std::string, int> by_name;
};

// What objects are called, where they are, and whether they are only parts of blocks.
void read_attributes(Bytes b, FileObject& o, const Layers& layers) {
    int minor = 0;
    const int major = b.version(minor);
    o.uuid = b.uuid();
    if (const auto at = layers.by_number.find(b.i32()); at != layers.by_number.end()) o.layer = at->second;
    int mode = 0, colour_from = 0;
    std::uint32_t colour = 0;
    constexpr int kOfObject = 1, kPartOfBlock = 3;
    if (major == 1) {
        b.i32();
        colour = b.get<std::uint32_t>();
        b.skip(2 + 2 + 8 + 8 + 4);
        mode = b.u8();
        colour_from = b.u8();
        b.skip(2);
        o.name = b.wide_string();
    } else {
        // Items in ascending order, of which those that are wanted come first.
        for (int item = b.u8(), last = 0; item > last && item <= 13; last = item, item = b.u8()) {
            switch (item) {
                case 1:
                    o.name = b.wide_string();
                    break;
                case 2:
                    b.wide_string();
                    break;
                case 5:
                    b.chunk();
                    break;
                case 6:
                    colour = b.get<std::uint32_t>();
                    break;
                case 8:
                    b.f64();
                    break;
                case 9:
                case 11:
                    b.u8();
                    break;
                case 12:
                    mode = b.u8();
                    break;
                case 13:
                    colour_from = b.u8();
                    break;
                default:
                    b.i32();
            }
            if (b.failed()) break;
        }
    }
    o.is_part_of_block = (mode & 15) == kPartOfBlock;
    if (colour_from == kOfObject) {
        const auto part = [&](int shift) { return double(colour >> shift & 255) / 255; };
        o.colour = Colour{part(0), part(8), part(16), 1};
    }
}

void read_layer(StoredObject o, Layers& layers, File3dm& out) {
    Bytes& b = o.data;
    int minor = 0;
    b.version(minor);
    b.i32();
    const int index = b.i32();
    b.skip(3 * 4 + 4 + 2 + 2 + 8 + 8);
    const std::string name = b.wide_string();
    if (b.failed() || name.empty()) return;
    const auto [at, fresh] = layers.by_name.emplace(name, int(out.layers.size()));
    if (fresh) out.layers.push_back(name);
    layers.by_number.emplace(index, at->second);
}

void read_units(Bytes b, File3dm& out) {
    b.i32();
    const int unit = b.i32();
    const double tolerance = b.f64();
    if (b.failed()) return;
    out.unit = unit_named(unit);
    if (tolerance > 0 && std::isfinite(tolerance)) out.tolerance = tolerance;
}

// Blocks by the numbers of their members; those of other files have none.
Result<void> read_block(StoredObject o, File3dm& out) {
    Bytes b = o.data;
    BlockOf block;
    std::string uuid;
    const auto members = [&] {
        const int n = b.count(16);
        for (int i = 0; i < n; ++i) block.members.push_back(b.uuid());
    };
    if (b.peek_type() != tag::kAnonymous) {
        int minor = 0;
        b.version(minor);
        uuid = b.uuid();
        members();
        block.name = b.wide_string();
    } else {
        b = b.chunk().body;
        b.skip(8);
        Bytes component = b.chunk().body;
        component.skip(8);
        if (component.u8() == 1) component.skip(12);
        if (component.u8() == 1) uuid = component.uuid();
        if (component.u8() == 1) component.i32();
        if (component.u8() == 1) component.i32();
        if (component.u8() == 1) block.name = component.wide_string();
        if (component.failed()) return ends_early(component, "a block");
        b.i32();
        b.chunk();
        for (int i = 0; i < 3; ++i) b.wide_string();
        b.skip(6 * 8);
        if (b.u8() != 0) members();
    }
    if (b.failed()) return ends_early(b, "a block");
    out.blocks.emplace(std::move(uuid), std::move(block));
    return {};
}

Result<void> read_object(Bytes b, File3dm& out, const Layers& layers) {
    FileObject o;
    bool is_there = false;
    while (b.left() > 0) {
        Chunk c = b.chunk();
        if (b.failed()) return ends_early(b, "an object");
        if (c.type == tag::kClass) {
            auto object = object_in(std::move(c));
            if (!object) return std::unexpected(object.error());
            o.object = std::move(*object), is_there = true;
        } else if (c.type == tag::kAttributes) {
            read_attributes(c.body, o, layers);
        }
    }
    if (is_there) out.objects.push_back(std::move(o));
    return {};
}

}  // namespace

std::string unit_named(int number) {
    constexpr std::array<std::string_view, 26> kNames{
        "",         "um", "mm", "cm",  "m",  "km", "microinch", "mil",  "inch", "ft",   "mile",          "",
        "angstrom", "nm", "dm", "dam", "hm", "Mm", "Gm",        "yard", "pt",   "pica", "nautical mile", "au",
        "ly",       "pc"};
    return number >= 0 && std::size_t(number) < kNames.size() ? std::string(kNames[std::size_t(number)]) : "";
}

Result<File3dm> parse_3dm(std::string_view bytes) {
    constexpr std::string_view kMagic = "3D Geometry File Format ";
    constexpr std::size_t kHeader = 32;
    if (!bytes.starts_with(kMagic) || bytes.size() < kHeader)
        return refuse(RefusalKind::unreadable, "byte 0",
                      text("a 3DM file begins with '", kMagic, "' and a version"));
    int version = 0;
    for (const char c : bytes.substr(kMagic.size(), kHeader - kMagic.size())) {
        if (c == ' ' && version == 0) continue;
        if (c < '0' || c > '9')
            return refuse(RefusalKind::unreadable, text("byte ", kMagic.size()),
                          "expected the version of a 3DM file");
        version = 10 * version + (c - '0');
    }
    if (version < 1 || version > 99)
        return refuse(RefusalKind::unsupported, text("byte ", kMagic.size()),
                      text("is of version ", version, "; 1 to 8 are read"));
    // Version 1 has no tables, but what says so may be of version 2.
    Bytes file(bytes.substr(kHeader), kHeader, version >= 50, version > 1);
    if (version == 1) {
        bool has_tables = false;
        for (Bytes b = file; b.left() > 0 && !has_tables;) {
            const std::uint32_t type = b.chunk().type;
            if (b.failed()) break;
            has_tables = (type & 0xFFFF0000) == 0x10000000;
        }
        if (!has_tables) return parse_version1(file);
        file = Bytes(bytes.substr(kHeader), kHeader, false, true);
    }
    File3dm out;
    Layers layers;
    const auto each = [](Bytes table, std::uint32_t type, auto&& f) -> Result<void> {
        while (table.left() > 0) {
            Chunk c = table.chunk();
            if (table.failed()) return ends_early(table, "a table of the file");
            if (c.type == type)
                if (auto ok = f(std::move(c.body)); !ok) return ok;
        }
        return {};
    };
    bool has_objects = false;
    while (file.left() > 0) {
        const std::size_t at = file.at();
        const Chunk c = file.chunk();
        if (file.failed())
            return refuse(RefusalKind::unreadable, text("byte ", at),
                          has_objects ? "what follows the objects ends too early, or is no part of a 3DM file"
                                      : "the file ends too early, or this is no part of a 3DM file");
        Result<void> ok;
        if (c.type == tag::kSettings)
            ok = each(c.body, tag::kUnits,
                      [&](Bytes b) -> Result<void> { return read_units(b, out), Result<void>{}; });
        else if (c.type == tag::kLayers)
            ok = each(c.body, tag::kLayer, [&](Bytes b) -> Result<void> {
                if (auto o = object_in(b)) read_layer(std::move(*o), layers, out);
                return {};
            });
        else if (c.type == tag::kDefinitions)
            ok = each(c.body, tag::kDefinition, [&](Bytes b) -> Result<void> {
                auto o = object_in(b);
                if (!o) return std::unexpected(o.error());
                return read_block(std::move(*o), out);
            });
        else if (c.type == tag::kObjects) {
            has_objects = true;
            ok = each(c.body, tag::kObject, [&](Bytes b) { return read_object(b, out, layers); });
        } else if (c.type == tag::kEndOfFile) {
            break;
        }
        if (!ok) return std::unexpected(ok.error());
    }
    return out;
}

}  // namespace freiform::rhino
