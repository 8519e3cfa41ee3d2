// project and gather through the executable.
#include <cmath>

#include "reference/base/vector.hpp"
#include "reference/scene/text.hpp"
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class LightCommand : public CommandTest {
 protected:
  void expect_white(const nlohmann::json& json) const {
    EXPECT_EQ(json.size(), 3U);
    EXPECT_EQ(json["bands"], 3);
    EXPECT_TRUE(json["convention"].is_string());
    ASSERT_EQ(json["coefficients"].size(), 9U);
    for (const double value : json["coefficients"][0]) {
      // L_00 = y_00 times 4 pi: closed form in double.
      EXPECT_LE(std::abs(value - std::sqrt(4.0 * kPi)), 1e-14);
    }
    for (std::size_t i = 1; i < 9; ++i) {
      for (const double value : json["coefficients"][i]) EXPECT_LE(std::abs(value), 1e-14) << i;
    }
  }

  // The numbers of a CSV, line by line; expects its first line to be `header`.
  static std::vector<std::vector<double>> parse_csv(const std::string& text, const std::string& header) {
    std::string_view rest = text;
    EXPECT_EQ(scene::next_line(rest), header);
    std::vector<std::vector<double>> rows;
    while (const auto line = scene::next_line(rest)) {
      rows.emplace_back();
      for (const std::string_view cell : split(*line, ',')) {
        const auto number = scene::parse_number(cell);
        EXPECT_TRUE(number.has_value()) << cell;
        rows.back().push_back(number.value_or(std::nan("")));
      }
      EXPECT_EQ(rows.back().size(), 12U);
    }
    return rows;
  }

  static constexpr const char* kHeader = "x,y,z,nx,ny,nz,E_r,E_g,E_b,stderr_r,stderr_g,stderr_b";
};

TEST_F(LightCommand, ProjectsToStandardOutputUnlessAskedOtherwise) {
  const std::string text = succeed({"project", "builtin:white", "--bands", "3"});
  expect_white(nlohmann::json::parse(text));
  EXPECT_EQ(succeed({"project", "builtin:white", "--bands", "3", "-o", "-", "--json", "-"}), text);
  EXPECT_EQ(succeed({"project", "builtin:white", "--bands", "3", "-o", "a.json"}), "");
  EXPECT_EQ(read("a.json"), text);
}

TEST_F(LightCommand, ProjectWindowsAndRotates) {
  const Arguments project = {"project", "builtin:two-lobes", "--bands", "3"};
  const auto plain = nlohmann::json::parse(succeed(project));
  Arguments with_window = project;
  with_window.insert(with_window.end(), {"--window", "hann"});
  const auto windowed = nlohmann::json::parse(succeed(with_window));
  // Hann's factor of degree 1 of 3 bands is (1 + cos(pi / 3)) / 2 = 3/4.
  const double z = plain["coefficients"][2][0];
  EXPECT_LE(std::abs(windowed["coefficients"][2][0].get<double>() - 0.75 * z), 1e-15 * std::abs(z));
  Arguments turned_over = project;
  turned_over.insert(turned_over.end(), {"--rotate-env", "-180,0,0"});
  const auto turned = nlohmann::json::parse(succeed(turned_over));
  // Half a turn about x changes the sign of z; the environment is sampled along directions in float.
  EXPECT_LE(std::abs(turned["coefficients"][2][0].get<double>() + z), 1e-5 * std::abs(z));
}

TEST_F(LightCommand, AutomaticWindowDampsWhatRingsAndLeavesTheRest) {
  const Arguments rings = {"project", "builtin:two-lobes", "--bands", "3"};
  const auto plain = nlohmann::json::parse(succeed(rings));
  Arguments automatic = rings;
  automatic.insert(automatic.end(), {"--window", "auto"});
  const Outcome outcome = run(automatic);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("window: lambda"), std::string::npos) << outcome.err;
  const auto damped = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(damped["coefficients"][0], plain["coefficients"][0]);
  EXPECT_LT(std::abs(damped["coefficients"][2][0].get<double>()),
            std::abs(plain["coefficients"][2][0].get<double>()));
  const Arguments white = {"project", "builtin:white", "--bands", "3"};
  Arguments white_automatic = white;
  white_automatic.insert(white_automatic.end(), {"--window", "auto"});
  EXPECT_EQ(run(white_automatic).out, succeed(white));
}

TEST_F(LightCommand, ProjectedLightIsALight) {
  (void)succeed({"project", "builtin:white", "--bands", "3", "-o", "light.json"});
  write("points.csv", "0,2,0,0,1,0\n");
  const std::string text = succeed({"gather", "builtin:convex", "--env", "light.json", "--points",
                                    "points.csv", "--bounces", "0", "--spp", "256", "-o", "-"});
  const auto rows = parse_csv(text, kHeader);
  ASSERT_EQ(rows.size(), 1U);
  // A sky given as a function is sampled: five standard errors, and those small enough to tell E from E/pi.
  EXPECT_LE(rows[0][9], 0.1);
  EXPECT_LE(std::abs(rows[0][6] - kPi), 5.0 * rows[0][9] + 1e-5);
}

TEST_F(LightCommand, GathersPiUnderAWhiteSky) {
  const std::string text = succeed({"gather", "builtin:convex", "--env", "builtin:white", "--vertices",
                                    "--bounces", "0", "--spp", "64", "-o", "-"});
  const auto rows = parse_csv(text, kHeader);
  EXPECT_EQ(rows.size(), 60U);
  for (const std::vector<double>& row : rows) {
    EXPECT_LE(std::abs(std::hypot(row[3], row[4], row[5]) - 1.0), 1e-6);
    for (std::size_t c = 6; c < 9; ++c) {
      EXPECT_GE(row[c + 3], 0.0);
      EXPECT_LE(row[c + 3], 0.05);
      // Five standard errors, and what nine digits and float radiance round off.
      EXPECT_LE(std::abs(row[c] - kPi), 5.0 * row[c + 3] + 1e-6);
    }
  }
}

TEST_F(LightCommand, GathersAtPointsOfATable) {
  write("points.csv",
        "\xEF\xBB\xBFx,y,z,nx,ny,nz,name\r\n# a comment\r\n\r\n 0, 2.5 "
        ",0,0,1e-30,0,up\r\n0,2,0,3e30,0,0,x\r\n");
  // 3e30 is farther out than any scene may be, also for a normal.
  expect_refused({"gather", "builtin:convex", "--points", "points.csv", "-o", "a.csv"},
                 {"points.csv: line 5"});
  write("points.csv", "\xEF\xBB\xBFx,y,z,nx,ny,nz,name\r\n# a comment\r\n\r\n 0, 2.5 ,0,0,1e-30,0,up\r\n");
  EXPECT_EQ(succeed({"gather", "builtin:convex", "--env", "builtin:white", "--points", "points.csv", "--spp",
                     "16", "-o", "a.csv", "--json", "a.json"}),
            "");
  const auto rows = parse_csv(read("a.csv"), kHeader);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(std::vector<double>(rows[0].begin(), rows[0].begin() + 6),
            (std::vector<double>{0.0, 2.5, 0.0, 0.0, 1.0, 0.0}));
  EXPECT_EQ(read_json("a.json")["points"], 1);
}

TEST_F(LightCommand, WritesIntoDevices) {
  EXPECT_EQ(succeed({"project", "builtin:white", "--bands", "1", "-o", "/dev/null"}), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace plumbline::app
