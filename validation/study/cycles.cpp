#include "validation/study/cycles.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "reference/integrate/hemisphere.hpp"
#include "reference/integrate/sampler.hpp"
#include "reference/scene/save_gltf.hpp"
#include "reference/trace/surface_point.hpp"
#include "validation/study/cycles_script.hpp"

namespace plumbline::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kProgram = "blender";
constexpr int kUnlimited = 1024;  // bounces: the most that Cycles takes
constexpr const char* kReply = "plumbline: ";

std::optional<fs::path> find_program() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / kProgram;
    std::error_code ignored;
    if (fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

// ---------------------------------------------------------------- the job

/// Flat meshes go without normals; others with them.
bool has_smooth_normals(const scene::Scene& scene) {
  constexpr float kFlat = 1e-3F;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Vec3 normal = scene::geometric_normal(scene, t);
    for (int k = 0; k < 3; ++k)
      if (glm::length(scene.normals[scene.triangles[t][k]] - normal) > kFlat) return true;
  }
  return false;
}

/// Whether light can meet the back of a single-sided surface: our backs are black, those of Cycles reflect unless its shader asks
/// which side was met, which takes time. A walk from the camera, 64 x 64 rays with up to 8 bounces, says whether asking is needed.
bool shows_backs(const Task& task) {
  constexpr int kSide = 64;
  constexpr int kBounces = 8;
  const scene::Scene& scene = task.world->scene;
  for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
    integrate::Sampler sampler(1, static_cast<std::uint64_t>(pixel), 0, 0);
    trace::Ray ray{task.camera.eye,
                   scene::ray_direction(task.camera, static_cast<float>(pixel % kSide) + 0.5F,
                                        static_cast<float>(pixel / kSide) + 0.5F, kSide, kSide)};
    for (int bounce = 0; bounce <= kBounces; ++bounce) {
      const std::optional<trace::Hit> hit = task.world->caster.closest_hit(ray);
      if (!hit) break;
      const trace::SurfaceHit met = trace::surface_hit(scene, *hit, ray.direction);
      if (!met.is_front && !scene.materials[scene.triangle_materials[hit->triangle]].is_double_sided)
        return true;
      const Vec3 direction =
          integrate::sample_cosine_hemisphere(met.point.geometric_normal, sampler.next_2d());
      ray = {trace::ray_origin(met.point, direction), direction};
    }
  }
  return false;
}

Json to_json(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json job_of(const Task& task, const fs::path& folder) {
  const scene::Camera& camera = task.camera;
  Json job = {{"scene", (folder / "scene.glb").string()},
              {"has_smooth_normals", has_smooth_normals(task.world->scene)},
              {"has_dark_backs", shows_backs(task)},
              {"width", task.width},
              {"height", task.height},
              {"bounces", std::min(task.max_bounces, kUnlimited)},
              {"sky_radiance", to_json(Rgb(0.0F))},
              {"sky_image", ""},
              {"sky_width", 0},
              {"is_bilinear", task.world->environment.lookup == light::Lookup::bilinear},
              {"camera",
               {{"eye", to_json(camera.eye)},
                {"forward", to_json(camera.forward)},
                {"up", to_json(camera.up)},
                {"vertical_fov_rad", camera.vertical_fov_rad}}}};
  if (const auto* constant = std::get_if<light::ConstantSky>(&task.world->environment.sky))
    job["sky_radiance"] = to_json(constant->radiance);
  if (const auto* picture = std::get_if<light::LatLongSky>(&task.world->environment.sky)) {
    job["sky_image"] = (folder / "sky.exr").string();
    job["sky_width"] = picture->image.width;
  }
  return job;
}

// ---------------------------------------------------------------- the process

/// A folder that is gone with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "plumbline-cycles-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw InputError(fmt::format("{}: cannot make a temporary folder", name));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Reply {
  Json values;
  double path_tracing_seconds = 0.0;  // as Cycles itself reported it since the last reply; 0 = it did not
};

/// Cycles' summary has a line "  Path Tracing   <wall seconds>   <average>".
std::optional<double> path_tracing_seconds(const std::string& line) {
  std::istringstream words(line);
  std::string first, second;
  double seconds = 0.0;
  if (words >> first >> second >> seconds && first == "Path" && second == "Tracing") return seconds;
  return std::nullopt;
}

