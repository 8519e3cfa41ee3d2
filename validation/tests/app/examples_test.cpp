// The scripts of ci/examples give the bits of the single run.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "validation/tests/app/processes.hpp"

namespace plumbline::test {
namespace {

using Words = std::vector<std::string>;

const std::string kCommand = "PLUMBLINE=" PLUMBLINE_COMMAND;
const Words kSettings = {"--size", "40x24", "--spp", "4", "--seed", "7"};

std::string example(const std::string& name) {
  return (std::filesystem::path(PLUMBLINE_DATA).parent_path() / "ci" / "examples" / name).string();
}

Words operator+(Words left, const Words& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

std::string single_run(const ScratchFolder& logs, const ScratchFolder& folder) {
  const Finished single = run(
      logs, Words{PLUMBLINE_COMMAND, "render", "builtin:cornell", "-o", folder / "single.exr"} + kSettings);
  EXPECT_EQ(single.code, 0) << single.err;
  return read_file(folder / "single.exr");
}

TEST(Examples, RenderParallelGivesTheSingleRunsBytes) {
  const ScratchFolder logs("examples-logs");
  const ScratchFolder folder("examples with spaces");
  const std::string whole = single_run(logs, folder);
  const Words xargs = {"env", kCommand, "LAUNCHER=xargs", "JOBS=2", "bash", example("render-parallel.sh")};
  for (const char* shards : {"1", "3"}) {
    const Finished merged =
        run(logs, xargs + Words{"builtin:cornell", shards, folder / "merged.exr"} + kSettings);
    ASSERT_EQ(merged.code, 0) << merged.err;
    EXPECT_TRUE(read_file(folder / "merged.exr") == whole) << shards << " shards";
  }
  const Finished other = run(logs, xargs + Words{"builtin:cornell", "1", folder / "other.exr"} + kSettings +
                                       Words{"--bounces", "0"});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_FALSE(read_file(folder / "other.exr") == whole) << "the comparison cannot fail";
}

TEST(Examples, RenderParallelFailsWhenAShardFails) {
  const ScratchFolder logs("examples-logs");
  const ScratchFolder folder("examples");
  const Words script = {"env", kCommand, "LAUNCHER=xargs", "bash", example("render-parallel.sh")};
  const Finished unknown = run(logs, script + Words{"builtin:nowhere", "2", folder / "merged.exr"});
  EXPECT_NE(unknown.code, 0);
  EXPECT_NE(unknown.err.find("builtin:nowhere"), std::string::npos) << unknown.err;
  EXPECT_EQ(run(logs, script + Words{"builtin:cornell", "none", folder / "merged.exr"}).code, 2);
  EXPECT_EQ(run(logs, script + Words{"builtin:cornell"}).code, 2);
  EXPECT_TRUE(folder.names().empty());
}

// Slurm itself is not needed: its tasks are told apart by one variable.
TEST(Examples, SlurmScriptsGiveTheSingleRunsBytes) {
  const ScratchFolder logs("examples-logs");
  const ScratchFolder folder("examples");
  const std::string whole = single_run(logs, folder);
  const Words merge = {
      "env", kCommand, "bash", example("slurm-merge.sbatch"), folder / "parts", folder / "merged.exr"};
  for (const std::string task : {"1", "0"}) {
    const Finished part =
        run(logs, Words{"env", kCommand, "SLURM_ARRAY_TASK_ID=" + task, "SLURM_CPUS_PER_TASK=2", "bash",
                        example("slurm-array.sbatch"), "builtin:cornell", "2", folder / "parts"} +
                      kSettings);
    ASSERT_EQ(part.code, 0) << part.err;
    EXPECT_EQ(run(logs, merge).code, task == "0" ? 0 : 2) << "after task " << task;
  }
  EXPECT_TRUE(read_file(folder / "merged.exr") == whole);
}

}  // namespace
}  // namespace plumbline::test
