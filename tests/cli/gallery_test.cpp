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

TEST_F(Gallery, every_row_has_a_figure_its_document_and_a_place_on_the_page) {
    const Ran r = run({"gallery", "-o", "figures/curves", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json report = Json::parse(r.out, nullptr, false);
    ASSERT_EQ(report["figures"].size(), rows().size());
    const std::string page = content(path("figures/curves/index.html"));
    EXPECT_EQ(trouble_in(page.substr(0, page.find("<style>"))).find("a bare"), std::string::npos);
    for (const char* elsewhere : {"http://", "https://", "<script", "@import", "url("})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << "no resources from elsewhere: " << elsewhere;
    for (const std::string& row : rows()) {
        const std::string svg = content(path("figures/curves/" + row + ".svg"));
        EXPECT_GT(svg.size(), 3000u) << row;
        EXPECT_EQ(trouble_in(svg), "") << row;
        for (const char* word : {"nan", "inf\"", "inf "})
            EXPECT_EQ(svg.find(word), std::string::npos) << row << " has a number that is none";
        std::multiset<std::string> ids;
        for (const std::string& id : attributes(svg, "id")) ids.insert(id);
        for (const std::string& id : ids) EXPECT_EQ(ids.count(id), 1u) << row << ": " << id;
        EXPECT_NE(page.find("<section id=\"" + row + "\">"), std::string::npos);
        EXPECT_NE(page.find("src=\"" + row + ".svg\""), std::string::npos);
        EXPECT_TRUE(read_document(content(path("figures/curves/" + row + ".json")))) << row;
        // Nothing is drawn outside of the page.
        const double width = std::stod(attributes(svg, "width").at(0)),
                     height = std::stod(attributes(svg, "height").at(0));
        for (const auto& [name, most] : {std::pair("cx", width), {"cy", height}, {"x", width}, {"y", height}})
            for (const std::string& x : attributes(svg, name)) {
                EXPECT_GE(std::stod(x), 0) << row;
                EXPECT_LE(std::stod(x), most) << row;
            }
    }
}

TEST_F(Gallery, the_commands_on_the_page_work) {
    ASSERT_EQ(run({"gallery", "-o", "."}).code, 0);
    const std::string page = content(path("index.html"));
    int commands = 0;
    for (std::size_t at = page.find("freiform draw "); at != std::string::npos;
         at = page.find("freiform draw ", at + 1)) {
        std::string line = page.substr(at + 9, page.find('\n', at) - at - 9);
        line = line.substr(0, line.find("</pre>"));
        std::vector<std::string> words;
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
        // The tag in the middle of the line has spaces of its own, which were skipped with it.
        const Ran r = run(words);
        EXPECT_EQ(r.code, 0) << line << ": " << r.err;
        EXPECT_EQ(r.err, "") << line;
        ++commands;
    }
    EXPECT_EQ(commands, 27);
}

TEST_F(Gallery, a_figure_can_be_chosen_in_every_format) {
    ASSERT_EQ(run({"gallery", "-o", "one", "--only", "r15"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(path("one/R15.svg")));
    EXPECT_FALSE(std::filesystem::exists(path("one/R01.svg")));
    EXPECT_FALSE(std::filesystem::exists(path("one/index.html"))) << "the page is about all";
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
