// Files that cannot be read or written: each is refused in one line that names it and says why, nothing is
// written and nothing is left behind.
#include <sys/stat.h>

#include <cmath>
#include <limits>

#include "reference/image/exr.hpp"
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class BadFiles : public CommandTest {
 protected:
  void expect_scene_refused(const std::string& name, std::string_view bytes,
                            const std::string& reason) const {
    write(name, bytes);
    expect_refused({"render", name, "-o", "out.exr"}, {name, reason});
  }

  void expect_points_refused(std::string_view text, const std::string& reason) const {
    write("points.csv", text);
    expect_refused({"gather", "builtin:corner", "--points", "points.csv", "-o", "out.csv"},
                   {"points.csv", reason});
  }

  void expect_environment_refused(const std::string& name, const std::string& reason) const {
    expect_refused({"project", name, "--bands", "2", "-o", "out.json"}, {name, reason});
  }

  void make_baked() const {
    (void)succeed({"bake", "builtin:convex", "--bands", "2", "--transfer", "unshadowed", "-o", "a.prt.glb"});
  }
};

// ---------------------------------------------------------------- scenes

TEST_F(BadFiles, RefusesScenesThatAreNotThere) {
  expect_refused({"render", "none.obj", "-o", "out.exr"}, {"none.obj", "no such file"});
  expect_refused({"bake", "none.glb", "--bands", "2", "-o", "out.glb"}, {"none.glb", "no such file"});
  expect_refused({"render", "none.xyz", "-o", "out.exr"}, {"none.xyz", "unknown kind of scene"});
}

TEST_F(BadFiles, RefusesMeshesWithoutFaces) {
  expect_scene_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no triangles");
  expect_scene_refused(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n",
      "no triangles");
  expect_scene_refused("a.gltf", R"({"asset": {"version": "2.0"}})", "no triangles");
}

TEST_F(BadFiles, RefusesObjsWithBadNumbers) {
  expect_scene_refused("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite");
  expect_scene_refused("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "4");
  expect_scene_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "area");
}

TEST_F(BadFiles, RefusesBrokenGltfs) {
  expect_scene_refused("json.gltf", "{\"asset\": {\n\"version\": ", "glTF");
  expect_scene_refused("buffer.gltf",
                       R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "missing.bin", "byteLength": 36}],
          "bufferViews": [{"buffer": 0, "byteLength": 36}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
          "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
          "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})",
                       "missing.bin");
}

TEST_F(BadFiles, RefusesATruncatedGlb) {
  make_baked();
  const std::string bytes = read("a.prt.glb");
  fs::remove(path("a.prt.glb"));
  expect_scene_refused("half.glb", bytes.substr(0, bytes.size() / 2), "bytes");
  expect_scene_refused("head.glb", bytes.substr(0, 10), "");
}

// ---------------------------------------------------------------- environments

TEST_F(BadFiles, RefusesEnvironmentsThatAreNotThereOrNoImages) {
  expect_environment_refused("none.exr", "no such file");
  write("text.exr", "this is no image\n");
  expect_environment_refused("text.exr", "cannot read");
  write("light.json", "{\n\"bands\": 2,\n");
  expect_refused({"render", "builtin:corner", "--env", "light.json", "-o", "out.exr"},
                 {"light.json", "JSON"});
}

TEST_F(BadFiles, RefusesATruncatedEnvironment) {
  write_image("whole.exr", 64, 32, 1.0F);
  const std::string bytes = read("whole.exr");
  write("half.exr", bytes.substr(0, bytes.size() / 2));
  expect_environment_refused("half.exr", "cannot read");
  expect_refused({"relight", "none.prt.glb", "--env", "half.exr", "-o", "out.exr"}, {"none.prt.glb"});
}

