// DCMTK's output into a file of ours, which appears complete or not at all.
#pragma once

#include "dcmtk/config/osconfig.h"
#include "dcmtk/dcmdata/dcostrma.h"

#include "hal/result.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::pipeline {

// Takes every byte, until writing fails; then none.
class DicomConsumer : public DcmConsumer {
public:
  explicit DicomConsumer(const AtomicFile& file) : file_(file) {}

  const hal::Result<>& outcome() const { return outcome_; }

  OFBool good() const override { return outcome_.has_value(); }
  OFCondition status() const override;
  OFBool isFlushed() const override { return true; }
  offile_off_t avail() const override;
  offile_off_t write(const void* bytes, offile_off_t count) override;
  void flush() override {}

private:
  const AtomicFile& file_;
  hal::Result<> outcome_;
  std::uint64_t offset_ = 0;
};

// The stream that DCMTK writes to. The consumer must outlive it.
class DicomOutput : public DcmOutputStream {
public:
  explicit DicomOutput(DicomConsumer& consumer) : DcmOutputStream(&consumer) {}
};

} // namespace octascope::pipeline
