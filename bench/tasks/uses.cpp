// What drawings and letters take: every glyph of fonts, and Boolean operations on random and nasty pairs of
// paths. Lines: glyphs:FILE:STEP seconds_per_glyph count= refused= longest=, and pairs:KIND seconds_per_pair
// count= right= wrong= refused= longest= off=.
#include <freiform/core/parallel.hpp>
#include <freiform/font/font.hpp>
#include <freiform/path/flatten.hpp>
#include <freiform/region/stroke.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <nasty_regions.hpp>

namespace {

using namespace freiform;

// Of the processor: others may be at work.
double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

struct Step {
    const char* name;
    int count = 0, refused = 0;
    double seconds = 0, longest = 0;
    std::string where = {};
};

// f() says whether there was an answer.
template <class F>
bool timed(Step& step, int index, F&& f) {
    const double begin = processor_seconds();
    const bool ok = f();
    const double s = processor_seconds() - begin;
    ++step.count, step.refused += !ok, step.seconds += s;
    if (s > step.longest) step.longest = s, step.where = text(index);
    return ok;
}

bool glyphs(const char* file) {
    std::ifstream in(file, std::ios::binary);
    const auto font = Font::parse({std::istreambuf_iterator<char>(in), {}});
    if (!font) return false;
    const double em = font->info().units_per_em;
    const RegionOptions options{.tolerance = em / 1000};
    Step all[] = {{"read"}, {"flattened"}, {"united"}, {"stroked"}};
    for (int g = 0; g < font->info().glyphs; ++g) {
        Path path;
        if (!timed(all[0], g, [&] {
                auto glyph = font->glyph(g);
                if (glyph) path = std::move(glyph->path);
                return glyph.has_value();
            }))
            continue;
        if (path.subpaths.empty()) continue;  // blanks count as read
        timed(all[1], g, [&] {
            bool ok = true;
            for (const Subpath& s : path.subpaths)
                std::visit(
                    [&](const auto& c) { ok = ok && flatten(c, {.tolerance = em / 1000}).has_value(); },
                    curve_of(s));
            return ok;
        });
        timed(all[2], g, [&] { return region_of({path}, options).has_value(); });
        StrokeStyle style;
        style.width = em / 20;
        timed(all[3], g, [&] { return stroked(path, style, options).has_value(); });
    }
    std::string name = file;
    name.erase(0, name.rfind('/') + 1);
    for (const Step& s : all)
        std::printf("glyphs:%s:%s %.9g count=%d refused=%d longest=%.9g at=%s\n", name.c_str(), s.name,
                    s.seconds / s.count, s.count, s.refused, s.longest,
                    s.where.empty() ? "0" : s.where.c_str());
    return true;
}

struct Pairs {
    int count = 0, right = 0, wrong = 0, refused = 0;
    double seconds = 0, longest = 0, off = 0;
};

// Areas of the four operations and of both paths: |A or B| = |A| + |B| - |A and B|, |A - B| = |A| - |A and
// B|, |A xor B| = |A or B| - |A and B|. Wrong: one of them does not hold to 1e-9 of the areas and to what the
// bounds of outlines leave open.
void judge(Pairs& to, const Filled& a, const Filled& b, double tolerance) {
    const RegionOptions options{.tolerance = tolerance};
    Box<2> box;
    double length = 0;
    for (const Path* p : {&a.path, &b.path})
        for (const Subpath& s : p->subpaths)
            for (const PathSegment& g : s.segments)
                for (int i = 0; i <= g.degree; ++i) {
                    box.add(g.points[std::size_t(i)]);
                    if (i > 0) length += norm(g.points[std::size_t(i)] - g.points[std::size_t(i) - 1]);
                }
    const double begin = processor_seconds();
    std::vector<Result<Region>> all;
    for (const auto o : {RegionOperation::union_of, RegionOperation::intersection,
                         RegionOperation::difference, RegionOperation::exclusion})
        all.push_back(combine(a, b, o, options));
    const double s = processor_seconds() - begin;
    ++to.count, to.seconds += s, to.longest = std::max(to.longest, s);
    all.push_back(region_of(a, options)), all.push_back(region_of(b, options));
    double area[6] = {}, open = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i]) return void(++to.refused);
        const PathArea measured = signed_area(all[i]->path);
        area[i] = measured.value;
        open = std::max(open, all[i]->bound * length + 10 * all[i]->bound * all[i]->bound + measured.bound);
    }
    const double off =
        std::max({std::abs(area[0] - area[4] - area[5] + area[1]), std::abs(area[2] - area[4] + area[1]),
                  std::abs(area[3] - area[0] + area[1])});
    const double sum = area[4] + area[5], size = box.is_empty() ? 0 : box.diagonal();
    const bool ok = off <= 1e-9 * sum + 4 * open;
    ++(ok ? to.right : to.wrong);
    if (sum > 1e-6 * size * size) to.off = std::max(to.off, off / sum);
}

void print(const char* kind, const Pairs& p) {
    std::printf("pairs:%s %.9g count=%d right=%d wrong=%d refused=%d longest=%.9g off=%.3g\n", kind,
                p.seconds / p.count, p.count, p.right, p.wrong, p.refused, p.longest, p.off);
}

}  // namespace

int main(int n, char** fonts) {
    set_max_threads(1);
    for (int i = 1; i < n; ++i)
        if (!glyphs(fonts[i])) std::printf("glyphs:%s failed\n", fonts[i]);
    test::Random random(1);
    Pairs polygons, curves, nasty;
    for (int i = 0; i < 1000; ++i) {
        const test::PathOptions o{
            .segments = random.integer(2, 4), .lattice = i % 4 == 1, .lines = i % 4 >= 2};
        const Path a = test::random_path(random, o), b = test::random_path(random, o);
        judge(o.lines ? polygons : curves, {a, FillRule(i % 2)}, {b, FillRule(i / 2 % 2)}, 1e-9);
    }
    for (const auto& p : test::nasty_pairs())
        for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd})
            judge(nasty, {p.a, rule}, {p.b, rule}, p.tolerance);
    print("random_polygons", polygons), print("random_curves", curves), print("nasty", nasty);
    return 0;
}