/// Blender, waiting for renders on its standard input.
class Blender {
 public:
  Blender(const std::vector<std::string>& words) {
    int input[2];
    int output[2];
    if (::pipe2(input, O_CLOEXEC) != 0 || ::pipe2(output, O_CLOEXEC) != 0)
      throw InputError("cycles: cannot make a pipe");
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(input[0], STDIN_FILENO);
      ::dup2(output[1], STDOUT_FILENO);
      ::dup2(output[1], STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(input[0]);
    ::close(output[1]);
    to_ = ::fdopen(input[1], "w");
    from_ = ::fdopen(output[0], "r");
    if (child_ < 0) throw InputError("cycles: cannot start a process");
  }
  ~Blender() {
    if (to_ != nullptr) std::fclose(to_);  // the end of its input ends it
    if (from_ != nullptr) std::fclose(from_);
    if (child_ <= 0) return;
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }
  Blender(const Blender&) = delete;
  Blender& operator=(const Blender&) = delete;

  void send(const Json& line) {
    std::fputs((line.dump() + "\n").c_str(), to_);
    std::fflush(to_);
  }

  Reply receive() {
    Reply reply;
    std::string last = "no output";
    char* text = nullptr;
    std::size_t capacity = 0;
    while (::getline(&text, &capacity, from_) > 0) {
      std::string line(text);
      while (!line.empty() && line.back() == '\n') line.pop_back();
      if (const auto seconds = path_tracing_seconds(line)) reply.path_tracing_seconds = *seconds;
      if (line.starts_with(kReply)) {
        reply.values = Json::parse(line.substr(std::string(kReply).size()), nullptr, false);
        break;
      }
      // The last error that Python named, else the last line.
      const bool is_error = line.find("Error: ") != std::string::npos;
      if (is_error ||
          (line.find_first_not_of(' ') != std::string::npos && last.find("Error: ") == std::string::npos))
        last = line;
    }
    std::free(text);
    if (!reply.values.is_object()) throw InputError(fmt::format("cycles: Blender ended too early: {}", last));
    return reply;
  }

 private:
  pid_t child_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

/// A task in a Blender that has loaded it.
class Session {
 public:
  explicit Session(const Task& task) : task_(task), blender_(start(task, folder_.path())) {
    (void)blender_.receive();
  }

  Rendered render(int spp, std::uint64_t seed) {
    const fs::path out = folder_.path() / "image.exr";
    // Cycles' seeds are 31 bits; ours are folded into them.
    blender_.send({{"spp", spp}, {"seed", integrate::mix(seed) >> 33U}, {"out", out.string()}});
    const Reply reply = blender_.receive();
    Rendered result{image::read_image(out), reply.path_tracing_seconds};
    if (!(result.seconds > 0.0)) throw InputError("cycles: Blender did not report its path tracing time");
    if (result.image.width != task_.width || result.image.height != task_.height)
      throw InputError(
          fmt::format("cycles: Blender's image is {}x{}", result.image.width, result.image.height));
    return result;
  }

 private:
  static std::vector<std::string> start(const Task& task, const fs::path& folder) {
    scene::save_glb(task.world->scene, folder / "scene.glb");
    if (const auto* sky = std::get_if<light::LatLongSky>(&task.world->environment.sky)) {
      image::LayeredImage file{sky->image.width, sky->image.height, {}, {}};
      image::set_rgb_layer(file, "", sky->image);
      image::write_exr(folder / "sky.exr", file);
    }
    write_text_atomically(folder / "cycles.py", cycles_script());
    write_text_atomically(folder / "job.json", job_of(task, folder).dump());
    return {find_program().value_or(kProgram),
            "-b",
            "--factory-startup",
            "-noaudio",
            "-t",
            std::to_string(task.threads),
            "--debug-cycles",
            "-P",
            (folder / "cycles.py").string(),
            "--",
            (folder / "job.json").string()};
  }

  Task task_;
  TemporaryFolder folder_;
  Blender blender_;
};

}  // namespace

std::string reason_against_cycles(const Task& task) {
  if (!find_program()) return "no program `blender` on the PATH (Debian package blender)";
  if (!task.world->scene.lights.empty()) return "lights without extent are not translated for Blender";
  return "";
}

Method make_cycles(const Task& task) {
  const auto session = std::make_shared<Session>(task);
  return {"cycles", [session](int spp, std::uint64_t seed) { return session->render(spp, seed); },
          [session](int spp, std::uint64_t seed) {
            const int half = std::max(1, spp / 2);
            return Halved{session->render(half, 2 * seed).image, session->render(half, 2 * seed + 1).image};
          }};
}

}  // namespace plumbline::study
