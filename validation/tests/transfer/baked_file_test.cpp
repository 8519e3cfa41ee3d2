#include "prt/transfer/baked_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "prt/transfer/bake.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/load.hpp"

namespace plumbline::transfer {
namespace {

std::filesystem::path file(const char* name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

Baked small_bake() {
  BakeSettings settings;
  settings.bands = 3;
  settings.samples = 64;
  Baked baked{scene::make_builtin_scene("corner"), {}};
  baked.transfer = bake(baked.scene, settings);
  return baked;
}

std::string message_of(const std::filesystem::path& path) {
  try {
    (void)load_baked(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_one_line_naming(const std::filesystem::path& path) {
  const std::string message = message_of(path);
  EXPECT_NE(message.find(path.filename().string()), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(BakedFile, ComesBackAsItWas) {
  const Baked baked = small_bake();
  save_baked(file("corner.prt.glb"), baked);
  const Baked back = load_baked(file("corner.prt.glb"));
  EXPECT_EQ(back.transfer.coefficients, baked.transfer.coefficients);
  EXPECT_EQ(back.transfer.standard_errors, baked.transfer.standard_errors);
  EXPECT_EQ(back.transfer.bands, 3);
  EXPECT_EQ(back.transfer.kind, Kind::shadowed);
  EXPECT_EQ(back.transfer.samples, baked.transfer.samples);
  EXPECT_EQ(back.scene.positions, baked.scene.positions);
  EXPECT_EQ(back.scene.triangles.size(), baked.scene.triangles.size());
  EXPECT_EQ(back.scene.cameras.size(), baked.scene.cameras.size());
}

TEST(BakedFile, KeepsTermsAndHowTheyCameAbout) {
  BakeSettings settings;
  settings.bands = 2;
  settings.samples = 64;
  settings.kind = Kind::interreflected;
  settings.method = {Solver::iterative, Sampling::cosine, DirectionSets::shared};
  settings.kept_terms = 3;
  Baked baked{scene::make_builtin_scene("corner"), {}};
  baked.transfer = bake(baked.scene, settings);
  ASSERT_EQ(baked.transfer.terms.size(), 3U);
  save_baked(file("terms.prt.glb"), baked);
  const Transfer back = load_baked(file("terms.prt.glb")).transfer;
  EXPECT_EQ(back.terms, baked.transfer.terms);
  EXPECT_EQ(back.coefficients, baked.transfer.coefficients);
  EXPECT_EQ(back.bounces, kAllBounces);
  EXPECT_EQ(back.remainder, baked.transfer.remainder);
  EXPECT_EQ(back.method.solver, Solver::iterative);
  EXPECT_EQ(back.method.sampling, Sampling::cosine);
  EXPECT_EQ(back.method.directions, DirectionSets::shared);
  // Damage.
  const std::string whole = read_file(file("terms.prt.glb"));
  const auto path = file("wrong_terms.prt.glb");
  for (const auto& [from, to] :
       {std::pair("\"terms\":3", "\"terms\":4"), std::pair("\"terms\":3", "\"terms\":0"),
        std::pair("\"terms\":3", "\"terms\":-"), std::pair("\"terms\":3", "\"terms\":9"),
        std::pair("\"solver\":\"iterative\"", "\"solver\":\"itexative\"")}) {
    std::string changed = whole;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, std::string(from).size(), to);
    write_text_atomically(path, changed);
    expect_one_line_naming(path);
  }
  baked.transfer.terms[1].coefficients.pop_back();
  EXPECT_THROW(save_baked(path, baked), InputError);
}

TEST(BakedFile, IsAPlainSceneToOthers) {
  save_baked(file("corner2.prt.glb"), small_bake());
  EXPECT_EQ(scene::load_scene(file("corner2.prt.glb").string()).triangles.size(), 4U);
}

TEST(BakedFile, RefusesDamage) {
  const auto path = file("damaged.prt.glb");
  save_baked(path, small_bake());
  const std::string whole = read_file(path);
  for (const std::size_t size : {std::size_t{0}, std::size_t{4}, std::size_t{11}, std::size_t{40},
                                 whole.size() / 2, whole.size() - 8}) {
    write_text_atomically(path, whole.substr(0, size));
    expect_one_line_naming(path);
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = whole;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    write_text_atomically(path, changed);
    expect_one_line_naming(path);
  };
  with("\"bands\":3", "\"bands\":4");
  with("\"bands\":3", "\"bands\":0");
  with("\"version\":1", "\"version\":7");
  with("\"channels\":1", "\"channels\":9");
  with("\"transfer\":\"shadowed\"", "\"transfer\":\"shadowes\"");
  with("\"compression\":\"none\"", "\"compression\":\"nine\"");
  with("Condon-Shortley", "Condon-Shortlez");
}

TEST(BakedFile, RefusesASceneWithoutTransfer) {
  const auto path = file("none.prt.glb");
  EXPECT_NE(message_of(path).find("no such file"), std::string::npos) << message_of(path);
}

TEST(BakedFile, RefusesShapesThatDisagree) {
  Baked baked = small_bake();
  baked.transfer.coefficients.pop_back();
  EXPECT_THROW(save_baked(file("short.prt.glb"), baked), InputError);
  baked = small_bake();
  baked.transfer.coefficients[3] = NAN;
  EXPECT_THROW(save_baked(file("nan.prt.glb"), baked), InputError);
  EXPECT_FALSE(std::filesystem::exists(file("nan.prt.glb")));
}

}  // namespace
}  // namespace plumbline::transfer
