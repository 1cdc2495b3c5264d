// Evaluation of many points whose parameters do not lie one after the other in memory, as NumPy's arrays of u
// and v, broadcast against each other, do not: they are gathered piece by piece, so that no memory is taken
// for them.
#pragma once
#include <freiform/spline/prepared.hpp>

#include <functional>

namespace freiform::detail {

// Writes the parameters first .. first + count - 1, those of one point together. Called by several threads.
using Gather = std::function<void(std::size_t first, std::size_t count, double* out)>;

// What net.evaluate() gives for all `count` of them: the same bits, and the same refusal, that of the first
// bad parameter; but then some points have been written.
Result<void> evaluate_gathered(const PreparedNet& net, std::size_t count, const Gather& gather, int order,
                               std::size_t slots, const PreparedNet::Destination& to, Outside outside);

}  // namespace freiform::detail
