// Which campaign of a coordinator flies next, and which one gives its place to it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "services/coordinator/catalogue.h"
#include "services/coordinator/quota.h"

namespace dispersa {

/// Of campaigns that have not ended, the one to open next; nullptr: none. Of the same flights they fly one
/// after the other: the later takes over what the earlier has flown. What lacks its report alone, when the
/// coordinator is started again, comes after all that is to be flown.
const CatalogueEntry* NextOf(const std::vector<const CatalogueEntry*>& open, const Quotas& quotas,
                             const std::function<bool(const std::string& id)>& is_delayed);

/// The last of those that fly, if `entry` has a higher priority; nullptr: none gives way.
const CatalogueEntry* WhoGivesWayTo(const CatalogueEntry& entry,
                                    const std::vector<const CatalogueEntry*>& flying);

}  // namespace dispersa
