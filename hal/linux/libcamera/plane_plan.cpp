#include "hal/linux/libcamera/plane_plan.h"

#include <algorithm>
#include <limits>

namespace octascope::hal::linux_backend {

namespace {

std::size_t file_of(std::vector<PlanePlan::File>& files, const BufferPlane& plane) {
  const std::size_t end = plane.offset + plane.length;
  const auto known = std::ranges::find_if(
      files, [&](const PlanePlan::File& file) { return file.descriptor == plane.descriptor; });
  if (known != files.end()) {
    known->length = std::max(known->length, end);
    return static_cast<std::size_t>(known - files.begin());
  }
  files.push_back({plane.descriptor, end});
  return files.size() - 1;
}

tl::unexpected<Error> too_short(const PictureLayout& layout, std::size_t found,
                                std::size_t expected) {
  return fail(ErrorCode::bad_data,
              "scope camera: a plane of {} bytes for {}x{} with rows of {}, expected at least {}: "
              "the camera's driver contradicts itself",
              found, layout.size.width, layout.size.height, layout.stride, expected);
}

// The planes that the format has when each lies for itself.
std::vector<std::size_t> plane_lengths(const PictureLayout& layout) {
  if (layout.encoding != Encoding::nv12)
    return {layout.bytes()};
  const auto height = static_cast<std::size_t>(layout.size.height);
  const std::size_t chroma_rows = (height + 1) / 2;
  const std::size_t row = row_bytes(layout.encoding, layout.size.width);
  return {layout.stride * (height - 1) + row, layout.stride * (chroma_rows - 1) + row};
}

bool sound(const BufferPlane& plane) {
  return plane.descriptor >= 0 && plane.length > 0 &&
         plane.offset <= std::numeric_limits<std::size_t>::max() / 2 &&
         plane.length <= std::numeric_limits<std::size_t>::max() / 2;
}

} // namespace

Result<PlanePlan> plan_planes(const std::vector<BufferPlane>& planes, const PictureLayout& layout) {
  if (planes.empty() || !std::ranges::all_of(planes, sound))
    return fail(ErrorCode::bad_data, "scope camera: its driver gave a buffer without memory");
  if (layout.size.width < 1 || layout.size.height < 1 ||
      layout.stride < row_bytes(layout.encoding, layout.size.width))
    return fail(ErrorCode::bad_data,
                "scope camera: {}x{} with rows of {} bytes, expected rows of at least {}",
                layout.size.width, layout.size.height, layout.stride,
                row_bytes(layout.encoding, layout.size.width));
  PlanePlan plan;
  const BufferPlane& first = planes.front();
  if (layout.encoding == Encoding::motion_jpeg) {
    plan.pieces.push_back({file_of(plan.files, first), first.offset, first.length, 0});
    return plan;
  }

  const std::vector<std::size_t> lengths = plane_lengths(layout);
  const bool in_one_plane = planes.size() == 1 || lengths.size() == 1;
  if (in_one_plane) {
    if (first.length < layout.bytes())
      return too_short(layout, first.length, layout.bytes());
    plan.pieces.push_back({file_of(plan.files, first), first.offset, layout.bytes(), 0});
    return plan;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (planes[i].length < lengths[i])
      return too_short(layout, planes[i].length, lengths[i]);
  const std::size_t luma_bytes = layout.stride * static_cast<std::size_t>(layout.size.height);
  const PlanePlan::Piece luma{file_of(plan.files, first), first.offset, lengths[0], 0};
  const PlanePlan::Piece chroma{file_of(plan.files, planes[1]), planes[1].offset, lengths[1],
                                luma_bytes};
  const bool adjoining = luma.file == chroma.file && chroma.offset == luma.offset + luma_bytes;
  if (adjoining)
    plan.pieces = {{luma.file, luma.offset, layout.bytes(), 0}};
  else
    plan.pieces = {luma, chroma};
  return plan;
}

} // namespace octascope::hal::linux_backend
