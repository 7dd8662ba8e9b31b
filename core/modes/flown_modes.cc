#include "core/modes/flown_modes.h"

#include <algorithm>
#include <functional>

#include "core/math/assertion.h"
#include "core/modes/beam_source.h"

namespace dispersa {

namespace {

// The columns that a row has for each mode of its own table, from these on.
std::vector<int> ColumnsByMode() {
  std::vector<int> columns = {ModeTable::kShortening, ModeTable::kBehindBoosters};
  for (int cause = 0; cause < kLiftCauses; ++cause)
    columns.push_back(ModeTable::LiftColumn(cause, kWorkEffects));
  return columns;
}

// A mode's row at a propellant, where the table's first mode is the mode `first` of all.
std::vector<double> RowAt(const ModeTable& table, int plane, int mode, double propellant_kg, int first) {
  std::vector<double> row(ModeTable::kRowSize);
  for (int column = 0; column < ModeTable::kRowSize; ++column)
    row[static_cast<std::size_t>(column)] = table.At(plane, mode, column, propellant_kg);
  for (const int column : ColumnsByMode()) {
    const auto from = row.begin() + column;
    std::rotate(from, from + kModes - first, from + kModes);
  }
  return row;
}

}  // namespace

ModeTable SideBySide(const std::vector<std::shared_ptr<const ModeTable>>& tables) {
  ModeTable all;
  for (const auto& table : tables) {
    all.modes += table->modes;
    all.planes = std::max(all.planes, table->planes);
    all.propellant_kg.insert(all.propellant_kg.end(), table->propellant_kg.begin(),
                             table->propellant_kg.end());
  }
  DISPERSA_ASSERT(all.modes <= kModes, all.modes);
  std::sort(all.propellant_kg.begin(), all.propellant_kg.end(), std::greater<>());
  all.propellant_kg.erase(std::unique(all.propellant_kg.begin(), all.propellant_kg.end()),
                          all.propellant_kg.end());
  for (int plane = 0; plane < all.planes; ++plane)
    for (const double propellant_kg : all.propellant_kg) {
      const std::size_t first_row = all.rows.size();
      int first = 0;
      for (const auto& table : tables) {
        for (int mode = 0; mode < table->modes; ++mode) {
          std::vector<double> row = RowAt(*table, table->planes == 1 ? 0 : plane, mode, propellant_kg, first);
          // The first of all modes has the residual of all.
          for (std::size_t i = ModeTable::kResidual; first > 0 && i < ModeTable::kDamping; ++i) {
            all.rows[first_row + i] += row[i];
            row[i] = 0.0;
          }
          for (const double value : row) all.rows.push_back(value);
        }
        first += table->modes;
      }
    }
  return all;
}

FlownModes::FlownModes(std::vector<std::shared_ptr<const ModeSource>> sources)
    : sources_(std::move(sources)) {}

std::shared_ptr<const ModeTable> FlownModes::Without(unsigned gone) const {
  if (sources_.size() == 1) return sources_[0]->Without(gone);
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<const ModeTable>& made = made_[gone];
  if (!made) {
    std::vector<std::shared_ptr<const ModeTable>> tables;
    for (const auto& source : sources_) tables.push_back(source->Without(gone));
    made = std::make_shared<const ModeTable>(SideBySide(tables));
  }
  return made;
}

ModalPassage FlownModes::Passage(unsigned before, unsigned after, double propellant_kg) const {
  if (sources_.size() == 1) return sources_[0]->Passage(before, after, propellant_kg);
  ModalPassage all;
  std::size_t first = 0;
  for (const auto& source : sources_) {
    const ModalPassage one = source->Passage(before, after, propellant_kg);
    const int modes = source->Without(before)->modes;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      for (int i = 0; i < modes; ++i) {
        const auto mode = static_cast<std::size_t>(i);
        all.shift[plane][first + mode] = one.shift[plane][mode];
        all.turn_1_m[plane][first + mode] = one.turn_1_m[plane][mode];
        std::copy_n(one.onto[plane][mode].begin(), modes,
                    all.onto[plane][first + mode].begin() + static_cast<std::ptrdiff_t>(first));
      }
    }
    first += static_cast<std::size_t>(modes);
  }
  return all;
}

std::shared_ptr<const FlownModes> FlownModes::Of(const std::shared_ptr<const Vehicle>& vehicle,
                                                 const std::shared_ptr<const LoadTable>& loads) const {
  std::vector<std::shared_ptr<const ModeSource>> sources;
  for (const auto& source : sources_) sources.push_back(source->Of(vehicle, loads));
  return std::make_shared<const FlownModes>(std::move(sources));
}

std::shared_ptr<const FlownModes> FlownModesBelow(double highest_rad_s,
                                                  const std::shared_ptr<const Vehicle>& vehicle, int stage,
                                                  const std::shared_ptr<const LoadTable>& loads) {
  std::vector<std::shared_ptr<const ModeSource>> sources;
  if (vehicle->structure_beam && vehicle->structure_beam->flown_modes > 0)
    sources.push_back(BeamSource::Below(highest_rad_s, vehicle, stage, loads));
  return sources.empty() ? nullptr : std::make_shared<const FlownModes>(std::move(sources));
}

}  // namespace dispersa
