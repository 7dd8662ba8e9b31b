#include "services/cli/plan_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/analysis/dispersion_summary.h"
#include "core/campaign/case_design.h"
#include "core/flight/flight_inputs.h"
#include "core/results/metric_catalogue.h"

namespace dispersa {
namespace {

constexpr std::size_t kShownInputs = 20;
constexpr std::size_t kIndent = 2, kUnitWidth = 6, kNumberWidth = 11;

/// Columns of the inputs that any dispersion feeds. The others stay empty.
CaseColumns DrawnColumns(const Campaign& campaign, const std::vector<int>& inputs) {
  const CaseDesign design(campaign);
  CaseColumns cases;
  const std::size_t stages = ColumnClass(campaign.vehicle);
  cases.inputs.resize(InputCount(stages));
  for (std::uint64_t index = 0; index < campaign.sampling.cases; ++index) {
    cases.index.push_back(index);
    const std::vector<double> values = InputValues(design.Draw(index), stages);
    for (const int input : inputs) {
      const auto column = static_cast<std::size_t>(input);
      cases.inputs[column].push_back(values[column]);
    }
  }
  return cases;
}

bool IsDoubtful(const DispersionSummary& one) { return one.consistent && !*one.consistent; }

/// The rows of both tables.
class PlanTable {
 public:
  PlanTable(const Campaign& campaign, bool all, std::size_t width)
      : campaign_(campaign),
        inputs_(DispersedInputs(campaign)),
        cases_(DrawnColumns(campaign, inputs_)),
        summaries_(SummarizeDispersions(campaign, cases_)),
        all_(all) {
    for (const int input : inputs_) name_width_ = std::max(name_width_, SplitUnit(Name(input)).stem.size());
    name_width_ += kIndent + 2;
    const std::size_t left = name_width_ + kUnitWidth;
    across_ = std::max<std::size_t>(
        (std::max<std::size_t>(std::max<std::size_t>(width, 80), left) - left) / kNumberWidth, 1);
  }

  std::string Text() const {
    std::string text = fmt::format("{}: {} cases, seed {}, {} dispersed inputs\n", campaign_.name,
                                   campaign_.sampling.cases, campaign_.sampling.seed, inputs_.size());
    if (inputs_.empty()) return text;
    text += DrawnTable() + Soundings();
    const std::size_t blocks = all_ ? (cases_.rows() + across_ - 1) / across_ : 1;
    for (std::size_t block = 0; block < blocks; ++block) text += CasesTable(block * across_);
    return text + Rest();
  }

 private:
  static const std::string& Name(int input) { return InputColumns()[static_cast<std::size_t>(input)].name; }

  std::string Row(const std::string& name) const {
    const NameAndUnit split = SplitUnit(name);
    return fmt::format("{:<{}}{:<{}}", std::string(kIndent, ' ') + split.stem, name_width_, split.unit,
                       kUnitWidth);
  }
  static std::string Number(double value) { return fmt::format("{:>{}.5g}", value, kNumberWidth); }
  static std::string Heading(const std::string& text) { return fmt::format("{:>{}}", text, kNumberWidth); }

  /// The dispersion without its parts: "thrust" of "thrust/stage1".
  static std::string Block(const DispersionSummary& one) {
    return one.dispersion.substr(0, one.dispersion.find('/'));
  }

  /// Inputs of one law stand together under it.
  std::string DrawnTable() const {
    std::string text =
        fmt::format("\n{:<{}}{:<{}}{}{}{}{}\n", "drawn", name_width_, "unit", kUnitWidth, Heading("mean"),
                    Heading("std dev"), Heading("least"), Heading("greatest"));
    const DispersionSummary* above = nullptr;
    std::size_t row = 0;
    for (const DispersionSummary& one : summaries_) {
      if (!IsShown(row++) && !IsDoubtful(one)) continue;
      if (above == nullptr || Block(*above) != Block(one) || above->declared != one.declared)
        text += fmt::format("{}: {}\n", Block(one), one.declared);
      above = &one;
      const Summary& drawn = one.drawn;
      text += Row(one.input) + Number(drawn.mean) + Number(drawn.std) + Number(drawn.min) + Number(drawn.max);
      text += IsDoubtful(one) ? "  THE DRAWS DO NOT AGREE\n" : "\n";
    }
    return text;
  }

  /// What the numbers of soundings mean.
  std::string Soundings() const {
    const std::vector<DatedWeather>& soundings = campaign_.soundings;
    if (soundings.empty()) return "";
    std::string text = fmt::format("\n{:<{}}file\n", "sounding", name_width_);
    const std::size_t shown = all_ ? soundings.size() : std::min(soundings.size(), kShownInputs);
    for (std::size_t i = 0; i < shown; ++i)
      text += fmt::format("{:<{}}{}  {}\n", "  " + std::to_string(i + 1), name_width_, soundings[i].file,
                          soundings[i].time);
    if (shown < soundings.size()) text += fmt::format("  ... of {}; --all shows them\n", soundings.size());
    return text;
  }

  std::string CasesTable(std::size_t from) const {
    const std::size_t to = std::min(from + across_, cases_.rows());
    std::string text = fmt::format("\n{:<{}}{:<{}}", "case", name_width_, "unit", kUnitWidth);
    for (std::size_t i = from; i < to; ++i) text += Heading(std::to_string(i));
    text += "\n";
    for (std::size_t row = 0; row < inputs_.size() && IsShown(row); ++row) {
      text += Row(Name(inputs_[row]));
      for (std::size_t i = from; i < to; ++i)
        text += Number(cases_.inputs[static_cast<std::size_t>(inputs_[row])][i]);
      text += "\n";
    }
    return text;
  }

  std::string Rest() const {
    std::string text = "\n";
    const auto judged = std::count_if(summaries_.begin(), summaries_.end(), [](const DispersionSummary& one) {
      return one.consistent.has_value();
    });
    const auto doubtful = std::count_if(summaries_.begin(), summaries_.end(), IsDoubtful);
    if (judged > 0 && doubtful == 0)
      text += fmt::format("Drawn as declared: mean and standard deviation of all {} that can be judged.\n",
                          judged);
    const bool fewer_inputs = !all_ && summaries_.size() > kShownInputs,
               fewer_cases = !all_ && cases_.rows() > across_;
    if (fewer_inputs || fewer_cases)
      text += fmt::format(
          "Shown: {} of {} inputs, {} of {} cases; --all shows the rest, --csv writes a table of it.\n",
          std::min(kShownInputs, inputs_.size()), inputs_.size(), std::min(across_, cases_.rows()),
          cases_.rows());
    return text == "\n" ? "" : text;
  }

  bool IsShown(std::size_t row) const { return all_ || row < kShownInputs; }

  const Campaign& campaign_;
  std::vector<int> inputs_;
  CaseColumns cases_;
  std::vector<DispersionSummary> summaries_;
  bool all_;
  std::size_t name_width_ = 0;  ///< of the first column
  std::size_t across_ = 1;      ///< cases beside each other
};

}  // namespace

std::string PlanText(const Campaign& campaign, bool all, std::size_t width) {
  return PlanTable(campaign, all, width).Text();
}

}  // namespace dispersa
