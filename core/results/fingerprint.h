// Hashes over every bit of what is stored.
#pragma once

#include <string_view>

#include "core/campaign/case_result.h"

namespace dispersa {

/// Covers every field. It detects a damaged row, and a second result of the case that differs anywhere. It is
/// taken over the stored values: any NaN or infinity is "undefined", -0 is 0. Rows of older releases have no
/// digest of the inputs: they hold all of them. They have no events.
Digest Fingerprint(const CaseResult& result, bool with_inputs_digest = true);
Digest Fingerprint(std::string_view bytes);

}  // namespace dispersa
