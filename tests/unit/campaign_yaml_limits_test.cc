// Texts from any source: however large, nested or damaged, reading ends soon, with a message.
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/input/input_error.h"
#include "tests/fuzz.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_limits_test {
namespace {

// Each of these takes far less than a second on an idle machine; before there were limits, minutes.
constexpr double kSoon_s = 20.0;

std::string MessageOf(const std::string& text) {
  const std::clock_t start = std::clock();  // of the process: what runs beside it does not count
  std::string message = "no error";
  try {
    ParseCampaign(text, "text");
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kSoon_s);
  return message.substr(0, message.find('\n'));
}

TEST(YamlLimits, AMapHasAtMost1000Keys) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  EXPECT_EQ(MessageOf(text), "text:1001:1: the map has too many keys, allowed: up to 1000");
}

TEST(YamlLimits, NestingHasAnEnd) {
  EXPECT_EQ(MessageOf("a: " + std::string(70, '[') + std::string(70, ']')),
            "text:1:67: nested too deeply, allowed: up to 64 levels");
  EXPECT_NE(MessageOf("a: " + std::string(1'000'000, '[')), "no error");
  EXPECT_NE(MessageOf(std::string(1'000'000, '{')), "no error");
}

TEST(YamlLimits, AKeyHasAnEnd) {
  EXPECT_EQ(MessageOf(std::string(201, 'k') + ": 1\n"),
            "text:1:1: the key is too long, allowed: up to 200 bytes");
}

TEST(YamlLimits, AWordOfAnyLengthIsNoChoiceAndNoGuess) {
  const std::string message = MessageOf("schema: " + std::string(5'000'000, 'x') + "\n");
  EXPECT_EQ(message.find("did you mean"), std::string::npos);
  EXPECT_NE(message, "no error");
}

TEST(YamlLimits, ATextHasAtMost64MiB) {
  EXPECT_EQ(MessageOf("a: 1\n" + std::string(64 << 20, '#')),
            "text:1:1: the file is too large, allowed: up to 64 MiB");
}

TEST(YamlLimits, ATextOf20MBEndsSoon) {
  std::string list = "a: [";
  for (int i = 0; i < 3'000'000; ++i) list += "1.5, ";
  EXPECT_NE(MessageOf(list + "2]\n"), "no error");
}

TEST(YamlLimits, DamagedTextsAreRefusedOrRead) {
  const std::string good =
      "schema: dispersa/campaign/1\nname: \"trial\"\nsampling: {method: monte_carlo, cases: 100, seed: 1}\n"
      "requirements:\n  - {metric: pitch_error_peak_deg, below: 0.5, probability: 0.9973, consumer_risk: "
      "0.1}\n";
  const std::string bits = "{}[]:,-#&*!|>'\"%@`\\ \n\t0\xff";
  std::mt19937_64 chance = fuzz::Chance();
  for (std::uint64_t i = 0; i < fuzz::Inputs(); ++i) {
    std::string text = good;
    for (std::uint64_t k = 1 + chance() % 5; k > 0; --k) {
      const std::size_t at = chance() % text.size();
      switch (chance() % 3) {
        case 0:
          text[at] = bits[chance() % bits.size()];
          break;
        case 1:
          text.insert(at, 1, bits[chance() % bits.size()]);
          break;
        default:
          text.erase(at, 1 + chance() % 9);
      }
      if (text.empty()) text = good;
    }
    std::vector<InputProblem> problems;
    ParseYaml(text, "text", problems);
    EXPECT_NE(MessageOf(text), "no error") << "it names no vehicle";
  }
}

}  // namespace
}  // namespace dispersa::campaign_yaml_limits_test
