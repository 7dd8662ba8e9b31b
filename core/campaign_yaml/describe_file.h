// The keys of whole files.
#pragma once

#include "core/campaign_yaml/file_kind.h"
#include "core/control/autopilot_fields.h"
#include "core/flight/scenario.h"
#include "core/input/fields.h"
#include "core/trajectory/reference.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// How files are based on others.
const BaseKeys& CampaignBase();
const BaseKeys& VehicleBase();

void DescribeVehicleFile(Fields& fields, Vehicle& vehicle);
void DescribeReferenceFile(Fields& fields, Reference& reference);
void DescribeAutopilotFile(Fields& fields, AutopilotConfig& autopilot, const OpenPlugin& open);
void DescribeScenarioFile(Fields& fields, Scenario& scenario);

/// Describes a kind of file without a file, for schemas and tables of keys.
void DescribeFile(FileKind kind, Fields& fields);

}  // namespace dispersa
