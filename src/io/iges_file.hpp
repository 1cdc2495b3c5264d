// Files of the Initial Graphics Exchange Specification: cards of 80 columns, entities, and splines among
// them.
#pragma once
#include "step_detail.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/in_space.hpp>

#include <array>
#include <map>

namespace freiform::detail {

inline std::string at_right(std::string_view s, std::size_t width) {
    return std::string(width - std::min(width, s.size()), ' ') + std::string(s);
}

// Whether others are made of the entity, and what it is for: columns of the status number.
enum class IgesUse { alone, part, parameters, definition, property };

// The entities that say the colour and the name of another one; 0: there are none.
struct IgesLook {
    int colour = 0, name = 0;
};

class IgesFile {
public:
    // They return the number of the directory entry.
    template <class P>
    Result<int> add(const Curve<P>& given, IgesUse use = IgesUse::alone, IgesLook look = {}) {
        const auto c = cut(in_space(given));
        if (!c) return std::unexpected(c.error());
        const BSplineBasis& b = c->basis();
        values_ = {text(b.size() - 1), text(b.degree()), "0", "0", Space<P>::kRational ? "0" : "1", "0"};
        knots(b);
        const auto all = c->net().flat();
        for (const auto& p : all) weight(p);
        for (const auto& p : all) point(p);
        interval(b.domain());
        for (int i = 0; i < 3; ++i) values_.emplace_back("0.");  // no normal of a plane is claimed
        return entity("126", use, 0, 0, look);
    }

    template <class P>
    Result<int> add(const Surface<P>& given, IgesUse use = IgesUse::alone, IgesLook look = {}) {
        auto s = cut(in_space(given));
        if (!s) return std::unexpected(s.error());
        const BSplineBasis &u = s->basis(0), &v = s->basis(1);
        values_ = {text(u.size() - 1),
                   text(v.size() - 1),
                   text(u.degree()),
                   text(v.degree()),
                   "0",
                   "0",
                   Space<P>::kRational ? "0" : "1",
                   "0",
                   "0"};
        knots(u), knots(v);
        const auto all = s->net().flat();
        const auto each = [&](auto&& f) {  // the first index runs fastest
            for (int j = 0; j < v.size(); ++j)
                for (int i = 0; i < u.size(); ++i) f(all[std::size_t(i * v.size() + j)]);
        };
        each([&](const auto& p) { weight(p); });
        each([&](const auto& p) { point(p); });
        interval(u.domain()), interval(v.domain());
        return entity("128", use, 0, 0, look);
    }

    bool is_empty() const { return entities_ == 0; }

    std::string take(std::string_view unit) const {
        // By the flags of the standard, of which 3 leaves it to the name.
        static constexpr std::array<std::string_view, 12> kUnits{"",  "inch", "mm",  "",   "ft", "mi",
                                                                 "m", "km",   "mil", "um", "cm", "uin"};
        const auto metres = metres_per(unit);
        std::size_t flag = metres ? 3 : 2;
        for (std::size_t i = 1; i < kUnits.size(); ++i)
            if (metres && metres_per(kUnits[i]) == metres) flag = i;
        std::string name(flag == 3 ? unit : kUnits[flag]);
        for (char& c : name) c = c >= 'a' && c <= 'z' ? char(c - 32) : c;
        const std::vector<std::string> global{"1H,",
                                              "1H;",
                                              "8Hfreiform",
                                              "8Hfreiform",
                                              "8Hfreiform",
                                              "8Hfreiform",
                                              "32",
                                              "308",
                                              "15",
                                              "308",
                                              "15",
                                              "8Hfreiform",
                                              "1.",
                                              text(flag),
                                              text(name.size(), "H", name),
                                              "1",
                                              "0.01",
                                              "15H20000101.000000",
                                              "1.E-07",
                                              "0.",
                                              "8Hfreiform",
                                              "8Hfreiform",
                                              "11",
                                              "0",
                                              "15H20000101.000000"};
        std::string out = card("freiform", 'S', 1);
        int count = 0;
        for (const std::string& line : lines(global, 72)) out += card(line, 'G', ++count);
        out += directory_ + parameters_;
        return out + card(text("S", at_right("1", 7), "G", at_right(text(count), 7), "D",
                               at_right(text(2 * entities_), 7), "P", at_right(text(rows_), 7)),
                          'T', 1);
    }

