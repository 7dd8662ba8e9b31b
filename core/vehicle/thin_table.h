// Fewer corners for a table of many rows, such as a test stand writes.
//
// Corners are chosen greedily. The piece whose rows miss its chord most, by the integral of the squares, is
// split at its worst row (the split of Douglas and Peucker, Cartographica 10, 1973). Squares keep the corners
// from crowding about single noisy rows. Values at the corners are the least-squares fit of a
// function that is linear between them to one that is linear between the rows (the L2 projection on hat
// functions). It averages noise, and keeps the area under the table. A value that is 0 stays 0 and none
// becomes negative. What this takes from the area is given back by one factor.
#pragma once

#include <cstddef>
#include <vector>

namespace dispersa {

/// Rows of the corners, the first and the last among them: at most `most`, and fewer if no row of any column
/// is farther from its chord than `tolerance` of the column's greatest value. `x` increases.
std::vector<std::size_t> ChooseCorners(const std::vector<double>& x,
                                       const std::vector<const std::vector<double>*>& columns,
                                       std::size_t most, double tolerance);

/// The values, 0 or more, at the corners of a column of values 0 or more.
std::vector<double> FitCorners(const std::vector<double>& x, const std::vector<double>& values,
                               const std::vector<std::size_t>& corners);

/// The greatest difference at a row, as a part of the greatest value.
double GreatestMiss(const std::vector<double>& x, const std::vector<double>& values,
                    const std::vector<std::size_t>& corners, const std::vector<double>& fitted);

}  // namespace dispersa
