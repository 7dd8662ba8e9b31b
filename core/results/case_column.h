// One quantity over all cases. Few cases are kept in memory. For many cases the disk holds the columns and
// memory holds the one in use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace dispersa {

/// Stores rows and returns columns. Beyond a few thousand rows it uses an unnamed file in `directory`, which
/// is removed with the object. If `directory` cannot be written, the file is in the system's folder for
/// temporary files. Throws ResultError (kDiskFull, else kFile).
class ColumnFile {
 public:
  ColumnFile(std::filesystem::path directory, std::size_t columns);
  ~ColumnFile();
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;

  /// `row` has one value for each column.
  void Append(const std::vector<double>& row);
  std::size_t rows() const { return rows_; }
  std::vector<double> Read(std::size_t column) const;

 private:
  void WriteBlock();

  std::filesystem::path directory_;
  std::size_t columns_;
  std::size_t rows_ = 0;
  std::vector<double> block_;  ///< the latest rows, column by column
  int file_ = -1;              ///< descriptor of the file with the earlier rows, block by block
};

/// A column of values, or of one value in every row. NaN is undefined.
class CaseColumn {
 public:
  CaseColumn() = default;
  /// In memory.
  CaseColumn(std::vector<double> values) : values_(std::move(values)) {}
  CaseColumn(std::shared_ptr<const ColumnFile> file, std::size_t number)
      : file_(std::move(file)), number_(number) {}
  CaseColumn(std::size_t rows, double constant) : rows_(rows), constant_(constant) {}

  std::size_t size() const { return file_ ? file_->rows() : rows_ > 0 ? rows_ : values_.size(); }
  bool empty() const { return size() == 0; }
  /// All values. Those of a column on disk are read now.
  std::vector<double> Values() const {
    if (rows_ > 0) return std::vector<double>(rows_, constant_);
    return file_ ? file_->Read(number_) : values_;
  }
  operator std::vector<double>() const { return Values(); }

  // For a column in memory only.
  void push_back(double value) { values_.push_back(value); }
  double operator[](std::size_t row) const { return values_[row]; }
  double& operator[](std::size_t row) { return values_[row]; }

 private:
  std::vector<double> values_;
  std::shared_ptr<const ColumnFile> file_;
  std::size_t number_ = 0;
  std::size_t rows_ = 0;  ///< of a constant
  double constant_ = 0.0;
};

}  // namespace dispersa
