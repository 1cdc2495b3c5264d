// Orders of derivatives in graded order, and the terms of the quotient rule for them, at compile time.

inline constexpr int slot_of(int axes, int a, int b,
                             int c) {  // orders along up to three axes, the last ones used
    const int bc = b + c, t = a + b + c;
    return c + (axes > 1 ? bc * (bc + 1) / 2 : 0) + (axes > 2 ? t * (t + 1) * (t + 2) / 6 : 0);
}

// S_a = (A_a - sum_{0 < b <= a} C(a, b) w_b S_{a-b}) / w                              [PT97, eq. 4.8, 4.20]
template <int N, int K>
struct Slots {
    static constexpr int kCount = N == 1   ? K + 1
                                  : N == 2 ? (K + 1) * (K + 2) / 2
                                           : (K + 1) * (K + 2) * (K + 3) / 6;
    static constexpr int kOuter = N == 1 ? 1 : N == 2 ? K + 1 : (K + 1) * (K + 2) / 2;
    struct Term {
        int weight = 0, rest = 0;
        double factor = 0;
    };
    int outer[kCount] = {}, last[kCount] = {};  // the slot among the outer axes, the order along the last
    int a[kCount] = {}, b[kCount] = {};         // orders along the outer axes
    int terms[kCount] = {};
    Term term[kCount][8] = {};

    constexpr Slots() {
        for (int i = 0; i <= (N > 2 ? K : 0); ++i)
            for (int j = 0; j <= (N > 1 ? K - i : 0); ++j)
                for (int k = 0; i + j + k <= K; ++k) {
                    const int s = slot_of(N, i, j, k);
                    outer[s] = slot_of(N - 1, 0, i, j), last[s] = k, a[s] = i, b[s] = j;
                    for (int x = 0; x <= i; ++x)
                        for (int y = 0; y <= j; ++y)
                            for (int z = 0; z <= k; ++z) {
                                if (x + y + z == 0) continue;
                                // Orders up to 2: C(n, k) is 2 for (2, 1) and otherwise 1.
                                const double f = (i == 2 && x == 1 ? 2 : 1) * (j == 2 && y == 1 ? 2 : 1) *
                                                 (k == 2 && z == 1 ? 2 : 1);
                                term[s][terms[s]++] = {slot_of(N, x, y, z), slot_of(N, i - x, j - y, k - z),
                                                       f};
                            }
                }
    }
};
template <int N, int K>
inline constexpr Slots<N, K> kSlots{};
