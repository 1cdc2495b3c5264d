// Idea. FreeType decodes the tables; the outline is put together here. At a size of one pixel to the font
// unit its scale is exactly 64, so that its coordinates, 1/64 of a pixel, are font units to the bit; and its
// own decomposition is not used because it rounds the points that TrueType implies between two control
// points.
//
// Hostile fonts. Programs in fonts (TrueType hinting) are not run. FreeType gets its memory from a counter,
// which refuses it after so many bytes, and after so many requests: components of components, which multiply
// their number at each depth, take a piece of memory each, so their number is bounded too. Charstrings have a
// limit of their own in FreeType (20 million instructions), and outlines at most 32767 points.
//
// Threads. A face of FreeType is changed by reading from it: a lock.
//
// References: the OpenType specification ("glyf", "CFF ", "fvar"); the manual of FreeType 2.
// Why not FT_LOAD_NO_SCALE, which gives whole units: scaled components and instances are rounded to them.
#include <freiform/font/font.hpp>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_FONT_FORMATS_H
#include FT_MODULE_H
#include FT_MULTIPLE_MASTERS_H
#include FT_OUTLINE_H
#include FT_SYSTEM_H

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>

namespace freiform {

namespace {

constexpr long kMostRequests = 2'000'000;  // of memory, for one glyph or for opening a font

// What FreeType may use. Each block begins with the room that it takes.
struct Allowance {
    std::size_t most = 0, used = 0;
    long requests = 0;
    bool exceeded = false;
    FT_MemoryRec_ functions{};
};

constexpr std::size_t kHead = alignof(std::max_align_t);
static_assert(kHead >= sizeof(std::size_t));

bool granted(Allowance& a, std::size_t more) {
    if (++a.requests <= kMostRequests && more <= a.most - a.used) return true;
    a.exceeded = true;
    return false;
}

std::size_t room_of(const char* block) {
    std::size_t room = 0;
    std::memcpy(&room, block, sizeof room);
    return room;
}
void* with_room(char* block, std::size_t room) {
    std::memcpy(block, &room, sizeof room);
    return block + kHead;
}

void* ft_take(FT_Memory memory, long size) {
    auto& a = *static_cast<Allowance*>(memory->user);
    const std::size_t n = std::size_t(size) + kHead;
    if (size < 0 || !granted(a, n)) return nullptr;
    auto* block = static_cast<char*>(std::malloc(n));
    if (block == nullptr) return nullptr;
    a.used += n;
    return with_room(block, n);
}

void ft_give_back(FT_Memory memory, void* p) {
    if (p == nullptr) return;
    char* block = static_cast<char*>(p) - kHead;
    static_cast<Allowance*>(memory->user)->used -= room_of(block);
    std::free(block);
}

// FreeType lengthens lists by a few entries at a time. By half at least, what is moved stays a multiple of
// what there is, whichever allocator moves it.
void* ft_resize(FT_Memory memory, long, long size, void* p) {
    if (p == nullptr) return ft_take(memory, size);
    auto& a = *static_cast<Allowance*>(memory->user);
    char* block = static_cast<char*>(p) - kHead;
    const std::size_t room = room_of(block), n = std::size_t(size) + kHead;
    const std::size_t wanted = n <= room ? room : std::max(n, room + room / 2);
    if (size < 0 || !granted(a, wanted - room)) return nullptr;
    if (wanted == room) return p;
    auto* moved = static_cast<char*>(std::realloc(block, wanted));
    if (moved == nullptr) return nullptr;
    a.used += wanted - room;
    return with_room(moved, wanted);
}

std::string error_text(FT_Error e) {
    const char* words = FT_Error_String(e);
    return words != nullptr ? text("FreeType says: ", words) : text("FreeType's error ", e);
}

// Names in fonts are in many encodings; FreeType gives ASCII, but promises nothing.
std::string ascii(const char* s) {
    std::string out;
    for (; s != nullptr && *s != 0 && out.size() < 256; ++s) out += *s >= ' ' && *s <= '~' ? *s : '?';
    return out;
}

std::string tag_text(FT_ULong tag) {
    std::string s;
    for (int shift = 24; shift >= 0; shift -= 8) s += char((tag >> shift) & 0xff);
    return ascii(s.c_str());
}

double of_fixed(FT_Fixed x) { return double(x) / 65536; }

// One contour after the other as lines and curves.
class Contours {
public:
    explicit Contours(const FT_Outline& outline) : outline_(outline) {}

    Result<Path> path() const {
        Path out;
        int first = 0;
        for (int c = 0; c < outline_.n_contours; ++c) {
            const int last = outline_.contours[c];
            if (last < first - 1 || last >= outline_.n_points)
                return refuse(RefusalKind::unreadable, text("contours[", c, "]"),
                              text("ends at point ", last, " of ", outline_.n_points));
            if (last > first) {  // a single point is an anchor, no area
                auto subpath = contour(first, last);
                if (!subpath) return refuse_within(text("contours[", c, "]"), subpath.error());
                if (!subpath->segments.empty()) out.subpaths.push_back(*std::move(subpath));
            }
            first = last + 1;
        }
        return out;
    }

private:
    Vec<2> point(int i) const {
        return {{double(outline_.points[i].x) / 64, double(outline_.points[i].y) / 64}};
    }
    int kind(int i) const { return FT_CURVE_TAG(outline_.tags[i]); }

