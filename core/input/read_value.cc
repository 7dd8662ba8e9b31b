#include "core/input/read_value.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/input/number_text.h"
#include "core/input/struct_problems.h"

namespace dispersa {
namespace {

bool IsAbsent(const InputNode& node) { return node.file == nullptr; }

// Levenshtein distance.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

bool Range::Contains(double value) const {
  return std::isfinite(value) && (low_open ? value > low : value >= low) &&
         (high_open ? value < high : value <= high);
}

std::string Range::Text(double scale) const {
  std::string text = "a number";
  if (std::isfinite(low) && std::isfinite(high) && !low_open && !high_open) {
    return text + " from " + FormatScaled(low, scale) + " to " + FormatScaled(high, scale);
  }
  if (std::isfinite(low)) {
    const std::string limit = FormatScaled(low, scale);
    text += low_open ? " above " + limit : " not below " + limit;
  }
  if (std::isfinite(high)) {
    if (std::isfinite(low)) text += " and";
    const std::string limit = FormatScaled(high, scale);
    text += high_open ? " below " + limit : " not above " + limit;
  }
  return text;
}

void AddProblem(std::vector<InputProblem>& problems, const InputNode& at, std::string path,
                std::string message, std::string allowed) {
  problems.push_back(
      {at.file ? *at.file : "", at.line, at.column, std::move(path), std::move(message), std::move(allowed)});
}

InputNode KeyOf(const InputMember& member) {
  InputNode at = MapAt(member.value);
  at.line = member.line;
  at.column = member.column;
  return at;
}

std::string TextIn(const Unit& unit, const Range& range) { return range.Less(unit.offset).Text(unit.scale); }

double ReadNumber(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                  const Range& range, const Unit& unit) {
  if (IsAbsent(node)) return 0.0;
  std::optional<double> value;
  if (node.kind == InputNode::Kind::kScalar && !node.quoted) value = ParseNumber(node.text);
  std::string problem;
  if (!value)
    problem = node.Describe() + " is not a number";
  else if (!std::isfinite(*value))
    problem = node.Describe() + " is not finite";
  else if (!range.Less(unit.offset).Contains(*value * unit.scale))
    problem = node.text + " is out of range";
  else
    return unit.offset == 0.0 ? *value * unit.scale : *value * unit.scale + unit.offset;
  AddProblem(problems, node, path, std::move(problem), TextIn(unit, range));
  return 0.0;
}

bool IsTruthValue(const std::string& text) { return text == "true" || text == "false"; }

std::string ReadText(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems) {
  if (IsAbsent(node)) return "";
  if (node.kind != InputNode::Kind::kScalar) {
    AddProblem(problems, node, path, node.Describe() + " is not text", "text");
  } else if (!node.quoted && (ParseNumber(node.text) || IsTruthValue(node.text))) {
    AddProblem(problems, node, path, node.Describe() + " is not text",
               "text; in quotes if it looks like a number");
  } else if (node.text.empty()) {
    AddProblem(problems, node, path, "the text is empty", "text");
  }
  return node.text;
}

std::string JoinWords(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

namespace {

/// "lh" of "latin_hypercube"; of one word nothing.
std::string InitialsOf(const std::string& words) {
  if (words.find('_') == std::string::npos) return "";
  std::string initials = words.substr(0, 1);
  for (std::size_t i = 1; i < words.size(); ++i)
    if (words[i - 1] == '_') initials += words[i];
  return initials;
}

/// Whether somebody may write so who means it: "lhs" is Latin hypercube sampling, and a column of cases.csv
/// has a prefix.
bool StandsFor(const std::string& word, const std::string& meant) {
  const std::string initials = InitialsOf(meant);
  return word == "metric_" + meant || word == "input_" + meant ||
         (!initials.empty() && (word == initials || word == initials + "s"));
}

}  // namespace

std::string Nearest(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t kLongestWord = 200;
  if (word.size() > kLongestWord) return "";
  for (const std::string& candidate : words)
    if (StandsFor(word, candidate)) return candidate;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 4) + 1;
  std::string best;
  for (const std::string& candidate : words) {
    if (IsInAnotherUnit(word, candidate)) continue;  // the numbers under it would be others
    const std::size_t distance = EditDistance(word, candidate);
    if (distance < best_distance && distance < std::max(word.size(), candidate.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string DidYouMean(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = Nearest(word, words);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

}  // namespace dispersa
