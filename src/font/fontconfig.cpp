// fontconfig always finds something; here what is found must be of the family that was asked for.
#include <freiform/font/font.hpp>

#include <fontconfig/fontconfig.h>
#include <memory>

namespace freiform {

namespace {

using Pattern = std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)>;

std::string string_of(const FcPattern* pattern, const char* what, int i = 0) {
    FcChar8* s = nullptr;
    return FcPatternGetString(pattern, what, i, &s) == FcResultMatch ? reinterpret_cast<const char*>(s)
                                                                     : std::string();
}

}  // namespace

Result<FontFile> font_file(const std::string& family) {
    const auto* asked = reinterpret_cast<const FcChar8*>(family.c_str());
    const Pattern wanted(FcNameParse(asked), FcPatternDestroy);
    const std::string name = wanted ? string_of(wanted.get(), FC_FAMILY) : "";
    if (name.empty()) return refuse(RefusalKind::invalid, family, "this names no family of fonts");
    FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultNoMatch;
    const Pattern found(FcFontMatch(nullptr, wanted.get(), &result), FcPatternDestroy);
    bool same = false;
    for (int i = 0; found && !same; ++i) {
        const std::string other = string_of(found.get(), FC_FAMILY, i);
        if (other.empty()) break;
        same = FcStrCmpIgnoreCase(reinterpret_cast<const FcChar8*>(other.c_str()),
                                  reinterpret_cast<const FcChar8*>(name.c_str())) == 0;
    }
    if (!same)
        return refuse(
            RefusalKind::no_answer, family,
            text("is neither a file nor an installed family of fonts",
                 found ? text("; the nearest is \"", string_of(found.get(), FC_FAMILY), "\"") : ""));
    FontFile file{string_of(found.get(), FC_FILE), 0};
    int index = 0;
    if (FcPatternGetInteger(found.get(), FC_INDEX, 0, &index) == FcResultMatch) file.face = index & 0xffff;
    return file;
}

}  // namespace freiform
