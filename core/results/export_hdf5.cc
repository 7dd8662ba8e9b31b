#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/campaign/dispersion_table.h"
#include "core/flight/flight_inputs.h"
#include "core/input/disk_full.h"
#include "core/results/case_columns.h"
#include "core/results/export.h"
#include "core/results/file_system.h"
#include "core/results/gzip.h"
#include "core/results/metric_catalogue.h"
#include "core/results/number_csv.h"
#include "core/results/result_error.h"

namespace dispersa {
namespace {

[[noreturn]] void FailHdf5(const std::string& what) {
  const int error = errno;  // of the call that the library failed in
  if (DiskFullWords(error)) throw std::system_error(error, std::generic_category());
  throw ResultError(ResultError::Kind::kFile, what + ": HDF5 cannot write it");
}

/// An identifier of the library, closed at the end of its scope.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
    if (id_ < 0) FailHdf5(what);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  hid_t Release() { return std::exchange(id_, -1); }

 private:
  hid_t id_;
  Close close_;
};

void Check(herr_t result, const std::string& what) {
  if (result < 0) FailHdf5(what);
}

/// Text of fixed length, padded with zeros: every reader supports this. Octave does not support UTF-8 in
/// datasets.
Handle TextType(std::size_t length, H5T_cset_t characters) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text");
  Check(H5Tset_size(type, std::max<std::size_t>(1, length)), "text");
  Check(H5Tset_strpad(type, H5T_STR_NULLPAD), "text");
  Check(H5Tset_cset(type, characters), "text");
  return type;
}

class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& file)
      : name_(file.string()),
        file_(H5Fcreate(name_.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, name_),
        creation_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name_),
        group_creation_(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, name_) {
    // Times are not stored, so that the same results give the same bytes.
    Check(H5Pset_obj_track_times(creation_, false), name_);
    Check(H5Pset_obj_track_times(group_creation_, false), name_);
  }

  /// What the library still holds is written.
  void Close() { Check(H5Fclose(file_.Release()), name_); }

  void Group(const char* path) {
    Handle(H5Gcreate2(file_, path, H5P_DEFAULT, group_creation_, H5P_DEFAULT), H5Gclose, path);
  }
  void Attribute(const std::string& path, const char* name, const std::string& text) {
    const Handle type = TextType(text.size(), H5T_CSET_UTF8);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, path);
    const Handle object(H5Oopen(file_, path.c_str(), H5P_DEFAULT), H5Oclose, path);
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
    std::string padded = text.empty() ? std::string(1, '\0') : text;
    Check(H5Awrite(attribute, type, padded.data()), path);
  }
  void Write(const std::string& path, hid_t stored, hid_t given, std::size_t rows, const void* values) {
    const hsize_t size = rows;
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, path);
    const Handle data(H5Dcreate2(file_, path.c_str(), stored, space, H5P_DEFAULT, creation_, H5P_DEFAULT),
                      H5Dclose, path);
    if (rows > 0) Check(H5Dwrite(data, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path);
  }
  void Numbers(const std::string& path, const std::vector<double>& values) {
    Write(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.size(), values.data());
  }
  void Integers(const std::string& path, const std::vector<std::uint64_t>& values) {
    Write(path, H5T_STD_U64LE, H5T_NATIVE_UINT64, values.size(), values.data());
  }
  void Texts(const std::string& path, const std::vector<std::string>& texts) {
    std::size_t length = 1;
    for (const std::string& text : texts) length = std::max(length, text.size());
    std::string padded(length * texts.size(), '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(padded.data() + i * length, length);
    const Handle type = TextType(length, H5T_CSET_ASCII);
    Write(path, type, type, texts.size(), padded.data());
  }

 private:
  std::string name_;
  Handle file_;
  Handle creation_;
  Handle group_creation_;
};

void WriteColumn(Hdf5File& output, const std::string& path, const std::string& unit,
                 const std::vector<double>& values) {
  output.Numbers(path, values);
  output.Attribute(path, "unit", unit);
}

void WriteProvenance(Hdf5File& output, const ResultFolder& folder, const std::string& incomplete) {
  output.Attribute("/", "schema", "dispersa/hdf5/1");
  for (const char* key : {"name", "campaign_id", "flight_id", "engine", "seed", "cases", "sampling"})
    output.Attribute("/", key, folder.Provenance(key));
  if (!incomplete.empty()) output.Attribute("/", "incomplete", incomplete);
}

/// What a case has beside inputs and metrics.
struct CaseOutcomes {
  std::vector<double> end_time_s;
  std::vector<std::uint64_t> end_stage;
  std::vector<std::string> outcome, reason, digest;

  void Add(const CaseResult& result) {
    outcome.push_back(OutcomeName(result.outcome));
    end_time_s.push_back(result.end_time_s);
    end_stage.push_back(static_cast<std::uint64_t>(result.end_stage));
    reason.push_back(result.reason);
    digest.push_back(result.digest.Hex());
  }
};

