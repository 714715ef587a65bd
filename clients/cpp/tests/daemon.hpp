/// A daemon of its own for a test, for as long as it is in scope.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

/// What the test script says by an environment variable.
inline std::string told(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr) throw std::runtime_error(std::string(variable) + " is not set; run clients/cpp/test");
  return value;
}

class Daemon {
 public:
  explicit Daemon(const std::string& configuration = "", const std::string& listen = "127.0.0.1:0") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("clearance-cpp-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const auto file = folder / "clearance.toml";
    std::ofstream(file) << configuration;
    const std::string program = told("CLEARANCE_BIN");
    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const std::string path = file.string();
    const char* arguments[] = {program.c_str(), "serve", "--config", path.c_str(), "--grpc-address", listen.c_str(), "--no-shared-memory", "--no-zenoh", nullptr};
    const int failed = posix_spawn(&process_, program.c_str(), &actions, nullptr, const_cast<char**>(arguments), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    if (failed != 0) throw std::runtime_error(program + " cannot be started");
    std::string line;
    pollfd ready{out[0], POLLIN, 0};
    char byte;
    while (poll(&ready, 1, 60'000) == 1 && read(out[0], &byte, 1) == 1 && byte != '\n') line += byte;
    out_ = out[0];
    const std::string start = "listening grpc ";
    if (line.compare(0, start.size(), start) != 0) {
      end();
      throw std::runtime_error(program + " said " + line);
    }
    // The daemon has read what it needs.
    std::filesystem::remove_all(folder);
    address_ = line.substr(start.size());
  }

  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  ~Daemon() { end(); }

  const std::string& address() const { return address_; }

 private:
  void end() {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    close(out_);
  }

  pid_t process_ = -1;
  int out_ = -1;
  std::string address_;
};
