#include "validation/conformance/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "reference/base/error.hpp"

namespace plumbline::conformance {
namespace {

using Clock = std::chrono::steady_clock;

// The text's length goes before it, so that a child that leaves in the middle is noticed.
constexpr std::size_t kHeader = sizeof(std::uint64_t);

void limit(int resource, rlim_t value) {
  const rlimit limits{value, value};
  (void)::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

void write_all(int file, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(file, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, int pipe) {
  constexpr rlim_t kMemory = rlim_t{8} << 30U;
  limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__  // whose shadow memory needs terabytes of addresses
  limit(RLIMIT_AS, kMemory);
#endif
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS, SIGPIPE}) ::signal(number, SIG_DFL);
  // A library that calls exit(): before the destructors of a process whose threads were not forked.
  ::on_exit([](int status, void*) { ::_exit(status); }, nullptr);
  const std::string text = work();
  const std::uint64_t length = text.size();
  char header[kHeader];
  std::memcpy(header, &length, kHeader);
  write_all(pipe, header, kHeader);
  write_all(pipe, text.data(), text.size());
  ::_exit(0);
}

/// Everything the child sends until it ends; false when the time is up first.
bool read_until(int pipe, Clock::time_point end, std::string& received) {
  char buffer[65536];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd wanted{pipe, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(std::min<long long>(left, 1000)));
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    const ssize_t count = ::read(pipe, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    received.append(buffer, static_cast<std::size_t>(count));
  }
}

std::string fate_of(int status, bool is_late, double seconds) {
  if (is_late) return fmt::format("hangs: no answer within {:g} s", seconds);
  if (WIFSIGNALED(status)) {
    const char* name = ::sigabbrev_np(WTERMSIG(status));
    return fmt::format("crashes (SIG{})", name != nullptr ? name : "?");
  }
  return fmt::format("ends the process with exit code {}", WEXITSTATUS(status));
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& work, double seconds) {
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0)
    throw DeviceError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  const pid_t child = ::fork();
  if (child < 0) throw DeviceError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) {
    ::close(pipe[0]);
    ::setpgid(0, 0);
    be_the_child(work, pipe[1]);
  }
  ::close(pipe[1]);
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::string received;
  const bool is_late = !read_until(pipe[0], end, received);
  ::close(pipe[0]);
  ::kill(-child, SIGKILL);  // and what it may have started
  ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::uint64_t length = 0;
  if (received.size() >= kHeader) std::memcpy(&length, received.data(), kHeader);
  ChildResult result;
  result.is_complete = !is_late && received.size() >= kHeader && received.size() - kHeader == length;
  if (result.is_complete) {
    result.text = received.substr(kHeader);
  } else {
    result.fate = fate_of(status, is_late, seconds);
  }
  return result;
}

}  // namespace plumbline::conformance
