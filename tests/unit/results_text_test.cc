#include "core/results/text.h"

#include "core/results/metric_catalogue.h"
#include "core/results/requirement_text.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::results_text_test {

TEST(ReadableText, HasFiveDigitsAndNoNoise) {
  EXPECT_EQ(ReadableText(7612.6), "7612.6");
  EXPECT_EQ(ReadableText(7612.5512), "7612.6");
  EXPECT_EQ(ReadableText(81234.567), "81235");
  EXPECT_EQ(ReadableText(1234567.0), "1234567");
  EXPECT_EQ(ReadableText(0.0123456), "0.012346");
  EXPECT_EQ(ReadableText(-0.5), "-0.5");
  EXPECT_EQ(ReadableText(100.0), "100");
  EXPECT_EQ(ReadableText(0.0), "0");
  EXPECT_EQ(ReadableText(-0.0), "0");
  EXPECT_EQ(ReadableText(5.5e-6), "5.500e-06");
  EXPECT_EQ(ReadableText(report_test::kNaN), "–");
}

TEST(PercentText, NeverRoundsUpToCertainty) {
  EXPECT_EQ(PercentText(0.9973), "99.73 %");
  EXPECT_EQ(PercentText(0.99865), "99.865 %");
  EXPECT_EQ(PercentText(0.9), "90 %");
  EXPECT_EQ(PercentText(1.0), "100 %");
  EXPECT_EQ(PercentText(0.999999), "99.9999 %");
  EXPECT_EQ(PercentText(4996.0 / 5000.0), "99.92 %");
}

TEST(RoundedText, HasThreeDigitsAndStaysOnItsSide) {
  EXPECT_EQ(RoundedText(0.22491), "0.225");
  EXPECT_EQ(RoundedText(0.20004), "0.2");
  EXPECT_EQ(RoundedText(96879.7), "96900");
  EXPECT_EQ(RoundedText(-6979.7), "-6980");
  EXPECT_EQ(RoundedText(999.6), "1000");
  EXPECT_EQ(RoundedText(0.0), "0");
  EXPECT_EQ(RoundedText(0.22401, Rounding::kUp), "0.225");
  EXPECT_EQ(RoundedText(0.22499, Rounding::kDown), "0.224");
  EXPECT_EQ(RoundedText(0.225, Rounding::kUp), "0.225") << "what is round already stays";
  EXPECT_EQ(RoundedText(0.49961, Rounding::kUp, 0.5), "0.49961");
  EXPECT_EQ(RoundedText(0.50004, Rounding::kDown, 0.5), "0.50004") << "on the limit is not inside";
  EXPECT_EQ(RoundedText(1.2345e-7), "1.23e-07");
  EXPECT_EQ(RoundedText(report_test::kNaN), "–");
}

TEST(RoundedText, TellsAValueFromTheLimitBesideIt) {
  struct Case {
    double value;
    Rounding rounding;
    double limit;
    const char* text;
  };
  const Case cases[] = {{295.494, Rounding::kDown, 295.0, "295.49"},
                        {294.506, Rounding::kUp, 295.0, "294.51"},
                        {-295.494, Rounding::kUp, -295.0, "-295.49"},
                        {295.494, Rounding::kNearest, 0.0, "295"},
                        {300.0, Rounding::kDown, 295.0, "300"},
                        {295.0004, Rounding::kDown, 295.0, "295.0004"},
                        {295.494, Rounding::kUp, 295.494, "295.494"},
                        {0.225, Rounding::kUp, 0.5, "0.225"},
                        {1234567.0, Rounding::kDown, 1234560.0, "1234567"},
                        {0.0, Rounding::kUp, 0.001, "0"}};
  for (const Case& one : cases) EXPECT_EQ(RoundedText(one.value, one.rounding, one.limit), one.text);
}

TEST(StatedText, HasAllDigitsThatSomebodyStates) {
  EXPECT_EQ(StatedText(295.0), "295");
  EXPECT_EQ(StatedText(-295.4941), "-295.4941");
  EXPECT_EQ(StatedText(0.1), "0.1");
  EXPECT_EQ(StatedText(0.0), "0");
  EXPECT_EQ(StatedText(100000.0), "100000");
  EXPECT_EQ(StatedText(3.0e-7), "3e-07");
  EXPECT_EQ(StatedText(report_test::kNaN), "–");
}

TEST(ScatterText, HasTwoDigitsOfTheDeviation) {
  EXPECT_EQ(ScatterText(499.8712, 0.123), "499.87");
  EXPECT_EQ(ScatterText(0.030145, 0.0045), "0.0301");
  EXPECT_EQ(ScatterText(96883.3, 2345.0), "96900");
  EXPECT_EQ(ScatterText(-0.0004, 1.0), "0");
  EXPECT_EQ(ScatterText(60.96, 0.0), "60.96");
}

TEST(ShareText, HasThreeDigitsAndShowsWhatIsMissingTo100) {
  EXPECT_EQ(ShareText(0.25877), "25.9 %");
  EXPECT_EQ(ShareText(0.066961), "6.7 %");
  EXPECT_EQ(ShareText(0.99541, Rounding::kDown), "99.54 %");
  EXPECT_EQ(ShareText(0.99953959, Rounding::kDown), "99.95 %");
  EXPECT_EQ(ShareText(0.9999541, Rounding::kDown), "99.995 %");
  EXPECT_EQ(ShareText(0.557489, Rounding::kUp), "55.8 %");
  EXPECT_EQ(ShareText(1e-9), "< 0.001 %");
  EXPECT_EQ(ShareText(0.0), "0 %");
  EXPECT_EQ(ShareText(1.0), "100 %");
  EXPECT_EQ(ShareText(0.999999), "99.9999 %");
  // 852 flights without a failure just show 99.73 %: not 99.72 %, and not less than is required.
  EXPECT_EQ(ShareText(std::pow(0.1, 1.0 / 852), Rounding::kDown, 0.9973), "99.7301 %");
  EXPECT_EQ(ShareText(0.997352, Rounding::kDown, 0.99735), "99.7352 %");
}