    static void add(Subpath& s, int degree, const std::array<Vec<2>, 3>& to) {
        PathSegment segment{degree, {s.segments.empty() ? s.start : s.segments.back().back()}, 1};
        bool moves = false;
        for (std::size_t i = 0; i < std::size_t(degree); ++i) {
            segment.points[i + 1] = to[i];
            moves = moves || to[i] != segment.points[0];
        }
        if (moves) s.segments.push_back(segment);
    }

    // Points of TrueType that are off the curve one after the other have one on it in their middle, the first
    // and the last of a contour too. Sums of two coordinates are exact.
    Result<Subpath> contour(int first, int last) const {
        Subpath s;
        s.closed = true;
        int i = first;
        if (kind(first) == FT_CURVE_TAG_ON)
            s.start = point(i++);
        else if (kind(first) == FT_CURVE_TAG_CUBIC)
            return refuse(RefusalKind::unreadable, text("point ", first), "a contour begins inside a cubic");
        else if (kind(last) == FT_CURVE_TAG_ON)
            s.start = point(last--);
        else
            s.start = 0.5 * (point(first) + point(last));
        while (i <= last) {
            if (kind(i) == FT_CURVE_TAG_ON) {
                add(s, 1, {point(i++)});
            } else if (kind(i) == FT_CURVE_TAG_CONIC) {
                const Vec<2> b = point(i++);
                if (i > last)
                    add(s, 2, {b, s.start});
                else if (kind(i) == FT_CURVE_TAG_ON)
                    add(s, 2, {b, point(i++)});
                else if (kind(i) == FT_CURVE_TAG_CONIC)
                    add(s, 2, {b, 0.5 * (b + point(i))});
                else
                    return refuse(RefusalKind::unreadable, text("point ", i),
                                  "a cubic after half a quadratic");
            } else {
                if (i + 1 > last || kind(i + 1) != FT_CURVE_TAG_CUBIC ||
                    (i + 2 <= last && kind(i + 2) != FT_CURVE_TAG_ON))
                    return refuse(RefusalKind::unreadable, text("point ", i),
                                  "a cubic has two points off the curve and one on it");
                add(s, 3, {point(i), point(i + 1), i + 2 <= last ? point(i + 2) : s.start});
                i += 3;
            }
        }
        if (!s.segments.empty() && s.segments.back().back() != s.start) add(s, 1, {s.start});
        return s;
    }

    const FT_Outline& outline_;
};

}  // namespace

struct Font::State {
    std::string bytes;
    FontOptions options;
    FontInfo info;
    Allowance allowance;
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    std::mutex lock;

    ~State() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_Library(library);
    }

    std::unexpected<Refusal> failed(std::string where, std::string_view what, FT_Error e) const {
        if (allowance.exceeded)
            return refuse(RefusalKind::limit, std::move(where),
                          text("takes more than ", double(options.memory_bytes) / (1 << 20), " MiB or ",
                               kMostRequests, " pieces of memory"));
        return refuse(RefusalKind::unreadable, std::move(where), text(what, ": ", error_text(e)));
    }

    Result<void> open();
    Result<void> vary();
};

Result<void> Font::State::open() {
    if (bytes.size() > std::size_t(std::numeric_limits<FT_Long>::max() / 2))
        return refuse(RefusalKind::limit, "", "the font is too large");
    allowance.most = options.memory_bytes;
    allowance.functions = {&allowance, ft_take, ft_give_back, ft_resize};
    if (const FT_Error e = FT_New_Library(&allowance.functions, &library))
        return failed("", "FreeType cannot be started", e);
    FT_Add_Default_Modules(library);
    if (options.face < 0 || options.face > 0xffff)
        return refuse(RefusalKind::invalid, "face", text("an index from 0 on, not ", options.face));
    if (const FT_Error e = FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                                              FT_Long(bytes.size()), options.face, &face)) {
        face = nullptr;
        return failed(options.face > 0 ? text("faces[", options.face, "]") : "",
                      "this is no font that can be read", e);
    }
    if (!FT_IS_SCALABLE(face) || face->units_per_EM == 0)
        return refuse(RefusalKind::unsupported, "", "the font has pictures of its glyphs, no outlines");
    if (const FT_Error e = FT_Set_Pixel_Sizes(face, face->units_per_EM, face->units_per_EM))
        return failed("", "the font cannot be scaled", e);
    if (face->size->metrics.x_scale != 64 * 65536 || face->size->metrics.y_scale != 64 * 65536)
        return refuse(RefusalKind::unsupported, "", "the font has another scale than its units per em say");
    info.family = ascii(face->family_name), info.style = ascii(face->style_name);
    info.format = ascii(FT_Get_Font_Format(face));
    info.faces = int(std::min<FT_Long>(face->num_faces, 0xffff));
    info.glyphs = int(std::clamp<FT_Long>(face->num_glyphs, 0, 0x10ffff));
    info.units_per_em = face->units_per_EM;
    info.ascender = face->ascender, info.descender = face->descender, info.line_step = face->height;
    return vary();
}

