// Aravis's own GigE Vision camera, on the machine's loopback: it answers to 127.0.0.1, at one port,
// so there is one at a time on a machine.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace octascope::tests {

class FakeCamera {
public:
  static constexpr const char* address = "127.0.0.1";

  // `lost`: the share of its packets that it leaves out. Waits while another test has the port.
  explicit FakeCamera(double lost = 0);
  ~FakeCamera();

  // Whether the loopback has it.
  bool runs() const;

  // Sends so many frames, one each time that the one before was sent, beside the caller.
  void trigger(int frames);

  void unplug();
  void replug();

private:
  struct Port; // of the machine
  void plug_in();
  void send(int frames);

  const double lost_;
  std::unique_ptr<Port> port_;
  void* camera_ = nullptr; // ArvGvFakeCamera
  std::thread sending_;
  std::atomic<bool> over_{false};
};

} // namespace octascope::tests
