// Drawings made to take all memory or all time: each is read or refused within 256 MiB and a second.
#include <freiform/io/svg.hpp>

#include <cmath>
#include <effort.hpp>
#include <gtest/gtest.h>
#include <string>

using namespace freiform;

namespace {

std::string repeated(std::string_view what, int n) {
    std::string s;
    s.reserve(what.size() * std::size_t(n));
    for (int i = 0; i < n; ++i) s += what;
    return s;
}
std::string svg_holding(const std::string& inside) {
    return "<svg xmlns='http://www.w3.org/2000/svg'>" + inside + "</svg>";
}
// Ten of each in the one before, `depth` times.
std::string tenfold(const std::string& innermost, int depth) {
    std::string s = "<defs><g id='g0'>" + innermost + "</g>";
    for (int i = 1; i <= depth; ++i)
        s += "<g id='g" + std::to_string(i) + "'>" +
             repeated("<use href='#g" + std::to_string(i - 1) + "'/>", 10) + "</g>";
    return svg_holding(s + "</defs><use href='#g" + std::to_string(depth) + "'/>");
}

bool is_refused(const std::string& s) {
    const auto read = read_svg(s);
    return !read && read.error().kind == RefusalKind::limit;
}
bool is_empty(const std::string& s) {
    const auto read = read_svg(s);
    return read && read->shapes.empty();
}

TEST(SvgHostile, nested_use_is_refused_for_shapes_for_groups_and_for_long_paths) {
    for (const std::string& innermost :
         {std::string("<rect width='1' height='1'/>"), std::string("<circle r='1'/>"), std::string("<g/>"),
          "<path d='M 0 0" + repeated(" 1 1", 5000) + "'/>", "<path d='" + repeated("M 0 0", 5000) + "'/>",
          "<path d='M 0 0" + repeated("z", 5000) + "'/>",
          "<polygon points='" + repeated("1 2 ", 5000) + "'/>"})
        FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(tenfold(innermost, 7)); });
}

TEST(SvgHostile, texts_that_every_use_has_of_its_own_are_refused) {
    const std::string many = repeated("<use href='#r'/>", 50000),
                      rect = "<rect id='r' width='1' height='1'/>";
    const std::string dashes = repeated("1 ", 50000), name(50000, 'n');
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_refused(svg_holding("<g stroke-dasharray='" + dashes + "'>" + rect + many + "</g>"));
    });
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_refused(svg_holding("<g id='r'><rect width='1' height='1' id='" + name + "'/></g>" + many));
    });
    // Paints that long mean nothing.
    FF_EXPECT_LITTLE_EFFORT([&] {
        const auto read = read_svg(svg_holding("<g fill='" + name + "'>" + rect + many + "</g>"));
        return read && read->shapes.size() == 50001 && read->shapes[0].fill == "black";
    });
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_refused(
            svg_holding("<rect id='r' width='1' height='1' style='" + repeated("a:b;", 9000) + "'/>" + many));
    });
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_empty(
            svg_holding("<rect width='1' height='1' style='" + repeated("a:b;", 1000000) + "'/>"));
    });
    // Names of elements that mean nothing are not quoted in full.
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_empty(svg_holding("<g id='r'><" + name + "/></g>" + repeated("<use href='#r'/>", 5000)));
    });
}

TEST(SvgHostile, style_sheets_that_say_a_thing_for_everyone_are_refused) {
    const std::string many = repeated("<rect width='1' height='1' class='a'/>", 20000);
    const auto sheet = [&](const std::string& css) {
        return svg_holding("<style>" + css + "</style>" + many);
    };
    FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(sheet("*{" + repeated("a:b;", 50000) + "}")); });
    FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(sheet("*{" + repeated("a:b;", 2000000) + "}")); });
    FF_EXPECT_LITTLE_EFFORT(
        [&] { return is_refused(sheet(repeated(".a,", 20000) + ".a{" + repeated("a:b;", 20000) + "}")); });
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_refused(svg_holding("<style>.a{" + repeated("a:b;", 20000) +
                                      "}</style><rect width='1' height='1' class='" + repeated("a ", 100000) +
                                      "'/>"));
    });
}

