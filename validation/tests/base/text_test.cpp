#include "reference/base/text.hpp"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Text, OneLineHasNoBreaksAndAnEnd) {
  EXPECT_EQ(one_line("a\r\n\tb \x1B[1m\n"), "a b [1m");
  EXPECT_EQ(one_line(""), "");
  EXPECT_EQ(one_line("12345", 5), "12345");
  EXPECT_EQ(one_line("123456", 5), "12345...");
}

TEST(Text, ReplacesEveryOccurrence) {
  EXPECT_EQ(replaced("ababc", "ab", "x"), "xxc");
  EXPECT_EQ(replaced("aaa", "aa", "a"), "aa");
  EXPECT_EQ(replaced("abc", "d", "x"), "abc");
}

TEST(Text, SplitKeepsEmptyWords) {
  using Words = std::vector<std::string_view>;
  EXPECT_EQ(split("a,b", ','), (Words{"a", "b"}));
  EXPECT_EQ(split(",a,,", ','), (Words{"", "a", "", ""}));
  EXPECT_EQ(split("", ','), (Words{""}));
}

TEST(Text, ExtensionsAreInLowerCase) {
  EXPECT_EQ(lower_case_extension("a.b/c.PRT.GLB"), ".glb");
  EXPECT_EQ(lower_case_extension("a.b/c"), "");
}

}  // namespace
}  // namespace plumbline
