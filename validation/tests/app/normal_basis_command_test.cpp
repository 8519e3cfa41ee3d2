// normal-basis through the executable.
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class NormalBasisCommand : public CommandTest {};

TEST_F(NormalBasisCommand, GivesThePublishedEnergies) {
  const auto four = nlohmann::json::parse(succeed({"normal-basis", "--terms", "4", "--json", "-"}));
  EXPECT_NEAR(four["energy_uniform"].get<double>(), 0.939, 0.002);
  EXPECT_NEAR(four["energy_cosine"].get<double>(), 0.964, 0.002);
  const auto six = nlohmann::json::parse(succeed({"normal-basis", "--terms", "6", "--json", "-"}));
  EXPECT_NEAR(six["energy_uniform"].get<double>(), 0.987, 0.002);
  EXPECT_NEAR(six["energy_cosine"].get<double>(), 0.993, 0.002);
  EXPECT_NE(succeed({"normal-basis", "--terms", "4"}).find("93.9"), std::string::npos);
}

TEST_F(NormalBasisCommand, RefusesTermsThatThereAreNot) {
  expect_refused({"normal-basis"}, {"--terms is required"});
  expect_refused({"normal-basis", "--terms", "0"}, {"--terms", "1 to 9", "0"});
  expect_refused({"normal-basis", "--terms", "10"}, {"--terms", "1 to 9", "10"});
  expect_refused({"normal-basis", "--terms", "four"}, {"--terms"});
}

}  // namespace
}  // namespace plumbline::app
