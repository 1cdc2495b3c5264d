#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/svg.hpp>
#include <freiform/query/length.hpp>

#include <corpus.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <refusal.hpp>

namespace freiform {
namespace {

SvgPicture picture(const std::string& inside, const std::string& attributes = "viewBox=\"0 0 200 100\"") {
    auto p =
        read_svg("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" " +
                 attributes + ">" + inside + "</svg>");
    EXPECT_TRUE(p) << p.error().where << ' ' << p.error().message;
    return p ? *p : SvgPicture();
}
// The paths as SVG would write them (y down), separated by bars.
std::string data(const SvgPicture& p) {
    std::string out;
    for (const SvgShape& s : p.shapes)
        out += (out.empty() ? "" : " | ") + path_data(transformed(s.path, {{{{1, 0}, {0, -1}}}, {}}));
    return out;
}
std::string data(const std::string& inside) { return data(picture(inside)); }

TEST(Svg, shapes_are_paths_with_y_turned_up) {
    const SvgPicture p = picture("<path id='a' d='M 1 2 L 3 4'/>", "viewBox='10 20 30 40'");
    EXPECT_EQ(p.shapes[0].path.subpaths[0].segments[0].back(), (Vec<2>{{3, -4}}));
    EXPECT_EQ(p.view.lo, (Vec<2>{{10, -60}}));
    EXPECT_EQ(p.view.hi, (Vec<2>{{40, -20}}));
    EXPECT_EQ(data("<rect x='1' y='2' width='3' height='4'/>"), "M 1,2 L 4,2 L 4,6 L 1,6 Z");
    EXPECT_EQ(data("<rect width='30' height='40' rx='5'/>"),
              data("<rect width='30' height='40' rx='5' ry='5'/>"));
    const std::string round = data("<rect width='30' height='40' rx='5' ry='10'/>");
    EXPECT_EQ(round.substr(0, 13), "M 5,0 L 25,0 ") << round;
    EXPECT_EQ(data("<rect width='10' height='10' rx='50' ry='2'/>"),
              data("<rect width='10' height='10' rx='5' ry='2'/>"));
    EXPECT_EQ(data("<rect width='10'/><rect width='-1' height='2'/><circle/><circle r='-1'/>"), "");
    EXPECT_EQ(data("<line x1='1' y1='2' x2='3' y2='4'/>"), "M 1,2 L 3,4");
    EXPECT_EQ(data("<polyline points='1,2 3 4,5-6 7'/>"), "M 1,2 L 3,4 L 5,-6");
    EXPECT_EQ(data("<polygon points='0,0 1,0 1,1'/>"), "M 0,0 L 1,0 L 1,1 Z");
    EXPECT_EQ(data("<ellipse cx='1' cy='2' rx='3'/>"), data("<circle cx='1' cy='2' r='3'/>"));
    const SvgPicture c = picture("<circle cx='1' cy='2' r='3'/>");
    const auto curve = std::get<Curve<Hom<2>>>(document_of(c).objects[0].shape);
    for (int i = 0; i < 50; ++i) EXPECT_NEAR(norm(curve(4 * i / 50.0) - Vec<2>{{1, -2}}), 3, 1e-14);
}

TEST(Svg, transforms_act_from_the_inside_out) {
    EXPECT_EQ(
        data("<g transform='translate(10,20) scale(2)'><path transform='rotate(90)' d='M 1 0 L 2 0'/></g>"),
        "M 10,22 L 10,24");
    EXPECT_EQ(data("<path transform='matrix(1 2 3 4 5 6)' d='M 1 1 L 0 0'/>"), "M 9,12 L 5,6");
    EXPECT_EQ(data("<path transform='rotate(180, 5, 5) , translate( 1 )' d='M 0 0 L 1 1'/>"), "M 9,10 L 8,9");
    const SvgPicture skew = picture("<path transform='skewX(45)' d='M 0 1 L 0 2'/>");
    EXPECT_EQ(data(picture("<path d='M 0 0 L 1 1'/>", "viewBox='0 0 9 9' transform='scale(3)'")),
              "M 0,0 L 3,3");
    EXPECT_NEAR(skew.shapes[0].path.subpaths[0].start[0], 1, 1e-15);
    const SvgPicture bad =
        picture("\n\n<path id='p' transform='turn(3)' d='M 0 0 L 1 1'/><path d='M 0 0 L 1 1'/>");
    EXPECT_EQ(bad.shapes.size(), 1u);
    ASSERT_EQ(bad.left_out.size(), 1u);
    EXPECT_EQ(bad.left_out[0].where, "line 3: <path id=\"p\">");
}

TEST(Svg, lengths_have_units_and_viewports) {
    EXPECT_EQ(data("<line x1='1in' x2='72pt' y1='25.4mm' y2='1e1'/>"), "M 96,96 L 96,10");
    EXPECT_EQ(data("<line x1='50%' y1='50%' x2='1em' y2='2ex' font-size='10'/>"), "M 100,50 L 10,10");
    EXPECT_EQ(data("<svg x='10' y='20' width='50' height='50' viewBox='0 0 100 50'><path d='M 0 0 L 100 "
                   "50'/></svg>"),
              "M 10,32.5 L 60,57.5");
    EXPECT_EQ(data("<svg width='50' height='50' viewBox='0 0 100 50' preserveAspectRatio='none'><path d='M 0 "
                   "0 L 100 50'/></svg>"),
              "M 0,0 L 50,50");
    EXPECT_EQ(picture("", "width='210mm' height='297mm' viewBox='0 0 210 297'").unit, "mm");
    EXPECT_EQ(picture("", "width='210' height='297' viewBox='0 0 210 297'").unit, "");
    EXPECT_EQ(picture("<rect width='1furlong' height='2'/>").left_out.size(), 1u);
}

TEST(Svg, things_are_used_again_but_not_inside_themselves) {
    EXPECT_EQ(
        data("<defs><path id='p' d='M 0 0 L 1 1'/></defs><use href='#p' x='5'/><use xlink:href='#p' y='7'/>"),
        "M 5,0 L 6,1 | M 0,7 L 1,8");
    EXPECT_EQ(data("<symbol id='s' viewBox='0 0 10 10'><path d='M 0 0 L 10 10'/></symbol><use href='#s' "
                   "width='20' height='20'/>"),
              "M 0,0 L 20,20");
    const SvgPicture round =
        picture("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/><path d='M 0 0 L 1 1'/></g>");
    EXPECT_EQ(round.left_out.size(), 2u);
    EXPECT_EQ(picture("<use href='other.svg#x'/>").left_out.size(), 1u);
    // 10^10 rectangles in a kilobyte.
    std::string bomb = "<g id='g0'><rect width='1' height='1'/></g>";
    for (int i = 1; i <= 10; ++i) {
        bomb += "<g id='g" + std::to_string(i) + "'>";
        for (int k = 0; k < 10; ++k) bomb += "<use href='#g" + std::to_string(i - 1) + "'/>";
        bomb += "</g>";
    }
    const auto refused = read_svg("<svg>" + bomb + "</svg>");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::limit);
}

TEST(Svg, styles_come_from_attributes_sheets_and_style_in_this_order) {
    const SvgPicture p = picture(
        "<style>/* x */ path { fill : red } .c, .d { stroke-width: 3 } #i{stroke:blue !important} a > b { "
        "fill: none }</style>"
        "<g stroke='green' fill-rule='evenodd' transform='scale(2)'>"
        "<path id='i' class='c' fill='yellow' stroke-width='9' style='stroke-dasharray: 1, 2 3; "
        "stroke-linecap:round' d='M 0 0 L 1 1'/>"
        "<rect width='1' height='1' stroke-linejoin='bevel' stroke-width='1%'/></g>"
        "<g display='none'><path d='M 0 0 L 1 1'/></g><path visibility='hidden' d='M 0 0 L 1 1'/>");
    ASSERT_EQ(p.shapes.size(), 2u);
    const SvgShape &a = p.shapes[0], &b = p.shapes[1];
    EXPECT_EQ(a.fill, "red");
    EXPECT_EQ(a.stroke, "blue");
    EXPECT_EQ(a.line.width, 6);
    EXPECT_EQ(a.line.dashes, (std::vector<double>{2, 4, 6, 2, 4, 6}));
    EXPECT_EQ(a.line.cap, LineCap::round);
    EXPECT_EQ(b.fill, "black");
    EXPECT_EQ(b.stroke, "green");
    EXPECT_EQ(b.fill_rule, FillRule::evenodd);
    EXPECT_EQ(b.line.join, LineJoin::bevel);
    EXPECT_NEAR(b.line.width, 2 * 0.01 * std::sqrt((200.0 * 200 + 100 * 100) / 2), 1e-12);
    EXPECT_EQ(p.left_out.size(), 1u);  // the rule with two elements
}

TEST(Svg, what_is_damaged_is_refused_or_named) {
    test::expect_refusal(read_svg("<svg><path d='M 0 0'</svg>"), RefusalKind::unreadable, "line 1");
    test::expect_refusal(read_svg("\n<html></html>"), RefusalKind::unreadable, "line 2: <html>");
    EXPECT_FALSE(read_svg(""));
    test::expect_refusal(read_svg(std::string(4 << 20, '<')), RefusalKind::limit, "");
    const SvgPicture p = picture(
        "<path d='M 0 0 L 1 1 L 2 q'/><path d='M 0 0 L 1e308 1e308' "
        "transform='scale(10)'/>\n<text>hi</text>");
    EXPECT_EQ(data(p), "M 0,0 L 1,1");
    ASSERT_EQ(p.left_out.size(), 3u);
    EXPECT_EQ(p.left_out[1].kind, RefusalKind::nonfinite);
    EXPECT_EQ(p.left_out[2].where, "line 2: <text>");
    std::string deep;
    for (int i = 0; i < 5000; ++i) deep += "<g>";
    EXPECT_EQ(picture(deep + std::string(5000, ' ') +
                      [] {
                          std::string s;
                          for (int i = 0; i < 5000; ++i) s += "</g>";
                          return s;
                      }())
                  .left_out.size(),
              1u);
    // So much is left out that only its number is said.
    std::string many;
    for (int i = 0; i < 1500; ++i) many += "<text/>";
    const SvgPicture all = picture(many);
    ASSERT_EQ(all.left_out.size(), 1001u);
    EXPECT_NE(all.left_out.back().message.find("500 more"), std::string::npos) << all.left_out.back().message;
    // Geometry in styles is not read; what has it is named instead of shown in a wrong place.
    const SvgPicture moved = picture(
        "<path style='transform: scale(2)' d='M 0 0 L 1 1'/><circle r='1' style='r: 5px'/>"
        "<path d='M 3 3 L 4 4' clip-path='url(#c)'/>");
    EXPECT_EQ(data(moved), "M 3,3 L 4,4");
    EXPECT_EQ(moved.left_out.size(), 3u);  // the last one for its clip
    // Entities of a document type stay what they are.
    const auto laughs = read_svg("<!DOCTYPE svg [<!ENTITY a \"M 0 0 L 1 1\">]><svg><path d='&a;'/></svg>");
    ASSERT_TRUE(laughs);
    EXPECT_TRUE(laughs->shapes.empty());
}

TEST(Svg, documents_are_written_and_read_back) {
    const SvgPicture p = picture(
        "<path id='a' d='M 1 2 L 3 4 C 5 6 7 9 9 10 Z M 0.1 0.2 A 3 2 20 1 0 5 5'/>"
        "<circle id='c&lt;' fill='none' stroke='#123456' stroke-width='0.5' stroke-dasharray='1 2' r='3'/>");
    const auto again = read_svg(write_svg(p));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->view.lo, p.view.lo);
    EXPECT_EQ(again->view.hi, p.view.hi);
    ASSERT_EQ(again->shapes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(again->shapes[i].id, p.shapes[i].id);
        EXPECT_EQ(again->shapes[i].fill, p.shapes[i].fill);
        EXPECT_EQ(again->shapes[i].line.dashes, p.shapes[i].line.dashes);
    }
    const Document d = document_of(p);
    ASSERT_EQ(d.objects.size(), 3u);
    EXPECT_EQ(d.objects[1].name, "a/2");
    const auto drawn = picture_of(d, 1e-6);
    ASSERT_TRUE(drawn);
    EXPECT_EQ(drawn->bound, 0);
    const Document back = document_of(*read_svg(write_svg(drawn->picture)));
    ASSERT_EQ(back.objects.size(), 3u);
    EXPECT_EQ(std::get<Curve<Vec<2>>>(back.objects[0].shape), std::get<Curve<Vec<2>>>(d.objects[0].shape));
    Document wrong;
    wrong.objects.push_back(
        {"s",
         *Curve<Vec<3>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<3>>({2}, {{{0, 0, 0}}, {{1, 0, 0}}})),
         {}});
    test::expect_refusal(picture_of(wrong, 1e-6), RefusalKind::unsupported, "objects[0]");
}

