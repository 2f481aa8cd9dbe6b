// Reports of every listed control, many in a row: readings within what the control has.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "hal/linux/hid/decoders/hid_decoder.h"
#include "hal/linux/hid/models/control_model.h"
#include "tests/fuzz/expect.h"

// The first byte chooses the control; then reports, each with its length in front.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace octascope;
  using namespace octascope::hal::linux_backend;
  if (size == 0)
    return 0;
  const auto models = listed_control_models();
  const ControlModel& model = models[bytes[0] % models.size()];
  const auto decoder = make_hid_decoder(model);
  if (!decoder)
    return 0;
  std::span<const std::uint8_t> rest{bytes + 1, size - 1};
  while (!rest.empty()) {
    const std::size_t length = std::min<std::size_t>(rest[0], rest.size() - 1);
    const auto reading = decoder->decode(rest.subspan(1, length));
    rest = rest.subspan(1 + length);
    if (!reading)
      continue;
    for (const std::int16_t axis : reading->axes)
      tests::expect(axis >= -1000 && axis <= 1000, "an axis goes from -1000 to 1000");
    tests::expect((reading->switches.value_or(0) >> model.switches) == 0,
                  "no switch is told that the control does not have");
    tests::expect(std::abs(reading->knob) <= 4000, "a report turns a knob by so much at most");
  }
  return 0;
}
