// Idea. HarfBuzz chooses and places the glyphs; it reads the same bytes as FreeType, in font units, so that
// nothing is rounded before the size is put in. What it would guess from the machine (the language of the
// locale) is given.
//
// Why not the bidirectional algorithm of Unicode, which takes lines of both directions apart: it needs
// another library (ICU or FriBidi). Such lines are refused instead of being set wrong.
#include <freiform/font/typeset.hpp>

#include <cmath>
#include <hb-ot.h>
#include <hb.h>
#include <limits>
#include <map>
#include <memory>

namespace freiform {

namespace {

constexpr std::size_t kMostBytes = 1'000'000;

using Blob = std::unique_ptr<hb_blob_t, decltype(&hb_blob_destroy)>;
using HbFace = std::unique_ptr<hb_face_t, decltype(&hb_face_destroy)>;
using HbFont = std::unique_ptr<hb_font_t, decltype(&hb_font_destroy)>;
using Buffer = std::unique_ptr<hb_buffer_t, decltype(&hb_buffer_destroy)>;

HbFont hb_font_of(const Font& font) {
    const std::string& bytes = font.bytes();
    const Blob blob(
        hb_blob_create(bytes.data(), unsigned(bytes.size()), HB_MEMORY_MODE_READONLY, nullptr, nullptr),
        hb_blob_destroy);
    const HbFace face(hb_face_create(blob.get(), unsigned(font.options().face)), hb_face_destroy);
    HbFont made(hb_font_create(face.get()), hb_font_destroy);
    const int em = font.info().units_per_em;
    hb_font_set_scale(made.get(), em, em);
    std::vector<hb_variation_t> at;
    for (const AxisValue& a : font.options().axes)
        at.push_back({hb_tag_from_string(a.tag.data(), int(a.tag.size())), float(a.value)});
    if (!at.empty()) hb_font_set_variations(made.get(), at.data(), unsigned(at.size()));
    return made;
}

Result<std::vector<hb_feature_t>> features_of(const TypesetOptions& options) {
    std::vector<hb_feature_t> all;
    for (std::size_t i = 0; i < options.features.size(); ++i) {
        const std::string& s = options.features[i];
        hb_feature_t f{};
        if (!hb_feature_from_string(s.data(), int(s.size()), &f))
            return refuse(RefusalKind::invalid, text("features[", i, "]"),
                          text("\"", s, "\" is no feature; such are \"liga\", \"-kern\", \"aalt=2\""));
        all.push_back(f);
    }
    return all;
}

std::string code_point(char32_t c) {
    std::string s;
    for (int shift = 20; shift >= 0; shift -= 4)
        if (const unsigned digit = (c >> shift) & 15; digit != 0 || !s.empty() || shift < 16)
            s += "0123456789ABCDEF"[digit];
    return "U+" + s;
}

// The direction that all letters of the line have. `chars` are pairs of code point and byte.
Result<hb_direction_t> direction_of(std::span<const std::pair<char32_t, std::size_t>> chars) {
    hb_unicode_funcs_t* unicode = hb_unicode_funcs_get_default();
    bool seen[2] = {false, false};
    std::size_t first[2] = {0, 0};
    for (const auto& [c, byte] : chars) {
        const hb_script_t script = hb_unicode_script(unicode, c);
        if (script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN)
            continue;
        const int k = hb_script_get_horizontal_direction(script) == HB_DIRECTION_RTL ? 1 : 0;
        if (!seen[k]) seen[k] = true, first[k] = byte;
    }
    if (seen[0] && seen[1])
        return refuse(
            RefusalKind::unsupported, text("byte ", std::max(first[0], first[1])),
            "letters that run in the other direction than those before in the line; set them apart");
    if (!seen[1]) return HB_DIRECTION_LTR;
    const auto is_digit = [&](char32_t c) {
        return hb_unicode_general_category(unicode, c) == HB_UNICODE_GENERAL_CATEGORY_DECIMAL_NUMBER;
    };
    for (std::size_t i = 1; i < chars.size(); ++i)
        if (is_digit(chars[i].first) && is_digit(chars[i - 1].first))
            return refuse(RefusalKind::unsupported, text("byte ", chars[i - 1].second),
                          "a number in a line that runs from right to left; set it apart");
    return HB_DIRECTION_RTL;
}

// Code points with their bytes. Refuses what is not UTF-8.
Result<std::vector<std::pair<char32_t, std::size_t>>> decoded(std::string_view s) {
    std::vector<std::pair<char32_t, std::size_t>> out;
    for (std::size_t i = 0; i < s.size();) {
        const auto byte = [&](std::size_t k) {
            return i + k < s.size() ? static_cast<unsigned char>(s[i + k]) : 0u;
        };
        const unsigned c = byte(0);
        const std::size_t n = c < 0x80 ? 1 : c < 0xC0 ? 0 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : c < 0xF8 ? 4 : 0;
        char32_t x = n == 1 ? c : n == 0 ? 0 : c & (0x7Fu >> n);
        bool right = n > 0;
        for (std::size_t k = 1; k < n; ++k)
            right = right && (byte(k) & 0xC0) == 0x80, x = x << 6 | (byte(k) & 0x3F);
        constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
        if (!right || x < kLeast[n] || x > 0x10FFFF || (x >= 0xD800 && x < 0xE000))
            return refuse(RefusalKind::invalid, text("byte ", i), "this is not UTF-8");
        out.emplace_back(x, i);
        i += n;
    }
    return out;
}

class Setter {
public:
    Setter(const Font& font, const TypesetOptions& options, std::vector<hb_feature_t> features)
        : font_(hb_font_of(font)),
          features_(std::move(features)),
          language_(hb_language_from_string(options.language.data(), int(options.language.size()))),
          scale_(options.size / font.info().units_per_em) {
        step_ = font.info().line_step;
    }

