// A hundred digits, for judging what rational arithmetic alone cannot say: lengths, angles.
#pragma once
#include "reference.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace freiform::test {

using Real = boost::multiprecision::cpp_bin_float_100;
inline Real real(const Rational& r) { return Real(numerator(r)) / Real(denominator(r)); }

}  // namespace freiform::test
