#include "firmware-host/outputs/picture_writer.h"

#include <chrono>

#include "firmware-host/outputs/dated_file.h"

namespace octascope::firmware_host {

bool PictureWriter::keep(pipeline::Image picture) {
  using namespace std::chrono_literals;
  if (writing_.valid() && writing_.wait_for(0s) != std::future_status::ready) {
    faults_.add(pipeline::Fault::picture_not_kept, "the last picture is still being written",
                clock_.now());
    return false;
  }
  const std::filesystem::path file = free_dated_name(folder_, "octascope", ".png");
  writing_ = std::async(std::launch::async, [this, file, image = std::move(picture)] {
    if (const auto written = pipeline::write_png(file, image, pipeline::Readers::owner); !written)
      faults_.add(pipeline::Fault::picture_not_kept, written.error().message, clock_.now());
  });
  return true;
}

} // namespace octascope::firmware_host
