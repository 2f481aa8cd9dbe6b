#include "hal/linux/kms/drm/topology.h"

#include <drm_mode.h>
#include <fmt/format.h>

namespace octascope::hal::linux_backend::kms {

double refresh_hz(const Mode& mode) {
  if (mode.htotal == 0 || mode.vtotal == 0)
    return 0;
  double rate = mode.clock_khz * 1000.0 / (double{1} * mode.htotal * mode.vtotal);
  if ((mode.flags & DRM_MODE_FLAG_INTERLACE) != 0)
    rate *= 2; // as fields, which is what monitors name
  if ((mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0)
    rate /= 2;
  if (mode.vscan > 1)
    rate /= mode.vscan;
  return rate;
}

bool is_preferred(const Mode& mode) {
  return (mode.type & DRM_MODE_TYPE_PREFERRED) != 0;
}

bool is_interlaced(const Mode& mode) {
  return (mode.flags & DRM_MODE_FLAG_INTERLACE) != 0;
}

std::string to_text(const Mode& mode) {
  return fmt::format("{}x{}{}@{:.2f}", mode.width, mode.height, is_interlaced(mode) ? "i" : "",
                     refresh_hz(mode));
}

std::string card_name(const Card& card) {
  return card.node.substr(card.node.rfind('/') + 1);
}

} // namespace octascope::hal::linux_backend::kms