TEST_F(BadFiles, RefusesEnvironmentsWithBadTexelsOrShape) {
  write_image("nan.exr", 4, 2, std::numeric_limits<float>::quiet_NaN());
  expect_environment_refused("nan.exr", "finite");
  write_image("odd.exr", 5, 3, 1.0F);
  expect_environment_refused("odd.exr", "aspect");
}

// ---------------------------------------------------------------- outputs

TEST_F(BadFiles, RefusesOutputsThatCannotBeWritten) {
  fs::create_directory(path("folder"));
  write("file", "old");
  expect_refused({"render", "builtin:corner", "-o", "none/out.exr"}, {"none/out.exr", "does not exist"});
  expect_refused({"render", "builtin:corner", "-o", "file/out.exr"}, {"file/out.exr", "not a folder"});
  expect_refused({"project", "builtin:white", "--bands", "2", "-o", "folder"}, {"folder", "it is a folder"});
  // Nobody can make a file in /proc, root included.
  expect_refused({"render", "builtin:corner", "-o", "/proc/out.exr"}, {"/proc/out.exr", "cannot write"});
}

TEST_F(BadFiles, RefusesOutputsOfTheWrongKind) {
  expect_refused({"render", "builtin:corner", "-o", "out.png"}, {"-o", "out.png", ".exr"});
  expect_refused({"render", "builtin:corner", "-o", "-"}, {"-o", "standard output"});
  expect_refused({"bake", "builtin:convex", "--bands", "2", "-o", "out.prt"}, {"-o", "out.prt", ".glb"});
}

TEST_F(BadFiles, RefusesTwoOutputsInOnePlace) {
  write("out.csv", "old");
  expect_refused({"gather", "builtin:corner", "--vertices", "-o", "-", "--json", "-"}, {"-o", "--json"});
  expect_refused({"gather", "builtin:corner", "--vertices", "-o", "out.csv", "--json", "./out.csv"},
                 {"-o", "--json", "out.csv"});
}

TEST_F(BadFiles, RefusesASummaryThatCannotBeWrittenBeforeTheWork) {
  expect_refused({"render", "builtin:corner", "-o", "out.exr", "--json", "none/a.json"},
                 {"none/a.json", "does not exist"});
}

TEST_F(BadFiles, LeavesPipesAlone) {
  ASSERT_EQ(::mkfifo(path("pipe.exr").c_str(), S_IRUSR | S_IWUSR), 0);
  expect_refused({"render", "builtin:corner", "-o", "pipe.exr"}, {"pipe.exr", "not a regular file"});
  EXPECT_TRUE(fs::is_fifo(path("pipe.exr")));
}

// ---------------------------------------------------------------- points

TEST_F(BadFiles, RefusesPointsThatAreNotThere) {
  expect_refused({"gather", "builtin:corner", "--points", "none.csv", "-o", "out.csv"},
                 {"none.csv", "no such file"});
  expect_points_refused("", "holds no points");
  expect_points_refused("x,y,z,nx,ny,nz\n", "holds no points");
}

TEST_F(BadFiles, RefusesPointsThatAreNoNumbers) {
  expect_points_refused("x,y,z,nx,ny,nz\n0,0,zero,0,1,0\n", "line 2: column 3: not a number: \"zero\"");
  expect_points_refused("0,0,z,0,1,0\n", "line 1: column 3: not a number");
  expect_points_refused("0,0,0,0,nan,0\n", "line 1: column 5: not finite");
}

TEST_F(BadFiles, RefusesPointsWithoutNormals) {
  expect_points_refused("0,0,0,0,1,0\n0,0,0,0,0,0\n", "line 2: the normal is zero");
  expect_points_refused("0,0,0\n", "line 1: expected x,y,z,nx,ny,nz, got 3 columns");
  expect_points_refused("1e30,0,0,0,1,0\n", "line 1: column 1");
}

// ---------------------------------------------------------------- baked files

