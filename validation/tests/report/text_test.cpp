#include "validation/report/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumbline::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const std::string kReplacement = "\xEF\xBF\xBD";

TEST(ReportText, CleanTextKeepsValidUtf8) {
  const std::string text = "a ± é 漢 😀\n\tb";
  EXPECT_EQ(clean_text(text), text);
}

TEST(ReportText, CleanTextReplacesControlsAndBrokenUtf8) {
  EXPECT_EQ(clean_text(std::string("a\0b", 3)), "a" + kReplacement + "b");
  EXPECT_EQ(clean_text("\x1B[31m"), kReplacement + "[31m");
  EXPECT_EQ(clean_text("a\xFF"), "a" + kReplacement);
  EXPECT_EQ(clean_text("\xE2\x82"), kReplacement + kReplacement);  // cut short
  EXPECT_EQ(clean_text("\xC0\xAF"), kReplacement + kReplacement);  // overlong '/'
  EXPECT_EQ(clean_text("\xED\xA0\x80"), kReplacement);             // a surrogate
  EXPECT_EQ(clean_text("\xEF\xBF\xBF"), kReplacement);             // U+FFFF
  EXPECT_EQ(clean_text("\xF4\x90\x80\x80"), kReplacement);         // above U+10FFFF
}

TEST(ReportText, EscapesMarkupAndAttributes) {
  EXPECT_EQ(escape_markup("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  EXPECT_EQ(escape_attribute("a\n\tb&"), "a&#10;&#9;b&amp;");
}

TEST(ReportText, Base64HasTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE"), "//4=");
}

TEST(ReportText, NumbersSayWhatTheyAre) {
  EXPECT_EQ(format_number(kNaN), "NaN");
  EXPECT_EQ(format_number(-kInf), "-inf");
  EXPECT_EQ(format_number(0.123456), "0.1235");
}

TEST(ReportText, IntervalsShareTheirLastPlace) {
  EXPECT_EQ(format_interval(2.5104, 0.0123), "2.510 ± 0.012");
  EXPECT_EQ(format_interval(3.14e-7, 4.2e-8), "(3.14 ± 0.42)e-7");
  EXPECT_EQ(format_interval(1.5, 0.0), "1.5");
  EXPECT_EQ(format_interval(1234.0, 56.0), "1234 ± 56");
  EXPECT_EQ(format_interval(0.0, 0.25), "0.00 ± 0.25");
  EXPECT_EQ(format_interval(kNaN, 0.1), "NaN ± 0.1");
  EXPECT_EQ(format_interval(1.0, kInf), "1 ± inf");
}

TEST(ReportText, SecondsTakeTheUnitThatReads) {
  EXPECT_EQ(format_seconds(0.0042), "4.2 ms");
  EXPECT_EQ(format_seconds(3.14159), "3.14 s");
  EXPECT_EQ(format_seconds(600.0), "10 min");
  EXPECT_EQ(format_seconds(kNaN), "NaN");
}

}  // namespace
}  // namespace plumbline::report
