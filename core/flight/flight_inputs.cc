#include "core/flight/flight_inputs.h"

#include <algorithm>
#include <cstring>

#include "core/math/assertion.h"

namespace dispersa {
namespace {

constexpr std::size_t kInputCount = sizeof(FlightInputs) / sizeof(double);

const InputDeclarations& Declared() {
  static const InputDeclarations declared = [] {
    InputDeclarations inputs;
    DeclareInputs(inputs);
    DISPERSA_ASSERT(inputs.AllColumns().size() == kInputCount);
    return inputs;
  }();
  return declared;
}

}  // namespace

InputDeclarations& InputDeclarations::One(double FlightInputs::*field, const std::string& name, double unit,
                                          const Dispersal& dispersal) {
  Begin();
  columns_.push_back({name, unit, OffsetOf(&(nominal_.*field))});
  Disperse(dispersal, DrawnFor::kFlight, name);
  return *this;
}

InputDeclarations& InputDeclarations::EachStage(PerStage FlightInputs::*field, const std::string& stem,
                                                const std::string& unit_suffix, double unit,
                                                const Dispersal& dispersal) {
  Begin();
  for (std::size_t i = 0; i < kMaxStages; ++i)
    ColumnsWith(i).push_back({stem + "_stage" + std::to_string(i + 1) + unit_suffix,
                              unit,
                              OffsetOf(&(nominal_.*field)[i]),
                              {static_cast<int>(i) + 1, 0}});
  Disperse(dispersal, DrawnFor::kEachStage, stem + "_{stage}" + unit_suffix);
  return *this;
}

InputDeclarations& InputDeclarations::EachNozzle(PerNozzle FlightInputs::*field, const std::string& stem,
                                                 const std::string& unit_suffix, double unit) {
  Begin();
  for (std::size_t i = 0; i < kMaxStages; ++i)
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle)
      ColumnsWith(i).push_back(
          {stem + "_stage" + std::to_string(i + 1) + "_" + kNozzleNames[nozzle] + unit_suffix,
           unit,
           OffsetOf(&(nominal_.*field)[i][nozzle]),
           {static_cast<int>(i) + 1, static_cast<int>(nozzle)}});
  return *this;
}

InputDeclarations& InputDeclarations::EachFurtherNozzle(PerFurtherNozzle FlightInputs::*field,
                                                        const std::string& stem,
                                                        const std::string& unit_suffix, double unit) {
  Begin();
  for (std::size_t i = 0; i < kFurtherNozzles; ++i)
    further_[i].push_back(
        {stem + "_nozzle" + std::to_string(kNozzles + 1 + static_cast<int>(i)) + unit_suffix,
         unit,
         OffsetOf(&(nominal_.*field)[i]),
         {0, static_cast<int>(i)}});
  return *this;
}

InputDeclarations& InputDeclarations::EachMode(std::array<double, kModes> FlightInputs::*field,
                                               const std::string& stem, const Dispersal& dispersal) {
  Begin();
  for (std::size_t i = 0; i < kModes; ++i)
    columns_.push_back({stem + "_mode" + std::to_string(i + 1),
                        1.0,
                        OffsetOf(&(nominal_.*field)[i]),
                        {0, static_cast<int>(i)}});
  Disperse(dispersal, DrawnFor::kEachMode, stem + "_{mode}");
  return *this;
}

InputDeclarations& InputDeclarations::EachLevel(std::array<double, kWindLevels> FlightInputs::*field,
                                                const std::string& stem, const std::string& unit_suffix) {
  Begin();
  for (std::size_t i = 0; i < kWindLevels; ++i)
    columns_.push_back({stem + "_" + std::to_string(i + 1) + unit_suffix,
                        1.0,
                        OffsetOf(&(nominal_.*field)[i]),
                        {0, static_cast<int>(i)}});
  return *this;
}

InputDeclarations& InputDeclarations::EachLaunchAxis(std::array<double, 3> FlightInputs::*field,
                                                     const std::string& stem,
                                                     const std::string& unit_suffix) {
  Begin();
  const char* const axes[] = {"_downrange", "_right", "_down"};
  for (std::size_t i = 0; i < 3; ++i)
    columns_.push_back({stem + axes[i] + unit_suffix, 1.0, OffsetOf(&(nominal_.*field)[i])});
  return *this;
}

template <typename Set>
InputDeclarations& InputDeclarations::ForLast(Set set) {
  for (std::size_t i = last_; i < columns_.size(); ++i) set(columns_[i]);
  for (std::size_t i = last_rare_; i < rare_.size(); ++i) set(rare_[i]);
  for (auto& columns : further_)
    for (std::size_t i = last_further_; i < columns.size(); ++i) set(columns[i]);
  return *this;
}