TEST_F(BadFiles, RefusesWhatIsNoBakedFile) {
  write("scene.obj", kTriangle);
  write("plain.glb", "glTF");
  expect_refused({"inspect", "none.prt.glb"}, {"none.prt.glb", "no such file"});
  expect_refused({"inspect", "scene.obj"}, {"scene.obj"});
  expect_refused({"relight", "plain.glb", "--env", "builtin:white", "-o", "out.exr"}, {"plain.glb"});
}

TEST_F(BadFiles, RefusesBakedFilesThatLackTheirTransfer) {
  make_baked();
  std::string bytes = read("a.prt.glb");
  write("cut.prt.glb", bytes.substr(0, bytes.size() - 100));
  expect_refused({"relight", "cut.prt.glb", "--env", "builtin:white", "-o", "out.exr"}, {"cut.prt.glb"});
  // The same glb under another extension's name is a plain one. Both names have one length.
  const std::string name = "PLUMBLINE_precomputed_radiance_transfer";
  for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name)) bytes[at] = 'X';
  write("plain.glb", bytes);
  expect_refused({"relight", "plain.glb", "--env", "builtin:white", "-o", "out.exr"},
                 {"plain.glb", "no baked transfer"});
}

TEST_F(BadFiles, RefusesVerticesThatAreNotThere) {
  make_baked();
  expect_refused({"inspect", "a.prt.glb", "--vertices", "60"}, {"--vertices", "a.prt.glb", "0 to 59"});
  expect_refused({"inspect", "a.prt.glb", "--vertices", "0,-1"}, {"--vertices", "a.prt.glb", "-1"});
  expect_refused({"inspect", "a.prt.glb", "--vertices", "0,,1"}, {"--vertices", "a.prt.glb"});
}

TEST_F(BadFiles, RelightWantsSomethingToDo) {
  make_baked();
  expect_refused({"relight", "a.prt.glb", "--env", "builtin:white"}, {"-o", "--vertices"});
  expect_refused({"relight", "a.prt.glb", "-o", "out.exr"}, {"--env is required"});
  expect_refused({"relight", "a.prt.glb", "--env", "builtin:white", "-o", "out.exr", "--camera", "x"},
                 {"--camera", "no camera"});
}

// ---------------------------------------------------------------- images

TEST_F(BadFiles, CompareRefusesImagesThatDoNotFit) {
  write_image("a.exr", 4, 2, 1.0F);
  write_image("b.exr", 2, 4, 1.0F);
  expect_refused({"compare", "a.exr", "b.exr", "--heatmap", "heat.png"}, {"a.exr", "4x2", "b.exr", "2x4"});
  expect_refused({"compare", "a.exr", "none.exr"}, {"none.exr", "no such file"});
}

TEST_F(BadFiles, CompareRefusesWhatIsNoColourImage) {
  write_image("a.exr", 4, 2, 1.0F);
  write("text.png", "no image");
  image::LayeredImage depth{4, 2, {{"depth", std::vector<float>(8, 1.0F)}}, {}};
  image::write_exr(path("depth.exr"), depth);
  expect_refused({"compare", "a.exr", "text.png"}, {"text.png", "cannot read"});
  expect_refused({"compare", "a.exr", "depth.exr"}, {"depth.exr", "no R, G and B"});
  expect_refused({"compare", "a.exr", "a.exr", "--heatmap", "heat.exr"}, {"--heatmap", "heat.exr", ".png"});
}

TEST_F(BadFiles, MergeRefusesWhatIsNotAllShardsOfOneRender) {
  write_image("plain.exr", 4, 2, 1.0F);
  expect_refused({"merge", "plain.exr", "-o", "out.exr"}, {"plain.exr", "not a shard"});
  (void)succeed({"render", "builtin:corner", "--env", "builtin:white", "--spp", "2", "--size", "4x4",
                 "--shard", "0/2", "-o", "part0.exr"});
  expect_refused({"merge", "part0.exr", "-o", "out.exr"}, {"part0.exr", "1/2 is missing"});
}

}  // namespace
}  // namespace plumbline::app
