// The tree of parts of a surface; sheet_detail.hpp is the essay.
#include "sheet_detail.hpp"
#include "sheet_rows_detail.hpp"

namespace freiform::detail {

namespace {

bool is_joined_sheet(const Surface<Hom<3>>& s, int axis) {
    const BSplineBasis& b = s.basis(axis);
    const Interval on = b.domain();
    const int p = b.degree(), n = b.size();
    if (p == 0 || b.knot(1) != on.lo || b.knot(n + p - 1) != on.hi) return false;
    bool same = true, point = true;
    const auto net = s.net().view();
    each_fibre(axis, net.extent, [&](const Index<2>& at) {
        Index<2> last = at;
        last[std::size_t(axis)] = n - 1;
        same = same && net(at) == net(last);
        for (int i = 1; i < n; ++i) {
            Index<2> inner = at;
            inner[std::size_t(axis)] = i;
            point = point && net(inner) == net(at);
        }
    });
    return same && !point;
}

}  // namespace

Sheet::Sheet(const Surface<Hom<3>>& surface) {
    const BezierPieces<2, Hom<3>> all(surface);
    double roundings = 0, most = 0, least = kInfinity;
    for (std::size_t k = 0; k < 2; ++k) {
        const BSplineBasis& basis = surface.basis(int(k));
        degree_[k] = basis.degree();
        count_[k] = all.extent()[k];
        breaks_[k] = all.breaks(int(k));
        domain_[k] = basis.domain();
        cyclic_[k] = basis.is_closed() || is_joined_sheet(surface, int(k));
        roundings += 12 * degree_[k] + 8;
    }
    block_ = (degree_[0] + 1) * (degree_[1] + 1);
    each_index(all.extent(), [&](const Index<2>& at) {
        const auto net = all.net(at);
        each_index(net.extent, [&](const Index<2>& i) { pieces_.push_back(net(i)); });
    });
    for (const Hom<3>& p : pieces_) {
        scale_ = std::max(scale_, max_abs(Space<Hom<3>>::project(p)));
        most = std::max(most, p.weight()), least = std::min(least, p.weight());
    }
    unit_ = 2.1 * kUnitRoundoff * (most / least) * scale_;
    // Outside of [0, 1] by kMargin the polynomials are at most (1 + 2 kMargin)^n times as large.
    stretch_ = std::pow(1 + 2 * kMargin, degree_[0] + degree_[1]);
    inner_error_ = unit_ * (roundings + 16 * (degree_[0] + degree_[1] + 2));
    value_error_ = stretch_ * inner_error_;
    // Address space more than memory: what is not used is not touched.
    const std::size_t parts =
        std::clamp<std::size_t>(192 * pieces_.size() / std::size_t(block_), 1024, 65536);
    nets_.reserve(std::size_t(block_) * parts), hull_.reserve(std::size_t(block_) * parts);
    parts_.reserve(parts);
    SheetPart root;
    root.to = count_, root.on = domain_;
    root.roundings = roundings;
    add(root);
}

Sheet::Piece Sheet::locate(std::size_t axis, double x) const {
    const auto& b = breaks_[axis];
    if (cyclic_[axis]) {
        const double period = b.back() - b.front();
        if (x < b.front()) x += period;
        if (x > b.back()) x -= period;
    }
    const int i =
        std::clamp(int(std::upper_bound(b.begin(), b.end(), x) - b.begin()) - 1, 0, count_[axis] - 1);
    return {i, (x - b[std::size_t(i)]) / width(axis, i)};
}

Sheet::At Sheet::at(double u, double v) const {
    const Piece i = locate(0, u), j = locate(1, v);
    const Hom<3>* p = pieces_.data() + std::size_t(i.index * count_[1] + j.index) * std::size_t(block_);
    const double wide_u = width(0, i.index), wide_v = width(1, j.index);
    return with_degrees(degree_, [&](auto n, auto m) {
        const BernsteinRow bu(n, i.t), bv(m, j.t);
        Four x{}, du{}, dv{};
        for (std::size_t r = 0; r <= std::size_t(n); ++r) {
            Four c{}, d{};
            for (std::size_t s = 0; s <= std::size_t(m); ++s, ++p) c.add(bv.b[s], *p), d.add(bv.d[s], *p);
            x.add(bu.b[r], c), du.add(bu.d[r], c), dv.add(bu.b[r], d);
        }
        At out;
        const double w = 1 / x[3], wu = w / wide_u, wv = w / wide_v;
        for (std::size_t k = 0; k < 3; ++k) {
            out.point.c[k] = x[k] * w;
            out.d[0].c[k] = (du[k] - out.point.c[k] * du[3]) * wu;
            out.d[1].c[k] = (dv[k] - out.point.c[k] * dv[3]) * wv;
        }
        return out;
    });
}

bool Sheet::has_piece_of(int part, const Sheet& other, int part_of_other) const {
    const SheetPart &p = (*this)[part], &q = other[part_of_other];
    for (const SheetPart* x : {&p, &q})
        if (x->local[0] != Interval{0, 1} || x->local[1] != Interval{0, 1}) return false;
    const int n = degree_[0], m = degree_[1];
    const Hom<3>*a = nets_.data() + p.net, *b = other.nets_.data() + q.net;
    for (const bool swapped : {false, true}) {
        if (other.degree_ != (swapped ? std::array{m, n} : degree_)) continue;
        for (int turn = 0; turn < 4; ++turn) {
            bool same = true;
            for (int i = 0; i <= n && same; ++i)
                for (int j = 0; j <= m && same; ++j) {
                    const int r = turn & 1 ? n - i : i, s = turn & 2 ? m - j : j;
                    same = a[i * (m + 1) + j] == b[swapped ? s * (n + 1) + r : r * (m + 1) + s];
                }
            if (same) return true;
        }
    }
    return false;
}

// Box and the rest of a part from its control points.
void Sheet::finish(SheetPart& part) const {
    part.error = unit_ * part.roundings;
    if (!part.is_one_piece()) {
        for (int i = part.from[0]; i < part.to[0]; ++i)
            for (int j = part.from[1]; j < part.to[1]; ++j) {
                const Hom<3>* p = pieces_.data() + std::size_t(i * count_[1] + j) * std::size_t(block_);
                for (int k = 0; k < block_; ++k) part.box.add(Space<Hom<3>>::project(p[k]));
            }
        return;
    }
    const Vec<3>* h = hull_.data() + part.net;
    for (int k = 0; k < block_; ++k) part.box.add(h[k]);
    const int n = degree_[0], m = degree_[1], w = m + 1;
    part.normal = unit(cross(h[n * w + m] - h[0], h[m] - h[n * w]));
    part.slab = {kInfinity, -kInfinity};
    for (int k = 0; k < block_; ++k) {
        const double x = dot(part.normal, h[k]);
        part.slab = {std::min(part.slab.lo, x), std::max(part.slab.hi, x)};
    }
}

int Sheet::add(SheetPart part) {
    const bool one = part.to[0] - part.from[0] == 1 && part.to[1] - part.from[1] == 1;
    if (one && !part.is_one_piece()) {
        part.net = int(nets_.size());
        part.local = {Interval{0, 1}, Interval{0, 1}};
        const auto first = pieces_.begin() +
                           std::ptrdiff_t(part.from[0] * count_[1] + part.from[1]) * std::ptrdiff_t(block_);
        nets_.insert(nets_.end(), first, first + block_);
    }
    if (part.is_one_piece())
        for (std::size_t k = hull_.size(); k < nets_.size(); ++k)
            hull_.push_back(Space<Hom<3>>::project(nets_[k]));
    finish(part);
    parts_.push_back(part);
    return int(parts_.size()) - 1;
}

bool Sheet::split(int index) {
    SheetPart whole = (*this)[index];
    if (whole.left >= 0) return true;
    SheetPart a = whole, b = whole;
    a.box = b.box = {};
    a.slopes = b.slopes = {-1, -1};
    if (!whole.is_one_piece()) {
        const std::size_t k = whole.to[0] - whole.from[0] < whole.to[1] - whole.from[1];
        const int middle = (whole.from[k] + whole.to[k]) / 2;
        a.to[k] = b.from[k] = middle;
        a.on[k].hi = b.on[k].lo = breaks_[k][std::size_t(middle)];
    } else {
        const int n = degree_[0], m = degree_[1], w = m + 1;
        const Vec<3>* h = hull(index);
        // The longer way across, along rows of control points.
        std::array<double, 2> length{};
        for (int r = 0; r <= n; ++r) {
            double sum = 0;
            for (int s = 0; s < m; ++s) sum += norm(h[r * w + s + 1] - h[r * w + s]);
            length[1] = std::max(length[1], sum);
        }
        for (int s = 0; s <= m; ++s) {
            double sum = 0;
            for (int r = 0; r < n; ++r) sum += norm(h[(r + 1) * w + s] - h[r * w + s]);
            length[0] = std::max(length[0], sum);
        }
        std::size_t k = length[1] > length[0];
        if (whole.local[k].length() <= 0x1p-40) k = 1 - k;
        if (whole.local[k].length() <= 0x1p-40) return false;
        double middle = whole.local[k].middle();
        double at = breaks_[k][std::size_t(whole.from[k])] + middle * width(k, whole.from[k]);
        for (std::size_t axis = 0; axis < 2; ++axis)
            for (const double cut : cuts_[axis]) {
                const Interval on = whole.on[axis];
                const double beside =
                    std::max(0x1p-20 * on.length(), 0x1p-38 * width(axis, whole.from[axis]));
                if (!(on.lo + beside < cut && cut < on.hi - beside)) continue;
                k = axis, at = cut;
                middle = (cut - breaks_[k][std::size_t(whole.from[k])]) / width(k, whole.from[k]);
            }
        const bool is_half = middle == whole.local[k].middle();
        const double place = (middle - whole.local[k].lo) / whole.local[k].length();
        a.local[k].hi = b.local[k].lo = middle;
        a.on[k].hi = b.on[k].lo = at;
        a.roundings = b.roundings = whole.roundings + (is_half ? 1 : 3) * degree_[k];
        a.net = int(nets_.size()), b.net = a.net + block_;
        nets_.resize(nets_.size() + std::size_t(2 * block_));
        std::copy_n(nets_.begin() + whole.net, block_, nets_.begin() + a.net);
        Hom<3>*l = nets_.data() + a.net, *r = nets_.data() + b.net;
        const auto divide = [&](int first, int degree, int stride) {
            if (is_half)
                halve_row(l + first, r + first, degree, stride);
            else
                divide_row(l + first, r + first, degree, stride, place);
        };
        if (k == 0)
            for (int s = 0; s <= m; ++s) divide(s, n, w);
        else
            for (int i = 0; i <= n; ++i) divide(i * w, m, 1);
    }
    const int left = add(a);
    add(b);
    parts_[std::size_t(index)].left = left;
    return true;
}

void Sheet::add_slopes_of(const Hom<3>* net, const std::array<double, 2>& width, double roundings,
                          Slopes& out) const {
    const double rounding = 8 * roundings * unit_;
    with_degrees(degree_, [&](auto n, auto m) {
        Interval w{kInfinity, 0};
        bool positive = true;
        for (int k = 0; k < (n + 1) * (m + 1); ++k) {
            positive = positive && net[k].weight() > 0;
            w = {std::min(w.lo, net[k].weight()), std::max(w.hi, net[k].weight())};
        }
        if (!positive) {
            for (SlopeBox& o : out) o.include({Box<3>::filled(-kInfinity), Box<3>::filled(kInfinity)});
            return;
        }
        Box<3> box;
        for (int k = 0; k < (n + 1) * (m + 1); ++k) box.add(Space<Hom<3>>::project(net[k]));
        const Vec<3> middle = 0.5 * (box.lo + box.hi), reach = 0.5 * (box.hi - box.lo);
        out[0].include(slope_box<0>(net, n, m, middle, reach, w, width[0], rounding));
        out[1].include(slope_box<1>(net, n, m, middle, reach, w, width[1], rounding));
    });
}

// Over a rectangle of the parameters of one piece, or beyond.
void Sheet::add_slopes(int piece, const std::array<Interval, 2>& local, Slopes& out) {
    const auto first = pieces_.begin() + std::ptrdiff_t(piece) * block_;
    restricted_.assign(first, first + block_);
    Hom<3>* net = restricted_.data();
    with_degrees(degree_, [&](auto n, auto m) {
        const int w = m + 1;
        for (int s = 0; s <= m; ++s) restrict_row(net + s, n, w, local[0]);
        for (int r = 0; r <= n; ++r) restrict_row(net + r * w, m, 1, local[1]);
    });
    const std::array<double, 2> size{local[0].length() * width(0, piece / count_[1]),
                                     local[1].length() * width(1, piece % count_[1])};
    add_slopes_of(net, size, stretch_ * (24 * (degree_[0] + degree_[1]) + 16), out);
}

const Sheet::Slopes& Sheet::slopes(int index, bool around) {
    const std::size_t which = around;
    if ((*this)[index].slopes[which] >= 0) return slopes_[std::size_t((*this)[index].slopes[which])];
    const SheetPart& part = (*this)[index];
    Slopes out;
    if (!around) {
        add_slopes_of(nets_.data() + part.net, {part.on[0].length(), part.on[1].length()}, part.roundings,
                      out);
    } else {
        // The pieces that the surroundings reach, each with its part of them.
        struct Share {
            int piece;
            Interval local;
        };
        std::array<std::vector<Share>, 2> shares;
        for (std::size_t k = 0; k < 2; ++k) {
            const double more = kMargin * part.on[k].length() * (1 + 0x1p-20);
            const Interval wide{part.on[k].lo - more, part.on[k].hi + more};
            const double period = breaks_[k].back() - breaks_[k].front();
            const auto piece_at = [&](int i) {
                const int own = ((i % count_[k]) + count_[k]) % count_[k];
                const double lo = breaks_[k][std::size_t(own)] + (i - own) / count_[k] * period;
                return std::pair(own, Interval{lo, lo + width(k, own)});
            };
            const int least = cyclic_[k] ? part.from[k] - 2 * count_[k] : 0;
            const int most = cyclic_[k] ? part.from[k] + 2 * count_[k] : count_[k] - 1;
            int first = part.from[k];
            while (first > least && piece_at(first).second.lo > wide.lo) --first;
            for (int i = first; i <= most; ++i) {
                const auto [own, whole] = piece_at(i);
                if (whole.lo >= wide.hi) break;
                Interval on{std::max(wide.lo, whole.lo), std::min(wide.hi, whole.hi)};
                if (i == least) on.lo = wide.lo;
                if (i == most) on.hi = wide.hi;
                const double size = whole.length();
                if (on.lo < on.hi)
                    shares[k].push_back({own, {(on.lo - whole.lo) / size, (on.hi - whole.lo) / size}});
            }
        }
        for (const Share& u : shares[0])
            for (const Share& v : shares[1])
                add_slopes(u.piece * count_[1] + v.piece, {u.local, v.local}, out);
    }
    parts_[std::size_t(index)].slopes[which] = int(slopes_.size());
    slopes_.push_back(out);
    return slopes_.back();
}

}  // namespace freiform::detail
