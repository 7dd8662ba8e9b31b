// Damaged files: a YAML file or a stored database with any content. The answer is the content, or an error
// that names the damage. It is never a wrong number. tests/fuzz.h: the number of each kind, and their seed.
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/fingerprint.h"
#include "core/results/result_folder.h"
#include "tests/every_metric.h"
#include "tests/fuzz.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::hostile_files_test {
namespace {

namespace fs = std::filesystem;

using fuzz::Inputs;

void Write(const fs::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(text.data(), static_cast<std::streamsize>(text.size()));
}

class HostileFiles : public testing::Test {
 protected:
  std::size_t Below(std::size_t n) { return chance_() % n; }

  /// Two to eight changes of the kind that an editor, a merge or an attacker makes.
  std::string DamagedText(std::string text) {
    static const std::vector<std::string> tokens = [] {
      std::vector<std::string> all = Words(
          R"({ } [ ] , *a " ' # ... ? 1e999 -1e999 .nan -.inf 0x7f null true ~ -0 1e-320 -1 99999999999999999999)");
      for (const char* other : {": ", "- ", "&a ", "<<: *a", "!!binary ", "\n", "\t", "  ", "|\n", ">\n",
                                "---\n", "\xff", "\xc0\x80"})
        all.emplace_back(other);
      all.emplace_back(1, '\0');
      return all;
    }();
    for (std::size_t changes = 2 + Below(7); changes > 0 && !text.empty(); --changes) {
      const std::size_t at = Below(text.size());
      const std::size_t length = std::min(text.size() - at, 1 + Below(40));
      switch (Below(6)) {
        case 0:
          text[at] = static_cast<char>(chance_());
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(Below(text.size()), text.substr(at, length));
          break;
        case 3: {  // a number or word becomes another one
          const std::size_t end = text.find_first_of(" ,]}\n", at);
          text.replace(at, std::min(end, text.size()) - at, tokens[Below(tokens.size())]);
          break;
        }
        default:
          text.insert(at, tokens[Below(tokens.size())]);
      }
    }
    return text;
  }

  /// Loads damaged copies of a file; each is what it is or an InputError.
  void Fuzz(const std::string& original, std::uint64_t inputs,
            const std::function<void(const std::string& path)>& load) {
    const std::string text = TextOfFile(original);
    const std::string path =
        (fs::path(original).parent_path() == fs::path(DISPERSA_CAMPAIGNS) ? root_ / "campaign.yaml"
                                                                          : root_ / "file.yaml")
            .string();
    std::uint64_t taken = 0;
    for (std::uint64_t i = 0; i < inputs; ++i) {
      const std::string damaged = DamagedText(text);
      Write(path, damaged);
      try {
        load(path);
        ++taken;
      } catch (const InputError&) {
      } catch (const std::exception& error) {
        Write("hostile.yaml", damaged);
        FAIL() << original << ", input " << i << " (hostile.yaml): " << error.what();
      }
    }
    RecordProperty(fs::path(original).filename().string(), static_cast<int>(taken));
  }

  /// In memory: very many files are written.
  const TemporaryFolder root_{fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()};
  std::mt19937_64 chance_ = fuzz::Chance();
};

TEST_F(HostileFiles, AutopilotsAreReadOrRefused) {
  for (const char* name : {"adaptive_fuzzy", "pid", "pd_aac"}) {
    Fuzz(std::string(DISPERSA_CAMPAIGNS "/autopilots/") + name + ".yaml", Inputs() / 5,
         [](const std::string& path) { LoadAutopilot(path); });
  }
}

TEST_F(HostileFiles, ScenariosAreReadOrRefused) {
  Fuzz(DISPERSA_CAMPAIGNS "/scenarios/nesc_case03.yaml", Inputs() / 5,
       [](const std::string& path) { LoadScenario(path); });
}

TEST_F(HostileFiles, VehiclesAreReadOrRefused) {
  Fuzz(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml", Inputs() / 5,
       [](const std::string& path) { LoadVehicle(path); });
}

// Far fewer: each is read with its vehicle, reference and autopilot.
TEST_F(HostileFiles, CampaignsAreReadOrRefused) {
  for (const char* folder : {"vehicles", "references", "autopilots", "winds"}) {
    if (fs::exists(fs::path(DISPERSA_CAMPAIGNS) / folder))
      fs::create_symlink(fs::path(DISPERSA_CAMPAIGNS) / folder, root_ / folder);
  }
  Fuzz(DISPERSA_CAMPAIGNS "/table3.yaml", Inputs() / 50, [](const std::string& path) { LoadCampaign(path); });
  const std::string canonical = LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml").canonical_yaml;
  for (std::uint64_t i = 0; i < Inputs() / 100; ++i) {
    const std::string damaged = DamagedText(canonical);
    try {
      ParseCampaign(damaged, "canonical");
    } catch (const InputError&) {
    }
  }
}

// A row that is read has the bits that were stored.
TEST_F(HostileFiles, NoWrongNumberComesOutOfADamagedDatabase) {
  Campaign campaign;
  campaign.vehicle.limits.axial_load_g = 1e9;  // with one, every metric is stored
  campaign.name = "made up";
  campaign.id = std::string(64, '1');
  campaign.flight_id = std::string(64, '2');
  campaign.canonical_yaml = "name: made up\n";
  campaign.sampling.cases = 8;
  MeasureEverything(campaign);
  std::map<std::uint64_t, Digest> stored;
  {
    ResultFolder folder = ResultFolder::Create(root_ / "out", campaign);
    for (std::uint64_t i = 0; i < 4; ++i) {
      CaseResult result;
      result.case_index = i;
      result.outcome = Outcome::kCompleted;
      result.reason = "a reason";
      ApplyNominal(result);
      for (std::size_t k = 0; k < MetricCount(kUsualStages); ++k)
        result.metrics.push_back(1.0 / static_cast<double>(k + i + 1));
      result.digest = {i, 5};
      folder.Append({{result}});
      stored[i] = Fingerprint(result);
    }
    folder.Store({}, {{{0, "w", "h", "", 1.0}}});
  }
  const fs::path database = root_ / "out/results.sqlite";
  const std::string good = TextOfFile(database);
  std::uint64_t rows = 0, refused = 0;
  for (std::uint64_t i = 0; i < Inputs() / 10; ++i) {
    std::string bytes = good;
    for (std::size_t changes = 1 + Below(4); changes > 0; --changes) {
      const std::size_t at = Below(Below(3) == 0 ? std::min<std::size_t>(bytes.size(), 200)
                                                 : bytes.size());  // the header more often
      switch (Below(4)) {
        case 0:
          bytes[at] = static_cast<char>(chance_());
          break;
        case 1:
          std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                      std::min<std::size_t>(bytes.size() - at, Below(600)),
                      static_cast<char>(Below(2) == 0 ? 0 : 0xff));
          break;
        case 2:
          std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(at / 2),
                           bytes.begin() + static_cast<std::ptrdiff_t>(at / 2 + Below(bytes.size() - at) / 2),
                           bytes.begin() + static_cast<std::ptrdiff_t>(at / 2 + (bytes.size() - at) / 2));
          break;
        default:
          if (Below(8) == 0) bytes.resize(std::max<std::size_t>(at, 1));
      }
    }
    Write(database, bytes);
    try {
      const ResultFolder folder =
          Below(2) == 0 ? ResultFolder::Open(root_ / "out") : ResultFolder::Resume(root_ / "out", campaign);
      folder.PastLooks();
      folder.QuarantinedCases();
      folder.ForEachUnaudited([](const Claim&) {});
      folder.ForEach([&](const CaseResult& result) {
        ++rows;
        ASSERT_TRUE(stored.contains(result.case_index));
        ASSERT_EQ(Fingerprint(result), stored.at(result.case_index)) << "input " << i;
      });
    } catch (const InputError&) {
      ++refused;
    } catch (const ResultError&) {
      ++refused;
    }
    ASSERT_FALSE(HasFatalFailure());
    for (const char* beside : {"out/results.sqlite-wal", "out/results.sqlite-shm"})
      fs::remove(root_ / beside);
  }
  EXPECT_GT(rows, Inputs() / 50) << "most damage leaves rows";
  EXPECT_GT(refused, Inputs() / 500);
}

}  // namespace
}  // namespace dispersa::hostile_files_test
