// The one numerical primitive of the library: a step of the recurrence that B-spline values, derivatives and
// blossoms share.
//
// Notation: p degree, s span (t_s <= u < t_{s+1}), b a row vector over the coefficients s - p .. s.
// Method: with R_k(x) the k x (k+1) bidiagonal matrix of Lyche & Morken, R_1(x_1) R_2(x_2) ... R_p(x_p) holds
// the weights of the blossom (polar form) at (x_1, .., x_p). All x_k = u: the values of the basis. The last r
// steps replaced by the derivatives of R_k: derivatives of order r. Different x_k: a row of the matrix of
// knot insertion, restriction or Bezier extraction; the mean over "all but one" argument: a row of the
// elevation. Cost: p (p + 1) / 2 pairs of products. Accuracy: for x inside the span all products are of
// numbers in [0, 1]; two divisions instead of one shared reciprocal keep the step finite for spans as short
// as a denormal number. References: [Ramshaw 1989], [Lyche & Morken 2018, ch. 2-4], [PT97, A2.2, A2.3].
#pragma once
#include <freiform/basis/bspline.hpp>

namespace freiform {

// b := b * R_k(x). b holds k values on entry and k + 1 on exit. T is double, or an exact type in tests.
template <class B, class T>
void blossom_step(const B& basis, int span, int k, const T& x, T* b) {
    T carry = T(0);
    for (int r = 0; r < k; ++r) {
        const T tl = T(basis.knot(span + 1 - k + r)), tr = T(basis.knot(span + 1 + r));
        const T width = tr - tl, old = b[r];
        b[r] = carry + old * ((tr - x) / width);
        carry = old * ((x - tl) / width);
    }
    b[k] = carry;
}

// b := b * dR_k/dx.
template <class B, class T>
void derivative_step(const B& basis, int span, int k, T* b) {
    T carry = T(0);
    for (int r = 0; r < k; ++r) {
        const T q = b[r] / (T(basis.knot(span + 1 + r)) - T(basis.knot(span + 1 - k + r)));
        b[r] = carry - q;
        carry = q;
    }
    b[k] = carry;
}

// w[0..p]: weights of the blossom at args[0..p-1] over the coefficients span - p .. span.
template <class B, class T>
void blossom(const B& basis, int span, const T* args, T* w) {
    w[0] = T(1);
    for (int k = 1; k <= basis.degree(); ++k) blossom_step(basis, span, k, args[k - 1], w);
}

// w[0..p]: weights of the derivative of this order at u, in the given span. Order 0: the values of the basis.
template <class B, class T>
void weights_in_span(const B& basis, int span, const T& u, int order, T* w) {
    const int p = basis.degree();
    if (order > p) {
        for (int i = 0; i <= p; ++i) w[i] = T(0);
        return;
    }
    w[0] = T(1);
    for (int k = 1; k <= p - order; ++k) blossom_step(basis, span, k, u, w);
    for (int k = p - order + 1; k <= p; ++k) {
        derivative_step(basis, span, k, w);
        for (int i = 0; i <= k; ++i) w[i] *= T(k);
    }
}

// The same with the span looked up and a closed basis wrapped. Returns the index of the first coefficient; of
// a closed basis indices count modulo size().
template <Basis B>
int weights(const B& basis, double u, int order, double* w) {
    const double inside = basis.wrap(u);
    const int s = basis.span(inside);
    weights_in_span(basis, s, inside, order, w);
    return s - basis.degree();
}

}  // namespace freiform
