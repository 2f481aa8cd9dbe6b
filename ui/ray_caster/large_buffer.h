// Memory on large pages, for data that rays read in scattered order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace octascope::ui {

// Zeroed bytes on pages of 2 MiB where the kernel provides them: with 4 KiB pages nearly every load
// of a ray that crosses B-scans misses the translation cache, and a picture takes three times as
// long. Works without large pages, more slowly.
class LargeBuffer {
public:
  LargeBuffer() = default;
  explicit LargeBuffer(std::size_t size);

  std::uint8_t* data() { return bytes_.get(); }
  const std::uint8_t* data() const { return bytes_.get(); }

private:
  struct Unmap {
    std::size_t size;
    void operator()(std::uint8_t* bytes) const;
  };
  std::unique_ptr<std::uint8_t, Unmap> bytes_{nullptr, Unmap{0}};
};

} // namespace octascope::ui