void WriteCases(Hdf5File& output, const std::vector<std::uint64_t>& index, const CaseOutcomes& outcomes) {
  output.Group("/cases");
  output.Integers("/cases/case_index", index);
  output.Texts("/cases/outcome", outcomes.outcome);
  output.Numbers("/cases/end_time_s", outcomes.end_time_s);
  output.Integers("/cases/end_stage", outcomes.end_stage);
  output.Texts("/cases/reason", outcomes.reason);
  output.Texts("/cases/digest", outcomes.digest);
}

void WriteInputs(Hdf5File& output, const ResultFolder& folder, const CaseColumns& cases) {
  output.Group("/inputs");
  for (const std::size_t i : folder.inputs().positions()) {
    const std::string path = "/inputs/" + InputColumns()[i].name;
    WriteColumn(output, path, SplitUnit(InputColumns()[i].name).unit, cases.inputs[i].Values());
    output.Attribute(path, "key", InputKey(static_cast<int>(i)));
  }
  output.Group("/nominal");
  std::vector<std::string> names, units, keys;
  std::vector<double> constants;
  for (const std::size_t i : folder.inputs().constants()) {
    names.push_back(InputColumns()[i].name);
    units.push_back(SplitUnit(names.back()).unit);
    keys.push_back(InputKey(static_cast<int>(i)));
    constants.push_back(folder.inputs().constant(i));
  }
  output.Texts("/nominal/input", names);
  output.Numbers("/nominal/value", constants);
  output.Texts("/nominal/unit", units);
  output.Texts("/nominal/key", keys);
}

void WriteMetrics(Hdf5File& output, const ResultFolder& folder, const CaseColumns& cases) {
  output.Group("/metrics");
  for (const std::size_t i : folder.metrics()) {
    const std::string& name = folder.metric_list().NameAt(i);
    const MetricInfo info = DescribeMetric(name);
    const std::string path = "/metrics/" + name;
    WriteColumn(output, path, info.unit, cases.metrics[i].Values());
    output.Attribute(path, "group", info.group);
    output.Attribute(path, "label", info.title);
    if (!info.over.empty()) output.Attribute(path, "defined_over", info.over);
  }
}

constexpr std::string_view kHistoryEnding = ".csv.gz";

/// Those of the folder's report, if it has written any.
std::vector<std::filesystem::path> HistoryFiles(const ResultFolder& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder.directory() / "histories", error), end;
       !error && entry != end; entry.increment(error))
    if (entry->path().filename().string().ends_with(kHistoryEnding)) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  return files;
}

NumberCsv ReadHistory(const std::filesystem::path& file) {
  std::ostringstream bytes;
  const std::ifstream stream(file, std::ios::binary);
  if (!stream) FailFile(file.string(), "cannot be read", errno);
  bytes << stream.rdbuf();
  const std::optional<std::string> text = Gunzip(std::move(bytes).str());
  std::optional<NumberCsv> table = text ? ReadNumberCsv(*text) : std::nullopt;
  if (!table) {
    throw ResultError(ResultError::Kind::kFile,
                      file.string() + ": no history, or damaged; `dispersa report` writes it anew");
  }
  return *std::move(table);
}

/// A column of bands ends in its statistic: altitude_m_p50.
std::string HistoryUnit(const std::string& column) {
  const std::string unit = SplitUnit(column).unit;
  return unit.empty() ? SplitUnit(column.substr(0, column.rfind('_'))).unit : unit;
}

void WriteHistories(Hdf5File& output, const ResultFolder& folder) {
  const std::vector<std::filesystem::path> files = HistoryFiles(folder);
  if (files.empty()) return;
  output.Group("/histories");
  for (const std::filesystem::path& file : files) {
    const std::string name = file.filename().string();
    const std::string group = "/histories/" + name.substr(0, name.size() - kHistoryEnding.size());
    const NumberCsv table = ReadHistory(file);
    output.Group(group.c_str());
    std::vector<double> values(table.rows.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      for (std::size_t row = 0; row < values.size(); ++row) values[row] = table.rows[row][i];
      WriteColumn(output, group + "/" + table.columns[i], HistoryUnit(table.columns[i]), values);
    }
  }
}

}  // namespace

void ExportHdf5(const ResultFolder& folder, const std::filesystem::path& file,
                const std::string& incomplete) {
  H5dont_atexit();  // after a full disk the library's last rites end the process with SIGSEGV
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what goes wrong is thrown, not printed
  const std::vector<std::size_t>& in_rows = folder.inputs().positions();
  CaseOutcomes outcomes;
  const CaseColumns cases = ReadColumns(folder, {in_rows.begin(), in_rows.end()},
                                        [&](const CaseResult& result) { outcomes.Add(result); });

  const std::filesystem::path temporary = file.string() + ".tmp";
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  try {
    {
      Hdf5File output(temporary);
      WriteProvenance(output, folder, incomplete);
      WriteCases(output, cases.index, outcomes);
      WriteInputs(output, folder, cases);
      WriteMetrics(output, folder, cases);
      WriteHistories(output, folder);
      output.Close();
    }
    std::filesystem::rename(temporary, file);
  } catch (const std::system_error& error) {
    std::filesystem::remove(temporary, ignored);
    FailFile(file.string(), "cannot be written", error.code().value());
  } catch (...) {
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace dispersa
