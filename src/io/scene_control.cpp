#include "io/drawing_lift.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/spline/in_space.hpp>

namespace freiform {

namespace {

template <class P>
void add_point(ControlNet& net, const P& p) {
    net.points.push_back(project(p));
    net.weights.push_back(Space<P>::weight(p));
}

template <class P>
void add_net(ControlNet& to, const Surface<P>& s) {
    const auto net = s.net().view();
    for (int axis = 0; axis < 2; ++axis)
        each_fibre(axis, net.extent, [&](const Index<2>& at) {
            const auto fibre = net.fibre(axis, at);
            std::vector<Vec<3>> line;
            for (int i = 0; i < fibre.size; ++i) line.push_back(project(fibre[i]));
            if (s.basis(axis).is_closed()) line.push_back(line.front());
            to.lines.push_back(std::move(line));
        });
    for (const P& p : s.net().flat()) add_point(to, p);
}

template <class P>
void add_net(ControlNet& to, const Triangle<P>& t) {
    const auto at = [&](int j, int k) { return project(in_space(t.coefficient(j, k))); };
    for (int row = 1; row <= t.degree(); ++row)  // rows j + k; the small triangles that point away
        for (int k = 0; k < row; ++k) {
            const int j = row - 1 - k;
            to.lines.push_back({at(j, k), at(j + 1, k), at(j, k + 1), at(j, k)});
        }
    for (const P& p : t.coefficients()) add_point(to, in_space(p));
}

void add_shape(ControlNet& to, const Shape& shape) {
    const auto visit = [&](const auto& s) {
        using S = std::remove_cvref_t<decltype(s)>;
        if constexpr (TensorPatch<S>) {
            if constexpr (S::kParams == 2)
                if (const auto lifted = drawing::lifted(s)) add_net(to, *lifted);
        } else if constexpr (TriangularPatch<S>) {
            if constexpr (Space<typename S::Coefficients>::kDim < 4) add_net(to, s);
        } else if constexpr (std::same_as<S, TrimmedSurface>) {
            visit_one([&](const auto& patch) { add_net(to, patch); }, s.surface);
        } else {
            for (const Face& face : s.faces)
                visit_one(
                    [&](const auto& patch) {
                        if constexpr (requires { patch.net(); }) add_net(to, patch);
                    },
                    face.surface);
        }
    };
    visit_one(visit, shape);
}

}  // namespace

std::vector<ControlNet> control_nets(const Document& document, std::span<const std::size_t> objects) {
    std::vector<ControlNet> out;
    for (std::size_t k = 0; k < (objects.empty() ? document.objects.size() : objects.size()); ++k) {
        ControlNet net{objects.empty() ? k : objects[k], {}, {}, {}};
        add_shape(net, document.objects[net.object].shape);
        if (!net.points.empty()) out.push_back(std::move(net));
    }
    return out;
}

}  // namespace freiform
