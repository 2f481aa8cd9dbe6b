#include "firmware-host/outputs/picture_writer.h"

#include "firmware-host/outputs/dated_file.h"

namespace octascope::firmware_host {

bool PictureWriter::keep(pipeline::Image picture) {
  writing_.take(); // it has told what went wrong
  if (writing_.busy()) {
    faults_.add(pipeline::Fault::picture_not_kept, "the last picture is still being written",
                clock_.now());
    return false;
  }
  const std::filesystem::path file = free_dated_name(folder_, "octascope", ".png");
  writing_.start([this, file, image = std::move(picture)] {
    auto written = pipeline::write_png(file, image, pipeline::Readers::owner);
    if (!written)
      faults_.add(pipeline::Fault::picture_not_kept, written.error().message, clock_.now());
    return written;
  });
  return true;
}

} // namespace octascope::firmware_host
