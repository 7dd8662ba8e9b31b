// The only function of a flight library: the core built by another compiler or at another optimisation level.
#pragma once

#include <cstdint>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"

namespace dispersa {

/// Appends the cases first to first + count - 1. The caller has a core of its own, of which the library uses
/// nothing; they share plain data and the C++ library.
using FlyCasesFunction = void (*)(const Campaign& campaign, std::uint64_t first, std::uint64_t count,
                                  std::vector<CaseResult>* results);
inline constexpr char kFlyCasesSymbol[] = "DispersaFlyCases";

}  // namespace dispersa

extern "C" __attribute__((visibility("default"))) void DispersaFlyCases(
    const dispersa::Campaign& campaign, std::uint64_t first, std::uint64_t count,
    std::vector<dispersa::CaseResult>* results);