InputDeclarations& InputDeclarations::Within(const AllowedValues& allowed) {
  return ForLast([&](InputColumn& column) { column.allowed = allowed; });
}
InputDeclarations& InputDeclarations::ReadBy(const Readers& readers) {
  return ForLast([&](InputColumn& column) { column.readers = readers; });
}
InputDeclarations& InputDeclarations::Usually(const UsualValues& usual) {
  return ForLast([&](InputColumn& column) { column.usual = usual; });
}

std::vector<InputColumn> InputDeclarations::AllColumns() const {
  std::vector<InputColumn> all = columns_;
  all.insert(all.end(), rare_.begin(), rare_.end());
  for (const auto& columns : further_) all.insert(all.end(), columns.begin(), columns.end());
  return all;
}

std::size_t InputDeclarations::OffsetOf(const double* value) const {
  const char* const first = reinterpret_cast<const char*>(&nominal_);
  return static_cast<std::size_t>(reinterpret_cast<const char*>(value) - first);
}

void InputDeclarations::Begin() {
  last_ = columns_.size();
  last_rare_ = rare_.size();
  last_further_ = further_[0].size();
}

std::vector<InputColumn>& InputDeclarations::ColumnsWith(std::size_t stage) {
  return stage < kUsualStages ? columns_ : rare_;
}

void InputDeclarations::Disperse(const Dispersal& dispersal, DrawnFor drawn_for, const std::string& column) {
  if (dispersal.key != nullptr) dispersed_.push_back({dispersal, drawn_for, column});
}

const std::vector<InputColumn>& InputColumns() {
  static const std::vector<InputColumn> columns = Declared().AllColumns();
  return columns;
}

const std::vector<DispersedInput>& DeclaredDispersals() { return Declared().dispersed(); }

std::size_t InputCount(std::size_t stages) {
  if (stages <= kUsualStages) return Declared().usual();
  const std::size_t further = stages > kMaxStages ? stages - kMaxStages : 0;
  return Declared().of_stages() +
         std::min<std::size_t>(further, kFurtherNozzles) * Declared().of_further_nozzle();
}

namespace {

int FurtherNozzlesOf(const Stage& stage) {
  return std::max(0, static_cast<int>(NozzlesOf(stage.gimbal).size()) - kNozzles);
}

}  // namespace

int FurtherNozzlesBefore(const Vehicle& vehicle, std::size_t stage) {
  int further = 0;
  for (std::size_t i = 0; i < stage; ++i) further += FurtherNozzlesOf(vehicle.stages[i]);
  return further;
}

std::size_t ColumnClass(const Vehicle& vehicle) {
  const std::size_t stages = vehicle.stages.size();
  const int further =
      FurtherNozzlesBefore(vehicle, stages) + static_cast<int>(vehicle.boosters.angles_rad.size());
  return further == 0 ? stages : kMaxStages + static_cast<std::size_t>(further);
}

std::string BoosterInColumns(const Vehicle& vehicle, std::size_t booster) {
  return "nozzle" + std::to_string(kNozzles + 1 + FurtherNozzlesBefore(vehicle, vehicle.stages.size()) +
                                   static_cast<int>(booster));
}

std::string NozzleInColumns(const Vehicle& vehicle, std::size_t stage, int nozzle) {
  if (nozzle < kNozzles) return "stage" + std::to_string(stage + 1) + "_" + kNozzleNames[nozzle];
  return "nozzle" + std::to_string(FurtherNozzlesBefore(vehicle, stage) + nozzle + 1);
}

Circle CircleOf(const InputColumn& column) {
  const bool is_direction = column.name.find("_clock") != std::string::npos ||
                            column.name.find("_azimuth_deg") != std::string::npos;
  return is_direction ? kCutAt0Deg : Circle{};
}

int FindInput(const std::string& name) {
  const std::vector<InputColumn>& columns = InputColumns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

double& InputValue(FlightInputs& inputs, int column) {
  const std::size_t offset = InputColumns()[static_cast<std::size_t>(column)].offset;
  return *reinterpret_cast<double*>(reinterpret_cast<char*>(&inputs) + offset);
}

void TakeColumns(FlightInputs& inputs) {
  for (const InputColumn& column : InputColumns()) {
    double& value = *reinterpret_cast<double*>(reinterpret_cast<char*>(&inputs) + column.offset);
    const double in_unit = value / column.unit + 0.0;
    value = in_unit * column.unit;
  }
}

std::vector<double> InputValues(const FlightInputs& inputs, std::size_t stages) {
  std::vector<double> values(InputCount(stages));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const InputColumn& column = InputColumns()[i];
    double value;
    std::memcpy(&value, reinterpret_cast<const char*>(&inputs) + column.offset, sizeof value);
    values[i] = 0.0 + value / column.unit;  // 0.0 +: results hold no -0
  }
  return values;
}

}  // namespace dispersa
