// A hash over every bit of a result as it is stored.
#pragma once

#include "core/campaign/case_result.h"

namespace dispersa {

/// Covers every field, so that a stored row that was damaged, or a second result that differs anywhere, is
/// told from the first. Taken over what storage keeps: any NaN or infinity is "undefined", -0 is 0.
Digest Fingerprint(const CaseResult& result);

}  // namespace dispersa
