#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/input/field_reader.h"

namespace dispersa {

void DescribeReferenceFile(Fields& fields, Reference& reference) {
  fields.Schema(kReferenceSchema);
  Describe(fields, reference);
}

Reference DecodeReference(const InputNode& node, const std::string& path,
                          std::vector<InputProblem>& problems) {
  Reference reference;
  if (!CheckSchema(node, kReferenceSchema, !path.empty(), path, problems)) return reference;
  ReadFields(node, path, problems, [&](Fields& fields) { DescribeReferenceFile(fields, reference); });
  return reference;
}

}  // namespace dispersa
