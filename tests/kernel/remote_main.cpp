// Runs the plain kernels of the processor that it is compiled for, with what comes in through a pipe.
// tests/spline/prepared_remote_test.cpp starts it.
#include <cstring>
#include <kernel_wire.hpp>

namespace {

using namespace freiform;
using test::Call;

// An axis or a net with the arrays that belong to it.
struct Arrays {
    std::vector<double> record[3], coefficients;
    std::vector<int> bucket[3];

    void get(test::Wire& wire, kernel::Axis& axis, int d) {
        record[d].resize(test::records_of(axis) + kernel::Axis::kLine);
        double* begin = record[d].data();  // of a line of the cache, as records are
        while (reinterpret_cast<std::size_t>(begin) % (kernel::Axis::kLine * sizeof(double)) != 0) ++begin;
        wire.get(begin, test::records_of(axis));
        for (std::size_t k = 0; k < test::spans_of(axis); ++k)
            wire.get(test::span_of(begin + k * axis.stride));
        bucket[d] = wire.get_many<int>(std::size_t(axis.buckets));
        axis.record = begin;
        axis.bucket = bucket[d].data();
    }
    kernel::Net get(test::Wire& wire) {
        auto net = wire.get<kernel::Net>();
        for (int d = 0; d < net.axes; ++d) get(wire, net.axis[d], d);
        coefficients = wire.get_many<double>(wire.get<std::size_t>());
        net.coefficients = coefficients.data();
        return net;
    }
};

// Where the results of n points go.
struct Results {
    std::vector<double> jets, normals, curvatures;
    Results(const kernel::Net& net, std::size_t n, test::Request& r)
        : jets(r.jets ? n * test::size_of(net, r.out) : 0),
          normals(r.normals ? 3 * n : 0),
          curvatures(r.curvatures ? 2 * n : 0) {
        r.out.jets = r.jets ? jets.data() : nullptr;
        r.out.normals = r.normals ? normals.data() : nullptr;
        r.out.curvatures = r.curvatures ? curvatures.data() : nullptr;
    }
    void put(test::Wire& wire) const {
        wire.put(jets.data(), jets.size());
        wire.put(normals.data(), normals.size());
        wire.put(curvatures.data(), curvatures.size());
    }
};

void scattered(test::Wire& wire, const kernel::Kernels& kernels) {
    Arrays arrays;
    const kernel::Net net = arrays.get(wire);
    const auto at = wire.get_many<double>(wire.get<std::size_t>());
    auto request = wire.get<test::Request>();
    const std::size_t n = at.size() / std::size_t(net.axes);
    const Results results(net, n, request);
    kernels.scattered(net, at.data(), n, request.out);
    kernels.flush();
    results.put(wire);
}

void weights(test::Wire& wire, const kernel::Kernels& kernels) {
    Arrays arrays;
    auto axis = wire.get<kernel::Axis>();
    arrays.get(wire, axis, 0);
    const auto at = wire.get_many<double>(wire.get<std::size_t>());
    const int order = wire.get<int>();
    std::vector<double> out(at.size() * std::size_t((order + 1) * axis.lanes));
    std::vector<int> first(at.size());
    kernels.weights(axis, at.data(), at.size(), order, out.data(), first.data());
    wire.put(out.data(), out.size());
    wire.put(first.data(), first.size());
}

void grid_row(test::Wire& wire, const kernel::Kernels& kernels) {
    const auto net = wire.get<kernel::Net>();
    auto last = wire.get<kernel::GridAxis>();
    const auto part = wire.get_many<kernel::GridPart>(std::size_t(last.parts));
    const auto weights = wire.get_many<double>(std::size_t(last.parts) * last.stride());
    const auto row = wire.get<std::size_t>();
    auto request = wire.get<test::Request>();
    const auto outer = wire.get_many<double>(row * test::outer_orders(net, request.out.order));
    last.part = part.data();
    last.weights = weights.data();
    const Results results(net, std::size_t(last.count), request);
    kernels.grid_row(net, last, outer.data(), row, request.out);
    kernels.flush();
    results.put(wire);
}

void combine(test::Wire& wire, const kernel::Kernels& kernels) {
    const auto w = wire.get_many<double>(wire.get<std::size_t>());
    const auto n = wire.get<std::size_t>();
    const auto all = wire.get_many<double>(n * w.size());
    std::vector<const double*> from;
    for (std::size_t i = 0; i < w.size(); ++i) from.push_back(all.data() + i * n);
    std::vector<double> sum(n);
    kernels.combine(from.data(), w.data(), int(w.size()), sum.data(), n);
    wire.put(sum.data(), n);
}

void inside(test::Wire& wire, const kernel::Kernels& kernels) {
    const int axes = wire.get<int>();
    const auto lo = wire.get_many<double>(std::size_t(axes)), hi = wire.get_many<double>(std::size_t(axes));
    const auto at = wire.get_many<double>(wire.get<std::size_t>());
    wire.put(kernels.inside(at.data(), at.size(), axes, lo.data(), hi.data()));
}

}  // namespace

int main() {
    test::Wire wire{stdout, stdin};
    const kernel::Kernels& kernels = kernel::kBase;
    char name[16] = {};
    std::strncpy(name, kernels.name, sizeof name - 1);
    wire.put(name, sizeof name);
    wire.put(kernels.width);
    std::fflush(stdout);
    for (Call call; std::fread(&call, sizeof call, 1, stdin) == 1; std::fflush(stdout)) {
        switch (call) {
            case Call::scattered:
                scattered(wire, kernels);
                break;
            case Call::weights:
                weights(wire, kernels);
                break;
            case Call::grid_row:
                grid_row(wire, kernels);
                break;
            case Call::combine:
                combine(wire, kernels);
                break;
            case Call::inside:
                inside(wire, kernels);
                break;
        }
    }
}
