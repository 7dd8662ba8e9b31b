// Result folders of a coordinator. The page is kept compressed, as histories are everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dispersa {

/// Compresses the page of a campaign that has its report: it becomes report.html.gz. A killed process leaves
/// both or one of them. Throws ResultError; then the rest stays as it was.
void PackReports(const std::filesystem::path& results);

/// Removes what a report has written, packed or not: cases.csv, summary.json, report.html, histories/. The
/// results stay. Throws ResultError.
void RemoveReports(const std::filesystem::path& results);

/// Files of a result folder that a client may have, by path within it. The page is listed as report.html.
std::vector<std::filesystem::path> FilesIn(const std::filesystem::path& results);
/// The same files as they lie on the disk.
std::vector<std::filesystem::path> StoredFilesIn(const std::filesystem::path& results);

/// The size of a file's text, packed or not, by the file's path. Throws ResultError.
std::uint64_t SizeOf(const std::filesystem::path& file);
/// At most `most` bytes of its text from `offset`, empty at its end. Throws ResultError.
std::string ReadPart(const std::filesystem::path& file, std::uint64_t offset, std::size_t most);

}  // namespace dispersa
