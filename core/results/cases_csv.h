// cases.csv: one line a case, sorted by case index, the same bytes however the cases were flown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct CsvColumns {
  std::vector<std::size_t> inputs;   ///< places in a row's inputs
  std::vector<std::size_t> metrics;  ///< positions in the folder's list
  /// Place of the sounding's number, and by this number what it is: two cells, its file and its time.
  std::optional<std::size_t> sounding = {};
  std::vector<std::string> soundings = {};
};
/// All that a folder stores. `soundings`: of the campaign.
CsvColumns StoredColumns(const ResultFolder& folder, const std::vector<DatedWeather>& soundings = {});
/// Those of them that differ between cases.
CsvColumns VaryingColumns(const ResultFolder& folder, const std::vector<DatedWeather>& soundings = {});

/// Both with their line break. Doubles in the shortest text that reads back to the same bits.
std::string CasesCsvHeader(const RowInputs& inputs, const MetricList& list, const CsvColumns& columns);
std::string CasesCsvLine(const CaseResult& result, const CsvColumns& columns);

/// The growing file. It replaces the old one as a whole.
class CasesCsv {
 public:
  CasesCsv(const std::filesystem::path& file, const ResultFolder& folder, CsvColumns columns);

  /// In ascending order of case index.
  void Write(const CaseResult& result) {
    file_.Write(CasesCsvLine(result, columns_));
    ++rows_;
  }
  std::uint64_t rows() const { return rows_; }
  void Commit() { file_.Commit(); }

 private:
  OutputFile file_;
  CsvColumns columns_;
  std::uint64_t rows_ = 0;
};

/// Number of cases of an earlier file; 0 if there is none.
std::uint64_t CountCases(const std::filesystem::path& file);

/// All cases that are stored.
void WriteCasesCsv(const ResultFolder& folder, const CsvColumns& columns, const std::filesystem::path& file);

}  // namespace dispersa
