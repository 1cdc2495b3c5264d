// Which of the compiled kernels run.
#include "blocks.hpp"
#include "evaluate.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace freiform::kernel {

int variants(Variant* out, int capacity) {
    Variant all[3] = {{&kBase, true}};
    int count = 1;
#if defined(__x86_64__)
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    all[count++] = {&kAvx2, avx2};
    all[count++] = {&kAvx512, avx512};
#endif
    for (int i = 0; i < count && i < capacity; ++i) out[i] = all[i];
    return count;
}

namespace {

const Kernels* first_choice() {
    Variant all[3];
    const int count = std::min(variants(all, 3), 3);
    const char* wanted = std::getenv("FREIFORM_ISA");
    const Kernels* best = &kBase;
    for (int i = 0; i < count; ++i) {
        if (!all[i].runs_here) continue;
        if (wanted && std::strcmp(wanted, all[i].kernels->name) == 0) return all[i].kernels;
        best = all[i].kernels;
    }
    return best;
}

std::atomic<const Kernels*>& chosen() {
    static std::atomic<const Kernels*> kernels = first_choice();
    return kernels;
}

double size_of_largest(const double* a) { return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])}); }

// a times the power of two that brings its largest coordinate into [1, 2); false if it is zero.
bool scaled(const double* a, double* out) {
    const double m = size_of_largest(a);
    if (!(m > 0)) return false;
    const int e = std::ilogb(m);
    for (int i = 0; i < 3; ++i) out[i] = std::scalbn(a[i], -e);
    return true;
}

}  // namespace

const Kernels& kernels() { return *chosen().load(std::memory_order_relaxed); }
void choose(const Kernels& other) { chosen().store(&other); }

const BlockKernels& block_kernels() {
#if defined(__x86_64__)
    if (&kernels() == &kAvx512) return kAvx512Blocks;
    if (&kernels() != &kBase) return kAvx2Blocks;
#endif
    return kBaseBlocks;
}

void careful_normal(const double* a, const double* b, double* out) {
    double u[3], v[3], n[3];
    out[0] = out[1] = out[2] = 0;
    if (!scaled(a, u) || !scaled(b, v)) return;
    const double c[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    if (!scaled(c, n)) return;
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; ++i) out[i] = n[i] / length;
}

// Other units of u and v change the derivatives and not the curvatures: S_u and S_v are brought near 1.
void careful_curvatures(const double (*jet)[3], double* out) {
    double size[2], d[5][3], c[3], n[3], form[3];
    out[0] = out[1] = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < 2; ++k) {
        size[k] = size_of_largest(jet[k]);
        if (!(size[k] > 0)) return;
    }
    const int u = -std::ilogb(size[0]), v = -std::ilogb(size[1]), unit[5] = {u, v, 2 * u, u + v, 2 * v};
    for (int k = 0; k < 5; ++k)
        for (int i = 0; i < 3; ++i) d[k][i] = std::scalbn(jet[k][i], unit[k]);
    const auto dot = [](const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = d[0][j] * d[1][k] - d[0][k] * d[1][j];
    }
    if (!scaled(c, n)) return;
    const double length = std::sqrt(dot(n, n)), area = std::scalbn(length, std::ilogb(size_of_largest(c)));
    for (double& x : n) x /= length;
    for (int k = 0; k < 3; ++k) form[k] = dot(d[2 + k], n) / area;
    out[0] = form[0] * form[2] - form[1] * form[1];
    out[1] =
        (form[0] * dot(d[1], d[1]) - 2 * form[1] * dot(d[0], d[1]) + form[2] * dot(d[0], d[0])) / area / 2;
}

}  // namespace freiform::kernel