    // The entity of these values; `form` says which kind of its type, `placed` the transformation matrix that
    // takes it to where it is.
    int entity(std::string_view type, IgesUse use, std::vector<std::string> values, int form = 0,
               int placed = 0, IgesLook look = {}) {
        values_ = std::move(values);
        return entity(type, use, form, placed, look);
    }

    // A colour is written once, in percent of red, green and blue; nothing says how opaque it is.
    IgesLook look(const std::optional<Colour>& colour, std::string_view name) {
        IgesLook out;
        if (colour) {
            const std::array<double, 3> rgb{colour->r, colour->g, colour->b};
            int& known = colours_[rgb];
            if (known == 0) {
                values_.clear();
                for (const double x : rgb) number(100 * x);
                known = entity("314", IgesUse::definition);
            }
            out.colour = known;
        }
        if (!name.empty()) {
            std::string words(name);
            for (char& c : words)
                if (c >= 0 && c < ' ') c = ' ';
            out.name = entity("406", IgesUse::property, {"1", text(words.size(), "H", words)}, 15);
        }
        return out;
    }

    // Open: closed patches are cut at their seam.
    template <std::size_t N, class P>
    static Result<Patch<N, P>> cut(Patch<N, P> s) {
        for (int axis = 0; axis < int(N); ++axis) {
            if (!s.basis(axis).is_closed()) continue;
            auto open = restrict_to(s, axis, s.basis(axis).domain());
            if (!open) return open;
            s = *std::move(open);
        }
        return s;
    }

private:
    static std::string card(std::string_view content, char section, int number) {
        return text(content, std::string(72 - std::min<std::size_t>(72, content.size()), ' '), section,
                    at_right(text(number), 7), "\n");
    }

    // Values with commas between them, a semicolon at the end, none of them on two lines but long strings.
    static std::vector<std::string> lines(const std::vector<std::string>& values, std::size_t width) {
        std::vector<std::string> all{""};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::string word = values[i] + (i + 1 < values.size() ? "," : ";");
            if (all.back().size() + word.size() > width) all.emplace_back();
            all.back() += word;
            while (all.back().size() > width) {
                std::string rest = all.back().substr(width);
                all.back().resize(width);
                all.push_back(std::move(rest));
            }
        }
        return all;
    }

    void number(double x) { values_.push_back(real(x)); }
    void knots(const BSplineBasis& b) {
        for (const double t : b.knots()) number(t);
    }
    void interval(Interval on) { number(on.lo), number(on.hi); }
    void weight(const Vec<3>&) { number(1); }
    void weight(const Hom<3>& p) { number(p.weight()); }
    template <class P>
    void point(const P& p) {
        const Vec<3> x = written_point(p);
        for (int i = 0; i < 3; ++i) number(x[i]);
    }

    int entity(std::string_view type, IgesUse use, int form = 0, int placed = 0, IgesLook look = {}) {
        static constexpr std::string_view kStatus[] = {"00000000", "00010000", "00010500", "00000200",
                                                       "00010300"};
        values_.insert(values_.begin(), std::string(type));
        if (look.name != 0)  // behind no associativity
            values_.insert(values_.end(), {"0", "1", text(look.name)});
        const int first = rows_ + 1, entry = 2 * entities_ + 1;
        for (const std::string& line : lines(values_, 64)) {
            const std::string padded = line + std::string(64 - line.size(), ' ');
            parameters_ += card(padded + at_right(text(entry), 8), 'P', ++rows_);
        }
        const auto fields = [](std::initializer_list<std::string> words) {
            std::string s;
            for (const std::string& w : words) s += at_right(w, 8);
            return s;
        };
        const std::string kind(type);
        directory_ += card(fields({kind, text(first), "0", "0", "0", "0", text(placed), "0",
                                   std::string(kStatus[int(use)])}),
                           'D', entry);
        directory_ += card(
            fields({kind, "0", text(-look.colour), text(rows_ - first + 1), text(form), "", "", "", "0"}),
            'D', entry + 1);
        ++entities_;
        return entry;
    }

    std::vector<std::string> values_;  // of the entity at hand
    std::string directory_, parameters_;
    int entities_ = 0, rows_ = 0;
    std::map<std::array<double, 3>, int> colours_;
};

// The solids of the model as B-rep objects (186), its other shells as 514.
Result<void> add_model(IgesFile& file, const Model& model);

}  // namespace freiform::detail
