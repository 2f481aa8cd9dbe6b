#include "hal/linux/hid/decoders/hid_decoder.h"

#include "hal/linux/hid/decoders/pedal_decoder.h"
#include "hal/linux/hid/decoders/shuttle_decoder.h"
#include "hal/linux/hid/decoders/space_mouse_decoder.h"
#include "hal/linux/hid/decoders/surface_dial_decoder.h"

namespace octascope::hal::linux_backend {

std::unique_ptr<HidDecoder> make_hid_decoder(const ControlModel& model) {
  switch (model.family) {
  case HidFamily::vec_pedal:
  case HidFamily::philips_pedal: return std::make_unique<PedalDecoder>(model.switches);
  case HidFamily::shuttle:
    return std::make_unique<ShuttleDecoder>(model.switches, model.first_button);
  case HidFamily::space_mouse: return std::make_unique<SpaceMouseDecoder>(model.switches);
  case HidFamily::surface_dial: return std::make_unique<SurfaceDialDecoder>();
  case HidFamily::mapped: return std::make_unique<MappedDecoder>(model.bits, model.report_id);
  case HidFamily::powermate:
  case HidFamily::keyboard: break;
  }
  return nullptr;
}

} // namespace octascope::hal::linux_backend
