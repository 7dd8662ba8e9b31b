// nominal.json: the inputs that rows do not hold, because nothing in the campaign sets them.
#pragma once

#include <string>

#include "core/campaign/row_inputs.h"

namespace dispersa {

/// Schema "dispersa/nominal/1": each constant by its name, with its value as every flight applied it, its
/// unit, and the key of `dispersions` that would set it.
std::string NominalJson(const RowInputs& inputs);

}  // namespace dispersa
