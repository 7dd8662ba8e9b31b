// One change of the valid files, and the message of `validate` about it.
#pragma once

#include <ostream>
#include <string>

#include "core/campaign_yaml/load.h"
#include "tests/unit/input_files.h"

namespace dispersa {

struct BadInput {
  const char* name;
  const char* edited;
  const char* from;
  const char* to;
  const char* texts;  ///< in full
};

inline void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

inline std::string TextsAbout(const char* validated, const BadInput& bad) {
  const InputFiles files;
  files.Edit(bad.edited, bad.from, bad.to);
  return files.Texts(CheckFile(files.Path(validated)).errors);
}

}  // namespace dispersa
