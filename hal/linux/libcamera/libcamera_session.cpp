#include "hal/linux/libcamera/libcamera_session.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <libcamera/camera.h>
#include <libcamera/camera_manager.h>
#include <libcamera/logging.h>
#include <link.h>
#include <sys/stat.h>

#include "hal/linux/libcamera/camera_link.h"
#include "hal/linux/libcamera/libcamera_version.h"
#include "hal/linux/libcamera/media_events.h"
#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend {

namespace {

// libcamera keeps its manager in a variable of the process and ends the program at a second one:
// so this has to be one of the process, too.
std::atomic_flag session_lives = ATOMIC_FLAG_INIT;

// libcamera hears of no camera that comes while it runs (media_events.h), nor of nodes that udevd sets up in
// the moment when it starts (0.0.3). So it begins anew where another device has come, and where it lists no
// camera, but then not at every question; and never while udevd is at work: it may crash when it begins or ends
// while nodes are set up.
constexpr std::chrono::seconds second_look_after{2};

// Those that udevd has set up, by their numbers in sysfs: one that is plugged in again has another.
std::vector<ino_t> media_devices() {
  std::vector<ino_t> devices;
  std::error_code error;
  for (const auto& device : entries("/sys/bus/media/devices")) {
    struct stat status {};
    if (std::filesystem::exists("/run/udev/data/c" + first_line(device / "dev"), error) &&
        ::stat(device.c_str(), &status) == 0)
      devices.push_back(status.st_ino);
  }
  std::ranges::sort(devices);
  return devices;
}

int note_module(dl_phdr_info* module, std::size_t, void* names) {
  if (std::string_view{module->dlpi_name}.find("/libcamera/ipa_") != std::string_view::npos)
    static_cast<std::vector<std::string>*>(names)->emplace_back(module->dlpi_name);
  return 0;
}

// An abandoned camera's thread may still be in the code of the module that steers it: those that
// are loaded now stay so. Each is mapped once, however often this is called.
void keep_modules() {
  std::vector<std::string> names;
  ::dl_iterate_phdr(note_module, &names);
  for (const std::string& name : names)
    if (void* const handle = ::dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE))
      ::dlclose(handle);
}

// libcamera's manager handles SIGCHLD while it lives, and reads there a pointer that is null until shortly
// after it began to and again shortly before it is gone (0.0.3, ProcessManager): a child of this program that
// ended in such a moment ended the program with it. What it would learn by the signal it never does, as the
// thread that makes it runs no event loop of libcamera's. So the handler is replaced by the one before it.
std::unique_ptr<libcamera::CameraManager> make_manager() {
  struct sigaction before {};
  ::sigaction(SIGCHLD, nullptr, &before);
  auto manager = std::make_unique<libcamera::CameraManager>();
  ::sigaction(SIGCHLD, &before, nullptr);
  return manager;
}

std::vector<dev_t> device_numbers(const std::vector<std::string>& nodes) {
  std::vector<dev_t> numbers;
  for (const std::string& node : nodes) {
    struct stat status {};
    if (::stat(node.c_str(), &status) == 0 && S_ISCHR(status.st_mode))
      numbers.push_back(status.st_rdev);
  }
  return numbers;
}

} // namespace

struct LibcameraSession::Parts {
  Parts() = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() {
    stop();
    session_lives.clear();
  }

  struct Listed {
    std::shared_ptr<libcamera::Camera> camera;
    CameraNodes nodes;
    LibcameraFound facts;
  };

  Result<> start() {
    if (manager)
      return {};
    auto made = make_manager();
    devices = media_devices();
    if (const int result = start_without_video_nodes(*made); result < 0)
      return system_failure("libcamera", "starting", -result);
    manager = std::move(made);
    started_at = std::chrono::steady_clock::now();
    return {};
  }
  void stop() {
    if (manager)
      manager->stop();
    manager.reset();
  }
  bool may_have_missed_one() const {
    return std::chrono::steady_clock::now() - started_at > second_look_after &&
           !media_devices().empty() && !udev_is_at_work();
  }
  bool another_came() const { return media_devices() != devices && !udev_is_at_work(); }
  // Cameras that are held become useless where it may begin anew.
  enum class Others : std::uint8_t { left, looked_for };
  Result<std::vector<Listed>> list(const std::vector<std::string>& taken_nodes, Others others);

  std::mutex mutex; // of all below
  std::unique_ptr<libcamera::CameraManager> manager;
  std::chrono::steady_clock::time_point started_at;
  std::vector<ino_t> devices; // that there were when it started
};

Result<std::vector<LibcameraSession::Parts::Listed>>
LibcameraSession::Parts::list(const std::vector<std::string>& taken_nodes, Others others) {
  const std::vector<dev_t> taken = device_numbers(taken_nodes);
  for (bool again = false;; again = true) {
    std::vector<Listed> cameras;
    if (!manager && udev_is_at_work())
      return cameras;
    HAL_CHECK(start());
    bool one_is_gone = false;
    for (const auto& camera : manager->cameras()) {
      CameraNodes nodes{nodes_of(*manager, camera)};
      one_is_gone = one_is_gone || !nodes.present();
      LibcameraFound facts{camera->id(), model_of(*camera)};
      for (const dev_t node : taken)
        facts.taken = facts.taken || nodes.include(node);
      if (nodes.present())
        cameras.push_back({camera, std::move(nodes), std::move(facts)});
    }
    const bool look_again = one_is_gone || (cameras.empty() && may_have_missed_one()) ||
                            ((cameras.empty() || others == Others::looked_for) && another_came());
    if (!look_again || again)
      return cameras;
    cameras.clear();
    stop();
  }
}

Result<std::unique_ptr<LibcameraSession>> LibcameraSession::start() {
  if (session_lives.test_and_set())
    return fail(ErrorCode::busy,
                "libcamera: this process uses it already, expected once; share the "
                "session that is there");
  auto parts = std::make_unique<Parts>();
  if (std::getenv("LIBCAMERA_LOG_LEVELS") == nullptr)
    libcamera::logSetTarget(libcamera::LoggingTargetNone);
  return std::unique_ptr<LibcameraSession>(new LibcameraSession{std::move(parts)});
}

LibcameraSession::LibcameraSession(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}
LibcameraSession::~LibcameraSession() = default;

std::vector<LibcameraFound> LibcameraSession::cameras(const std::vector<std::string>& taken_nodes) {
  const std::lock_guard lock{parts_->mutex};
  std::vector<LibcameraFound> found;
  if (const auto listed = parts_->list(taken_nodes, Parts::Others::left))
    for (const Parts::Listed& one : *listed)
      found.push_back(one.facts);
  return found;
}

Result<LibcameraSession::Chosen>
LibcameraSession::choose(const std::string& wanted, const std::vector<std::string>& taken_nodes) {
  const std::lock_guard lock{parts_->mutex};
  HAL_TRY(const auto listed, parts_->list(taken_nodes, Parts::Others::looked_for));
  if (listed.empty())
    return tl::make_unexpected(explain_absence());
  std::vector<LibcameraFound> found;
  for (const Parts::Listed& one : listed)
    found.push_back(one.facts);
  return choose_camera(found, wanted).map([&](std::size_t index) {
    const Parts::Listed& one = listed[index];
    return Chosen{one.camera, one.facts.model, one.nodes};
  });
}

void LibcameraSession::restart() {
  const std::lock_guard lock{parts_->mutex};
  keep_modules();
  parts_->stop();
}

} // namespace octascope::hal::linux_backend
