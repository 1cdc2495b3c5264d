// Kernels of another processor, which an emulator runs: a stand-in for kernel::Kernels that sends everything
// through a pipe. One of them at a time.
#pragma once
#include <kernel_wire.hpp>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace freiform::test {

class RemoteKernels {
public:
    // Starts the program of the first word with the others. running() afterwards says whether it answered.
    explicit RemoteKernels(std::vector<std::string> words) {
        int to[2], from[2];
        if (pipe(to) != 0 || pipe(from) != 0) return;
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, to[0], 0);
        posix_spawn_file_actions_adddup2(&actions, from[1], 1);
        for (const int fd : {to[0], to[1], from[0], from[1]}) posix_spawn_file_actions_addclose(&actions, fd);
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const bool started =
            posix_spawn(&child_, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
        posix_spawn_file_actions_destroy(&actions);
        close(to[0]), close(from[1]);
        wire().to = fdopen(to[1], "wb"), wire().from = fdopen(from[0], "rb");
        if (!started) child_ = 0;
        if (!started || std::fread(name_, sizeof name_, 1, wire().from) != 1) return;
        kernels_ = {name_, wire().get<int>(), &scattered, &weights, &grid_row, &combine, &flush, &inside};
    }
    RemoteKernels(const RemoteKernels&) = delete;
    RemoteKernels& operator=(const RemoteKernels&) = delete;
    ~RemoteKernels() {
        if (wire().to) std::fclose(wire().to);
        if (wire().from) std::fclose(wire().from);
        wire() = {};
        if (child_ > 0) waitpid(child_, nullptr, 0);
    }
    bool running() const { return kernels_.name != nullptr; }
    const kernel::Kernels& kernels() const { return kernels_; }

private:
    static Wire& wire() {
        static Wire one;
        return one;
    }
    static void put(const kernel::Axis& axis) {
        wire().put(axis.record, records_of(axis));
        for (std::size_t k = 0; k < spans_of(axis); ++k)
            wire().put(*reinterpret_cast<const kernel::Span*>(axis.record + k * axis.stride));
        wire().put(axis.bucket, std::size_t(axis.buckets));
    }
    static void put(const kernel::Net& net) {
        wire().put(net);
        for (int d = 0; d < net.axes; ++d) put(net.axis[d]);
        wire().put(coefficients_of(net));
        wire().put(net.coefficients, coefficients_of(net));
    }
    static void get_results(const kernel::Net& net, std::size_t n, const kernel::Output& out) {
        std::fflush(wire().to);
        if (out.jets) wire().get(out.jets, n * size_of(net, out));
        if (out.normals) wire().get(out.normals, 3 * n);
        if (out.curvatures) wire().get(out.curvatures, 2 * n);
    }

    static void scattered(const kernel::Net& net, const double* at, std::size_t n,
                          const kernel::Output& out) {
        wire().put(Call::scattered);
        put(net);
        wire().put(n * std::size_t(net.axes));
        wire().put(at, n * std::size_t(net.axes));
        wire().put(request(out));
        get_results(net, n, out);
    }
    static void weights(const kernel::Axis& axis, const double* at, std::size_t n, int order, double* out,
                        int* first) {
        wire().put(Call::weights);
        wire().put(axis);
        put(axis);
        wire().put(n);
        wire().put(at, n);
        wire().put(order);
        std::fflush(wire().to);
        wire().get(out, n * std::size_t((order + 1) * axis.lanes));
        wire().get(first, n);
    }
    static void grid_row(const kernel::Net& net, const kernel::GridAxis& last, const double* outer,
                         std::size_t row, const kernel::Output& out) {
        wire().put(Call::grid_row);
        wire().put(net);
        wire().put(last);
        wire().put(last.part, std::size_t(last.parts));
        wire().put(last.weights, std::size_t(last.parts) * last.stride());
        wire().put(row);
        wire().put(request(out));
        wire().put(outer, row * outer_orders(net, out.order));
        get_results(net, std::size_t(last.count), out);
    }
    static void combine(const double* const* from, const double* w, int terms, double* sum, std::size_t n) {
        wire().put(Call::combine);
        wire().put(std::size_t(terms));
        wire().put(w, std::size_t(terms));
        wire().put(n);
        for (int k = 0; k < terms; ++k) wire().put(from[k], n);
        std::fflush(wire().to);
        wire().get(sum, n);
    }
    static void flush() {}
    static bool inside(const double* at, std::size_t n, int axes, const double* lo, const double* hi) {
        wire().put(Call::inside);
        wire().put(axes);
        wire().put(lo, std::size_t(axes));
        wire().put(hi, std::size_t(axes));
        wire().put(n);
        wire().put(at, n);
        std::fflush(wire().to);
        return wire().get<bool>();
    }

    pid_t child_ = 0;
    char name_[16] = {};
    kernel::Kernels kernels_{};
};

}  // namespace freiform::test
