// cases.csv: one line a case, sorted by case index, the same bytes however the cases were flown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/campaign/case_result.h"
#include "core/results/output_file.h"
#include "core/results/result_folder.h"

namespace dispersa {

/// Both with their line break, of a vehicle with so many stages. Doubles in the shortest text that reads back
/// to the same bits.
std::string CasesCsvHeader(std::size_t stages);
std::string CasesCsvLine(const CaseResult& result);

/// The file as it grows; it takes its place as a whole.
class CasesCsv {
 public:
  CasesCsv(const std::filesystem::path& file, std::size_t stages);

  /// In ascending order of case index.
  void Write(const CaseResult& result) {
    file_.Write(CasesCsvLine(result));
    ++rows_;
  }
  std::uint64_t rows() const { return rows_; }
  void Commit() { file_.Commit(); }

 private:
  OutputFile file_;
  std::uint64_t rows_ = 0;
};

/// Cases of a file that was written before; 0 if there is none.
std::uint64_t CountCases(const std::filesystem::path& file);

/// All that is stored.
void WriteCasesCsv(const ResultFolder& folder, const std::filesystem::path& file);

}  // namespace dispersa
