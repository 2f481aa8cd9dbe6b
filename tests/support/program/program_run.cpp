#include "tests/support/program/program_run.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/program/built_places.h"

namespace octascope::tests {

namespace {

struct Pipe {
  int read_end = -1;
  int write_end = -1;

  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw std::runtime_error{"no pipe to a child"};
    read_end = ends[0];
    write_end = ends[1];
  }
};

// Until the last writer is gone; owns the descriptor.
std::jthread read_all(int descriptor, std::string& text) {
  return std::jthread{[descriptor, &text] {
    std::array<char, 4096> piece{};
    for (ssize_t n = 1; n > 0;) {
      n = read(descriptor, piece.data(), piece.size());
      if (n > 0)
        text.append(piece.data(), static_cast<std::size_t>(n));
    }
    close(descriptor);
  }};
}

// False when it still runs after `most`.
bool ends_within(pid_t child, WallClock::duration most) {
  const auto descriptor = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  pollfd ended{descriptor, POLLIN, 0};
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(most).count();
  const bool in_time = poll(&ended, 1, static_cast<int>(ms)) == 1;
  close(descriptor);
  return in_time;
}

} // namespace

std::string ProgramResult::describe() const {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(took).count();
  std::string text = timed_out ? "killed" : "exit " + std::to_string(exit_status);
  if (signal != 0)
    text += ", signal " + std::to_string(signal);
  return text + " after " + std::to_string(ms) + " ms\nstdout: " + out + "\nstderr: " + err;
}

ProgramRun::ProgramRun(std::vector<std::string> words) : started_(WallClock::now()) {
  const Pipe out;
  const Pipe err;
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.write_end, STDERR_FILENO);
  const int error =
      posix_spawnp(&child_, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(out.write_end);
  close(err.write_end);
  read_out_ = read_all(out.read_end, out_);
  read_err_ = read_all(err.read_end, err_);
  if (error != 0) {
    child_ = -1;
    throw std::runtime_error{words.front() + ": " + std::strerror(error)};
  }
}

ProgramRun::~ProgramRun() {
  if (child_ <= 0)
    return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

bool ProgramRun::running() const {
  return child_ > 0 && !ends_within(child_, {});
}

bool ProgramRun::wait_for_thread(const std::string& name, WallClock::duration most) const {
  const std::filesystem::path tasks = "/proc/" + std::to_string(child_) + "/task";
  for (const auto end = WallClock::now() + most; running() && WallClock::now() < end;) {
    std::error_code error; // a thread may end while we look
    for (std::filesystem::directory_iterator it{tasks, error}, last; !error && it != last;
         it.increment(error)) {
      std::ifstream in{it->path() / "comm"};
      std::string found;
      if (std::getline(in, found) && found == name)
        return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return false;
}

void ProgramRun::send_signal(int number) const {
  kill(child_, number);
}

ProgramResult ProgramRun::wait(WallClock::duration most) {
  ProgramResult result;
  result.timed_out = !ends_within(child_, most);
  if (result.timed_out)
    kill(child_, SIGKILL);
  int status = 0;
  waitpid(child_, &status, 0);
  child_ = -1;
  result.took = WallClock::now() - started_;
  if (WIFEXITED(status))
    result.exit_status = WEXITSTATUS(status);
  if (WIFSIGNALED(status))
    result.signal = WTERMSIG(status);
  read_out_.join();
  read_err_.join();
  result.out = std::move(out_);
  result.err = std::move(err_);
  return result;
}

ProgramResult run_program(std::vector<std::string> words, WallClock::duration most) {
  return ProgramRun{std::move(words)}.wait(most);
}

std::vector<std::string> octascope_command(std::vector<std::string> arguments) {
  std::vector<std::string> words{built_program()};
  for (std::string& argument : arguments)
    words.push_back(std::move(argument));
  return words;
}

ProgramResult run_octascope(std::vector<std::string> arguments, WallClock::duration most) {
  return run_program(octascope_command(std::move(arguments)), most);
}

bool program_exists(const std::string& name) {
  return run_program({"sh", "-c", "command -v " + name}).exit_status == 0;
}

} // namespace octascope::tests
