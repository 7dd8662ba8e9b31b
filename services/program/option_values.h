// What an option's value, or an argument, must be in every program.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace dispersa {

/// A case's number has 32 bits.
inline constexpr std::uint64_t kMostCases = 4294967295;

/// For an option's transform(): a whole number in digits, from `least` to `most`. To CLI11 alone, 010 is
/// eight and -1 of what has no sign the largest number that there is.
CLI::Validator WholeNumber(std::int64_t least, std::uint64_t most);

/// Of an option whose type lists its values as "{one,another}"; of any other none.
std::vector<std::string> ListedValues(const CLI::Option& option);

/// Has every option and argument of a program and its commands refuse a value that is empty, that is not
/// among those listed, or that is no WholeNumber, or no finite number, where one is wanted. Once all are
/// added.
void CheckValues(CLI::App& app);

}  // namespace dispersa
