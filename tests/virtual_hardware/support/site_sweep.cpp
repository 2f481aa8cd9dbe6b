#include "tests/virtual_hardware/support/site_sweep.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/linux/system/file_descriptor.h"
#include "tests/virtual_hardware/support/call_site.h"

namespace octascope::tests {

namespace {

// A fault that hangs is told by that; it has another try that may take longer, as the machine may
// be busy. Where it is known to hang, no more than a moment is waited.
constexpr unsigned longest_fault_s = 10, longest_second_try_s = 60, longest_known_s = 3;

// What a process tells of one fault, in memory that the test has, too.
struct Note {
  bool begun = false, ended = false, reached = false, left = false;
  std::array<char, 1024> wrong{};
  std::array<char, 4096> stack{}; // of where it died

  template <std::size_t Size>
  static void write(std::array<char, Size>& to, const std::string& text) {
    text.copy(to.data(), Size - 1);
  }
  bool is_good() const { return ended && reached && !left && wrong[0] == 0; }
};

struct Target {
  const SeenSite& seen;
  int error;
};

Note* note_of_this_shot = nullptr; // for the handler, which has no place for a context

// The functions on the stack are asked for in a process that is broken: should that hang, an alarm
// ends it.
void tell_death(int signal) {
  constexpr unsigned longest_s = 5;
  std::signal(SIGALRM, SIG_DFL);
  ::alarm(longest_s);
  constexpr std::size_t told_callers = 24;
  Note::write(note_of_this_shot->stack, CallStack::from(nullptr, nullptr).names(told_callers));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void hear_deaths() {
  static std::array<std::byte, 65536> other_stack; // that of the broken thread may be full
  stack_t stack{};
  stack.ss_sp = other_stack.data();
  stack.ss_size = other_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = tell_death;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGALRM})
    ::sigaction(signal, &action, nullptr);
}

void shoot(const SweepPlan& plan, const Target& target, Note& note, unsigned limit_s) {
  note_of_this_shot = &note;
  ::alarm(limit_s);
  note.begun = true;
  const Holdings before = Holdings::now();
  std::optional<std::string> wrong;
  {
    const SyscallFaultInjector injector{plan.kinds,
                                        SyscallFault{0, target.error, target.seen.site}};
    wrong = injector.run(plan.scenario);
    note.reached = injector.has_hit();
  }
  note.left = !(Holdings::now() == before);
  if (!wrong && plan.afterwards && (note.left || !note.reached))
    if (wrong = plan.afterwards(); wrong)
      wrong = "afterwards: " + *wrong;
  if (wrong)
    Note::write(note.wrong, *wrong);
  note.ended = true;
}

// One process: from `first` on until a fault does not end well. `words` takes what it says.
void shoot_on(const SweepPlan& plan, std::span<const Target> targets, std::span<Note> notes,
              unsigned limit_s, int words) {
  ::dup2(words, STDERR_FILENO);
  hear_deaths();
  if (plan.begin && !plan.begin())
    return;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const bool is_repeated = i == 0 && limit_s != longest_fault_s;
    const bool may_hang = std::ranges::any_of(plan.known, [&](const KnownDeath& death) {
      return targets[i].seen.name.find(death.site) != std::string::npos;
    });
    shoot(plan, targets[i], notes[i],
          is_repeated ? limit_s
          : may_hang  ? longest_known_s
                      : longest_fault_s);
    if (!notes[i].is_good())
      break;
  }
}

int status_of(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) == -1 && errno == EINTR) {
  }
  return status;
}

// The end of what it said.
std::string last_words(int words) {
  std::array<char, 400> text{};
  const off_t size = ::lseek(words, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t count = ::pread(words, text.data(), text.size(), from);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
}

const KnownDeath* known_death(std::span<const KnownDeath> known, const Target& target,
                              const Note& note) {
  const std::string_view stack = note.stack.data();
  const auto found = std::ranges::find_if(known, [&](const KnownDeath& death) {
    return target.seen.name.find(death.site) != std::string::npos &&
           stack.find(death.stack) != std::string_view::npos &&
           stack.empty() == death.stack.empty();
  });
  return note.ended || found == known.end() ? nullptr : &*found;
}

std::string name_of(const Target& target) {
  return fmt::format("{} with {}", target.seen.name,
                     target.error != 0 ? std::strerror(target.error) : "half of it");
}

void judge(const Target& target, const Note& note, int status, int words, SweepReport& report) {
  ++report.faults;
  report.missed += note.ended && !note.reached ? 1 : 0;
  report.left_behind += note.left ? 1 : 0;
  if (!note.ended)
    report.complaints.push_back(
        fmt::format("{}\n    {}: {}; it said: {}", name_of(target),
                    WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "it ended",
                    note.stack.data(), last_words(words)));
  else if (note.wrong[0] != 0)
    report.complaints.push_back(name_of(target) + "\n    " + note.wrong.data());
}

// Memory for `count` notes that children write to.
class Notes {
public:
  explicit Notes(std::size_t count)
      : bytes_{count * sizeof(Note)}, memory_{::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                                                     MAP_SHARED | MAP_ANONYMOUS, -1, 0)} {
    if (memory_ != MAP_FAILED)
      notes_ = {new (memory_) Note[count], count};
  }
  Notes(const Notes&) = delete;
  Notes& operator=(const Notes&) = delete;
  ~Notes() {
    if (memory_ != MAP_FAILED)
      ::munmap(memory_, bytes_);
  }
  std::span<Note> all() const { return notes_; } // empty: there is no memory

private:
  std::size_t bytes_;
  void* memory_;
  std::span<Note> notes_;
};

