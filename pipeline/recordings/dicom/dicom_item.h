// A DICOM data set, or an item of a sequence in one, filled element by element.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dcmtk/config/osconfig.h"
#include "dcmtk/dcmdata/dctk.h"

namespace octascope::pipeline {

// Every element is put with its value representation, so that what is written does not hang on the
// version of DCMTK's dictionary. After a failure the rest is left out; condition() says why.
class DicomItem {
public:
  explicit DicomItem(DcmItem& item) : item_(item) {}

  const OFCondition& condition() const { return condition_; }

  void put(const DcmTagKey& key, DcmEVR representation, const std::string& value) {
    keep([&] { return item_.putAndInsertString({key, {representation}}, value.c_str()); });
  }
  void put(const DcmTagKey& key, std::uint16_t value) { // US
    keep([&] { return item_.putAndInsertUint16({key, {EVR_US}}, value); });
  }
  void put(const DcmTagKey& key, double value) { // FD
    keep([&] { return item_.putAndInsertFloat64({key, {EVR_FD}}, value); });
  }
  void put(const DcmTagKey& key, const DcmTagKey& value) { // AT
    keep([&] { return item_.putAndInsertTagKey({key, {EVR_AT}}, value); });
  }
  void put(const DcmTagKey& key, std::span<const std::uint8_t> bytes) { // OB
    keep([&] { return item_.putAndInsertUint8Array({key, {EVR_OB}}, bytes.data(), bytes.size()); });
  }
  // A sequence of one item, which `fill` fills.
  template <class Fill> void put_item(const DcmTagKey& sequence, const Fill& fill) {
    keep([&] {
      DcmItem* made = nullptr;
      const OFCondition inserted =
          item_.findOrCreateSequenceItem({sequence, {EVR_SQ}}, made, append);
      if (inserted.bad())
        return inserted;
      DicomItem item{*made};
      fill(item);
      return item.condition();
    });
  }

private:
  static constexpr long append = -2; // as DCMTK has it

  template <class Action> void keep(const Action& action) {
    if (condition_.good())
      condition_ = action();
  }

  DcmItem& item_;
  OFCondition condition_ = EC_Normal;
};

} // namespace octascope::pipeline