TEST(PValueText, IsNeverZero) {
  EXPECT_EQ(PValueText(0.0), "< 1e-15");
  EXPECT_EQ(PValueText(3.14e-6), "3.1e-06");
  EXPECT_EQ(PValueText(0.0009766), "0.000977");
  EXPECT_EQ(PValueText(1.0), "1");
}

// What was required once is known by its line alone.
TEST(RequirementLine, CanBeReadBack) {
  const Requirement one{"pitch_error_peak_deg", 0.1, {}, 0.9973, 0.1};
  EXPECT_EQ(LineWords(RequirementLine(one)),
            "pitch_error_peak_deg below 0.1 for 99.73 % of flights at 10 % risk");
  Requirement range = one;
  range.below.reset();
  range.within = {{-1.5, 2.0}};
  range.plan = {PlanKind::kGroupSequential, 4, Spending::kPocock};
  EXPECT_EQ(LineWords(RequirementLine(range)),
            "pitch_error_peak_deg between -1.5 and 2 for 99.73 % of flights at 10 % risk, judged 4 times");
  Requirement own = one;
  own.metric = "tilt_deg";
  own.own_expression = "max(pitch_deg) above 3 below 4";
  own.below.reset();
  own.above = 7.0;
  own.plan.kind = PlanKind::kAnytime;
  EXPECT_EQ(LineWords(RequirementLine(own)),
            "tilt_deg above 7 for 99.73 % of flights at 10 % risk, judged at any time");
  Requirement every = one;
  every.every_case = true;
  EXPECT_EQ(LineWords(RequirementLine(every)), "pitch_error_peak_deg below 0.1 in every case");
  for (const Requirement& requirement : {one, range, own, every}) {
    const std::optional<Requirement> read = RequirementOfLine(RequirementLine(requirement));
    ASSERT_TRUE(read);
    EXPECT_EQ(RequirementLine(*read), RequirementLine(requirement));
  }
  EXPECT_EQ(LineWords("no requirement"), "no requirement");
}

TEST(HtmlText, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(HtmlText("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
}

TEST(MetricCatalogue, ReadsUnitsFromNames) {
  EXPECT_EQ(SplitUnit("wind_max_speed_m_s").unit, "m/s");
  EXPECT_EQ(SplitUnit("wind_max_speed_m_s").stem, "wind_max_speed");
  EXPECT_EQ(SplitUnit("bending_moment_max_n_m").unit, "N m") << "not metres";
  EXPECT_EQ(SplitUnit("adaptation_norm_peak_deg_s2").unit, "°/s²");
  EXPECT_EQ(SplitUnit("q_alpha_max_pa_rad").unit, "Pa rad");
  EXPECT_EQ(SplitUnit("thrust_factor_stage1").unit, "");
}

TEST(MetricCatalogue, KnowsEveryMetricOfTheEngine) {
  for (const std::string& name : MetricNames()) {
    const MetricInfo info = DescribeMetric(name);
    EXPECT_TRUE(info.known) << name;
    EXPECT_FALSE(info.title.empty()) << name;
  }
}

TEST(MetricCatalogue, NamesThePhase) {
  EXPECT_EQ(DescribeMetric("pitch_error_rms_stage2_deg").title, "Pitch error, RMS, stage 2");
  EXPECT_EQ(DescribeMetric("pitch_error_peak_coast_deg").title, "Pitch error, peak, coast");
  EXPECT_EQ(DescribeMetric("pitch_error_peak_time_stage3_s").unit, "s");
}

TEST(MetricCatalogue, DescribesAnUnknownMetricByItsName) {
  const MetricInfo info = DescribeMetric("slosh_angle_max_deg");
  EXPECT_EQ(info.title, "Slosh angle max");
  EXPECT_EQ(info.unit, "°");
  EXPECT_FALSE(info.known);
}

TEST(MetricCatalogue, RanksByWhatIsWorse) {
  EXPECT_GT(Badness(Worse::kLarger, 2.0), Badness(Worse::kLarger, 1.0));
  EXPECT_GT(Badness(Worse::kSmaller, 1.0), Badness(Worse::kSmaller, 2.0));
  EXPECT_GT(Badness(Worse::kFartherFromZero, -2.0), Badness(Worse::kFartherFromZero, 1.0));
  EXPECT_EQ(DescribeMetric("injection_altitude_km").worse, Worse::kNeither);
}

TEST(FixedText, NeverShowsANegativeZero) {
  EXPECT_EQ(FixedText(-1e-9, 7), "0.0000000");
  EXPECT_EQ(FixedText(-0.0, 2), "0.00");
  EXPECT_EQ(FixedText(-0.004, 3), "-0.004");
  EXPECT_EQ(FixedText(12.345, 1), "12.3");
  EXPECT_EQ(FixedText(std::nan(""), 3), "–");
}

}  // namespace dispersa::results_text_test
