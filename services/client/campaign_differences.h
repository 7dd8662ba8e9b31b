// What was changed from one campaign to another.
#pragma once

#include <string>
#include <vector>

namespace dispersa {

/// A value that only one text has, or that differs; absent values are empty.
struct ValueDifference {
  std::string path;  ///< "dispersions.wind.max_speed_m_s"; of a table of numbers the table
  std::string a;
  std::string b;
};

/// Of two canonical texts (Campaign::canonical_yaml), by path. A list or map that only one has is one
/// difference, and so is a list of scalars that differs, or a list whose length does. Throws InputError when
/// a text is no YAML.
std::vector<ValueDifference> DifferencesOf(const std::string& a, const std::string& b);

}  // namespace dispersa
