#include "core/results/text.h"

#include <gtest/gtest.h>

#include "core/results/metric_catalogue.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::results_text_test {
namespace {

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

}  // namespace
}  // namespace dispersa::results_text_test
