// Rules for the values of options and arguments in every program.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace dispersa {

/// A case's number has 32 bits.
inline constexpr std::uint64_t kMostCases = 4294967295;

/// For an option's transform(): a whole number in digits, from `least` to `most`. CLI11 by itself reads 010
/// as eight, and -1 of an unsigned number as the largest number.
CLI::Validator WholeNumber(std::int64_t least, std::uint64_t most);

/// Values of an option whose type lists them as "{one,another}"; none for any other option.
std::vector<std::string> ListedValues(const CLI::Option& option);

/// Makes every option and argument of a program and its commands refuse a wrong value: an empty one, one that
/// is not listed, or one that is not the needed WholeNumber or finite number. Call it after all are added.
void CheckValues(CLI::App& app);

}  // namespace dispersa