TEST(SvgHostile, a_path_of_millions_of_segments_is_refused_and_one_of_half_a_million_is_read) {
    FF_EXPECT_LITTLE_EFFORT(
        [&] { return is_refused(svg_holding("<path d='M 0 0" + repeated("h1", 4000000) + "'/>")); });
    FF_EXPECT_LITTLE_EFFORT(
        [&] { return is_refused(svg_holding("<path d='M 0 0" + repeated("zh1", 2000000) + "'/>")); });
    FF_EXPECT_LITTLE_EFFORT(
        [&] { return is_refused(svg_holding("<path d='M 0 0h" + repeated(" 1", 4000000) + "'/>")); });
    FF_EXPECT_LITTLE_EFFORT([&] {
        const auto read = read_svg(svg_holding("<path d='M 0 0" + repeated("h1", 500000) + "'/>"));
        return read && read->shapes.at(0).path.subpaths.at(0).segments.size() == 500000;
    });
}

TEST(SvgHostile, entities_are_not_expanded) {
    std::string laughs = "<!DOCTYPE svg [<!ENTITY l0 'M 0 0 L 1 1'>";
    for (int i = 1; i < 30; ++i)
        laughs +=
            "<!ENTITY l" + std::to_string(i) + " '" + repeated("&l" + std::to_string(i - 1) + ";", 10) + "'>";
    laughs += "<!ENTITY file SYSTEM 'file:///etc/passwd'>]>";
    FF_EXPECT_LITTLE_EFFORT([&] {
        const auto read = read_svg(laughs + svg_holding("<path id='&file;' d='&l29;'/><g>&l29;&file;</g>"));
        return read && read->shapes.empty();
    });
    // No document type ends here.
    FF_EXPECT_LITTLE_EFFORT([&] { return !read_svg(repeated("<!DOCTYPE svg [", 100000)); });
}

TEST(SvgHostile, numbers_of_2_to_the_31_and_no_numbers_are_numbers_or_left_out) {
    for (const char* number : {"2147483648", "-2147483649", "18446744073709551616", "1e308", "1e-320"})
        for (const std::string& shape :
             {std::string("<rect width='N' height='N' rx='N'/>"), std::string("<circle r='N' cx='N'/>"),
              std::string("<path d='M N N A N N 0 1 1 -1 N N N 0 0 0 N 1'/>"),
              std::string("<svg viewBox='N N N N' width='N' height='N'><path d='M 1 1 H N'/></svg>"),
              std::string("<path transform='scale(N) translate(N N)' d='M 1 1 H N' stroke-width='N' "
                          "stroke-dasharray='N' style='font-size:N'/>")}) {
            std::string s = shape;
            for (std::size_t at; (at = s.find('N')) != std::string::npos;) s.replace(at, 1, number);
            FF_EXPECT_LITTLE_EFFORT([&] {
                const auto read = read_svg(svg_holding(s));
                bool finite = read.has_value();
                for (const SvgShape& shown : read->shapes)
                    for (const Subpath& sub : shown.path.subpaths)
                        for (const PathSegment& g : sub.segments)
                            for (int i = 0; i <= g.degree; ++i)
                                finite = finite && std::isfinite(max_abs(g.points[std::size_t(i)]));
                return finite;
            });
        }
    for (const char* none : {"NaN", "nan", "inf", "-Infinity", "0x10", "1e999"})
        FF_EXPECT_LITTLE_EFFORT([&] {
            const std::string n = none;
            const auto read =
                read_svg(svg_holding("<rect x='" + n + "' width='" + n + "' height='1'/><path d='M " + n +
                                     " 0 L 1 1'/><circle r='" + n + "'/>"));
            return read && read->shapes.empty() && !read->left_out.empty();
        });
}

TEST(SvgHostile, references_in_a_circle_end) {
    std::string ring;
    for (int i = 0; i < 1000; ++i)
        ring +=
            "<g id='g" + std::to_string(i) + "'><use href='#g" + std::to_string((i + 1) % 1000) + "'/></g>";
    FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(svg_holding(ring)) || is_empty(svg_holding(ring)); });
    // Everyone refers to everyone.
    std::string all;
    for (int i = 0; i < 60; ++i) {
        all += "<g id='g" + std::to_string(i) + "'>";
        for (int k = 0; k < 60; ++k) all += "<use href='#g" + std::to_string(k) + "'/>";
        all += "</g>";
    }
    FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(svg_holding(all)); });
    FF_EXPECT_LITTLE_EFFORT([&] {
        return is_empty(svg_holding("<use id='a' href='#a'/><use id='b' href='#c'/><use id='c' href='#b'/>"));
    });
    // Deep, and used from inside.
    const std::string deep = "<defs>" + repeated("<g>", 200000) + "<g id='d'>" +
                             repeated("<use href='#e'/>", 20000) + "</g>" + repeated("</g>", 200000) +
                             "<g id='e'/></defs><use href='#d'/>";
    FF_EXPECT_LITTLE_EFFORT([&] { return is_refused(svg_holding(deep)); });
}

}  // namespace
