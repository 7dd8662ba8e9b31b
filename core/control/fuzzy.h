// Rule base of the paper, equations (20) to (22): five triangular sets for the error, five for its rate, and
// 25 rules with singleton consequents. Defuzzification is by centre of gravity, with the product as the
// rules' AND.
//
// The sets are centred at -range, -range/2, 0, range/2, range. Neighbours cross at one half and the outer
// sets are shoulders, so the grades of any value sum to 1. Rule i * 5 + j has the error's set i and the
// rate's set j. The control law itself is fuzzy_law.h.
#pragma once

namespace dispersa {

inline constexpr int kFuzzySets = 5;
inline constexpr int kFuzzyRules = kFuzzySets * kFuzzySets;

}  // namespace dispersa
