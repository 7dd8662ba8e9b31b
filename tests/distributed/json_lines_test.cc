// The log of a daemon as JSON, in a child process that ends with it.
#include "services/log/json_lines.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "services/log/log.h"
#include "tests/test.h"

namespace dispersa::json_lines_test {

using Json = nlohmann::ordered_json;

// What a daemon writes to standard error. It is forked before this process has threads.
std::vector<std::string> LinesOf(const std::function<void()>& work) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    LogForDaemon("dispersa-test");
    LogAsJson();
    work();
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char part[1000];
  for (ssize_t n; (n = read(ends[0], part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(JsonLines, ALineIsAnObject) {
  const auto lines = LinesOf([] {
    LogInfo("{} cases", 5);
    LogWarning("slow");
    LogError("lost");
    TellText("faulty\n");
  });
  ASSERT_EQ(lines.size(), 4u);
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"info", "5 cases"}, {"warning", "slow"}, {"error", "lost"}, {"error", "faulty"}};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Json line = Json::parse(lines[i]);
    EXPECT_THAT(line.at("time").get<std::string>(),
                testing::MatchesRegex("20[0-9]{2}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3}Z"));
    EXPECT_EQ(line.at("level"), expected[i].first);
    EXPECT_EQ(line.at("program"), "dispersa-test");
    EXPECT_EQ(line.at("message"), expected[i].second);
    EXPECT_EQ(line.size(), 4u);
  }
}

TEST(JsonLines, ALineNamesItsCampaignAndRequest) {
  const auto lines = LinesOf([] {
    const LogAbout request("", "cancel 3 of ann");
    {
      const LogAbout campaign("5f3a");
      LogInfo("both");
      std::thread([] { LogInfo("of another thread"); }).join();
    }
    LogInfo("one");
  });
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_THAT(lines[0], EndsWith(R"("message":"both","campaign":"5f3a","request":"cancel 3 of ann"})"));
  EXPECT_THAT(lines[1], EndsWith(R"("message":"of another thread"})"));
  EXPECT_THAT(lines[2], EndsWith(R"("message":"one","request":"cancel 3 of ann"})"));
}

TEST(JsonLines, ForeignTextIsEscaped) {
  const auto lines = LinesOf([] {
    LogInfo("{}", "a\n\x1b[31m\"\\\x7f\u00e9\xff");
    const LogAbout about("\r\n{}", "\x1b");
    LogInfo("b");
  });
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], HasSubstr(R"("message":"a\n\u001b[31m\"\\\u007f\u00e9\ufffd"})"));
  EXPECT_THAT(lines[1], EndsWith(R"("campaign":"\r\n{}","request":"\u001b"})"));
}

TEST(JsonLines, WhatForeignCodePrintsBecomesLines) {
  const auto lines = LinesOf([] {
    const int pipe = OpenLoggedPipe();
    const std::string text = "a\x1b\nb\n" + std::string(4096, 'x') + "y\n";
    if (write(pipe, text.data(), text.size()) < 0) _exit(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  });
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[0], EndsWith(R"("message":"a control law prints: a\u001b"})"));
  EXPECT_THAT(lines[1], EndsWith(R"("message":"a control law prints: b"})"));
  EXPECT_THAT(lines[2], EndsWith("xxx\"}")) << "a part";
  EXPECT_THAT(lines[3], EndsWith(R"("message":"a control law prints: y"})"));
}

}  // namespace dispersa::json_lines_test
