#include "tests/hal/hid/fake_hidapi.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <deque>
#include <map>
#include <mutex>

#include <hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace octascope::tests {

namespace {

struct Plugged {
  std::uint16_t vendor = 0, product = 0;
  int usages = 1;
  bool gone = false;
  int broken_off = 0;
  std::deque<std::vector<std::uint8_t>> sent = {};
  std::vector<std::vector<std::uint8_t>> written = {};
};

struct State {
  std::mutex guard;
  std::condition_variable news;
  std::map<std::string, Plugged> plugged;
  bool refuses = false;
  int open = 0, begun = 0;
  unsigned calls = 0; // as the last error of hidapi: unguarded
};

State* state = nullptr;

} // namespace

FakeHidapi::FakeHidapi() {
  state = new State;
}

FakeHidapi::~FakeHidapi() {
  delete state;
  state = nullptr;
}

void FakeHidapi::plug(const std::string& node, std::uint16_t vendor, std::uint16_t product,
                      int usages) {
  const std::lock_guard lock{state->guard};
  state->plugged[node] = Plugged{.vendor = vendor, .product = product, .usages = usages};
}

void FakeHidapi::send(const std::string& node, std::vector<std::uint8_t> report) {
  const std::lock_guard lock{state->guard};
  state->plugged.at(node).sent.push_back(std::move(report));
  state->news.notify_all();
}

void FakeHidapi::pull(const std::string& node) {
  const std::lock_guard lock{state->guard};
  state->plugged.at(node).gone = true;
  state->news.notify_all();
}

void FakeHidapi::break_off_reading(const std::string& node, int times) {
  const std::lock_guard lock{state->guard};
  state->plugged.at(node).broken_off = times;
  state->news.notify_all();
}

void FakeHidapi::refuse_to_open(bool refuses) {
  const std::lock_guard lock{state->guard};
  state->refuses = refuses;
}

std::vector<std::vector<std::uint8_t>> FakeHidapi::written(const std::string& node) const {
  const std::lock_guard lock{state->guard};
  return state->plugged.at(node).written;
}

int FakeHidapi::open_devices() const {
  const std::lock_guard lock{state->guard};
  return state->open;
}

int FakeHidapi::begun() const {
  const std::lock_guard lock{state->guard};
  return state->begun;
}

} // namespace octascope::tests

using octascope::tests::Plugged;
using octascope::tests::state;

struct hid_device_ {
  Plugged& plugged;
  unsigned calls = 0; // as the device's last error: unguarded
};

extern "C" {

int hid_init() {
  ++state->calls;
  const std::lock_guard lock{state->guard};
  ++state->begun;
  return 0;
}

int hid_exit() {
  ++state->calls;
  const std::lock_guard lock{state->guard};
  --state->begun;
  return 0;
}

hid_device_info* hid_enumerate(unsigned short, unsigned short) {
  ++state->calls;
  const std::lock_guard lock{state->guard};
  hid_device_info* first = nullptr;
  for (const auto& [node, plugged] : state->plugged)
    for (int i = 0; i < plugged.usages; ++i) {
      auto* const info = static_cast<hid_device_info*>(std::calloc(1, sizeof(hid_device_info)));
      info->path = ::strdup(node.c_str());
      info->vendor_id = plugged.vendor;
      info->product_id = plugged.product;
      info->next = first;
      first = info;
    }
  return first;
}

void hid_free_enumeration(hid_device_info* first) {
  while (first != nullptr) {
    hid_device_info* const next = first->next;
    std::free(first->path);
    std::free(first);
    first = next;
  }
}

hid_device* hid_open_path(const char* path) {
  ++state->calls;
  const std::lock_guard lock{state->guard};
  const auto found = state->plugged.find(path);
  if (state->refuses || found == state->plugged.end())
    return nullptr;
  ++state->open;
  return new hid_device_{found->second};
}

void hid_close(hid_device* device) {
  const std::lock_guard lock{state->guard};
  --state->open;
  delete device;
}

int hid_read_timeout(hid_device* device, unsigned char* data, std::size_t length, int timeout_ms) {
  ++device->calls;
  std::unique_lock lock{state->guard};
  Plugged& plugged = device->plugged;
  state->news.wait_for(lock, std::chrono::milliseconds{timeout_ms}, [&] {
    return plugged.gone || plugged.broken_off > 0 || !plugged.sent.empty();
  });
  if (plugged.broken_off > 0) {
    --plugged.broken_off;
    return -1;
  }
  if (plugged.sent.empty())
    return plugged.gone ? -1 : 0;
  const std::vector<std::uint8_t> report = std::move(plugged.sent.front());
  plugged.sent.pop_front();
  const std::size_t size = std::min(length, report.size());
  std::memcpy(data, report.data(), size);
  return static_cast<int>(size);
}

int hid_write(hid_device* device, const unsigned char* data, std::size_t length) {
  ++device->calls;
  const std::lock_guard lock{state->guard};
  device->plugged.written.emplace_back(data, data + length);
  return static_cast<int>(length);
}

const wchar_t* hid_error(hid_device*) {
  ++state->calls;
  return L"no reason at all";
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (request == HIDIOCGRAWINFO && state != nullptr)
    return 0;
  return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
}

} // extern "C"
