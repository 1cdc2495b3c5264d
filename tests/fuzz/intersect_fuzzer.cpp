// libFuzzer: intersections of two arbitrary curves, of the plane or of space, polynomial or rational, with
// knots. Not part of the test suite; with clang,
//   tests/fuzz/run.sh intersect 300
// builds and runs it for 300 seconds.
//
// Checked is what the header promises: parameters in their boxes, boxes in the domains, points of both curves
// no farther from each other than `gap`, order, counts; and that exchanging the curves exchanges the answer.
#include "bytes.hpp"

#include <freiform/intersect/curve_curve.hpp>

#include <algorithm>

using namespace freiform;

namespace {

// Small integers and eighths, so that curves touch and overlap; or any double.
double number(Bytes& bytes, int kind) {
    return kind % 4 != 0 ? (bytes.next() - 128) / (kind % 2 == 0 ? 1.0 : 8.0) : bytes.any();
}

template <class P>
std::optional<Curve<P>> curve_of(Bytes& bytes, int kind) {
    const int degree = 1 + bytes.next() % 5, inner = bytes.next() % 4;
    std::vector<double> knots(std::size_t(degree) + 1, 0.0);
    double at = 0;
    for (int i = 0; i < inner; ++i) knots.push_back(at += bytes.next() % 3);
    knots.insert(knots.end(), std::size_t(degree) + 1, at + 1);
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return {};
    std::vector<P> c;
    for (int i = 0; i < basis->size(); ++i) {
        P p;
        for (int k = 0; k < P::kCoords; ++k) p[k] = number(bytes, kind);
        if constexpr (Space<P>::kRational) p[P::kCoords - 1] = 0.125 * (1 + bytes.next() % 32);
        c.push_back(p);
    }
    const int n = basis->size();
    auto made = Curve<P>::make({*std::move(basis)}, Net<1, P>({n}, std::move(c)));
    if (!made) return {};
    return *std::move(made);
}

template <class P>
void check_contacts(const Curve<P>& a, const Curve<P>& b, const Intersections<Space<P>::kDim, 2>& found) {
    const std::array domain{a.domain()[0], b.domain()[0]};
    for (std::size_t i = 0; i < found.contacts.size(); ++i) {
        const auto& c = found.contacts[i];
        for (std::size_t k = 0; k < 2; ++k) {
            demand(c.box[k].contains(c.at[k]));
            demand(domain[k].lo <= c.box[k].lo && c.box[k].hi <= domain[k].hi);
        }
        demand(c.least >= 0 && c.least <= c.most && c.gap >= 0);
        if (i > 0) demand(found.contacts[i - 1].at <= c.at);
        const double apart = norm(a(c.at[0]) - b(c.at[1]));
        const double noise = 4 * (a.value_error_bound() + b.value_error_bound());
        // At a jump the value is that after it; the contact may be before.
        const bool jump = a.basis().multiplicity(c.at[0]) > a.basis().degree() ||
                          b.basis().multiplicity(c.at[1]) > b.basis().degree();
        if (!jump && std::isfinite(apart) && std::isfinite(noise)) demand(apart <= c.gap + noise);
    }
    for (const Overlap& o : found.overlaps) {
        demand(o.a.lo <= o.a.hi && o.b.lo <= o.b.hi && o.gap >= 0);
        demand(domain[0].lo <= o.a.lo && o.a.hi <= domain[0].hi);
    }
}

template <class P>
void run(Bytes& bytes, int kind) {
    const auto a = curve_of<P>(bytes, kind), b = curve_of<P>(bytes, kind);
    if (!a || !b) return;
    const IntersectOptions options{.accuracy = kind % 3 == 0 ? 1e-3 : 0.0, .max_parts = 3000};
    const auto there = intersect(*a, *b, options), back = intersect(*b, *a, options);
    demand(there.has_value() == back.has_value());
    if (!there) {
        demand(!there.error().message.empty());
        return;
    }
    check_contacts(*a, *b, *there);
    demand(there->contacts.size() == back->contacts.size());
    demand(there->overlaps.size() == back->overlaps.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes{data, size};
    const int kind = bytes.next();
    switch (bytes.next() % 4) {
        case 0:
            run<Vec<2>>(bytes, kind);
            break;
        case 1:
            run<Hom<2>>(bytes, kind);
            break;
        case 2:
            run<Vec<3>>(bytes, kind);
            break;
        default:
            run<Hom<3>>(bytes, kind);
    }
    return 0;
}
