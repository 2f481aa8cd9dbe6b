#include "pipeline/recordings/dicom/dicom_output.h"

#include <cstddef>
#include <limits>

#include "dcmtk/dcmdata/dcerror.h"

namespace octascope::pipeline {

OFCondition DicomConsumer::status() const {
  return outcome_ ? EC_Normal : EC_InvalidStream;
}

offile_off_t DicomConsumer::avail() const {
  return outcome_ ? std::numeric_limits<offile_off_t>::max() : 0;
}

offile_off_t DicomConsumer::write(const void* bytes, offile_off_t count) {
  if (!outcome_ || count <= 0)
    return 0;
  const auto size = static_cast<std::size_t>(count);
  outcome_ = file_.write_at(offset_, {static_cast<const std::byte*>(bytes), size});
  if (!outcome_)
    return 0;
  offset_ += size;
  return count;
}

} // namespace octascope::pipeline