TEST(Svg, path_data_have_the_lengths_that_are_known) {
    FF_CORPUS_OR_SKIP(oracle, "oracle/svg_lengths_open.json");
    const auto known = nlohmann::json::parse(*read_file(oracle.string(), 1 << 24));
    int compared = 0;
    for (const auto& c : known["cases"]) {
        if (!c.contains("d") || c.contains("error")) continue;
        const std::string d = c["d"].get<std::string>();
        const PathData path = parse_path_data(d);
        // What made these numbers wants blanks between flags, goes on after those that are none, and does not
        // mirror the control point of a first T; the reference pictures beside the drawings do as the
        // specification says.
        const bool only_t = d.find_first_of("Tt") != d.npos && d.find_first_of("Qq") == d.npos;
        const bool flags_together = d.find(" 0 10 ") != d.npos;
        if (path.stopped || only_t || flags_together) continue;
        double sum = 0;
        for (const Subpath& s : path.path.subpaths)
            if (!s.segments.empty())
                sum += std::visit([](const auto& curve) { return length(curve, 1e-9).value; }, curve_of(s));
        EXPECT_NEAR(sum, c["length"].get<double>(), 1e-3 * sum + 1e-6) << d;
        ++compared;
    }
    EXPECT_GE(compared, 80);
}

}  // namespace
}  // namespace freiform
