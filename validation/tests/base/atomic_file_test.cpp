#include "reference/base/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>

#include "reference/base/error.hpp"

namespace fs = std::filesystem;
namespace plumbline {
namespace {

fs::path fresh_folder(const char* name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, AppearsWholeAndAlone) {
  const fs::path folder = fresh_folder("atomic_whole");
  write_text_atomically(folder / "a.txt", "hello");
  EXPECT_EQ(read_file(folder / "a.txt"), "hello");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
  const fs::path folder = fresh_folder("atomic_keeps");
  write_text_atomically(folder / "a.txt", "old");
  const auto failing = [](const fs::path& temporary) {
    write_text_atomically(temporary, "half");
    throw std::runtime_error("disk full");
  };
  EXPECT_THROW(write_atomically(folder / "a.txt", failing), std::runtime_error);
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(AtomicFile, RefusesAMissingFolderAndAFolderAsFile) {
  const fs::path folder = fresh_folder("atomic_refuses");
  EXPECT_THROW(write_text_atomically(folder / "none" / "a.txt", "x"), InputError);
  EXPECT_THROW(write_text_atomically(folder, "x"), InputError);
  EXPECT_THROW((void)read_file(folder / "none.txt"), InputError);
  EXPECT_THROW((void)read_file(folder), InputError);
}

TEST(AtomicFile, RefusesBeforeTheWorkWhatCannotBeWritten) {
  const fs::path folder = fresh_folder("atomic_before");
  EXPECT_NO_THROW(require_writable(folder / "a.txt"));
  EXPECT_THROW(require_writable(""), InputError);
  EXPECT_THROW(require_writable(folder / std::string(300, 'a')), InputError);  // longer than names may be
  EXPECT_THROW(require_writable("/proc/a.txt"), InputError);                   // root may not either
  EXPECT_EQ(entries(folder), 0U);
}

// A rename would put a file where the pipe or, as root, a device is.
TEST(AtomicFile, RefusesPipes) {
  const fs::path pipe = fresh_folder("atomic_pipe") / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_THROW(write_text_atomically(pipe, "x"), InputError);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, ReplacesWhatALinkPointsTo) {
  const fs::path folder = fresh_folder("atomic_link");
  write_text_atomically(folder / "file", "old");
  fs::create_symlink("file", folder / "link");
  write_text_atomically(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "file"), "new");
}

}  // namespace
}  // namespace plumbline
