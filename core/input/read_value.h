// Single values of a tree. After a problem, which is recorded with its place, the value is a harmless one (0,
// empty). The caller must check that no problem was recorded before it uses a value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"
#include "core/input/range.h"
#include "core/input/units.h"

namespace dispersa {

void AddProblem(std::vector<InputProblem>& problems, const InputNode& at, std::string path,
                std::string message, std::string allowed = "");

/// The place of a member's key.
InputNode KeyOf(const InputMember& member);

/// A range's text for a number in a unit: "a number above 0".
std::string TextIn(const Unit& unit, const Range& range);

/// A scalar that is a finite number in a unit. Range and result are in internal units.
double ReadNumber(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems,
                  const Range& range = kAnyNumber, const Unit& unit = kNoUnit);

/// The scalar as text. A number or a truth value must be quoted to be a text.
std::string ReadText(const InputNode& node, const std::string& path, std::vector<InputProblem>& problems);

bool IsTruthValue(const std::string& text);

/// "a, b, c"
std::string JoinWords(const std::vector<std::string>& words);
/// " (did you mean 'x'?)" for the nearest word within two edits, else empty.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& words);
/// The nearest of the words, or empty.
std::string Nearest(const std::string& word, const std::vector<std::string>& words);

}  // namespace dispersa
