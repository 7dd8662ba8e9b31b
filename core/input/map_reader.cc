#include "core/input/map_reader.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/input/number_text.h"

namespace dispersa {
namespace {

bool IsAbsent(const InputNode& node) { return node.file == nullptr; }

bool IsTruthValue(const std::string& text) { return text == "true" || text == "false"; }

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

// The nearest word, or empty.
std::string Nearest(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t kLongestWord = 200;
  if (word.size() > kLongestWord) return "";
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 4) + 1;
  std::string best;
  for (const std::string& candidate : words) {
    const std::size_t distance = EditDistance(word, candidate);
    if (distance < best_distance && distance < std::max(word.size(), candidate.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string Quote(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : separator + "'") + word + "'";
  return text;
}

bool IsUnitLike(std::string_view suffix) {
  return std::find(std::begin(kUnitLike), std::end(kUnitLike), suffix) != std::end(kUnitLike);
}

// The key among `keys` that a unit written otherwise stands for, or empty.
std::string MeantKey(const std::string& stem, std::string suffix, const std::vector<std::string>& keys) {
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::vector<std::string> candidates = {stem + "_" + suffix};
  for (const UnitSpelling& spelling : kUnitSpellings)
    if (spelling.written == suffix) candidates.push_back(stem + "_" + std::string(spelling.meant));
  for (const std::string& candidate : candidates)
    if (std::find(keys.begin(), keys.end(), candidate) != keys.end()) return candidate;
  return "";
}

std::string CountText(std::size_t low, std::size_t high) {
  if (low == high) return "a list of " + std::to_string(low);
  if (high == SIZE_MAX) return "a list of " + std::to_string(low) + " or more";
  return "a list of " + std::to_string(low) + " to " + std::to_string(high);
}

// A number in a unit; the range is in internal units.
double ReadNumberIn(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                    const Range& range, const Unit& unit) {
  const double number = ReadNumber(node, path, problems, range.Less(unit.offset), unit.scale);
  return unit.offset == 0.0 ? number : number + unit.offset;
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

double ReadNumber(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                  const Range& range, double scale) {
  if (IsAbsent(node)) return 0.0;
  std::optional<double> value;
  if (node.kind == InputNode::Kind::kScalar && !node.quoted) value = ParseNumber(node.text);
  if (!value) {
    AddProblem(problems, node, path, node.Describe() + " is not a number", range.Text(scale));
    return 0.0;
  }
  if (!std::isfinite(*value)) {
    AddProblem(problems, node, path, node.Describe() + " is not finite", range.Text(scale));
    return 0.0;
  }
  if (!range.Contains(*value * scale)) {
    AddProblem(problems, node, path, node.text + " is out of range", range.Text(scale));
    return 0.0;
  }
  return *value * scale;
}

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

std::string DidYouMean(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = Nearest(word, words);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

MapReader::MapReader(const InputNode& node, std::string path, std::vector<InputProblem>& problems)
    : node_(&node), path_(std::move(path)), problems_(problems) {
  if (!IsAbsent(node) && node.kind != InputNode::Kind::kMap) {
    AddProblem(problems_, node, path_, node.Describe() + " is not a map", "a map of keys and values");
  }
}

MapReader::~MapReader() { Finish(); }

const InputNode* MapReader::Optional(const std::string& key) {
  known_.insert(key);
  return node_->Find(key);
}

const InputNode* MapReader::Peek(const std::string& key) const { return node_->Find(key); }

const InputNode& MapReader::Required(const std::string& key, const std::string& allowed) {
  static const InputNode absent;
  if (const InputNode* value = Optional(key)) return *value;
  ReportMissing({key}, allowed);
  return absent;
}

std::string MapReader::Text(const std::string& key) {
  return ReadText(Required(key, "text"), PathOf(key), problems_);
}

std::string MapReader::Text(const std::string& key, const std::string& absent) {
  const InputNode* value = Optional(key);
  return value == nullptr ? absent : ReadText(*value, PathOf(key), problems_);
}

bool MapReader::Flag(const std::string& key, bool absent) {
  const InputNode* value = Optional(key);
  if (value == nullptr) return absent;
  if (value->kind == InputNode::Kind::kScalar && !value->quoted && IsTruthValue(value->text)) {
    return value->text == "true";
  }
  AddProblem(problems_, *value, PathOf(key), value->Describe() + " is not a truth value", "true or false");
  return absent;
}

std::uint64_t MapReader::Integer(const std::string& key, std::uint64_t low, std::uint64_t high,
                                 std::optional<std::uint64_t> absent) {
  std::string allowed = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  const InputNode* value = Optional(key);
  if (value == nullptr) {
    if (!absent) ReportMissing({key}, allowed);
    return absent.value_or(low);
  }
  std::optional<std::uint64_t> number;
  if (value->kind == InputNode::Kind::kScalar && !value->quoted) number = ParseInteger(value->text);
  if (number && *number >= low && *number <= high) return *number;
  const bool is_number =
      value->kind == InputNode::Kind::kScalar && !value->quoted && ParseNumber(value->text);
  AddProblem(problems_, *value, PathOf(key),
             number ? value->text + " is out of range"
                    : value->Describe() + (is_number ? " is not a whole number" : " is not a number"),
             std::move(allowed));
  return low;
}

double MapReader::Number(const std::string& key, const Range& range, std::optional<double> absent) {
  const InputNode* value = Optional(key);
  if (value != nullptr) return ReadNumber(*value, PathOf(key), problems_, range);
  if (!absent) ReportMissing({key}, range.Text());
  return absent.value_or(0.0);
}

const InputNode* MapReader::FindQuantity(const std::string& stem, Dimension dimension, std::string* key,
                                         Unit* unit) {
  const InputNode* found = nullptr;
  std::vector<std::string> keys;
  for (const Unit& candidate : dimension) {
    keys.push_back(stem + "_" + std::string(candidate.suffix));
    known_.insert(keys.back());
    const InputNode* value = node_->Find(keys.back());
    if (value == nullptr) continue;
    if (found != nullptr) {
      AddProblem(problems_, *value, PathOf(keys.back()), "'" + *key + "' is given too", "one of the two");
      continue;
    }
    found = value;
    *key = keys.back();
    *unit = candidate;
  }
  quantities_.emplace_back(stem, std::move(keys));
  return found;
}

double MapReader::Quantity(const std::string& stem, Dimension dimension, const Range& range,
                           std::optional<double> absent) {
  std::string key;
  Unit unit = {};
  const InputNode* value = FindQuantity(stem, dimension, &key, &unit);
  if (value != nullptr) return ReadNumberIn(*value, PathOf(key), problems_, range, unit);
  if (!absent)
    ReportMissing(quantities_.back().second,
                  range.Less(dimension.front().offset).Text(dimension.front().scale));
  return absent.value_or(0.0);
}

std::optional<double> MapReader::OptionalQuantity(const std::string& stem, Dimension dimension,
                                                  const Range& range, std::string* key) {
  std::string found;
  Unit unit = {};
  const InputNode* value = FindQuantity(stem, dimension, &found, &unit);
  if (key != nullptr) *key = found;
  if (value == nullptr) return std::nullopt;
  return ReadNumberIn(*value, PathOf(found), problems_, range, unit);
}

std::vector<double> MapReader::Quantities(const std::string& stem, Dimension dimension, const Range& range,
                                          std::size_t low_count, std::size_t high_count, std::string* key) {
  std::string found;
  Unit unit = {};
  std::vector<double> values;
  if (FindQuantity(stem, dimension, &found, &unit) == nullptr) {
    if (low_count > 0) ReportMissing(quantities_.back().second, CountText(low_count, high_count));
    return values;
  }
  if (key != nullptr) *key = found;
  Each(found, low_count, high_count, [&](const InputNode& item, const std::string& path) {
    values.push_back(ReadNumberIn(item, path, problems_, range, unit));
  });
  return values;
}

std::vector<double> MapReader::Numbers(const std::string& key, const Range& range, std::size_t low_count,
                                       std::size_t high_count) {
  std::vector<double> values;
  Each(key, low_count, high_count, [&](const InputNode& item, const std::string& path) {
    values.push_back(ReadNumber(item, path, problems_, range));
  });
  return values;
}

std::array<double, 2> MapReader::Ends(const std::string& stem, Dimension dimension, const Range& range) {
  std::string key;
  Unit unit = {};
  const InputNode* value = FindQuantity(stem, dimension, &key, &unit);
  if (value == nullptr) {
    ReportMissing(quantities_.back().second,
                  range.Less(dimension.front().offset).Text(dimension.front().scale));
    return {};
  }
  if (value->kind != InputNode::Kind::kList) {
    const double number = ReadNumberIn(*value, PathOf(key), problems_, range, unit);
    return {number, number};
  }
  std::array<double, 2> ends{};
  std::size_t i = 0;
  Each(key, 2, 2, [&](const InputNode& item, const std::string& path) {
    ends[i++] = ReadNumberIn(item, path, problems_, range, unit);
  });
  return ends;
}

bool MapReader::Has(const std::string& stem, Dimension dimension) const {
  return std::any_of(dimension.begin(), dimension.end(), [&](const Unit& unit) {
    return node_->Find(stem + "_" + std::string(unit.suffix)) != nullptr;
  });
}

void MapReader::Spare(const std::function<void()>& read) {
  static const InputNode absent;
  const InputNode* const node = std::exchange(node_, &absent);
  read();
  node_ = node;
}

const InputNode* MapReader::List(const std::string& key, std::size_t low_count, std::size_t high_count) {
  const InputNode* list = known_.contains(key) ? node_->Find(key) : Optional(key);
  const std::string allowed = CountText(low_count, high_count);
  if (list == nullptr) {
    if (low_count > 0) ReportMissing({key}, allowed);
    return nullptr;
  }
  if (list->kind != InputNode::Kind::kList) {
    AddProblem(problems_, *list, PathOf(key), list->Describe() + " is not a list", allowed);
    return nullptr;
  }
  const std::size_t count = list->items.size();
  if (count < low_count || count > high_count) {
    AddProblem(problems_, *list, PathOf(key),
               count == 0 ? "the list is empty" : "the list has " + std::to_string(count), allowed);
    return nullptr;
  }
  return list;
}

std::optional<std::size_t> MapReader::WordIndex(const std::string& key, const std::vector<std::string>& words,
                                                bool required) {
  const std::string allowed = "one of " + JoinWords(words);
  const InputNode* value = Optional(key);
  if (value == nullptr) {
    if (required) ReportMissing({key}, allowed);
    return std::nullopt;
  }
  if (value->kind == InputNode::Kind::kScalar) {
    const auto found = std::find(words.begin(), words.end(), value->text);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  const std::string guess = value->kind == InputNode::Kind::kScalar ? DidYouMean(value->text, words) : "";
  AddProblem(problems_, *value, PathOf(key), value->Describe() + " is not a choice" + guess, allowed);
  return std::nullopt;
}

void MapReader::ReportMissing(std::vector<std::string> keys, const std::string& allowed) {
  if (node_->kind == InputNode::Kind::kMap) missing_.push_back({std::move(keys), allowed});
}

void MapReader::Finish() {
  if (is_finished_) return;
  is_finished_ = true;
  const std::vector<std::string> known(known_.begin(), known_.end());
  std::set<std::string> explained;  // missing keys that an unknown key evidently stands for
  for (const InputMember& member : node_->members) {
    if (known_.contains(member.key)) continue;
    const InputNode at = KeyOf(member);
    const std::string path = PathOf(member.key);

    std::string meant;
    const auto quantity = std::find_if(quantities_.begin(), quantities_.end(), [&](const auto& entry) {
      const auto& [stem, keys] = entry;
      if (member.key == stem) meant = keys.front();
      if (!member.key.starts_with(stem + "_")) return member.key == stem;
      const std::string suffix = member.key.substr(stem.size() + 1);
      meant = MeantKey(stem, suffix, keys);
      return !meant.empty() || IsUnitLike(suffix);
    });
    if (quantity != quantities_.end()) {
      const std::string guess = meant.empty() ? "" : " (did you mean '" + meant + "'?)";
      AddProblem(problems_, at, path,
                 (member.key == quantity->first ? "missing unit"
                                                : "the unit of '" + member.key + "' is not known here") +
                     guess,
                 JoinWords(quantity->second));
      explained.insert(quantity->second.begin(), quantity->second.end());
      continue;
    }
    const std::string nearest = Nearest(member.key, known);
    if (!nearest.empty()) explained.insert(nearest);
    AddProblem(problems_, at, path, "unknown key '" + member.key + "'" + DidYouMean(member.key, known),
               JoinWords(known));
  }
  for (const Missing& missing : missing_) {
    const bool is_explained = std::any_of(missing.keys.begin(), missing.keys.end(),
                                          [&](const std::string& key) { return explained.contains(key); });
    if (is_explained) continue;
    AddProblem(problems_, *node_, path_, "missing key " + Quote(missing.keys, " or "), missing.allowed);
  }
}

}  // namespace dispersa