    Result<void> line(std::span<const std::pair<char32_t, std::size_t>> chars) {
        const auto direction = direction_of(chars);
        if (!direction) return std::unexpected(direction.error());
        const Buffer buffer(hb_buffer_create(), hb_buffer_destroy);
        for (const auto& [c, byte] : chars) hb_buffer_add(buffer.get(), c, unsigned(byte));
        hb_buffer_set_content_type(buffer.get(), HB_BUFFER_CONTENT_TYPE_UNICODE);
        hb_buffer_set_direction(buffer.get(), *direction);
        hb_buffer_set_language(buffer.get(), language_);
        hb_buffer_guess_segment_properties(buffer.get());  // the script
        hb_shape(font_.get(), buffer.get(), features_.data(), unsigned(features_.size()));
        if (!hb_buffer_allocation_successful(buffer.get()))
            return refuse(RefusalKind::limit, text("line ", out.lines + 1),
                          "there is no memory to set this text");
        unsigned n = 0;
        const hb_glyph_info_t* info = hb_buffer_get_glyph_infos(buffer.get(), &n);
        const hb_glyph_position_t* position = hb_buffer_get_glyph_positions(buffer.get(), &n);
        std::map<std::size_t, char32_t> of_byte;
        double x = 0;
        const double y = -out.lines * step_;
        for (unsigned i = 0; i < n; ++i) {
            out.glyphs.push_back(
                {int(info[i].codepoint),
                 info[i].cluster,
                 {{scale_ * (x + position[i].x_offset), scale_ * (y + position[i].y_offset)}}});
            x += position[i].x_advance;
            if (info[i].codepoint != 0) continue;
            if (of_byte.empty())
                for (const auto& [c, byte] : chars) of_byte[byte] = c;
            out.missing.push_back({RefusalKind::no_answer, text("byte ", info[i].cluster),
                                   text("the font has no glyph for ", code_point(of_byte[info[i].cluster]))});
        }
        out.width = std::max(out.width, scale_ * x);
        ++out.lines;
        return {};
    }

    Typeset out;

private:
    HbFont font_;
    std::vector<hb_feature_t> features_;
    hb_language_t language_;
    double scale_, step_ = 0;
};

}  // namespace

Result<Typeset> typeset(const Font& font, std::string_view utf8, const TypesetOptions& options) {
    if (!(options.size > 0) || !std::isfinite(options.size))
        return refuse(RefusalKind::invalid, "size", text("a positive number, not ", options.size));
    if (utf8.size() > kMostBytes)
        return refuse(RefusalKind::limit, "text", text(utf8.size(), " bytes, at most ", kMostBytes));
    auto features = features_of(options);
    if (!features) return std::unexpected(features.error());
    const auto chars = decoded(utf8);
    if (!chars) return std::unexpected(chars.error());
    Setter setter(font, options, *std::move(features));
    for (std::size_t i = 0; i <= chars->size();) {
        std::size_t end = i;
        while (end < chars->size() && (*chars)[end].first != U'\n') ++end;
        if (auto ok = setter.line(std::span(*chars).subspan(i, end - i)); !ok)
            return std::unexpected(ok.error());
        i = end + 1;
    }
    return std::move(setter.out);
}

Result<std::vector<Path>> outlines(const Font& font, const Typeset& set, double size) {
    const double scale = size / font.info().units_per_em;
    std::map<int, Path> known;
    std::vector<Path> all;
    all.reserve(set.glyphs.size());
    for (const PlacedGlyph& g : set.glyphs) {
        auto it = known.find(g.index);
        if (it == known.end()) {
            auto glyph = font.glyph(g.index);
            if (!glyph) return std::unexpected(glyph.error());
            it = known.emplace(g.index, std::move(glyph->path)).first;
        }
        all.push_back(transformed(it->second, {{{{scale, 0}, {0, scale}}}, g.at}));
    }
    return all;
}

}  // namespace freiform
