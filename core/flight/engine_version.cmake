# Writes the translation unit that defines EngineVersion().
#
#   cmake -D ROOT=<repository> -D VERSION=<project version> -D OUTPUT=<file> -P engine_version.cmake
#
# The digest is the SHA-256 of one line "<SHA-256 of the file>  <path from ROOT>\n" for each source file,
# sorted by path in byte order: what `sha256sum` prints for them.
include("${CMAKE_CURRENT_LIST_DIR}/engine_sources.cmake")
engine_sources("${ROOT}" sources)
set(manifest "")
foreach(source IN LISTS sources)
  file(SHA256 "${ROOT}/${source}" digest)
  string(APPEND manifest "${digest}  ${source}\n")
endforeach()
string(SHA256 digest "${manifest}")
string(SUBSTRING "${digest}" 0 12 digest)
file(WRITE "${OUTPUT}" "#include \"core/flight/engine_version.h\"

namespace dispersa {

std::string EngineVersion() { return \"${VERSION}+${digest}\"; }

}  // namespace dispersa
")
