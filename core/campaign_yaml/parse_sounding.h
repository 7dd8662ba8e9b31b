// Soundings in the shapes in which people hold them, as the columns of a weather table (core/environment).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/environment/sounding.h"
#include "core/input/input_error.h"
#include "core/input/input_node.h"

namespace dispersa {

/// A sounding as its file gives it. `source` of a level is its line.
struct Sounding {
  std::string title;                   ///< the station and the time, as far as the file names them
  std::string time;                    ///< DatedWeather's; empty: the file names none
  std::optional<double> latitude_rad;  ///< of the station
  std::vector<SoundingLevel> levels;
  std::vector<std::string> not_read;  ///< names of further columns
};

/// Whether a text is a sounding of the University of Wyoming or of IGRA 2, rather than a CSV table.
bool IsSoundingText(const std::string& text);
/// Whether a table (parse_csv.h) is a sounding: it has an altitude, and wind as speed and direction, or units
/// that our own tables do not have.
bool IsSoundingTable(const InputNode& table);

/// The times of the soundings of an IGRA 2 file, as `date` below. Of any other text none.
std::vector<std::string> TimesOf(const std::string& text);
/// YYYYMMDD in a file's name, with or without '-' or '_' between and an hour after, as a DatedWeather's time.
/// Empty: there is none.
std::string TimeInName(const std::string& file);
/// One sounding. Of an IGRA 2 file with several, `date` (YYYY-MM-DDTHH) chooses. Columns and their units come
/// from the file. Values for "missing" are missing. A text of another form is a problem and gives no levels.
Sounding ReadSounding(const std::string& text, const std::string& file, const std::string& date,
                      std::vector<InputProblem>& problems);
Sounding ReadSounding(const InputNode& table, std::vector<InputProblem>& problems);

/// The columns altitude_m, north_m_s, east_m_s, and, where the sounding has air, pressure_pa and
/// density_kg_m3. A value's place is its level's. Without a table, an absent node.
InputNode TableOf(const Sounding& sounding, const std::string& file, std::vector<InputProblem>& problems);

/// A sounding's file as our own CSV table, under comments that say what was read and what was added.
/// `path` may be "-". Throws InputError.
std::string ConvertSounding(const std::string& path, const std::string& date);

}  // namespace dispersa
