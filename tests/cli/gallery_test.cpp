#include "run.hpp"

#include <freiform/io/document.hpp>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Gallery = Program;

std::vector<std::string> rows() {
    std::vector<std::string> out;
    for (int i = 1; i <= 29; ++i) out.push_back((i < 10 ? "R0" : "R") + std::to_string(i));
    out.push_back("R31");
    for (const char* row : {"R32", "R33", "R34", "R35", "R36"}) out.push_back(row);
    return out;
}

// What is wrong with the tags of an XML text; empty if all are closed in order and quoted.
std::string trouble_in(const std::string& s) {
    std::vector<std::string> open;
    for (std::size_t at = s.find('<'); at != std::string::npos; at = s.find('<', at + 1)) {
        const std::size_t end = s.find('>', at);
        if (end == std::string::npos) return "a tag without an end";
        const std::string tag = s.substr(at + 1, end - at - 1);
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "a quote without an end in " + tag;
        if (tag.find('<') != std::string::npos) return "a bare < in " + tag;
        if (tag[0] == '?' || tag[0] == '!') continue;
        if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1))
                return "</" + tag.substr(1) + "> without its begin";
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(tag.substr(0, tag.find(' ')));
        }
        at = end;
    }
    return open.empty() ? "" : open.back() + " is not closed";
}

std::vector<std::string> attributes(const std::string& s, const std::string& name) {
    std::vector<std::string> out;
    const std::string begin = " " + name + "=\"";
    for (std::size_t at = s.find(begin); at != std::string::npos; at = s.find(begin, at + 1))
        out.push_back(s.substr(at + begin.size(), s.find('"', at + begin.size()) - at - begin.size()));
    return out;
}

// The words of the commands `freiform draw` on a page, without its tags.
std::vector<std::vector<std::string>> commands_on(const std::string& page) {
    std::vector<std::vector<std::string>> out;
    for (std::size_t at = page.find("freiform draw "); at != std::string::npos;
         at = page.find("freiform draw ", at + 1)) {
        std::string line = page.substr(at + 9, page.find('\n', at) - at - 9);
        line = line.substr(0, line.find("</pre>"));
        std::vector<std::string>& words = out.emplace_back();
        std::string word;
        bool tag = false;
        for (const char c : line + " ") {
            tag = c == '<' || (tag && c != '>');
            if (tag || c == '>') continue;
            if (c != ' ') {
                word += c;
            } else if (!word.empty()) {
                words.push_back(word);
                word.clear();
            }
        }
    }
    return out;
}

void check_figure(const std::string& row, const std::string& svg) {
    EXPECT_GT(svg.size(), 3000u) << row;
    EXPECT_EQ(trouble_in(svg), "") << row;
    for (const char* word : {"nan", "inf\"", "inf "})
        EXPECT_EQ(svg.find(word), std::string::npos) << row << " has a number that is none";
    std::multiset<std::string> ids;
    for (const std::string& id : attributes(svg, "id")) ids.insert(id);
    for (const std::string& id : ids) EXPECT_EQ(ids.count(id), 1u) << row << ": " << id;
    // Nothing is drawn outside of the page.
    const double width = std::stod(attributes(svg, "width").at(0)),
                 height = std::stod(attributes(svg, "height").at(0));
    for (const auto& [name, most] : {std::pair("cx", width), {"cy", height}, {"x", width}, {"y", height}})
        for (const std::string& x : attributes(svg, name)) {
            EXPECT_GE(std::stod(x), 0) << row;
            EXPECT_LE(std::stod(x), most) << row;
        }
}

// A part of the rows, so that no test takes long where sanitizers slow it down.
constexpr int kParts = 6;
class GalleryRows : public Program, public testing::WithParamInterface<int> {};

TEST_P(GalleryRows, have_figures_documents_places_on_the_page_and_commands_that_work) {
    std::vector<std::string> shown, words = {"gallery", "-o", ".", "--json", "--only"};
    for (std::size_t i = std::size_t(GetParam()); i < rows().size(); i += kParts) shown.push_back(rows()[i]);
    words.insert(words.end(), shown.begin(), shown.end());
    const Ran r = run(words);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json report = Json::parse(r.out, nullptr, false);
    ASSERT_EQ(report["figures"].size(), shown.size());
    const std::string page = content(path("index.html"));
    EXPECT_EQ(trouble_in(page.substr(0, page.find("<style>"))).find("a bare"), std::string::npos);
    for (const char* elsewhere : {"http://", "https://", "<script", "@import", "url("})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << "no resources from elsewhere: " << elsewhere;
    std::size_t drawn_alone = 0;
    for (const std::string& row : shown) {
        check_figure(row, content(path(row + ".svg")));
        EXPECT_NE(page.find("<section id=\"" + row + "\">"), std::string::npos);
        EXPECT_NE(page.find("src=\"" + row + ".svg\""), std::string::npos);
        EXPECT_TRUE(read_document(content(path(row + ".json")))) << row;
        drawn_alone += row != "R08" && row != "R09" && row != "R10";  // joints are more than their curves
    }
    const auto commands = commands_on(page);
    EXPECT_EQ(commands.size(), drawn_alone);
    for (const auto& command : commands) {
        const Ran again = run(command);
        EXPECT_EQ(again.code, 0) << command.at(1) << ": " << again.err;
        EXPECT_EQ(again.err, "") << command.at(1);
    }
}

INSTANTIATE_TEST_SUITE_P(parts, GalleryRows, testing::Range(0, kParts));

TEST_F(Gallery, a_figure_can_be_chosen_in_every_format) {
    ASSERT_EQ(run({"gallery", "-o", "one", "--only", "r15"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(path("one/R15.svg")));
    EXPECT_FALSE(std::filesystem::exists(path("one/R01.svg")));
    EXPECT_FALSE(std::filesystem::exists(path("one/index.html"))) << "a page is about several";
    const Ran pdf = run({"gallery", "-o", "one", "--only", "R15", "--to", "pdf"});
    if (pdf.code == 3 && pdf.err.find("libcairo2-dev") != std::string::npos) GTEST_SKIP() << pdf.err;
    ASSERT_EQ(pdf.code, 0) << pdf.err;
    EXPECT_TRUE(content(path("one/R15.pdf")).starts_with("%PDF-1."));
    ASSERT_EQ(run({"gallery", "-o", "one", "--only", "R15", "--to", "png"}).code, 0);
    EXPECT_TRUE(content(path("one/R15.png")).starts_with("\x89PNG"));
}

TEST_F(Gallery, wrong_usage_and_folders_that_cannot_be_made_are_said) {
    EXPECT_EQ(run({"gallery"}).code, 2);
    EXPECT_EQ(run({"gallery", "-o", "a", "--only", "R99"}).code, 2);
    EXPECT_EQ(run({"gallery", "-o", "a", "--to", "gif"}).code, 2);
    file("taken", "a file");
    EXPECT_EQ(run({"gallery", "-o", "taken/figures"}).code, 5);
}

}  // namespace
}  // namespace freiform::test
