// InputError lives with the campaign, so that modules without YAML (core/report) may throw it too.
#pragma once

#include "core/campaign/input_error.h"
