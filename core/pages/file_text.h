// A file of a result folder in one piece.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace dispersa {

/// Empty: it cannot be read. Character by character took longer than the flights of a small campaign.
inline std::string TextOfFile(const std::filesystem::path& file) {
  std::ostringstream text;
  if (const std::ifstream stream(file, std::ios::binary); stream) text << stream.rdbuf();
  return std::move(text).str();
}

}  // namespace dispersa
