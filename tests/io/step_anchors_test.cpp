// Names that instances of STEP files have, and numbers that stand for them: edition 3.
#include <freiform/io/step_read.hpp>

#include <support/effort.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// A triangle whose edges run between vertices that are numbered #800..: what stands for #200.. is said before
// the data.
std::string anchored_file(std::string_view anchors, std::string_view references) {
    std::string s = polygon_file({{0, 0}, {3, 0}, {3, 2}});
    for (int i = 0; i < 3; ++i) {
        const std::string at = text("#", 200 + i, ",");
        for (std::size_t k = s.find(at); k != s.npos; k = s.find(at, k)) s.replace(k, 4, text("#", 800 + i));
    }
    const std::size_t data = s.find("DATA;");
    s.insert(data, text("REFERENCE;\n", references, "ENDSEC;\n"));
    s.insert(data, text("ANCHOR;\n", anchors, "ENDSEC;\n"));
    return s;
}

constexpr std::string_view kNames = "<a> = #200;\n<b c> = #201 {note:'x;y'};\n/* ; */ <it's>=#202;\n";
constexpr std::string_view kNumbers = "#800 = <#a>;\n#801=<#b c>;\n#802 /* > */ = <#it's>;\n";

// What is said of #800, which an edge needs.
Refusal told(std::string_view anchors, std::string_view references) {
    const auto m = read_step(anchored_file(anchors, references));
    EXPECT_FALSE(m) << "the face is not there";
    return m ? Refusal{} : m.error();
}

TEST(StepAnchors, numbers_of_references_stand_for_what_has_their_names) {
    const Model m = must(read_step(anchored_file(kNames, kNumbers)));
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
    EXPECT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(m.edges.size(), 3u);
    EXPECT_EQ(m.vertices.size(), 3u);
}

TEST(StepAnchors, names_of_references_are_followed_to_the_end) {
    const Model m = must(read_step(anchored_file("<a>=#801;<b>=#802;<c>=#803;<d>=#200;<y>=#201;<z>=#202;\n",
                                                 "#850=<#a>;#803=<#d>;#802=<#c>;#801=<#y>;#800=<#b>;\n")));
    // #800 is #802, that is #803, that is #200; and #801 is #201. #802 is no vertex of its own.
    EXPECT_EQ(m.faces.size() + m.refused.size(), 1u);
    const Model chain =
        must(read_step(anchored_file("<a>=#820;<b>=#821;<c>=#200;<y>=#201;<z>=#202;\n",
                                     "#800=<#a>;#820=<#b>;#821=<#c>;#801=<#y>;#802=<#z>;\n")));
    EXPECT_TRUE(chain.refused.empty());
    EXPECT_EQ(chain.edges.size(), 3u);
}

TEST(StepAnchors, references_to_other_files_are_refused_with_their_line_and_name) {
    const Refusal r = told(kNames, "#801=<#b c>;\n#800=<bolts.stp#a>;\n#802=<#it's>;\n");
    EXPECT_EQ(r.kind, RefusalKind::unsupported);
    EXPECT_EQ(r.where, "#800");
    EXPECT_NE(r.message.find("refers to <bolts.stp#a>, which is in another file (line 10, byte "),
              r.message.npos)
        << r.message;
    // Nothing needs this one.
    const Model m = must(read_step(anchored_file(kNames, text(kNumbers, "#900=<bolts.stp#a>;\n"))));
    EXPECT_TRUE(m.refused.empty());
}

TEST(StepAnchors, references_that_lead_nowhere_are_refused) {
    const auto expect = [](std::string_view anchors, std::string_view references, std::string_view what) {
        const Refusal r = told(anchors, references);
        EXPECT_EQ(r.kind, RefusalKind::invalid) << what;
        EXPECT_NE(r.message.find(what), r.message.npos) << r.message;
    };
    expect("<a>=#800;\n", "#800=<#a>;\n", "refers to itself, by <#a>");
    expect("<a>=#801;<b>=#802;<c>=#801;\n", "#800=<#a>;#801=<#b>;#802=<#c>;\n", "refers to itself, by <#b>");
    expect("<a>=#200;\n", "#800=<#b>;\n", "refers to <#b>, which the file does not name");
    expect("<a>=(1.,2.);\n", "#800=<#a>;\n", "refers to <#a>, which is no instance");
    expect("<a>=#999;\n", "#800=<#a>;\n", "refers to <#a>, #999, which is not in the file");
    expect("<a>=#200;<a>=#201;\n", "#800=<#b>;\n", "the anchor <a> is given before");
}

TEST(StepAnchors, what_is_no_anchor_and_no_reference_is_told_with_its_line) {
    const Model m = must(read_step(anchored_file(
        text(kNames, "nothing;\n"), text(kNumbers, "#5=<#a>;\n#800=<#a>;\n@1=<#a>;\n#=<#a>;\n"))));
    EXPECT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.refused.size(), 5u);
    EXPECT_EQ(m.refused[0].kind, RefusalKind::unreadable);
    EXPECT_NE(m.refused[0].message.find("an anchor is expected: <name> = an instance (line 7, byte "),
              std::string::npos)
        << m.refused[0].message;
    EXPECT_EQ(m.refused[1].kind, RefusalKind::unsupported) << "a value";
    EXPECT_EQ(m.refused[2].kind, RefusalKind::unreadable);
    EXPECT_EQ(m.refused[3].where, "#5");
    EXPECT_NE(m.refused[3].message.find("its number is used before (line 13"), std::string::npos)
        << m.refused[3].message;
    EXPECT_EQ(m.refused[4].where, "#800");
}

TEST(StepAnchors, long_chains_take_linear_time) {
    constexpr int kLong = 100'000;
    std::string anchors = "<y>=#201;<z>=#202;<end>=#200;\n",
                references = "#801=<#y>;#802=<#z>;#800=<#1000>;\n";
    for (int i = 1000; i < kLong; ++i) {
        anchors += text("<", i, ">=#", 10'000 + i, ";\n");
        references += text("#", 10'000 + i, "=<#", i + 1 < kLong ? text(i + 1) : std::string("end"), ">;\n");
    }
    const std::string bytes = anchored_file(anchors, references);
    FF_EXPECT_LITTLE_EFFORT([&] { return must(read_step(bytes)).faces.size() == 1; });
}

}  // namespace
}  // namespace freiform::test
