// Differences between the texts of two campaigns.
#pragma once

#include <string>
#include <vector>

namespace dispersa {

/// A value that differs, or that only one text has. An absent value is empty.
struct ValueDifference {
  std::string path;  ///< "dispersions.wind.max_speed_m_s", for a table of numbers the table
  std::string a;
  std::string b;
};

/// Differences of two canonical texts (Campaign::canonical_yaml), by path. A list or map that only one has is
/// one difference. So is a list of scalars that differs, or a list whose length differs. Throws InputError if
/// a text is no YAML.
std::vector<ValueDifference> DifferencesOf(const std::string& a, const std::string& b);

}  // namespace dispersa
