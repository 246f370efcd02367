#include "gate/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "io/file_bytes.h"

namespace rangepose::gate {
namespace {

std::string lastLine(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return oneLine(last);
}

std::string nameOf(const std::vector<std::string>& words) {
  const bool command = words.size() > 1 && !words[1].empty() && words[1].front() != '-';
  return command ? words[0] + " " + words[1] : words[0];
}

/// The process, or Error.
pid_t start(const std::vector<std::string>& words, const std::filesystem::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), kFlags, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<std::string> texts = words;
  std::vector<char*> arguments;
  arguments.reserve(texts.size() + 1);
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failure =
      posix_spawn(&child, words.at(0).c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == 0) return child;
  throw Error(fmt::format("{}: cannot be started ({})", words[0], std::strerror(failure)));
}

}  // namespace

void runLogged(const std::vector<std::string>& words, const std::filesystem::path& log) {
  const pid_t child = start(words, log);
  int status = 0;
  while (waitpid(child, &status, 0) != child) {
    if (errno != EINTR) throw Error(nameOf(words) + ": lost the process");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string how = WIFEXITED(status)
                              ? fmt::format("failed with exit code {}", WEXITSTATUS(status))
                              : fmt::format("was ended by signal {}", WTERMSIG(status));
  throw Error(fmt::format("{} {}, see {}: {}", nameOf(words), how, log.string(), lastLine(log)));
}

}  // namespace rangepose::gate
