// Puts the contents of a file in the place of its name, so that one tree holds everything.
#pragma once

#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

inline constexpr char kCampaignSchema[] = "dispersa/campaign/1";
inline constexpr char kVehicleSchema[] = "dispersa/vehicle/1";
inline constexpr char kAutopilotSchema[] = "dispersa/autopilot/1";
inline constexpr char kReferenceSchema[] = "dispersa/reference/1";
inline constexpr char kScenarioSchema[] = "dispersa/scenario/1";

/// Columns of the tables that a file may name.
inline const std::vector<std::string> kWindTableColumns = {"altitude_m", "north_m_s", "east_m_s"};
inline const std::vector<std::string> kWindStatisticsColumns = {
    "altitude_m", "mean_north_m_s", "mean_east_m_s", "sigma_north_m_s", "sigma_east_m_s"};
inline const std::vector<std::string> kAeroTableColumns = {
    "mach", "incidence_deg", "ca", "cn", "xcp_station_m", "cmq_per_rad", "clp_per_rad"};
inline const std::vector<std::string> kThrustCurveColumns = {"time_s", "thrust_n"};
inline const std::vector<std::string> kThrottleColumns = {"time_s", "level_percent"};
inline constexpr char kFlowColumn[] = "mass_flow_kg_s";  ///< which a thrust curve may have besides
inline const std::vector<std::string> kMassTableColumns = {"propellant_kg", "mass_kg",   "cg_station_m",
                                                           "ixx_kg_m2",     "iyy_kg_m2", "izz_kg_m2",
                                                           "ixy_kg_m2",     "ixz_kg_m2", "iyz_kg_m2"};
inline const std::vector<std::string> kModeTableColumns = {
    "stage",     "propellant_kg", "plane",    "mode", "frequency_hz", "generalized_mass_kg",
    "station_m", "deflection",    "slope_1_m"};

/// Whether a text may name files: a canonical text, which lives anywhere, may not.
enum class FileNames { kAllowed, kRefused };

/// Reads a YAML file. An unreadable one is a problem at line 1, column 1.
InputNode ReadYamlFile(const std::string& path, std::vector<InputProblem>& problems);

/// Replaces what names a file: a campaign's vehicle, reference, autopilot and wind tables, a vehicle's base,
/// thrust curves, throttles, aerodynamic tables and table of modes, a scenario's wind, mass and coefficient
/// tables. Names are relative to the file in which they stand. A plug-in's library becomes its bytes:
/// {sha256, base64}.
void InlineAutopilotFiles(InputNode& autopilot, const std::string& path, FileNames names,
                          std::vector<InputProblem>& problems);
void InlineCampaignFiles(InputNode& campaign, FileNames names, std::vector<InputProblem>& problems);
void InlineVehicleFiles(InputNode& vehicle, FileNames names, std::vector<InputProblem>& problems);
void InlineScenarioFiles(InputNode& scenario, FileNames names, std::vector<InputProblem>& problems);

/// True if a tree that was read from a file has this `schema`; a map that stands inside another file
/// (`inside`) need not have one. False is recorded as a problem.
bool CheckSchema(const InputNode& node, const std::string& schema, bool inside, const std::string& path,
                 std::vector<InputProblem>& problems);

}  // namespace dispersa
