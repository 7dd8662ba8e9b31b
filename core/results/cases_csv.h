// cases.csv: one line a case, sorted by case index, the same bytes however the cases were flown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"

namespace dispersa {

/// Both with their line break, with the metrics at these positions of the list. Doubles in the shortest text
/// that reads back to the same bits.
std::string CasesCsvHeader(const MetricList& list, const std::vector<std::size_t>& metrics);
std::string CasesCsvLine(const CaseResult& result, const std::vector<std::size_t>& metrics);

/// The growing file. It replaces the old one as a whole.
class CasesCsv {
 public:
  /// Of what the folder stores.
  CasesCsv(const std::filesystem::path& file, const ResultFolder& folder);

  /// In ascending order of case index.
  void Write(const CaseResult& result) {
    file_.Write(CasesCsvLine(result, metrics_));
    ++rows_;
  }
  std::uint64_t rows() const { return rows_; }
  void Commit() { file_.Commit(); }

 private:
  OutputFile file_;
  std::vector<std::size_t> metrics_;
  std::uint64_t rows_ = 0;
};

/// Number of cases of an earlier file; 0 if there is none.
std::uint64_t CountCases(const std::filesystem::path& file);

/// All that is stored.
void WriteCasesCsv(const ResultFolder& folder, const std::filesystem::path& file);

}  // namespace dispersa