Result<void> Font::State::vary() {
    std::vector<FT_Fixed> at;
    if (FT_HAS_MULTIPLE_MASTERS(face)) {
        FT_MM_Var* axes = nullptr;
        if (const FT_Error e = FT_Get_MM_Var(face, &axes))
            return failed("fvar", "the axes cannot be read", e);
        for (FT_UInt i = 0; i < axes->num_axis; ++i) {
            const FT_Var_Axis& a = axes->axis[i];
            info.axes.push_back(
                {tag_text(a.tag), ascii(a.name), of_fixed(a.minimum), of_fixed(a.def), of_fixed(a.maximum)});
            info.at.push_back(of_fixed(a.def));
            at.push_back(a.def);
        }
        FT_Done_MM_Var(library, axes);
    }
    for (std::size_t k = 0; k < options.axes.size(); ++k) {
        const AxisValue& wanted = options.axes[k];
        const auto axis = std::ranges::find(info.axes, wanted.tag, &FontAxis::tag);
        if (axis == info.axes.end()) {
            std::string known;
            for (const FontAxis& a : info.axes) known += text(known.empty() ? "" : ", ", a.tag);
            return refuse(
                RefusalKind::invalid, text("axes[", k, "]"),
                text("the font has no axis \"", wanted.tag, "\"", known.empty() ? "" : "; it has ", known));
        }
        if (!(axis->least <= wanted.value && wanted.value <= axis->most))
            return refuse(
                RefusalKind::invalid, text("axes[", k, "]"),
                text(wanted.tag, " is from ", axis->least, " to ", axis->most, ", not ", wanted.value));
        const auto i = std::size_t(axis - info.axes.begin());
        info.at[i] = wanted.value, at[i] = FT_Fixed(wanted.value * 65536);
    }
    if (options.axes.empty()) return {};
    if (const FT_Error e = FT_Set_Var_Design_Coordinates(face, FT_UInt(at.size()), at.data()))
        return failed("axes", "the instance cannot be made", e);
    return {};
}

Result<Font> Font::parse(std::string bytes, const FontOptions& options) {
    auto state = std::make_shared<State>();
    state->bytes = std::move(bytes), state->options = options;
    if (auto ok = state->open(); !ok) return std::unexpected(ok.error());
    return Font(std::move(state));
}

const FontInfo& Font::info() const { return state_->info; }
const std::string& Font::bytes() const { return state_->bytes; }
const FontOptions& Font::options() const { return state_->options; }

Result<Glyph> Font::glyph(int index) const {
    const std::string where = text("glyphs[", index, "]");
    if (index < 0 || index >= info().glyphs)
        return refuse(RefusalKind::out_of_domain, where, text("the font has ", info().glyphs, " glyphs"));
    const std::scoped_lock only(state_->lock);
    Allowance& allowance = state_->allowance;
    allowance.requests = 0, allowance.exceeded = false;
    constexpr FT_Int32 kHow =
        FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP | FT_LOAD_NO_AUTOHINT | FT_LOAD_IGNORE_TRANSFORM;
    if (const FT_Error e = FT_Load_Glyph(state_->face, FT_UInt(index), kHow))
        return state_->failed(where, "the glyph cannot be read", e);
    const FT_GlyphSlot slot = state_->face->glyph;
    if (slot->format != FT_GLYPH_FORMAT_OUTLINE)
        return refuse(RefusalKind::unsupported, where, "the glyph is a picture, not an outline");
    auto path = Contours(slot->outline).path();
    if (!path) return refuse_within(where, path.error());
    return Glyph{*std::move(path), of_fixed(slot->linearHoriAdvance)};
}

int Font::index_of(char32_t character) const {
    const std::scoped_lock only(state_->lock);
    return int(FT_Get_Char_Index(state_->face, character));
}

std::optional<int> Font::index_named(std::string_view name) const {
    const std::scoped_lock only(state_->lock);
    const FT_UInt i = FT_Get_Name_Index(state_->face, std::string(name).c_str());
    if (i == 0 && name != ".notdef") return std::nullopt;
    return int(i);
}

std::string Font::name_of(int index) const {
    if (index < 0 || index >= info().glyphs) return {};
    const std::scoped_lock only(state_->lock);
    char name[128] = {};
    if (!FT_HAS_GLYPH_NAMES(state_->face) ||
        FT_Get_Glyph_Name(state_->face, FT_UInt(index), name, sizeof name) != 0)
        return {};
    return ascii(name);
}

std::vector<std::pair<char32_t, int>> Font::characters() const {
    const std::scoped_lock only(state_->lock);
    std::vector<std::pair<char32_t, int>> all;
    FT_UInt index = 0;
    for (FT_ULong c = FT_Get_First_Char(state_->face, &index); index != 0 && all.size() < 0x110000;
         c = FT_Get_Next_Char(state_->face, c, &index))
        all.emplace_back(char32_t(c), int(index));
    return all;
}

}  // namespace freiform
