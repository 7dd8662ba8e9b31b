// learn-schemas FILE: writes the source of LearnedSchemaText (learned_text.h), with what it has learned from the
// readers.
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "services/schema/schema_json.h"

namespace dispersa {
namespace {

void WriteSource(const char* file) {
  std::ofstream out(file);
  out << "// Written by learn-schemas.\n#include <cstddef>\n\n#include \"services/schema/learned_text.h\"\n\n"
         "namespace dispersa {\n\nconst std::string& LearnedSchemaText(FileKind kind) {\n"
         "  static const std::string texts[] = {\n";
  for (const FileKind kind : kFileKinds)
    out << "      R\"schema(" << SchemaJson(kind).dump(1) << "\n)schema\",\n";
  out << "  };\n  return texts[static_cast<std::size_t>(kind)];\n}\n\n}  // namespace dispersa\n";
  out.close();
  if (!out) throw std::runtime_error(std::string(file) + " cannot be written");
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: learn-schemas FILE");
    dispersa::WriteSource(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