// The faults of one sweep, process after process.
class Shooting {
public:
  Shooting(const SweepPlan& plan, std::vector<Target> targets, SweepReport& report)
      : plan_{plan}, targets_{std::move(targets)}, report_{report}, shared_{targets_.size()},
        words_{::memfd_create("words", MFD_CLOEXEC)} {}

  void run() {
    if (shared_.all().empty() || !words_) {
      report_.complaints.emplace_back("the test: no memory to share with its children");
      return;
    }
    while (next_ < targets_.size()) {
      const std::size_t first = next_;
      const int status = run_process(std::exchange(limit_s_, longest_fault_s));
      while (next_ < targets_.size() && note().begun)
        if (!take(next_ == first, status))
          break;
      if (next_ == first && limit_s_ == longest_fault_s) {
        report_.complaints.emplace_back("the test: a child could not be made");
        return;
      }
    }
  }

private:
  Note& note() { return shared_.all()[next_]; }

  int run_process(unsigned limit_s) {
    const pid_t child = ::fork();
    if (child == 0) {
      shoot_on(plan_, std::span{targets_}.subspan(next_), shared_.all().subspan(next_), limit_s,
               words_.get());
      ::_exit(0);
    }
    ++report_.processes;
    limit_now_s_ = limit_s;
    return status_of(child);
  }

  // What became of the next fault; false: it is to be repeated, in a new process.
  bool take(bool was_first, int status) {
    // Those before it may be the reason.
    const bool was_missed = note().ended && !note().reached && note().wrong[0] == 0;
    const KnownDeath* const known = known_death(plan_.known, targets_[next_], note());
    const bool hung = !note().ended && WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM &&
                      known == nullptr && limit_now_s_ < longest_second_try_s;
    if ((was_missed && !was_first) || hung) {
      if (hung)
        limit_s_ = longest_second_try_s;
      note() = {};
      return false;
    }
    if (known == nullptr) {
      judge(targets_[next_++], note(), status, words_.get(), report_);
      return true;
    }
    ++report_.faults;
    report_.known.push_back(fmt::format("{}: {}", name_of(targets_[next_]), known->reason));
    const CallSite site = targets_[next_++].seen.site;
    for (; next_ < targets_.size() && targets_[next_].seen.site == site; ++next_)
      ++report_.spared;
    return true;
  }

  const SweepPlan& plan_;
  const std::vector<Target> targets_;
  SweepReport& report_;
  Notes shared_;
  hal::linux_backend::FileDescriptor words_;
  std::size_t next_ = 0;
  unsigned limit_s_ = longest_fault_s;     // of the next process's first fault
  unsigned limit_now_s_ = longest_fault_s; // of the one that ran
};

} // namespace

std::span<const int> possible_errors(CallKind kind) {
  static constexpr int of_open[]{EINTR, ENODEV, ENOMEM};
  static constexpr int of_close[]{EINTR, EIO};
  static constexpr int of_control[]{EINTR, EAGAIN, ENODEV, ENOMEM};
  static constexpr int of_poll[]{EINTR, EAGAIN, ENOMEM};
  static constexpr int of_data[]{EINTR, EAGAIN, ENODEV, ENOMEM, 0};
  static constexpr int of_map[]{EAGAIN, ENODEV, ENOMEM};
  static constexpr int of_receive[]{EINTR, EAGAIN, ENOMEM};
  switch (kind) {
  case CallKind::open: return of_open;
  case CallKind::close: return of_close;
  case CallKind::control: return of_control;
  case CallKind::poll: return of_poll;
  case CallKind::read:
  case CallKind::write: return of_data;
  case CallKind::map: return of_map;
  case CallKind::receive: return of_receive;
  }
  return {};
}

SweepReport sweep_sites(const SweepPlan& plan) {
  SweepReport report;
  std::vector<SeenSite> sites;
  if (plan.begin && !plan.begin()) {
    report.complaints.emplace_back("unharmed: it could not begin");
    return report;
  }
  for (const SyscallFaultInjector::Notes notes :
       {SyscallFaultInjector::Notes::none, SyscallFaultInjector::Notes::sites}) {
    // Twice: what is made once in a process, is made the first time.
    const SyscallFaultInjector injector{plan.kinds, {}, notes};
    if (const auto wrong = injector.run(plan.scenario)) {
      report.complaints.push_back("unharmed: " + *wrong);
      return report;
    }
    report.calls = injector.calls();
    sites = injector.sites();
  }
  if (plan.end)
    plan.end();
  report.sites = static_cast<unsigned>(sites.size());
  std::vector<Target> targets;
  unsigned faults = 0;
  for (const SeenSite& seen : sites)
    for (const int error : possible_errors(seen.site.kind))
      if (is_injected(faults++))
        targets.push_back({seen, error});
  Shooting{plan, std::move(targets), report}.run();
  if (const auto wrong = plan.afterwards ? plan.afterwards() : plan.scenario())
    report.complaints.push_back("unharmed, after all faults: " + *wrong);
  return report;
}

void print(const SweepReport& report) {
  fmt::print("  {} calls from {} sites; {} faults in {} processes, {} spared, {} missed, after {} "
             "something was left\n",
             report.calls, report.sites, report.faults, report.processes, report.spared,
             report.missed, report.left_behind);
  for (const std::string& death : report.known)
    fmt::print("  known: {}\n", death);
}

} // namespace octascope::tests
