#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "prt/compress/quantise.hpp"
#include "prt/transfer/bake.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"

namespace plumbline::transfer {
namespace {

std::filesystem::path file(const char* name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

Baked compressed_bake(compress::Method method, std::vector<int> bits, int clusters = 5) {
  BakeSettings settings;
  settings.bands = 3;
  settings.samples = 64;
  settings.is_skipping = false;  // a convex body has a closed form, and no noise
  Baked baked{scene::make_builtin_scene("convex"), {}};
  baked.transfer = bake(baked.scene, settings);
  compress::CompressSettings how;
  how.method = method;
  how.clusters.clusters = clusters;
  how.clusters.components = 3;
  how.bits = std::move(bits);
  baked.compressed = compress::compress(baked.transfer, how);
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

void expect_refused(const std::filesystem::path& path, const std::string& what) {
  const std::string message = message_of(path);
  EXPECT_NE(message.find(path.filename().string()), std::string::npos) << what << ": " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(CompressedFile, ComesBackAsItWas) {
  const auto path = file("compressed.prt.glb");
  for (const compress::Method method :
       {compress::Method::vq, compress::Method::pca, compress::Method::cpca}) {
    for (const std::vector<int>& bits : {std::vector<int>{4}, {8}, {16}, {32}, {32, 8, 4}}) {
      const Baked baked = compressed_bake(method, bits);
      save_baked(path, baked);
      const Baked back = load_baked(path);
      ASSERT_TRUE(back.compressed.has_value());
      const compress::Compressed& is = *back.compressed;
      const compress::Compressed& was = *baked.compressed;
      EXPECT_EQ(is.method, method);
      EXPECT_EQ(is.is_iterative, was.is_iterative);
      EXPECT_EQ(is.means, was.means);
      EXPECT_EQ(is.axes, was.axes);
      EXPECT_EQ(is.labels, was.labels);
      EXPECT_EQ(is.codes, was.codes);
      EXPECT_EQ(is.relative_error, was.relative_error);
      EXPECT_EQ(is.bake_relative_error, was.bake_relative_error);
      EXPECT_GT(is.bake_relative_error, 0.0);
      EXPECT_EQ(back.transfer.coefficients, compress::decode(was));
      EXPECT_TRUE(back.transfer.standard_errors.empty());
      EXPECT_EQ(back.transfer.samples, baked.transfer.samples);
    }
  }
}

TEST(CompressedFile, ManyClustersTakeTwoBytesALabel) {
  Baked baked = compressed_bake(compress::Method::vq, {8}, 60);
  compress::Compressed& compressed = *baked.compressed;
  compressed.clusters = 300;
  compressed.means.resize(300 * compressed.dimension, 0.5F);
  compressed.labels[7] = 299;
  save_baked(file("labels.prt.glb"), baked);
  EXPECT_EQ(load_baked(file("labels.prt.glb")).compressed->labels, compressed.labels);
}

TEST(CompressedFile, RefusesHostileNumbers) {
  const auto path = file("hostile.prt.glb");
  save_baked(path, compressed_bake(compress::Method::cpca, {8}));
  const std::string whole = read_file(path);
  ASSERT_EQ(message_of(path), "");
  const std::pair<const char*, const char*> changes[] = {
      {"\"clusters\":5", "\"clusters\":0"},
      {"\"clusters\":5", "\"clusters\":6"},
      {"\"clusters\":5", "\"clusters\":\""},
      {"\"components\":3", "\"components\":2"},
      {"\"bits\":[8,8,8]", "\"bits\":[8,8,4]"},
      {"\"bits\":[8,8,8]", "\"bits\":[8,8,7]"},
      {"\"bits\":[8,8,8]", "\"bits\":{\"8\":8}"},
      {"\"compression\":\"cpca\"", "\"compression\":\"cpcb\""},
      {"\"compression\":\"cpca\"", "\"compression\":\"none\""},
      {"\"compression\":\"cpca\"", "\"compression\":[1,2]"},
      {"\"clustering\":\"iterative\"", "\"clustering\":\"iterativf\""},
      {"\"vertices\":60", "\"vertices\":61"},
      {"\"bands\":3", "\"bands\":4"},
      {"\"bands\":3", "\"bands\":9"}};
  for (const auto& [from, to] : changes) {
    std::string changed = whole;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::string padded = to;  // JSON may hold blanks: the chunk keeps its size
    padded.resize(std::max(padded.size(), std::string(from).size()), ' ');
    ASSERT_EQ(padded.size(), std::string(from).size()) << to;
    changed.replace(at, padded.size(), padded);
    write_text_atomically(path, changed);
    expect_refused(path, to);
  }
}

TEST(CompressedFile, RefusesLabelsAndNumbersThatCannotBe) {
  Baked baked = compressed_bake(compress::Method::cpca, {8});
  const auto path = file("label.prt.glb");
  save_baked(path, baked);
  // The first mean's first float lies where the buffer view begins: find it and write a NaN; then a label out of range.
  std::string bytes = read_file(path);
  const std::string mean(reinterpret_cast<const char*>(baked.compressed->means.data()), 8 * sizeof(float));
  const std::size_t begin = bytes.find(mean);
  ASSERT_NE(begin, std::string::npos);
  std::string bad = bytes;
  bad.replace(begin, 4, std::string("\x00\x00\xC0\x7F", 4));
  write_text_atomically(path, bad);
  expect_refused(path, "NaN");
  const std::size_t labels =
      begin + sizeof(float) * (baked.compressed->means.size() + baked.compressed->axes.size());
  bad = bytes;
  bad[labels + 3] = 5;
  write_text_atomically(path, bad);
  expect_refused(path, "label");
}

TEST(CompressedFile, RefusesToWriteShapesThatDisagree) {
  Baked baked = compressed_bake(compress::Method::cpca, {8});
  baked.compressed->labels[0] = 200;
  EXPECT_THROW(save_baked(file("bad.prt.glb"), baked), InputError);
  baked = compressed_bake(compress::Method::cpca, {8});
  baked.compressed->dimension = 3;
  EXPECT_THROW(save_baked(file("bad.prt.glb"), baked), InputError);
  EXPECT_FALSE(std::filesystem::exists(file("bad.prt.glb")));
}

}  // namespace
}  // namespace plumbline::transfer
