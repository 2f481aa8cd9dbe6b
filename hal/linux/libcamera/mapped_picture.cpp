#include "hal/linux/libcamera/mapped_picture.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

void MappedPicture::Unmap::operator()(const std::byte* address) const {
  ::munmap(const_cast<std::byte*>(address), length);
}

Result<MappedPicture> MappedPicture::map(const PlanePlan& plan, std::size_t bytes,
                                         std::string_view device) {
  MappedPicture picture;
  for (const PlanePlan::File& file : plan.files) {
    void* const address = ::mmap(nullptr, file.length, PROT_READ, MAP_SHARED, file.descriptor, 0);
    if (address == MAP_FAILED)
      return system_failure(device, "mapping a picture's memory", errno);
    picture.mappings_.push_back(
        {{static_cast<const std::byte*>(address), Unmap{file.length}}, file.descriptor});
  }
  picture.pieces_ = plan.pieces;
  if (picture.pieces_.size() > 1)
    picture.gathered_.resize(bytes);
  return picture;
}

void MappedPicture::synchronise(std::uint64_t flags) {
  // Where it fails, the memory is no dma-buf and needs none, or the device is gone and its last
  // bytes stay as they are.
  for (const Mapping& mapping : mappings_) {
    dma_buf_sync request{flags | DMA_BUF_SYNC_READ};
    int result = -1;
    do {
      result = ::ioctl(mapping.descriptor, DMA_BUF_IOCTL_SYNC, &request);
    } while (result == -1 && (errno == EINTR || errno == EAGAIN) && flags == DMA_BUF_SYNC_END);
  }
}

std::span<const std::byte> MappedPicture::begin_reading() {
  synchronise(DMA_BUF_SYNC_START);
  reading_ = true;
  if (gathered_.empty()) {
    const PlanePlan::Piece& whole = pieces_.front();
    return {mappings_[whole.file].bytes.get() + whole.offset, whole.length};
  }
  for (const PlanePlan::Piece& piece : pieces_)
    std::memcpy(gathered_.data() + piece.place, mappings_[piece.file].bytes.get() + piece.offset,
                piece.length);
  return gathered_;
}

void MappedPicture::end_reading() {
  if (std::exchange(reading_, false))
    synchronise(DMA_BUF_SYNC_END);
}

} // namespace octascope::hal::linux_backend
