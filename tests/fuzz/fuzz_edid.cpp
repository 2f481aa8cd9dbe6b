// What a monitor says of itself: a short printable name, or none.
#include <cstddef>
#include <cstdint>

#include "hal/linux/kms/drm/edid.h"
#include "tests/fuzz/expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace octascope;
  const std::string name = hal::linux_backend::kms::monitor_name({bytes, size});
  tests::expect(name.size() <= 32, "a name is short");
  for (const char letter : name)
    tests::expect(letter >= ' ' && letter <= '~', "a name is printable");
  return 0;
}
