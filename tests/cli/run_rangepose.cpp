#include "cli/run_rangepose.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace rangepose::test {
namespace {

/// A file without a name, for one of the streams.
class Capture {
 public:
  Capture() {
    std::string name = (std::filesystem::temp_directory_path() / "rangepose_cli_XXXXXX").string();
    file_ = mkostemp(name.data(), O_CLOEXEC);
    if (file_ < 0) throw std::runtime_error("no temporary file");
    unlink(name.c_str());
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  ~Capture() { close(file_); }

  int file() const { return file_; }
  std::string text() const {
    std::string text;
    char buffer[4096];
    lseek(file_, 0, SEEK_SET);
    for (ssize_t count = 0; (count = read(file_, buffer, sizeof buffer)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int file_ = -1;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// `added` first: where a name comes twice, the first one counts.
std::vector<std::string> environmentWith(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;
  for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
  return all;
}

/// Waits for the end of a process; returns what waitpid() says of it.
using Wait = std::function<int(pid_t child)>;

int waitForEnd(pid_t child) {
  int status = 0;
  if (waitpid(child, &status, 0) != child) throw std::runtime_error("lost the process");
  return status;
}

RunResult runAndWait(const std::string& executable,
                     const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder,
                     const std::vector<std::string>& environment,
                     const Wait& wait) {
  const Capture out;
  const Capture err;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.file(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.file(), STDERR_FILENO);
  std::vector<std::string> words = {executable};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environmentWith(environment);
  pid_t child = 0;
  const int failure = posix_spawn(&child,
                                  executable.c_str(),
                                  &actions,
                                  nullptr,
                                  pointers(words).data(),
                                  pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " + executable);
  const int status = wait(child);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, out.text(), err.text()};
}

}  // namespace

RunResult runRangepose(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder,
                       const std::vector<std::string>& environment) {
  return runAndWait(RP_EXECUTABLE, arguments, folder, environment, waitForEnd);
}

RunResult runProgram(const std::string& executable,
                     const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder,
                     const std::vector<std::string>& environment) {
  return runAndWait(executable, arguments, folder, environment, waitForEnd);
}

RunResult runRangeposeUntil(const std::function<bool()>& condition,
                            int signal,
                            const std::vector<std::string>& arguments,
                            const std::filesystem::path& folder) {
  return runAndWait(RP_EXECUTABLE, arguments, folder, {}, [&](pid_t child) {
    int status = 0;
    for (;;) {
      if (waitpid(child, &status, WNOHANG) != 0) return status;
      if (condition()) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, signal);
    return waitForEnd(child);
  });
}

}  // namespace rangepose::test
