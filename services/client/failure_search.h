// The smallest dispersion of a campaign that fails a requirement, by a bounded local search.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/campaign/campaign.h"
#include "core/search/smallest_failure.h"
#include "services/client/observer.h"

namespace dispersa {

struct FailureSearchRequest {
  std::string metric;                  ///< empty: that of the campaign's first requirement
  std::optional<double> below, above;  ///< instead of the campaign's limits; they need a metric
  FailureSearchOptions options;        ///< all but its seed
  std::optional<std::uint64_t> seed;   ///< none: the campaign's
};

struct FailureSearch {
  nlohmann::ordered_json json;  ///< schema "dispersa/search/1"
  std::string text;             ///< the same for people
};

/// Flies on all usable cores. Throws InputError, Interrupted.
FailureSearch SearchForFailure(const Campaign& campaign, const FailureSearchRequest& request,
                               Observer& observer);

}  // namespace dispersa
