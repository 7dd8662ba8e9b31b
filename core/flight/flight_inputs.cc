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

InputDeclarations& InputDeclarations::One(int number, const double& of, const std::string& name, double unit,
                                          const Dispersal& dispersal) {
  Begin();
  columns_.push_back({number, name, unit, OffsetOf(of)});
  Disperse(number, dispersal, DrawnFor::kFlight, name);
  return *this;
}

InputDeclarations& InputDeclarations::EachStage(int number, const double& of, const std::string& stem,
                                                const std::string& unit_suffix, double unit,
                                                const Dispersal& dispersal) {
  Begin();
  for (std::size_t i = 0; i < kMaxStages; ++i)
    ColumnsWith(i).push_back({number,
                              stem + "_stage" + std::to_string(i + 1) + unit_suffix,
                              unit,
                              OffsetOf(of) + i * sizeof(StageInputs),
                              {Carrier::kStage, static_cast<int>(i) + 1, 0}});
  Disperse(number, dispersal, DrawnFor::kEachStage, stem + "_{stage}" + unit_suffix);
  return *this;
}

InputDeclarations& InputDeclarations::EachNozzle(NozzleNumbers numbers, const double& of,
                                                 const std::string& stem, const std::string& unit_suffix,
                                                 double unit) {
  Begin();
  const auto* const first = reinterpret_cast<const double*>(&nominal_.stages[0].nozzles[0]);
  for (std::size_t i = 0; i < kMaxStages; ++i)
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle)
      ColumnsWith(i).push_back(
          {numbers.of_stage,
           stem + "_stage" + std::to_string(i + 1) + "_" + kNozzleNames[nozzle] + unit_suffix,
           unit,
           OffsetOf(of) + i * sizeof(StageInputs) + nozzle * sizeof(NozzleInputs),
           {Carrier::kNozzle, static_cast<int>(i) + 1, static_cast<int>(nozzle)}});
  const std::size_t within = OffsetOf(of) - OffsetOf(*first);
  const auto* const beyond = reinterpret_cast<const double*>(&nominal_.further[0].nozzle);
  Further(Carrier::kFurtherNozzle, numbers.further, OffsetOf(*beyond) + within, stem, unit_suffix, unit);
  return *this;
}

InputDeclarations& InputDeclarations::EachBooster(int number, const double& of, const std::string& stem) {
  Begin();
  Further(Carrier::kBooster, number, OffsetOf(of), stem, "", 1.0);
  return *this;
}

InputDeclarations& InputDeclarations::EachMode(int number, const std::array<double, kModes>& of,
                                               const std::string& stem, const Dispersal& dispersal) {
  Begin();
  for (std::size_t i = 0; i < kModes; ++i)
    columns_.push_back({number,
                        stem + "_mode" + std::to_string(i + 1),
                        1.0,
                        OffsetOf(of[i]),
                        {Carrier::kFlight, 0, static_cast<int>(i)}});
  Disperse(number, dispersal, DrawnFor::kEachMode, stem + "_{mode}");
  return *this;
}

InputDeclarations& InputDeclarations::EachLevel(int number, const std::array<double, kWindLevels>& of,
                                                const std::string& stem, const std::string& unit_suffix) {
  Begin();
  for (std::size_t i = 0; i < kWindLevels; ++i)
    columns_.push_back({number,
                        stem + "_" + std::to_string(i + 1) + unit_suffix,
                        1.0,
                        OffsetOf(of[i]),
                        {Carrier::kFlight, 0, static_cast<int>(i)}});
  return *this;
}

InputDeclarations& InputDeclarations::EachLaunchAxis(int number, const std::array<double, 3>& of,
                                                     const std::string& stem,
                                                     const std::string& unit_suffix) {
  Begin();
  const char* const axes[] = {"_downrange", "_right", "_down"};
  for (std::size_t i = 0; i < 3; ++i)
    columns_.push_back({number, stem + axes[i] + unit_suffix, 1.0, OffsetOf(of[i])});
  return *this;
}

void InputDeclarations::Further(Carrier carrier, int number, std::size_t offset, const std::string& stem,
                                const std::string& unit_suffix, double unit) {
  for (std::size_t i = 0; i < kFurtherNozzles; ++i)
    further_[i].push_back(
        {number,
         stem + "_nozzle" + std::to_string(kNozzles + 1 + static_cast<int>(i)) + unit_suffix,
         unit,
         offset + i * sizeof(FurtherInputs),
         {carrier, 0, static_cast<int>(i)}});
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
InputDeclarations& InputDeclarations::OfFurtherReadBy(const Readers& readers) {
  for (auto& columns : further_)
    for (std::size_t i = last_further_; i < columns.size(); ++i) columns[i].readers = readers;
  return *this;
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

void InputDeclarations::Finish() {
  const auto by_number = [](const auto& a, const auto& b) { return a.number < b.number; };
  const auto sort = [&](auto& all) { std::stable_sort(all.begin(), all.end(), by_number); };
  sort(columns_);
  sort(rare_);
  for (auto& columns : further_) sort(columns);
  sort(dispersed_);
}

std::size_t InputDeclarations::OffsetOf(const double& value) const {
  const char* const first = reinterpret_cast<const char*>(&nominal_);
  const std::ptrdiff_t offset = reinterpret_cast<const char*>(&value) - first;
  DISPERSA_ASSERT(offset >= 0 && offset < static_cast<std::ptrdiff_t>(sizeof nominal_), offset);
  return static_cast<std::size_t>(offset);
}

void InputDeclarations::Begin() {
  last_ = columns_.size();
  last_rare_ = rare_.size();
  last_further_ = further_[0].size();
}

std::vector<InputColumn>& InputDeclarations::ColumnsWith(std::size_t stage) {
  return stage < kUsualStages ? columns_ : rare_;
}

void InputDeclarations::Disperse(int number, const Dispersal& dispersal, DrawnFor drawn_for,
                                 const std::string& column) {
  if (dispersal.key != nullptr) dispersed_.push_back({number, dispersal, drawn_for, column});
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
