// Nasty questions: how many answers are right, how many say that they do not know, how many are wrong, and
// how long the longest call takes. Lines: task longest_seconds count=.. right=.. open=.. wrong=..
#include <freiform/core/parallel.hpp>

#include <chrono>
#include <cstdio>
#include <nasty_curves.hpp>
#include <nasty_objects.hpp>

namespace {

using namespace freiform;

struct Tally {
    std::string name;
    int count = 0, verdicts[3] = {};
    double longest = 0;
};

void print(const char* task, const Tally& t) {
    std::string word = t.name;
    for (char& c : word)
        if (c == ' ') c = '_';
    std::printf("%s:%s %.9g count=%d right=%d open=%d wrong=%d\n", task, word.c_str(), t.longest, t.count,
                t.verdicts[0], t.verdicts[1], t.verdicts[2]);
}

// Runs f() -> verdict, with its time.
template <class F>
void tally(std::vector<Tally>& all, const std::string& name, F&& f) {
    auto at = std::find_if(all.begin(), all.end(), [&](const Tally& t) { return t.name == name; });
    if (at == all.end()) at = all.insert(all.end(), {name, 0, {}, 0});
    double seconds = 0;
    ++at->verdicts[int(f(seconds))];
    ++at->count;
    at->longest = std::max(at->longest, seconds);
}
template <class F>
auto timed(double& seconds, F&& f) {
    const auto begin = std::chrono::steady_clock::now();
    auto out = f();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

bench::Verdict meet(const bench::CurveCase& c, double& seconds) {
    const auto curve = [](const bench::NastyGrid& g) {
        return bench::PlaneBezier::make({*BSplineBasis::bezier(int(g.size()) - 1)},
                                        Net<1, Vec<2>>({int(g.size())}, g));
    };
    const auto a = curve(c.a), b = curve(c.b);
    if (!a || !b) return c.points < 0 ? bench::Verdict::right : bench::Verdict::wrong;
    const auto found = timed(seconds, [&] { return intersect(*a, *b); });
    return found ? bench::judge(c, *found) : bench::Verdict::wrong;
}

}  // namespace

int main() {
    set_max_threads(1);
    std::vector<Tally> known, curves, objects;
    for (const bench::CurveCase& c : bench::known_hard_cases())
        tally(known, c.kind, [&](double& s) { return meet(c, s); });
    bench::NastyCurves nasty(9101);
    for (int i = 0; i < 1000; ++i) {
        const bench::CurveCase c = nasty.next();
        tally(curves, c.kind, [&](double& s) { return meet(c, s); });
    }
    bench::NastyObjects things(9102);
    for (int i = 0; i < 250; ++i) {
        const bench::NastyObject object = things.next();
        for (const Vec<3>& q : object.questions)
            tally(objects, object.kind, [&](double& s) {
                return bench::judge(object, q, timed(s, [&] { return object.query.nearest<3>(q); }));
            });
    }
    for (const Tally& t : known) print("known", t);
    for (const Tally& t : curves) print("curves", t);
    for (const Tally& t : objects) print("nearest", t);
}
