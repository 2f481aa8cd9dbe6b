#include "hal/linux/hid/hid_decoder.h"

#include "hal/linux/hid/pedal_decoder.h"
#include "hal/linux/hid/shuttle_decoder.h"
#include "hal/linux/hid/space_mouse_decoder.h"
#include "hal/linux/hid/surface_dial_decoder.h"

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
