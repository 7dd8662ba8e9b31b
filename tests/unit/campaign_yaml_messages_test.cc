// What is said about mistakes in input files, in full: each file of tests/data/messages is a table of cases.
//
//     OfSolidsHaveNoMixture: with boosters     a case, and what is done to a copy of tests/data/yaml
//     in campaign.yaml                         the file that is edited
//     - name: trial                            replaced where it stands first; further lines continue it
//     + name: other                            by this
//     write wind.csv                           the lines that follow (+) are a new file
//     check vehicle.yaml                       the file that is checked; `check vehicle.yaml warnings`
//     = vehicle.yaml:4:1: ...                  all that is said, a line each; `none` where it is nothing
//     ~ is out of range                        a part of what is said
//     ! is out of range                        no part of it
//
// What stands before a file's first case is done in each. A case with a small letter is for others, by
// `with`.
#include "core/campaign_yaml/load.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_messages_test {
namespace {

using Lines = std::vector<std::string>;

struct Case {
  std::string name;
  Lines lines;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

void Append(const Lines& from, Lines& to) { to.insert(to.end(), from.begin(), from.end()); }

void AddCases(const std::filesystem::path& path, std::vector<Case>& cases) {
  std::map<std::string, Lines> shared;
  std::ifstream file(path);
  std::string line, name;
  Lines* lines = &shared["first"];
  const auto add = [&](const std::string& done) {
    if (done.starts_with("with "))
      Append(shared.at(done.substr(5)), *lines);
    else
      lines->push_back(done);
  };
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (std::isalpha(line[0]) == 0 || colon == std::string::npos || line.find(' ') < colon) {
      add(line);
      continue;
    }
    name = line.substr(0, colon);
    if (std::islower(name[0]) != 0) {
      lines = &shared[name];
    } else {
      cases.push_back({path.stem().string() + "_" + name, shared.at("first")});
      lines = &cases.back().lines;
    }
    if (line.size() > colon + 2) add(line.substr(colon + 2));
  }
}

std::vector<Case> AllCases() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(DISPERSA_TEST_DATA "/messages"))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Case> cases;
  for (const auto& path : paths) AddCases(path, cases);
  return cases;
}

/// The lines from `at` on that begin with the mark, joined; \xNN is a byte.
std::string Block(char mark, const Lines& lines, std::size_t& at) {
  std::string text;
  for (; at < lines.size() && lines[at][0] == mark; ++at)
    text += (lines[at].size() > 2 ? lines[at].substr(2) : "") + "\n";
  for (std::size_t byte = 0; (byte = text.find("\\x", byte)) != std::string::npos; ++byte)
    text.replace(byte, 4, 1, static_cast<char>(std::stoi(text.substr(byte + 2, 2), nullptr, 16)));
  return text;
}
std::string WithoutLastLineEnd(std::string text) { return text.substr(0, text.size() - !text.empty()); }

class InputMessages : public testing::TestWithParam<Case> {};

TEST_P(InputMessages, AreSaidInFull) {
  const InputFiles files;
  const Lines& lines = GetParam().lines;
  std::string edited, checked, topic;
  const auto said = [&] {
    const FileCheck check = CheckFile(files.Path(checked));
    return files.Texts(topic == "warnings" ? check.warnings : check.errors);
  };
  int judged = 0;
  for (std::size_t at = 0; at < lines.size();) {
    const std::string& line = lines[at];
    if (line[0] == '-') {
      const std::string from = WithoutLastLineEnd(Block('-', lines, at));
      files.Edit(edited, from, WithoutLastLineEnd(Block('+', lines, at)));
    } else if (line[0] == '=') {
      EXPECT_EQ(said(), Block('=', lines, at));
      ++judged;
    } else if (line[0] == '~') {
      EXPECT_THAT(said(), testing::HasSubstr(WithoutLastLineEnd(Block('~', lines, at))));
      ++judged;
    } else if (line[0] == '!') {
      EXPECT_THAT(said(), Not(testing::HasSubstr(WithoutLastLineEnd(Block('!', lines, at)))));
      ++judged;
    } else {
      std::istringstream words(line);
      std::string word, file;
      words >> word >> file;
      ++at;
      if (word == "in") {
        edited = file;
      } else if (word == "write") {
        files.Write(file, Block('+', lines, at));
      } else if (word == "check") {
        checked = file;
        topic.clear();
        words >> topic;
      } else {
        ASSERT_EQ(line, "none");
        EXPECT_EQ(said(), "");
        ++judged;
      }
    }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(judged, 0);
}

INSTANTIATE_TEST_SUITE_P(Each, InputMessages, testing::ValuesIn(AllCases()),
                         [](const auto& one) { return one.param.name; });

TEST(LoadingCampaigns, CampaignToOptimizeCannotBeFlownYet) {
  const InputFiles files;
  const std::string reference = TextOfFile(files.Path("reference.yaml"));
  const std::size_t begin = reference.find("  target:");
  const std::string problem = reference.substr(begin, reference.find("flight_program:") - begin);
  files.Edit("campaign.yaml", "reference: reference.yaml\n", "optimize:\n" + problem);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  EXPECT_EQ(LoadOptimization(files.Path("campaign.yaml"), 7).problem.seed, 7u);
  try {
    LoadCampaign(files.Path("campaign.yaml"));
    FAIL() << "loaded";
  } catch (const InputError& error) {
    EXPECT_EQ(
        files.Texts(error.problems()),
        "campaign.yaml:5:3: optimize: the campaign has no trajectory to fly yet, allowed: run `dispersa "
        "optimize "
        "campaign.yaml -o REFERENCE.yaml`, then write `reference: REFERENCE.yaml` in place of `optimize:`\n");
  }
}

TEST(LoadingCampaigns, TextWithoutFilesNamesNone) {
  const InputFiles files;
  try {
    ParseCampaign(TextOfFile(files.Path("campaign.yaml")), "assignment");
    FAIL() << "loaded";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "assignment:3:10: vehicle: the file 'vehicle.yaml' is named in a text without files, allowed: its "
        "contents in its place\n"
        "assignment:4:12: reference: the file 'reference.yaml' is named in a text without files, allowed: "
        "its "
        "contents in its place\n"
        "assignment:5:12: autopilot: the file 'autopilot.yaml' is named in a text without files, allowed: "
        "its "
        "contents in its place");
  }
}

}  // namespace
}  // namespace dispersa::campaign_yaml_messages_test
