// Aravis's own GigE Vision camera, on the machine's loopback: it answers to 127.0.0.1, at one port,
// so there is one at a time on a machine.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/program/loopback_port.h"

namespace octascope::tests {

struct FakeCameraTraits {
  double lost = 0;              // the share of its packets that it leaves out
  std::string description = {}; // an XML file, where it is not Aravis's own
};

class FakeCamera {
public:
  static constexpr const char* address = "127.0.0.1";

  // Waits while another test has the port.
  explicit FakeCamera(FakeCameraTraits traits = {});
  ~FakeCamera();

  // The description that Aravis has for it.
  static std::string usual_description();

  // What it sends from now on, instead of a ramp: these bytes, as many as its frames have.
  void send_bytes(std::vector<std::byte> frame);

  // Whether the loopback has it.
  bool runs() const;

  // Sends so many frames, one each time that the one before was sent, beside the caller.
  void trigger(int frames);

  void unplug();
  void replug();

private:
  void plug_in();
  void send(int frames);

  const FakeCameraTraits traits_;
  const LoopbackPort port_;
  std::vector<std::byte> frame_;
  void* camera_ = nullptr; // ArvGvFakeCamera
  std::thread sending_;
  std::atomic<bool> over_{false};
};

} // namespace octascope::tests
