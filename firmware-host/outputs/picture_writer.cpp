#include "firmware-host/outputs/picture_writer.h"

#include "firmware-host/outputs/dated_file.h"

namespace octascope::firmware_host {

bool PictureWriter::keep(pipeline::Image picture) {
  const std::lock_guard lock{mutex_};
  if (waiting_.size() > most_waiting) {
    faults_.add(pipeline::Fault::picture_not_kept, "the last pictures are still being written",
                clock_.now());
    return false;
  }
  waiting_.push_back(std::move(picture));
  if (waiting_.size() == 1)
    writing_ = std::async(std::launch::async, [this] { write_waiting(); });
  return true;
}

void PictureWriter::write_waiting() {
  std::unique_lock lock{mutex_};
  while (!waiting_.empty()) {
    const pipeline::Image& picture = waiting_.front(); // keep() moves none
    lock.unlock();
    const auto written = pipeline::write_png(free_dated_name(folder_, "octascope", ".png"), picture,
                                             pipeline::Readers::owner);
    if (!written)
      faults_.add(pipeline::Fault::picture_not_kept, written.error().message, clock_.now());
    lock.lock();
    waiting_.pop_front();
  }
}

} // namespace octascope::firmware_host
