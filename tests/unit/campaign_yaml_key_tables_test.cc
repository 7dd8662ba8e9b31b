// The tables of keys in core/campaign_yaml/README.md against the descriptions that read the files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>

#include "core/campaign_yaml/describe_file.h"
#include "tests/unit/key_tables.h"

namespace dispersa::campaign_yaml_key_tables_test {
namespace {

constexpr char kReadme[] = DISPERSA_CAMPAIGNS "/../core/campaign_yaml/README.md";
constexpr char kBegin[] = "<!-- keys ", kAfterPath[] = ":begin -->\n", kEnd[] = "<!-- keys:end -->";

// The rows of each kind of file by its name, and of each group by its own.
std::map<std::string, std::vector<KeyRow>> AllRows() {
  std::map<std::string, std::vector<KeyRow>> all;
  for (const FileKind kind : kFileKinds) {
    std::map<std::string, std::vector<KeyRow>> groups;
    KeyRows rows(groups);
    DescribeFile(kind, rows);
    all[NameOf(kind)] = std::move(rows.rows);
    all.merge(groups);
  }
  return all;
}

// "vehicle.stages.motor"
const std::vector<KeyRow>* Find(const std::map<std::string, std::vector<KeyRow>>& all,
                                const std::string& path) {
  std::size_t end = std::min(path.find('.'), path.size());
  const auto kind = all.find(path.substr(0, end));
  const std::vector<KeyRow>* rows = kind == all.end() ? nullptr : &kind->second;
  while (rows != nullptr && end < path.size()) {
    const std::size_t begin = end + 1;
    end = std::min(path.find('.', begin), path.size());
    const auto row = std::find_if(rows->begin(), rows->end(), [&](const KeyRow& one) {
      return one.key == path.substr(begin, end - begin);
    });
    rows = row == rows->end() ? nullptr : &row->inside;
  }
  return rows;
}

struct Block {
  std::string path;
  std::size_t begin, end;  ///< of the table
};

std::vector<Block> Blocks(const std::string& page) {
  std::vector<Block> blocks;
  for (std::size_t at = 0; (at = page.find(kBegin, at)) != std::string::npos;) {
    const std::size_t path = at + sizeof kBegin - 1, after = page.find(kAfterPath, path);
    const std::size_t begin = after + sizeof kAfterPath - 1, end = page.find(kEnd, begin);
    if (after == std::string::npos || end == std::string::npos) break;
    blocks.push_back({page.substr(path, after - path), begin, end});
    at = end;
  }
  return blocks;
}

TEST(KeyTables, SayWhatTheDescriptionsSay) {
  std::ifstream file(kReadme);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const auto all = AllRows();
  const std::vector<Block> blocks = Blocks(page);
  const auto has_table = [&](const std::string& path) {
    return std::any_of(blocks.begin(), blocks.end(), [&](const Block& block) { return block.path == path; });
  };
  for (const auto& [name, rows] : all) EXPECT_TRUE(has_table(name)) << "no table of the keys of a " << name;
  std::string written;
  std::size_t from = 0;
  for (const Block& block : blocks) {
    const std::vector<KeyRow>* rows = Find(all, block.path);
    ASSERT_NE(rows, nullptr) << "the page has a table of " << block.path << ", which is no map of keys";
    written += page.substr(from, block.begin - from) + KeyTable(has_table).Text(*rows, block.path);
    from = block.end;
  }
  written += page.substr(from);
  if (written == page) return;
  if (std::getenv("DISPERSA_REWRITE_TABLES") != nullptr) std::ofstream(kReadme) << written;
  FAIL() << "core/campaign_yaml/README.md does not say what the descriptions of the keys say; this command "
            "rewrites "
            "its tables:\nDISPERSA_REWRITE_TABLES=1 tests/run -R KeyTables";
}

}  // namespace
}  // namespace dispersa::campaign_yaml_key_tables_test
