// A hash over every bit of a stored result.
#pragma once

#include "core/campaign/case_result.h"

namespace dispersa {

/// Covers every field. It detects a damaged row, and a second result of the case that differs anywhere. It is
/// taken over the stored values: any NaN or infinity is "undefined", -0 is 0.
Digest Fingerprint(const CaseResult& result);

}  // namespace dispersa
